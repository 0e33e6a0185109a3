//! Casimirs: `{C, x_i} = sum_j dC/dx_j Pi_ji = 0` for all `i`, proven by a normal form.

use crate::model::PoissonMatrix;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::degree::degree;
use lie_symbolic::prove::normal::NormalForm;
use lie_symbolic::prove::proof::{Proof, examine};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};

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

/// Verifies one Casimir and returns its degree, if it is a polynomial.
///
/// A function that is none would be reported as a drift of the method, hence no benefit of the
/// doubt: what the normal form cannot decide is refused. `scratch` is an arena that may be littered.
pub fn check(
    candidate: &Candidate,
    scratch: &mut Graph,
    poisson: &PoissonMatrix,
    name: &dyn Fn(Symbol) -> String,
    report: &mut Report,
) -> Option<Option<u32>> {
    let brackets = brackets(scratch, candidate.expr, poisson);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let mut domain = vec![candidate.expr];
    domain.extend(poisson.entries.iter().map(|(.., value)| *value));
    let mut normal = NormalForm::with_domain(scratch, &budget, &domain);
    let mut undecided = None;
    for (i, bracket) in &brackets {
        let coordinate = name(Symbol::Coordinate(*i));
        let shown = match examine(&mut normal, scratch, *bracket, name) {
            Proof::Zero => continue,
            Proof::Nonzero(shown) => shown,
            Proof::Unproven { text, values } => {
                undecided.get_or_insert((coordinate, text, values));
                continue;
            }
        };
        let why = if coordinate == crate::model::configuration::TIME_MOMENTUM {
            "it depends on the time".to_owned()
        } else {
            format!("{{{}, {coordinate}}} = {shown}", candidate.name)
        };
        report.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!("`{}` is not a Casimir: {why}", candidate.name),
            )
            .help("a Casimir commutes with every coordinate: either it is wrong, or the sign or the coefficient of a bracket is"),
        );
        return None;
    }
    if let Some((coordinate, shown, values)) = undecided {
        let shown = shown.map_or_else(String::new, |shown| format!(" = {shown}"));
        report.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!(
                    "`{0}` is unproven: it could not be shown that {{{0}, {coordinate}}}{shown} is zero, {values}",
                    candidate.name,
                ),
            )
            .help("write it in a simpler form, with fewer different functions and roots, or leave it out"),
        );
        return None;
    }
    Some(degree(scratch, candidate.expr))
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
