//! Powers and logarithms of what is not known to be positive.

use super::*;

impl Fixture {
    fn log(&mut self, id: ExprId) -> ExprId {
        self.call(Elementary::Log, id)
    }
    fn exp(&mut self, id: ExprId) -> ExprId {
        self.call(Elementary::Exp, id)
    }
    /// `exp(p/q log id)`
    fn by_logarithm(&mut self, id: ExprId, p: i64, q: i64) -> ExprId {
        let logarithm = self.log(id);
        let scaled = self.scale(logarithm, p, q);
        self.exp(scaled)
    }
    fn neg(&mut self, id: ExprId) -> ExprId {
        self.graph.neg(id)
    }
    fn absolute(&mut self, id: ExprId) -> ExprId {
        let square = self.power(id, 2, 1);
        self.power(square, 1, 2)
    }
    /// `a - b` is zero where all that is in it and in `domain` is defined.
    fn same_within(&mut self, a: ExprId, b: ExprId, domain: &[ExprId]) -> bool {
        let difference = self.graph.sub(a, b);
        let budget = Budget::new(1_000_000);
        let mut normal = NormalForm::with_domain(&self.graph, &budget, domain);
        matches!(normal.unconfirmed(difference), Verdict::Zero)
    }
}

#[test]
fn the_exponential_undoes_the_logarithm_where_it_is_real() {
    let mut f = Fixture::new();
    let x = f.x();
    let negative = f.neg(x);
    let positive = f.by_logarithm(x, 1, 1);
    f.same(positive, x);
    // exp(log(-x)) = -x, not x
    let other = f.by_logarithm(negative, 1, 1);
    f.same(other, negative);
    f.differ(other, x);
    // exp(log(x^2)/2) = |x| = sqrt(x^2), neither x nor -x
    let square = f.power(x, 2, 1);
    let size = f.by_logarithm(square, 1, 2);
    let root = f.absolute(x);
    f.same(size, root);
    f.differ(size, x);
    f.differ(size, negative);
    let back = f.power(size, 2, 1);
    f.same(back, square);
    // exp(3 log(x^2)/2) = |x|^3 has no degree
    let cube = f.by_logarithm(square, 3, 2);
    let (third, power) = (f.power(root, 3, 1), f.power(x, 3, 1));
    f.same(cube, third);
    f.differ(cube, power);
    let budget = Budget::new(1_000_000);
    let graph = f.graph.clone();
    let mut normal = NormalForm::new(&graph, &budget);
    assert_eq!(normal.degree(cube), None);
    assert_eq!(normal.degree(power), Some(3));
    let fourth = f.by_logarithm(square, 2, 1);
    let graph = f.graph.clone();
    assert_eq!(NormalForm::new(&graph, &budget).degree(fourth), Some(4));
}

#[test]
fn the_sign_of_a_product_says_nothing_of_its_factors() {
    let mut f = Fixture::new();
    let (x, y) = (f.x(), f.y());
    let product = f.graph.mul(x, y);
    // log(x y) is real where x and y are both negative, too
    let (whole, sizes) = (f.log(product), [x, y].map(|id| f.absolute(id)));
    let parts = sizes.map(|id| f.log(id));
    let sum = f.graph.add(parts[0], parts[1]);
    f.same(whole, sum);
    let size = f.graph.mul(whole, sizes[0]);
    let signed = f.graph.mul(whole, x);
    f.differ(size, signed);
    // but |x| |y| = x y there, which is not so elsewhere
    let both = f.graph.mul(sizes[0], sizes[1]);
    f.differ(both, product);
    let (left, right) = (f.graph.mul(both, whole), f.graph.mul(product, whole));
    f.same(left, right);
    // with log x, both are positive
    let other = f.log(x);
    let (left, right) = (f.graph.mul(size, other), f.graph.mul(signed, other));
    f.same(left, right);
    let (left, right) = (f.graph.mul(sizes[1], left), f.graph.mul(y, right));
    f.same(left, right);
}

