//! The block `observables`.

use super::entry::Entry;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::entries::{Line, Recorded};
use crate::front::item;
use crate::front::token::{Token, split_commas};

/// `{ height = z; phi = atan2(y, x), unwrap; }`
pub fn read<'a>(block: &[Entry<'a>], report: &mut Report) -> Vec<Recorded<'a>> {
    let mut read = Vec::new();
    for entry in block {
        let parts = item::definition(entry.tokens, "an observable", entry.origin(), report);
        let Some((name, value)) = parts else { continue };
        let (value, unwrap) = unwrapped(value, report);
        let place = name.origin;
        let tokens = value.into();
        read.push(Recorded {
            name,
            value: Line { tokens, place },
            unwrap,
        });
    }
    read
}

/// Splits `, unwrap` off an expression.
fn unwrapped<'a>(value: &'a [Token], report: &mut Report) -> (&'a [Token], bool) {
    let parts = split_commas(value);
    let [expression, words @ ..] = parts.as_slice() else {
        return (value, false);
    };
    for word in words {
        if !matches!(word, [word] if word.is_word("unwrap"))
            && let Some(token) = word.first().or(expression.last())
        {
            let message = "behind the expression of an observable stands `unwrap` or nothing";
            report.push(Diagnostic::new(Kind::Syntax, token.origin, message).help(
                "write `phi = atan2(y, x), unwrap;` for an angle whose jumps by 2 pi are taken out",
            ));
        }
    }
    (expression, !words.is_empty())
}
