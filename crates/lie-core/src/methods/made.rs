//! `new()` of every method: at its defaults, which are those of the command line.

use super::*;

/// Methods without a choice.
macro_rules! plain {
    ($($method:ident),+ $(,)?) => {$(
        impl $method {
            /// The method.
            #[must_use]
            pub const fn new() -> Self {
                Self
            }
        }
    )+};
}

plain!(
    CommutatorFree4,
    CrouchGrossman3,
    EulerArnold2,
    Exact,
    Gauss4,
    Gauss6,
    Gauss8,
    Gauss10,
    Gauss12,
    Gauss14,
    Gauss16,
    GeneratingSecondKind2,
    Gonzalez,
    ImplicitMidpoint,
    ItohAbe,
    LieEuler,
    MeanValue,
    MoserVeselov,
    Rk4,
    Rkmk2,
    Rkmk3,
    Rkmk4,
    Rkmk6,
    SphericalMidpoint,
);

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

impl Dopri5 {
    /// With the tolerances 1e-6, relative, and 1e-9, absolute.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

impl Taylor {
    /// With a tolerance of 1e-15: as exact as round-off lets it be.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

impl LieTaylor {
    /// With a tolerance of 1e-15: as exact as round-off lets it be.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}
