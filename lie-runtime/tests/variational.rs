//! Variational integrators: agreement with the Hamiltonian form step by step, an independent oracle, orders by
//! slope, structure by the tangent map, and controls that must fail.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::{self, GalerkinStep};
use lie_runtime::lagrangian::{
    DiscreteLagrangian, LagrangianOfStep, legendre, legendre_left, legendre_right,
};
use lie_runtime::methods::{Cayley, Exp, Facts, ImplicitStepper, Method};
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Implicit, Unknown};
use nalgebra::{SMatrix, SVector};
use systems::quartic_lagrangian::{BODY, LINE, QuarticBody, QuarticLine};
use systems::{distance, jacobian_against_differences, state, steps};

/// `l'(xi)` at `xi = (0.9, 1.1)` of the system on aff(1).
const LINE_START: [f64; 2] = [13.0 / 6.0, 2.4648];
/// `l'(xi(1))` from [`BODY`] and [`LINE_START`]: the Euler–Poincaré equations in 30 digits (Bulirsch and Stoer).
const BODY_END: [f64; 3] = [0.9571181584335036, 0.08926396986236093, 0.6349702714240891];
const LINE_END: [f64; 2] = [-1.458016106572237, 2.4108218921190145];

#[test]
fn legendre_transform_and_its_derivatives() {
    let system = QuarticBody;
    for xi in [[0.4, 0.5, 0.7], [-1.5, 2.0, 0.25], [1e-7, -3.0, 1e-3]] {
        let xi = SVector::from(xi);
        let mut mu = xi;
        system.momentum(&xi, &mut mu);
        let mut found = xi;
        legendre::velocity(&system, &mu, &mut found);
        assert!((found - xi).amax() < 8e-16 * xi.amax(), "{found}");
        let energy = mu.dot(&xi) - system.lagrangian(&xi);
        assert!((legendre::hamiltonian(&system, &mu) - energy).abs() < 4e-15 * energy.abs());
        let mut hessian = SMatrix::zeros();
        let mut inertia = SMatrix::zeros();
        legendre::hessian(&system, &mu, &mut hessian);
        system.inertia(&xi, &mut inertia);
        assert!((inertia * hessian - SMatrix::<f64, 3, 3>::identity()).amax() < 2e-14);
        // the derivative of the gradient through the iteration is the Hessian
        for column in 0..3 {
            let mut dual = mu.map(Dual::constant_of);
            dual[column].derivative = 1.0;
            let mut slope = dual;
            system.gradient(&dual, &mut slope);
            for row in 0..3 {
                let error = slope[row].derivative - hessian[(row, column)];
                assert!(error.abs() < 4e-15 * hessian.amax(), "{error:e}");
            }
            let energy = system.hamiltonian(&dual).derivative;
            assert!((energy - xi[column]).abs() < 4e-15 * xi.amax());
        }
    }
}

#[test]
fn euler_poincare_is_the_field_of_the_hamiltonian_form() {
    let system = QuarticBody;
    let xi = SVector::from([0.4, 0.5, 0.7]);
    let (mut mu, mut field, mut rate) = (xi, xi, xi);
    system.momentum(&xi, &mut mu);
    system.vector_field(&mu, &mut field);
    system.euler_poincare(&xi, &mut rate);
    let mut inertia = SMatrix::<f64, 3, 3>::zeros();
    system.inertia(&xi, &mut inertia);
    assert!((inertia * rate - field).amax() < 1e-15);
    assert!(rate.amax() > 0.05);
}

/// Both forms of one method, step by step.
fn both_forms<L, H>(variational: L, hamiltonian: H)
where
    L: Method<f64, QuarticBody>,
    H: Method<f64, QuarticBody>,
{
    let (system, newton) = (QuarticBody, NewtonOptions::default());
    for h in [0.1, -0.4] {
        let mut first = variational.stepper(&system, h, &newton);
        let mut second = hamiltonian.stepper(&system, h, &newton);
        let (mut a, mut b) = (SVector::from(BODY), SVector::from(BODY));
        for step in 1..=2000 {
            let mut once = a;
            second.step(&mut once, &mut ()).expect("a step");
            first.step(&mut a, &mut ()).expect("a step");
            second.step(&mut b, &mut ()).expect("a step");
            assert!(
                (a - once).amax() < 2e-15,
                "step {step} of {h}: {:e}",
                (a - once).amax()
            );
            assert!(
                (a - b).amax() < 2e-15 * f64::from(step),
                "step {step} of {h}"
            );
        }
        assert!((a - SVector::from(BODY)).amax() > 0.05, "it moves");
    }
}

