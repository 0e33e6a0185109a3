//! Hostile specs: what a spec may ask for and should not get, or should get within bounds.

mod expressions;
mod forms;
pub mod spec;
mod systems;

use spec::Spec;

/// A spec that asks for much, or for what is wrong.
pub struct Case {
    /// What it does, in a few words; different for each.
    pub name: String,
    /// The text of the file.
    pub text: String,
}

fn case(name: &str, spec: impl Into<Text>) -> Case {
    Case {
        name: name.to_owned(),
        text: spec.into().0,
    }
}

/// A file as it is.
fn raw(text: &str) -> Text {
    Text(text.to_owned())
}

struct Text(String);

impl From<Spec> for Text {
    fn from(spec: Spec) -> Self {
        Self(spec.json())
    }
}

/// All of them, in the same order every time.
pub fn all() -> Vec<Case> {
    let mut cases = systems::cases();
    cases.extend(expressions::cases());
    cases.extend(forms::cases());
    cases
}
