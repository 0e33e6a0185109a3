//! The explicit methods of coadjoint form: orders, what they keep, factors, lanes, failures.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::coadjoint_action;
use lie_runtime::methods::{
    CommutatorFree4, CrouchGrossman3, FactorSink, Facts, LieEuler, Method, Retraction, Rk4, Rkmk2,
    Rkmk3, Rkmk4, Rkmk6, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use nalgebra::SVector;
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::{distance, state, steps};

/// Calls a macro with every method of this kind.
macro_rules! each {
    ($call:ident) => {
        $call!(LieEuler);
        $call!(Rkmk2);
        $call!(Rkmk3);
        $call!(Rkmk4);
        $call!(Rkmk6);
        $call!(CrouchGrossman3);
        $call!(CommutatorFree4);
    };
}

/// The state of the non-polynomial system at t = 1 from (0.6, -0.5, 0.7).
const NONPOLYNOMIAL: [f64; 3] = [0.18714184953656818, 0.09258594649146742, 1.0278160198519537];
const BODY: [f64; 3] = [0.6, -0.5, 0.7];
/// The state of the heavy top at t = 1.
const TOP: [f64; 6] = [
    0.702124293102685,
    -0.19397034937192864,
    0.8493552060006306,
    0.6478081064813676,
    0.2690475836433316,
    0.712711761452489,
];

fn slope(counts: &[u32], error: impl Fn(u32) -> f64) -> f64 {
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| (1.0 / f64::from(count), error(count)))
        .collect();
    order_of_convergence(&points, 3e-14)
        .expect("enough points above round-off")
        .slope
}

const COUNTS: [u32; 6] = [16, 24, 32, 48, 64, 96];

fn measured<M>(method: &M) -> [f64; 2]
where
    M: Method<f64, Nonpolynomial> + Method<f64, HeavyTop> + Facts,
{
    let counts = COUNTS.map(|count| if M::ORDER < 6 { count } else { count / 4 });
    fn error<P: Poisson<f64>>(
        system: &P,
        method: &impl Method<f64, P>,
        (start, end): (&[f64], &[f64]),
        count: u32,
    ) -> f64 {
        let mut mu = state(system, start);
        let h = 1.0 / f64::from(count);
        steps(system, method, h, count, &mut mu).expect("finite");
        distance(&mu, &state(system, end))
    }
    let top = HeavyTop::default();
    [
        slope(&counts, |count| {
            error(&Nonpolynomial, method, (&BODY, &NONPOLYNOMIAL), count)
        }),
        slope(&counts, |count| error(&top, method, (&START, &TOP), count)),
    ]
}

#[test]
fn measured_orders_are_the_declared_ones() {
    macro_rules! check {
        ($method:ident) => {
            for slope in measured(&$method) {
                let order = f64::from($method::ORDER);
                assert!((slope - order).abs() < 0.15, "{}: {slope}", $method::ID);
            }
        };
    }
    each!(check);
}

/// `rkmk4` once more, straight from its formulas and with a sign in front of sigma in the inverse of
/// dexp: -1 is right.
fn rkmk4_by_hand(sign: f64, h: f64, mu: &SVector<f64, 3>) -> SVector<f64, 3> {
    let act = |sigma: &SVector<f64, 3>| {
        let mut out = *mu;
        coadjoint_action(&Nonpolynomial, sigma, mu, &mut out);
        out
    };
    let slope = |sigma: SVector<f64, 3>| {
        let mut xi = *mu;
        Poisson::<f64>::gradient(&Nonpolynomial, &act(&sigma), &mut xi);
        let argument = sigma * sign;
        let (once, twice) = (argument.cross(&xi), argument.cross(&argument.cross(&xi)));
        xi - once / 2.0 + twice / 12.0
    };
    let k1 = slope(SVector::zeros());
    let k2 = slope(k1 * (h / 2.0));
    let k3 = slope(k2 * (h / 2.0));
    let k4 = slope(k3 * h);
    act(&((k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)))
}

#[test]
fn the_wrong_sign_in_the_inverse_of_dexp_costs_two_orders() {
    let start = SVector::from(BODY);
    let mut mu = start;
    steps(&Nonpolynomial, &Rkmk4, 0.1, 1, &mut mu).expect("finite");
    assert!(distance(&mu, &rkmk4_by_hand(-1.0, 0.1, &start)) < 5e-16);
    let order = |sign: f64| {
        slope(&COUNTS, |count| {
            let mut mu = start;
            for _ in 0..count {
                mu = rkmk4_by_hand(sign, 1.0 / f64::from(count), &mu);
            }
            distance(&mu, &SVector::from(NONPOLYNOMIAL))
        })
    };
    let (right, wrong) = (order(-1.0), order(1.0));
    assert!((right - 4.0).abs() < 0.15, "{right}");
    assert!((wrong - 2.0).abs() < 0.15, "{wrong}");
}

fn casimir_drift<M: Method<f64, HeavyTop>>(method: &M) -> f64 {
    let system = HeavyTop::default();
    let mut mu = state(&system, &START);
    let (mut first, mut last) = ([0.0; 2], [0.0; 2]);
    system.casimirs(&mu, &mut first);
    steps(&system, method, 0.1, 2000, &mut mu).expect("finite");
    system.casimirs(&mu, &mut last);
    (first[0] - last[0]).abs().max((first[1] - last[1]).abs())
}

