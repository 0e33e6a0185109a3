//! Functions a of one coordinate with a closed integral `int dx/a`: rational ones, powers of polynomials of degree 1 and 2, and elementary
//! functions of `a x + b`.

use super::factors;
use super::partial_fractions::{Coefficients, half, integral, logarithm, times};
use crate::structure::conjugate::integral::slope_of;
use lie_symbolic::exact::{Fraction, Polynomial, Rational};
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};

/// A function with its integral.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    /// `a(x)`
    pub speed: ExprId,
    /// `int dx/a(x)`
    pub integral: ExprId,
    /// What two states have in common that are on one side of the zeros and poles of a; of all others one of these is different.
    pub sides: Vec<Side>,
}

/// What is the same for states between which no motion passes through a zero or a pole.
#[derive(Clone, Debug, PartialEq)]
pub enum Side {
    /// The sign of this.
    Sign(ExprId),
    /// This, but for less than pi.
    Turn(ExprId),
}

/// The function of the coordinate i, with no other symbol; none where its integral has no such form.
pub(super) fn closed(graph: &mut Graph, speed: ExprId, i: usize) -> Option<Closed> {
    let only = graph.symbols(speed);
    if only.iter().any(|symbol| *symbol != Symbol::Coordinate(i)) {
        return None;
    }
    let x = graph.symbol(Symbol::Coordinate(i));
    if let Some((numerator, denominator)) = rational(graph, speed) {
        let (value, sides) = integral(&denominator, &numerator, x, graph)?;
        return Some(Closed {
            speed,
            integral: value,
            sides,
        });
    }
    let (number, product) = graph.coefficient(speed);
    let factors = factors(graph, product);
    let [(base, exponent)] = &factors[..] else {
        return None;
    };
    let (value, sides) = match graph.node(*base).clone() {
        Node::Call(Function::Elementary(function), arguments) => {
            let argument = arguments[0];
            let slope = slope_of(graph, argument, i)?;
            let power = exponent.to_integer()?;
            let (value, sides) = of_function(graph, function, argument, power)?;
            (graph.scale(value, &slope.recip()?), sides)
        }
        _ => of_power(graph, *base, exponent, i)?,
    };
    Some(Closed {
        speed,
        integral: graph.scale(value, &number.recip()?),
        sides,
    })
}

/// The numerator and the denominator of a rational function of one variable with numbers as coefficients.
fn rational(graph: &mut Graph, speed: ExprId) -> Option<(Coefficients, Coefficients)> {
    let variable = graph.symbol(Symbol::Parameter(0));
    let there = graph.substitute(&[speed], &|symbol| {
        matches!(symbol, Symbol::Coordinate(_)).then_some(variable)
    })[0];
    let fraction: Fraction = graph.fraction(there, None)?;
    let mut below = vec![Rational::ONE];
    for (factor, power) in fraction.denominator() {
        for _ in 0..power {
            below = times(&below, &coefficients(factor));
        }
    }
    Some((coefficients(fraction.numerator()), below))
}

fn coefficients(polynomial: &Polynomial) -> Coefficients {
    let degree = polynomial.degree() as usize;
    let mut all = vec![Rational::ZERO; degree + 1];
    for (monomial, coefficient) in polynomial.terms() {
        all[monomial.degree() as usize] = coefficient.clone();
    }
    all
}

