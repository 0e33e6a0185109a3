//! The block `dissipation`.

use super::entry::{Entry, compact, inside};
use super::vectors;
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::token::{Delimiter, TokenKind, split_commas};
use crate::front::{Names, driving, item};

/// `{ double-bracket(strength = alpha, metric = [[1, 0], [0, 2]]); }`; one with a mistake is left out.
pub fn read(block: &[Entry<'_>], names: &Names, report: &mut Report) -> Vec<driving::Entry> {
    let entries = block.iter();
    entries
        .filter_map(|entry| one(entry, names, report))
        .collect()
}

fn one(entry: &Entry<'_>, names: &Names, report: &mut Report) -> Option<driving::Entry> {
    let open = TokenKind::Open(Delimiter::Parenthesis);
    let parenthesis = entry.tokens.iter().position(|token| token.kind == open);
    let head = &entry.tokens[..parenthesis.unwrap_or(entry.tokens.len())];
    let arguments = inside(&entry.tokens[head.len()..], Delimiter::Parenthesis);
    let Some(arguments) = arguments.filter(|_| !head.is_empty()) else {
        let message = "a dissipation is a kind with what belongs to it in parentheses";
        let help =
            "write `double-bracket(strength = 1/10);` or `rayleigh(matrix = [[1, 0], [0, 1]]);`";
        report.push(Diagnostic::new(Kind::Syntax, entry.origin(), message).help(help));
        return None;
    };
    let mut fields = Vec::new();
    for part in split_commas(arguments) {
        let what = "what belongs to a dissipation";
        let (name, value) = item::definition(part, what, entry.origin(), report)?;
        let value = vectors::value(&name, value, names, report)?;
        fields.push((name, value));
    }
    Some(driving::Entry {
        kind: Name {
            text: compact(head),
            origin: entry.origin(),
        },
        fields,
    })
}
