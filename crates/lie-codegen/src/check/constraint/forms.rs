//! Constraints as linear forms on the algebra, and the subspace that they leave.
//!
//! The forms are reduced exactly, over the rational functions of the parameters, until each has a component that no other one has:
//! `xi_p + sum_f R_pf xi_f = 0`, with pivots p and the free components f. The elements `e_f - sum_p R_pf e_p` are a basis of the
//! subspace D. The last component of a form that can be a pivot is one, so that the first names of a declaration stay.

use super::super::coordinates::Whole;
use super::super::environment::{Allowed, Environment};
use super::super::lower::Lowering;
use crate::model::{Configuration, Parameter};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_symbolic::prove::degree::degree;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Constraint;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Work allowed for the elimination.
const WORK: u64 = 2_000_000;
/// A coefficient below that part of the largest at the default parameters is no pivot there.
const SINGULAR: f64 = 1e-13;

/// What the constraints leave of the algebra.
#[derive(Clone, Debug)]
pub struct Distribution {
    /// The components that the constraints determine, one for each, ascending.
    pub pivots: Vec<usize>,
    /// The others, ascending.
    pub free: Vec<usize>,
    /// `R_pf`, by the places of p and f in these lists.
    pub ratios: Vec<Vec<Fraction>>,
    /// The coefficients of the equations as they are declared, one for each component.
    pub declared: Vec<Vec<Fraction>>,
    /// Where the constraints stand.
    pub origin: Origin,
}

