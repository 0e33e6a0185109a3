//! The systems of `specs/`, and how tests go through them.

// Each test file uses its own part of this.
#![allow(dead_code, unused_macros, unused_imports)]

#[path = "random.rs"]
mod random;

use lie_runtime::methods::{
    CohenHairer, Exp, Gauss4, Gauss6, Gonzalez, ImplicitMidpoint, ItohAbe, LieMidpoint, MeanValue,
};
use lie_runtime::{Implicit, LiePoisson, Lift, Poisson, Scalar, State};
pub use random::Random;

pub use spec_systems::canonical_pendulum::{self, CanonicalPendulum};
pub use spec_systems::e2_pendulum::{self, Pendulum};
pub use spec_systems::heisenberg_h3::{self, Heisenberg};
pub use spec_systems::lotka_volterra::{self, LotkaVolterra};
pub use spec_systems::se2_circulation::{self, BodyWithCirculation};
pub use spec_systems::se3_heavy_top::{self, HeavyTop};
pub use spec_systems::se3_kirchhoff::{self, KirchhoffBody};
pub use spec_systems::se3_kirchhoff_full::{self, KirchhoffFull};
pub use spec_systems::sl2_quadratic::{self, Sl2Quadratic};
pub use spec_systems::so3_cotangent_euler_arnold::{self, CotangentEulerArnold};
pub use spec_systems::so3_cotangent_group::{self, CotangentBody};
pub use spec_systems::so3_discrete_lagrangian::{self, DiscreteBody};
pub use spec_systems::so3_free_rigid_body::{self, FreeRigidBody};
pub use spec_systems::so3_gravity_gradient::{self, Satellite};
pub use spec_systems::so3_gyrostat_lagrangian::{self, Gyrostat};
pub use spec_systems::so3_nonpolynomial::{self, NonpolynomialSpin};
pub use spec_systems::so3_quartic_lagrangian::{self, QuarticBody};
pub use spec_systems::so4_manakov::{self, ManakovTop};
pub use spec_systems::su3_quadratic::{self, Su3Quadratic};
pub use spec_systems::toda3_solvable::{self, TodaLattice};

/// A system of `specs/` with its default parameters, over any scalar.
pub trait Declared {
    /// The name of its spec and reference values.
    const FILE: &'static str;
    type System<S: Scalar>: LiePoisson<S>
        + Lift<S>
        + Implicit<S, ImplicitMidpoint>
        + Implicit<S, Gauss4>
        + Implicit<S, Gauss6>
        + Implicit<S, LieMidpoint<Exp>>;
    fn declared<S: Scalar>() -> Self::System<S>;
    /// The initial state of the declaration.
    fn initial<S: Scalar>() -> <Self::System<S> as Poisson<S>>::State;
}

macro_rules! declared {
    ($file:ident, $name:ident, $system:ident) => {
        declared!(Declared, $file, $name, $system);
    };
    ($trait:ident, $file:ident, $name:ident, $system:ident) => {
        impl $trait for $name {
            const FILE: &'static str = stringify!($file);
            type System<S: Scalar> = $file::$system<S>;
            fn declared<S: Scalar>() -> Self::System<S> {
                $file::$name::<S>::default()
                    .system()
                    .expect("the default parameters are valid")
            }
            fn initial<S: Scalar>() -> <Self::System<S> as Poisson<S>>::State {
                $file::$name::<S>::default().initial_state()
            }
        }
    };
}

declared!(e2_pendulum, Pendulum, PendulumSystem);
declared!(heisenberg_h3, Heisenberg, HeisenbergSystem);
declared!(se3_heavy_top, HeavyTop, HeavyTopSystem);
declared!(se3_kirchhoff, KirchhoffBody, KirchhoffBodySystem);
declared!(se3_kirchhoff_full, KirchhoffFull, KirchhoffFullSystem);
declared!(sl2_quadratic, Sl2Quadratic, Sl2QuadraticSystem);
declared!(
    so3_cotangent_euler_arnold,
    CotangentEulerArnold,
    CotangentEulerArnoldSystem
);
declared!(so3_cotangent_group, CotangentBody, CotangentBodySystem);
declared!(so3_gravity_gradient, Satellite, SatelliteSystem);
declared!(so3_free_rigid_body, FreeRigidBody, FreeRigidBodySystem);
declared!(
    so3_nonpolynomial,
    NonpolynomialSpin,
    NonpolynomialSpinSystem
);
declared!(so3_discrete_lagrangian, DiscreteBody, DiscreteBodySystem);
declared!(so3_gyrostat_lagrangian, Gyrostat, GyrostatSystem);
declared!(so3_quartic_lagrangian, QuarticBody, QuarticBodySystem);
declared!(so4_manakov, ManakovTop, ManakovTopSystem);
declared!(su3_quadratic, Su3Quadratic, Su3QuadraticSystem);
declared!(toda3_solvable, TodaLattice, TodaLatticeSystem);

