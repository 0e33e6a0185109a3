//! The blocks `dissipation`, `noise` and `inputs`.

use super::entry::{Entry, compact, inside};
use super::vectors;
use crate::ast::{Input, Name};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::entries::Line;
use crate::front::token::{Delimiter, TokenKind, split_commas};
use crate::front::{Names, driving, families, item};

/// `{ double-bracket(strength = alpha, metric = [[1, 0], [0, 2]]); }`; one with a mistake is left out.
pub fn dissipation(block: &[Entry<'_>], names: &Names, report: &mut Report) -> Vec<driving::Entry> {
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

/// `{ hamiltonian = sigma*x; force(m1 = s, m2 = s); }`
pub fn noise<'a>(block: &[Entry<'a>], report: &mut Report) -> Vec<driving::Noisy<'a>> {
    let mut all = Vec::new();
    for entry in block {
        let tokens = entry.tokens;
        let place = entry.origin();
        match tokens {
            [word, equals, value @ ..] if word.is_word("hamiltonian") && equals.is('=') => {
                let tokens = value.into();
                all.push(driving::Noisy::Hamiltonian(Line { tokens, place }));
            }
            [word, rest @ ..] if word.is_word("force") => {
                let parts = inside(rest, Delimiter::Parenthesis).unwrap_or_default();
                let mut lines = Vec::new();
                for part in split_commas(parts) {
                    let parts =
                        item::definition_of(families::target, part, "a force", place, report);
                    lines.extend(parts.map(|(name, value)| {
                        let (tokens, place) = (value.into(), name.origin);
                        (name, Line { tokens, place })
                    }));
                }
                all.push(driving::Noisy::Force(lines, place));
            }
            _ => {
                let message = "a noise is along a Hamiltonian, or a force";
                let help = "write `hamiltonian = sigma*x;` or `force(m1 = s);`";
                report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
            }
        }
    }
    all
}

/// `{ u = 0; w = 1/2, sampling = 1/10; }`
pub fn inputs(block: &[Entry<'_>], report: &mut Report) -> Vec<Input> {
    let entries = block.iter();
    entries.filter_map(|entry| input(entry, report)).collect()
}

fn input(entry: &Entry<'_>, report: &mut Report) -> Option<Input> {
    let (name, value) = item::definition(entry.tokens, "an input", entry.origin(), report)?;
    let parts = split_commas(value);
    let [default, rest @ ..] = parts.as_slice() else {
        report.push(item::missing_constant(name.origin));
        return None;
    };
    if default.is_empty() {
        report.push(item::missing_constant(name.origin));
        return None;
    }
    let default = item::constant(default, report)?;
    let mut sampling = None;
    for part in rest {
        let (word, value) =
            item::definition(part, "what belongs to an input", name.origin, report)?;
        if word.text != "sampling" {
            let message = format!("an input has no `{}`", word.text);
            let help = "write `, sampling = 1/10` for the time from one sampling to the next";
            report.push(Diagnostic::new(Kind::Syntax, word.origin, message).help(help));
            return None;
        }
        sampling = Some(item::constant(value, report)?);
    }
    Some(Input {
        name,
        default,
        sampling,
    })
}
