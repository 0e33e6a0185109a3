//! Taylor series: the written recurrences are those of power series, orders by slope, reference trajectories, Casimirs,
//! singularities, lanes, and the same states on any grid.

use crate::systems;

use crate::systems::{
    BodyWithCirculation, Bracketed, CanonicalPendulum, CotangentBody, CotangentEulerArnold,
    Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, LotkaVolterra, ManakovTop,
    NonpolynomialSpin, Pendulum, Satellite, Sl2Quadratic, Su3Quadratic, TodaLattice, distance,
    relative_distance, se3_heavy_top,
};
use crate::vectors::Reference;
use lie_runtime::generic::PowerSeries;
use lie_runtime::methods::{FactorSink, Method, Retraction, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::{Expand, GradientRecurrence, GradientSeries, Recurrence, Series, Unknown};

/// Orders that are compared.
const ORDERS: usize = 16;

/// Coefficients of field and gradient along a solution, those of each order divided by the largest of the order.
fn coefficients<R, V: State<f64>>(
    mut recurrence: R,
    start: &V,
    gradient: impl Fn(&R) -> Option<V>,
) -> Vec<Vec<f64>>
where
    R: Recurrence<f64, State = V>,
{
    let (mut row, mut field) = (start.clone(), start.clone());
    let mut rows = Vec::new();
    let mut carry = recurrence.begin(&row, &mut field);
    for k in 1..=ORDERS {
        let mut all = field.as_slice().to_vec();
        all.extend(gradient(&recurrence).iter().flat_map(|g| g.as_slice()));
        rows.push(all);
        for (row, field) in row.as_mut_slice().iter_mut().zip(field.as_slice()) {
            *row = field / k as f64;
        }
        carry = recurrence.advance(k, carry, &row, &mut field);
    }
    rows
}

/// The largest difference of two lists of coefficients, relative to the largest of each order.
fn difference(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let rows = one.iter().zip(other);
    let of_row = |(one, other): (&Vec<f64>, &Vec<f64>)| {
        let pairs = one.iter().zip(other);
        let largest = pairs
            .clone()
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        largest
            / one
                .iter()
                .map(|a| a.abs())
                .fold(f64::MIN_POSITIVE, f64::max)
    };
    rows.map(of_row).fold(0.0, f64::max)
}

/// Rounding errors of an order enter the next ones, which the sums make larger.
const ROUND_OFF: f64 = 1e-13;

fn compare<P: Series<f64> + Expand<f64>>(system: &P, start: &P::State) {
    let written = coefficients(system.series(), start, |_| None);
    let plain = coefficients(PowerSeries::new(system), start, |_| None);
    let found = difference(&written, &plain);
    println!("{}: {found:.1e}", system.name());
    assert!(found < ROUND_OFF, "{}: {found:e}", system.name());
    // the bound is no formality
    let mut moved = start.clone();
    moved.as_mut_slice()[0] += 1e-9;
    let elsewhere = coefficients(system.series(), &moved, |_| None);
    assert!(difference(&elsewhere, &plain) > ROUND_OFF);
}

fn compare_with_gradient<P: GradientSeries<f64> + Expand<f64>>(system: &P, start: &P::State) {
    let written = coefficients(system.gradient_series(), start, |r| {
        Some(r.gradient().clone())
    });
    let plain = coefficients(PowerSeries::new(system), start, |r| {
        Some(r.gradient().clone())
    });
    let found = difference(&written, &plain);
    assert!(found < ROUND_OFF, "{}: {found:e}", system.name());
}

#[test]
fn written_recurrences_are_those_of_power_series() {
    macro_rules! check {
        ($file:ident, $system:ident, $cayley:ident) => {
            compare(&$system::declared::<f64>(), &$system::initial());
            compare_with_gradient(&$system::declared::<f64>(), &$system::initial());
        };
    }
    each_system!(check);
    check!(so3_cotangent_group, CotangentBody, exp);
    check!(so3_gravity_gradient, Satellite, exp);
    macro_rules! check_bracket {
        ($file:ident, $system:ident) => {
            compare(&$system::declared::<f64>(), &$system::initial());
        };
    }
    each_bracket!(check_bracket);
}

lie_poisson! {
    /// Every operation and every function.
    pub system Functions;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { a = 1.3; b = 0.4; }
    hamiltonian = exp(b*x*y) + log(2 + x^2) + sin(a*z)*cos(x - y) + tan(y/3) + asin(x/4) - acos(z/5) + atan(x + y*z)
        + sinh(x/2)*cosh(z) + tanh(y - z) + atan2(3 + x, 1 - y*z) + atan2(z, a) + sqrt(3 + x*z) + (2 + y)^(7/5)
        + (1 + z^2)^-2 + 1/(2 + x + b*y) + x/(3 + z) + (4 + x)^(-2/3)/a + x^3*y^2 + sqrt(2 + z)*(x^2 + y)^3
        + cbrt(2 + x*y) + cbrt(z - 3) + log1p(x*z) + expm1(b*y + z) + asinh(x + a*y) + acosh(3 + y*z) + atanh(x*y/2) + hypot(1 + x, z);
    methods = [taylor, lie-taylor];
}

lie_poisson! {
    /// A gradient with entries that vanish and one that is constant.
    pub system Flow;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = 2*z;
    casimir C = x^2 + y^2 + z^2;
    methods = [taylor, lie-taylor];
}

#[test]
fn every_function_has_its_rule() {
    let system = Functions::new().system().expect("sound");
    for start in [[0.4, -0.3, 0.5], [-0.2, 0.7, 0.1], [0.9, 0.2, -0.6]] {
        compare(&system, &start.into());
        compare_with_gradient(&system, &start.into());
    }
    let linear = Flow::new().system().expect("sound");
    compare_with_gradient(&linear, &[0.4, -0.3, 0.5].into());
}

/// The state after steps of a grid.
fn run<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    mut mu: P::State,
    h: S,
    steps: u32,
) -> P::State {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("the step is made");
    }
    mu
}

