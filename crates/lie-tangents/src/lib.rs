//! The methods of the catalogue over dual numbers: a step of one is a step with its tangent.
//!
//! `lie verify`, `lie stress` and `lie exponents` ask for them; runs do not. Nothing is written here that [`lie_dynamic`] does not have
//! for every scalar. All methods are compiled here for dual numbers, so that cargo does it beside [`lie_dynamic`], which has those over
//! numbers, and not after it.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

use lie_codegen::methods::Choice;
use lie_dynamic::{Method, Tolerances};
use lie_runtime::Dual;

/// A method over dual numbers.
pub type Tangent = Method<Dual<f64>>;

/// The method of a choice. Whether it applies to a system is for the catalogue to say.
pub fn method(choice: &Choice, tolerances: Tolerances) -> Tangent {
    lie_dynamic::method_over(choice, tolerances)
}

/// The same with its own defaults: series at the tolerance at which they are exact on every grid.
pub fn at_defaults(choice: &Choice) -> Tangent {
    lie_dynamic::at_defaults_over(choice)
}
