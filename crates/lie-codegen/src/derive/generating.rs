//! Generating functions of Lie–Poisson steps and their derivatives.
//!
//! With `xi = grad H`, `X = ad*_xi p`, `X2 = ad*_xi X` and `w = H''(p) X`:
//!
//! - exp: `S3 = H''(X, X)/24` and, with `eta = 24 grad S3` and `Y = ad*_w p`,
//!   `S5 = (-4 <X2 + 3 Y, eta> + 4 H''(X2, X2) + 12 H'''(X, X, X2) + 3 H''''(X, X, X, X))/5760`;
//! - on the realization of any bracket the same with `X = Pi xi`, `X2 = Pi'[X] xi`, `Y = Pi w`, and `12 <w, Pi''[X, X] xi>` in S5;
//! - Cayley: `S3 = H''(X, X)/24 - <p, T(xi, xi, xi)>/12`;
//! - coordinates of the second kind: `S2 = sum_(i<j) H_i H_j C_ji^k p_k/2`.
//!
//! The term `H''(X, ad*_eta p)` of S5 is written `<p, [eta, w]> = -<Y, eta>`.

use super::field::mu;
use super::leaner::{Derived, leaner_jacobian};
use super::tape::{Tangents, Tape};
use super::{Argument, Kernel, Source};
use crate::methods::Retraction;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// The generating function of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Generating {
    /// In coordinates of the first kind by a retraction, to an order of 4 or 6; by exp of a bracket that is not that of an algebra in
    /// those of its symplectic realization.
    First(Retraction, u32),
    /// In coordinates of the second kind, order 2.
    Second,
}

/// The gradient of S at p as definitions and results.
pub(crate) struct Slope {
    pub(crate) tape: Tape,
    /// `grad S`.
    pub(crate) entries: Vec<ExprId>,
}

fn rational(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator, denominator).unwrap_or(Rational::ONE)
}

/// `sum_i a_i b_i`
fn dot(source: &mut Source, a: &[ExprId], b: &[ExprId]) -> ExprId {
    let terms: Vec<ExprId> = a
        .iter()
        .zip(b)
        .map(|(a, b)| source.graph.mul(*a, *b))
        .collect();
    source.graph.sum(&terms)
}

/// The derivatives of functions of the coordinates along a vector of opaque quantities.
fn along(
    source: &mut Source,
    tape: &mut Tape,
    functions: &[ExprId],
    direction: &[ExprId],
) -> Vec<ExprId> {
    functions
        .iter()
        .map(|function| {
            let slopes: Vec<ExprId> = (0..source.dimension)
                .map(|i| tape.slope(source, *function, Symbol::Coordinate(i)))
                .collect();
            dot(source, &slopes, direction)
        })
        .collect()
}

/// `h^power/denominator`
fn power_of_step(source: &mut Source, power: i64, denominator: i64) -> ExprId {
    let h = source.graph.symbol(Symbol::Step);
    let power = source.graph.pow(h, &Rational::from(power));
    source.graph.scale(power, &rational(1, denominator))
}

/// The gradient of S.
pub(crate) fn slope(source: &mut Source, generating: Generating) -> Slope {
    let n = source.dimension;
    // vectors of the algebra, the unknown and the midpoint have symbols of their own
    let mut tape = Tape::new(source, 4 * n);
    let gradient = source.gradient_of_h();
    let mut weighted: Vec<(ExprId, Vec<ExprId>)> = Vec::new();
    let h = source.graph.symbol(Symbol::Step);
    weighted.push((h, gradient.clone()));
    match generating {
        Generating::Second => {
            let second = second_order(source, &mut tape);
            let slope = tape.gradient(source, second);
            weighted.push((power_of_step(source, 2, 2), slope));
        }
        Generating::First(retraction, order) => {
            // powers of h apart from what they multiply would leave the range of numbers at order 6: S5 has that of h H
            let (unit, mut field) = (order == 6, source.field());
            let mut gradient = gradient;
            if unit {
                for entry in gradient.iter_mut().chain(&mut field) {
                    *entry = source.graph.mul(h, *entry);
                }
            }
            let power = |source: &mut Source, power, denominator| {
                power_of_step(source, if unit { 0 } else { power }, denominator)
            };
            let x = tape.define_all(source, &field);
            let w = along(source, &mut tape, &gradient, &x);
            let w = tape.define_all(source, &w);
            let mut third = dot(source, &w, &x);
            if retraction == Retraction::Cayley {
                let cubic = cubic_term(source, &mut tape);
                third = source
                    .graph
                    .linear(&[(third, Rational::ONE), (cubic, Rational::from(-2))]);
            }
            let eta = tape.gradient(source, third);
            let eta = tape.define_all(source, &eta);
            weighted.push((power(source, 3, 24), eta.clone()));
            if order == 6 {
                let fifth = fifth_order(source, &mut tape, &gradient, [&x, &w, &eta]);
                let slope = tape.gradient(source, fifth);
                weighted.push((power(source, 5, 5760), slope));
            }
        }
    }
    let entries: Vec<ExprId> = (0..n)
        .map(|i| {
            let terms: Vec<ExprId> = weighted
                .iter()
                .map(|(weight, slope)| source.graph.mul(*weight, slope[i]))
                .collect();
            source.graph.sum(&terms)
        })
        .collect();
    Slope { tape, entries }
}

