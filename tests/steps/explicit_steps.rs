//! Single steps of the explicit methods against their reference values, on every system that has them.

use crate::systems::{
    CotangentEulerArnold, Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, ManakovTop,
    NonpolynomialSpin, Pendulum, Sl2Quadratic, Su3Quadratic, TodaLattice, distance,
};
use crate::vectors::steps;
use lie_runtime::State;
use lie_runtime::methods::{CommutatorFree4, LieEuler, Method, Rkmk4, Stepper};
use lie_runtime::newton::NewtonOptions;

/// Round-off of a step of numbers near 1.
const STEP: f64 = 1e-15;

/// One step of each size that the file has, without failure; returns the largest error.
fn error<D: Declared>(name: &str, method: &impl Method<f64, D::System<f64>>) -> f64 {
    let system = D::declared::<f64>();
    let expected = steps(D::FILE, name);
    assert_eq!(expected.len(), 2, "{name} of {}", D::FILE);
    let errors = expected.into_iter().map(|(h, expected)| {
        let mut mu = D::initial::<f64>();
        let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
        stepper.step(&mut mu, &mut ()).expect("an explicit step");
        distance(mu.as_slice(), &expected)
    });
    let error = errors.fold(0.0, f64::max);
    println!("{}: {name}: {error:.1e}", D::FILE);
    error
}

fn coadjoint_orbit<D: Declared>() {
    let errors = [
        error::<D>("lie_euler", &LieEuler),
        error::<D>("rkmk4", &Rkmk4),
        error::<D>("cf4", &CommutatorFree4),
    ];
    assert!(errors.iter().all(|error| *error < STEP), "{errors:?}");
    // the bound is no formality: another method misses it
    assert!(error::<D>("rkmk4", &LieEuler) > 1e-6);
}

macro_rules! tests {
    ($file:ident, $system:ident, $cayley:ident) => {
        #[test]
        fn $file() {
            coadjoint_orbit::<$system>();
        }
    };
}

each_system!(tests);