/// `int du/f(u)^e`
fn of_function(
    graph: &mut Graph,
    function: Elementary,
    u: ExprId,
    e: i64,
) -> Option<(ExprId, Vec<Side>)> {
    use Elementary::{Atan, Cos, Cosh, Exp, Log, Sin, Sinh, Tan, Tanh};
    let of = |graph: &mut Graph, function: Elementary| graph.call(function, &[u]);
    let [sine, cosine] = [Sin, Cos].map(|function| of(graph, function));
    let middle = graph.scale(u, &half());
    let turns = |between: &[ExprId]| {
        let signs = between.iter().map(|value| Side::Sign(*value));
        signs.chain([Side::Turn(u)]).collect::<Vec<Side>>()
    };
    let sign = || vec![Side::Sign(u)];
    Some(match (function, e) {
        (Exp, e) => {
            let factor = Rational::from(-e);
            let exponent = graph.scale(u, &factor);
            let grown = graph.call(Exp, &[exponent]);
            (graph.scale(grown, &factor.recip()?), Vec::new())
        }
        (Cosh, 1) => {
            let inside = of(graph, Sinh);
            (graph.call(Atan, &[inside]), Vec::new())
        }
        (Cosh, 2) => (of(graph, Tanh), Vec::new()),
        (Cosh, -1) => (of(graph, Sinh), Vec::new()),
        (Sinh, 1) => {
            let inside = graph.call(Tanh, &[middle]);
            (logarithm(graph, inside), sign())
        }
        (Sinh, 2) => (negative_inverse(graph, Tanh, u), sign()),
        (Sinh, -1) => (of(graph, Cosh), sign()),
        (Tanh, 1) => {
            let inside = of(graph, Sinh);
            (logarithm(graph, inside), sign())
        }
        (Tanh, -1) => {
            let inside = of(graph, Cosh);
            (graph.call(Log, &[inside]), sign())
        }
        (Sin, 1) => {
            let inside = graph.call(Tan, &[middle]);
            (logarithm(graph, inside), turns(&[sine]))
        }
        (Sin, 2) => (negative_inverse(graph, Tan, u), turns(&[sine])),
        (Sin, -1) => (graph.neg(cosine), turns(&[sine])),
        (Cos, 1) => {
            let one = graph.integer(1);
            let above = graph.add(one, sine);
            let inside = graph.div(above, cosine);
            (logarithm(graph, inside), turns(&[cosine]))
        }
        (Cos, 2) => (of(graph, Tan), turns(&[cosine])),
        (Cos, -1) => (sine, turns(&[cosine])),
        (Tan, 1 | -1) => {
            let value = logarithm(graph, if e == 1 { sine } else { cosine });
            (
                graph.scale(value, &Rational::from(e)),
                turns(&[sine, cosine]),
            )
        }
        _ => return None,
    })
}

/// `-1/f(u)`
fn negative_inverse(graph: &mut Graph, function: Elementary, u: ExprId) -> ExprId {
    let value = graph.call(function, &[u]);
    let inverse = graph.pow(value, &Rational::from(-1));
    graph.neg(inverse)
}

/// `int dx/p^e` for a polynomial p of degree 1, or of degree 2 and e = 1/2 or 3/2.
fn of_power(
    graph: &mut Graph,
    base: ExprId,
    e: &Rational,
    i: usize,
) -> Option<(ExprId, Vec<Side>)> {
    let (polynomial, _) = rational(graph, base).filter(|(_, below)| below.len() == 1)?;
    if let Some(slope) = slope_of(graph, base, i) {
        let above = &Rational::ONE - e;
        let power = graph.pow(base, &above);
        let factor = (&above * &slope).recip()?;
        return Some((graph.scale(power, &factor), vec![Side::Sign(base)]));
    }
    let [c, b, a] = &polynomial[..] else {
        return None;
    };
    // w = 4 a c - b^2, without which the polynomial is a square
    let width = &(&(a * c) * &Rational::from(4)) - &(b * b);
    if width.is_zero() {
        return None;
    }
    let slope = graph.derivative(base, Symbol::Coordinate(i));
    let sides = match (a.is_negative(), width.is_negative()) {
        (false, false) => Vec::new(),
        (false, true) => vec![Side::Sign(slope)],
        (true, _) => vec![Side::Sign(base)],
    };
    let root = |graph: &mut Graph, value: Rational| {
        let value = graph.number(value);
        graph.pow(value, &half())
    };
    let along = graph.pow(base, &half());
    if *e == &half() + &Rational::ONE {
        let ratio = graph.div(slope, along);
        let factor = &Rational::from(2) / &width;
        return Some((graph.scale(ratio, &factor), sides));
    }
    if *e != half() {
        return None;
    }
    let lead = root(graph, a.abs());
    let size = root(graph, width.abs());
    let value = match (a.is_negative(), width.is_negative()) {
        (false, false) => {
            let inside = graph.div(slope, size);
            graph.call(Elementary::Asinh, &[inside])
        }
        // the sign of u times acosh |u|, where no digits are lost
        (false, true) => {
            let u = graph.div(slope, size);
            let square = graph.pow(u, &Rational::from(-2));
            let one = graph.integer(1);
            let rest = graph.sub(one, square);
            let root = graph.pow(rest, &half());
            let inside = graph.mul(u, root);
            graph.call(Elementary::Asinh, &[inside])
        }
        (true, _) => {
            let inside = graph.div(slope, size);
            let angle = graph.call(Elementary::Asin, &[inside]);
            graph.neg(angle)
        }
    };
    Some((graph.div(value, lead), sides))
}
