//! The elementary functions of one number, a row each.
//!
//! A row says what a function is called, what it is, which differential equation it solves, and where it is defined.
//! Everything that knows the functions one by one is made of the rows: the methods of [`Scalar`] and their forms over
//! lanes, dual numbers and series, the names of the grammar, the calculus of the compiler, and what compiled code calls.
//! Outside of this module a function has its rigorous bounds and, on purpose, the rules of the judge.

use crate::scalar::{Primitive, Scalar, elementary};
use core::marker::PhantomData;

/// Hands the rows to a macro.
///
/// A row is the variant of [`Elementary`], the name (of the method, in the grammar, and in `libm`), the name in `libm`
/// for single precision, where the values of double precision come from (`libm`; `program` for a straight line of arithmetic of ours,
/// [`Elementary::program`]; `angle` for such programs of angles, which are shorter where all are small), and what the function is; then, in
/// braces, the facts:
///
/// * `rule`: its differential equation, a call of a method of [`Rules`]
/// * `domain`: where it is real and finite, a [`Domain`]
/// * `odd`: whether `f(-x) = -f(x)`
/// * `exact`: its values at integers that are integers
#[macro_export]
macro_rules! elementary_functions {
    ($rows:ident) => {
        $rows! {
            Exp exp expf program "the exponential"
                { rule: exponential(), domain: Everywhere, odd: false, exact: [0 => 1] }
            Log log logf program "the natural logarithm"
                { rule: inverse(Quadratic::Argument), domain: Positive, odd: false, exact: [1 => 0] }
            Sin sin sinf angle "the sine of an angle in radians"
                { rule: sine(Curve::Circle), domain: Everywhere, odd: true, exact: [0 => 0] }
            Cos cos cosf angle "the cosine of an angle in radians"
                { rule: cosine(Curve::Circle), domain: Everywhere, odd: false, exact: [0 => 1] }
            Tan tan tanf angle "the tangent of an angle in radians"
                { rule: tangent(Curve::Circle), domain: NotRight, odd: true, exact: [0 => 0] }
            Asin asin asinf libm "the angle from -pi/2 to pi/2 whose sine is x"
                { rule: inverse_root(1, Quadratic::OneMinusSquare), domain: WithinOne, odd: true, exact: [0 => 0] }
            Acos acos acosf libm "the angle from 0 to pi whose cosine is x"
                { rule: inverse_root(-1, Quadratic::OneMinusSquare), domain: WithinOne, odd: false, exact: [1 => 0] }
            Atan atan atanf libm "the angle between -pi/2 and pi/2 whose tangent is x"
                { rule: inverse(Quadratic::OnePlusSquare), domain: Everywhere, odd: true, exact: [0 => 0] }
            Sinh sinh sinhf libm "the hyperbolic sine"
                { rule: sine(Curve::Hyperbola), domain: Everywhere, odd: true, exact: [0 => 0] }
            Cosh cosh coshf libm "the hyperbolic cosine"
                { rule: cosine(Curve::Hyperbola), domain: Everywhere, odd: false, exact: [0 => 1] }
            Tanh tanh tanhf libm "the hyperbolic tangent"
                { rule: tangent(Curve::Hyperbola), domain: Everywhere, odd: true, exact: [0 => 0] }
            Cbrt cbrt cbrtf libm "the cube root, of negative numbers too"
                { rule: cube_root(), domain: Everywhere, odd: true, exact: [0 => 0, 1 => 1] }
            Log1p log1p log1pf libm "log(1 + x), with all digits where x is small"
                { rule: inverse(Quadratic::OnePlus), domain: AboveMinusOne, odd: false, exact: [0 => 0] }
            Expm1 expm1 expm1f libm "exp(x) - 1, with all digits where x is small"
                { rule: integral(|words, x| words.apply(Elementary::Exp, x)), domain: Everywhere, odd: false, exact: [0 => 0] }
            Asinh asinh asinhf libm "the number whose hyperbolic sine is x"
                { rule: inverse_root(1, Quadratic::OnePlusSquare), domain: Everywhere, odd: true, exact: [0 => 0] }
            Acosh acosh acoshf libm "the number that is not negative and whose hyperbolic cosine is x"
                { rule: inverse_root(1, Quadratic::SquareMinusOne), domain: FromOne, odd: false, exact: [1 => 0] }
            Atanh atanh atanhf libm "the number whose hyperbolic tangent is x"
                { rule: inverse(Quadratic::OneMinusSquare), domain: BetweenOnes, odd: true, exact: [0 => 0] }
        }
    };
}

