//! The elementary functions of the grammar, and those that closed forms of the exponential are made of. Square roots
//! are powers, not functions here.

use lie_core::closed;

use super::Opaque;

macro_rules! functions {
    ($($name:ident $text:literal $arity:literal),+ $(,)?) => {
        /// An elementary function.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Function {
            $(#[doc = concat!("`", $text, "`")] $name,)+
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
        impl Function {
            /// Every function of the grammar.
            pub const ALL: &'static [Function] = &[$(Function::$name),+];
            /// Its name in the grammar, and in generated code.
            pub fn name(self) -> &'static str {
                match self {
                    $(Function::$name => $text,)+
                    Function::Stumpff(k) => STUMPFF[usize::from(k)],
                    Function::Phi(k) => PHI[usize::from(k)],
                    Function::Below => "below",
                    Function::Own(own) => &own.declared().name,
                }
            }
            /// The number of its arguments.
            pub fn arity(self) -> usize {
                match self {
                    $(Function::$name => $arity,)+
                    Function::Stumpff(_) | Function::Phi(_) => 1,
                    Function::Below => 3,
                    Function::Own(own) => own.declared().arity,
                }
            }
        }
    };
}
functions! {
    Exp "exp" 1, Log "log" 1, Sin "sin" 1, Cos "cos" 1, Tan "tan" 1, Asin "asin" 1, Acos "acos" 1,
    Atan "atan" 1, Sinh "sinh" 1, Cosh "cosh" 1, Tanh "tanh" 1, Cbrt "cbrt" 1, Log1p "log1p" 1,
    Expm1 "expm1" 1, Asinh "asinh" 1, Acosh "acosh" 1, Atanh "atanh" 1, Atan2 "atan2" 2,
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

    /// The names of all functions of the grammar.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let own = Self::ALL.iter().map(|f| f.name());
        own.chain(POWERS).chain(CHOICES)
    }

    /// Whether a function of the grammar has that name.
    pub fn is_name(name: &str) -> bool {
        Self::names().any(|known| known == name)
    }

    /// The function of that name; those that are powers or choices are none of them.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|f| f.name() == name)
    }

    /// The function in double precision, by the library that generated code uses: the same on every
    /// machine. Of a function of the user it is that of another one, which stands in.
    pub fn evaluate(self, arguments: &[f64]) -> f64 {
        let x = arguments[0];
        match self {
            Function::Exp => libm::exp(x),
            Function::Log => libm::log(x),
            Function::Sin => libm::sin(x),
            Function::Cos => libm::cos(x),
            Function::Tan => libm::tan(x),
            Function::Asin => libm::asin(x),
            Function::Acos => libm::acos(x),
            Function::Atan => libm::atan(x),
            Function::Sinh => libm::sinh(x),
            Function::Cosh => libm::cosh(x),
            Function::Tanh => libm::tanh(x),
            Function::Cbrt => libm::cbrt(x),
            Function::Log1p => libm::log1p(x),
            Function::Expm1 => libm::expm1(x),
            Function::Asinh => libm::asinh(x),
            Function::Acosh => libm::acosh(x),
            Function::Atanh => libm::atanh(x),
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
