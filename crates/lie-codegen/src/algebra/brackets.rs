//! From declared brackets to structure constants.

use std::collections::BTreeMap;

use super::StructureConstants;
use super::antisymmetry::{self, BASIS};
use lie_symbolic::exact::{Budget, Exhausted, Fraction};
use lie_syntax::ast::Bracket;
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::{Scope, bracket_value};

type Form = Vec<(usize, Fraction)>;

fn negative(form: &Form) -> Form {
    form.iter().map(|(k, v)| (*k, v.neg())).collect()
}

/// Lowers the declared brackets.
///
/// Antisymmetry is implied, so `[b, a]` may be left out; where it is given it must be `-[a, b]`,
/// because one of the two is a slip. The same pair twice is allowed if both say the same.
///
/// # Errors
/// Every mistake in them.
pub fn structure_constants(
    brackets: &[Bracket],
    scope: &Scope<'_>,
    budget: &Budget,
) -> Result<StructureConstants<Fraction>, Vec<Diagnostic>> {
    let mut known: BTreeMap<(usize, usize), (Form, &Bracket)> = BTreeMap::new();
    let mut mistakes = Vec::new();
    for bracket in brackets {
        let ends = ends(bracket, scope, &mut mistakes);
        let value = bracket_value(&bracket.value, scope, budget);
        let value = value.map_err(|found| mistakes.extend(found)).ok();
        let (Some((a, b)), Some(value)) = (ends, value) else {
            continue;
        };
        if a == b {
            if !value.is_empty() {
                let value = scope.display(&value);
                mistakes.push(antisymmetry::with_itself(bracket, BASIS, &value));
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
                let shown = [first, &negative(first)].map(|form| scope.display(form));
                let [upper, lower] = shown.each_ref().map(String::as_str);
                let values = if a < b {
                    [upper, lower]
                } else {
                    [lower, upper]
                };
                mistakes.push(antisymmetry::contradiction(bracket, earlier, BASIS, values));
            }
            Err(Exhausted) => {
                let message = "the brackets are too large to be compared exactly";
                let limit = Diagnostic::new(Kind::Limit, bracket.origin, message);
                mistakes.push(limit.help("simplify their coefficients"));
                return Err(mistakes);
            }
        }
    }
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    let entries = known
        .into_iter()
        .flat_map(|((i, j), (form, _))| form.into_iter().map(move |(k, v)| (i, j, k, v)));
    Ok(StructureConstants::new(
        scope.basis().len(),
        entries.collect(),
    ))
}

/// The two basis elements.
fn ends(
    bracket: &Bracket,
    scope: &Scope<'_>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<(usize, usize)> {
    let [a, b] = [&bracket.left, &bracket.right].map(|name| {
        let index = scope.basis_index(&name.text);
        if index.is_none() {
            mistakes.push(scope.unknown_basis(Kind::UnknownSymbol, name));
        }
        index
    });
    a.zip(b)
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
