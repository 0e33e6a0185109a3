//! What a bracket that is declared by its entries is beyond that, found exactly, and what that brings.

pub(super) mod multiple;

use std::collections::BTreeSet;

use super::conjugate::conjugate;
use super::conjugate::integral::integral;
use super::elementwise::{Speed, elementwise, vanish};
use crate::model::{Bracket, Model, PoissonMatrix};
use lie_symbolic::exact::Budget;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for identities.
const WORK: u64 = 500_000;
/// Halves of more coordinates are not looked through.
const MOST: usize = 12;

/// A class of brackets, the first of these that one is in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Class {
    /// Every entry is constant.
    Constant,
    /// `{x_i, x_j} = c_ij x_i x_j`
    LogCanonical,
    /// `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`, with the texts of `int dx_i/a_i` where an `a_i` is neither constant nor linear.
    Elementwise(Vec<String>),
    /// Half of the coordinates, these positions, commute; their brackets with the others are constant, and those of the others functions of the
    /// positions: a particle in a magnetic field.
    Magnetic(Vec<usize>),
    /// In three dimensions `{f, g} = <grad C, grad f x grad g>`, with the text of C (Y. Nambu, Physical Review D 7 (1973) 2405–2412,
    /// doi:10.1103/PhysRevD.7.2405).
    Jacobian(String),
    /// Pairs `{x, y} = 1/B(x, y)` with a closed integral of B, beside elementwise brackets; the text of `int B dy` and of the pair for each.
    Conjugate(Vec<String>),
    /// Every entry is affine: that of a Lie algebra with a cocycle.
    Affine,
    /// In three dimensions a function times a Jacobian bracket, with the text of its Casimir.
    Multiple(String),
}

impl Class {
    /// Its name, for programs too.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::LogCanonical => "log-canonical",
            Self::Elementwise(_) => "elementwise",
            Self::Magnetic(_) => "magnetic",
            Self::Jacobian(_) => "Jacobian",
            Self::Conjugate(_) => "conjugate pairs",
            Self::Affine => "affine",
            Self::Multiple(_) => "multiple of Jacobian",
        }
    }

    /// What it is, and what it brings, as a clause.
    pub fn describe(&self, model: &Model) -> String {
        let names = |places: &[usize]| {
            let names = places.iter().map(|i| &*model.coordinates[*i].text);
            names.collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::Constant => "constant: functions of linear forms have exact flows".into(),
            Self::LogCanonical => {
                "log-canonical, {x_i, x_j} = c_ij x_i x_j: functions of monomials have exact flows, which keep signs; `canonical2` to `canonical6` are Gauss methods in logarithms, and Poisson maps; `lie canonical` writes the system in these".into()
            }
            Self::Elementwise(others) if others.is_empty() => {
                "elementwise, {x_i, x_j} = c_ij a_i(x_i) a_j(x_j): functions of sums of int dx_i/a_i have exact flows; `canonical2` to `canonical6` are Gauss methods in these, and Poisson maps; `lie canonical` writes the system in them".into()
            }
            Self::Elementwise(others) => format!(
                "elementwise, {{x_i, x_j}} = c_ij a_i(x_i) a_j(x_j): constant with int dx_i/a_i, which are {} among others; `canonical2` to `canonical6` are Gauss methods in these, and Poisson maps",
                others.join(", ")
            ),
            Self::Magnetic(positions) => format!(
                "magnetic, with the positions {}: functions of one momentum have exact flows, in a field that is no polynomial by quadrature",
                names(positions)
            ),
            Self::Jacobian(casimir) => format!("Jacobian, with the Casimir {casimir}"),
            Self::Multiple(casimir) => {
                format!("a function times a Jacobian one, with the Casimir {casimir}")
            }
            Self::Conjugate(integrals) => format!(
                "of conjugate pairs, {{x, y}} = 1/B(x, y): constant with {}; `canonical2` to `canonical6` are Gauss methods in these coordinates, and Poisson maps",
                integrals.join(", ")
            ),
            Self::Affine => {
                "affine: declared as an algebra with a cocycle it has every method of the algebra".into()
            }
        }
    }
}

