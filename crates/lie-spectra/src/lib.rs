//! What a motion is about: how fast neighbours part ([`exponents`]), and of which frequencies it is made ([`frequencies`]).
//!
//! The first takes a system and a method over dual numbers, the second the samples of a signal. Neither knows of declarations.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod blocks;
pub mod exponents;
mod fourier;
mod frame;
pub mod frequencies;
mod lines;
mod random;
mod window;