#[test]
fn casimirs_are_kept_and_the_poisson_structure_is_not() {
    macro_rules! check {
        ($method:ident) => {
            let drift = casimir_drift(&$method);
            assert!(drift < 3e-13, "{}: {drift:e}", $method::ID);
            assert!($method::PRESERVES.orbit && $method::PRESERVES.casimirs);
            let system = HeavyTop::<Dual<f64>>::default();
            let options = NewtonOptions::default();
            let defect = poisson_defect(&system, &$method, 0.2, &START, &options).expect("finite");
            assert!(defect > 1e-11, "{}: {defect:e}", $method::ID);
            assert!(!$method::PRESERVES.poisson);
        };
    }
    each!(check);
    let control = casimir_drift(&Rk4);
    assert!(control > 1e-9, "{control:e}");
}

#[test]
fn steps_are_not_symmetric() {
    macro_rules! check {
        ($method:ident) => {
            let start = SVector::from(BODY);
            let mut mu = start;
            steps(&Nonpolynomial, &$method, 0.2, 1, &mut mu).expect("finite");
            steps(&Nonpolynomial, &$method, -0.2, 1, &mut mu).expect("finite");
            assert!(distance(&mu, &start) > 1e-10, "{}", $method::ID);
            assert!(!$method::SYMMETRIC && $method::EXPLICIT);
        };
    }
    each!(check);
}

/// Applies the factors as they come.
struct Replay<V> {
    mu: V,
    count: usize,
}

impl FactorSink<SVector<f64, 6>> for Replay<SVector<f64, 6>> {
    fn push(&mut self, retraction: Retraction, xi: &SVector<f64, 6>) {
        assert_eq!(retraction, Retraction::Exp);
        let mu = self.mu;
        coadjoint_action(&HeavyTop::default(), xi, &mu, &mut self.mu);
        self.count += 1;
    }
}

#[test]
fn the_factors_lead_to_the_new_state() {
    let factors = |method: &str| match method {
        "cg3" => 3,
        "cf4" => 2,
        _ => 1,
    };
    macro_rules! check {
        ($method:ident) => {
            let system = HeavyTop::default();
            let mut mu = SVector::from(START);
            let mut replay = Replay { mu, count: 0 };
            let mut stepper = $method.stepper(&system, 0.3, &NewtonOptions::default());
            let report = stepper.step(&mut mu, &mut replay).expect("finite");
            assert_eq!(replay.count, factors($method::ID));
            assert!(report.evaluations >= $method::ORDER && report.iterations == 0);
            let distance = distance(&mu, &replay.mu);
            assert!(distance < 1e-16, "{}: {distance:e}", $method::ID);
        };
    }
    each!(check);
}

#[test]
fn lanes_have_the_digits_of_the_scalar_run() {
    macro_rules! check {
        ($method:ident) => {
            let h = [0.1, -0.2, 0.5, 1e-9, 0.8, 0.6, -0.3, 0.01];
            let start = |lane: usize| START.map(|entry| entry * (1.0 + 0.5 * lane as f64));
            let many = HeavyTop::<F64x8>::default();
            let mut together = SVector::<F64x8, 6>::from_fn(|row, _| {
                F64x8::new(core::array::from_fn(|lane| start(lane)[row]))
            });
            let options = NewtonOptions::default();
            let mut stepper = $method.stepper(&many, F64x8::new(h), &options);
            for _ in 0..4 {
                stepper.step(&mut together, &mut ()).expect("finite");
            }
            for lane in 0..8 {
                let system = HeavyTop::<f64>::default();
                let mut mu = SVector::from(start(lane));
                steps(&system, &$method, h[lane], 4, &mut mu).expect("finite");
                for row in 0..6 {
                    let bits = (together[row].lane(lane).to_bits(), mu[row].to_bits());
                    assert_eq!(bits.0, bits.1, "{}: lane {lane}", $method::ID);
                }
            }
        };
    }
    each!(check);
}

#[test]
fn a_failed_lane_keeps_its_state() {
    macro_rules! check {
        ($method:ident) => {
            let system = HeavyTop::<F64x8>::default();
            let mut mu = SVector::<F64x8, 6>::from_fn(|row, _| F64x8::splat(START[row]));
            mu[0] = mu[0].with_lane(2, f64::NAN);
            // so far that no series of an exponential converges
            let h = F64x8::splat(0.1).with_lane(4, 1e30);
            let before = mu;
            let mut stepper = $method.stepper(&system, h, &NewtonOptions::default());
            let failure = stepper.step(&mut mu, &mut ()).expect_err("two lanes fail");
            assert_eq!(failure.lanes, 0b1_0100, "{}", $method::ID);
            assert_eq!(failure.reason, FailureReason::NotFinite);
            for lane in 0..8 {
                let kept = (0..6)
                    .all(|row| before[row].lane(lane).to_bits() == mu[row].lane(lane).to_bits());
                assert_eq!(kept, [2, 4].contains(&lane), "{}: lane {lane}", $method::ID);
            }
        };
    }
    each!(check);
}

#[test]
fn steps_allocate_nothing() {
    macro_rules! check {
        ($method:ident) => {
            let system = HeavyTop::<f64>::default();
            let mut mu = state(&system, &START);
            let mut stepper = $method.stepper(&system, 0.1, &NewtonOptions::default());
            let allocations = allocation_counter::measure(|| {
                for _ in 0..10 {
                    stepper.step(&mut mu, &mut ()).expect("finite");
                }
            });
            assert_eq!(allocations.count_total, 0, "{}", $method::ID);
        };
    }
    each!(check);
}
