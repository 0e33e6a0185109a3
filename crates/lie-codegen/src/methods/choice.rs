//! A method with its options, as asked for.

use super::options::{Gradient, Lift, OptionError, Pieces, Retraction, Scheme, Tensor};
use super::{CATALOGUE, find};
use crate::suggest::meant;

/// A method with its options. Numbers are orders, except where stages are said.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Choice {
    /// `midpoint`
    Midpoint,
    /// `gauss4`, `gauss6` and so on, as the catalogue has them: Gauss collocation with that many stages.
    Gauss(usize),
    /// `lie-midpoint`
    LieMidpoint(Retraction),
    /// `lie-euler`
    LieEuler,
    /// `rkmk2`, `rkmk3`, `rkmk4`, `rkmk6`
    Rkmk(u32),
    /// `cg3`
    CrouchGrossman3,
    /// `cf4`
    CommutatorFree4,
    /// `variational2`, `variational4`, `variational6`; only the first has another retraction than exp.
    Variational(u32, Retraction),
    /// `discrete-euler-poincare`
    DiscreteEulerPoincare(Retraction),
    /// `moser-veselov`
    MoserVeselov,
    /// `compose4(ID)`, `compose6(ID)`, `compose8(ID)` of a symmetric method of order 2.
    Compose(u32, Scheme, Box<Choice>),
    /// `generating2`, `generating4`, `generating6`
    Generating(u32, Retraction),
    /// `generating-second-kind2`
    GeneratingSecondKind2,
    /// `collective2` to `collective16`
    Collective(u32, Lift),
    /// `isospectral2` to `isospectral16`
    Isospectral(u32),
    /// `euler-arnold2`
    EulerArnold2,
    /// `spherical-midpoint`
    SphericalMidpoint,
    /// `splitting1`, `splitting2`, `splitting4`, `splitting6`, `splitting8`; of order 1 the
    /// scheme means nothing.
    Splitting(u32, Scheme, Pieces),
    /// `gonzalez`, `mean-value`, `itoh-abe`
    DiscreteGradient(Gradient, Tensor),
    /// `orbit-energy`
    OrbitEnergy(Gradient),
    /// `cohen-hairer2`, `cohen-hairer4`, … `cohen-hairer16`
    CohenHairer(u32),
    /// `exact`
    Exact,
    /// `rk4`
    Rk4,
    /// `dopri5`; its tolerances are arguments of the program.
    Dopri5,
    /// `taylor`; its tolerance is an argument of the program.
    Taylor,
    /// `lie-taylor`; its tolerance is an argument of the program.
    LieTaylor,
}

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
        if let Some(choice) = Self::plain(id) {
            return Ok(choice);
        }
        if matches!(id, "compose4" | "compose6" | "compose8") {
            return Err(Unusable {
                message: format!("`{id}` needs the method that it composes"),
                help: format!("write for example `{id}(lie-midpoint)`"),
            });
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
        let order = match outer {
            "compose4" => 4,
            "compose6" => 6,
            "compose8" => 8,
            _ => {
                return Err(Unusable {
                    message: format!("there is no method `{id}`"),
                    help: "compositions are `compose4(ID)`, `compose6(ID)` and `compose8(ID)`"
                        .into(),
                });
            }
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
        Ok(Self::Compose(
            order,
            Scheme::of_composition(order)[0],
            Box::new(base),
        ))
    }

    fn plain(id: &str) -> Option<Self> {
        let splitting = |order| {
            let scheme = Scheme::of_splitting(order).first();
            Self::Splitting(order, scheme.copied().unwrap_or_default(), Pieces::Found)
        };
        Some(match id {
            "midpoint" => Self::Midpoint,
            "lie-midpoint" => Self::LieMidpoint(Retraction::Exp),
            "lie-euler" => Self::LieEuler,
            "rkmk2" => Self::Rkmk(2),
            "rkmk3" => Self::Rkmk(3),
            "rkmk4" => Self::Rkmk(4),
            "rkmk6" => Self::Rkmk(6),
            "cg3" => Self::CrouchGrossman3,
            "cf4" => Self::CommutatorFree4,
            "variational2" => Self::Variational(2, Retraction::Exp),
            "variational4" => Self::Variational(4, Retraction::Exp),
            "variational6" => Self::Variational(6, Retraction::Exp),
            "discrete-euler-poincare" => Self::DiscreteEulerPoincare(Retraction::Exp),
            "moser-veselov" => Self::MoserVeselov,
            "generating2" => Self::Generating(2, Retraction::Exp),
            "generating4" => Self::Generating(4, Retraction::Exp),
            "generating6" => Self::Generating(6, Retraction::Exp),
            "generating-second-kind2" => Self::GeneratingSecondKind2,
            "collective2" => Self::Collective(2, Lift::Representation),
            "collective4" => Self::Collective(4, Lift::Representation),
            "collective6" => Self::Collective(6, Lift::Representation),
            "collective8" => Self::Collective(8, Lift::Smallest),
            "collective10" => Self::Collective(10, Lift::Smallest),
            "collective12" => Self::Collective(12, Lift::Smallest),
            "collective14" => Self::Collective(14, Lift::Smallest),
            "collective16" => Self::Collective(16, Lift::Smallest),
            "isospectral2" => Self::Isospectral(2),
            "isospectral4" => Self::Isospectral(4),
            "isospectral6" => Self::Isospectral(6),
            "isospectral8" => Self::Isospectral(8),
            "isospectral10" => Self::Isospectral(10),
            "isospectral12" => Self::Isospectral(12),
            "isospectral14" => Self::Isospectral(14),
            "isospectral16" => Self::Isospectral(16),
            "euler-arnold2" => Self::EulerArnold2,
            "spherical-midpoint" => Self::SphericalMidpoint,
            "splitting1" => splitting(1),
            "splitting2" => splitting(2),
            "splitting4" => splitting(4),
            "splitting6" => splitting(6),
            "splitting8" => splitting(8),
            "gonzalez" => Self::DiscreteGradient(Gradient::Gonzalez, Tensor::Midpoint),
            "mean-value" => Self::DiscreteGradient(Gradient::MeanValue, Tensor::Midpoint),
            "itoh-abe" => Self::DiscreteGradient(Gradient::ItohAbe, Tensor::Midpoint),
            "orbit-energy" => Self::OrbitEnergy(Gradient::Gonzalez),
            "exact" => Self::Exact,
            "rk4" => Self::Rk4,
            "dopri5" => Self::Dopri5,
            "taylor" => Self::Taylor,
            "lie-taylor" => Self::LieTaylor,
            _ => {
                let id = find(id)?.id;
                if let Some(order) = id.strip_prefix("cohen-hairer") {
                    return Some(Self::CohenHairer(order.parse().ok()?));
                }
                let order: usize = id.strip_prefix("gauss")?.parse().ok()?;
                Self::Gauss(order / 2)
            }
        })
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
        match self {
            Self::Compose(order, ..) => find(&format!("compose{order}")),
            other => find(&other.id()),
        }
    }

    /// The id.
    pub fn id(&self) -> String {
        match self {
            Self::Midpoint => "midpoint".into(),
            Self::Gauss(stages) => format!("gauss{}", 2 * stages),
            Self::LieMidpoint(_) => "lie-midpoint".into(),
            Self::LieEuler => "lie-euler".into(),
            Self::Rkmk(order) => format!("rkmk{order}"),
            Self::CrouchGrossman3 => "cg3".into(),
            Self::CommutatorFree4 => "cf4".into(),
            Self::Variational(order, _) => format!("variational{order}"),
            Self::DiscreteEulerPoincare(_) => "discrete-euler-poincare".into(),
            Self::MoserVeselov => "moser-veselov".into(),
            Self::Compose(order, _, base) => format!("compose{order}({})", base.id()),
            Self::Generating(order, _) => format!("generating{order}"),
            Self::GeneratingSecondKind2 => "generating-second-kind2".into(),
            Self::Collective(order, _) => format!("collective{order}"),
            Self::Isospectral(order) => format!("isospectral{order}"),
            Self::EulerArnold2 => "euler-arnold2".into(),
            Self::SphericalMidpoint => "spherical-midpoint".into(),
            Self::Splitting(order, ..) => format!("splitting{order}"),
            Self::DiscreteGradient(gradient, _) => gradient.name().into(),
            Self::OrbitEnergy(_) => "orbit-energy".into(),
            Self::CohenHairer(order) => format!("cohen-hairer{order}"),
            Self::Exact => "exact".into(),
            Self::Rk4 => "rk4".into(),
            Self::Dopri5 => "dopri5".into(),
            Self::Taylor => "taylor".into(),
            Self::LieTaylor => "lie-taylor".into(),
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
