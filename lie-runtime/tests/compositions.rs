//! Compositions and splittings: orders, what they keep, factors, lanes, failures.

use crate::systems::heavy_top::{HeavyTop, START};
use crate::systems::nonpolynomial::Nonpolynomial;
use crate::systems::rigid_body::RigidBody;
use crate::systems::saddle::Saddle;
use crate::systems::{daily, deep, distance, state, steps};
use lie_runtime::Implicit;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::coadjoint_action;
use lie_runtime::methods::{
    Compose, Compose4, Compose6, Compose8, FactorSink, Facts, Method, Retraction, Scheme,
    Splitting, Splitting1, Splitting2, Splitting4, Splitting6, Splitting8, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use nalgebra::SVector;

const BODY: [f64; 3] = [0.6, -0.5, 0.7];

/// The order as a slope, errors against Gauss collocation with small steps.
fn order<P: Implicit<f64, Gauss6>, M: Method<f64, P>>(
    system: &P,
    method: &M,
    start: &[f64],
    span: f64,
    counts: &[u32],
) -> f64 {
    fn end<P: Poisson<f64>>(
        system: &P,
        method: &impl Method<f64, P>,
        start: &[f64],
        span: f64,
        count: u32,
    ) -> P::State {
        let mut mu = state(system, start);
        steps(system, method, span / f64::from(count), count, &mut mu).expect("a step");
        mu
    }
    let reference = end(system, &Gauss6, start, span, 400);
    let error = |count| distance(&end(system, method, start, span, count), &reference);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| (span / f64::from(count), error(count)))
        .collect();
    let order = order_of_convergence(&points, 5e-14);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}

/// Within a twentieth of the order that the constants name.
fn check_order<M: Facts>(_method: &M, measured: f64) {
    println!("{}: {measured:.2}", M::ID);
    let difference = (measured - f64::from(M::ORDER)).abs();
    assert!(
        difference < 0.05 * f64::from(M::ORDER),
        "{}: {measured}",
        M::ID
    );
}

#[test]
fn compositions_have_their_order() {
    fn check<const ORDER: u32>(schemes: &[Scheme], counts: &[u32]) {
        for &scheme in schemes {
            let method = Compose::<_, ORDER>::new(LieMidpoint::exp()).scheme(scheme);
            println!("{scheme:?}");
            check_order(&method, order(&Nonpolynomial, &method, &BODY, 1.0, counts));
        }
    }
    use Scheme::{KahanLi, Suzuki, SuzukiUmeno, TripleJump, Yoshida};
    check::<4>(&[Suzuki, TripleJump], &[16, 24, 32, 48, 64]);
    check::<6>(&[KahanLi, Yoshida, Suzuki], &[6, 8, 12, 16, 24]);
    check::<6>(&[TripleJump], &[24, 32, 48, 64]);
    check::<8>(&[KahanLi, SuzukiUmeno], &[5, 6, 7, 8, 10]);
}

#[test]
fn splittings_have_their_order() {
    fn check<const ORDER: u32>(method: Splitting<ORDER>, span: f64, counts: &[u32]) {
        let top = HeavyTop::default();
        println!("{method:?}");
        check_order(&method, order(&top, &method, &START, span, counts));
    }
    use Scheme::{BlanesMoan, KahanLi, Suzuki, SuzukiUmeno, TripleJump, Yoshida};
    check(Splitting1::new(), 1.0, &[128, 192, 256]);
    check(Splitting2::new(), 1.0, &[16, 24, 32, 48, 64]);
    for scheme in [BlanesMoan, Suzuki, TripleJump] {
        check(Splitting4::new().scheme(scheme), 1.0, &[16, 24, 32, 48]);
    }
    for scheme in [BlanesMoan, KahanLi, Yoshida, Suzuki] {
        check(Splitting6::new().scheme(scheme), 2.0, &[10, 12, 14, 16, 20]);
    }
    let long = Splitting6::new().scheme(TripleJump);
    check(long, 2.0, &[48, 64, 80, 96]);
    for scheme in [KahanLi, SuzukiUmeno] {
        check(Splitting8::new().scheme(scheme), 4.0, &[14, 16, 18, 20]);
    }
}