#[test]
fn domains_are_those_of_the_functions_asked_about() {
    let mut f = Fixture::new();
    let x = f.x();
    let size = f.absolute(x);
    let (logarithm, root) = (f.log(x), f.power(x, 1, 2));
    assert!(!f.same_within(size, x, &[]));
    assert!(f.same_within(size, x, &[logarithm]));
    assert!(f.same_within(size, x, &[root]));
    // the facts of one question are not those of the next
    let negative = f.neg(x);
    let other = f.log(negative);
    let (with, without) = (f.graph.sub(size, x), f.graph.mul(size, other));
    let signed = f.graph.mul(negative, other);
    let zero = f.graph.sub(without, signed);
    let budget = Budget::new(1_000_000);
    let mut normal = NormalForm::new(&f.graph, &budget);
    assert!(matches!(normal.unconfirmed(zero), Verdict::Zero));
    assert!(!matches!(normal.unconfirmed(with), Verdict::Zero));
    assert!(matches!(normal.unconfirmed(zero), Verdict::Zero));
}

#[test]
fn what_is_positive_anyway_has_no_sign() {
    let mut f = Fixture::new();
    let (x, y) = (f.x(), f.y());
    let (xx, yy) = (f.power(x, 2, 1), f.power(y, 2, 1));
    let one = f.graph.integer(1);
    let wave = f.call(Elementary::Cosh, x);
    let power = f.exp(y);
    for id in [
        f.graph.sum(&[xx, yy, one]),
        f.graph.add(xx, yy),
        wave,
        power,
    ] {
        let size = f.absolute(id);
        f.same(size, id);
    }
    // x^2 - y^2 + 1 and x + y may be negative, and parameters unless they are declared positive
    let k = f.graph.symbol(Symbol::Parameter(0));
    for id in [f.graph.add(x, y), f.graph.sub(xx, yy), k] {
        let size = f.absolute(id);
        f.differ(size, id);
    }
    let (size, sum) = (f.absolute(k), f.graph.add(k, xx));
    let whole = f.absolute(sum);
    f.differ(whole, sum);
    f.graph.assume_positive(Symbol::Parameter(0));
    f.same(size, k);
    f.same(whole, sum);
    // what is positive makes sums of it positive
    let (root, sum) = (f.power(x, 1, 2), f.graph.add(x, one));
    let size = f.absolute(sum);
    f.differ(size, sum);
    let (left, right) = (f.graph.mul(size, root), f.graph.mul(sum, root));
    f.same(left, right);
}

#[test]
fn squares_are_recognised() {
    let mut f = Fixture::new();
    let (x, y) = (f.x(), f.y());
    let (xx, yy, xy) = (f.power(x, 2, 1), f.power(y, 2, 1), f.graph.mul(x, y));
    let twice = f.scale(xy, 2, 1);
    let square = f.graph.sum(&[xx, yy, twice]);
    let sum = f.graph.add(x, y);
    let (left, right) = (f.power(square, 1, 2), f.absolute(sum));
    f.same(left, right);
    f.differ(left, sum);
    // |x + y| |x - y| = |x^2 - y^2|
    let difference = f.graph.sub(x, y);
    let sizes = [sum, difference].map(|id| f.absolute(id));
    let product = f.graph.mul(sizes[0], sizes[1]);
    let squares = f.graph.sub(xx, yy);
    let whole = f.absolute(squares);
    f.same(product, whole);
    // sqrt(1 - cos(x)^2) = |sin x|
    let (s, c) = (f.call(Elementary::Sin, x), f.call(Elementary::Cos, x));
    let size = f.absolute(s);
    f.differ(size, s);
    let logarithm = f.by_logarithm(c, 1, 1);
    f.same(logarithm, c);
}

#[test]
fn a_hidden_zero_fixes_no_sign() {
    let mut f = Fixture::new();
    let (x, y) = (f.x(), f.y());
    let z = f.graph.symbol(Symbol::Coordinate(2));
    // x - |x| is zero for x > 0: the roots are real there for every y and z
    let size = f.absolute(x);
    let zero = f.graph.sub(x, size);
    let roots = [y, z].map(|id| {
        let product = f.graph.mul(zero, id);
        f.power(product, 1, 2)
    });
    let product = f.graph.mul(y, z);
    let absolute = f.absolute(product);
    let terms = [roots[0], roots[1], absolute];
    let left = f.graph.sum(&terms);
    let right = f.graph.sum(&[roots[0], roots[1], product]);
    assert!(!f.same_within(left, right, &[roots[0], roots[1]]));
}