/// What the slope of an inverse function is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadratic {
    /// `x`
    Argument,
    /// `1 + x`
    OnePlus,
    /// `1 + x^2`
    OnePlusSquare,
    /// `1 - x^2`
    OneMinusSquare,
    /// `x^2 - 1`
    SquareMinusOne,
}

/// The curve whose points sine and cosine are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Curve {
    /// `c^2 + s^2 = 1`
    Circle,
    /// `c^2 - s^2 = 1`
    Hyperbola,
}

impl Curve {
    /// Its sine.
    pub fn sine(self) -> Elementary {
        match self {
            Curve::Circle => Elementary::Sin,
            Curve::Hyperbola => Elementary::Sinh,
        }
    }

    /// Its cosine.
    pub fn cosine(self) -> Elementary {
        match self {
            Curve::Circle => Elementary::Cos,
            Curve::Hyperbola => Elementary::Cosh,
        }
    }
}

/// Where a function is real and finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// At every number.
    Everywhere,
    /// `x > 0`
    Positive,
    /// `x > -1`
    AboveMinusOne,
    /// `x >= 1`
    FromOne,
    /// `-1 <= x <= 1`
    WithinOne,
    /// `-1 < x < 1`
    BetweenOnes,
    /// `cos(x) != 0`
    NotRight,
}

/// Numbers or expressions of which the slope of a function is made.
pub trait Words {
    /// A number or an expression.
    type Value: Clone;
    /// An integer.
    fn integer(&mut self, value: i32) -> Self::Value;
    /// `-a`
    fn negate(&mut self, a: &Self::Value) -> Self::Value;
    /// `a b`
    fn multiply(&mut self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// `a/b`
    fn divide(&mut self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// The square root.
    fn root(&mut self, a: &Self::Value) -> Self::Value;
    /// A quadratic function, by the form that suits the values.
    fn quadratic(&mut self, form: Quadratic, x: &Self::Value) -> Self::Value;
    /// An elementary function.
    fn apply(&mut self, function: Elementary, x: &Self::Value) -> Self::Value;
}

/// What is made of the differential equation of a function `y = f(x)`: its slope, its power series.
///
/// Where a rule has no better form, it is an integral over a formula.
pub trait Rules: Sized {
    /// What formulas are made of.
    type Words: Words;
    /// What is found.
    type Answer;

    /// `y' = g(x)`
    fn integral(
        self,
        slope: impl FnOnce(&mut Self::Words, &Value<Self>) -> Value<Self>,
    ) -> Self::Answer;
    /// `y' = y`
    fn exponential(self) -> Self::Answer;
    /// `y' = 1 + y^2` on the circle, `1 - y^2` on the hyperbola.
    fn tangent(self, curve: Curve) -> Self::Answer;
    /// `y' = 1/(3 y^2)`
    fn cube_root(self) -> Self::Answer;

    /// The derivative is the cosine.
    #[inline]
    fn sine(self, curve: Curve) -> Self::Answer {
        self.integral(|words, x| words.apply(curve.cosine(), x))
    }
    /// The derivative is the sine, of the circle with the other sign.
    #[inline]
    fn cosine(self, curve: Curve) -> Self::Answer {
        self.integral(|words, x| {
            let sine = words.apply(curve.sine(), x);
            match curve {
                Curve::Circle => words.negate(&sine),
                Curve::Hyperbola => sine,
            }
        })
    }
    /// `y' = 1/w(x)`
    #[inline]
    fn inverse(self, w: Quadratic) -> Self::Answer {
        self.integral(|words, x| {
            let (one, w) = (words.integer(1), words.quadratic(w, x));
            words.divide(&one, &w)
        })
    }
    /// `y' = 1/sqrt(w(x))`, or minus that.
    #[inline]
    fn inverse_root(self, sign: i32, w: Quadratic) -> Self::Answer {
        self.integral(|words, x| {
            let (mut one, w) = (words.integer(1), words.quadratic(w, x));
            if sign < 0 {
                one = words.negate(&one);
            }
            let root = words.root(&w);
            words.divide(&one, &root)
        })
    }
}

/// What the formulas of some rules are made of.
pub type Value<R> = <<R as Rules>::Words as Words>::Value;

macro_rules! program {
    (libm $name:ident $x:ident) => {
        None
    };
    ($from:ident $name:ident $x:ident) => {
        Some(elementary::$name($x))
    };
}

macro_rules! define {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal {
        rule: $rule:ident $form:tt, domain: $domain:ident, odd: $odd:literal, exact: [$($at:literal => $is:literal),*]
    })+) => {
        /// An elementary function of one number.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Elementary {
            $(#[doc = concat!("`", stringify!($name), "(x)`: ", $what, ".")] $variant,)+
        }

        impl Elementary {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its name in the grammar, and in generated code.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($name),)+
                }
            }
            /// What it is.
            pub const fn meaning(self) -> &'static str {
                match self {
                    $(Self::$variant => $what,)+
                }
            }
            /// The function over a scalar.
            #[inline]
            pub fn apply<S: Scalar>(self, x: S) -> S {
                match self {
                    $(Self::$variant => x.$name(),)+
                }
            }
            /// The function in double precision by `libm` alone.
            pub fn evaluate(self, x: f64) -> f64 {
                match self {
                    $(Self::$variant => libm::$name(x),)+
                }
            }
            /// The function as a straight line of arithmetic, of those that are one: of numbers of double precision the bits of
            /// [`Elementary::apply`].
            #[inline]
            pub fn program<P: Primitive>(self, x: P) -> Option<P> {
                match self {
                    $(Self::$variant => program!($from $name x),)+
                }
            }
            /// What its differential equation gives.
            pub fn rule<R: Rules>(self, rules: R) -> R::Answer {
                match self {
                    $(Self::$variant => rules.$rule $form,)+
                }
            }
            /// Where it is real and finite.
            pub fn domain(self) -> Domain {
                match self {
                    $(Self::$variant => Domain::$domain,)+
                }
            }
            /// Whether `f(-x) = -f(x)`.
            pub fn is_odd(self) -> bool {
                match self {
                    $(Self::$variant => $odd,)+
                }
            }
            /// Its value at an integer where that is known to be an integer.
            pub fn exact(self, x: i64) -> Option<i64> {
                match (self, x) {
                    $($((Self::$variant, $at) => Some($is),)*)+
                    _ => None,
                }
            }
        }
    };
}
elementary_functions!(define);

