//! `new()` of every method: at its defaults, which are those of the command line.

use super::*;

/// Methods that are a name.
macro_rules! by_name {
    (
        {} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt $($choice:tt $type:tt $value:tt $how:tt)+ })+
    ) => {
        $($(by_name!($type $value $how);)+)+
    };
    ([$method:ident] [$value:ident] { tolerances }) => {};
    ([$method:ident] [$value:ident] $how:tt) => {
        impl $method {
            /// The method.
            #[must_use]
            pub const fn new() -> Self {
                Self
            }
        }
    };
    ($type:tt $value:tt $how:tt) => {};
}
crate::for_each_method!(by_name! {});

/// Methods with a choice, which has a name.
macro_rules! by_default {
    ($([$($generics:tt)*] $method:ty, $constructor:ident, $doc:literal;)+) => {$(
        impl $($generics)* $method {
            #[doc = $doc]
            #[must_use]
            pub const fn new() -> Self {
                Self::$constructor()
            }
        }
    )+};
}

by_default!(
    [] LieMidpoint<Exp>, exp, "With the exponential map.";
    [] Generating2, exp, "With the exponential map.";
    [] Generating4, exp, "With the exponential map.";
    [] Generating6, exp, "With the exponential map.";
    [] Variational2, exp, "With the exponential map.";
    [] Variational4, exp, "With the exponential map.";
    [] Variational6, exp, "With the exponential map.";
    [] DiscreteEulerPoincare<Exp>, exp, "With l_d in exponential coordinates.";
    [] OrbitEnergy<Gonzalez>, gonzalez, "Along the midpoint discrete gradient.";
    [<const STAGES: usize>] Collective<Representation, STAGES>, representation, "Over the declared representation.";
    [<const STAGES: usize>] ParallelCollective<Smallest, STAGES>, smallest, "Over the smallest space that there is.";
);

/// Methods that choose their steps.
macro_rules! by_tolerances {
    ($($method:ident, $doc:literal;)+) => {$(
        impl $method {
            #[doc = $doc]
            #[must_use]
            pub fn new() -> Self {
                Self::default()
            }
        }
    )+};
}

by_tolerances!(
    Dopri5, "With the tolerances 1e-6, relative, and 1e-9, absolute.";
    Taylor, "With a tolerance of 1e-15: as exact as round-off lets it be.";
    LieTaylor, "With a tolerance of 1e-15: as exact as round-off lets it be.";
);

/// Tolerances of methods that choose their steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            rtol: 1e-6,
            atol: 1e-9,
        }
    }
}

impl Tolerances {
    /// Both alike.
    pub const fn both(tolerance: f64) -> Self {
        Self {
            rtol: tolerance,
            atol: tolerance,
        }
    }
}

impl From<Tolerances> for Dopri5 {
    fn from(Tolerances { rtol, atol }: Tolerances) -> Self {
        Self { rtol, atol }
    }
}

impl From<Tolerances> for Taylor {
    fn from(tolerances: Tolerances) -> Self {
        Self::with_tolerance(tolerances.rtol)
    }
}

impl From<Tolerances> for LieTaylor {
    fn from(tolerances: Tolerances) -> Self {
        Self::with_tolerance(tolerances.rtol)
    }
}