#[test]
fn the_lagrangian_and_the_hamiltonian_form_make_the_same_steps() {
    both_forms(Variational2::exp(), LieMidpoint::exp());
    both_forms(Variational2::cayley(), LieMidpoint::cayley());
}

/// One step of 1/4, by arithmetic of 50 digits: the discrete Lagrangian differenced, the equation
/// `(dexp_Theta^-1)* dl_d = mu` solved by matrices.
#[test]
fn single_steps_are_those_of_an_independent_computation() {
    fn one<M: Method<f64, QuarticBody> + Method<f64, QuarticLine>>(
        method: M,
        body: [f64; 3],
        line: [f64; 2],
    ) {
        let mut mu = SVector::from(BODY);
        steps(&QuarticBody, &method, 0.25, 1, &mut mu).expect("a step");
        assert!((mu - SVector::from(body)).amax() < 1e-15, "{mu}");
        let mut mu = SVector::from(LINE);
        steps(&QuarticLine, &method, 0.25, 1, &mut mu).expect("a step");
        assert!((mu - SVector::from(line)).amax() < 1e-15, "{mu}");
    }
    one(
        Variational2::exp(),
        [0.8650467129290198, 0.4975800582725393, 0.5756203099016794],
        [0.6735900072713027, 0.5914867982640691],
    );
    one(
        Variational4::exp(),
        [0.8651710734264783, 0.4974902024589481, 0.5755110626864973],
        [0.6734854162194913, 0.5915106583386196],
    );
    one(
        Variational6::exp(),
        [0.8651710192689682, 0.49749028824697955, 0.575511069944048],
        [0.6734853918565522, 0.5915106695096789],
    );
}

/// The slope, and the error at the smallest step.
fn slope<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    (start, end): (&[f64], &[f64]),
    counts: &[u32],
) -> f64 {
    let end = state(system, end);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| {
            let mut mu = state(system, start);
            steps(system, method, 1.0 / f64::from(count), count, &mut mu)
                .expect("the steps converge");
            (1.0 / f64::from(count), distance(&mu, &end))
        })
        .collect();
    order_of_convergence(&points, 3e-14)
        .expect("enough points above round-off")
        .slope
}

#[test]
fn measured_orders_are_the_declared_ones() {
    fn check<M>(method: M, counts: [&[u32]; 2])
    where
        M: Method<f64, QuarticBody> + Method<f64, QuarticLine> + Facts,
    {
        let order = f64::from(M::ORDER);
        let body = slope(&QuarticBody, &method, (&BODY, &BODY_END), counts[0]);
        let line = slope(&QuarticLine, &method, (&LINE_START, &LINE_END), counts[1]);
        println!("{}: {body:.3} on so(3), {line:.3} on aff(1)", M::ID);
        for slope in [body, line] {
            assert!((slope - order).abs() < 0.12, "{}: {body} and {line}", M::ID);
        }
    }
    check(
        Variational2::exp(),
        [&[8, 12, 16, 24, 32, 48], &[24, 32, 48, 64, 96]],
    );
    check(
        Variational4::exp(),
        [&[8, 12, 16, 24, 32, 48], &[24, 32, 48, 64, 96]],
    );
    check(
        Variational6::exp(),
        [&[4, 6, 8, 10, 12, 16], &[12, 16, 20, 24, 28, 32]],
    );
    let body = slope(
        &QuarticBody,
        &Variational2::cayley(),
        (&BODY, &BODY_END),
        &[8, 16, 32, 64],
    );
    assert!((body - 2.0).abs() < 0.1, "{body}");
    // the end of another system is not reached
    let wrong = [BODY_END[0], BODY_END[1], BODY_END[2] + 1e-6];
    let counts = [16, 24, 32, 48];
    let control = slope(&QuarticBody, &Variational4::exp(), (&BODY, &wrong), &counts);
    assert!(control < 3.0, "{control}");
}

