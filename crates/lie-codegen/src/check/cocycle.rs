//! Constants that are added to a Lie–Poisson bracket: a 2-cocycle of the algebra.

use super::poisson::{Entry, symbol_name};
use crate::algebra::StructureConstants;
use crate::model::Parameter;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::normal::NormalForm;
use lie_symbolic::prove::proof::{Proof, examine};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, Expr, ExprKind, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};

/// Work allowed for the identity.
const WORK: u64 = 5_000_000;

/// Reports constants that use parameters which are not exact: the identity must hold for what the
/// brackets of the algebra may depend on, and these are exact.
pub fn parameters(declaration: &Declaration, report: &mut Report) {
    let Structure::Lie { cocycle, .. } = &declaration.structure else {
        return;
    };
    let inexact = |name: &str| {
        let mut parameters = declaration.parameters.iter();
        parameters.any(|p| p.name.text == name && !p.exact)
    };
    for bracket in cocycle {
        for (name, origin) in names(&bracket.value) {
            if inexact(name) {
                report.push(not_exact(name, origin));
            }
        }
    }
}

fn not_exact(name: &str, origin: Origin) -> Diagnostic {
    let message = format!("the parameter `{name}` is not exact, so a cocycle cannot use it");
    let help =
        format!("declare it exact: `exact {name} = …;` in the macro, `\"exact\": true` in a spec");
    Diagnostic::new(Kind::UnknownSymbol, origin, message).help(help)
}

/// Reports constants that reach such parameters through abbreviations, and those that are not finite for
/// the default parameters.
pub fn values(entries: &[Entry], graph: &Graph, parameters: &[Parameter], report: &mut Report) {
    for entry in entries {
        let used = graph.symbols(entry.value);
        let inexact = used.into_iter().find_map(|symbol| match symbol {
            Symbol::Parameter(p) => parameters.get(p).filter(|p| p.exact.is_none()),
            _ => None,
        });
        if let Some(parameter) = inexact {
            report.push(not_exact(&parameter.name, entry.origin));
            continue;
        }
        let value = |symbol| match symbol {
            Symbol::Parameter(p) => parameters[p].default_value,
            _ => f64::NAN,
        };
        if !graph.evaluate(entry.value, &value).is_finite() {
            let message = "this constant is not finite for the default parameters";
            report.push(
                Diagnostic::new(Kind::Number, entry.origin, message).help("choose another default"),
            );
        }
    }
}

/// The names in an expression, in the order of the text.
fn names(expression: &Expr) -> Vec<(&str, Origin)> {
    let mut pending = vec![expression];
    let mut names = Vec::new();
    while let Some(part) = pending.pop() {
        match &part.kind {
            ExprKind::Name { name, .. } => names.push((name.as_str(), part.origin)),
            ExprKind::Number(_) => {}
            ExprKind::Negative(a) => pending.push(a),
            ExprKind::Power(a, b) => pending.extend([&**b, &**a]),
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                pending.extend(operands.iter().rev().map(|(_, operand)| operand));
            }
            ExprKind::Call { arguments, .. } => pending.extend(arguments.iter().rev()),
            ExprKind::IndexedSum { from, to, body, .. } => {
                pending.extend([&**body, &**to, &**from]);
            }
        }
    }
    names
}

/// Reports the first three basis elements for which the cocycle identity
/// `S([a, b], c) + S([b, c], a) + S([c, a], b) = 0` fails, with `S(e_i, e_j)` the constant that is added to
/// `{x_i, x_j}`: only then is the sum a Poisson bracket, the Lie–Poisson bracket of a central extension.
pub fn check(
    declaration: &Declaration,
    entries: &[Entry],
    constants: &StructureConstants<ExprId>,
    scratch: &mut Graph,
    report: &mut Report,
) {
    let cocycle = matrix(entries, constants.dimension(), scratch);
    let brackets = brackets(constants, scratch);
    let sums = sums(&cocycle, &brackets, scratch);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::new(scratch, &budget);
    let name = |symbol: Symbol| symbol_name(declaration, symbol);
    for (triple, sum) in &sums {
        let [a, b, c] = triple.map(|index| declaration.basis()[index].text.as_str());
        let sums = format!("S([{a}, {b}], {c}) + S([{b}, {c}], {a}) + S([{c}, {a}], {b})");
        let message = match examine(&mut normal, scratch, *sum, &name) {
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
        report.push(
            Diagnostic::new(Kind::Cocycle, place, message).help(
                "correct the constants; S(a, b) is what is added to the bracket of the coordinates of a and b",
            ),
        );
        return;
    }
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
