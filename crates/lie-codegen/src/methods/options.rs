//! The options of methods, by the names of their flags.

pub use lie_core::methods::Scheme;

use super::Choice;
use super::rows::Row;
use lie_syntax::suggest::{did_you_mean, listed};

macro_rules! named {
    ($(#[$doc:meta])* $type:ident, $default:ident { $($(#[$variant_doc:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $type {
            $($(#[$variant_doc])* $variant,)+
        }

        impl $type {
            /// Every value, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The value as an option spells it.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// The value of a name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|value| value.name() == name)
            }
        }

        impl Default for $type {
            fn default() -> Self {
                Self::$default
            }
        }
    };
}

named! {
    /// A retraction `tau: g -> G`, `--retraction`.
    Retraction, Exp {
        /// The exponential map.
        Exp = "exp",
        /// The Cayley map of the declared representation.
        Cayley = "cayley",
        /// The declared retraction.
        Spec = "spec",
    }
}

named! {
    /// A canonical space over g*, `--lift`.
    Lift, Representation {
        /// `T*V` of the declared representation V.
        Representation = "representation",
        /// `T*R^2` by the Hopf map, for so(3).
        Hopf = "hopf",
        /// The points of the declared realization.
        Spec = "spec",
        /// `T*H`, H the quaternions, for so(3) with vectors.
        Quaternion = "quaternion",
        /// `C^(N x (N-1))`, for anti-Hermitian matrices of N complex rows.
        Unitary = "unitary",
        /// The smallest linear space that there is.
        Smallest = "smallest",
    }
}

named! {
    /// A discrete gradient, `--gradient`.
    Gradient, Gonzalez {
        /// The midpoint discrete gradient.
        Gonzalez = "gonzalez",
        /// The mean value along the segment.
        MeanValue = "mean-value",
        /// Coordinate increments, symmetrised.
        ItohAbe = "itoh-abe",
    }
}

named! {
    /// The Poisson tensor of a discrete gradient method, `--tensor`.
    Tensor, Midpoint {
        /// `Pi((mu + mu1)/2)`.
        Midpoint = "midpoint",
        /// `(Pi(mu) + Pi(mu1))/2`.
        Mean = "mean",
    }
}

named! {
    /// The pieces of a splitting, `--pieces`.
    Pieces, Found {
        /// The fewest pieces with exact flows that are found, the longest in the middle.
        Found = "found",
        /// The functions of one coordinate each that H is the sum of, in their order.
        Coordinate = "coordinate",
    }
}

/// Why an option cannot be set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OptionError {
    /// The method has no option of this name.
    Foreign,
    /// The option has no such value: what is wrong, and what there is.
    Value(String, String),
}

impl Choice {
    /// The same method with an option set; the options of a composition are those of its base, and
    /// its own.
    ///
    /// # Errors
    /// The option is none of this method, or its value none of the option.
    pub fn with_option(self, option: &str, value: &str) -> Result<Self, OptionError> {
        let others = |choice: &Self| {
            let mut options = choice.options();
            options.retain(|(name, _)| *name != option);
            options
        };
        let set = |choice: &Self| {
            let options = choice.options();
            let set = options.iter().find(|(name, _)| *name == option);
            set.map(|(_, value)| *value)
        };
        let unchanged = others(&self);
        let mut alternatives = self.alternatives();
        alternatives.retain(|choice| others(choice) == unchanged);
        let values: Vec<&str> = alternatives.iter().filter_map(set).collect();
        // tolerances are numbers, and arguments of a program
        if values.is_empty() || self.is_adaptive() {
            return Err(OptionError::Foreign);
        }
        let mut chosen = alternatives.iter();
        let chosen = chosen.find(|choice| set(choice) == Some(value));
        chosen.cloned().ok_or_else(|| {
            let near = did_you_mean(value, values.iter().copied());
            let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
            OptionError::Value(
                format!("--{option} has no value `{value}`"),
                format!("{near}here it may be {}", listed(&values)),
            )
        })
    }

    /// Whether its coefficients are for two pieces one of which is small.
    pub fn is_near_integrable(&self) -> bool {
        matches!(self, Self::Splitting(_, scheme, _) if scheme.is_near_integrable())
    }

    /// The options and their values, defaults included.
    pub fn options(&self) -> Vec<(&'static str, &'static str)> {
        match self {
            Self::LieMidpoint(retraction)
            | Self::Generating(_, retraction)
            | Self::Variational(_, retraction)
            | Self::DiscreteEulerPoincare(retraction) => {
                vec![("retraction", retraction.name())]
            }
            Self::Collective(_, lift) => vec![("lift", lift.name())],
            Self::OrbitEnergy(gradient) => vec![("gradient", gradient.name())],
            Self::DiscreteGradient(_, tensor) => vec![("tensor", tensor.name())],
            Self::Splitting(1, _, pieces) => vec![("pieces", pieces.name())],
            Self::Splitting(_, scheme, pieces) => {
                vec![("composition", scheme.name()), ("pieces", pieces.name())]
            }
            Self::Compose(_, scheme, base) => {
                let mut options = vec![("composition", scheme.name())];
                // that of the base is its default
                let of_base = base.options().into_iter();
                options.extend(of_base.filter(|(name, _)| *name != "composition"));
                options
            }
            Self::Dopri5 => vec![("rtol", "1e-6"), ("atol", "1e-9")],
            Self::Taylor | Self::LieTaylor => vec![("rtol", "1e-15")],
            _ => Vec::new(),
        }
    }

    /// The method with every combination of its options, the default first; of splittings the schemes with the pieces that
    /// are found, and others with the default scheme.
    pub fn variants(&self) -> Vec<Self> {
        let mut all = self.alternatives();
        if let Some(Self::Splitting(_, default, _)) = all.first().cloned() {
            all.retain(|choice| match choice {
                Self::Splitting(_, scheme, pieces) => {
                    *pieces == Pieces::Found || *scheme == default
                }
                _ => false,
            });
        }
        all
    }

    /// The method with every combination of its options, the default first.
    fn alternatives(&self) -> Vec<Self> {
        match self {
            Self::Splitting(order, scheme, _) => {
                let mut schemes: Vec<Scheme> = Scheme::of_splitting(*order).collect();
                if schemes.is_empty() {
                    schemes.push(*scheme);
                }
                let with = |pieces: &Pieces| {
                    let (order, pieces) = (*order, *pieces);
                    let schemes = schemes.iter();
                    schemes.map(move |scheme| Self::Splitting(order, *scheme, pieces))
                };
                Pieces::ALL.iter().flat_map(with).collect()
            }
            Self::Compose(order, _, base) => {
                let mut bases = base.variants();
                bases.retain(|base| !base.is_near_integrable());
                let with = |scheme| {
                    let bases = bases.iter().cloned();
                    bases.map(move |base| Self::Compose(*order, scheme, Box::new(base)))
                };
                Scheme::of_composition(*order).flat_map(with).collect()
            }
            Self::Generating(order, _) => {
                let retractions = [Retraction::Exp, Retraction::Cayley];
                retractions
                    .map(|tau| Self::Generating(*order, tau))
                    .to_vec()
            }
            _ => {
                let id = Row::find(self).id;
                let rows = Row::all().iter().filter(|row| row.id == id);
                rows.map(|row| row.choice.clone()).collect()
            }
        }
    }
}