/// `2 S2 = sum_(i<j) H_i H_j C_ji^k p_k`
fn second_order(source: &mut Source, tape: &mut Tape) -> ExprId {
    let gradient = source.gradient_of_h();
    let xi = tape.define_all(source, &gradient);
    let p = source.coordinates();
    let mut terms = Vec::new();
    for (i, j, k, value) in source.constants().to_vec() {
        let term = source.graph.product(&[value, xi[i], xi[j], p[k]]);
        terms.push((term, Rational::MINUS_ONE));
    }
    source.graph.linear(&terms)
}

/// `<p, T(xi, xi, xi)>` with `xi = grad H`
fn cubic_term(source: &mut Source, tape: &mut Tape) -> ExprId {
    let gradient = source.gradient_of_h();
    let xi = tape.define_all(source, &gradient);
    let p = source.coordinates();
    let product = super::cayley::triple_of(source, &xi, &xi, &p);
    dot(source, &xi, &product)
}

/// `5760 S5` in exponential coordinates for a gradient, given X, w and `eta = 24 grad S3`.
fn fifth_order(
    source: &mut Source,
    tape: &mut Tape,
    gradient: &[ExprId],
    [x, w, eta]: [&[ExprId]; 3],
) -> ExprId {
    let p = source.coordinates();
    let xi = tape.define_all(source, gradient);
    let (x2, y, bent) = match source.is_lie() {
        true => (source.ad_star_of(&xi, x), source.ad_star_of(w, &p), None),
        false => {
            // with xi held
            let field = against(source, &xi);
            let once = along(source, tape, &field, x);
            let twice = along(source, tape, &once, x);
            (once, against(source, w), Some(dot(source, w, &twice)))
        }
    };
    let x2 = tape.define_all(source, &x2);
    let moved: Vec<ExprId> = x2
        .iter()
        .zip(&y)
        .map(|(x2, y)| {
            source
                .graph
                .linear(&[(*x2, Rational::ONE), (*y, Rational::from(3))])
        })
        .collect();
    let moved = tape.define_all(source, &moved);
    let first = dot(source, &moved, eta);
    let along_x2 = along(source, tape, gradient, &x2);
    let square = dot(source, &along_x2, &x2);
    let once = along(source, tape, gradient, x);
    let twice = along(source, tape, &once, x);
    let cubic = dot(source, &twice, &x2);
    let thrice = along(source, tape, &twice, x);
    let quartic = dot(source, &thrice, x);
    let mut terms = vec![
        (first, Rational::from(-4)),
        (square, Rational::from(4)),
        (cubic, Rational::from(12)),
        (quartic, Rational::from(3)),
    ];
    terms.extend(bent.map(|bent| (bent, Rational::from(12))));
    source.graph.linear(&terms)
}

/// `Pi v`
fn against(source: &mut Source, v: &[ExprId]) -> Vec<ExprId> {
    let matrix = source.poisson_matrix();
    matrix.iter().map(|row| dot(source, row, v)).collect()
}

/// The kernels of a generating function.
pub struct Function {
    /// `grad S`.
    pub gradient: Kernel,
    /// `grad S` and the Hessian; `None` where it swells.
    pub linearize: Option<Kernel>,
    /// Whether each entry of the Hessian can be nonzero.
    pub pattern: Vec<Vec<bool>>,
}

/// The arena of a function that is written out, nodes and operands together: seconds of scheduling,
/// not minutes. Order 6 on su(3) takes 40 000.
pub(super) const MOST_SCHEDULED: usize = 60_000;

/// Whether what was derived is no good, or too much to be written out.
pub(super) fn too_large(source: &Source, tape: &Tape) -> bool {
    tape.is_beyond(source, MOST_SCHEDULED)
}

/// `grad S` and the Hessian of S; `None` where already the gradient swells.
pub(super) fn function(source: &mut Source, generating: Generating) -> Option<Function> {
    let n = source.dimension;
    let Slope { mut tape, entries } = slope(source, generating);
    if too_large(source, &tape) {
        return None;
    }
    let p = Argument {
        name: "p",
        symbols: mu(source).symbols,
    };
    let gradient = Kernel::vector(
        &source.graph,
        "gradient",
        "`xi = grad S(p)`",
        vec![p.clone()],
        &entries,
    )
    .within_step(tape.definitions().to_vec());
    let hessian = symmetric(leaner_jacobian(
        source,
        &mut tape,
        &entries,
        &p.symbols,
        Tangents::Named,
        &|_, derived| Derived {
            rows: symmetric(derived.rows),
            ..derived
        },
    ));
    if too_large(source, &tape) {
        return Some(Function {
            gradient,
            linearize: None,
            pattern: vec![vec![true; n]; n],
        });
    }
    let linearize = Kernel::fused(
        &source.graph,
        "linearize",
        "`xi = grad S(p)` and the Hessian of S",
        vec![p],
        &entries,
        &hessian,
    )
    .within_step(tape.definitions().to_vec());
    let pattern = hessian
        .iter()
        .map(|row| row.iter().map(|e| !source.graph.is_zero(*e)).collect())
        .collect();
    Some(Function {
        gradient,
        linearize: Some(linearize),
        pattern,
    })
}

/// The lower half as the mirror of the upper, so that each entry is computed once.
pub(crate) fn symmetric(mut rows: Vec<Vec<ExprId>>) -> Vec<Vec<ExprId>> {
    for i in 1..rows.len() {
        let (above, below) = rows.split_at_mut(i);
        for (entry, row) in below[0].iter_mut().zip(above.iter()) {
            *entry = row[i];
        }
    }
    rows
}
