//! Errors of parameter values.

use crate::scalar::{Mask, Scalar};
use thiserror::Error;

/// A parameter value for which a constant of the system is not finite, such as a moment of
/// inertia of zero.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("`{expression}` is not finite for this value of the parameter `{name}`")]
pub struct ParameterError {
    /// The parameter; where several enter the expression, the first of them.
    pub name: &'static str,
    /// The constant that is not finite, in the user's names.
    pub expression: &'static str,
}

/// Tests derived constants, each with the parameter it stands under and its expression.
///
/// # Errors
/// The first constant that is not finite in every lane.
pub fn all_finite<S: Scalar>(
    constants: &[(S, &'static str, &'static str)],
) -> Result<(), ParameterError> {
    match constants.iter().find(|(value, ..)| !value.finite().all()) {
        Some(&(_, name, expression)) => Err(ParameterError { name, expression }),
        None => Ok(()),
    }
}