/// Five equal stages, in place of Suzuki's: a symmetric composition of order 2.
#[test]
fn the_order_comes_from_the_coefficients() {
    let start = SVector::from(BODY);
    let run = |method: &dyn Fn(f64, &mut SVector<f64, 3>)| {
        let end = |count: u32| {
            let mut mu = start;
            (0..count).for_each(|_| method(1.0 / f64::from(count), &mut mu));
            mu
        };
        let reference = end(2000);
        let points =
            [16, 24, 32].map(|count| (1.0 / f64::from(count), distance(&end(count), &reference)));
        order_of_convergence(&points, 1e-13)
            .expect("three points")
            .slope
    };
    let equal = |h: f64, mu: &mut SVector<f64, 3>| {
        steps(&Nonpolynomial, &LieMidpoint::exp(), h / 5.0, 5, mu).expect("a step");
    };
    let suzuki = |h: f64, mu: &mut SVector<f64, 3>| {
        let method = Compose4::new(LieMidpoint::exp());
        steps(&Nonpolynomial, &method, h, 1, mu).expect("a step");
    };
    let (equal, suzuki) = (run(&equal), run(&suzuki));
    assert!(
        (equal - 2.0).abs() < 0.1 && (suzuki - 4.0).abs() < 0.1,
        "{equal} {suzuki}"
    );
}

#[test]
fn a_splitting_of_higher_order_is_the_composition_of_strang_steps() {
    let top = HeavyTop::default();
    fn check(top: &HeavyTop, one: &impl Method<f64, HeavyTop>, other: &impl Method<f64, HeavyTop>) {
        let (mut a, mut b) = (SVector::from(START), SVector::from(START));
        steps(top, one, 0.3, 1, &mut a).expect("a step");
        steps(top, other, 0.3, 1, &mut b).expect("a step");
        let distance = distance(&a, &b);
        assert!(distance < 2e-15, "{distance:e}");
    }
    use Scheme::{KahanLi, Suzuki, TripleJump, Yoshida};
    let strang = Splitting2::new();
    for scheme in [Suzuki, TripleJump] {
        let composed = Compose4::new(strang).scheme(scheme);
        check(&top, &Splitting4::new().scheme(scheme), &composed);
    }
    for scheme in [KahanLi, Yoshida, Suzuki, TripleJump] {
        let composed = Compose6::new(strang).scheme(scheme);
        check(&top, &Splitting6::new().scheme(scheme), &composed);
    }
    check(&top, &Splitting8::new(), &Compose8::new(strang));
}

/// Calls a macro with splittings and compositions.
macro_rules! each {
    ($call:ident) => {
        $call!(Splitting1::new());
        $call!(Splitting2::new());
        $call!(Splitting4::new());
        $call!(Splitting4::new().scheme(Scheme::Suzuki));
        $call!(Splitting6::new());
        $call!(Splitting8::new());
        $call!(Compose4::new(LieMidpoint::exp()));
        $call!(Compose6::new(LieMidpoint::cayley()));
        $call!(Compose8::new(LieMidpoint::exp()));
        $call!(Compose4::new(Splitting2::new()));
    };
}

/// Largest change of a Casimir over some thousand steps.
fn casimir_drift(method: &impl Method<f64, HeavyTop>) -> f64 {
    let top = HeavyTop::default();
    let mut mu = SVector::from(START);
    let (mut first, mut last) = ([0.0; 2], [0.0; 2]);
    top.casimirs(&mu, &mut first);
    steps(&top, method, 0.1, daily(400, 2000), &mut mu).expect("a step");
    top.casimirs(&mu, &mut last);
    (first[0] - last[0]).abs().max((first[1] - last[1]).abs())
}

fn defect(method: &impl Method<Dual<f64>, HeavyTop<Dual<f64>>>) -> f64 {
    let top = HeavyTop::default();
    poisson_defect(&top, method, 0.2, &START, &NewtonOptions::default()).expect("a step")
}

#[test]
fn they_keep_what_their_constants_say() {
    fn facts<M: Facts>(_: &M) -> (bool, bool) {
        assert!(M::PRESERVES.orbit && M::PRESERVES.poisson && !M::PRESERVES.energy);
        (M::SYMMETRIC, M::EXPLICIT)
    }
    macro_rules! check {
        ($method:expr) => {
            let name = stringify!($method);
            let drift = casimir_drift(&$method);
            assert!(drift < 3e-13, "{name}: {drift:e}");
            let defect = defect(&$method);
            assert!(defect < 2e-14, "{name}: {defect:e}");
            let (symmetric, explicit) = facts(&$method);
            assert_eq!(explicit, !name.contains("LieMidpoint"));
            let top = HeavyTop::default();
            let mut mu = SVector::from(START);
            steps(&top, &$method, 0.2, 1, &mut mu).expect("a step");
            steps(&top, &$method, -0.2, 1, &mut mu).expect("a step");
            let distance = distance(&mu, &SVector::from(START));
            assert_eq!(distance < 1e-14, symmetric, "{name}: {distance:e}");
        };
    }
    each!(check);
    // compositions keep no more than their base does
    let midpoint = Compose4::new(ImplicitMidpoint);
    let (lost, kept) = (defect(&midpoint), casimir_drift(&midpoint));
    assert!(lost > 1e-8 && kept < 3e-13, "{lost:e} {kept:e}");
    const { assert!(!<Compose4<ImplicitMidpoint> as Facts>::PRESERVES.poisson) };
}

