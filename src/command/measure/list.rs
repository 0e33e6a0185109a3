//! Lists of methods: `midpoint,lie-midpoint --retraction cayley,compose4(midpoint)`.

use lie_codegen::methods::Choice;
use lie_codegen::structure::Structure;
use lie_in_process::request::{Front, OptionValue, method};

use crate::message::Message;

/// The methods of a list. An id without options stands for every option that applies.
///
/// # Errors
/// Every mistake, at its place in the list.
pub fn parse(text: &str, model: &Structure) -> Result<Vec<Choice>, Vec<Message>> {
    let whole = OptionValue::flag("--methods", text);
    let mut choices: Vec<Choice> = Vec::new();
    let mut mistakes = Vec::new();
    for given in whole.split() {
        let place = given.wrong("").place;
        match method::expand(&given.text, model, Front::Command) {
            Ok(chosen) => {
                for choice in chosen {
                    if !choices.contains(&choice) {
                        choices.push(choice);
                    }
                }
            }
            Err(message) => mistakes.push(message.at_place(place)),
        }
    }
    if mistakes.is_empty() {
        Ok(choices)
    } else {
        Err(mistakes)
    }
}
