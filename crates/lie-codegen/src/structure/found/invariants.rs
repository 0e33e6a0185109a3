//! Casimirs of the algebra and of its subalgebras, as arguments of pieces.
//!
//! A function on the dual of a subalgebra h, spanned by some basis elements, is one on g* of these coordinates. A Casimir c of h
//! commutes with all of them, so that they, and with them the gradient of c, are constant along the flow of c, which is
//! `exp(t ad*_(grad c(mu))) mu`. Casimirs of subalgebras one inside the other commute. That of so(3) in se(3), `|m|^2`, is no Casimir of se(3): its
//! flow turns the other vector about m. With h = g nothing moves.
//!
//! Where H contains such a function, or a part of H is a multiple of one, a symbol takes its place.
//!
//! Source: A. Thimm, "Integrable geodesic flows on homogeneous spaces", Ergodic Theory and Dynamical Systems 1 (1981) 495–517,
//! doi:10.1017/S0143385700001401.

use std::collections::BTreeSet;

use super::additive;
use crate::algebra::{StructureConstants, rank};
use crate::model::{self, Algebra};
use crate::structure::casimirs::{self, Casimir};
use lie_symbolic::exact::{Fraction, Polynomial, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// The first symbol of a Casimir, beyond those of all arguments and definitions of kernels.
const FIRST: usize = 1 << 26;
/// Casimirs of the algebra of a higher degree are left alone.
const HIGHEST: u32 = 4;
/// Larger subalgebras are left alone.
const LARGEST: usize = 10;
/// More Casimirs are not looked at.
const MOST: usize = 12;
/// Work allowed for the Casimirs of one subalgebra.
const WORK: u64 = 50_000;

/// A Casimir of the algebra or of a subalgebra.
#[derive(Clone, Debug)]
pub(super) struct Invariant {
    /// What stands for it.
    pub symbol: Symbol,
    /// The function in normal form.
    pub value: ExprId,
    /// Its coordinates.
    pub support: Vec<usize>,
    /// The coordinates that its flow moves: none of a Casimir of the algebra.
    pub moved: Vec<usize>,
    /// Whether it is a quadratic form.
    pub quadratic: bool,
}

/// The Casimirs of the model that are polynomials, and quadratic ones of subalgebras in the coordinates of H.
pub(super) fn collect(
    casimirs: &[model::Casimir],
    algebra: &Algebra,
    graph: &mut Graph,
    h: ExprId,
) -> Vec<Invariant> {
    let mut all = Vec::new();
    for casimir in casimirs {
        if casimir.degree.is_some_and(|d| (2..=HIGHEST).contains(&d)) {
            let value = graph.normal(casimir.expr);
            add(&mut all, algebra, graph, value, casimir.degree == Some(2));
        }
    }
    let inside: BTreeSet<usize> = graph.coordinates(h).into_iter().collect();
    for elements in subalgebras(algebra, &inside) {
        for function in quadratic_casimirs(algebra, &elements) {
            let value = expression(graph, &function, &elements);
            add(&mut all, algebra, graph, value, true);
        }
    }
    all
}

fn add(
    all: &mut Vec<Invariant>,
    algebra: &Algebra,
    graph: &mut Graph,
    value: ExprId,
    quadratic: bool,
) {
    if all.len() >= MOST || all.iter().any(|known| known.value == value) {
        return;
    }
    let n = algebra.basis.len();
    let moved: Vec<usize> = (0..n)
        .filter(|i| !commutes_with(algebra, graph, value, *i))
        .collect();
    all.push(Invariant {
        symbol: Symbol::Input(FIRST + all.len()),
        value,
        support: graph.coordinates(value),
        moved,
        quadratic,
    });
}

/// `{f, x_i}` is zero: `sum_j df/dx_j Pi_ji` with `Pi_ji = C_ij^k mu_k`.
fn commutes_with(algebra: &Algebra, graph: &mut Graph, f: ExprId, i: usize) -> bool {
    let mut terms = Vec::new();
    for (a, b, k, constant) in algebra.constants.entries() {
        let (j, sign) = match i {
            _ if i == *a => (*b, Rational::ONE),
            _ if i == *b => (*a, Rational::MINUS_ONE),
            _ => continue,
        };
        let slope = graph.derivative(f, Symbol::Coordinate(j));
        if !graph.is_zero(slope) {
            let mu = graph.symbol(Symbol::Coordinate(*k));
            let term = graph.product(&[slope, *constant, mu]);
            terms.push(graph.scale(term, &sign));
        }
    }
    vanishes(graph, &terms)
}

/// Whether a sum of polynomials is seen to be zero.
fn vanishes(graph: &mut Graph, terms: &[ExprId]) -> bool {
    let sum = graph.sum(terms);
    let collected = additive::collected(graph, sum);
    collected.is_some_and(|(constant, terms)| constant.is_zero() && terms.is_empty())
}

/// Whether two of them commute.
pub(super) fn commute(
    algebra: &Algebra,
    graph: &mut Graph,
    one: &Invariant,
    other: &Invariant,
) -> bool {
    let apart = |one: &Invariant, other: &Invariant| {
        let mut moved = one.moved.iter();
        !moved.any(|i| other.support.contains(i))
    };
    if apart(one, other) || apart(other, one) {
        return true;
    }
    let mut terms = Vec::new();
    for (i, j, k, constant) in algebra.constants.entries() {
        for (i, j, sign) in [(*i, *j, Rational::MINUS_ONE), (*j, *i, Rational::ONE)] {
            let f = graph.derivative(one.value, Symbol::Coordinate(i));
            let g = graph.derivative(other.value, Symbol::Coordinate(j));
            let mu = graph.symbol(Symbol::Coordinate(*k));
            let term = graph.product(&[f, g, *constant, mu]);
            terms.push(graph.scale(term, &sign));
        }
    }
    vanishes(graph, &terms)
}

/// The subalgebras that two basis elements generate, spanned by basis elements, with coordinates of H alone.
fn subalgebras(algebra: &Algebra, inside: &BTreeSet<usize>) -> Vec<Vec<usize>> {
    let n = algebra.basis.len();
    let mut all: Vec<Vec<usize>> = Vec::new();
    for (i, j, ..) in algebra.exact.entries() {
        let known = all.iter().any(|s| s.contains(i) && s.contains(j));
        if known || all.len() >= 2 * MOST {
            continue;
        }
        let elements = closure(algebra, [*i, *j]);
        if elements.len() < n && elements.len() <= LARGEST && elements.is_subset(inside) {
            all.push(elements.into_iter().collect());
        }
    }
    all
}

/// The least set of basis elements with two of them that spans a subalgebra.
fn closure(algebra: &Algebra, generators: [usize; 2]) -> BTreeSet<usize> {
    let mut set = BTreeSet::from(generators);
    loop {
        let before = set.len();
        for (i, j, k, _) in algebra.exact.entries() {
            if set.contains(i) && set.contains(j) {
                set.insert(*k);
            }
        }
        if set.len() == before {
            return set;
        }
    }
}

/// The quadratic Casimirs of the subalgebra of some basis elements.
fn quadratic_casimirs(algebra: &Algebra, elements: &[usize]) -> Vec<Polynomial> {
    let m = elements.len();
    let place = |i: &usize| elements.iter().position(|element| element == i);
    let entries = algebra.exact.entries().iter();
    let entries: Vec<(usize, usize, usize, Fraction)> = entries
        .filter_map(|(i, j, k, value)| Some((place(i)?, place(j)?, place(k)?, value.clone())))
        .collect();
    let constants = StructureConstants::new(m, entries);
    let wanted = m - rank::generic_rank(&constants, m);
    let found = casimirs::find(&constants, wanted, casimirs::Kind::LINEAR, WORK);
    let quadratic = found
        .casimirs
        .into_iter()
        .filter_map(|casimir| match casimir {
            Casimir::Polynomial(function) => Some(function),
            Casimir::Rational(_) => None,
        });
    let degree = |function: &Polynomial| {
        let of = |m2: &lie_symbolic::exact::Monomial| -> u32 {
            m2.powers().filter(|(v, _)| *v < m).map(|(_, e)| e).sum()
        };
        function.terms().map(|(monomial, _)| of(monomial)).max()
    };
    quadratic
        .filter(|function| degree(function) == Some(2))
        .collect()
}

/// A polynomial in the coordinates of some elements, and parameters behind them.
fn expression(graph: &mut Graph, function: &Polynomial, elements: &[usize]) -> ExprId {
    let mut terms = Vec::new();
    for (monomial, coefficient) in function.terms() {
        let powers = monomial.powers().map(|(v, e)| {
            let symbol = match elements.get(v) {
                Some(i) => Symbol::Coordinate(*i),
                None => Symbol::Parameter(v - elements.len()),
            };
            (symbol, Rational::from(i64::from(e)))
        });
        let powers: Vec<(Symbol, Rational)> = powers.collect();
        let powers: Vec<(ExprId, Rational)> = powers
            .into_iter()
            .map(|(symbol, e)| (graph.symbol(symbol), e))
            .collect();
        terms.push((graph.power_product(&powers), coefficient.clone()));
    }
    let sum = graph.linear(&terms);
    graph.normal(sum)
}
