//! Who answers what a trait asks: a family, a kernel of the plan, or nobody.

use crate::compiled::Place;
use lie_runtime::Scalar;

/// Over which scalars there are families.
pub(super) trait Families: Scalar {
    /// No method of families asks for second derivatives by dual numbers of dual numbers: their loops are not compiled for those.
    const FAMILIES: bool = Self::LOOPS && Self::DERIVATIVES < 2;
}

impl<S: Scalar> Families for S {}

/// Where the system is a family, the family says what it is.
macro_rules! by_family {
    ($system:ident.$method:ident($($argument:expr),*)) => {
        if S::FAMILIES
            && let Some(family) = &$system.family
        {
            return Poisson::<S>::$method(family, $($argument),*);
        }
    };
}
pub(super) use by_family;

/// Where the system is a family, the family answers by its loops; over scalars without families, nothing of them is compiled.
macro_rules! by_loops {
    ($system:ident.$method:ident($($argument:expr),*)) => {
        if S::FAMILIES
            && let Some(family) = &$system.family
        {
            return family.$method($($argument),*);
        }
    };
}
pub(super) use by_loops;

/// The place of a kernel that every system has.
pub(super) fn require(place: Place) -> usize {
    let Some(place) = place else {
        panic!("the system has no such kernel")
    };
    place
}

/// A kernel that is a loop was asked for over a scalar without any.
pub(super) fn without_loops() -> ! {
    unreachable!("the scalar has no loops within a kernel")
}