/// The order as a slope of errors at a time of the reference values.
fn order<D: Declared>(
    method: &impl Method<f64, D::System<f64>>,
    until: &str,
    steps: &[u32],
) -> f64 {
    let reference = Reference::vector(D::FILE);
    let row = reference.times().iter().position(|&time| time == until);
    let end = &reference.states()[row.expect("a time of the file")];
    let until: f64 = until.parse().expect("a number");
    let point = |&steps: &u32| {
        let h = until / f64::from(steps);
        let mu = run(&D::declared::<f64>(), method, D::initial(), h, steps);
        (h.ln(), distance(mu.as_slice(), end).ln())
    };
    let clear = |p: &(f64, f64)| (2e-13_f64.ln()..1e-3_f64.ln()).contains(&p.1);
    let points: Vec<(f64, f64)> = steps.iter().map(point).filter(clear).collect();
    assert!(points.len() >= 3, "{points:?}");
    let mean =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let products: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    products / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn fixed_orders_are_slopes() {
    for p in [2, 3, 5, 8] {
        let claimed = f64::from(p);
        let (steps, tops): (&[u32], &[u32]) = match p {
            2 | 3 => (&[400, 600, 800], &[1000, 1500, 2000]),
            5 => (&[60, 80, 100, 120], &[200, 240, 280]),
            _ => (&[16, 20, 24, 30, 36, 44], &[60, 70, 80, 95, 110, 130]),
        };
        for slope in [
            order::<NonpolynomialSpin>(&Taylor::of_order(p), "2", steps),
            order::<HeavyTop>(&Taylor::of_order(p), "10", tops),
            order::<NonpolynomialSpin>(&LieTaylor::of_order(p), "2", steps),
            order::<HeavyTop>(&LieTaylor::of_order(p), "10", tops),
        ] {
            // the next order may still show at large steps; one less may not
            assert!(
                slope > claimed - 0.2 && slope < claimed + 1.2,
                "{p}: {slope}"
            );
        }
    }
}

/// The error at the last time of the reference values, where it is at most 10.
fn error<D: Declared>(method: &impl Method<f64, D::System<f64>>) -> f64 {
    let reference = Reference::vector(D::FILE);
    let time = |text: &str| text.parse::<f64>().unwrap_or(0.0); // 1/10 and 1/2 come early
    let times: Vec<f64> = reference.times().into_iter().map(time).collect();
    let row = times
        .iter()
        .rposition(|&time| time <= 10.0)
        .expect("a time");
    let mu = run(&D::declared::<f64>(), method, D::initial(), times[row], 1);
    relative_distance(mu.as_slice(), &reference.states()[row])
}

#[test]
fn reference_trajectories_are_met() {
    macro_rules! check {
        ($file:ident, $system:ident, $cayley:ident) => {
            let exact = [
                error::<$system>(&Taylor::default()),
                error::<$system>(&LieTaylor::default()),
            ];
            let loose = [
                error::<$system>(&Taylor::with_tolerance(1e-5)),
                error::<$system>(&LieTaylor::with_tolerance(1e-5)),
            ];
            println!("{}: {exact:.1?}, at 1e-5 {loose:.1?}", stringify!($file));
            assert!(
                exact.iter().all(|e| *e < 3e-13),
                "{}: {exact:?}",
                stringify!($file)
            );
            assert!(
                loose.iter().all(|e| *e < 1e-2),
                "{}: {loose:?}",
                stringify!($file)
            );
        };
    }
    each_system!(check);
    // the tolerance decides
    assert!(error::<HeavyTop>(&Taylor::with_tolerance(1e-5)) > 1e-9);
    assert!(error::<HeavyTop>(&LieTaylor::with_tolerance(1e-5)) > 1e-9);
}

/// The largest drift of the Casimirs relative to their size at the start over steps of a grid.
fn drift<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, start: &P::State) -> f64 {
    let values = |mu: &P::State| {
        let mut out = vec![0.0; system.casimir_count()];
        system.casimirs(mu, &mut out);
        out
    };
    let first = values(start);
    let mut mu = start.clone();
    let mut stepper = method.stepper(system, 0.7, &NewtonOptions::default());
    let mut largest = 0.0_f64;
    for _ in 0..300 {
        stepper.step(&mut mu, &mut ()).expect("the step is made");
        for (value, first) in values(&mu).iter().zip(&first) {
            largest = largest.max((value - first).abs() / (first.abs() + 1e-2));
        }
    }
    largest
}

