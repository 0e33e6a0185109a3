//! Collective methods with their stages evaluated together: over the Hopf map, quaternions, factors of Hermitian matrices and columns
//! of a representation.

use crate::systems::daily;
use lie_runtime::ColumnPoisson;
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::generic::{
    LinearLift, MatrixStages, QuaternionStages, StageMomenta, StageParallel,
};
use lie_runtime::methods::{
    Collective4, Collective6, Facts, Hopf, ImplicitStepper, ParallelCollective, Quaternion,
    Representation, StageLift, StepFailure, Unitary,
};
use lie_runtime::newton::{FailureReason, Iteration};
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body whose moments remove a term by the gauge, in a basis with c = 2, and a term that is no polynomial.
    system Body;
    algebra { basis a, b, c; [a, b] = 2*c; [b, c] = 2*a; [c, a] = 2*b; }
    state x, y, z;
    parameters { I1 = 4; I2 = 2; I3 = 4/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3) + sqrt(4 + z^4)/8;
    casimir C = x^2 + y^2 + z^2;
    methods = [collective16];
}
lie_poisson! {
    /// Two coupled spins in crossed order, without code of its own.
    system Pair;
    algebra { basis a, d, b, e, c, f;
        [a, b] = c; [b, c] = a; [c, a] = b; [d, e] = -3*f; [e, f] = -3*d; [f, d] = -3*e; }
    state x, u, y, v, z, w;
    hamiltonian = x*u + y*v/2 + z*w/3 + x^2/5 + v^2/7 + exp(w/3);
}
lie_poisson! {
    /// A heavy top.
    system Top;
    algebra {
        basis J1, J2, J3, P1, P2, P3;
        [J1, J2] = J3; [J2, J3] = J1; [J3, J1] = J2;
        [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = P2;
        [J2, P1] = -P3; [J3, P2] = -P1; [J1, P3] = -P2;
        matrix J1 = [[0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 0]];
        matrix J2 = [[0, 0, 1, 0], [0, 0, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 0]];
        matrix J3 = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]];
        matrix P1 = [[0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]];
        matrix P2 = [[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0]];
        matrix P3 = [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]];
    }
    state m1, m2, m3, g1, g2, g3;
    parameters { I1 = 1; I2 = 3/2; I3 = 11/5; }
    hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + g1/5 + g2/10 + 97*g3/100 + cos(g1)*m2/9;
    casimir length2 = g1^2 + g2^2 + g3^2;
    casimir vertical = m1*g1 + m2*g2 + m3*g3;
    methods = [collective16, isospectral16];
}
lie_poisson! {
    /// The same top with a second vector along, the vectors in another order and scaled, and c = -1.
    system Vectors;
    algebra {
        basis Q3, J1, P1, Q1, J2, P2, J3, Q2, P3;
        [J1, J2] = -J3; [J2, J3] = -J1; [J3, J1] = -J2;
        [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = -P2;
        [J2, P1] = -P3; [J3, P2] = P1; [J1, P3] = -P2;
        [J1, Q2] = -Q3/2; [J2, Q3] = -2*Q1; [J3, Q1] = -Q2;
        [J2, Q1] = Q3/2; [J3, Q2] = Q1; [J1, Q3] = 2*Q2;
    }
    state n3, m1, g1, n1, m2, g2, m3, n2, g3;
    hamiltonian = m1^2/2 + m2^2/3 + m3^2/5 + g1/5 - g2/3 + g3 + n1*g1/4 + n3^2/8 + exp(n2/3);
}
lie_poisson! {
    /// The heavy top with a vector that nothing depends on.
    system Beside;
    algebra {
        basis J1, J2, J3, P1, P2, P3, Q1, Q2, Q3;
        [J1, J2] = J3; [J2, J3] = J1; [J3, J1] = J2;
        [J1, P2] = P3; [J2, P3] = P1; [J3, P1] = P2;
        [J2, P1] = -P3; [J3, P2] = -P1; [J1, P3] = -P2;
        [J1, Q2] = Q3; [J2, Q3] = Q1; [J3, Q1] = Q2;
        [J2, Q1] = -Q3; [J3, Q2] = -Q1; [J1, Q3] = -Q2;
    }
    state m1, m2, m3, g1, g2, g3, n1, n2, n3;
    parameters { I1 = 1; I2 = 3/2; I3 = 11/5; }
    hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + g1/5 + g2/10 + 97*g3/100 + cos(g1)*m2/9;
    methods = [collective16];
}
lie_poisson! {
    /// On u(3), where the trace is a Casimir of its own, with a term that is no polynomial; the gauge removes one.
    system Threefold;
    algebra = u(3);
    state x1, x2, x3, x4, x5, x6, x7, x8, x9;
    hamiltonian = x1^2/4 + x2^2/6 + x3*x5/4 + x3^2/4 + x4^2/4 + x6^2/7 + x7^2/6 + x8*x9/5 + x7*x1/6 + exp(x9/4)/3;
    methods = [collective16];
}
lie_poisson! {
    /// On su(2), which is so(3).
    system Twofold;
    algebra = su(2);
    state x1, x2, x3;
    hamiltonian = x1^2/3 + x2^2/5 + x3^2/7 + exp(x1/3)/2;
}
lie_poisson! { spec = "../../specs/so4_manakov.json"; }
lie_poisson! { spec = "../../specs/su3_quadratic.json"; }
lie_poisson! { spec = "../../specs/sl2_quadratic.json"; }

const SU3: [f64; 8] = [0.3, -0.2, 0.4, 0.1, 0.5, -0.3, 0.2, 0.6];
const TOP: [f64; 6] = [0.3, -0.5, 1.2, 0.1, 0.2, 0.97];

fn state<P: Poisson<f64>>(system: &P, values: &[f64]) -> P::State {
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(values);
    mu
}

/// Some state without symmetry, of the size of 1.
fn some<P: Poisson<f64>>(system: &P) -> P::State {
    let values: Vec<f64> = (0..system.dimension())
        .map(|k| (1.0 + 2.3 * k as f64).sin() * 0.9)
        .collect();
    state(system, &values)
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// Makes steps.
fn run<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    mu: &mut P::State,
    h: f64,
    steps: usize,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(mu, &mut ()).expect("the step is solved");
    }
}

