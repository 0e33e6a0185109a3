//! Energy and Casimirs over long runs, each beside a control that must fail the same assertion.

#[path = "../../tests/common/five_body.rs"]
mod five_body;
#[path = "../../tests/common/systems.rs"]
mod systems;

use five_body::{FIVE, FiveBody};
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{Drift, InvariantDrift};
use lie_runtime::methods::{
    Collective2, Collective4, Collective6, ImplicitMidpoint, Isospectral4, LieMidpoint, Method,
    MoserVeselov, OrbitEnergy, Rk4, SphericalMidpoint,
};
use systems::{
    Declared, FreeRigidBody, HeavyTop, KirchhoffBody, ManakovTop, NonpolynomialSpin, Su3Quadratic,
    state,
};

/// Drift from the initial state of a declaration.
fn drift<D: Declared>(method: impl Method<f64, D::System<f64>>, h: f64, steps: u32) -> Drift {
    lab::drift(D::declared::<f64>(), D::initial::<f64>(), method, h, steps)
}

/// The largest error of all Casimirs relative to what they are.
fn casimirs(drift: &Drift) -> f64 {
    drift.casimirs.iter().map(relative).fold(0.0, Scalar::max)
}

fn relative(invariant: &InvariantDrift) -> f64 {
    invariant.relative().expect("not zero")
}

/// All Casimirs within 1e-11 over 10^6 steps of 0.05; returns the largest drift.
fn casimirs_over_a_million_steps<D: Declared>(
    name: &str,
    method: impl Method<f64, D::System<f64>>,
) -> f64 {
    let drift = drift::<D>(method, 0.05, 1_000_000);
    for casimir in &drift.casimirs {
        let windows: Vec<String> = casimir
            .windows
            .iter()
            .map(|window| format!("{window:.1e}"))
            .collect();
        println!(
            "{} {name}, {}: {:.1e}, growth {:.1}, tenths {}",
            D::FILE,
            casimir.name,
            casimir.max,
            casimir.growth().unwrap_or(1.0),
            windows.join(" ")
        );
    }
    println!(
        "{} {name}, energy: {:.1e}, growth {:.2}",
        D::FILE,
        drift.energy.max,
        drift.energy.growth().unwrap_or(1.0)
    );
    drift
        .casimirs
        .iter()
        .fold(0.0, |largest, casimir| Scalar::max(largest, casimir.max))
}

const CASIMIR_BOUND: f64 = 1e-11;

#[test]
fn lie_midpoint_keeps_the_casimirs_of_the_heavy_top() {
    assert!(casimirs_over_a_million_steps::<HeavyTop>("exp", LieMidpoint::exp()) < CASIMIR_BOUND);
    assert!(casimirs_over_a_million_steps::<HeavyTop>("rk4", Rk4) > CASIMIR_BOUND);
}

#[test]
fn lie_midpoint_with_cayley_keeps_the_casimirs_of_the_heavy_top() {
    let drift = casimirs_over_a_million_steps::<HeavyTop>("cayley", LieMidpoint::cayley());
    assert!(drift < CASIMIR_BOUND);
}

#[test]
fn lie_midpoint_keeps_the_casimirs_of_the_kirchhoff_body() {
    assert!(
        casimirs_over_a_million_steps::<KirchhoffBody>("exp", LieMidpoint::exp()) < CASIMIR_BOUND
    );
    assert!(casimirs_over_a_million_steps::<KirchhoffBody>("rk4", Rk4) > CASIMIR_BOUND);
}

#[test]
fn lie_midpoint_with_cayley_keeps_the_casimirs_of_the_kirchhoff_body() {
    let drift = casimirs_over_a_million_steps::<KirchhoffBody>("cayley", LieMidpoint::cayley());
    assert!(drift < CASIMIR_BOUND);
}