#[test]
fn lie_taylor_keeps_casimirs_at_any_tolerance() {
    macro_rules! check {
        ($system:ident) => {
            let (system, start) = ($system::declared::<f64>(), $system::initial());
            let kept = drift(&system, &LieTaylor::with_tolerance(1e-4), &start);
            let control = drift(&system, &Taylor::with_tolerance(1e-4), &start);
            println!("{}: {kept:.1e}, control {control:.1e}", $system::FILE);
            assert!(kept < 3e-12, "{}: {kept:e}", $system::FILE);
            assert!(control > 1e-6, "{}: {control:e}", $system::FILE);
        };
    }
    // one Casimir of su(3) is cubic
    check!(Su3Quadratic);
    check!(HeavyTop);
    check!(NonpolynomialSpin);
    check!(ManakovTop);
}

/// A grid finer than the steps of the method, a coarse one, and one step give the same states; there and back is at home.
#[test]
fn states_do_not_depend_on_the_grid() {
    fn check<M>(method: M)
    where
        M: Method<f64, se3_heavy_top::HeavyTopSystem>,
    {
        let (system, start) = (HeavyTop::declared::<f64>(), HeavyTop::initial());
        let fine = run(&system, &method, start, 0.01, 500);
        let coarse = run(&system, &method, start, 5.0, 1);
        assert!(distance(fine.as_slice(), coarse.as_slice()) < 1e-13);
        let back = run(&system, &method, coarse, -0.5, 10);
        assert!(distance(back.as_slice(), start.as_slice()) < 1e-13);
        // on a fine grid most steps need no series of their own
        let mut stepper = method.stepper(&system, 0.01, &NewtonOptions::default());
        let mut mu = start;
        let series: u32 = (0..500)
            .map(|_| stepper.step(&mut mu, &mut ()).expect("a step").substeps)
            .sum();
        assert!((3..100).contains(&series), "{series}");
    }
    check(Taylor::default());
    check(LieTaylor::default());
}

/// The factors of lie-taylor move the state.
#[test]
fn factors_are_those_of_the_state() {
    struct Factors(Vec<Vec<f64>>);
    impl<V: State<f64>> FactorSink<V> for Factors {
        fn push(&mut self, retraction: Retraction, xi: &V) {
            assert_eq!(retraction, Retraction::Exp);
            self.0.push(xi.as_slice().to_vec());
        }
    }
    let system = HeavyTop::declared::<f64>();
    let method = LieTaylor::default();
    let mut stepper = method.stepper(&system, 0.13, &NewtonOptions::default());
    let mut mu = HeavyTop::initial();
    let mut followed = mu;
    for _ in 0..40 {
        let mut factors = Factors(Vec::new());
        stepper.step(&mut mu, &mut factors).expect("a step");
        for xi in factors.0 {
            let (xi, before) = (systems::state(&system, &xi), followed);
            lie_runtime::generic::coadjoint_action(&system, &xi, &before, &mut followed);
        }
        assert!(distance(followed.as_slice(), mu.as_slice()) < 1e-13);
    }
}

