//! Methods as options name them.

use lie_codegen::diagnostic::Kind;
use lie_codegen::methods::{self, Choice, Method, Retraction};
use lie_codegen::model::Model;

use crate::message::Message;

/// The method of an id, with its default options.
///
/// # Errors
/// `method` if there is none, or none yet.
pub fn find(id: &str) -> Result<Choice, Message> {
    Choice::from_id(id)
        .map_err(|unusable| Message::new(Kind::Method, unusable.message).help(unusable.help))
}

/// Whether the method of a choice has an option of this name.
pub fn takes(choice: Choice, option: &str) -> bool {
    options(choice).any(|(name, _)| name == option)
}

/// Chooses the retraction; a method without one stays as it is.
///
/// # Errors
/// The help for a name that is none.
pub fn with_retraction(choice: Choice, name: &str) -> Result<Choice, &'static str> {
    let retraction = match name {
        "exp" => Retraction::Exp,
        "cayley" => Retraction::Cayley,
        _ => return Err("the retractions are exp and cayley"),
    };
    Ok(match choice {
        Choice::LieMidpoint(_) => Choice::LieMidpoint(retraction),
        other => other,
    })
}

/// Whether a method can integrate a system.
///
/// # Errors
/// `method`, why not, and what can.
pub fn applies(choice: Choice, model: &Model) -> Result<Choice, Message> {
    match methods::refusal(model, choice) {
        None => Ok(choice),
        Some((reason, remedy)) => {
            let text = format!(
                "`{}` does not apply to {}: {reason}",
                choice.label(),
                model.name
            );
            Err(Message::new(Kind::Method, text).help(remedy))
        }
    }
}

/// What to write about the options of a method.
pub fn help_on_options(choice: Choice) -> String {
    let names: Vec<String> = options(choice)
        .map(|(name, _)| format!("`--{name}`"))
        .collect();
    match names.as_slice() {
        [] => format!("{} has no options of its own; leave it out", choice.id()),
        names => format!("{} takes {}", choice.id(), names.join(" and ")),
    }
}

/// For people: `lie-midpoint (cayley)`.
pub fn title(choice: Choice) -> String {
    match choice {
        Choice::LieMidpoint(Retraction::Cayley) => "lie-midpoint (cayley)".to_owned(),
        other => other.id().to_owned(),
    }
}

fn options(choice: Choice) -> impl Iterator<Item = (&'static str, &'static str)> {
    let entry: Option<&'static Method> = methods::find(choice.id());
    entry
        .into_iter()
        .flat_map(|entry| entry.options.iter().copied())
}
