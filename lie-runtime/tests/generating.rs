//! Generating-function methods on systems written by hand: order by slope, structure by the tangent
//! map, and controls whose function is wrong in one coefficient.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::{self, ExpRetraction, SecondKind};
use lie_runtime::methods::{FactorSink, Facts, ImplicitStepper, Method, Retraction};
use lie_runtime::prelude::*;
use lie_runtime::{Equation, GeneratingFunction, Implicit, Unknown};
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::{distance, state, steps};

/// The state of the non-polynomial system at t = 1 from [`SPIN`].
const NONPOLYNOMIAL: [f64; 3] = [0.18714184953656818, 0.09258594649146742, 1.0278160198519537];
/// The state of the heavy top at t = 1.
const TOP: [f64; 6] = [
    0.702124293102685,
    -0.19397034937192864,
    0.8493552060006306,
    0.6478081064813676,
    0.2690475836433316,
    0.712711761452489,
];
const SPIN: [f64; 3] = [0.6, -0.5, 0.7];

/// The slope over numbers of steps in the unit of time, and the errors.
fn slope<T, P>(
    system: &P,
    start: &[f64],
    end: &[f64],
    counts: &[u32],
    stepper: impl Fn(f64) -> T,
) -> (f64, Vec<(f64, f64)>)
where
    P: Poisson<f64>,
    T: Stepper<f64, State = P::State>,
{
    let end = state(system, end);
    let points: Vec<(f64, f64)> = (counts.iter())
        .map(|&count| {
            let mut mu = state(system, start);
            let h = 1.0 / f64::from(count);
            let mut stepper = stepper(h);
            for _ in 0..count {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
            (h, distance(&mu, &end))
        })
        .collect();
    let order = order_of_convergence(&points, 3e-14).expect("enough points above round-off");
    (order.slope, points)
}

fn check<M>(method: M, counts: &[u32])
where
    M: Method<f64, Nonpolynomial> + Method<f64, HeavyTop> + Facts,
{
    let newton = NewtonOptions::default();
    let top = HeavyTop::default();
    let slopes = [
        slope(&Nonpolynomial, &SPIN, &NONPOLYNOMIAL, counts, |h| {
            method.stepper(&Nonpolynomial, h, &newton)
        }),
        slope(&top, &START, &TOP, counts, |h| {
            method.stepper(&top, h, &newton)
        }),
    ];
    for (slope, points) in slopes {
        assert!(
            (slope - f64::from(M::ORDER)).abs() < 0.1,
            "{}: {slope} of {points:?}",
            M::ID
        );
    }
}

#[test]
fn measured_orders_are_the_declared_ones() {
    const COUNTS: [u32; 5] = [16, 24, 32, 48, 64];
    check(Generating2::exp(), &COUNTS);
    check(Generating2::cayley(), &COUNTS);
    check(Generating4::exp(), &COUNTS);
    check(Generating4::cayley(), &COUNTS);
    check(GeneratingSecondKind2, &COUNTS);
    // larger steps are not asymptotic yet for order 6, smaller ones end in round-off
    check(Generating6::exp(), &[12, 16, 20, 24, 28, 32]);
}

/// `h H` and a multiple of the rest of a generating function.
struct Scaled<G, H> {
    all: G,
    first: H,
    factor: f64,
}

impl<G, H> GeneratingFunction<f64> for Scaled<G, H>
where
    G: GeneratingFunction<f64>,
    H: GeneratingFunction<f64, State = G::State, Jacobian = G::Jacobian>,
    G::Jacobian: Clone,
{
    type State = G::State;
    type Jacobian = G::Jacobian;
    fn gradient(&mut self, p: &G::State, xi: &mut G::State) {
        let mut first = xi.clone();
        self.first.gradient(p, &mut first);
        self.all.gradient(p, xi);
        for (entry, first) in xi.as_mut_slice().iter_mut().zip(first.as_slice()) {
            *entry = first + self.factor * (*entry - first);
        }
    }
    fn linearize(&mut self, p: &G::State, xi: &mut G::State, hessian: &mut G::Jacobian) {
        let mut first = hessian.clone();
        self.first.linearize(p, xi, &mut first);
        self.all.linearize(p, xi, hessian);
        self.gradient(p, xi);
        for row in 0..hessian.dimension() {
            for column in 0..hessian.dimension() {
                let entry = first.get(row, column);
                let rest = hessian.get(row, column) - entry;
                hessian.set(row, column, entry + self.factor * rest);
            }
        }
    }
}

#[test]
fn a_wrong_coefficient_loses_the_order() {
    let newton = NewtonOptions::default();
    let system = &Nonpolynomial;
    let exp = |factor: f64| {
        let counts = [16, 24, 32, 48, 64];
        slope(system, &SPIN, &NONPOLYNOMIAL, &counts, |h| {
            let all = generic::Generating4::new(system, h);
            let first = generic::Generating2::new(system, h);
            let function = Scaled { all, first, factor };
            let equation = ExpRetraction::with_function(system, function, h);
            ImplicitStepper::new(equation, state(system, &SPIN), &newton)
        })
        .0
    };
    assert!((exp(1.0) - 4.0).abs() < 0.1, "{}", exp(1.0));
    // 1/25 in the place of 1/24
    assert!(exp(0.96) < 3.5, "{}", exp(0.96));
    let second = |factor: f64| {
        let counts = [16, 24, 32, 48, 64, 96, 128];
        slope(system, &SPIN, &NONPOLYNOMIAL, &counts, |h| {
            let all = generic::SecondKind2::new(system, h);
            let first = generic::Generating2::new(system, h);
            let function = Scaled { all, first, factor };
            let equation = SecondKind::with_function(system, function, h);
            ImplicitStepper::new(equation, state(system, &SPIN), &newton)
        })
        .0
    };
    assert!((second(1.0) - 2.0).abs() < 0.1, "{}", second(1.0));
    assert!((second(0.0) - 1.0).abs() < 0.2, "{}", second(0.0));
    assert!(second(-1.0) < 1.5, "{}", second(-1.0));
}

#[test]
fn poisson_maps_by_their_tangent() {
    fn defects<M>(method: M, h: f64) -> [f64; 2]
    where
        M: Method<Dual<f64>, HeavyTop<Dual<f64>>> + Method<Dual<f64>, Nonpolynomial>,
    {
        let (top, newton) = (HeavyTop::default(), NewtonOptions::default());
        [
            poisson_defect(&top, &method, h, &START, &newton).expect("the step converges"),
            poisson_defect(&Nonpolynomial, &method, h, &SPIN, &newton).expect("the step converges"),
        ]
    }
    for h in [0.1, -0.2] {
        let all = [
            defects(Generating2::exp(), h),
            defects(Generating2::cayley(), h),
            defects(Generating4::exp(), h),
            defects(Generating4::cayley(), h),
            defects(Generating6::exp(), h),
            defects(GeneratingSecondKind2, h),
        ];
        assert!(all.concat().iter().all(|d| *d < 5e-15), "h = {h}: {all:?}");
        let control = defects(ImplicitMidpoint, h);
        assert!(control.iter().all(|d| *d > 1e-7), "h = {h}: {control:?}");
    }
}

#[test]
fn symmetric_methods_undo_themselves() {
    fn there_and_back<M: Method<f64, Nonpolynomial>>(method: &M) -> f64 {
        let start = state(&Nonpolynomial, &SPIN);
        let mut mu = start;
        steps(&Nonpolynomial, method, 0.1, 1, &mut mu).expect("the step converges");
        steps(&Nonpolynomial, method, -0.1, 1, &mut mu).expect("the step converges");
        let distance = distance(&mu, &start);
        assert_eq!(distance < 1e-15, M::SYMMETRIC, "{}: {distance:e}", M::ID);
        distance
    }
    there_and_back(&Generating2::cayley());
    there_and_back(&Generating4::exp());
    there_and_back(&Generating4::cayley());
    there_and_back(&Generating6::exp());
    assert!(there_and_back(&GeneratingSecondKind2) > 1e-7);
}

#[test]
fn order_two_is_the_midpoint_method() {
    let system = HeavyTop::<f64>::default();
    let step = |advance: &dyn Fn(&mut nalgebra::SVector<f64, 6>)| {
        let mut mu = state(&system, &START);
        advance(&mut mu);
        mu
    };
    let first = step(&|mu| steps(&system, &Generating2::exp(), 0.1, 3, mu).expect("a step"));
    let second = step(&|mu| steps(&system, &LieMidpoint::exp(), 0.1, 3, mu).expect("a step"));
    assert_eq!(first, second);
    let first = step(&|mu| steps(&system, &Generating2::cayley(), 0.1, 3, mu).expect("a step"));
    let second = step(&|mu| steps(&system, &LieMidpoint::cayley(), 0.1, 3, mu).expect("a step"));
    assert_eq!(first, second);
}

/// Applies the factor to the state before the step.
struct Replay {
    system: Nonpolynomial,
    mu: nalgebra::SVector<f64, 3>,
}

impl FactorSink<nalgebra::SVector<f64, 3>> for Replay {
    fn push(&mut self, retraction: Retraction, xi: &nalgebra::SVector<f64, 3>) {
        let mut act = |xi: [f64; 3]| {
            let before = self.mu;
            generic::coadjoint_action(&self.system, &xi.into(), &before, &mut self.mu);
        };
        match retraction {
            Retraction::Exp => act((*xi).into()),
            Retraction::Cayley => {
                // a rotation by 2 atan(|xi|/2) about xi
                let size = xi.norm();
                act((xi * (2.0 * (size / 2.0).atan() / size)).into());
            }
            Retraction::SecondKind => {
                act([xi[0], 0.0, 0.0]);
                act([0.0, xi[1], 0.0]);
                act([0.0, 0.0, xi[2]]);
            }
            Retraction::Declared => panic!("no retraction is declared"),
        }
    }
}

#[test]
fn group_factors_move_the_state() {
    fn error<M: Method<f64, Nonpolynomial>>(method: M) -> f64 {
        let mut mu = state(&Nonpolynomial, &SPIN);
        let mut replay = Replay {
            system: Nonpolynomial,
            mu,
        };
        let mut stepper = method.stepper(&Nonpolynomial, 0.1, &NewtonOptions::default());
        for _ in 0..5 {
            stepper.step(&mut mu, &mut replay).expect("a step");
        }
        assert!(mu.max_norm() > 0.5);
        distance(&mu, &replay.mu)
    }
    let errors = [
        error(Generating4::exp()),
        error(Generating4::cayley()),
        error(Generating6::exp()),
        error(GeneratingSecondKind2),
    ];
    assert!(errors.iter().all(|error| *error < 2e-15), "{errors:?}");
}

/// The Jacobian of a step's equation against the derivative of its residual by dual numbers, beside the solution.
fn jacobian_error<P, M>(system: &P, method: &M, start: &[f64]) -> f64
where
    P: Implicit<f64, M> + Lift<f64>,
    P::Lifted: Implicit<Dual<f64>, M>,
{
    let h = 0.2;
    let dual = system.lift();
    let mut equation = system.equation(method, h);
    let mut lifted = dual.equation(method, Dual::constant_of(h));
    equation.set_base(&state(system, start));
    lifted.set_base(&state(&dual, start));
    let mut unknown = equation.zero_unknown();
    equation.initial_guess(&mut unknown);
    let mut matrix = equation.zero_matrix();
    let mut residual = equation.zero_unknown();
    equation.linearize(&unknown, &mut residual, &mut matrix);
    let mut error: f64 = 0.0;
    for column in 0..unknown.len() {
        let mut seeded = lifted.zero_unknown();
        for index in 0..unknown.len() {
            let seed = if index == column { 1.0 } else { 0.0 };
            seeded.set_entry(index, Dual::new(unknown.entry(index), seed));
        }
        let mut out = lifted.zero_unknown();
        lifted.residual(&seeded, &mut out);
        for row in 0..unknown.len() {
            let entry = out.entry(row);
            error = f64::max(error, (entry.value - residual.entry(row)).abs());
            let slope = entry.derivative - matrix.get(row, column);
            error = f64::max(error, slope.abs());
        }
    }
    error
}

#[test]
fn jacobians_are_derivatives() {
    let top = HeavyTop::default();
    macro_rules! check {
        ($method:expr) => {
            for error in [
                jacobian_error(&Nonpolynomial, &$method, &SPIN),
                jacobian_error(&top, &$method, &START),
            ] {
                assert!(error < 1e-14, "{}: {error:e}", stringify!($method));
            }
        };
    }
    check!(GeneratingSecondKind2);
    check!(Generating2::exp());
    check!(Generating4::exp());
    check!(Generating4::cayley());
}