#[test]
fn structure_is_kept() {
    fn check<M, P>(system: &P, method: M, start: &[f64])
    where
        M: Method<Dual<f64>, P::Lifted> + Method<f64, P> + Facts,
        P: Lift<f64>,
    {
        let lifted = system.lift();
        let mu = state(system, start);
        let defect = poisson_defect(
            &lifted,
            &method,
            0.4,
            mu.as_slice(),
            &NewtonOptions::default(),
        );
        let defect = defect.expect("a step");
        assert!(defect < 4e-15, "{} {}: {defect:e}", system.name(), M::ID);
        let mut casimirs = [[0.0; 1]; 2];
        let mut end = mu.clone();
        steps(system, &method, 0.4, 300, &mut end).expect("the steps");
        system.casimirs(&mu, &mut casimirs[0][..system.casimir_count()]);
        system.casimirs(&end, &mut casimirs[1][..system.casimir_count()]);
        let drift = (casimirs[0][0] - casimirs[1][0]).abs();
        assert!(
            drift < 300.0 * 4e-16,
            "{} {}: {drift:e}",
            system.name(),
            M::ID
        );
        let energy = (system.hamiltonian(&end) - system.hamiltonian(&mu)).abs();
        assert!(energy < 1e-2, "{} {}: {energy:e}", system.name(), M::ID);
    }
    check(&QuarticBody, Variational2::exp(), &BODY);
    check(&QuarticBody, Variational2::cayley(), &BODY);
    check(&QuarticBody, Variational4::exp(), &BODY);
    check(&QuarticBody, Variational6::exp(), &BODY);
    check(&QuarticLine, Variational2::exp(), &LINE);
    check(&QuarticLine, Variational4::exp(), &LINE);
    check(&QuarticLine, Variational6::exp(), &LINE);
    let rk4 = poisson_defect(&QuarticBody, &Rk4, 0.4, &BODY, &NewtonOptions::default());
    assert!(rk4.expect("a step") > 1e-8, "the control");
}

#[test]
fn order_two_is_symmetric_and_the_others_are_not() {
    fn defect(method: impl Method<f64, QuarticBody>) -> f64 {
        let mut mu = SVector::from(BODY);
        steps(&QuarticBody, &method, 0.5, 1, &mut mu).expect("a step");
        steps(&QuarticBody, &method, -0.5, 1, &mut mu).expect("a step");
        (mu - SVector::from(BODY)).amax()
    }
    assert!(defect(Variational2::exp()) < 1e-15);
    assert!(defect(Variational2::cayley()) < 1e-15);
    assert!(defect(Variational4::exp()) > 1e-9);
    assert!(defect(Variational6::exp()) > 1e-13);
}

/// With one stage the path is a one-parameter subgroup.
#[test]
fn one_stage_is_order_two() {
    let (system, newton) = (QuarticBody, NewtonOptions::default());
    let zero = system.zero_state();
    let equation = GalerkinStep::<f64, QuarticBody, 1>::new(&system, 0.3);
    let mut first = ImplicitStepper::new(equation, zero, &newton);
    let mut second = Variational2::exp().stepper(&system, 0.3, &newton);
    let (mut a, mut b) = (SVector::from(BODY), SVector::from(BODY));
    for _ in 0..20 {
        first.step(&mut a, &mut ()).expect("a step");
        second.step(&mut b, &mut ()).expect("a step");
        assert!((a - b).amax() < 1e-14, "{a} {b}");
    }
}

/// The Jacobian of an equation against differences of its residual.
#[test]
fn jacobians_agree_with_differences() {
    jacobian_against_differences(&QuarticBody, &Variational2::exp(), 0.5, &BODY);
    jacobian_against_differences(&QuarticBody, &Variational2::cayley(), 0.5, &BODY);
    jacobian_against_differences(&QuarticBody, &Variational4::exp(), 0.5, &BODY);
    jacobian_against_differences(&QuarticBody, &Variational6::exp(), 0.5, &BODY);
}

/// The series of dexp converges everywhere, but not within its terms where the path turns hundreds of times: there the
/// residual is not a number rather than that of a series cut off.
#[test]
fn a_path_beyond_the_series_has_no_residual() {
    let method = Variational4::exp();
    let mut equation = QuarticBody.equation(&method, 0.5);
    equation.set_base(&SVector::from(BODY));
    let mut unknown = equation.zero_unknown();
    let mut residual = unknown.clone();
    for (size, inside) in [(1.0, true), (3.0, true), (100.0, false), (1000.0, false)] {
        for index in 0..unknown.len() {
            unknown.set_entry(index, size * (1.0 - 0.37 * index as f64));
        }
        equation.residual(&unknown, &mut residual);
        let finite = (0..residual.len()).all(|index| residual.entry(index).is_finite());
        assert_eq!(finite, inside, "{size}");
    }
}

