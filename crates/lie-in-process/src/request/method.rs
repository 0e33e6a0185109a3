//! Methods as options name them.

use lie_codegen::compile::with_options;
use lie_codegen::methods::{self, Choice};
use lie_codegen::structure::Structure;
use lie_syntax::diagnostic::Kind;

use super::Front;
use crate::message::Message;

/// The options by which a method is chosen; the others are numbers of a run.
pub const OPTIONS: [&str; 6] = [
    "retraction",
    "composition",
    "pieces",
    "lift",
    "gradient",
    "tensor",
];

/// The method of an id, possibly with options behind it: `lie-midpoint --retraction cayley`.
///
/// # Errors
/// `method` if there is none, or none yet, and an option that it does not have.
pub fn labelled(text: &str, front: Front) -> Result<Choice, Message> {
    if text.trim().is_empty() {
        let message = Message::new(Kind::Method, "the method is empty");
        return Err(message.help("name one, such as `lie-midpoint`, or leave it out"));
    }
    Choice::from_label(text.trim()).map_err(|unusable| {
        let help = front.reword(&unusable.help);
        Message::new(Kind::Method, unusable.message).help(help)
    })
}

/// The methods that an entry of a list stands for: with options the method alone, without them every option of it that
/// applies to a system.
///
/// # Errors
/// As of [`labelled`] and [`applies`].
pub fn expand(text: &str, model: &Structure, front: Front) -> Result<Vec<Choice>, Message> {
    let choice = labelled(text, front)?;
    let all = match text.contains("--") {
        true => Vec::new(),
        false => with_options(model, std::slice::from_ref(&choice)),
    };
    match all.is_empty() {
        true => applies(choice, model).map(|choice| vec![choice]),
        false => Ok(all),
    }
}

/// Whether a method has an option of this name.
pub fn takes(choice: &Choice, option: &str) -> bool {
    choice.options().iter().any(|(name, _)| *name == option)
}

/// Whether a method can integrate a system.
///
/// # Errors
/// `method`, why not, and what can.
pub fn applies(choice: Choice, model: &Structure) -> Result<Choice, Message> {
    match methods::refusal(model, &choice) {
        None => Ok(choice),
        Some((reason, remedy)) => {
            let text = format!(
                "`{}` does not apply to {}: {reason}",
                choice.label(),
                model.name
            );
            let kind = methods::kind_of_refusal(&choice);
            Err(Message::new(kind, text).help(remedy))
        }
    }
}

/// What to write about the options of a method.
pub fn help_on_options(choice: &Choice, front: Front) -> String {
    let options = choice.options();
    let names: Vec<String> = options
        .iter()
        .map(|(name, _)| format!("`{}`", front.option(name)))
        .collect();
    match names.as_slice() {
        [] => format!("{} has no options of its own; leave it out", choice.id()),
        names => format!("{} takes {}", choice.id(), names.join(" and ")),
    }
}
