//! Constants that are added to a Lie–Poisson bracket: a 2-cocycle of the algebra.

use super::poisson::Entry;
use crate::algebra::StructureConstants;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::{Proof, Prover};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work allowed for the identity.
const WORK: u64 = 5_000_000;

/// The first three basis elements for which the cocycle identity
/// `S([a, b], c) + S([b, c], a) + S([c, a], b) = 0` fails, with `S(e_i, e_j)` the constant that is added to
/// `{x_i, x_j}`: only then is the sum a Poisson bracket, the Lie–Poisson bracket of a central extension.
pub fn cocycle_identity(
    declaration: &Declaration,
    entries: &[Entry],
    constants: &StructureConstants<ExprId>,
    scratch: &mut Graph,
    name: &dyn Fn(Symbol) -> String,
) -> Option<Diagnostic> {
    let cocycle = matrix(entries, constants.dimension(), scratch);
    let brackets = brackets(constants, scratch);
    let sums = sums(&cocycle, &brackets, scratch);
    let budget = Budget::new(WORK);
    let mut prover = Prover::new(scratch, &budget, &[], name);
    for (triple, sum) in &sums {
        let [a, b, c] = triple.map(|index| declaration.basis()[index].text.as_str());
        let sums = format!("S([{a}, {b}], {c}) + S([{b}, {c}], {a}) + S([{c}, {a}], {b})");
        let message = match prover.examine(*sum) {
            Proof::Zero => continue,
            Proof::Nonzero(shown) => {
                format!("the cocycle identity fails for ({a}, {b}, {c}): {sums} = {shown}")
            }
            Proof::Unproven { .. } => format!(
                "the cocycle identity is unproven for ({a}, {b}, {c}): it could not be shown that {sums} is zero"
            ),
        };
        let mut involved = entries
            .iter()
            .filter(|entry| is_part(entry, triple, &brackets));
        let found = involved.next().or(entries.first());
        let place = found.map_or(declaration.place(), |entry| entry.origin);
        return Some(Diagnostic::new(Kind::Cocycle, place, message).help(
            "correct the constants; S(a, b) is what is added to the bracket of the coordinates of a and b",
        ));
    }
    None
}

/// `S(e_i, e_j)` for all i, j.
fn matrix(entries: &[Entry], n: usize, scratch: &mut Graph) -> Vec<Vec<ExprId>> {
    let zero = scratch.integer(0);
    let mut rows = vec![vec![zero; n]; n];
    for entry in entries {
        rows[entry.row][entry.column] = entry.value;
        rows[entry.column][entry.row] = scratch.neg(entry.value);
    }
    rows
}

/// The terms `(k, C_ij^k)` of `[e_i, e_j]`, for all i, j.
type Brackets = Vec<Vec<Vec<(usize, ExprId)>>>;

fn brackets(constants: &StructureConstants<ExprId>, scratch: &mut Graph) -> Brackets {
    let n = constants.dimension();
    let mut brackets = vec![vec![Vec::new(); n]; n];
    for (i, j, k, value) in constants.entries() {
        brackets[*i][*j].push((*k, *value));
        brackets[*j][*i].push((*k, scratch.neg(*value)));
    }
    brackets
}

/// The sums of the identity that are not zero at sight, with their i < j < k.
fn sums(
    cocycle: &[Vec<ExprId>],
    brackets: &Brackets,
    scratch: &mut Graph,
) -> Vec<([usize; 3], ExprId)> {
    let n = brackets.len();
    let mut sums = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let mut terms = Vec::new();
                for (a, b, c) in [(i, j, k), (j, k, i), (k, i, j)] {
                    for (l, value) in &brackets[a][b] {
                        terms.push(scratch.mul(*value, cocycle[*l][c]));
                    }
                }
                let sum = scratch.sum(&terms);
                if !scratch.is_zero(sum) {
                    sums.push(([i, j, k], sum));
                }
            }
        }
    }
    sums
}

/// Whether the sum of a triple contains a constant `S(e_l, e_c)`.
fn is_part(entry: &Entry, triple: &[usize; 3], brackets: &Brackets) -> bool {
    let ends = (entry.row, entry.column);
    [(0, 1, 2), (1, 2, 0), (2, 0, 1)].iter().any(|&(x, y, z)| {
        let (x, y, z) = (triple[x], triple[y], triple[z]);
        let mut from = brackets[x][y].iter();
        from.any(|(l, _)| ends == (*l, z) || ends == (z, *l))
    })
}
