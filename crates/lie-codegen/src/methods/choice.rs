//! A method with its options, as asked for.

use super::options::{Gradient, Lift, OptionError, Pieces, Retraction, Scheme, Tensor};
use super::rows::Row;
use super::{CATALOGUE, find};
use lie_syntax::suggest::meant;

macro_rules! choice {
    ({} choices { $($variants:tt)* } $($rows:tt)*) => {
        /// A method with its options. Numbers are orders, except where stages are said.
        #[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Choice { $($variants)* }
    };
}
lie_core::for_each_method!(choice! {});

/// Why an id is no method that can be used: message and remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unusable {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl Choice {
    /// The method of an id, its options at their defaults.
    ///
    /// # Errors
    /// An id that is unknown.
    pub fn from_id(id: &str) -> Result<Self, Unusable> {
        let id = id.trim();
        if let Some((outer, base)) = id.strip_suffix(')').and_then(|id| id.split_once('(')) {
            return Self::composed(id, outer.trim(), base.trim());
        }
        let row = Row::all().iter().find(|row| row.id == id);
        match row.map(|row| &row.choice) {
            Some(Self::Compose(..)) => {
                return Err(Unusable {
                    message: format!("`{id}` needs the method that it composes"),
                    help: format!("write for example `{id}(lie-midpoint)`"),
                });
            }
            Some(choice) => return Ok(choice.clone()),
            None => {}
        }
        if let Some((id, option)) = id.split_once(" --") {
            return Err(Unusable {
                message: format!("`--{option}` is not part of a method id"),
                help: format!(
                    "write `{}`: `methods` has every option that applies, and `run` has a key for each",
                    id.trim()
                ),
            });
        }
        if id.contains('(') {
            return Err(Unusable {
                message: format!("`{id}` has no `)` at its end"),
                help: format!("write `{id})`"),
            });
        }
        let known = CATALOGUE.iter().map(|m| m.id);
        Err(Unusable {
            message: format!("there is no method `{id}`"),
            help: match meant(id, known) {
                Some(near) => format!("did you mean `{near}`? `lie methods` lists all of them"),
                None => "`lie methods` lists them".into(),
            },
        })
    }

    /// `composeN(base)`.
    fn composed(id: &str, outer: &str, base: &str) -> Result<Self, Unusable> {
        let row = Row::all().iter().find(|row| row.id == outer);
        let Some(Self::Compose(order, scheme, _)) = row.map(|row| &row.choice) else {
            return Err(Unusable {
                message: format!("there is no method `{id}`"),
                help: "compositions are `compose4(ID)`, `compose6(ID)` and `compose8(ID)`".into(),
            });
        };
        let base = Self::from_id(base)?;
        let symmetric = base
            .entry()
            .is_some_and(|method| method.symmetric && method.order == 2);
        if !symmetric {
            return Err(Unusable {
                message: format!(
                    "`{outer}` composes symmetric methods of order 2, and `{}` is not one",
                    base.id()
                ),
                help: format!("take for example `{outer}(lie-midpoint)`"),
            });
        }
        Ok(Self::Compose(*order, *scheme, Box::new(base)))
    }

    /// A method from its label: an id, then options as on the command line,
    /// `lie-midpoint --retraction cayley`.
    ///
    /// # Errors
    /// An id that cannot be used, an option that the method does not have, or one that is there twice.
    pub fn from_label(label: &str) -> Result<Self, Unusable> {
        let id = label.split("--").next().unwrap_or_default().trim();
        if let (true, Some((_, options))) = (
            id.contains('(') && !id.ends_with(')'),
            label.split_once("--"),
        ) {
            let options = options.replacen(')', "", 1);
            return Err(Unusable {
                message: "the options of a composition stand behind its parenthesis".into(),
                help: format!("write `{id}) --{}`", options.trim()),
            });
        }
        let mut parts = label.split("--");
        let mut choice = Self::from_id(parts.next().unwrap_or_default())?;
        let mut names = Vec::new();
        for option in parts {
            let (name, value) = option
                .trim()
                .split_once([' ', '='])
                .unwrap_or((option.trim(), ""));
            let id = choice.id();
            if names.contains(&name) {
                return Err(Unusable {
                    message: format!("`--{name}` of {id} is there twice"),
                    help: "leave one of the two out".into(),
                });
            }
            names.push(name);
            choice = choice
                .with_option(name, value.trim())
                .map_err(|error| match error {
                    OptionError::Value(message, help) => Unusable { message, help },
                    OptionError::Foreign => Unusable {
                        message: format!("`{name}` does not choose a variant of {id}"),
                        help: "`lie methods` lists the options of each method; tolerances are flags of `lie run`"
                            .into(),
                    },
                })?;
        }
        Ok(choice)
    }

    /// The row of the catalogue.
    pub fn entry(&self) -> Option<&'static super::Method> {
        find(Row::find(self).id)
    }

    /// The id.
    pub fn id(&self) -> String {
        let id = Row::find(self).id;
        match self {
            Self::Compose(_, _, base) => format!("{id}({})", base.id()),
            _ => id.to_owned(),
        }
    }

    /// The id with the options that are not at their defaults, as [`Choice::from_label`] reads it.
    pub fn label(&self) -> String {
        let id = self.id();
        let defaults = Self::from_id(&id).map_or_else(|_| self.options(), |c| c.options());
        let options = self.options();
        let changed = options.iter().zip(&defaults).filter(|(a, b)| a != b);
        changed.fold(id, |label, ((name, value), _)| {
            format!("{label} --{name} {value}")
        })
    }

    /// For people, `lie-midpoint (cayley)`: the values of options that are not at their defaults.
    pub fn title(&self) -> String {
        let label = self.label();
        let mut parts = label.split(" --");
        let id = parts.next().unwrap_or_default().to_owned();
        let values: Vec<&str> = parts
            .filter_map(|option| option.split_once(' ').map(|(_, value)| value))
            .collect();
        if values.is_empty() {
            id
        } else {
            format!("{id} ({})", values.join(", "))
        }
    }

    /// Whether it chooses its own steps by tolerances.
    pub fn is_adaptive(&self) -> bool {
        self.options().iter().any(|(name, _)| *name == "rtol")
    }

    /// Whether its steps act by exponentials of elements that are not known beforehand.
    pub fn follows_exponentials(&self) -> bool {
        match self.solved() {
            Self::LieMidpoint(retraction)
            | Self::Variational(_, retraction)
            | Self::DiscreteEulerPoincare(retraction)
            | Self::Generating(_, retraction) => *retraction == Retraction::Exp,
            Self::LieEuler
            | Self::Rkmk(_)
            | Self::CrouchGrossman3
            | Self::CommutatorFree4
            | Self::EulerArnold2
            | Self::NinomiyaVictoir
            | Self::OrbitEnergy(_) => true,
            _ => false,
        }
    }

    /// Whether its generic equation needs the derivative of `phi1(ad*_x) mu` in x.
    pub fn follows_slopes(&self) -> bool {
        match self.solved() {
            Self::Variational(2, retraction) | Self::DiscreteEulerPoincare(retraction) => {
                *retraction == Retraction::Exp
            }
            Self::Generating(order, retraction) => *order > 2 && *retraction == Retraction::Exp,
            Self::EulerArnold2 => true,
            _ => false,
        }
    }

    /// Whether its step needs nothing of the system but its field.
    pub fn follows_field(&self) -> bool {
        matches!(self, Self::Rk4 | Self::Dopri5 | Self::Taylor)
    }

    /// Whether its step consists of steps of another.
    pub fn is_composed(&self) -> bool {
        matches!(self, Self::Compose(..) | Self::NinomiyaVictoir)
    }

    /// The methods whose equations this one solves: itself, or the base of a composition.
    pub fn solved(&self) -> &Self {
        match self {
            Self::Compose(_, _, base) => base,
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_option_that_is_there_twice_is_refused() {
        let label = "lie-midpoint --retraction cayley";
        assert!(Choice::from_label(label).is_ok());
        let twice = Choice::from_label(&format!("{label} --retraction exp"));
        let message = twice.map_err(|unusable| unusable.message);
        let expected = "`--retraction` of lie-midpoint is there twice";
        assert_eq!(message, Err(expected.to_owned()));
    }

    #[test]
    fn options_of_a_composition_stand_behind_it() {
        let inside = "compose4(lie-midpoint --retraction cayley)";
        let help = Choice::from_label(inside).map_err(|unusable| unusable.help);
        let right = "compose4(lie-midpoint) --retraction cayley";
        assert_eq!(help, Err(format!("write `{right}`")));
        assert!(Choice::from_label(right).is_ok());
    }
}
