//! Casimirs: `{C, x_i} = sum_j dC/dx_j Pi_ji = 0` for all `i`, proven by a normal form.

use super::normal::{NormalForm, Verdict};
use super::sample::Samples;
use crate::algebra::StructureConstants;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::exact::{Budget, Rational};
use crate::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for one Casimir.
const WORK: u64 = 2_000_000;
/// Longer brackets are not printed in full.
const LONGEST: usize = 300;

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
    constants: &StructureConstants<ExprId>,
    name: &dyn Fn(Symbol) -> String,
    report: &mut Report,
) -> Option<Option<u32>> {
    let brackets = brackets(scratch, candidate.expr, constants);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(scratch, &budget);
    let mut undecided = None;
    for (i, terms, bracket) in &brackets {
        let shown = match normal.verdict(*bracket) {
            Verdict::Zero => continue,
            Verdict::Nonzero(value) => normal.display(&value, name),
            Verdict::Undecided if is_nonzero(scratch, terms) => scratch.display(*bracket, name),
            Verdict::Undecided => {
                undecided.get_or_insert((*i, *bracket));
                continue;
            }
        };
        let shown = if shown.chars().count() > LONGEST {
            "a long expression, not zero".into()
        } else {
            shown
        };
        report.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!(
                    "`{0}` is not a Casimir: {{{0}, {1}}} = {shown}",
                    candidate.name,
                    name(Symbol::Coordinate(*i))
                ),
            )
            .help("a Casimir commutes with every coordinate; correct it or remove it"),
        );
        return None;
    }
    if let Some((i, bracket)) = undecided {
        let shown = scratch.display(bracket, name);
        let shown = if shown.chars().count() > LONGEST {
            String::new()
        } else {
            format!(" = {shown}")
        };
        report.push(
            Diagnostic::new(
                Kind::Casimir,
                candidate.origin,
                format!(
                    "`{0}` is unproven: it could not be shown that {{{0}, {1}}}{shown} is zero, although it is at sample points",
                    candidate.name,
                    name(Symbol::Coordinate(i)),
                ),
            )
            .help("write it in a simpler form, with fewer different functions and roots, or leave it out"),
        );
        return None;
    }
    Some(normal.degree(candidate.expr))
}

/// The total degree of a function in the coordinates, if it is a polynomial in them and small enough
/// to tell.
pub fn degree(graph: &Graph, function: ExprId) -> Option<u32> {
    let budget = Budget::new(WORK);
    NormalForm::new(graph, &budget).degree(function)
}

/// The brackets with all coordinates that are not trivially zero: their terms and their sum.
fn brackets(
    graph: &mut Graph,
    function: ExprId,
    constants: &StructureConstants<ExprId>,
) -> Vec<(usize, Vec<ExprId>, ExprId)> {
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); constants.dimension()];
    // {C, x_i} = sum_j dC/dx_j Pi_ji with Pi_ji = -C_ji^k x_k
    for (j, i, k, constant) in constants.entries() {
        let x = graph.symbol(Symbol::Coordinate(*k));
        for (row, column, sign) in [(*j, *i, Rational::MINUS_ONE), (*i, *j, Rational::ONE)] {
            let slope = graph.derivative(function, Symbol::Coordinate(row));
            if !graph.is_zero(slope) {
                let product = graph.product(&[slope, *constant, x]);
                terms[column].push(graph.scale(product, &sign));
            }
        }
    }
    let mut result = Vec::new();
    for (i, terms) in terms.into_iter().enumerate() {
        let sum = graph.sum(&terms);
        if !graph.is_zero(sum) {
            result.push((i, terms, sum));
        }
    }
    result
}

/// Whether the sum of the terms is not zero at some point, beyond round-off.
fn is_nonzero(graph: &Graph, terms: &[ExprId]) -> bool {
    Samples::new().take(40).any(|point| {
        let values = graph.evaluate_all(terms, &|symbol| point.value(symbol));
        let (sum, scale) = values
            .iter()
            .fold((0.0, 0.0), |(s, a), v| (s + v, a + v.abs()));
        f64::is_finite(scale) && f64::abs(sum) > 1e-7 * scale
    })
}
