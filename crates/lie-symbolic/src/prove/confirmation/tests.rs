use super::*;

fn finding(build: impl Fn(&mut Graph, [ExprId; 2]) -> ExprId) -> Finding {
    let mut graph = Graph::new();
    let x = graph.symbol(Symbol::Coordinate(0));
    let y = graph.symbol(Symbol::Coordinate(1));
    let id = build(&mut graph, [x, y]);
    Confirmation::new(&graph, &[]).check_zero(id)
}

fn half() -> Rational {
    Rational::new(1, 2).unwrap()
}

#[test]
fn rational_functions_are_looked_at_in_a_field() {
    // (x + y)(x - y) - x^2 + y^2, and with one sign changed
    for (sign, expected) in [(1, Finding::Zero), (-1, Finding::Nonzero)] {
        let found = finding(|g, [x, y]| {
            let (sum, difference) = (g.add(x, y), g.sub(x, y));
            let product = g.mul(sum, difference);
            let (xx, yy) = (g.pow(x, &2.into()), g.pow(y, &2.into()));
            let one = Rational::ONE;
            g.linear(&[(product, one), (xx, Rational::MINUS_ONE), (yy, sign.into())])
        });
        assert_eq!(found, expected);
    }
}

#[test]
fn both_sides_of_a_branch_are_reached() {
    // sqrt((x - y)^2) is x - y on one side and y - x on the other
    for sign in [1, -1] {
        let found = finding(|g, [x, y]| {
            let difference = g.sub(x, y);
            let square = g.pow(difference, &2.into());
            let root = g.pow(square, &half());
            g.linear(&[(root, Rational::ONE), (difference, sign.into())])
        });
        assert_eq!(found, Finding::Nonzero);
    }
    // on the domain of log(x - y) there is one side only
    let found = finding(|g, [x, y]| {
        let difference = g.sub(x, y);
        let square = g.pow(difference, &2.into());
        let root = g.pow(square, &half());
        let logarithm = g.call(Elementary::Log, &[difference]);
        let zero = g.sub(root, difference);
        g.mul(zero, logarithm)
    });
    assert_eq!(found, Finding::Zero);
}

#[test]
fn an_empty_domain_shows_nothing() {
    let found = finding(|g, [x, _]| {
        let square = g.pow(x, &2.into());
        let negative = g.neg(square);
        g.call(Elementary::Log, &[negative])
    });
    assert_eq!(found, Finding::Unknown);
}

#[test]
fn degrees_are_looked_at_along_lines() {
    let mut g = Graph::new();
    let x = g.symbol(Symbol::Coordinate(0));
    let y = g.symbol(Symbol::Coordinate(1));
    // exp(3/2 log(x^2)) = |x|^3 is x^3 on either side only
    let square = g.pow(x, &2.into());
    let logarithm = g.call(Elementary::Log, &[square]);
    let scaled = g.scale(logarithm, &Rational::new(3, 2).unwrap());
    let cube = g.call(Elementary::Exp, &[scaled]);
    let whole = g.mul(cube, y);
    let mut confirmation = Confirmation::new(&g, &[]);
    for (degree, expected) in [
        (2, Finding::Nonzero),
        (3, Finding::Nonzero),
        (4, Finding::Zero),
    ] {
        assert_eq!(confirmation.check_degree(whole, degree), expected);
    }
}

#[test]
fn the_smallest_difference_is_seen() {
    // sin^2 + cos^2 - 1 + 10^-50
    let found = finding(|g, [x, _]| {
        let (sine, cosine) = (g.call(Elementary::Sin, &[x]), g.call(Elementary::Cos, &[x]));
        let (a, b) = (g.pow(sine, &2.into()), g.pow(cosine, &2.into()));
        let small = Rational::from(10).pow(-50).unwrap();
        let rest = g.number(&small - &Rational::ONE);
        g.sum(&[a, b, rest])
    });
    assert_eq!(found, Finding::Nonzero);
}