/// `F+(g) = mu`, `F-(g) = mu1`, and the discrete Euler–Poincaré equation over several steps.
#[test]
fn discrete_legendre_maps() {
    fn check<E, T>(equation: E, retraction: T)
    where
        E: Equation<f64, State = SVector<f64, 3>, Unknown = SVector<f64, 3>>,
        T: lie_runtime::lagrangian::Trivialise<f64, QuarticBody>,
    {
        let (system, h) = (QuarticBody, 0.3);
        let l_d = LagrangianOfStep::new(&system, h);
        let mut stepper =
            ImplicitStepper::new(equation, system.zero_state(), &NewtonOptions::default());
        let mut mu = SVector::from(BODY);
        for _ in 0..10 {
            let before = mu;
            stepper.step(&mut mu, &mut ()).expect("a step");
            let x = stepper.unknown();
            let (mut right, mut left) = (before, before);
            legendre_right(&retraction, &system, &l_d, x, &mut right);
            legendre_left(&retraction, &system, &l_d, x, &mut left);
            assert!(
                (right - before).amax() < 2e-15,
                "F+ {:e}",
                (right - before).amax()
            );
            assert!((left - mu).amax() < 2e-15, "F- {:e}", (left - mu).amax());
            // F- and F+ differ: the step moves
            assert!((left - right).amax() > 1e-3);
            let action = h * system.lagrangian(&(x / h));
            assert!((l_d.value(x) - action).abs() < 1e-16);
        }
    }
    check(QuarticBody.equation(&Variational2::exp(), 0.3), Exp);
    check(QuarticBody.equation(&Variational2::cayley(), 0.3), Cayley);
}

#[test]
fn lanes_make_the_steps_of_scalar_runs() {
    fn check<M: Method<f64, QuarticBody> + Method<F64x4, QuarticBody> + Copy>(method: M) {
        let scales = [1.0, 0.25, -1.5, 3.0];
        let mut mu = SVector::<F64x4, 3>::from(BODY.map(F64x4::splat));
        for (entry, value) in mu.iter_mut().zip(BODY) {
            for (lane, scale) in scales.into_iter().enumerate() {
                *entry = entry.with_lane(lane, value * scale);
            }
        }
        steps(&QuarticBody, &method, 0.2, 5, &mut mu).expect("the steps");
        for (lane, scale) in scales.into_iter().enumerate() {
            let mut alone = SVector::from(BODY.map(|value| value * scale));
            steps(&QuarticBody, &method, 0.2, 5, &mut alone).expect("the steps");
            for row in 0..3 {
                assert_eq!(mu[row].lane(lane), alone[row], "lane {lane}");
            }
        }
    }
    check(Variational2::exp());
    check(Variational2::cayley());
    check(Variational4::exp());
    check(Variational6::exp());
    check(LieMidpoint::exp());
}

/// Beyond the momenta that have a velocity, a step is refused and the state left alone.
#[test]
fn a_momentum_without_velocity_is_refused() {
    let mut out = SVector::from([0.0; 3]);
    let mu = SVector::from([f64::INFINITY, 0.0, 0.0]);
    legendre::velocity(&QuarticBody, &mu, &mut out);
    assert!(!out.iter().all(|x| x.is_finite()));
    let mut mu = SVector::from([f64::NAN, 0.5, 0.5]);
    let failure = steps(&QuarticBody, &Variational4::exp(), 0.1, 1, &mut mu);
    assert!(failure.is_err());
}

/// The generic forms hold for a Lagrangian that is a Legendre transform back and forth.
#[test]
fn inverse_tangents_undo_the_tangents() {
    let system = QuarticBody;
    let (x, m) = (
        SVector::from([0.7, -1.1, 0.4]),
        SVector::from([0.3, 0.9, -0.2]),
    );
    let (mut there, mut back) = (m, m);
    generic::dexp_inverse_dual(&system, &x, &m, &mut there);
    generic::dexp_dual(&system, &x, &there, &mut back);
    assert!((back - m).amax() < 1e-15);
    // Ad*_(tau x) (d tau_x^-1)* m = (d tau_-x^-1)* m
    let mut left = m;
    generic::dexp_inverse_dual(&system, &-x, &m, &mut left);
    generic::coadjoint_action(&system, &x, &there, &mut back);
    assert!((back - left).amax() < 1e-15);
}