/// The subspace of a declaration; `Some(None)` where nothing is constrained.
pub fn distribution(
    whole: &Whole<'_>,
    graph: &mut Graph,
    environment: &Environment<'_>,
    parameters: &[Parameter],
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Option<Distribution>> {
    let declaration = &*whole.declaration;
    let [first, ..] = declaration.constraint.as_slice() else {
        return Some(None);
    };
    // the time and the group element are coordinates behind those of the declared algebra
    let configuration = whole.configuration.as_ref();
    let own = configuration.map_or(declaration.dimension(), Configuration::own_momenta);
    let names = environment.of_velocity(declaration, own);
    let mut rows = Vec::new();
    let mut complete = true;
    for constraint in &declaration.constraint {
        match row(constraint, own, graph, &names, mistakes) {
            Some(row) => rows.push((row, constraint.origin)),
            None => complete = false,
        }
    }
    if !complete {
        return None;
    }
    let elimination = Elimination {
        value: &|graph, fraction| {
            let value = graph.rational_function(fraction);
            graph.evaluate(value, &|symbol| match symbol {
                Symbol::Parameter(p) => parameters.get(p).map_or(f64::NAN, |p| p.default_value),
                _ => f64::NAN,
            })
        },
        budget: Budget::new(WORK),
        own,
    };
    let declared = rows.iter().map(|(row, _)| row.clone()).collect();
    match elimination.reduce(rows, graph) {
        Ok((pivots, rows)) => {
            let free: Vec<usize> = (0..own).filter(|i| !pivots.contains(i)).collect();
            if free.is_empty() {
                mistakes.push(at_rest(first.origin));
                return None;
            }
            let ratios = rows.iter();
            let ratios = ratios.map(|row| free.iter().map(|f| row[*f].clone()).collect());
            Some(Some(Distribution {
                ratios: ratios.collect(),
                declared,
                pivots,
                free,
                origin: first.origin,
            }))
        }
        Err(mistake) => {
            mistakes.push(mistake);
            None
        }
    }
}

/// The coefficients of a form.
fn row(
    constraint: &Constraint,
    own: usize,
    graph: &mut Graph,
    names: &Environment<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<Fraction>> {
    let mut lower = |side| Lowering::new(graph, names, mistakes, Allowed::Constraint).lower(side);
    let (left, right) = (lower(&constraint.left), lower(&constraint.right));
    let difference = graph.sub(left?, right?);
    // of a polynomial in the components: those are coordinates for a moment
    let as_coordinates = |graph: &mut Graph, id: ExprId| {
        let inputs: Vec<ExprId> = (0..own)
            .map(|i| graph.symbol(Symbol::Coordinate(i)))
            .collect();
        let replaced = graph.substitute(&[id], &|symbol| match symbol {
            Symbol::Input(i) => inputs.get(i).copied(),
            _ => None,
        });
        replaced[0]
    };
    let form = as_coordinates(graph, difference);
    let mut wrong = |message: String, help: &str| {
        let mistake = Diagnostic::new(Kind::Constraint, constraint.origin, message);
        mistakes.push(mistake.help(help));
        None
    };
    if degree(graph, form).is_none_or(|degree| degree > 1) {
        let message = "a constraint is linear in the velocity, and this one is not";
        return wrong(
            message.into(),
            "write a linear form that is zero, such as `e1 - 2*e2 = 0`",
        );
    }
    let zero = Some(Rational::ZERO);
    let constant = graph.fraction(form, zero.clone());
    let mut coefficients = Vec::new();
    for i in 0..own {
        let slope = graph.derivative(form, Symbol::Coordinate(i));
        coefficients.push(graph.fraction(slope, zero.clone()));
    }
    let coefficients: Option<Vec<Fraction>> = coefficients.into_iter().collect();
    let (Some(constant), Some(coefficients)) = (constant, coefficients) else {
        let message = "the coefficients of a constraint are rational functions of parameters";
        return wrong(
            message.into(),
            "declare a parameter for what is not rational, with its value as the default",
        );
    };
    if !constant.is_zero() {
        let message = "a constraint is homogeneous: this one has a term without the velocity";
        return wrong(
            message.into(),
            "remove the term; affine constraints, as of a body on a turning table, are not built",
        );
    }
    if coefficients.iter().all(Fraction::is_zero) {
        let message = "this constraint holds for every velocity";
        return wrong(message.into(), "remove it");
    }
    Some(coefficients)
}

fn at_rest(origin: Origin) -> Diagnostic {
    let message = "the constraints leave no velocity but zero: nothing moves";
    Diagnostic::new(Kind::Constraint, origin, message)
        .help("declare fewer constraints than the algebra has dimensions")
}

struct Elimination<'a> {
    /// The value at the default parameters.
    value: &'a dyn Fn(&mut Graph, &Fraction) -> f64,
    budget: Budget,
    own: usize,
}

impl Elimination<'_> {
    /// The reduced rows with their pivots, ascending.
    fn reduce(
        &self,
        rows: Vec<(Vec<Fraction>, Origin)>,
        graph: &mut Graph,
    ) -> Result<(Vec<usize>, Vec<Vec<Fraction>>), Diagnostic> {
        let mut reduced: Vec<(usize, Vec<Fraction>)> = Vec::new();
        for (mut row, origin) in rows {
            let limit = |_: Exhausted| {
                let message = "the constraints are too large to be solved exactly";
                Diagnostic::new(Kind::Limit, origin, message)
                    .help("write them with fewer parameters, or as numbers")
            };
            let size = self.size(&row, graph);
            for (pivot, known) in &reduced {
                let factor = row[*pivot].clone();
                self.subtract(&mut row, known, &factor).map_err(limit)?;
            }
            let pivot = self.pivot(&row, size, graph);
            let pivot = pivot.ok_or_else(|| match size {
                0.0 => void(origin),
                _ => dependent(origin, &row),
            })?;
            let inverse = row[pivot].recip(&self.budget).map_err(limit)?;
            let inverse = inverse.unwrap_or_default();
            for entry in &mut row {
                *entry = entry.mul(&inverse, &self.budget).map_err(limit)?;
            }
            for (_, other) in &mut reduced {
                let factor = other[pivot].clone();
                self.subtract(other, &row, &factor).map_err(limit)?;
            }
            reduced.push((pivot, row));
        }
        reduced.sort_by_key(|(pivot, _)| *pivot);
        Ok(reduced.into_iter().unzip())
    }

    /// `row -= factor*other`
    fn subtract(
        &self,
        row: &mut [Fraction],
        other: &[Fraction],
        factor: &Fraction,
    ) -> Result<(), Exhausted> {
        if factor.is_zero() {
            return Ok(());
        }
        for (entry, other) in row.iter_mut().zip(other) {
            let product = other.mul(factor, &self.budget)?;
            *entry = entry.sub(&product, &self.budget)?;
        }
        Ok(())
    }

    /// The largest coefficient at the default parameters.
    fn size(&self, row: &[Fraction], graph: &mut Graph) -> f64 {
        let values = row.iter().map(|entry| (self.value)(graph, entry).abs());
        values.fold(0.0, f64::max)
    }

    /// The last component that can be solved for, at the default parameters too; the row was of this size.
    fn pivot(&self, row: &[Fraction], size: f64, graph: &mut Graph) -> Option<usize> {
        let mut usable =
            |i: &usize| !row[*i].is_zero() && (self.value)(graph, &row[*i]).abs() > SINGULAR * size;
        (0..self.own).rev().find(|i| usable(i))
    }
}

/// A constraint whose coefficients are zero where it is looked at.
fn void(origin: Origin) -> Diagnostic {
    let message = "this constraint holds for every velocity at the default parameters";
    Diagnostic::new(Kind::Constraint, origin, message)
        .help("choose other defaults, for which it constrains something, or remove it")
}

/// A constraint that follows from those before it, at least where it is looked at.
fn dependent(origin: Origin, row: &[Fraction]) -> Diagnostic {
    if row.iter().all(Fraction::is_zero) {
        let message = "this constraint follows from those before it";
        return Diagnostic::new(Kind::Constraint, origin, message).help("remove it");
    }
    let message = "this constraint follows from those before it at the default parameters";
    Diagnostic::new(Kind::Constraint, origin, message)
        .help("choose other defaults, for which the constraints are independent")
}
