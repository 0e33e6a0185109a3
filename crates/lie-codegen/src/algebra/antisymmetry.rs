//! What is said of brackets that are not antisymmetric, those of a basis and those of coordinates.

use lie_syntax::ast::Bracket;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// The signs around a bracket.
pub type Signs = [char; 2];
/// Those of basis elements.
pub const BASIS: Signs = ['[', ']'];
/// Those of coordinates.
pub const COORDINATES: Signs = ['{', '}'];

fn shown(bracket: &Bracket, [open, close]: Signs) -> String {
    let (left, right) = (&bracket.left.text, &bracket.right.text);
    format!("{open}{left}, {right}{close}")
}

/// A bracket of something with itself that is not zero.
pub fn with_itself(bracket: &Bracket, signs: Signs, value: &str) -> Diagnostic {
    let shown = shown(bracket, signs);
    let message = format!("{shown} = {value}, but an antisymmetric bracket makes it zero");
    Diagnostic::new(Kind::Antisymmetry, bracket.origin, message).help("remove this bracket")
}

/// A bracket that an earlier one contradicts. `own` is the value that the earlier one gives in the order in which it was written,
/// `turned` the value in the other order.
pub fn contradiction(
    bracket: &Bracket,
    earlier: &Bracket,
    signs: Signs,
    [own, turned]: [&str; 2],
) -> Diagnostic {
    let [here, before] = [bracket, earlier].map(|bracket| shown(bracket, signs));
    if earlier.left.text == bracket.left.text {
        let message = format!("{here} was already given another value: {before} = {own}");
        return Diagnostic::new(Kind::DuplicateBracket, bracket.origin, message)
            .help("keep one of the two");
    }
    let message = format!("{here} disagrees with {before} = {turned}: a bracket is antisymmetric");
    Diagnostic::new(Kind::Antisymmetry, bracket.origin, message)
        .help(format!("write {here} = {own}, or leave it out"))
}