/// The energy of a Poisson map oscillates; that of the control drifts.
#[test]
fn energy_does_not_drift() {
    for drift in [
        drift::<HeavyTop>(LieMidpoint::exp(), 0.05, 100_000),
        drift::<KirchhoffBody>(LieMidpoint::exp(), 0.05, 100_000),
        drift::<NonpolynomialSpin>(LieMidpoint::exp(), 0.05, 100_000),
    ] {
        let growth = drift.energy.growth().expect("an error");
        assert!(growth < 1.2, "{:?}", drift.energy);
    }
    let control = drift::<HeavyTop>(Rk4, 0.05, 100_000);
    assert!(
        control.energy.growth().expect("an error") > 5.0,
        "{:?}",
        control.energy
    );
}

#[test]
fn orbits_and_casimirs_are_kept() {
    const STEPS: u32 = 100_000;
    const BOUND: f64 = 1e-12;
    macro_rules! kept {
        ($system:ident: $($method:expr),+) => {
            $(
                let run = drift::<$system>($method, 0.05, STEPS);
                let (lost, energy) = (casimirs(&run), relative(&run.energy));
                let name = concat!(stringify!($system), " ", stringify!($method));
                println!("{name}: casimirs {lost:.1e}, energy {energy:.1e}");
                assert!(lost < BOUND, "{name}: {lost:e}");
                assert!(energy < 1e-2, "{name}: {energy:e}");
            )+
            let control = casimirs(&drift::<$system>(Rk4, 0.05, STEPS));
            assert!(control > BOUND, "{}: the control has {control:e}", stringify!($system));
        };
    }
    kept!(Su3Quadratic: Isospectral4::new());
    kept!(HeavyTop: Isospectral4::new());
    kept!(ManakovTop: Isospectral4::new(), MoserVeselov);
    kept!(NonpolynomialSpin: Isospectral4::new(), Collective2::hopf(), Collective4::hopf(), Collective6::hopf(), SphericalMidpoint);
}

#[test]
fn the_discrete_body_keeps_the_energy() {
    const BOUND: f64 = 1e-12;
    // another Poisson map does not
    macro_rules! kept {
        ($name:literal, $system:expr, $start:expr) => {
            let run = |method, steps| lab::drift($system, $start, method, 0.05, steps);
            let kept = lab::drift($system, $start, MoserVeselov, 0.05, 100_000);
            let (lost, energy) = (casimirs(&kept), relative(&kept.energy));
            println!("{}: casimirs {lost:.1e}, energy {energy:.1e}", $name);
            assert!(lost < BOUND && energy < BOUND, "{lost:e} {energy:e}");
            let control = relative(&run(LieMidpoint::exp(), 1000).energy);
            assert!(control > 1e-7, "{control:e}");
        };
    }
    kept!(
        "so(3)",
        FreeRigidBody::declared::<f64>(),
        FreeRigidBody::initial::<f64>()
    );
    kept!(
        "so(4)",
        ManakovTop::declared::<f64>(),
        ManakovTop::initial::<f64>()
    );
    let five = || FiveBody::<f64>::default().system().expect("valid");
    kept!("so(5)", five(), state(&five(), &FIVE));
}

/// On su(3) one Casimir is cubic: orbits keep it, the midpoint rule does not, nor do discrete gradients.
#[test]
fn orbits_keep_the_cubic_casimir_of_su3() {
    const STEPS: u32 = 100_000;
    let relative = |drift: &Drift| -> Vec<f64> {
        let values = drift.casimirs.iter().chain([&drift.energy]);
        values
            .map(|invariant| invariant.relative().expect("not zero"))
            .collect()
    };
    for kept in [
        relative(&drift::<Su3Quadratic>(OrbitEnergy::gonzalez(), 0.1, STEPS)),
        relative(&drift::<Su3Quadratic>(OrbitEnergy::itoh_abe(), 0.1, 10_000)),
    ] {
        println!("orbit-energy: {kept:?}");
        assert!(kept.iter().all(|error| *error < 1e-12), "{kept:?}");
    }
    let lost = relative(&drift::<Su3Quadratic>(ImplicitMidpoint, 0.1, STEPS));
    println!("midpoint: {lost:?}");
    assert!(
        lost[0] < 1e-12 && lost[2] < 1e-12,
        "quadratic ones: {lost:?}"
    );
    assert!(lost[1] > 1e-5, "the cubic one: {lost:?}");
}
