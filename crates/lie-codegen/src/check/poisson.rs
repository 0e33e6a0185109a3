//! Brackets of coordinates: from `{x, y} = value` to the entries of the Poisson matrix, and the Jacobi
//! identity of these.

use std::collections::BTreeMap;

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::model::CANONICAL;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::prove::proof::{Proof, examine};
use lie_symbolic::prove::residues;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Bracket, Declaration, Name, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};
use lie_syntax::suggest::{listed, misspelt};

/// Work allowed for the Jacobi identity of one system.
const WORK: u64 = 5_000_000;
/// Work allowed to show a sum that is not zero.
const SHOWN: u64 = 100_000;

/// A bracket `{x_i, x_j} = value` with `i < j`.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The row i.
    pub row: usize,
    /// The column j.
    pub column: usize,
    /// The value, not the number zero.
    pub value: ExprId,
    /// Where it is declared.
    pub origin: Origin,
}

/// Lowers the brackets of coordinates: all of a general bracket, or those of a cocycle.
///
/// Antisymmetry is implied, so `{y, x}` may be left out; where it is given it must be `-{x, y}`,
/// because one of the two is a slip. The same pair twice is allowed if both say the same.
pub fn check(
    declaration: &Declaration,
    graph: &mut Graph,
    environment: &Environment<'_>,
    report: &mut Report,
) -> Option<Vec<Entry>> {
    let (brackets, allowed) = match &declaration.structure {
        Structure::Lie { cocycle, .. } => (cocycle, Allowed::Parameters),
        Structure::General { brackets, .. } => (brackets, Allowed::State),
    };
    let mut known: BTreeMap<(usize, usize), (ExprId, &Bracket)> = BTreeMap::new();
    let mut complete = true;
    let position = |name: &Name| declaration.state.iter().position(|c| c.text == name.text);
    // The order in the arena, and with it the code, is that of the coordinates, not that of the text.
    let mut brackets: Vec<&Bracket> = brackets.iter().collect();
    brackets.sort_by_key(|bracket| {
        let (a, b) = (position(&bracket.left), position(&bracket.right));
        (a.min(b), a.max(b))
    });
    for bracket in brackets {
        let ends = [&bracket.left, &bracket.right].map(|name| {
            let index = position(name);
            if index.is_none() {
                report.push(unknown(declaration, name));
            }
            index
        });
        let value = Lowering::new(graph, environment, report, allowed).lower(&bracket.value);
        let ([Some(a), Some(b)], Some(value)) = (ends, value) else {
            complete = false;
            continue;
        };
        if a == b {
            if !is_zero(graph, value) {
                report.push(of_itself(declaration, graph, bracket, value));
                complete = false;
            }
            continue;
        }
        let above = if a < b { value } else { graph.neg(value) };
        let pair = (a.min(b), a.max(b));
        let Some(&(first, earlier)) = known.get(&pair) else {
            known.insert(pair, (above, bracket));
            continue;
        };
        let difference = graph.sub(above, first);
        if !is_zero(graph, difference) {
            report.push(disagreement(
                declaration,
                graph,
                bracket,
                earlier,
                (a < b, first),
            ));
            complete = false;
        }
    }
    complete.then(|| entries(graph, known))
}

/// What is not zero.
fn entries(graph: &Graph, known: BTreeMap<(usize, usize), (ExprId, &Bracket)>) -> Vec<Entry> {
    let known = known.into_iter();
    let entry = |((row, column), (value, bracket)): (_, (_, &Bracket))| Entry {
        row,
        column,
        value,
        origin: bracket.origin,
    };
    known
        .filter(|(_, (value, _))| !graph.is_zero(*value))
        .map(entry)
        .collect()
}

fn unknown(declaration: &Declaration, name: &Name) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Kind::UnknownSymbol,
        name.origin,
        format!("`{}` is not a coordinate of the state", name.text),
    );
    let state: Vec<&str> = declaration.state.iter().map(|c| c.text.as_str()).collect();
    diagnostic.help(match misspelt(&name.text, state.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the state is {}", listed(&state)),
    })
}

fn is_zero(graph: &Graph, value: ExprId) -> bool {
    let budget = Budget::new(WORK);
    graph.is_zero(value)
        || matches!(
            NormalForm::new(graph, &budget).verdict(value),
            Verdict::Zero
        )
}

fn display(declaration: &Declaration, graph: &Graph, value: ExprId) -> String {
    graph.display(value, &|symbol| symbol_name(declaration, symbol))
}

/// The name of a coordinate or of a parameter.
pub fn symbol_name(declaration: &Declaration, symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => declaration.state[i].text.clone(),
        Symbol::Parameter(p) => declaration.parameters[p].name.text.clone(),
        Symbol::Input(i) => {
            let mut names = declaration.realization.iter().flat_map(|r| r.names());
            let name = i.checked_sub(CANONICAL).and_then(|k| names.nth(k));
            name.map_or_else(String::new, |name| name.text.clone())
        }
        _ => String::new(),
    }
}

