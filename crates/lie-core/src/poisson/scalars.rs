//! Systems that exist over other scalars too.

use super::Poisson;
#[cfg(feature = "std")]
use crate::generic;
use crate::scalar::{Dual, Scalar};

/// A system that also exists over dual numbers, so that running it there differentiates it.
///
/// Generated for every system; by hand, convert the constants with [`Dual::constant_of`].
pub trait Lift<S: Scalar>: Poisson<S> {
    /// The same system over dual numbers.
    type Lifted: Lift<Dual<S>>;
    /// The system with all its constants as dual numbers without derivative.
    fn lift(&self) -> Self::Lifted;
}

/// A system that also exists over eight numbers at once, so that all stages of a step are evaluated together.
///
/// Generated for every system; by hand, convert the constants with [`Scalar::widen`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say how it looks over eight numbers of the scalar `{S}` at once",
    note = "methods that evaluate all stages of a step together need it: implement `Widen<{S}>`"
)]
pub trait Widen<S: Scalar>: Poisson<S> {
    /// The same system over eight numbers at once.
    type Widened: Poisson<S::Wide>;
    /// The system with each of its constants eight times.
    fn widen(&self) -> Self::Widened;
    /// Programs that do an iteration of a step with its stages side by side, where the system has some in place of its kernels.
    #[cfg(feature = "std")]
    fn stage_program(
        &self,
        _slopes: generic::StageSlopes,
        _stages: usize,
    ) -> Option<Box<dyn generic::StageProgram<S::Wide>>> {
        None
    }
}

/// A generated system over other scalars, by its function `_over`.
#[doc(hidden)]
#[macro_export]
macro_rules! __over_scalars {
    ($system:ident) => {
        impl<S: $crate::Scalar> $crate::Lift<S> for $system<S> {
            type Lifted = $system<$crate::Dual<S>>;
            fn lift(&self) -> Self::Lifted {
                self._over($crate::Dual::constant_of)
            }
        }

        impl<S: $crate::Scalar> $crate::Widen<S> for $system<S> {
            type Widened = $system<S::Wide>;
            fn widen(&self) -> Self::Widened {
                self._over(S::widen)
            }
        }

        impl<S: $crate::Scalar> $crate::Expand<S> for $system<S> {
            type Expanded = $system<$crate::scalar::Truncated<S>>;
            fn expand(&self) -> Self::Expanded {
                self._over($crate::scalar::Truncated::constant_of)
            }
        }
    };
}
