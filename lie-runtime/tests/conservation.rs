//! What each method keeps, beside a control that does not.

use crate::systems;
use crate::systems::heavy_top::{HeavyTop, START};
use crate::systems::nonpolynomial::Nonpolynomial;
use crate::systems::rigid_body::RigidBody;
use lie_runtime::diagnostics::{Drift, DriftMonitor, poisson_defect};
use lie_runtime::driver::integrate;
use lie_runtime::methods::{Facts, Method};
use lie_runtime::prelude::*;

fn drift<P, M>(system: P, method: M, start: &[f64], h: f64, steps: u32) -> Drift
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let mu0 = systems::state(&system, start);
    let problem = Problem {
        system,
        mu0,
        span: (0.0, h * f64::from(steps)),
    };
    let mut monitor = DriftMonitor::<f64>::new();
    let options = Options::new(h).save(Save::Ends);
    integrate(&problem, method, &options, &mut monitor).expect("every step converges");
    monitor.drift().clone()
}

#[test]
fn lie_midpoint_keeps_casimirs_over_many_steps() {
    let steps = systems::daily(20_000, 1_000_000);
    let exp = drift(HeavyTop::default(), LieMidpoint::exp(), &START, 0.05, steps);
    let cayley = drift(
        HeavyTop::default(),
        LieMidpoint::cayley(),
        &START,
        0.05,
        steps,
    );
    let control = drift(HeavyTop::default(), Rk4, &START, 0.05, steps);
    for method in [&exp, &cayley] {
        for casimir in &method.casimirs {
            assert!(casimir.max < 1e-11, "{}: {:?}", casimir.name, casimir);
        }
        // the energy oscillates and does not drift: the fewer oscillations, the less alike are the windows
        let alike = if cfg!(debug_assertions) { 1.5 } else { 1.2 };
        let growth = method.energy.growth().expect("an error");
        assert!(method.energy.max < 5e-3, "{:?}", method.energy);
        assert!(growth < alike, "{:?}", method.energy);
    }
    assert!(control.casimirs[0].max > 1e-7, "{control:?}");
    assert!(
        control.casimirs[0].growth().expect("an error") > 5.0,
        "{control:?}"
    );
}

#[test]
fn quadratic_invariants_are_kept_by_midpoint_and_gauss() {
    fn check<M: Method<f64, HeavyTop> + Facts>(method: M) {
        let drift = drift(HeavyTop::default(), method, &START, 0.1, 2000);
        let kept = M::PRESERVES.quadratic_invariants;
        // both Casimirs and the energy of the heavy top are quadratic
        for invariant in drift.casimirs.iter().chain([&drift.energy]) {
            assert_eq!(invariant.max < 1e-12, kept, "{}: {invariant:?}", M::ID);
        }
    }
    check(ImplicitMidpoint);
    check(Gauss4);
    check(Gauss6);
    check(Rk4);
    check(Dopri5::default());
}

#[test]
fn poisson_maps_by_their_tangent() {
    fn defect<M: Method<Dual<f64>, HeavyTop<Dual<f64>>>>(method: M, h: f64) -> f64 {
        let system = HeavyTop::<Dual<f64>>::default();
        poisson_defect(&system, &method, h, &START, &NewtonOptions::default())
            .expect("the step converges")
    }
    fn nonpolynomial<M: Method<Dual<f64>, Nonpolynomial>>(method: M, h: f64) -> f64 {
        poisson_defect(
            &Nonpolynomial,
            &method,
            h,
            &[0.6, -0.5, 0.7],
            &NewtonOptions::default(),
        )
        .expect("the step converges")
    }
    for h in [0.1, 0.5, -0.2] {
        let defects = [
            defect(LieMidpoint::exp(), h),
            defect(LieMidpoint::cayley(), h),
            nonpolynomial(LieMidpoint::exp(), h),
            nonpolynomial(LieMidpoint::cayley(), h),
        ];
        for defect in defects {
            assert!(defect < 3e-15, "h = {h}: {defects:?}");
        }
    }
    // whatever the units: momenta of 2^-40 and steps to match
    let scale = 2.0_f64.powi(-40);
    let start = [0.6, -0.5, 0.7].map(|entry| entry * scale);
    let body = RigidBody::<Dual<f64>>::default();
    let options = NewtonOptions::default();
    let h = 0.5 / scale;
    let kept = poisson_defect(&body, &LieMidpoint::exp(), h, &start, &options).expect("a step");
    let lost = poisson_defect(&body, &ImplicitMidpoint, h, &start, &options).expect("a step");
    let (kept, lost) = (kept / scale, lost / scale);
    assert!(kept < 3e-15 && lost > 1e-6, "{kept:e} {lost:e}");

    let points: Vec<(f64, f64)> = [0.2, 0.1, 0.05, 0.025]
        .map(|h| (h, defect(ImplicitMidpoint, h)))
        .into();
    let order =
        lie_runtime::diagnostics::order_of_convergence(&points, 1e-14).expect("four points");
    assert!((order.slope - 3.0).abs() < 0.1, "{order:?} of {points:?}");
    assert!(defect(Rk4, 0.1) > 1e-9);
}
