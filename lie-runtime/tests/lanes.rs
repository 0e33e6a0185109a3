//! Eight lanes have the digits of eight scalar runs.

use crate::systems;

use lie_runtime::methods::{
    CohenHairer4, Gonzalez, MeanValue, Method, OrbitEnergy, Rkmk6, StepFailure, StepReport, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use nalgebra::SVector;
use systems::driven_body::DrivenBody;
use systems::heavy_top::HeavyTop;
use systems::nonpolynomial::Nonpolynomial;
use systems::saddle::Saddle;

/// Steps whose sizes may differ per lane; returns the report of the first.
fn run<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    options: &NewtonOptions,
    h: S,
    mu: &mut P::State,
) -> Result<StepReport, StepFailure> {
    let mut stepper = method.stepper(system, h, options);
    let first = stepper.step(mu, &mut ())?;
    for _ in 0..5 {
        stepper.step(mu, &mut ())?;
    }
    Ok(first)
}

/// Runs in lanes and one lane after the other; returns the reports of the lanes alone.
fn compare<const N: usize, Many, One, M>(
    (many, one): (&Many, &One),
    method: &M,
    options: &NewtonOptions,
    h: [f64; 8],
    start: impl Fn(usize) -> [f64; N],
) -> [StepReport; 8]
where
    Many: Poisson<F64x8, State = SVector<F64x8, N>>,
    One: Poisson<f64, State = SVector<f64, N>>,
    M: Method<F64x8, Many> + Method<f64, One>,
{
    let mut together = SVector::<F64x8, N>::from_fn(|row, _| {
        F64x8::new(core::array::from_fn(|lane| start(lane)[row]))
    });
    let report = run(many, method, options, F64x8::new(h), &mut together).expect("lanes converge");
    let alone: [StepReport; 8] = core::array::from_fn(|lane| {
        let mut mu = SVector::from(start(lane));
        let report = run(one, method, options, h[lane], &mut mu).expect("the lane converges");
        for row in 0..N {
            let bits = (together[row].lane(lane).to_bits(), mu[row].to_bits());
            assert_eq!(bits.0, bits.1, "lane {lane}, coordinate {row}");
        }
        report
    });
    assert_eq!(
        Some(report.iterations),
        alone.iter().map(|report| report.iterations).max()
    );
    alone
}

fn different(reports: [StepReport; 8]) -> bool {
    reports
        .iter()
        .any(|report| report.iterations != reports[0].iterations)
}

/// From nearly at rest to fast, so that lanes converge at different iterations.
fn top(lane: usize) -> [f64; 6] {
    let size = [1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0, 3.0, 6.0][lane];
    [0.4 * size, 0.3 * size, -0.9 * size, 0.36, -0.48, 0.8]
}

fn body(lane: usize) -> [f64; 3] {
    let size = [1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0, 1.5, 2.0][lane];
    [0.6 * size, -0.5 * size, 0.7 * size]
}

/// The same of a body that is driven and damped.
fn driven(lane: usize) -> [f64; 6] {
    let [x, y, z] = body(lane);
    [x, y, z, 0.0, 0.3 + lane as f64, 1.0]
}

#[test]
fn forces_and_damping_have_the_digits_of_the_scalar_run() {
    let body = DrivenBody {
        forced: true,
        strength: Some(0.4),
    };
    let many = DrivenBody {
        forced: true,
        strength: Some(F64x8::from_f64(0.4)),
    };
    let (bodies, h) = ((&many, &body), [0.1; 8]);
    let options = NewtonOptions::default();
    compare(bodies, &LieMidpoint::exp(), &options, h, driven);
    compare(bodies, &LieMidpoint::cayley(), &options, h, driven);
    compare(bodies, &Gonzalez, &options, h, driven);
    compare(bodies, &MeanValue, &options, h, driven);
    let orbit = OrbitEnergy::gonzalez();
    assert!(different(compare(bodies, &orbit, &options, h, driven)));
    compare(bodies, &CohenHairer4::new(), &options, h, driven);
    compare(bodies, &Rkmk6, &options, h, driven);
    compare(bodies, &CommutatorFree4, &options, h, driven);
}

#[test]
fn every_method_has_the_digits_of_the_scalar_run() {
    let tops = (&HeavyTop::default(), &HeavyTop::default());
    let bodies = (&Nonpolynomial, &Nonpolynomial);
    let h = [0.1; 8];
    for options in [
        NewtonOptions::default(),
        NewtonOptions::simplified(),
        NewtonOptions::fixed_point(),
    ] {
        assert!(different(compare(
            tops,
            &ImplicitMidpoint,
            &options,
            h,
            top
        )));
        assert!(different(compare(tops, &Gauss4, &options, h, top)));
        assert!(different(compare(tops, &Gauss6, &options, h, top)));
        assert!(different(compare(
            tops,
            &LieMidpoint::exp(),
            &options,
            h,
            top
        )));
        assert!(different(compare(
            tops,
            &LieMidpoint::cayley(),
            &options,
            h,
            top
        )));
        assert!(different(compare(
            bodies,
            &ImplicitMidpoint,
            &options,
            h,
            body
        )));
        assert!(different(compare(
            bodies,
            &LieMidpoint::exp(),
            &options,
            h,
            body
        )));
        assert!(different(compare(
            bodies,
            &LieMidpoint::cayley(),
            &options,
            h,
            body
        )));
    }
    let options = NewtonOptions::default();
    let generating = [
        compare(bodies, &Generating4::exp(), &options, h, body),
        compare(bodies, &Generating4::cayley(), &options, h, body),
        compare(bodies, &Generating6::exp(), &options, h, body),
        compare(tops, &GeneratingSecondKind2, &options, h, top),
    ];
    assert!(generating.map(different).iter().all(|different| *different));
    compare(tops, &Rk4, &options, h, top);
    compare(bodies, &Rk4, &options, h, body);
    compare(tops, &Dopri5::default(), &options, h, top);
    compare(
        bodies,
        &Dopri5 {
            rtol: 1e-10,
            atol: 1e-12,
        },
        &options,
        [1.0; 8],
        body,
    );
}