/// One step by Newton's iteration in the momenta of the stages.
macro_rules! reduced {
    ($system:expr, $mu:expr, $h:expr, $map:ty, $stages:literal) => {{
        let equation = StageMomenta::<f64, _, $map, $stages>::new($system, $h);
        let options = NewtonOptions::default();
        let mut stepper = ImplicitStepper::new(equation, $system.zero_state(), &options);
        stepper.step($mu, &mut ()).expect("the step is solved");
    }};
}

/// A step on points is that in the momenta, for every number of stages.
#[test]
fn a_step_is_that_in_the_momenta() {
    fn representation<P, const STAGES: usize>(system: &P, h: f64)
    where
        P: ColumnPoisson<f64> + Widen<f64>,
        P::Widened: ColumnPoisson<<f64 as Scalar>::Wide>,
    {
        let start = some(system);
        let mut expected = start.clone();
        let equation =
            StageMomenta::<f64, _, MatrixStages<f64, P::Matrix, STAGES>, STAGES>::new(system, h);
        let options = NewtonOptions::default();
        let mut stepper = ImplicitStepper::new(equation, system.zero_state(), &options);
        stepper
            .step(&mut expected, &mut ())
            .expect("the step is solved");
        let mut mu = start.clone();
        let method = ParallelCollective::<_, STAGES>::representation();
        run(system, &method, &mut mu, h, 1);
        let off = distance(mu.as_slice(), expected.as_slice());
        println!("{} {STAGES} stages: {off:e}", system.name());
        assert!(off < 4e-15, "{} {STAGES}: {off:e}", system.name());
        let moved = distance(mu.as_slice(), start.as_slice());
        assert!(moved > 1e-3, "it moves");
        run(system, &method, &mut mu, -h, 1);
        let off = distance(mu.as_slice(), start.as_slice());
        assert!(
            off < 8e-15,
            "{} {STAGES}: {off:e} there and back",
            system.name()
        );
    }
    let top = Top::new().system().expect("parameters");
    representation::<_, 2>(&top, 0.3);
    representation::<_, 3>(&top, 0.3);
    representation::<_, 5>(&top, 0.3);
    representation::<_, 8>(&top, 0.3);
    let body = ManakovTop::new().system().expect("parameters");
    representation::<_, 3>(&body, 0.2);
    representation::<_, 4>(&body, 0.2);
    representation::<_, 7>(&body, 0.2);
    let su3 = Su3Quadratic::new().system().expect("parameters");
    representation::<_, 2>(&su3, 0.2);
    representation::<_, 6>(&su3, 0.2);
    let sl2 = Sl2Quadratic::new().system().expect("parameters");
    representation::<_, 8>(&sl2, 0.2);

    let pair = Pair::new().system().expect("parameters");
    let start = some(&pair);
    for (sign, h) in [(1.0, 0.1), (-1.0, 0.1), (-1.0, -0.2)] {
        let mut expected = start;
        expected[4] *= sign;
        let mut mu = expected;
        reduced!(&pair, &mut expected, h, QuaternionStages<f64, 5>, 5);
        run(&pair, &Collective10::hopf(), &mut mu, h, 1);
        let off = distance(mu.as_slice(), expected.as_slice());
        assert!(off < 4e-15, "{sign} {h}: {off:e}");
    }
    // of low order it is the method that exists
    let (mut points, mut momenta) = (start, start);
    run(
        &pair,
        &ParallelCollective::<Hopf, 2>::hopf(),
        &mut points,
        0.1,
        20,
    );
    run(&pair, &Collective4::hopf(), &mut momenta, 0.1, 20);
    assert!(distance(points.as_slice(), momenta.as_slice()) < 4e-15);
    let start = state(&top, &TOP);
    let (mut points, mut momenta) = (start, start);
    run(
        &top,
        &ParallelCollective::<Representation, 3>::representation(),
        &mut points,
        0.1,
        20,
    );
    run(&top, &Collective6::representation(), &mut momenta, 0.1, 20);
    assert!(distance(points.as_slice(), momenta.as_slice()) < 8e-15);
}

