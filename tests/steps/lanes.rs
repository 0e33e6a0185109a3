//! One generated impl over f64, f32 and eight lanes: a lane has the digits of the scalar run.

use crate::systems::{
    Declared, HeavyTop, Random, canonical_pendulum, e2_pendulum, heisenberg_h3, lotka_volterra,
    se2_circulation, se3_heavy_top, se3_kirchhoff, sl2_quadratic, so3_cotangent_euler_arnold,
    so3_free_rigid_body, so3_gyrostat_lagrangian, so3_nonpolynomial, so3_quartic_lagrangian,
    so4_manakov, state, su3_quadratic, toda3_solvable,
};
use lie_runtime::methods::{
    MeanTensor, MeanValue, Method, StepFailure, StepReport, Stepper, WithTensor,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;

const STEPS: usize = 20;

/// Eight starts around one state: from close to it to far from it, so that Newton's iteration takes
/// more steps in some lanes than in others.
fn starts(initial: &[f64]) -> [Vec<f64>; 8] {
    let mut random = Random(2018);
    core::array::from_fn(|lane| {
        let size = [1e-6, 1e-3, 0.03, 0.1, 0.3, 1.0, 2.0, 3.0][lane];
        initial
            .iter()
            .map(|x| size * (x + 0.5 * random.number()))
            .collect()
    })
}

fn steps<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    h: S,
    mu: &mut P::State,
) -> Vec<Result<StepReport, StepFailure>> {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    (0..STEPS).map(|_| stepper.step(mu, &mut ())).collect()
}

/// Runs eight lanes together and one after the other: the same digits, and steps that are too large
/// for a lane fail in it alone. Returns whether some step took different numbers of iterations in
/// different lanes.
fn compare<P8, P1, M>(lanes: &P8, scalar: &P1, method: &M, initial: &[f64]) -> bool
where
    P8: Poisson<F64x8>,
    P1: Poisson<f64>,
    M: Method<F64x8, P8> + Method<f64, P1>,
{
    let starts = starts(initial);
    let h: [f64; 8] = [0.1, 0.1, 0.1, 0.1, 0.2, 0.2, -0.2, 0.3];
    let mut together = lanes.zero_state();
    for (row, entry) in together.as_mut_slice().iter_mut().enumerate() {
        *entry = F64x8::new(core::array::from_fn(|lane| starts[lane][row]));
    }
    let reports = steps(lanes, method, F64x8::new(h), &mut together);
    let mut alone = Vec::new();
    for (lane, start) in starts.iter().enumerate() {
        let mut mu = state(scalar, start);
        alone.push(steps(scalar, method, h[lane], &mut mu));
        for (row, x) in mu.as_slice().iter().enumerate() {
            let bits = together.as_slice()[row].lane(lane).to_bits();
            assert_eq!(
                bits,
                x.to_bits(),
                "{} {}: lane {lane}, coordinate {row}",
                scalar.name(),
                M::ID
            );
        }
    }
    let mut different = false;
    for (step, together) in reports.iter().enumerate() {
        let lanes: Vec<_> = alone.iter().map(|lane| lane[step]).collect();
        let failed = (0..8)
            .filter(|&lane| lanes[lane].is_err())
            .map(|lane| 1_u64 << lane);
        assert_eq!(
            together.map_or_else(|failure| failure.lanes, |_| 0),
            failed.sum::<u64>()
        );
        let iterations = |report: &Result<StepReport, StepFailure>| {
            report
                .map_or_else(|failure| failure.report, |report| report)
                .iterations
        };
        let each: Vec<u32> = lanes.iter().map(iterations).collect();
        let slowest = each.iter().max();
        assert_eq!(
            Some(&iterations(together)),
            slowest,
            "as many as the slowest lane"
        );
        different |= each.iter().any(|&other| other != each[0]);
    }
    different
}

macro_rules! same_digits {
    (@cayley $lanes:ident, $scalar:ident, $initial:ident, cayley) => {
        assert!(compare(&$lanes, &$scalar, &LieMidpoint::cayley(), &$initial));
    };
    (@cayley $lanes:ident, $scalar:ident, $initial:ident, exp) => {};
    ($file:ident, $name:ident, $cayley:ident) => {
        #[test]
        fn $file() {
            let lanes = $file::$name::<F64x8>::default().system().expect("valid parameters");
            let scalar = $file::$name::<f64>::default().system().expect("valid parameters");
            let initial = $file::$name::<f64>::default().initial_state().as_slice().to_vec();
            assert!(compare(&lanes, &scalar, &ImplicitMidpoint, &initial));
            assert!(compare(&lanes, &scalar, &Gauss4, &initial));
            assert!(compare(&lanes, &scalar, &LieMidpoint::exp(), &initial));
            same_digits!(@cayley lanes, scalar, initial, $cayley);
            compare(&lanes, &scalar, &Rk4, &initial);
        }
    };
}

each_system!(same_digits);
same_digits!(so3_gyrostat_lagrangian, Gyrostat, cayley);
same_digits!(so3_quartic_lagrangian, QuarticBody, cayley);

macro_rules! same_digits_of_brackets {
    ($file:ident, $name:ident) => {
        #[test]
        fn $file() {
            let lanes = $file::$name::<F64x8>::default()
                .system()
                .expect("valid parameters");
            let scalar = $file::$name::<f64>::default()
                .system()
                .expect("valid parameters");
            let initial = $file::$name::<f64>::default()
                .initial_state()
                .as_slice()
                .to_vec();
            assert!(compare(&lanes, &scalar, &ImplicitMidpoint, &initial));
            assert!(compare(&lanes, &scalar, &Gauss4, &initial));
            assert!(compare(&lanes, &scalar, &MeanValue, &initial));
            let mean = WithTensor::new(MeanValue, MeanTensor);
            assert!(compare(&lanes, &scalar, &mean, &initial));
            compare(&lanes, &scalar, &OrbitEnergy::gonzalez(), &initial);
            compare(&lanes, &scalar, &Rk4, &initial);
        }
    };
}

