use super::*;
use crate::exact::Rational;

fn xyz(g: &mut Graph) -> [ExprId; 3] {
    [0, 1, 2].map(|i| g.symbol(Symbol::Coordinate(i)))
}
fn name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => ["x", "y", "z"][i].into(),
        other => format!("{other:?}"),
    }
}
fn rational(n: i64, d: i64) -> Rational {
    Rational::new(n, d).unwrap()
}

#[test]
fn equal_expressions_are_one_node() {
    let mut g = Graph::new();
    let [x, y, _] = xyz(&mut g);
    let two = rational(2, 1);
    let a = g.add(x, y);
    let b = g.add(y, x);
    assert_eq!(a, b);
    let (xx, x2) = (g.mul(x, x), g.pow(x, &two));
    assert_eq!(xx, x2);
    let difference = g.sub(a, b);
    assert!(g.is_zero(difference));
    let quotient = g.div(x, x);
    assert_eq!(g.as_number(quotient), Some(&Rational::ONE));
    let (x3, y3) = (g.scale(x, &rational(3, 1)), g.scale(y, &rational(1, 3)));
    let (p, q) = (g.mul(x3, y3), g.mul(x, y));
    assert_eq!(p, q);
}

#[test]
fn powers_keep_their_meaning() {
    let mut g = Graph::new();
    let [x, ..] = xyz(&mut g);
    let half = rational(1, 2);
    let square = g.pow(x, &rational(2, 1));
    let root = g.pow(square, &half);
    assert_ne!(root, x, "the square root of x^2 is |x|");
    let root = g.pow(x, &half);
    let back = g.mul(root, root);
    assert_eq!(back, x);
    let eight = g.integer(8);
    let root = g.pow(eight, &rational(2, 3));
    assert_eq!(g.as_number(root), Some(&rational(4, 1)));
    let two = g.integer(2);
    let (a, b) = (g.pow(two, &half), g.pow(two, &rational(3, 2)));
    let product = g.mul(a, b);
    assert_eq!(g.as_number(product), Some(&rational(4, 1)));
    let zero = g.integer(0);
    let infinite = g.pow(zero, &Rational::MINUS_ONE);
    assert!(g.evaluate(infinite, &|_| 0.0).is_infinite());
    let huge = g.pow(two, &rational(1_000_000, 1));
    assert!(g.as_number(huge).is_none(), "no number of a million bits");
}

#[test]
fn text_is_the_grammar() {
    let mut g = Graph::new();
    let [x, y, z] = xyz(&mut g);
    let s = g.linear(&[(x, rational(-1, 2)), (y, Rational::ONE)]);
    let e = g.power_product(&[(s, rational(-2, 1)), (z, rational(1, 2))]);
    assert_eq!(g.display(e, &name), "4*sqrt(z)/(x - 2*y)^2");
    let sine = g.call(Elementary::Sin, &[x]);
    let e = g.linear(&[(sine, rational(-3, 1))]);
    assert_eq!(g.display(e, &name), "-3*sin(x)");
}

/// Every rule of differentiation against central differences; a wrong sign or factor fails.
#[test]
fn derivatives_agree_with_differences() {
    let mut g = Graph::new();
    let [x, y, z] = xyz(&mut g);
    let mut cases = Vec::new();
    for f in Function::all() {
        let arguments = if f.arity() == 2 { vec![x, y] } else { vec![x] };
        let mut inner = g.mul(x, y);
        if f == Elementary::Acosh.into() {
            // real from 1 on
            let one = g.integer(1);
            inner = g.add(inner, one);
            cases.push(g.call(f, &[inner]));
            continue;
        }
        let composed: Vec<_> = if f.arity() == 2 {
            vec![inner, z]
        } else {
            vec![inner]
        };
        cases.push(g.call(f, &arguments));
        cases.push(g.call(f, &composed));
    }
    let sum = g.add(x, z);
    cases.push(g.power_product(&[
        (sum, rational(-3, 2)),
        (y, rational(3, 1)),
        (x, rational(1, 2)),
    ]));
    let at = [0.3, 0.7, 1.1];
    let value = |point: [f64; 3]| {
        move |s: Symbol| {
            if let Symbol::Coordinate(i) = s {
                point[i]
            } else {
                f64::NAN
            }
        }
    };
    for e in cases {
        for i in 0..3 {
            let d = g.derivative(e, Symbol::Coordinate(i));
            let exact = g.evaluate(d, &value(at));
            let h = 1e-5;
            let (mut up, mut down) = (at, at);
            up[i] += h;
            down[i] -= h;
            let difference = (g.evaluate(e, &value(up)) - g.evaluate(e, &value(down))) / (2.0 * h);
            // acos of x*y and the like stay inside their domain at this point.
            if difference.is_finite() {
                assert!(
                    (exact - difference).abs() < 1e-8,
                    "{}: {exact} {difference}",
                    g.display(e, &name)
                );
            }
        }
    }
}

#[test]
fn substitution_rebuilds_in_normal_form() {
    let mut g = Graph::new();
    let [x, y, z] = xyz(&mut g);
    let e = g.power_product(&[(x, rational(2, 1)), (y, Rational::ONE)]);
    let image = g.substitute(&[e], &|s| (s == Symbol::Coordinate(1)).then_some(z))[0];
    assert_eq!(g.display(image, &name), "x^2*z");
}

#[test]
fn depth_does_not_exhaust_the_stack() {
    let mut g = Graph::new();
    let [x, ..] = xyz(&mut g);
    let mut e = x;
    for _ in 0..100_000 {
        e = g.call(Elementary::Sin, &[e]);
    }
    assert!(g.evaluate(e, &|_| 0.5).is_finite());
    assert!(g.symbols(e).contains(&Symbol::Coordinate(0)));
    assert!(!g.display(e, &name).is_empty());
}