/// Applies the factors as they come.
struct Replay {
    mu: SVector<f64, 6>,
    retraction: Retraction,
    count: usize,
}

impl FactorSink<SVector<f64, 6>> for Replay {
    fn push(&mut self, retraction: Retraction, xi: &SVector<f64, 6>) {
        assert_eq!(retraction, self.retraction);
        let mu = self.mu;
        coadjoint_action(&HeavyTop::default(), xi, &mu, &mut self.mu);
        self.count += 1;
    }
}

#[test]
fn the_factors_lead_to_the_new_state() {
    let top = HeavyTop::default();
    let replay = |method: &dyn Fn(&mut SVector<f64, 6>, &mut Replay)| {
        let mut mu = SVector::from(START);
        let (retraction, count) = (Retraction::Exp, 0);
        let mut replay = Replay {
            mu,
            retraction,
            count,
        };
        method(&mut mu, &mut replay);
        (distance(&mu, &replay.mu), replay.count)
    };
    macro_rules! check {
        ($method:expr, $count:expr) => {
            let (distance, count) = replay(&|mu, sink| {
                let mut stepper = $method.stepper(&top, 0.3, &NewtonOptions::default());
                stepper.step(mu, sink).expect("a step");
            });
            assert!(distance < 1e-15, "{}: {distance:e}", stringify!($method));
            assert_eq!(count, $count);
        };
    }
    // six pieces; where a sweep turns, two flows are one
    check!(Splitting1::new(), 6);
    check!(Splitting2::new(), 2 * 6 - 1);
    check!(Splitting4::new(), 12 * 6 - 11);
    check!(Splitting8::new(), 34 * 6 - 33);
    check!(Compose4::new(LieMidpoint::exp()), 5);
    check!(Compose8::new(Splitting2::new()), 17 * 11);
}

#[test]
fn lanes_have_the_digits_of_the_scalar_run() {
    fn check<M>(method: &M, name: &str)
    where
        M: Method<F64x8, HeavyTop<F64x8>> + Method<f64, HeavyTop<f64>>,
    {
        let h = [0.1, -0.2, 0.5, 1e-9, 0.3, 0.25, -0.35, 0.01];
        let start = |lane: usize| START.map(|entry| entry * (1.0 + 0.2 * lane as f64));
        let many = HeavyTop::<F64x8>::default();
        let mut together = SVector::<F64x8, 6>::from_fn(|row, _| {
            F64x8::new(core::array::from_fn(|lane| start(lane)[row]))
        });
        let options = NewtonOptions::default();
        let mut stepper = method.stepper(&many, F64x8::new(h), &options);
        for _ in 0..3 {
            stepper.step(&mut together, &mut ()).expect("a step");
        }
        for (lane, h) in h.into_iter().enumerate() {
            let mut mu = SVector::from(start(lane));
            steps(&HeavyTop::default(), method, h, 3, &mut mu).expect("a step");
            for row in 0..6 {
                let bits = (together[row].lane(lane).to_bits(), mu[row].to_bits());
                assert_eq!(bits.0, bits.1, "{name}: lane {lane}");
            }
        }
    }
    macro_rules! check {
        ($method:expr) => {
            deep(|| check(&$method, stringify!($method)))
        };
    }
    each!(check);
}

/// Sees the factors of all lanes.
struct Lanes(Vec<[bool; 8]>);

impl<const N: usize> FactorSink<SVector<F64x8, N>> for Lanes {
    fn push(&mut self, _retraction: Retraction, xi: &SVector<F64x8, N>) {
        let moves = |lane: usize| xi.iter().any(|entry| entry.lane(lane) != 0.0);
        self.0.push(core::array::from_fn(moves));
    }
}

#[test]
fn a_failed_lane_keeps_its_state_and_gives_no_factors() {
    fn check<M: Method<F64x8, HeavyTop<F64x8>>>(method: M, name: &str) {
        let top = HeavyTop::<F64x8>::default();
        let mut mu = SVector::<F64x8, 6>::from_fn(|row, _| F64x8::splat(START[row]));
        mu[0] = mu[0].with_lane(2, f64::NAN);
        let h = F64x8::splat(0.1).with_lane(4, 1e300);
        let before = mu;
        let mut stepper = method.stepper(&top, h, &NewtonOptions::default());
        let mut lanes = Lanes(Vec::new());
        let failure = stepper
            .step(&mut mu, &mut lanes)
            .expect_err("two lanes fail");
        assert_eq!(failure.lanes, 0b1_0100, "{name}");
        assert_eq!(failure.reason, FailureReason::NotFinite);
        for lane in 0..8 {
            let bits = |mu: &SVector<F64x8, 6>| mu.map(|entry| entry.lane(lane).to_bits());
            let failed = [2, 4].contains(&lane);
            assert_eq!(bits(&before) == bits(&mu), failed, "{lane}");
            let moved = lanes.0.iter().filter(|moves| moves[lane]).count();
            assert_eq!(moved == 0, failed, "{name}: {lane}");
        }
    }
    macro_rules! checked {
        ($method:expr) => {
            deep(|| check($method, stringify!($method)));
        };
    }
    each!(checked);
}

