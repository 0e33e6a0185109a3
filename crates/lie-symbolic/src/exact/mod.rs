//! Exact numbers: the compiler never computes in floats before it emits.
mod ball;
mod budget;
pub mod elimination;
mod fraction;
pub mod matrix;
mod monomial;
mod polynomial;
mod rational;
mod residue;
pub mod span;
pub use ball::{Ball, Precision};
pub use budget::{Budget, Exhausted};
pub use fraction::Fraction;
pub use monomial::Monomial;
pub use polynomial::Polynomial;
pub use rational::Rational;
pub use residue::Residue;