/// A vector on which nothing depends changes nothing: with one vector points are chosen in one of two charts, with two q = 1.
#[test]
fn both_charts_of_quaternions_give_the_same_step() {
    let (top, beside) = (
        Top::new().system().expect("parameters"),
        Beside::new().system().expect("parameters"),
    );
    for vector in [
        [0.1, 0.2, 0.97],
        [0.6, -0.3, -0.5],
        [0.3, 0.4, 0.0],
        [1e-9, 2e-9, -1.5],
        [0.0, 0.0, -0.7],
        [0.0, 0.0, 0.7],
        [0.0, 0.0, 0.0],
        [1e-170, 0.0, -1e-170],
    ] {
        let mut one = state(&top, &[0.3, -0.5, 1.2, vector[0], vector[1], vector[2]]);
        let mut values = one.as_slice().to_vec();
        values.extend([0.3, 0.1, -0.2]);
        let mut two = state(&beside, &values);
        run(&top, &Collective16::quaternion(), &mut one, 0.5, 20);
        run(&beside, &Collective16::quaternion(), &mut two, 0.5, 20);
        let off = distance(one.as_slice(), &two.as_slice()[..6]);
        println!("{vector:?}: {off:e}");
        assert!(off < 1e-14, "{vector:?}: {off:e}");
    }
}

/// On C^2 factors are spinors. On orbits where eigenvalues coincide there are columns that are 0, and a state may be 0.
#[test]
fn factors_are_found_over_every_state() {
    let two = Twofold::new().system().expect("parameters");
    for start in [
        [0.3, -0.5, 1.2],
        [0.0, 0.0, -0.7],
        [1e-160, 0.0, 1e-170],
        [0.0; 3],
    ] {
        let (mut one, mut other) = (state(&two, &start), state(&two, &start));
        run(&two, &Collective16::hopf(), &mut one, 0.5, 20);
        run(&two, &Collective16::unitary(), &mut other, 0.5, 20);
        let off = distance(one.as_slice(), other.as_slice());
        println!("{start:?}: {off:e}");
        assert!(off < 1e-14, "{start:?}: {off:e}");
    }
    let three = Threefold::new().system().expect("parameters");
    let diagonal = |values: [f64; 3]| {
        let mut mu = vec![0.0; 9];
        mu[6..].copy_from_slice(&values);
        state(&three, &mu)
    };
    for (start, equal) in [
        (some(&three), false),
        (diagonal([0.5, 0.5, -0.8]), true),
        (diagonal([0.5, -0.8, 0.5]), true),
        (diagonal([0.5, 0.5 + 1e-16, -0.8]), true),
        (diagonal([0.5, 0.5, 0.9]), false),
        (diagonal([0.3, 0.3, 0.3]), true),
        (diagonal([0.0, 0.0, 0.0]), true),
        (diagonal([3e200, 1e200, -2e200]), false),
        (diagonal([3e-200, 1e-200, -2e-200]), false),
    ] {
        let mut labels = <Unitary as LinearLift<f64, _>>::zero_labels(&three);
        let mut point = <Unitary as LinearLift<f64, _>>::zero_point(&three);
        <Unitary as LinearLift<f64, _>>::lift(&three, &start, &mut labels, &mut point);
        let mut under = three.zero_state();
        <Unitary as LinearLift<f64, _>>::project(&three, &labels, &point, &mut under);
        let size = start
            .as_slice()
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let off = distance(under.as_slice(), start.as_slice());
        println!("{:?}: {off:e}", start.as_slice());
        assert!(off <= 2e-15 * size, "{off:e} of {size:e}");
        let last = point.as_slice()[3..6].iter().chain(&point.as_slice()[9..]);
        assert_eq!(
            last.clone().all(|x| *x == 0.0),
            equal,
            "{:?}",
            start.as_slice()
        );
    }
}

