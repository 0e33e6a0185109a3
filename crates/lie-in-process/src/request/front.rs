//! How options are written where a request is made.

use super::IN_CALLS;

/// Who asks: a command line, or a call from Python.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Front {
    /// `--step 0.1`.
    #[default]
    Command,
    /// `h=0.1`.
    Call,
}

impl Front {
    /// An option as it is written: `--step`, `h`.
    pub fn option(self, name: &str) -> String {
        let called = IN_CALLS.iter().find(|(known, _)| *known == name);
        match (self, called) {
            (Self::Command, _) => format!("--{name}"),
            (Self::Call, Some((_, called))) => (*called).to_owned(),
            (Self::Call, None) => name.replace('-', "_"),
        }
    }

    /// An option in a sentence, which a spec may have given too: `step`, `h`.
    pub fn named(self, name: &str) -> String {
        match self {
            Self::Command => name.to_owned(),
            Self::Call => self.option(name),
        }
    }

    /// The name of an option of which this is the spelling in calls.
    pub fn canonical(spelling: &str) -> String {
        let called = IN_CALLS.iter().find(|(_, called)| *called == spelling);
        called.map_or_else(
            || spelling.replace('_', "-"),
            |(name, _)| (*name).to_owned(),
        )
    }

    /// An option with a value: `--step 0.1` between backticks, `h=0.1`, `converge="state"`; the method alone.
    pub fn assignment(self, name: &str, value: &str) -> String {
        let option = self.option(name);
        let number = value.starts_with(|c: char| c.is_ascii_digit() || "-[".contains(c));
        match self {
            Self::Command => format!("`{option} {value}`"),
            Self::Call if name == "method" => format!("\"{value}\""),
            Self::Call if number => format!("{option}={value}"),
            Self::Call => format!("{option}=\"{value}\""),
        }
    }

    /// A parameter with a value: `--param k=2` between backticks, `k=2`.
    pub fn parameter(self, name: &str, value: &str) -> String {
        match self {
            Self::Command => format!("`--param {name}={value}`"),
            Self::Call => format!("{name}={value}"),
        }
    }

    /// What the compiler says to users of the command, in words for these.
    pub fn reword(self, text: &str) -> String {
        match self {
            Self::Command => text.to_owned(),
            Self::Call => text
                .replace("`lie methods`", "`System.methods()`")
                .replace("are flags of `lie run`", "are arguments of run"),
        }
    }
}
