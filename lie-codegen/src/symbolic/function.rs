//! The elementary functions of the grammar. A square root is the power 1/2, not a function here.

macro_rules! functions {
    ($($name:ident $text:literal $arity:literal),+ $(,)?) => {
        /// An elementary function.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Function { $(#[doc = concat!("`", $text, "`")] $name),+ }
        impl Function {
            /// Every function.
            pub const ALL: &'static [Function] = &[$(Function::$name),+];
            /// Its name in the grammar, and in generated code.
            pub fn name(self) -> &'static str {
                match self { $(Function::$name => $text),+ }
            }
            /// The number of its arguments.
            pub fn arity(self) -> usize {
                match self { $(Function::$name => $arity),+ }
            }
        }
    };
}
functions! {
    Exp "exp" 1, Log "log" 1, Sin "sin" 1, Cos "cos" 1, Tan "tan" 1, Asin "asin" 1, Acos "acos" 1,
    Atan "atan" 1, Sinh "sinh" 1, Cosh "cosh" 1, Tanh "tanh" 1, Atan2 "atan2" 2,
}

impl Function {
    /// The function of that name; `sqrt` is none of them.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|f| f.name() == name)
    }

    /// The function in double precision, by the library that generated code uses: the same on every
    /// machine.
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
            Function::Atan2 => libm::atan2(x, arguments[1]),
        }
    }
}