lie_poisson! {
    /// `y' = y^2`: y reaches infinity at `t = 1/y`.
    pub system Explosion;
    algebra { basis a, b; [a, b] = b; }
    state x, y;
    hamiltonian = x*y;
    methods = [taylor, lie-taylor];
}

lie_poisson! {
    /// H is not finite at x = 0, which solutions reach.
    pub system Edge;
    algebra { basis a, b; [a, b] = b; }
    state x, y;
    hamiltonian = sqrt(y) + x;
    methods = [taylor, lie-taylor];
}

#[test]
fn singularities_stop_a_run() {
    fn check(method: impl Method<f64, ExplosionSystem>) {
        let system = Explosion::new().system().expect("sound");
        let mut mu = systems::state(&system, &[0.1, 1.0]);
        let before = mu;
        let mut stepper = method.stepper(&system, 2.0, &NewtonOptions::default());
        let failure = stepper
            .step(&mut mu, &mut ())
            .expect_err("y is infinite at 1");
        let clear = [FailureReason::StepTooSmall, FailureReason::NotFinite];
        assert!(clear.contains(&failure.reason), "{failure:?}");
        assert_eq!(mu, before, "the state is as it was");
        // before the singularity all is well
        let near = run(&system, &method, before, 0.5, 1);
        assert!((near.as_slice()[1] - 2.0).abs() < 1e-13);
    }
    check(Taylor::default());
    check(LieTaylor::default());
    let system = Edge::new().system().expect("sound");
    let mut mu = systems::state(&system, &[0.1, 0.0]);
    let method = Taylor::default();
    let mut stepper = method.stepper(&system, 1.0, &NewtonOptions::default());
    let failure = stepper
        .step(&mut mu, &mut ())
        .expect_err("the gradient is infinite");
    assert_eq!(failure.reason, FailureReason::NotFinite);
}

/// Lanes at different paces have the digits of the scalar runs.
#[test]
fn lanes_have_the_digits_of_scalar_runs() {
    fn check<D: Declared, M>(method: M)
    where
        M: Method<f64, D::System<f64>> + Method<F64x8, D::System<F64x8>>,
    {
        let (one, many) = (D::declared::<f64>(), D::declared::<F64x8>());
        let scale = |lane: usize| 0.3 + 0.17 * lane as f64;
        let starts: Vec<_> = (0..8)
            .map(|lane| {
                let mut mu = D::initial::<f64>();
                mu.as_mut_slice().iter_mut().for_each(|x| *x *= scale(lane));
                mu
            })
            .collect();
        let mut together = many.zero_state();
        for (i, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(core::array::from_fn(|lane| starts[lane].as_slice()[i]));
        }
        let h = |lane: usize| 0.11 * (lane as f64 - 2.5);
        let step = F64x8::new(core::array::from_fn(h));
        let together = run(&many, &method, together, step, 7);
        for (lane, start) in starts.into_iter().enumerate() {
            let alone = run(&one, &method, start, h(lane), 7);
            for (many, one) in together.as_slice().iter().zip(alone.as_slice()) {
                assert_eq!(many.lane(lane).to_bits(), one.to_bits(), "lane {lane}");
            }
        }
    }
    check::<HeavyTop, _>(Taylor::default());
    check::<HeavyTop, _>(LieTaylor::default());
    check::<NonpolynomialSpin, _>(Taylor::with_tolerance(1e-6));
    check::<NonpolynomialSpin, _>(LieTaylor::with_tolerance(1e-6));
}

/// A lane that fails leaves the others as they are.
#[test]
fn a_lane_fails_alone() {
    let many = Explosion::<F64x8>::default().system().expect("sound");
    let one = Explosion::new().system().expect("sound");
    let slow = |lane: usize| 0.1 + 0.2 * lane as f64;
    let start = [F64x8::splat(0.1), F64x8::new(core::array::from_fn(slow))];
    let mut mu = nalgebra::SVector::from(start);
    let mut stepper =
        Taylor::default().stepper(&many, F64x8::splat(1.0), &NewtonOptions::default());
    let failure = stepper
        .step(&mut mu, &mut ())
        .expect_err("some lanes explode");
    // those with y > 1
    assert_eq!(failure.lanes, 0b1110_0000);
    for lane in 0..8 {
        let scalar = nalgebra::SVector::from([0.1, slow(lane)]);
        let expected = match lane < 5 {
            true => run(&one, &Taylor::default(), scalar, 1.0, 1),
            false => scalar,
        };
        assert_eq!(mu[1].lane(lane).to_bits(), expected[1].to_bits(), "{lane}");
    }
    assert!(Unknown::<F64x8>::finite(&mu).all());
}
