//! Casimirs: `{C, x_i} = sum_j dC/dx_j Pi_ji = 0` for all `i`, proven by a normal form.

use std::collections::HashSet;

use crate::model::PoissonMatrix;
use crate::model::configuration::TIME_MOMENTUM;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{self, Declaration};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

/// Work allowed for one Casimir.
const WORK: u64 = 2_000_000;

/// A function that was declared to be a Casimir.
pub struct Candidate {
    /// Its name, declared or provisional.
    pub name: String,
    /// Where its expression stands.
    pub origin: Origin,
    /// The function.
    pub expr: ExprId,
}

/// The names that a declaration uses.
pub fn taken(declaration: &Declaration) -> HashSet<String> {
    let names = declaration
        .state
        .iter()
        .chain(declaration.basis())
        .chain(declaration.lets.iter().map(|(n, _)| n));
    let names = names.chain(declaration.parameters.iter().map(|p| &p.name));
    let names = names.chain(declaration.casimirs.iter().filter_map(|c| c.name.as_ref()));
    let names = names.chain(declaration.quantities().map(|(name, _)| name));
    names.map(|n| n.text.clone()).collect()
}

/// C1, C2, … without the names that are taken.
pub fn free_names(taken: &HashSet<String>) -> impl Iterator<Item = String> {
    (1..)
        .map(|i| format!("C{i}"))
        .filter(move |name| !taken.contains(name))
}

/// The declared Casimirs, those without a name under the next of the free ones.
pub fn candidates(
    declaration: &Declaration,
    functions: &[ExprId],
    mut free: impl Iterator<Item = String>,
) -> Vec<Candidate> {
    let casimirs = declaration.casimirs.iter().zip(functions);
    let candidate = |(casimir, expr): (&ast::Casimir, &ExprId)| {
        let name = casimir.name.as_ref().map(|n| n.text.clone());
        Candidate {
            name: name.or_else(|| free.next()).unwrap_or_default(),
            origin: casimir.value.origin,
            expr: *expr,
        }
    };
    casimirs.map(candidate).collect()
}

/// Why a function is no Casimir, or is not shown to be one.
///
/// A function that is none would be reported as a drift of the method, hence no benefit of the
/// doubt: what the normal form cannot decide is refused. `scratch` is an arena that may be littered.
pub fn refutation(
    candidate: &Candidate,
    scratch: &mut Graph,
    poisson: &PoissonMatrix,
    name: &dyn Fn(Symbol) -> String,
) -> Option<Diagnostic> {
    let brackets = brackets(scratch, candidate.expr, poisson);
    let budget = Budget::new(WORK);
    let mut domain = vec![candidate.expr];
    domain.extend(poisson.entries.iter().map(|(.., value)| *value));
    let mut prover = Prover::new(scratch, &budget, &domain, name);
    let mut undecided = None;
    let refused = |message, help| {
        let diagnostic = Diagnostic::new(Kind::Casimir, candidate.origin, message);
        Some(diagnostic.help(help))
    };
    for (i, bracket) in &brackets {
        let coordinate = name(Symbol::Coordinate(*i));
        let shown = match prover.examine(*bracket) {
            Proof::Zero => continue,
            Proof::Nonzero(shown) => shown,
            Proof::Unproven { text, values } => {
                undecided.get_or_insert((coordinate, text, values));
                continue;
            }
        };
        let why = if coordinate == TIME_MOMENTUM {
            "it depends on the time".to_owned()
        } else {
            format!("{{{}, {coordinate}}} = {shown}", candidate.name)
        };
        return refused(
            format!("`{}` is not a Casimir: {why}", candidate.name),
            "a Casimir commutes with every coordinate: either it is wrong, or the sign or the coefficient of a bracket is",
        );
    }
    let (coordinate, shown, values) = undecided?;
    let shown = shown.map_or_else(String::new, |shown| format!(" = {shown}"));
    refused(
        format!(
            "`{0}` is unproven: it could not be shown that {{{0}, {coordinate}}}{shown} is zero, {values}",
            candidate.name,
        ),
        "write it in a simpler form, with fewer different functions and roots, or leave it out",
    )
}

/// The brackets with all coordinates that are not trivially zero.
fn brackets(graph: &mut Graph, function: ExprId, poisson: &PoissonMatrix) -> Vec<(usize, ExprId)> {
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); poisson.dimension];
    // {C, x_i} = sum_j dC/dx_j Pi_ji
    for (j, i, entry) in &poisson.entries {
        for (row, column, sign) in [(*j, *i, Rational::ONE), (*i, *j, Rational::MINUS_ONE)] {
            let slope = graph.derivative(function, Symbol::Coordinate(row));
            if !graph.is_zero(slope) {
                let product = graph.mul(slope, *entry);
                terms[column].push(graph.scale(product, &sign));
            }
        }
    }
    let mut result = Vec::new();
    for (i, terms) in terms.into_iter().enumerate() {
        let sum = graph.sum(&terms);
        if !graph.is_zero(sum) {
            result.push((i, sum));
        }
    }
    result
}
