//! From declared brackets to structure constants.

use std::collections::BTreeMap;

use super::StructureConstants;
use lie_symbolic::exact::{Budget, Exhausted, Fraction};
use lie_syntax::ast::Bracket;
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};
use lie_syntax::linear::{Scope, bracket_value};

type Form = Vec<(usize, Fraction)>;

fn negative(form: &Form) -> Form {
    form.iter().map(|(k, v)| (*k, v.neg())).collect()
}

/// Lowers the declared brackets.
///
/// Antisymmetry is implied, so `[b, a]` may be left out; where it is given it must be `-[a, b]`,
/// because one of the two is a slip. The same pair twice is allowed if both say the same.
pub fn check(
    brackets: &[Bracket],
    scope: &Scope<'_>,
    budget: &Budget,
    report: &mut Report,
) -> Option<StructureConstants<Fraction>> {
    let mut known: BTreeMap<(usize, usize), (Form, &Bracket)> = BTreeMap::new();
    let mut complete = true;
    for bracket in brackets {
        let ends = ends(bracket, scope, report);
        let value = bracket_value(&bracket.value, scope, budget, report);
        let (Some((a, b)), Some(value)) = (ends, value) else {
            complete = false;
            continue;
        };
        if a == b {
            if !value.is_empty() {
                report.push(with_itself(bracket, &value, scope));
                complete = false;
            }
            continue;
        }
        let (pair, form) = if a < b {
            ((a, b), value)
        } else {
            ((b, a), negative(&value))
        };
        let Some((first, earlier)) = known.get(&pair) else {
            known.insert(pair, (form, bracket));
            continue;
        };
        match same(first, &form, budget) {
            Ok(true) => {}
            Ok(false) => {
                let upper = scope.basis_index(&earlier.left.text) == Some(pair.0);
                let said = if upper {
                    first.clone()
                } else {
                    negative(first)
                };
                report.push(contradiction(bracket, (earlier, &said), scope));
                complete = false;
            }
            Err(Exhausted) => {
                let message = "the brackets are too large to be compared exactly";
                let limit = Diagnostic::new(Kind::Limit, bracket.origin, message);
                report.push(limit.help("simplify their coefficients"));
                return None;
            }
        }
    }
    let entries = known
        .into_iter()
        .flat_map(|((i, j), (form, _))| form.into_iter().map(move |(k, v)| (i, j, k, v)));
    complete.then(|| StructureConstants::new(scope.basis().len(), entries.collect()))
}

/// The two basis elements.
fn ends(bracket: &Bracket, scope: &Scope<'_>, report: &mut Report) -> Option<(usize, usize)> {
    let [a, b] = [&bracket.left, &bracket.right].map(|name| {
        let index = scope.basis_index(&name.text);
        if index.is_none() {
            report.push(scope.unknown_basis(Kind::UnknownSymbol, name));
        }
        index
    });
    a.zip(b)
}

/// `[a, a]` that is not zero.
fn with_itself(bracket: &Bracket, value: &Form, scope: &Scope<'_>) -> Diagnostic {
    let message = format!(
        "[{0}, {0}] = {1}, but an antisymmetric bracket makes it zero",
        bracket.left.text,
        scope.display(value)
    );
    Diagnostic::new(Kind::Antisymmetry, bracket.origin, message).help("remove this bracket")
}

/// A bracket that an earlier one, with its value, contradicts.
fn contradiction(
    bracket: &Bracket,
    (earlier, said): (&Bracket, &Form),
    scope: &Scope<'_>,
) -> Diagnostic {
    let shown = |bracket: &Bracket| format!("[{}, {}]", bracket.left.text, bracket.right.text);
    let (here, before) = (shown(bracket), shown(earlier));
    let value = scope.display(said);
    if earlier.left.text == bracket.left.text {
        let message = format!("{here} was already given another value: {before} = {value}");
        return Diagnostic::new(Kind::DuplicateBracket, bracket.origin, message)
            .help("keep one of the two");
    }
    let message = format!("{here} disagrees with {before} = {value}: a bracket is antisymmetric");
    let right = scope.display(&negative(said));
    Diagnostic::new(Kind::Antisymmetry, bracket.origin, message)
        .help(format!("write {here} = {right}, or leave it out"))
}

fn same(a: &Form, b: &Form, budget: &Budget) -> Result<bool, Exhausted> {
    if a.len() != b.len() {
        return Ok(false);
    }
    for ((k, v), (l, w)) in a.iter().zip(b) {
        if k != l || !v.equals(w, budget)? {
            return Ok(false);
        }
    }
    Ok(true)
}