/// The order as the slope of errors against fine steps, and that the limit is the flow.
fn order<P: Poisson<f64>, M: Facts + Method<f64, P>>(
    system: &P,
    method: &M,
    start: &P::State,
    until: f64,
    steps: &[usize],
) where
    Gauss16: Method<f64, P>,
{
    let mut exact = start.clone();
    run(system, &Gauss16, &mut exact, until / 200.0, 200);
    let mut logs: Vec<(f64, f64)> = Vec::new();
    for &steps in steps {
        let mut mu = start.clone();
        run(system, method, &mut mu, until / steps as f64, steps);
        let error = distance(mu.as_slice(), exact.as_slice());
        println!("{} {} {steps}: {error:e}", system.name(), M::ID);
        if (3e-14..1e-4).contains(&error) {
            logs.push(((until / steps as f64).ln(), error.ln()));
        }
    }
    assert!(logs.len() >= 3, "{} {}", system.name(), M::ID);
    let count = logs.len() as f64;
    let (x, y) = (
        logs.iter().map(|p| p.0).sum::<f64>() / count,
        logs.iter().map(|p| p.1).sum::<f64>() / count,
    );
    let above: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let slope = above / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    let claimed = f64::from(M::ORDER);
    println!("{} {}: slope {slope:.2}", system.name(), M::ID);
    assert!(
        (slope - claimed).abs() < 0.2 * claimed,
        "{} {}: {slope}",
        system.name(),
        M::ID
    );
}

#[test]
fn orders_are_those_stated() {
    let top = Top::new().system().expect("parameters");
    let start = state(&top, &TOP);
    order(
        &top,
        &Collective8::quaternion(),
        &start,
        8.0,
        &[10, 12, 14, 17, 20, 24],
    );
    order(
        &top,
        &Collective12::quaternion(),
        &start,
        8.0,
        &[6, 7, 8, 9, 10, 12],
    );
    order(
        &top,
        &Collective16::quaternion(),
        &start,
        8.0,
        &[5, 6, 7, 8, 9],
    );
    order(
        &top,
        &Isospectral10::new(),
        &start,
        8.0,
        &[14, 17, 20, 24, 28],
    );
    order(
        &top,
        &Isospectral16::new(),
        &start,
        8.0,
        &[9, 10, 11, 12, 14, 16],
    );
    let vectors = Vectors::new().system().expect("parameters");
    let start = some(&vectors);
    order(
        &vectors,
        &Collective8::quaternion(),
        &start,
        4.0,
        &[6, 8, 10, 12, 14, 17, 20],
    );
    order(
        &vectors,
        &Collective14::smallest(),
        &start,
        4.0,
        &[4, 5, 6, 7, 8, 9],
    );
    let body = ManakovTop::new().system().expect("parameters");
    order(
        &body,
        &Collective8::representation(),
        &some(&body),
        3.0,
        &[8, 10, 12, 14, 17, 20],
    );
    let su3 = Su3Quadratic::new().system().expect("parameters");
    order(
        &su3,
        &Collective8::unitary(),
        &some(&su3),
        8.0,
        &[6, 8, 10, 12, 14, 17],
    );
    let three = Threefold::new().system().expect("parameters");
    order(
        &three,
        &Collective14::smallest(),
        &some(&three),
        4.0,
        &[4, 5, 6, 7, 8, 9],
    );
    let spin = Body::new().system().expect("parameters");
    let start = state(&spin, &[0.7, 0.4, 1.1]);
    order(
        &spin,
        &Collective10::hopf(),
        &start,
        8.0,
        &[8, 10, 12, 14, 17, 20],
    );
    order(
        &spin,
        &Collective14::hopf(),
        &start,
        8.0,
        &[5, 6, 7, 8, 9, 10, 12],
    );
}