#[test]
fn step_sizes_may_differ_per_lane() {
    let tops = (&HeavyTop::default(), &HeavyTop::default());
    let h = [0.1, -0.1, 0.2, 1e-3, 1e-9, 0.3, -0.25, 0.05];
    let options = NewtonOptions::default();
    assert!(different(compare(
        tops,
        &LieMidpoint::exp(),
        &options,
        h,
        |_| top(5)
    )));
    assert!(different(compare(tops, &Gauss4, &options, h, |_| top(5))));
    compare(tops, &Dopri5::default(), &options, h, |_| top(5));
}

#[test]
fn a_lane_with_a_small_pivot_is_solved_alone() {
    let saddles = (&Saddle(F64x8::from_f64(0.75)), &Saddle(0.75));
    let h = [0.1, 2.0, 0.3, 2.0 - 1e-4, 0.5, 0.6, 2.0 + 1e-3, 0.8];
    let start = |lane: usize| [0.3 + lane as f64, -0.4];
    for options in [NewtonOptions::default(), NewtonOptions::simplified()] {
        let reports = compare(saddles, &ImplicitMidpoint, &options, h, start);
        let pivoted = reports.map(|report| report.pivoted == 1);
        assert_eq!(
            pivoted,
            [false, true, false, true, false, false, true, false]
        );
    }
    // the exact step: (1 - Df) u = (1 + Df) mu with h/2 = 1
    let mut mu = SVector::from([0.3, -0.4]);
    let stepper = &mut ImplicitMidpoint.stepper(&Saddle(0.75), 2.0, &NewtonOptions::default());
    Stepper::<f64>::step(stepper, &mut mu, &mut ()).expect("the step converges");
    // matrices (0, -1; -3/4, 2) and (2, 1; 3/4, 0)
    let right = [2.0 * 0.3 - 0.4, 0.75 * 0.3];
    let residual = [-mu[1] - right[0], -0.75 * mu[0] + 2.0 * mu[1] - right[1]];
    assert!(
        residual[0].abs() < 1e-15 && residual[1].abs() < 1e-15,
        "{residual:?}"
    );
}

#[test]
fn a_failed_lane_keeps_its_state_and_leaves_the_others_alone() {
    let coefficient = F64x8::new([0.75, 0.0, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75]);
    let system = Saddle(coefficient);
    let mut mu = SVector::<F64x8, 2>::new(F64x8::splat(0.3), F64x8::splat(-0.4));
    mu[1] = mu[1].with_lane(5, f64::NAN);
    let before = mu;
    let mut stepper =
        ImplicitMidpoint.stepper(&system, F64x8::splat(2.0), &NewtonOptions::default());
    let failure = stepper.step(&mut mu, &mut ()).expect_err("two lanes fail");
    assert_eq!(failure.lanes, 0b10_0010);
    assert_eq!(failure.reason, FailureReason::Singular);
    for lane in 0..8 {
        let bits = |state: &SVector<F64x8, 2>| [0, 1].map(|row| state[row].lane(lane).to_bits());
        assert_eq!(
            bits(&before) == bits(&mu),
            [1, 5].contains(&lane),
            "lane {lane}"
        );
    }
    let mut alone = SVector::<f64, 2>::from([0.3, -0.4]);
    let mut stepper = ImplicitMidpoint.stepper(&Saddle(0.75), 2.0, &NewtonOptions::default());
    stepper
        .step(&mut alone, &mut ())
        .expect("the lane alone converges");
    assert_eq!(alone[0].to_bits(), mu[0].lane(7).to_bits());
}

#[test]
fn single_precision_in_lanes() {
    let start = top(5).map(|x| x as f32);
    let mut lanes = SVector::<F32x8, 6>::from_fn(|row, _| F32x8::splat(start[row]));
    let mut one = SVector::<f32, 6>::from(start);
    let options = NewtonOptions::default();
    let method = LieMidpoint::exp();
    run(
        &HeavyTop::default(),
        &method,
        &options,
        F32x8::splat(0.1),
        &mut lanes,
    )
    .expect("converges");
    run(&HeavyTop::default(), &method, &options, 0.1_f32, &mut one).expect("converges");
    let mut double = SVector::from(top(5));
    run(
        &HeavyTop::default(),
        &method,
        &options,
        0.1_f64,
        &mut double,
    )
    .expect("converges");
    for row in 0..6 {
        assert_eq!(lanes[row].lane(3).to_bits(), one[row].to_bits());
        assert!((f64::from(one[row]) - double[row]).abs() < 3e-6);
    }
}
