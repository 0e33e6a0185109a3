//! The motion on the group over long runs: spatial momentum, and the group element in the group.
//!
//! All methods go 10^5 steps here, some 10^6: all of them stay below 1e-11 over 10^6, which takes minutes.

#[path = "../../tests/common/systems.rs"]
mod systems;

use lie_runtime::driver::{Chart, Reconstruction};
use lie_runtime::methods::Method;
use lie_runtime::prelude::*;
use systems::Declared;
use systems::so3_free_rigid_body::{FreeRigidBody, FreeRigidBodySystem};

const STEP: f64 = 0.05;

/// The largest deviation of `g mu` from its start and of `g^T g` from 1, at a hundred times of the run.
fn deviations<M: Method<f64, FreeRigidBodySystem>>(method: M, steps: f64) -> (f64, f64) {
    let system = FreeRigidBody::declared::<f64>();
    let start = FreeRigidBody::initial::<f64>();
    let mut attitude = Reconstruction::new(&system, Chart::Matrix);
    let problem = Problem::new(system, start, (0.0, STEP * steps));
    let options = Options::new(STEP).save(Save::Every((steps / 100.0) as u64));
    let Ok(solution) = solve_observed(&problem, method, &options, &mut attitude) else {
        panic!("every step converges");
    };
    let (mut momentum, mut orthogonal) = (0.0_f64, 0.0_f64);
    for (mu, g) in solution.mu.iter().zip(attitude.rows()) {
        for i in 0..3 {
            let turned: f64 = (0..3).map(|j| g[3 * i + j] * mu.as_slice()[j]).sum();
            momentum = momentum.max((turned - start.as_slice()[i]).abs());
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| g[3 * k + i] * g[3 * k + j]).sum();
                let unit = f64::from(u8::from(i == j));
                orthogonal = orthogonal.max((product - unit).abs());
            }
        }
    }
    (momentum, orthogonal)
}

macro_rules! long {
    ($($(#[$attribute:meta])* $name:ident, $steps:literal: $($method:expr),*;)*) => { $(
        #[test]
        $(#[$attribute])*
        fn $name() {
            $({
                let (momentum, orthogonal) = deviations($method, $steps);
                println!("{:<32} momentum {momentum:.1e}, orthogonal {orthogonal:.1e}", stringify!($method));
                assert!(momentum < 1e-11, "{}: {momentum:e}", stringify!($method));
                assert!(orthogonal < 1e-14, "{}: {orthogonal:e}", stringify!($method));
            })*
        }
    )* };
}

long! {
    #[ignore = "half a minute: .ci/nightly runs it"]
    a_million, 1e6: LieMidpoint::exp(), MoserVeselov, Isospectral4::new(), Rkmk4, Splitting2::new(), LieEuler;
    retractions, 1e5: LieMidpoint::exp(), LieMidpoint::cayley(), OrbitEnergy::gonzalez();
    generating_functions, 1e5: Generating4::exp(), Generating4::cayley(), Generating6::exp(), GeneratingSecondKind2;
    explicit, 1e5: LieEuler, Rkmk2, Rkmk3, Rkmk4, Rkmk6, CrouchGrossman3, CommutatorFree4;
    splittings, 1e5: Splitting1::new(), Splitting2::new(), Splitting4::new(), Splitting6::new(), Splitting8::new();
    over_g, 1e5: Collective2::hopf(), Collective4::hopf(), Collective6::hopf(), Isospectral2::new(), Isospectral4::new(), Isospectral6::new();
    spheres, 1e5: SphericalMidpoint, MoserVeselov;
    // not of coadjoint form by construction, but so on so(3)
    midpoints, 1e5: ImplicitMidpoint, Gauss4, Gauss6, Gonzalez, CohenHairer4::new();
}

#[test]
fn what_the_others_lose() {
    let (momentum, orthogonal) = deviations(Rk4, 1e5);
    println!("Rk4: momentum {momentum:.1e}, orthogonal {orthogonal:.1e}");
    assert!(momentum > 1e-7 && orthogonal < 1e-11);
}