/// The code that is written out agrees with the generic form: the same system with and without it.
#[test]
fn written_flows_are_the_generic_ones() {
    let top = Top::new().system().expect("parameters");
    fn check<L: LinearLift<f64, P>, P: LiePoisson<f64>>(
        system: &P,
        plain: impl Fn(&P, &L::Labels, &L::Point, &mut L::Point),
        gauge: bool,
    ) {
        let mu = some(system);
        let (mut labels, mut point) = (L::zero_labels(system), L::zero_point(system));
        L::lift(system, &mu, &mut labels, &mut point);
        for (k, entry) in point.as_mut_slice().iter_mut().enumerate() {
            *entry += 0.1 * (k as f64).cos();
        }
        let (mut one, mut other) = (point.clone(), point.clone());
        L::flow(system, &labels, &point, &mut one);
        plain(system, &labels, &point, &mut other);
        let same = distance(one.as_slice(), other.as_slice());
        assert_eq!(same > 1e-3, gauge, "{}: {same:e}", system.name());
        // over the same state they lead to the same one
        let mut rates = [system.zero_state(), system.zero_state()];
        for (flow, rate) in [one, other].iter().zip(&mut rates) {
            let epsilon = 1e-5;
            let (mut ahead, mut behind) = (system.zero_state(), system.zero_state());
            for (sign, out) in [(1.0, &mut ahead), (-1.0, &mut behind)] {
                let mut moved = point.clone();
                moved.axpy(sign * epsilon, flow);
                L::project(system, &labels, &moved, out);
            }
            rate.axpy(0.5 / epsilon, &ahead);
            rate.axpy(-0.5 / epsilon, &behind);
        }
        let mut field = system.zero_state();
        let mut under = system.zero_state();
        L::project(system, &labels, &point, &mut under);
        system.vector_field(&under, &mut field);
        for rate in &rates {
            let off = distance(rate.as_slice(), field.as_slice());
            assert!(off < 1e-9, "{}: {off:e}", system.name());
        }
    }
    use lie_runtime::generic::{
        flow_over_columns, flow_over_factors, flow_over_quaternions, flow_over_spins,
    };
    check::<Quaternion, _>(&top, flow_over_quaternions, false);
    check::<Representation, _>(&top, |s, _, p, out| flow_over_columns(s, p, out), false);
    let beside = Beside::new().system().expect("parameters");
    check::<Quaternion, _>(&beside, flow_over_quaternions, false);
    let body = Body::new().system().expect("parameters");
    check::<Hopf, _>(&body, |s, _, p, out| flow_over_spins(s, p, out), true);
    let vectors = Vectors::new().system().expect("parameters");
    check::<Quaternion, _>(&vectors, flow_over_quaternions, false);
    let three = Threefold::new().system().expect("parameters");
    check::<Unitary, _>(&three, flow_over_factors, true);
    let su3 = Su3Quadratic::new().system().expect("parameters");
    check::<Unitary, _>(&su3, flow_over_factors, false);
}

