//! The options of methods, by the names of their flags.

use super::Choice;
use crate::suggest::{did_you_mean, listed};

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

named! {
    /// The coefficients of a composition, `--composition`.
    Scheme, Suzuki {
        /// Five stages for each two orders.
        Suzuki = "suzuki",
        /// Three stages for each two orders.
        TripleJump = "triple-jump",
        /// Yoshida's solution A: seven stages, order 6.
        Yoshida = "yoshida",
        /// Kahan and Li: nine stages for order 6, seventeen for order 8.
        KahanLi = "kahan-li",
        /// Suzuki and Umeno: fifteen stages, order 8.
        SuzukiUmeno = "suzuki-umeno",
        /// Blanes and Moan: splittings with the fewest stages for their error.
        BlanesMoan = "blanes-moan",
        /// Strang: order 2.
        Strang = "strang",
        /// Laskar and Robutel: order 2, for two pieces, the second small, two stages.
        Saba2 = "saba2",
        /// The same with four stages.
        Saba4 = "saba4",
        /// Laskar and Robutel: order 2, for two pieces, the first small, two stages.
        Sbab2 = "sbab2",
        /// The same with four stages.
        Sbab4 = "sbab4",
        /// McLachlan: order (8, 4), for two pieces, the second small, five stages.
        McLachlan84 = "mclachlan-8-4",
    }
}

impl Scheme {
    /// The schemes of a composition of an order; the first is the default.
    pub const fn of_composition(order: u32) -> &'static [Self] {
        match order {
            4 => &[Self::Suzuki, Self::TripleJump],
            6 => &[Self::KahanLi, Self::Yoshida, Self::Suzuki, Self::TripleJump],
            8 => &[Self::KahanLi, Self::SuzukiUmeno],
            _ => &[],
        }
    }

    /// Whether it is for two pieces one of which is small.
    pub const fn is_near_integrable(self) -> bool {
        matches!(
            self,
            Self::Saba2 | Self::Saba4 | Self::Sbab2 | Self::Sbab4 | Self::McLachlan84
        )
    }

    /// The schemes of a splitting of an order; the first is the default.
    pub const fn of_splitting(order: u32) -> &'static [Self] {
        match order {
            2 => &[
                Self::Strang,
                Self::Saba2,
                Self::Saba4,
                Self::Sbab2,
                Self::Sbab4,
            ],
            4 => &[
                Self::BlanesMoan,
                Self::Suzuki,
                Self::TripleJump,
                Self::McLachlan84,
            ],
            6 => &[
                Self::BlanesMoan,
                Self::KahanLi,
                Self::Yoshida,
                Self::Suzuki,
                Self::TripleJump,
            ],
            8 => &[Self::KahanLi, Self::SuzukiUmeno],
            _ => &[],
        }
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

fn pick<T: Copy + PartialEq>(
    what: &str,
    text: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<T, OptionError> {
    all.iter()
        .copied()
        .find(|value| name(*value) == text)
        .ok_or_else(|| {
            let names: Vec<&str> = all.iter().map(|value| name(*value)).collect();
            let near = did_you_mean(text, names.iter().copied());
            let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
            OptionError::Value(
                format!("--{what} has no value `{text}`"),
                format!("{near}here it may be {}", listed(&names)),
            )
        })
}

impl Lift {
    /// Those of the collective method of an order: from order 8 on the stages are evaluated together on the points of a linear
    /// space, the smallest one unless another is asked for.
    pub fn of_collective(order: u32) -> &'static [Self] {
        if order > 6 {
            &[
                Self::Smallest,
                Self::Hopf,
                Self::Quaternion,
                Self::Representation,
            ]
        } else {
            &[Self::Representation, Self::Hopf, Self::Spec]
        }
    }
}