/// A linear saddle whose midpoint step is singular where h times the coefficient is 2.
#[test]
fn a_failure_in_a_later_stage_undoes_the_earlier_ones() {
    // the third stage of Suzuki's composition, about -0.66 h, is 2; the others are not
    let middle = -0.657963087177503_f64;
    let near = (2.0 / middle).abs().to_bits();
    let singular = (near - 4..near + 4)
        .map(|bits| -f64::from_bits(bits))
        .find(|h| middle * h == 2.0)
        .expect("a number whose product rounds to 2");
    let h = F64x8::splat(0.1).with_lane(3, singular);
    let system = Saddle(F64x8::splat(0.0));
    let mut mu = SVector::<F64x8, 2>::new(F64x8::splat(0.3), F64x8::splat(-0.4));
    let before = mu;
    let method = Compose4::new(ImplicitMidpoint);
    let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
    let outcome = stepper.step(&mut mu, &mut ());
    let failure = outcome.expect_err("one lane fails");
    assert_eq!(failure.lanes, 0b1000);
    for lane in 0..8 {
        let kept =
            (0..2).all(|row| before[row].lane(lane).to_bits() == mu[row].lane(lane).to_bits());
        assert_eq!(kept, lane == 3, "lane {lane}");
    }
    // alone: the two stages before did move
    let mut alone = SVector::from([0.3, -0.4]);
    let mut stepper = method.stepper(&Saddle(0.0), singular, &NewtonOptions::default());
    let failure = stepper.step(&mut alone, &mut ()).expect_err("it fails");
    assert_eq!(alone, SVector::from([0.3, -0.4]));
    assert!(failure.report.iterations >= 3, "{failure:?}");
}

#[test]
fn steps_allocate_nothing() {
    macro_rules! check {
        ($method:expr) => {
            deep(|| {
                let top = HeavyTop::<F64x8>::default();
                let mut mu = state(&top, &START);
                let h = F64x8::splat(0.1);
                let mut stepper = $method.stepper(&top, h, &NewtonOptions::default());
                let allocations = allocation_counter::measure(|| {
                    for _ in 0..3 {
                        stepper.step(&mut mu, &mut ()).expect("a step");
                    }
                });
                assert_eq!(allocations.count_total, 0, "{}", stringify!($method));
            });
        };
    }
    each!(check);
}

#[test]
#[should_panic(expected = "no such composition")]
fn a_scheme_of_another_order_is_refused() {
    let _method = Compose4::new(LieMidpoint::exp()).scheme(Scheme::KahanLi);
}

#[test]
#[should_panic(expected = "no such splitting")]
fn strang_has_one_scheme() {
    let _method = Splitting2::new().scheme(Scheme::Suzuki);
}

/// The order of the pieces and the times, against rotations written out.
#[test]
fn strang_and_lie_trotter_by_hand() {
    let body = RigidBody::<f64>::default();
    let start = SVector::from([0.9, 0.3, 0.4]);
    let rotate = |mu: &mut SVector<f64, 3>, axis: usize, t: f64| {
        let (sin, cos) = (t * mu[axis] / body.inertia[axis]).sin_cos();
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        (mu[j], mu[k]) = (cos * mu[j] + sin * mu[k], cos * mu[k] - sin * mu[j]);
    };
    for h in [0.1, -0.2] {
        let mut expected = start;
        (0..3).for_each(|axis| rotate(&mut expected, axis, h));
        let mut mu = start;
        steps(&body, &Splitting1::new(), h, 1, &mut mu).expect("a step");
        assert!(distance(&mu, &expected) < 5e-16);

        let mut expected = start;
        for axis in [0, 1, 2, 2, 1, 0] {
            rotate(&mut expected, axis, h / 2.0);
        }
        let mut mu = start;
        steps(&body, &Splitting2::new(), h, 1, &mut mu).expect("a step");
        assert!(distance(&mu, &expected) < 5e-16);
        let mut backwards = start;
        for axis in [2, 1, 0, 0, 1, 2] {
            rotate(&mut backwards, axis, h / 2.0);
        }
        assert!(distance(&mu, &backwards) > 1e-6);
    }
}