/// The class of the bracket of a single system; none of a Lie–Poisson one, or where no class is found.
pub fn class(model: &Model) -> Option<Class> {
    let Bracket::General(matrix) = &model.bracket else {
        return None;
    };
    let others = model.family.is_some() || model.realization.is_some();
    if others || model.configuration.is_some() || model.constraint.is_some() {
        return None;
    }
    let mut graph = model.graph.clone();
    let name = |symbol| model.symbol_name(symbol);
    if let Some(found) = elementwise(model, matrix, &mut graph) {
        if found.is_constant() {
            return Some(Class::Constant);
        }
        if found.all(Speed::is_coordinate) {
            return Some(Class::LogCanonical);
        }
        let others = found.closed();
        let texts = others.map(|closed| graph.display(closed.integral, &name));
        let class = Class::Elementwise(texts.collect());
        // one entry may be that of a pair
        if found.is_affine() || matrix.entries.len() > 1 {
            return Some(class);
        }
        let mut own = graph.clone();
        let integrals = conjugate(model, &mut own).map(|found| found.integrals(&own, model));
        let integrals = integrals.filter(|integrals| !integrals.is_empty());
        return Some(integrals.map_or(class, Class::Conjugate));
    }
    let positions = magnetic(&graph, matrix).map(Class::Magnetic);
    let affine = || {
        matrix
            .degree
            .is_some_and(|degree| degree <= 1)
            .then_some(Class::Affine)
    };
    if positions.is_some() {
        return positions;
    }
    if let Some(casimir) = jacobian(model, matrix, &mut graph) {
        return Some(Class::Jacobian(graph.display(casimir, &name)));
    }
    affine()
        .or_else(|| {
            let integrals = conjugate(model, &mut graph)?.integrals(&graph, model);
            (!integrals.is_empty()).then_some(Class::Conjugate(integrals))
        })
        .or_else(|| {
            let casimir = multiple::casimir(model, matrix, &mut graph)?;
            Some(Class::Multiple(graph.display(casimir, &name)))
        })
}

/// The positions, if the bracket is that of a particle in a magnetic field.
fn magnetic(graph: &Graph, matrix: &PoissonMatrix) -> Option<Vec<usize>> {
    let n = matrix.dimension;
    if !n.is_multiple_of(2) || n > MOST {
        return None;
    }
    let in_entries = matrix.entries.iter();
    let needed: BTreeSet<usize> = in_entries
        .flat_map(|(.., entry)| graph.coordinates(*entry))
        .collect();
    let is_position = |set: u32, i: usize| set >> i & 1 == 1;
    let fits = |set: &u32| {
        needed.iter().all(|i| is_position(*set, *i))
            && matrix.entries.iter().all(|(i, j, entry)| {
                match (is_position(*set, *i), is_position(*set, *j)) {
                    (true, true) => false,
                    (false, false) => true,
                    _ => graph.coordinates(*entry).is_empty(),
                }
            })
    };
    let half = |set: &u32| set.count_ones() as usize == n / 2;
    let set = (0..1 << n).filter(half).find(fits)?;
    Some((0..n).filter(|i| is_position(set, *i)).collect())
}

/// The Casimir C with `w = (Pi_23, Pi_31, Pi_12) = grad C`.
pub(super) fn jacobian(model: &Model, matrix: &PoissonMatrix, graph: &mut Graph) -> Option<ExprId> {
    if matrix.dimension != 3 {
        return None;
    }
    let rows = matrix.rows(graph);
    gradient_of(model, &[rows[1][2], rows[2][0], rows[0][1]], graph)
}

/// The function whose gradient these are, by an integral over each coordinate of what the others leave; none where one of them is not closed.
fn gradient_of(model: &Model, w: &[ExprId; 3], graph: &mut Graph) -> Option<ExprId> {
    let mut sum = graph.integer(0);
    for (i, entry) in w.iter().enumerate() {
        let slope = graph.derivative(sum, Symbol::Coordinate(i));
        let rest = graph.sub(*entry, slope);
        let rest = graph.normal(rest);
        if !graph.is_zero(rest) {
            let integral = integral(graph, rest, i)?;
            sum = graph.add(sum, integral);
        }
    }
    let differences: Vec<ExprId> = (w.iter().enumerate())
        .map(|(i, entry)| {
            let slope = graph.derivative(sum, Symbol::Coordinate(i));
            graph.sub(slope, *entry)
        })
        .collect();
    let budget = Budget::new(WORK);
    vanish(model, graph, w, &differences, &budget).then_some(sum)
}

#[cfg(test)]
mod tests;