fn of_itself(
    declaration: &Declaration,
    graph: &Graph,
    bracket: &Bracket,
    value: ExprId,
) -> Diagnostic {
    let name = &bracket.left.text;
    let shown = display(declaration, graph, value);
    let message =
        format!("{{{name}, {name}}} = {shown}, but an antisymmetric bracket makes it zero");
    Diagnostic::new(Kind::Antisymmetry, bracket.origin, message).help("remove this bracket")
}

/// A pair for the second time, with another value; `known` is that of the ascending pair.
fn disagreement(
    declaration: &Declaration,
    graph: &mut Graph,
    bracket: &Bracket,
    earlier: &Bracket,
    (ascending, known): (bool, ExprId),
) -> Diagnostic {
    let (left, right) = (&bracket.left.text, &bracket.right.text);
    let flipped = earlier.left.text != *left;
    let negative = graph.neg(known);
    let own = if ascending { known } else { negative };
    let own = display(declaration, graph, own);
    if flipped {
        let theirs = if ascending { negative } else { known };
        let theirs = display(declaration, graph, theirs);
        let message = format!(
            "{{{left}, {right}}} disagrees with {{{right}, {left}}} = {theirs}: a bracket is antisymmetric"
        );
        let help = format!("write {{{left}, {right}}} = {own}, or leave it out");
        return Diagnostic::new(Kind::Antisymmetry, bracket.origin, message).help(help);
    }
    let message =
        format!("{{{left}, {right}}} was already given another value: {{{left}, {right}}} = {own}");
    Diagnostic::new(Kind::DuplicateBracket, bracket.origin, message).help("keep one of the two")
}

/// Reports the first three coordinates for which the Jacobi identity
/// `{x_i, {x_j, x_k}} + {x_j, {x_k, x_i}} + {x_k, {x_i, x_j}} = 0`, that is
/// `sum_l (Pi_il d_l Pi_jk + Pi_jl d_l Pi_ki + Pi_kl d_l Pi_ij) = 0`, fails or cannot be proven.
///
/// A bracket that violates it is none of a Poisson manifold: there are no leaves, and no map keeps it.
pub fn jacobi(
    declaration: &Declaration,
    entries: &[Entry],
    scratch: &mut Graph,
    report: &mut Report,
) {
    let sums = jacobiator(declaration.state.len(), entries, scratch);
    let scratch = &*scratch;
    let budget = Budget::new(WORK);
    let domain: Vec<ExprId> = entries.iter().map(|entry| entry.value).collect();
    let mut normal = NormalForm::with_domain(scratch, &budget, &domain);
    let mut first: Option<(Diagnostic, usize)> = None;
    for (triple, sum) in &sums {
        let name = |symbol| symbol_name(declaration, symbol);
        let (what, shown) = match proof(&mut normal, scratch, *sum, first.is_some(), &name) {
            Proof::Zero => continue,
            Proof::Nonzero(shown) => ("fails", shown),
            Proof::Unproven { text, values } => {
                let shown = text.unwrap_or_else(|| "a long expression".into());
                ("is unproven", format!("{shown} is zero, {values}"))
            }
        };
        if let Some((_, others)) = &mut first {
            *others += usize::from(what == "fails");
            continue;
        }
        let [a, b, c] = triple.map(|index| declaration.state[index].text.as_str());
        let sum = format!("{{{a}, {{{b}, {c}}}}} + {{{b}, {{{c}, {a}}}}} + {{{c}, {{{a}, {b}}}}}");
        let unproven = what != "fails";
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
        let diagnostic = Diagnostic::new(Kind::Jacobi, place(entries, *triple), message);
        first = Some((diagnostic.help(help), 0));
        if unproven {
            break;
        }
    }
    if let Some((mut diagnostic, others)) = first {
        match others {
            0 => {}
            1 => diagnostic
                .message
                .push_str("; it fails for one other triple too"),
            others => diagnostic
                .message
                .push_str(&format!("; it fails for {others} other triples too")),
        }
        report.push(diagnostic);
    }
}

/// Examines a sum of the identity. One that does not vanish modulo a prime fails for sure: to show it, little
/// work is done, and none where it is not shown.
fn proof(
    normal: &mut NormalForm<'_>,
    graph: &Graph,
    sum: ExprId,
    hidden: bool,
    name: &dyn Fn(Symbol) -> String,
) -> Proof {
    if !residues::is_nonzero(graph, sum) {
        return examine(normal, graph, sum, name);
    }
    if hidden {
        return Proof::Nonzero(String::new());
    }
    let budget = Budget::new(SHOWN);
    match examine(&mut NormalForm::new(graph, &budget), graph, sum, name) {
        Proof::Nonzero(shown) => Proof::Nonzero(shown),
        _ => Proof::Nonzero("a long expression, not zero".into()),
    }
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

/// The first bracket between two of the three coordinates.
fn place(entries: &[Entry], triple: [usize; 3]) -> Origin {
    let between = |entry: &&Entry| triple.contains(&entry.row) && triple.contains(&entry.column);
    let found = entries.iter().find(between).or(entries.first());
    found.map_or(Origin::from_span(proc_macro2::Span::call_site()), |entry| {
        entry.origin
    })
}
