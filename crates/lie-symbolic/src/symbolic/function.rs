//! The elementary functions of the grammar, and those that closed forms of the exponential are made of. Square roots
//! are powers, not functions here.

use std::fmt;

use lie_core::{Elementary, closed};

use super::Opaque;

/// An elementary function, or a choice.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// One of one number.
    Elementary(Elementary),
    /// The angle of a point: `atan2(y, x)`.
    Atan2,
    /// The Stumpff function `S_k(w) = sum_n (-w)^n/(2n + k)!`; not in the grammar.
    Stumpff(u8),
    /// `phi_k(z) = sum_n z^n/(n + k)!`; not in the grammar.
    Phi(u8),
    /// `below(g, a, b)`: a where g is negative, b elsewhere. In the grammar these are `abs`, `min`, `max` and
    /// `piecewise`.
    Below,
    /// A function of the user, or a derivative of it.
    Own(Opaque),
}

impl From<Elementary> for Function {
    fn from(function: Elementary) -> Self {
        Self::Elementary(function)
    }
}

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Elementary(function) => function.fmt(f),
            Self::Atan2 => f.write_str("Atan2"),
            Self::Stumpff(k) => f.debug_tuple("Stumpff").field(k).finish(),
            Self::Phi(k) => f.debug_tuple("Phi").field(k).finish(),
            Self::Below => f.write_str("Below"),
            Self::Own(own) => f.debug_tuple("Own").field(own).finish(),
        }
    }
}

/// Functions of the grammar that are powers: `sqrt(x) = x^(1/2)`, `hypot(x, y) = (x^2 + y^2)^(1/2)`.
pub const POWERS: [&str; 2] = ["sqrt", "hypot"];

/// Functions of the grammar that are made of [`Function::Below`].
pub const CHOICES: [&str; 4] = ["abs", "min", "max", "piecewise"];

/// The names of the functions of closed forms.
const STUMPFF: [&str; closed::MOST_FUNCTIONS] = [
    "S0", "S1", "S2", "S3", "S4", "S5", "S6", "S7", "S8", "S9", "S10", "S11", "S12", "S13",
];
const PHI: [&str; closed::MOST_FUNCTIONS] = [
    "phi0", "phi1", "phi2", "phi3", "phi4", "phi5", "phi6", "phi7", "phi8", "phi9", "phi10",
    "phi11", "phi12", "phi13",
];

impl Function {
    /// The slope of a function of closed forms.
    pub fn slope_of_closed(self, x: f64) -> Option<f64> {
        match self {
            Function::Stumpff(k) => {
                let of = |k: u8| closed::stumpff_of(k.into(), x);
                Some(0.5 * (f64::from(k) * of(k + 2) - of(k + 1)))
            }
            Function::Phi(k) => {
                let of = |k: u8| closed::phi_of(k.into(), x);
                Some(of(k) - f64::from(k) * of(k + 1))
            }
            _ => None,
        }
    }

    /// Every function of the grammar but powers and choices.
    pub fn all() -> impl Iterator<Item = Self> {
        let elementary = Elementary::ALL.iter().copied().map(Self::Elementary);
        elementary.chain([Self::Atan2])
    }

    /// Its name in the grammar, and in generated code.
    pub fn name(self) -> &'static str {
        match self {
            Function::Elementary(function) => function.name(),
            Function::Atan2 => "atan2",
            Function::Stumpff(k) => STUMPFF[usize::from(k)],
            Function::Phi(k) => PHI[usize::from(k)],
            Function::Below => "below",
            Function::Own(own) => &own.declared().name,
        }
    }

    /// The number of its arguments.
    pub fn arity(self) -> usize {
        match self {
            Function::Elementary(_) | Function::Stumpff(_) | Function::Phi(_) => 1,
            Function::Atan2 => 2,
            Function::Below => 3,
            Function::Own(own) => own.declared().arity,
        }
    }

    /// The names of all functions of the grammar.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::all().map(Self::name).chain(POWERS).chain(CHOICES)
    }

    /// Whether a function of the grammar has that name.
    pub fn is_name(name: &str) -> bool {
        Self::names().any(|known| known == name)
    }

    /// The function of that name; those that are powers or choices are none of them.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|f| f.name() == name)
    }

    /// The function in double precision, by the library that generated code uses: the same on every
    /// machine. Of a function of the user it is that of another one, which stands in.
    pub fn evaluate(self, arguments: &[f64]) -> f64 {
        let x = arguments[0];
        match self {
            Function::Elementary(function) => function.evaluate(x),
            Function::Atan2 => libm::atan2(x, arguments[1]),
            Function::Stumpff(k) => closed::stumpff_of(k.into(), x),
            Function::Phi(k) => closed::phi_of(k.into(), x),
            Function::Below => arguments[chosen(x < 0.0)],
            Function::Own(own) => own.stand_in(arguments),
        }
    }
}

/// Which argument of [`Function::Below`] is its value, by whether the first one is negative.
pub fn chosen(negative: bool) -> usize {
    if negative { 1 } else { 2 }
}