impl Elementary {
    /// The function of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|f| f.name() == name)
    }

    /// `f'(x)` from `x` and `f(x)`.
    pub fn slope<S: Scalar>(self, x: S, y: S) -> S {
        self.rule(Slope { x, y })
    }
}

/// Formulas over numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Numbers<S>(PhantomData<S>);

impl<S: Scalar> Words for Numbers<S> {
    type Value = S;
    #[inline]
    fn integer(&mut self, value: i32) -> S {
        S::from_f64(value.into())
    }
    #[inline]
    fn negate(&mut self, a: &S) -> S {
        -*a
    }
    #[inline]
    fn multiply(&mut self, a: &S, b: &S) -> S {
        *a * *b
    }
    #[inline]
    fn divide(&mut self, a: &S, b: &S) -> S {
        *a / *b
    }
    #[inline]
    fn root(&mut self, a: &S) -> S {
        a.sqrt()
    }
    /// Differences of squares are products, which keep their digits near a zero.
    #[inline]
    fn quadratic(&mut self, form: Quadratic, x: &S) -> S {
        let (one, x) = (S::one(), *x);
        match form {
            Quadratic::Argument => x,
            Quadratic::OnePlus => one + x,
            Quadratic::OnePlusSquare => one + x * x,
            Quadratic::OneMinusSquare => (one - x) * (one + x),
            Quadratic::SquareMinusOne => (x - one) * (x + one),
        }
    }
    #[inline]
    fn apply(&mut self, function: Elementary, x: &S) -> S {
        function.apply(*x)
    }
}

/// The slope of a function of numbers.
pub(crate) struct Slope<S> {
    pub(crate) x: S,
    pub(crate) y: S,
}

impl<S: Scalar> Rules for Slope<S> {
    type Words = Numbers<S>;
    type Answer = S;

    #[inline]
    fn integral(self, slope: impl FnOnce(&mut Numbers<S>, &S) -> S) -> S {
        slope(&mut Numbers(PhantomData), &self.x)
    }
    #[inline]
    fn exponential(self) -> S {
        self.y
    }
    #[inline]
    fn tangent(self, curve: Curve) -> S {
        let form = match curve {
            Curve::Circle => Quadratic::OnePlusSquare,
            Curve::Hyperbola => Quadratic::OneMinusSquare,
        };
        Numbers(PhantomData).quadratic(form, &self.y)
    }
    #[inline]
    fn cube_root(self) -> S {
        S::ratio(1.0, 3.0) / (self.y * self.y)
    }
}

#[cfg(test)]
mod tests;
