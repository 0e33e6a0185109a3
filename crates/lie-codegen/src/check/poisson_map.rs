//! Realizations are Poisson maps J: `{J_a, J_b} = Pi_ab(J)`, proven by a normal form.

use super::descent::{self, Component};
use crate::model::{CANONICAL, PoissonMatrix, Realization};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work allowed for all brackets of one realization.
const WORK: u64 = 5_000_000;

/// Why a realization is no Poisson map, or is not shown to be one; where it is, whether Gauss methods over it descend
/// stands in it afterwards.
pub fn poisson_map(
    realization: &mut Realization,
    poisson: &PoissonMatrix,
    scratch: &mut Graph,
    name: &dyn Fn(Symbol) -> String,
) -> Option<Diagnostic> {
    let points = realization.names.len();
    let map = realization.map.clone();
    let slopes: Vec<Vec<ExprId>> = map.iter().map(|&j| slopes(scratch, j, points)).collect();
    let differences = differences(scratch, &map, &slopes, poisson);
    let (components, thirds) = higher_derivatives(scratch, &map, &slopes);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let mut prover = Prover::new(scratch, &budget, &map, name);
    for (a, b, difference) in differences {
        let shown = |k| name(Symbol::Coordinate(k));
        if let Some(message) = message(&prover.examine(difference), &shown(a), &shown(b)) {
            let mistake = Diagnostic::new(Kind::Representation, realization.origins[b], message);
            return Some(mistake.help(
                "{f, g} = sum df/dq dg/dp - df/dp dg/dq must be the bracket of the system; often a sign is wrong",
            ));
        }
    }
    if thirds.iter().all(|third| prover.vanishes(*third)) {
        realization.descent = descent::descent(scratch, &components, points);
    }
    None
}

/// The derivatives of a function by the canonical coordinates.
fn slopes(graph: &mut Graph, function: ExprId, points: usize) -> Vec<ExprId> {
    let symbols = (0..points).map(|i| Symbol::Input(CANONICAL + i));
    let slopes = symbols.map(|symbol| graph.derivative(function, symbol));
    slopes.collect()
}

/// What must vanish: `(a, b, {J_a, J_b} - Pi_ab(J))`, a < b.
fn differences(
    scratch: &mut Graph,
    map: &[ExprId],
    slopes: &[Vec<ExprId>],
    poisson: &PoissonMatrix,
) -> Vec<(usize, usize, ExprId)> {
    let mut differences = Vec::new();
    for a in 0..map.len() {
        for b in a + 1..map.len() {
            let half = slopes[a].len() / 2;
            let mut terms = Vec::new();
            for i in 0..half {
                terms.push(scratch.mul(slopes[a][i], slopes[b][half + i]));
                let other = scratch.mul(slopes[a][half + i], slopes[b][i]);
                terms.push(scratch.neg(other));
            }
            let mut entries = poisson.entries.iter();
            if let Some(&(_, _, value)) = entries.find(|entry| (entry.0, entry.1) == (a, b)) {
                let over = scratch.substitute(&[value], &|symbol| match symbol {
                    Symbol::Coordinate(k) => Some(map[k]),
                    _ => None,
                });
                terms.push(scratch.neg(over[0]));
            }
            differences.push((a, b, scratch.sum(&terms)));
        }
    }
    differences
}

/// The components with their second derivatives, and all third ones.
fn higher_derivatives(
    scratch: &mut Graph,
    map: &[ExprId],
    slopes: &[Vec<ExprId>],
) -> (Vec<Component>, Vec<ExprId>) {
    let (mut components, mut thirds) = (Vec::new(), Vec::new());
    for (&value, slopes) in map.iter().zip(slopes) {
        let mut seconds = Vec::new();
        for slope in slopes {
            for i in 0..slopes.len() {
                let second = scratch.derivative(*slope, Symbol::Input(CANONICAL + i));
                seconds.push(second);
                for j in i..slopes.len() {
                    thirds.push(scratch.derivative(second, Symbol::Input(CANONICAL + j)));
                }
            }
        }
        components.push(Component {
            value,
            slopes: slopes.clone(),
            seconds,
        });
    }
    thirds.sort_unstable();
    thirds.dedup();
    (components, thirds)
}

/// Why two components do not have the bracket of the system.
fn message(proof: &Proof, left: &str, right: &str) -> Option<String> {
    match proof {
        Proof::Zero => None,
        Proof::Nonzero(shown) => Some(format!(
            "the realization is not a Poisson map: {{{left}, {right}}} of its components is not the bracket of the \
             system; the difference is {shown}"
        )),
        Proof::Unproven { .. } => Some(format!(
            "it could not be shown that {{{left}, {right}}} of the components is the bracket of the system"
        )),
    }
}
