//! Who answers what a trait asks: a family, a kernel of the plan, or nobody.

use crate::compiled::Place;

/// Where the system is a family, the family says what it is.
macro_rules! by_family {
    ($system:ident.$method:ident($($argument:expr),*)) => {
        if let Some(family) = &$system.family {
            return Poisson::<S>::$method(family, $($argument),*);
        }
    };
}
pub(super) use by_family;

/// Where the system is a family, the family answers by its loops; over scalars without any, nothing of them is compiled.
macro_rules! by_loops {
    ($system:ident.$method:ident($($argument:expr),*)) => {
        if S::LOOPS
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
    unreachable!("what is written down has no loops within a kernel")
}