#[test]
fn constants_are_decided() {
    let mut f = Fixture::new();
    let pi = f.graph.pi();
    let sine = f.call(Elementary::Sin, pi);
    assert!(f.zero(sine));
    let numbers = [2, 3, 6].map(|n| {
        let n = f.graph.integer(n);
        f.power(n, 1, 2)
    });
    let product = f.graph.mul(numbers[0], numbers[1]);
    f.same(product, numbers[2]);
    let one = f.graph.integer(1);
    let (s, c) = (f.call(Elementary::Sin, one), f.call(Elementary::Cos, one));
    let (s, c) = (f.power(s, 2, 1), f.power(c, 2, 1));
    let sum = f.graph.add(s, c);
    f.same(sum, one);
    for (p, q, numerator, root) in [(1, 3, 1, 1), (1, 4, 1, 2), (1, 6, 1, 3), (2, 3, -1, 1)] {
        let angle = f.scale(pi, p, q);
        let cosine = f.call(Elementary::Cos, angle);
        let root = f.graph.integer(root);
        let root = f.power(root, 1, 2);
        let value = f.scale(root, numerator, 2);
        f.same(cosine, value);
    }
    // 4 cos(pi/5) = 1 + sqrt 5 is beyond it, but exp(i pi/5)^5 = -1 is not
    let fifth = f.scale(pi, 1, 5);
    let (s, c) = (
        f.call(Elementary::Sin, fifth),
        f.call(Elementary::Cos, fifth),
    );
    let (a, b, d) = (f.power(c, 5, 1), f.power(c, 3, 1), f.power(s, 2, 1));
    let second = f.graph.mul(b, d);
    let last = f.power(s, 4, 1);
    let last = f.graph.mul(c, last);
    let sum = f
        .graph
        .linear(&[(a, 1.into()), (second, (-10).into()), (last, 5.into())]);
    let minus = f.graph.integer(-1);
    f.same(sum, minus);
}

#[test]
fn inverse_functions() {
    let mut f = Fixture::new();
    let (x, y) = (f.x(), f.y());
    let one = f.graph.integer(1);
    let xx = f.power(x, 2, 1);
    let below = f.graph.sub(one, xx);
    let root = f.power(below, 1, 2);
    let asin = f.call(Elementary::Asin, x);
    let (s, c) = (f.call(Elementary::Sin, asin), f.call(Elementary::Cos, asin));
    f.same(s, x);
    f.same(c, root);
    let acos = f.call(Elementary::Acos, x);
    let (s, c) = (f.call(Elementary::Sin, acos), f.call(Elementary::Cos, acos));
    f.same(s, root);
    f.same(c, x);
    let atan = f.call(Elementary::Atan, x);
    let tangent = f.call(Elementary::Tan, atan);
    f.same(tangent, x);
    let negative = f.neg(x);
    let (other, minus) = (f.call(Elementary::Atan, negative), f.neg(atan));
    f.same(other, minus);
    let angle = f.graph.call(Function::Atan2, &[y, x]);
    let yy = f.power(y, 2, 1);
    let square = f.graph.add(xx, yy);
    let radius = f.power(square, 1, 2);
    let cosine = f.call(Elementary::Cos, angle);
    let product = f.graph.mul(radius, cosine);
    f.same(product, x);
    let third = f.scale(angle, 3, 1);
    let sine = f.call(Elementary::Sin, third);
    let sine = f.graph.neg(sine);
    let (a, b) = (f.graph.call(Function::Atan2, &[y, x]), f.neg(angle));
    f.differ(a, b);
    let opposite = f.scale(angle, -3, 1);
    let left = f.call(Elementary::Sin, opposite);
    f.same(left, sine);
}
