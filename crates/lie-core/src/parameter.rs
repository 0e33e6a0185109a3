//! Errors of parameter values.

use core::fmt;

use crate::scalar::{Mask, Scalar};
use thiserror::Error;

/// A parameter value for which there is no system: one that is not positive although it was declared so, or
/// one for which a constant of the system is not finite, such as a moment of inertia of zero.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub struct ParameterError {
    /// The parameter; where several enter the expression, the first of them.
    pub name: &'static str,
    /// The constant that is not finite, in the user's names; of a parameter that is not positive, itself.
    pub expression: &'static str,
    /// What is wrong.
    pub fault: ParameterFault,
}

/// What is wrong with a parameter value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ParameterFault {
    /// A constant of the system is not finite.
    NotFinite,
    /// The parameter was declared positive.
    NotPositive,
    /// The parameter is the size of a family, which is a whole number.
    NotASize,
    /// The parameter has a value for each site of a family, and another number of values.
    NotOneForEachSite,
    /// A row of the bonds does not join two sites of the family.
    NoBond,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name, expression, ..
        } = self;
        match self.fault {
            ParameterFault::NotFinite => write!(
                f,
                "`{expression}` is not finite for this value of the parameter `{name}`"
            ),
            ParameterFault::NotASize => write!(
                f,
                "the parameter `{name}` is the size of the family: a whole number between 1 and 2^31"
            ),
            ParameterFault::NotOneForEachSite => write!(
                f,
                "the parameter `{name}` has a value for each site of the family, and there are other numbers of values and of sites"
            ),
            ParameterFault::NoBond => write!(
                f,
                "a row of `{name}` joins no two sites of the family: it has the numbers of two of them, from 0 on, and a value"
            ),
            ParameterFault::NotPositive => {
                write!(
                    f,
                    "the parameter `{name}` was declared positive, and this value is not"
                )
            }
        }
    }
}

/// Tests derived constants, each with the parameter it stands under and its expression.
///
/// # Errors
/// The first constant that is not finite in every lane.
pub fn all_finite<S: Scalar>(
    constants: &[(S, &'static str, &'static str)],
) -> Result<(), ParameterError> {
    match constants.iter().find(|(value, ..)| !value.finite().all()) {
        Some(&(_, name, expression)) => Err(ParameterError {
            name,
            expression,
            fault: ParameterFault::NotFinite,
        }),
        None => Ok(()),
    }
}

/// Tests parameters that were declared positive, each with its name.
///
/// # Errors
/// The first that is not positive in every lane.
pub fn all_positive<S: Scalar>(parameters: &[(S, &'static str)]) -> Result<(), ParameterError> {
    let positive = |value: &S| S::zero().less(*value).all();
    match parameters.iter().find(|(value, _)| !positive(value)) {
        Some(&(_, name)) => Err(ParameterError {
            name,
            expression: name,
            fault: ParameterFault::NotPositive,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_positive_are_refused() {
        assert_eq!(all_positive(&[(1.0, "a"), (1e-300, "b")]), Ok(()));
        for bad in [0.0, -0.0, -1.0, f64::NAN] {
            let error = all_positive(&[(1.0, "a"), (bad, "b")]).unwrap_err();
            let fault = ParameterFault::NotPositive;
            assert_eq!((error.name, error.fault), ("b", fault));
        }
    }
}
