//! Steps of methods, by the name of the system and of the method.

use lie_runtime::State;
use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use spec_systems::so3_free_rigid_body::FreeRigidBody;
use spec_systems::{se3_heavy_top, so4_manakov, su3_quadratic};

/// Makes steps of 0.05 with the default solver; prints the state at the end.
fn run<P: Poisson<f64>>(system: &P, mut mu: P::State, method: &impl Method<f64, P>, steps: u32) {
    let mut stepper = method.stepper(system, 0.05, &NewtonOptions::default());
    for step in 0..steps {
        if let Err(failure) = stepper.step(&mut mu, &mut ()) {
            panic!("step {step}: {failure}");
        }
    }
    println!("{:?}", mu.as_slice());
}

/// Those of the methods that every one of these systems has, and of others.
macro_rules! steps {
    ($method:expr, $steps:expr, $parameters:expr, {$($label:literal => $more:expr),* $(,)?}) => {{
        let parameters = $parameters;
        let system = parameters.system().expect("the default parameters are valid");
        let mu = parameters.initial_state();
        match $method {
            "midpoint" => run(&system, mu, &ImplicitMidpoint, $steps),
            "gauss4" => run(&system, mu, &Gauss4, $steps),
            "gauss6" => run(&system, mu, &Gauss6, $steps),
            "gauss16" => run(&system, mu, &Gauss16, $steps),
            "lie-midpoint" => run(&system, mu, &LieMidpoint::exp(), $steps),
            "collective4" => run(&system, mu, &Collective4::representation(), $steps),
            "cohen-hairer4" => run(&system, mu, &CohenHairer4::new(), $steps),
            "orbit-energy" => run(&system, mu, &OrbitEnergy::gonzalez(), $steps),
            "rk4" => run(&system, mu, &Rk4, $steps),
            "dopri5" => run(&system, mu, &Dopri5 { rtol: 1e-6, atol: 1e-9 }, $steps),
            "rkmk4" => run(&system, mu, &Rkmk4, $steps),
            $($label => run(&system, mu, &$more, $steps),)*
            _ => return false,
        }
    }};
}

/// Makes steps; false where there is no such system or method.
pub fn make(system: &str, method: &str, steps: u32) -> bool {
    match system {
        "so3_free_rigid_body" => steps!(method, steps, FreeRigidBody::new(), {
            "lie-midpoint-cayley" => LieMidpoint::cayley(),
            "moser-veselov" => MoserVeselov,
            "spherical-midpoint" => SphericalMidpoint,
            "splitting2" => Splitting2::new(),
            "splitting2-coordinate" => Splitting2::new().coordinate(),
            "splitting4-coordinate" => Splitting4::new().coordinate(),
        }),
        "se3_heavy_top" => steps!(method, steps, se3_heavy_top::HeavyTop::new(), {
            "lie-midpoint-cayley" => LieMidpoint::cayley(),
            "splitting2" => Splitting2::new(),
            "splitting2-coordinate" => Splitting2::new().coordinate(),
            "splitting4-coordinate" => Splitting4::new().coordinate(),
        }),
        "so4_manakov" => steps!(method, steps, so4_manakov::ManakovTop::new(), {
            "lie-midpoint-cayley" => LieMidpoint::cayley(),
            "moser-veselov" => MoserVeselov,
            "splitting2" => Splitting2::new(),
            "splitting2-coordinate" => Splitting2::new().coordinate(),
            "splitting4-coordinate" => Splitting4::new().coordinate(),
        }),
        "su3_quadratic" => steps!(method, steps, su3_quadratic::Su3Quadratic::new(), {}),
        _ => return false,
    }
    true
}
