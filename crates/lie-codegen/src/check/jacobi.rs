//! The Jacobi identity of brackets of coordinates.

use std::collections::BTreeMap;

use super::poisson::Entry;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work allowed for the identity.
const WORK: u64 = 5_000_000;

/// The first three coordinates for which the Jacobi identity
/// `{x_i, {x_j, x_k}} + {x_j, {x_k, x_i}} + {x_k, {x_i, x_j}} = 0`, that is
/// `sum_l (Pi_il d_l Pi_jk + Pi_jl d_l Pi_ki + Pi_kl d_l Pi_ij) = 0`, fails or cannot be proven.
///
/// A bracket that violates it is not a Poisson bracket: it has no symplectic leaves, and no map preserves it.
pub fn jacobi_identity(
    declaration: &Declaration,
    entries: &[Entry],
    scratch: &mut Graph,
    name: &dyn Fn(Symbol) -> String,
) -> Option<Diagnostic> {
    let sums = jacobiator(declaration.state.len(), entries, scratch);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let domain: Vec<ExprId> = entries.iter().map(|entry| entry.value).collect();
    let mut prover = Prover::new(scratch, &budget, &domain, name);
    let mut first: Option<(Diagnostic, usize)> = None;
    for (triple, sum) in &sums {
        let proof = match first.is_some() {
            true => prover.examine_hidden(*sum),
            false => prover.examine(*sum),
        };
        let (unproven, shown) = match proof {
            Proof::Zero => continue,
            Proof::Nonzero(shown) => (false, shown),
            Proof::Unproven { text, values } => {
                let shown = text.unwrap_or_else(|| "a long expression".into());
                (true, format!("{shown} is zero, {values}"))
            }
        };
        if let Some((_, others)) = &mut first {
            *others += usize::from(!unproven);
            continue;
        }
        let [a, b, c] = triple.map(|index| declaration.state[index].text.as_str());
        let sum = format!("{{{a}, {{{b}, {c}}}}} + {{{b}, {{{c}, {a}}}}} + {{{c}, {{{a}, {b}}}}}");
        let message = if unproven {
            format!(
                "the Jacobi identity is unproven for ({a}, {b}, {c}): it could not be shown that {sum} = {shown}"
            )
        } else {
            format!("the Jacobi identity fails for ({a}, {b}, {c}): {sum} = {shown}")
        };
        let help = if unproven {
            "write the brackets in a simpler form, with fewer different functions and roots"
        } else {
            "check the sign and the value of the brackets of these three coordinates and of those in them; a bracket that is left out is zero"
        };
        let involved =
            |entry: &&Entry| triple.contains(&entry.row) && triple.contains(&entry.column);
        let found = entries.iter().find(involved).or(entries.first());
        let place = found.map_or(declaration.place(), |entry| entry.origin);
        let diagnostic = Diagnostic::new(Kind::Jacobi, place, message);
        first = Some((diagnostic.help(help), 0));
        if unproven {
            break;
        }
    }
    let (mut diagnostic, others) = first?;
    diagnostic.message += &match others {
        0 => String::new(),
        1 => "; it fails for one other triple too".into(),
        others => format!("; it fails for {others} other triples too"),
    };
    Some(diagnostic)
}

/// Whether the identity holds for brackets of which nobody asks it; `None` where it is not decided.
pub fn holds(
    dimension: usize,
    entries: &[Entry],
    scratch: &mut Graph,
    name: &dyn Fn(Symbol) -> String,
) -> Option<bool> {
    let sums = jacobiator(dimension, entries, scratch);
    let budget = Budget::new(WORK);
    let domain: Vec<ExprId> = entries.iter().map(|entry| entry.value).collect();
    let mut prover = Prover::new(scratch, &budget, &domain, name);
    let mut found = Some(true);
    for (_, sum) in &sums {
        match prover.examine_hidden(*sum) {
            Proof::Zero => {}
            Proof::Nonzero(_) => return Some(false),
            Proof::Unproven { .. } => found = None,
        }
    }
    found
}

/// The sums of the identity that are not trivially zero.
fn jacobiator(dimension: usize, entries: &[Entry], graph: &mut Graph) -> Vec<([usize; 3], ExprId)> {
    let zero = graph.integer(0);
    let mut matrix = vec![vec![zero; dimension]; dimension];
    for entry in entries {
        matrix[entry.row][entry.column] = entry.value;
        matrix[entry.column][entry.row] = graph.neg(entry.value);
    }
    // d_l Pi_jk, only where Pi_jk varies
    let mut slopes: BTreeMap<(usize, usize), Vec<(usize, ExprId)>> = BTreeMap::new();
    for entry in entries {
        for symbol in graph.symbols(entry.value) {
            if let Symbol::Coordinate(l) = symbol {
                let slope = graph.derivative(entry.value, symbol);
                let negative = graph.neg(slope);
                let (row, column) = (entry.row, entry.column);
                slopes.entry((row, column)).or_default().push((l, slope));
                slopes.entry((column, row)).or_default().push((l, negative));
            }
        }
    }
    let mut sums = Vec::new();
    for i in 0..dimension {
        for j in i + 1..dimension {
            for k in j + 1..dimension {
                let mut terms = Vec::new();
                for (a, b, c) in [(i, j, k), (j, k, i), (k, i, j)] {
                    for (l, slope) in slopes.get(&(b, c)).into_iter().flatten() {
                        let term = graph.mul(matrix[a][*l], *slope);
                        if !graph.is_zero(term) {
                            terms.push(term);
                        }
                    }
                }
                let sum = graph.sum(&terms);
                if !graph.is_zero(sum) {
                    sums.push(([i, j, k], sum));
                }
            }
        }
    }
    sums
}
