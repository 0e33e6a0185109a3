//! What `lie check` says of brackets and their signs.

use std::fmt::Write as _;

use lie_codegen::structure::{Structure, directions};
use lie_in_process::report::signs::sentences;
use lie_program::protocol::Start;

use super::{list, sentence};

/// More brackets are not listed in words.
const MOST: usize = 60;

/// The brackets of the state, and which way time and vectors go by them.
pub(super) fn write(
    model: &Structure,
    start: Option<&Start>,
    text: &mut String,
) -> std::fmt::Result {
    let title = match model.is_almost_poisson() {
        true => "almost-Poisson brackets",
        false => "Poisson brackets",
    };
    let brackets = directions::brackets(model);
    let mut shown: Vec<&str> = brackets.iter().map(String::as_str).take(MOST).collect();
    let rest = brackets.len() - shown.len();
    let more = format!("and {rest} more, see --json");
    if rest > 0 {
        shown.push(&more);
    }
    match shown.is_empty() {
        true => writeln!(text, "  {title}: all are zero")?,
        false => list(text, &format!("  {title}: "), &shown)?,
    }
    for line in sentences(model, start) {
        sentence(text, &format!("    {line}"))?;
    }
    Ok(())
}