each_bracket!(same_digits_of_brackets);

/// Parameters may differ per lane.
#[test]
fn parameters_per_lane() {
    let moments: [f64; 8] = core::array::from_fn(|lane| 1.5 + 0.25 * lane as f64);
    let lanes = HeavyTop {
        I1: F64x8::new(moments),
        ..HeavyTop::<F64x8>::default()
    };
    let lanes = lanes.system().expect("valid parameters");
    let mut together = HeavyTop::<f64>::initial::<F64x8>();
    steps(
        &lanes,
        &LieMidpoint::exp(),
        F64x8::splat(0.1),
        &mut together,
    );
    for (lane, &moment) in moments.iter().enumerate() {
        let scalar = HeavyTop {
            I1: moment,
            ..HeavyTop::<f64>::default()
        };
        let scalar = scalar.system().expect("valid parameters");
        let mut mu = HeavyTop::<f64>::initial::<f64>();
        steps(&scalar, &LieMidpoint::exp(), 0.1, &mut mu);
        for (row, x) in mu.iter().enumerate() {
            assert_eq!(
                together[row].lane(lane).to_bits(),
                x.to_bits(),
                "lane {lane}"
            );
        }
    }
}

/// A lane that fails keeps its state; the others have the digits of their own runs.
#[test]
fn one_lane_fails() {
    fn check<M>(method: &M, broken: f64)
    where
        M: Method<F64x8, se3_heavy_top::HeavyTopSystem<F64x8>>
            + Method<f64, se3_heavy_top::HeavyTopSystem<f64>>,
    {
        let (lanes, scalar) = (
            HeavyTop::<f64>::declared::<F64x8>(),
            HeavyTop::<f64>::declared::<f64>(),
        );
        let start = HeavyTop::<f64>::initial::<f64>();
        let mut together = HeavyTop::<f64>::initial::<F64x8>();
        together[1] = together[1].with_lane(5, broken);
        let before = together;
        let reports = steps(&lanes, method, F64x8::splat(0.1), &mut together);
        let mut mu = start;
        steps(&scalar, method, 0.1, &mut mu);
        for report in reports {
            let failure = report.expect_err("lane 5 fails in every step");
            assert_eq!(failure.lanes, 1 << 5, "{}: {failure}", M::ID);
            assert_ne!(failure.reason, FailureReason::Singular);
        }
        let mut alone = start;
        alone[1] = broken;
        assert!(steps(&scalar, method, 0.1, &mut alone)[0].is_err());
        for row in 0..6 {
            for lane in 0..8 {
                let expected = if lane == 5 {
                    before[row].lane(lane)
                } else {
                    mu[row]
                };
                assert_eq!(
                    together[row].lane(lane).to_bits(),
                    expected.to_bits(),
                    "lane {lane}"
                );
            }
        }
    }
    for broken in [f64::NAN, f64::INFINITY, 1e200] {
        check(&ImplicitMidpoint, broken);
        check(&Gauss4, broken);
        check(&LieMidpoint::exp(), broken);
        check(&LieMidpoint::cayley(), broken);
    }
}

/// f32 is close to f64 in units of its own round-off, and keeps Casimirs as well as it can.
#[test]
fn single_precision() {
    fn check<M>(method: &M)
    where
        M: Method<f32, se3_heavy_top::HeavyTopSystem<f32>>
            + Method<F32x8, se3_heavy_top::HeavyTopSystem<F32x8>>
            + Method<f64, se3_heavy_top::HeavyTopSystem<f64>>,
    {
        let single = HeavyTop::<f64>::declared::<f32>();
        let mut mu = HeavyTop::<f64>::initial::<f32>();
        let mut before = [0.0; 2];
        single.casimirs(&mu, &mut before);
        for report in steps(&single, method, 0.1, &mut mu) {
            let report = report.expect("it converges");
            assert!(report.iterations - report.fixed_point <= 4 && report.fixed_point <= 12);
        }
        let mut after = [0.0; 2];
        single.casimirs(&mu, &mut after);
        let mut double = HeavyTop::<f64>::initial::<f64>();
        steps(
            &HeavyTop::<f64>::declared::<f64>(),
            method,
            0.1,
            &mut double,
        );
        let mut lanes = HeavyTop::<f64>::initial::<F32x8>();
        steps(
            &HeavyTop::<f64>::declared::<F32x8>(),
            method,
            F32x8::splat(0.1),
            &mut lanes,
        );
        let mut largest = 0.0_f64;
        for row in 0..6 {
            largest = largest.max((f64::from(mu[row]) - double[row]).abs());
            assert_eq!(lanes[row].lane(7).to_bits(), mu[row].to_bits());
        }
        println!(
            "{}: f32 is {largest:.1e} from f64, Casimirs {before:?} to {after:?}",
            M::ID
        );
        assert!(
            largest < 16.0 * f64::from(f32::EPSILON),
            "{}: {largest:e}",
            M::ID
        );
        for (before, after) in before.iter().zip(after) {
            assert!((before - after).abs() < 8.0 * f32::EPSILON, "{}", M::ID);
        }
        // and is f32 indeed
        assert!(largest > 1e-9);
    }
    check(&ImplicitMidpoint);
    check(&Gauss4);
    check(&LieMidpoint::exp());
    check(&LieMidpoint::cayley());
}
