//! From declared brackets to structure constants.

use std::collections::BTreeMap;

use super::linear::bracket_value;
use super::{Scope, StructureConstants};
use crate::ast::Bracket;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::exact::{Budget, Exhausted, Fraction};

type Form = Vec<(usize, Fraction)>;

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
        let ends = [&bracket.left, &bracket.right].map(|name| {
            let index = scope.basis_index(&name.text);
            if index.is_none() {
                report.push(scope.unknown_basis(Kind::UnknownSymbol, name));
            }
            index
        });
        let value = bracket_value(&bracket.value, scope, budget, report);
        let ([Some(a), Some(b)], Some(value)) = (ends, value) else {
            complete = false;
            continue;
        };
        let (left, right) = (&bracket.left.text, &bracket.right.text);
        if a == b {
            if !value.is_empty() {
                report.push(
                    Diagnostic::new(
                        Kind::Antisymmetry,
                        bracket.origin,
                        format!(
                            "[{left}, {left}] = {}, but an antisymmetric bracket makes it zero",
                            scope.display(&value)
                        ),
                    )
                    .help("remove this bracket"),
                );
                complete = false;
            }
            continue;
        }
        let (pair, form) = if a < b {
            ((a, b), value)
        } else {
            (
                (b, a),
                value.into_iter().map(|(k, v)| (k, v.neg())).collect(),
            )
        };
        let Some((first, origin)) = known.get(&pair) else {
            known.insert(pair, (form, bracket));
            continue;
        };
        match same(first, &form, budget) {
            Ok(true) => {}
            Ok(false) => {
                let flipped = origin.left.text != *left;
                let shown: Form = if (a < b) != flipped {
                    first.clone()
                } else {
                    first.iter().map(|(k, v)| (*k, v.neg())).collect()
                };
                let earlier = format!(
                    "[{}, {}] = {}",
                    origin.left.text,
                    origin.right.text,
                    scope.display(&shown)
                );
                let diagnostic = if flipped {
                    let negative: Form = shown.iter().map(|(k, v)| (*k, v.neg())).collect();
                    Diagnostic::new(
                        Kind::Antisymmetry,
                        bracket.origin,
                        format!(
                            "[{left}, {right}] disagrees with {earlier}: a bracket is antisymmetric"
                        ),
                    )
                    .help(format!(
                        "write [{left}, {right}] = {}, or leave it out",
                        scope.display(&negative)
                    ))
                } else {
                    Diagnostic::new(
                        Kind::DuplicateBracket,
                        bracket.origin,
                        format!("[{left}, {right}] was already given another value: {earlier}"),
                    )
                    .help("keep one of the two")
                };
                report.push(diagnostic);
                complete = false;
            }
            Err(Exhausted) => {
                report.push(
                    Diagnostic::new(
                        Kind::Limit,
                        bracket.origin,
                        "the brackets are too large to be compared exactly",
                    )
                    .help("simplify their coefficients"),
                );
                return None;
            }
        }
    }
    let entries = known
        .into_iter()
        .flat_map(|((i, j), (form, _))| form.into_iter().map(move |(k, v)| (i, j, k, v)));
    complete.then(|| StructureConstants::new(scope.basis().len(), entries.collect()))
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
