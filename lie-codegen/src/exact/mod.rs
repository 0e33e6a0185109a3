//! Exact numbers: the compiler never computes in floats before it emits.
mod rational;
pub use rational::Rational;