/// How far the executed steps of a walk are from symplectic maps of the points, with the start of each iteration frozen: for each
/// of some steps the largest entry of `D^T Omega D - Omega`.
fn frozen_defects<L, P, D>(system: &P, dual: &D, mu: &[f64], h: f64, options: &NewtonOptions) -> f64
where
    P: LiePoisson<f64> + Widen<f64>,
    P::Widened: LiePoisson<<f64 as Scalar>::Wide>,
    D: LiePoisson<Dual<f64>> + Widen<Dual<f64>>,
    D::Widened: LiePoisson<<Dual<f64> as Scalar>::Wide>,
    L: StageLift<f64, P> + StageLift<Dual<f64>, D>,
{
    type W = <f64 as Scalar>::Wide;
    type X = <Dual<f64> as Scalar>::Wide;
    let (wide, wide_dual) = (system.widen(), dual.widen());
    let mu = state(system, mu);
    let mut labels = <L as LinearLift<f64, P>>::zero_labels(system);
    let mut point = <L as LinearLift<f64, P>>::zero_point(system);
    <L as LinearLift<f64, P>>::lift(system, &mu, &mut labels, &mut point);
    let mut wide_labels = <L as LinearLift<W, P::Widened>>::zero_labels(&wide);
    let mut dual_labels = <L as LinearLift<X, D::Widened>>::zero_labels(&wide_dual);
    for (k, label) in labels.as_slice().iter().enumerate() {
        wide_labels.as_mut_slice()[k] = label.widen();
        dual_labels.as_mut_slice()[k] = Dual::constant_of(*label).widen();
    }
    let zero = <L as LinearLift<W, P::Widened>>::zero_point(&wide);
    let mut stages = StageParallel::<f64, _>::new(8, h, zero, options);
    let mut slope = point.clone();
    <L as LinearLift<f64, P>>::flow(system, &labels, &point, &mut slope);
    stages.start(true, point.as_slice(), slope.as_slice());
    let size = point.as_slice().len();
    let (half, mut worst) = (size / 2, 0.0_f64);
    for step in 0..24 {
        if step > 0 {
            stages.go_on();
        }
        let (base, increments) = stages.base_and_increments();
        let base: Vec<f64> = base
            .as_slice()
            .iter()
            .map(|y| f64::scatter(*y)[0])
            .collect();
        let start: Vec<[f64; 8]> = increments
            .as_slice()
            .iter()
            .map(|d| f64::scatter(*d))
            .collect();
        let solved = stages.iterate(|at, slopes| {
            <L as LinearLift<W, P::Widened>>::flow(&wide, &wide_labels, at.points, slopes);
        });
        assert!(solved.converged);
        if step % 6 == 5 {
            let exactly = NewtonOptions {
                tolerance: 0.0,
                max_iterations: solved.iterations,
                convergence: Convergence::State,
                iteration: Iteration::FixedPoint,
            };
            // by columns
            let mut derivative = vec![vec![0.0; size]; size];
            for (direction, column) in derivative.iter_mut().enumerate() {
                let zero = <L as LinearLift<X, D::Widened>>::zero_point(&wide_dual);
                let step = Dual::constant_of(h);
                let mut stages = StageParallel::<Dual<f64>, _>::new(8, step, zero, &exactly);
                stages.set_increments_where(true, |stage, k| Dual::constant_of(start[k][stage]));
                let mut end: Vec<Dual<f64>> = base
                    .iter()
                    .enumerate()
                    .map(|(k, &x)| Dual::new(x, f64::from(u8::from(k == direction))))
                    .collect();
                stages.set_base(true, &end);
                let solved = stages.iterate(|at, slopes| {
                    <L as LinearLift<X, D::Widened>>::flow(
                        &wide_dual,
                        &dual_labels,
                        at.points,
                        slopes,
                    );
                });
                assert!(solved.iterations <= exactly.max_iterations);
                stages.advance();
                stages.base_into(&mut end);
                for (entry, x) in column.iter_mut().zip(&end) {
                    *entry = x.derivative;
                }
            }
            for a in 0..size {
                for b in 0..size {
                    let pairs = (0..half).map(|k| {
                        derivative[a][k] * derivative[b][k + half]
                            - derivative[a][k + half] * derivative[b][k]
                    });
                    let expected =
                        f64::from(u8::from(b == a + half)) - f64::from(u8::from(a == b + half));
                    worst = worst.max((pairs.sum::<f64>() - expected).abs());
                }
            }
        }
        stages.advance();
        let (base, increments) = stages.base_and_increments();
        <L as LinearLift<W, P::Widened>>::settle(&wide, base, increments);
    }
    worst
}

/// The executed map is exact to round-off, its start frozen, where the map is to converge; where only the state is, it is not.
#[test]
fn the_executed_map_is_symplectic_to_round_off() {
    let map = NewtonOptions {
        convergence: Convergence::Map,
        ..NewtonOptions::default()
    };
    let by_state = |tolerance: f64| NewtonOptions {
        convergence: Convergence::State,
        tolerance,
        ..NewtonOptions::default()
    };
    let mut lost = 0.0_f64;
    macro_rules! check {
        ($lift:ty, $system:ident, $mu:expr, $steps:expr) => {
            let system = $system::new().system().expect("parameters");
            let dual = $system::<Dual<f64>>::default()
                .system()
                .expect("parameters");
            for h in $steps {
                let exact = frozen_defects::<$lift, _, _>(&system, &dual, $mu, h, &map);
                let control = frozen_defects::<$lift, _, _>(&system, &dual, $mu, h, &by_state(1.0));
                println!(
                    "{} h = {h}: map {exact:e}, state {control:e}",
                    stringify!($system)
                );
                assert!(exact < 5e-14, "{} h = {h}: {exact:e}", stringify!($system));
                lost = lost.max(control);
            }
        };
    }
    check!(Hopf, Body, &[0.7, 0.4, 1.1], [0.02, 0.1, 0.4, 0.8, 1.2]);
    check!(Quaternion, Top, &TOP, [0.01, 0.05, 0.2, 0.5, 0.8, 1.2]);
    check!(Representation, Top, &TOP, [0.05, 0.2, 0.5]);
    check!(
        Unitary,
        Threefold,
        &[0.3, -0.2, 0.4, 0.1, 0.5, -0.3, 0.2, 0.6, -0.1],
        [0.05, 0.5, 1.5]
    );
    check!(
        Quaternion,
        Vectors,
        &[0.3, -0.5, 1.2, 0.1, 0.2, 0.97, 0.3, -0.2, 0.4],
        [0.05, 0.2, 0.5]
    );
    assert!(
        lost > 1e-12,
        "by the state alone the derivative is left over: {lost:e}"
    );
}