/// Calls a macro once per system: file, type, and `cayley` where that retraction exists, else `exp`.
macro_rules! each_system {
    ($check:ident) => {
        $check!(e2_pendulum, Pendulum, cayley);
        $check!(heisenberg_h3, Heisenberg, cayley);
        $check!(se3_heavy_top, HeavyTop, cayley);
        $check!(se3_kirchhoff, KirchhoffBody, cayley);
        $check!(sl2_quadratic, Sl2Quadratic, cayley);
        $check!(so3_cotangent_euler_arnold, CotangentEulerArnold, exp);
        $check!(so3_free_rigid_body, FreeRigidBody, cayley);
        $check!(so3_nonpolynomial, NonpolynomialSpin, cayley);
        $check!(so4_manakov, ManakovTop, cayley);
        $check!(su3_quadratic, Su3Quadratic, exp);
        $check!(toda3_solvable, TodaLattice, exp);
    };
}

/// The same for the systems without reference values of their own, on which that of Cayley is not checked.
macro_rules! each_further_system {
    ($check:ident) => {
        $check!(se3_kirchhoff_full, KirchhoffFull, exp);
        $check!(so3_cotangent_group, CotangentBody, exp);
        $check!(so3_discrete_lagrangian, DiscreteBody, exp);
        $check!(so3_gravity_gradient, Satellite, exp);
        $check!(so3_gyrostat_lagrangian, Gyrostat, exp);
        $check!(so3_quartic_lagrangian, QuarticBody, exp);
    };
}

/// The methods that ask for nothing but a Poisson bracket.
pub trait OfPoisson<S: Scalar>:
    Lift<S>
    + Implicit<S, ImplicitMidpoint>
    + Implicit<S, Gauss4>
    + Implicit<S, Gauss6>
    + Implicit<S, Gonzalez>
    + Implicit<S, MeanValue>
    + Implicit<S, ItohAbe>
    + Implicit<S, CohenHairer<1>>
    + Implicit<S, CohenHairer<2>>
    + Implicit<S, CohenHairer<3>>
{
}

impl<S: Scalar, P> OfPoisson<S> for P where
    P: Lift<S>
        + Implicit<S, ImplicitMidpoint>
        + Implicit<S, Gauss4>
        + Implicit<S, Gauss6>
        + Implicit<S, Gonzalez>
        + Implicit<S, MeanValue>
        + Implicit<S, ItohAbe>
        + Implicit<S, CohenHairer<1>>
        + Implicit<S, CohenHairer<2>>
        + Implicit<S, CohenHairer<3>>
{
}

/// A system of `specs/` whose bracket is declared by entries, or has some beside an algebra.
pub trait Bracketed {
    /// The name of its spec.
    const FILE: &'static str;
    type System<S: Scalar>: OfPoisson<S>;
    fn declared<S: Scalar>() -> Self::System<S>;
    /// The initial state of the declaration.
    fn initial<S: Scalar>() -> <Self::System<S> as Poisson<S>>::State;
}

declared!(
    Bracketed,
    canonical_pendulum,
    CanonicalPendulum,
    CanonicalPendulumSystem
);
declared!(
    Bracketed,
    lotka_volterra,
    LotkaVolterra,
    LotkaVolterraSystem
);
declared!(
    Bracketed,
    se2_circulation,
    BodyWithCirculation,
    BodyWithCirculationSystem
);

/// Calls a macro once per system whose bracket is declared by entries, or has some beside an algebra: file and type.
macro_rules! each_bracket {
    ($check:ident) => {
        $check!(canonical_pendulum, CanonicalPendulum);
        $check!(lotka_volterra, LotkaVolterra);
        $check!(se2_circulation, BodyWithCirculation);
    };
}

/// A state from f64 coordinates.
pub fn state<S: Scalar, P: Poisson<S>>(system: &P, coordinates: &[f64]) -> P::State {
    let mut state = system.zero_state();
    assert_eq!(coordinates.len(), state.as_slice().len());
    for (entry, &coordinate) in state.as_mut_slice().iter_mut().zip(coordinates) {
        *entry = S::from_f64(coordinate);
    }
    state
}

/// The largest distance of two lists of numbers; not a number if one is not.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |largest, (a, b)| Scalar::max(largest, (a - b).abs()))
}

/// The same in units of the second list's largest number, or of 1 if that is smaller.
pub fn relative_distance(a: &[f64], b: &[f64]) -> f64 {
    distance(a, b)
        / b.iter()
            .fold(1.0, |largest, b| Scalar::max(largest, b.abs()))
}
