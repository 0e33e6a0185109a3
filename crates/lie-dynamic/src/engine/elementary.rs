//! The elementary functions that compiled code calls: those of the numeric core, so that every back end gives the same digits.

use lie_runtime::Scalar;

/// A function of one number.
pub type Unary = extern "C" fn(f64) -> f64;
/// A function of two numbers.
pub type Binary = extern "C" fn(f64, f64) -> f64;

macro_rules! unary {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        $(extern "C" fn $name(x: f64) -> f64 { Scalar::$name(x) })+
        /// Those of one number, by the names of [`Elementary::name`](lie_core::Elementary::name).
        pub const UNARY: &[(&str, Unary)] = &[$((stringify!($name), $name)),+];
    };
}
lie_core::elementary_functions!(unary);

extern "C" fn atan2(y: f64, x: f64) -> f64 {
    Scalar::atan2(y, x)
}
extern "C" fn powf(x: f64, exponent: f64) -> f64 {
    Scalar::powf(x, exponent)
}

/// The angle of a point, and powers.
pub const BINARY: &[(&str, Binary)] = &[("atan2", atan2), ("powf", powf)];