/// The step is a Poisson map to round-off also where it is large; Gauss collocation on mu is not.
#[test]
fn steps_are_poisson_maps() {
    fn check<P, M>(system: &P, method: &M, mu: &[f64], steps: &[f64], bound: f64)
    where
        P: Poisson<Dual<f64>>,
        M: Facts + Method<Dual<f64>, P>,
    {
        let options = NewtonOptions::default();
        for &h in steps {
            let found = poisson_defect(system, method, h, mu, &options).expect("solved");
            println!("{} {} h = {h}: {found:e}", system.name(), M::ID);
            assert!(
                found < bound,
                "{} {} h = {h}: {found:e}",
                system.name(),
                M::ID
            );
        }
    }
    let top = Top::<Dual<f64>>::default().system().expect("parameters");
    check(
        &top,
        &Collective16::quaternion(),
        &TOP,
        &[0.1, 0.5, 1.2, 2.0],
        3e-14,
    );
    check(
        &top,
        &Collective8::quaternion(),
        &TOP,
        &[0.5, 1.2, 1.6],
        3e-14,
    );
    check(&top, &Isospectral16::new(), &TOP, &[0.1, 0.5, 1.2], 3e-14);
    let vectors = Vectors::<Dual<f64>>::default()
        .system()
        .expect("parameters");
    let mu: Vec<f64> = (0..9)
        .map(|k| (1.0 + 2.3 * f64::from(k)).sin() * 0.9)
        .collect();
    check(
        &vectors,
        &Collective16::quaternion(),
        &mu,
        &[0.1, 0.4, 0.8],
        3e-14,
    );
    let body = Body::<Dual<f64>>::default().system().expect("parameters");
    check(
        &body,
        &Collective16::hopf(),
        &[0.7, 0.4, 1.1],
        &[0.1, 0.6, 1.2],
        3e-14,
    );
    let sl2 = Sl2Quadratic::<Dual<f64>>::default()
        .system()
        .expect("parameters");
    check(
        &sl2,
        &Isospectral8::new(),
        &[0.3, 0.5, 0.4],
        &[0.1, 0.3],
        1e-14,
    );

    let three = Threefold::<Dual<f64>>::default()
        .system()
        .expect("parameters");
    let su3 = Su3Quadratic::<Dual<f64>>::default()
        .system()
        .expect("parameters");
    for start in [
        [0.3, -0.2, 0.4, 0.1, 0.5, -0.3, 0.2, 0.6, -0.1],
        // two equal eigenvalues, the lower or the higher ones
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7, 0.7, -0.4],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7, -0.4, -0.4],
    ] {
        check(
            &three,
            &Collective16::unitary(),
            &start,
            &[0.1, 1.0, 2.0],
            3e-14,
        );
        check(
            &su3,
            &Collective16::unitary(),
            &start[..8],
            &[0.1, 1.0, 2.5],
            3e-14,
        );
        check(&su3, &Collective10::smallest(), &start[..8], &[1.0], 3e-14);
    }
    let control = |found: Result<f64, StepFailure>| assert!(found.expect("solved") > 1e-12);
    let options = NewtonOptions::default();
    control(poisson_defect(&top, &Gauss16, 2.0, &TOP, &options));
    control(poisson_defect(&vectors, &Gauss16, 2.0, &mu, &options));
    control(poisson_defect(&su3, &Gauss16, 2.5, &SU3, &options));
    control(poisson_defect(
        &body,
        &Gauss16,
        2.4,
        &[0.7, 0.4, 1.1],
        &options,
    ));
    control(poisson_defect(
        &sl2,
        &Gauss8,
        0.5,
        &[0.3, 0.5, 0.4],
        &options,
    ));
}