impl Choice {
    /// The same method with an option set; the options of a composition are those of its base, and
    /// its own.
    ///
    /// # Errors
    /// The option is none of this method, or its value none of the option.
    pub fn with_option(self, option: &str, value: &str) -> Result<Self, OptionError> {
        Ok(match (self, option) {
            (Self::LieMidpoint(_), "retraction") => {
                Self::LieMidpoint(pick(option, value, Retraction::ALL, Retraction::name)?)
            }
            (Self::Variational(2, _), "retraction") => {
                Self::Variational(2, pick(option, value, Retraction::ALL, Retraction::name)?)
            }
            (Self::DiscreteEulerPoincare(_), "retraction") => {
                Self::DiscreteEulerPoincare(pick(option, value, Retraction::ALL, Retraction::name)?)
            }
            (Self::Generating(order, _), "retraction") => Self::Generating(
                order,
                pick(option, value, Retraction::ALL, Retraction::name)?,
            ),
            (Self::Collective(order, _), "lift") => {
                let all = Lift::of_collective(order);
                Self::Collective(order, pick(option, value, all, Lift::name)?)
            }
            (Self::DiscreteGradient(gradient, _), "tensor") => {
                let tensor = pick(option, value, Tensor::ALL, Tensor::name)?;
                Self::DiscreteGradient(gradient, tensor)
            }
            (Self::OrbitEnergy(_), "gradient") => {
                Self::OrbitEnergy(pick(option, value, Gradient::ALL, Gradient::name)?)
            }
            (Self::Splitting(order, _, pieces), "composition") if order > 1 => {
                let all = Scheme::of_splitting(order);
                Self::Splitting(order, pick(option, value, all, Scheme::name)?, pieces)
            }
            (Self::Splitting(order, scheme, _), "pieces") => {
                let all = Pieces::ALL;
                Self::Splitting(order, scheme, pick(option, value, all, Pieces::name)?)
            }
            (Self::Compose(order, _, base), "composition") => {
                let all = Scheme::of_composition(order);
                Self::Compose(order, pick(option, value, all, Scheme::name)?, base)
            }
            (Self::Compose(order, scheme, base), _) => {
                Self::Compose(order, scheme, Box::new(base.with_option(option, value)?))
            }
            _ => return Err(OptionError::Foreign),
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
            | Self::Variational(2, retraction)
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

    /// The method with every combination of its options, the default first.
    pub fn variants(&self) -> Vec<Self> {
        match self {
            Self::LieMidpoint(_) => Retraction::ALL
                .iter()
                .map(|r| Self::LieMidpoint(*r))
                .collect(),
            Self::Variational(2, _) => Retraction::ALL
                .iter()
                .map(|r| Self::Variational(2, *r))
                .collect(),
            Self::DiscreteEulerPoincare(_) => Retraction::ALL
                .iter()
                .map(|r| Self::DiscreteEulerPoincare(*r))
                .collect(),
            Self::Generating(order, _) => Retraction::ALL
                .iter()
                .map(|r| Self::Generating(*order, *r))
                .collect(),
            Self::Collective(order, _) => Lift::of_collective(*order)
                .iter()
                .map(|l| Self::Collective(*order, *l))
                .collect(),
            Self::DiscreteGradient(gradient, _) => Tensor::ALL
                .iter()
                .map(|tensor| Self::DiscreteGradient(*gradient, *tensor))
                .collect(),
            Self::OrbitEnergy(_) => Gradient::ALL
                .iter()
                .map(|g| Self::OrbitEnergy(*g))
                .collect(),
            Self::Splitting(order, scheme, _) => {
                let schemes = Scheme::of_splitting(*order);
                let default = schemes.first().copied().unwrap_or(*scheme);
                let of = |scheme| Self::Splitting(*order, scheme, Pieces::Found);
                let mut all = vec![of(default)];
                all.extend(schemes.iter().skip(1).map(|scheme| of(*scheme)));
                all.push(Self::Splitting(*order, default, Pieces::Coordinate));
                all
            }
            Self::Compose(order, _, base) => {
                let schemes = Scheme::of_composition(*order);
                let mut bases = base.variants();
                bases.retain(|base| !base.is_near_integrable());
                let of = |scheme: &Scheme| {
                    let scheme = *scheme;
                    bases
                        .iter()
                        .map(move |base| Self::Compose(*order, scheme, Box::new(base.clone())))
                        .collect::<Vec<_>>()
                };
                schemes.iter().flat_map(of).collect()
            }
            other => vec![other.clone()],
        }
    }
}