/// Casimirs stay and the energy error does not grow.
#[test]
fn orbits_are_kept_and_the_energy_does_not_drift() {
    fn check<P: Poisson<f64>, M: Facts + Method<f64, P>>(
        system: &P,
        method: &M,
        start: &P::State,
        h: f64,
        steps: u32,
    ) -> f64 {
        let mut mu = start.clone();
        let mut stepper = method.stepper(system, h, &NewtonOptions::default());
        let energy = system.hamiltonian(start);
        let count = system.casimir_count();
        let (mut before, mut now) = (vec![0.0; count], vec![0.0; count]);
        system.casimirs(start, &mut before);
        let (mut early, mut late, mut off) = (0.0_f64, 0.0_f64, 0.0_f64);
        for k in 0..steps {
            stepper.step(&mut mu, &mut ()).expect("the step is solved");
            let error = (system.hamiltonian(&mu) - energy).abs();
            if 10 * k < steps {
                early = early.max(error);
            } else if 10 * k >= 9 * steps {
                late = late.max(error);
            }
            system.casimirs(&mu, &mut now);
            off = off.max(distance(&now, &before));
        }
        println!(
            "{}: energy {early:e}, then {late:e}, Casimirs {off:e}",
            system.name()
        );
        assert!(
            early > 1e-12,
            "{}: a step that shows something",
            system.name()
        );
        if M::PRESERVES.orbit {
            assert!(off < 2e-12, "{}: {off:e}", system.name());
        }
        late / early
    }
    const GROWTH: f64 = 5.0;
    let top = Top::new().system().expect("parameters");
    // swinging below the fixed point
    let start = state(&top, &[0.2, -0.1, 0.8, 0.2, 0.1, -1.0]);
    let body = ManakovTop::new().system().expect("parameters");
    let su3 = Su3Quadratic::new().system().expect("parameters");
    for growth in [
        check(
            &top,
            &Collective8::quaternion(),
            &start,
            0.5,
            daily(800, 20_000),
        ),
        check(
            &top,
            &Collective16::quaternion(),
            &start,
            2.2,
            daily(300, 5_000),
        ),
        check(
            &top,
            &Isospectral8::new(),
            &start,
            0.4,
            daily(1_000, 10_000),
        ),
        check(
            &body,
            &Collective8::smallest(),
            &some(&body),
            0.3,
            daily(500, 5_000),
        ),
        check(
            &su3,
            &Isospectral8::new(),
            &some(&su3),
            0.4,
            daily(500, 2_000),
        ),
        check(
            &su3,
            &Collective8::unitary(),
            &some(&su3),
            1.0,
            daily(600, 10_000),
        ),
        check(
            &su3,
            &Collective16::smallest(),
            &state(&su3, &SU3),
            2.5,
            daily(1_000, 5_000),
        ),
    ] {
        assert!(growth < GROWTH, "{growth}");
    }
    let control = check(&top, &Rk4, &start, 0.05, 20_000);
    assert!(control > GROWTH, "{control}");
}

/// Eight trajectories in lanes have the digits of eight runs, also where points are chosen anew.
#[test]
fn a_lane_has_the_digits_of_its_own_run() {
    macro_rules! check {
        ($system:ident, $method:expr, $h:expr) => {
            let lanes = $system::<F64x8>::default().system().expect("parameters");
            let scalar = $system::new().system().expect("parameters");
            let start = some(&scalar);
            let mut alone: [_; 8] = core::array::from_fn(|lane| {
                let mut mu = start;
                for (k, entry) in mu.as_mut_slice().iter_mut().enumerate() {
                    *entry *= 0.2 * lane as f64 + 0.05 * (k as f64).cos();
                }
                mu
            });
            let mut together = Poisson::<F64x8>::zero_state(&lanes);
            for (row, entry) in together.as_mut_slice().iter_mut().enumerate() {
                *entry = F64x8::new(core::array::from_fn(|lane| alone[lane][row]));
            }
            let options = NewtonOptions::default();
            let mut stepper = $method.stepper(&lanes, F64x8::splat($h), &options);
            for _ in 0..12 {
                stepper
                    .step(&mut together, &mut ())
                    .expect("the step is solved");
            }
            for (lane, mu) in alone.iter_mut().enumerate() {
                run(&scalar, &$method, mu, $h, 12);
                for (row, x) in mu.iter().enumerate() {
                    let other = together.as_slice()[row].lane(lane);
                    assert_eq!(other.to_bits(), x.to_bits(), "lane {lane}, row {row}");
                }
            }
        };
    }
    check!(Top, Collective12::quaternion(), 0.2);
    check!(Top, Isospectral16::new(), 0.4);
    check!(Sl2Quadratic, Isospectral8::new(), 0.1);
    check!(Threefold, Collective12::unitary(), 0.3);
    check!(Su3Quadratic, Collective16::smallest(), 0.5);
}

/// A step that does not contract is refused, and the state stays.
#[test]
fn a_step_that_does_not_contract_is_refused() {
    let top = Top::new().system().expect("parameters");
    let start = state(&top, &TOP);
    let mut mu = start;
    let mut stepper = Method::<f64, _>::stepper(
        &Collective16::quaternion(),
        &top,
        30.0,
        &NewtonOptions::default(),
    );
    let failure = stepper.step(&mut mu, &mut ()).expect_err("it is too large");
    assert_eq!((failure.reason, mu), (FailureReason::NotConverged, start));
}
