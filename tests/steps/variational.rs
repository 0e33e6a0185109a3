//! Systems declared by a Lagrangian: their variational integrators make the steps of the Hamiltonian form, and the
//! Legendre transform by Newton's iteration is the one in closed form.

use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::lagrangian::{
    DeclaredDiscreteLagrangian, LagrangianOfStep, legendre_left, legendre_right,
};
use lie_runtime::methods::{Cayley, Exp};
use lie_runtime::prelude::*;
use nalgebra::{SMatrix, SVector};

// The same body by its Lagrangian, and by a Hamiltonian written by hand.
lie_poisson! { spec = "tests/data/lagrangian/gyrostat_lagrangian.json"; }
lie_poisson! { spec = "tests/data/lagrangian/gyrostat_hamiltonian.json"; }

// Moser and Veselov's body in Cayley coordinates.
lie_poisson! { spec = "specs/so3_discrete_lagrangian.json"; }

// The same, as it is written in the literature: `(tr J - tr(g J))/h`.
lie_poisson! { spec = "tests/data/lagrangian/moser_veselov_entries.json"; }

// A discrete Lagrangian on the affine group of the line, in the entries of its matrices.
lie_poisson! {
    system AffineByEntries;
    algebra {
        basis a, b; [a, b] = b;
        matrix a = [[1, 0], [0, 0]];
        matrix b = [[0, 1], [0, 0]];
    }
    group G;
    state p, q;
    velocity u, v;
    discrete_lagrangian = ((G11 - 1)^2/G11 + G12^2/(2*G11))/h + (G11 - 1)*G12/(3*h);
    initial = [11/15, 0.5512];
}

// The action along one-parameter subgroups: what `variational2` takes by itself.
lie_poisson! {
    system DiscreteLine;
    algebra { basis a, b; [a, b] = b; }
    state p, q;
    velocity x, y;
    let u = x/h;
    let v = y/h;
    discrete_lagrangian = h*(u^2 + v^2/2 + u*v/3 + v^4/5);
    initial = [11/15, 0.5512];
}

// One that is not symmetric in time: the cubic term has the order of its error.
lie_poisson! {
    system Skew;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state m1, m2, m3;
    velocity x, y, z;
    discrete_lagrangian = (2*x^2 + y^2 + z^2*2/3)/(2*h) + x*y*z/(3*h) + z^3/(5*h);
    casimir C = m1^2 + m2^2 + m3^2;
    initial = [0.6, -0.5, 0.7];
}

// `l = -c^2 sqrt(1 - <A xi, xi>/c^2)`, of which the Hamiltonian is `c^2 sqrt(1 + <A^-1 mu, mu>/c^2)`.
lie_poisson! {
    system RelativisticByLagrangian;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    velocity u, v, w;
    parameters { c = 1.25; }
    lagrangian = -c^2*sqrt(1 - (u^2 + 2*v^2 + w^2/2)/c^2);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
    initial = [0.9, -1.5, 2];
}

lie_poisson! {
    system RelativisticByHamiltonian;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { c = 1.25; }
    hamiltonian = c^2*sqrt(1 + (x^2 + y^2/2 + 2*z^2)/c^2);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
    initial = [0.9, -1.5, 2];
}

lie_poisson! {
    system Line;
    algebra { basis a, b; [a, b] = b; }
    state p, q;
    velocity u, v;
    lagrangian = u^2 + v^2/2 + u*v/3 + v^4/5;
    initial = [11/15, 0.5512];
}

// The momentum of `sqrt(1 + u^2)` is below 1.
lie_poisson! {
    system Bounded;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    velocity u, v, w;
    lagrangian = sqrt(1 + u^2) + v^2/2 + w^2/4;
    initial = [0.5, 1.5, 0.9];
}

type V = SVector<f64, 3>;

/// Steps of one method on one system and of another on another: the largest difference of a single step from the
/// same state, and of both runs.
fn differences<A, B>(
    (first, method): (&A, &impl Method<f64, A>),
    (second, other): (&B, &impl Method<f64, B>),
    start: V,
    h: f64,
    steps: u32,
) -> (f64, f64)
where
    A: Poisson<f64, State = V>,
    B: Poisson<f64, State = V>,
{
    let newton = NewtonOptions::default();
    let mut one = method.stepper(first, h, &newton);
    let mut two = other.stepper(second, h, &newton);
    let (mut a, mut b) = (start, start);
    let (mut single, mut both, mut moved) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..steps {
        let mut from_the_same = a;
        two.step(&mut from_the_same, &mut ()).expect("a step");
        one.step(&mut a, &mut ()).expect("a step");
        two.step(&mut b, &mut ()).expect("a step");
        single = single.max((a - from_the_same).amax());
        both = both.max((a - b).amax());
        moved = moved.max((a - start).amax());
    }
    assert!(moved > 0.1, "it moves");
    (single, both)
}

#[test]
fn both_forms_make_the_same_steps() {
    let lagrangian = GyrostatByLagrangian::new().system().expect("finite");
    let hamiltonian = GyrostatByHamiltonian::new().system().expect("finite");
    let start = GyrostatByLagrangian::new().initial_state();
    let mut mu = start;
    lagrangian.gradient(&start, &mut mu);
    let mut expected = start;
    hamiltonian.gradient(&start, &mut expected);
    assert!((mu - expected).amax() < 1e-15, "{mu} {expected}");
    for h in [0.1, -0.35] {
        let (single, both) = differences(
            (&lagrangian, &Variational2::exp()),
            (&hamiltonian, &LieMidpoint::exp()),
            start,
            h,
            5000,
        );
        println!("exp, h = {h}: {single:.1e} in a step, {both:.1e} in 5000");
        assert!(single < 1.5e-15 && both < 1e-10, "{h}: {single:e} {both:e}");
        let (single, both) = differences(
            (&lagrangian, &Variational2::cayley()),
            (&hamiltonian, &LieMidpoint::cayley()),
            start,
            h,
            5000,
        );
        println!("cayley, h = {h}: {single:.1e} in a step, {both:.1e} in 5000");
        assert!(single < 1.5e-15 && both < 1e-10, "{h}: {single:e} {both:e}");
        // the control: another retraction is another method
        let (single, _) = differences(
            (&lagrangian, &Variational2::cayley()),
            (&hamiltonian, &LieMidpoint::exp()),
            start,
            h,
            10,
        );
        assert!(single > 1e-7, "{single:e}");
    }
}

#[test]
fn newtons_legendre_transform_is_the_closed_one() {
    let lagrangian = RelativisticByLagrangian::new().system().expect("finite");
    let hamiltonian = RelativisticByHamiltonian::new().system().expect("finite");
    for scale in [1e-6, 0.3, 1.0, 4.0] {
        let mu: V = scale * RelativisticByLagrangian::<f64>::new().initial_state();
        let (a, b) = (lagrangian.hamiltonian(&mu), hamiltonian.hamiltonian(&mu));
        assert!((a - b).abs() < 4e-15 * b.abs(), "{scale}: {a} {b}");
        let (mut a, mut b) = (mu, mu);
        lagrangian.gradient(&mu, &mut a);
        hamiltonian.gradient(&mu, &mut b);
        assert!((a - b).amax() < 2e-15 * b.amax(), "{scale}: {a} {b}");
        let (mut a, mut b) = (SMatrix::<f64, 3, 3>::zeros(), SMatrix::<f64, 3, 3>::zeros());
        lagrangian.hessian(&mu, &mut a);
        hamiltonian.hessian(&mu, &mut b);
        assert!((a - b).amax() < 1e-13 * b.amax(), "{scale}: {a} {b}");
        lagrangian.jacobian(&mu, &mut a);
        hamiltonian.jacobian(&mu, &mut b);
        assert!((a - b).amax() < 1e-13 * b.amax(), "{scale}: {a} {b}");
    }
    let start = RelativisticByLagrangian::new().initial_state();
    let closed = (&hamiltonian, &LieMidpoint::exp());
    let (single, both) = differences(
        (&lagrangian, &Variational2::exp()),
        closed,
        start,
        0.2,
        3000,
    );
    println!("relativistic: {single:.1e} in a step, {both:.1e} in 3000");
    assert!(single < 3e-15 && both < 1e-10, "{single:e} {both:e}");
    let (single, both) = differences((&lagrangian, &LieMidpoint::exp()), closed, start, 0.2, 3000);
    assert!(single < 3e-15 && both < 1e-10, "{single:e} {both:e}");
    // derivatives of higher order through the iteration
    let (single, both) = differences(
        (&lagrangian, &Generating6::exp()),
        (&hamiltonian, &Generating6::exp()),
        start,
        0.2,
        25,
    );
    println!("generating6: {single:.1e} in a step, {both:.1e} in 25");
    assert!(single < 3e-15 && both < 1e-12, "{single:e} {both:e}");
}

/// One step of 1/4 against arithmetic of 50 digits, as for the system written by hand in the runtime's tests.
#[test]
fn generated_systems_make_the_steps_of_an_independent_computation() {
    let system = Line::new().system().expect("finite");
    let step = |mu: &mut SVector<f64, 2>, order: u32| {
        let newton = NewtonOptions::default();
        match order {
            2 => Variational2::exp()
                .stepper(&system, 0.25, &newton)
                .step(mu, &mut ()),
            4 => Variational4::exp()
                .stepper(&system, 0.25, &newton)
                .step(mu, &mut ()),
            _ => Variational6::exp()
                .stepper(&system, 0.25, &newton)
                .step(mu, &mut ()),
        }
    };
    for (order, expected) in [
        (2, [0.6735900072713027, 0.5914867982640691]),
        (4, [0.6734854162194913, 0.5915106583386196]),
        (6, [0.6734853918565522, 0.5915106695096789]),
    ] {
        let mut mu = Line::new().initial_state();
        step(&mut mu, order).expect("a step");
        assert!(
            (mu - SVector::from(expected)).amax() < 1e-15,
            "{order}: {mu}"
        );
    }
}

#[test]
fn discrete_euler_poincare_equation() {
    let system = GyrostatByLagrangian::new().system().expect("finite");
    let l_d = LagrangianOfStep::new(&system, 0.3);
    let mut stepper = Variational2::exp().stepper(&system, 0.3, &NewtonOptions::default());
    let mut mu = GyrostatByLagrangian::new().initial_state();
    let mut before: Option<V> = None;
    for _ in 0..50 {
        stepper.step(&mut mu, &mut ()).expect("a step");
        let (mut left, mut right) = (mu, mu);
        legendre_right(&Exp, &system, &l_d, stepper.unknown(), &mut right);
        legendre_left(&Exp, &system, &l_d, stepper.unknown(), &mut left);
        assert!((left - mu).amax() < 2e-15);
        if let Some(before) = before {
            assert!(
                (before - right).amax() < 4e-15,
                "{:e}",
                (before - right).amax()
            );
        }
        before = Some(left);
    }
}

#[test]
fn moser_and_veselovs_body_is_an_instance() {
    let system = DiscreteBody::new().system().expect("finite");
    let start = DiscreteBody::new().initial_state();
    for h in [0.05, 0.3, -0.2] {
        let (single, both) = differences(
            (&system, &DiscreteEulerPoincare::cayley()),
            (&system, &MoserVeselov),
            start,
            h,
            2000,
        );
        println!("Moser-Veselov, h = {h}: {single:.1e} in a step, {both:.1e} in 2000");
        assert!(single < 1.5e-15 && both < 1e-11, "{h}: {single:e} {both:e}");
    }
    // read in exponential coordinates it is another method
    let other = (&system, &DiscreteEulerPoincare::exp());
    let (single, _) = differences(other, (&system, &MoserVeselov), start, 0.3, 20);
    assert!(single > 1e-6, "{single:e}");
}

/// In the entries of the group element, the discrete Lagrangian of Moser and Veselov is linear.
#[test]
fn discrete_lagrangians_in_the_entries_of_the_group_element() {
    let system = BodyByEntries::new().system().expect("finite");
    let start = BodyByEntries::new().initial_state();
    let entries = (&system, &DiscreteEulerPoincare::cayley());
    for h in [0.3, -0.2] {
        let (single, both) = differences(entries, (&system, &MoserVeselov), start, h, 2000);
        println!("by entries, h = {h}: {single:.1e} in a step, {both:.1e} in 2000");
        assert!(single < 2e-15 && both < 1e-11, "{h}: {single:e} {both:e}");
    }
    let coordinates = DiscreteBody::new().system().expect("finite");
    let other = (&coordinates, &DiscreteEulerPoincare::cayley());
    let (single, _) = differences(entries, other, start, 0.3, 100);
    assert!(single < 2e-15, "{single:e}");

    // not on so(3): by the map `F-(g)_i = <dl_d/dg, g rho_i>` on the matrices themselves
    let system = AffineByEntries::new().system().expect("finite");
    let h = 0.2;
    let method = DiscreteEulerPoincare::cayley();
    let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
    let mut mu = AffineByEntries::new().initial_state();
    for _ in 0..20 {
        let before = mu;
        stepper.step(&mut mu, &mut ()).expect("a step");
        let [x, y] = stepper.unknown().data.0[0];
        // (1 - X/2)^-1 (1 + X/2) for X = [[x, y], [0, 0]]
        let (g, b) = ((1.0 + x / 2.0) / (1.0 - x / 2.0), y / (1.0 - x / 2.0));
        let by_g = (1.0 - 1.0 / (g * g) - b * b / (2.0 * g * g) + b / 3.0) / h;
        let by_b = (b / g + (g - 1.0) / 3.0) / h;
        // g rho(a) = [[g, 0], [0, 0]], g rho(b) = [[0, g], [0, 0]]; rho(a) g = [[g, b], [0, 0]], rho(b) g = [[0, 1], [0, 0]]
        let (after, start) = ([by_g * g, by_b * g], [by_g * g + by_b * b, by_b]);
        for k in 0..2 {
            assert!((mu[k] - after[k]).abs() < 2e-14, "{mu} {after:?}");
            assert!((before[k] - start[k]).abs() < 2e-14, "{before} {start:?}");
        }
    }
}

/// Both Legendre maps of a declared discrete Lagrangian, and the discrete Euler–Poincaré equation between steps.
#[test]
fn legendre_maps_of_a_declared_discrete_lagrangian() {
    let system = DiscreteBody::new().system().expect("finite");
    let h = 0.3;
    let l_d = DeclaredDiscreteLagrangian::new(&system, h);
    let method = DiscreteEulerPoincare::cayley();
    let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
    let mut mu = DiscreteBody::new().initial_state();
    let mut last: Option<V> = None;
    for _ in 0..50 {
        let before = mu;
        stepper.step(&mut mu, &mut ()).expect("a step");
        let (mut left, mut right) = (mu, mu);
        legendre_right(&Cayley, &system, &l_d, stepper.unknown(), &mut right);
        legendre_left(&Cayley, &system, &l_d, stepper.unknown(), &mut left);
        assert!(
            (right - before).amax() < 2e-15,
            "{:e}",
            (right - before).amax()
        );
        assert!((left - mu).amax() < 2e-15, "{:e}", (left - mu).amax());
        if let Some(last) = last {
            let error: V = last - right;
            assert!(error.amax() < 4e-15, "{:e}", error.amax());
        }
        last = Some(left);
        // (tr J - tr(g J))/h by the matrix itself
        let [x, y, z] = stepper.unknown().data.0[0];
        let hat = SMatrix::<f64, 3, 3>::new(0.0, -z, y, z, 0.0, -x, -y, x, 0.0) / 2.0;
        let one = SMatrix::<f64, 3, 3>::identity();
        let g = (one - hat).try_inverse().expect("an inverse") * (one + hat);
        let moments = [0.25, 1.25, 0.75];
        let action: f64 = (0..3).map(|k| moments[k] * (1.0 - g[(k, k)])).sum::<f64>() / h;
        assert!((l_d.value(stepper.unknown()) - action).abs() < 1e-14);
    }
}

#[test]
fn a_declared_action_of_subgroups_is_variational2() {
    let (declared, reduced) = (DiscreteLine::new(), Line::new());
    let (declared, reduced) = (
        declared.system().expect("finite"),
        reduced.system().expect("finite"),
    );
    let newton = NewtonOptions::default();
    let mut discrete = DiscreteEulerPoincare::exp().stepper(&declared, 0.2, &newton);
    let mut variational = Variational2::exp().stepper(&reduced, 0.2, &newton);
    let mut of_the_limit = Variational2::exp().stepper(&declared, 0.2, &newton);
    let mut mu = Line::new().initial_state();
    for _ in 0..50 {
        let (mut a, mut b) = (mu, mu);
        discrete.step(&mut a, &mut ()).expect("a step");
        of_the_limit.step(&mut b, &mut ()).expect("a step");
        variational.step(&mut mu, &mut ()).expect("a step");
        assert!(
            (a - mu).amax() < 4e-16 && (b - mu).amax() < 4e-16,
            "{a} {b} {mu}"
        );
    }
}

#[test]
fn a_discrete_lagrangian_that_is_not_symmetric_has_order_one() {
    let system = Skew::new().system().expect("finite");
    let start = Skew::new().initial_state();
    let run = |method: &dyn Fn(f64, u32) -> V, steps: u32| method(1.0 / f64::from(steps), steps);
    let skew = |h: f64, steps: u32| {
        let mut mu = start;
        let mut stepper =
            DiscreteEulerPoincare::exp().stepper(&system, h, &NewtonOptions::default());
        for _ in 0..steps {
            stepper.step(&mut mu, &mut ()).expect("a step");
        }
        mu
    };
    let reference = |h: f64, steps: u32| {
        let mut mu = start;
        let mut stepper = Gauss6.stepper(&system, h, &NewtonOptions::default());
        for _ in 0..steps {
            stepper.step(&mut mu, &mut ()).expect("a step");
        }
        mu
    };
    let exact = run(&reference, 200);
    let errors = [32, 64, 128].map(|steps| (run(&skew, steps) - exact).amax());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.1, "{errors:?}");
    }
    // a Poisson map all the same
    let defect = poisson_defect(
        &system.lift(),
        &DiscreteEulerPoincare::exp(),
        0.3,
        start.as_slice(),
        &NewtonOptions::default(),
    );
    assert!(defect.expect("a step") < 2e-15);
}

/// A step beyond the momenta that have a velocity is refused, and what was computed before is kept.
#[test]
fn where_there_is_no_velocity_the_run_ends() {
    let run = |start: [f64; 3], h: f64| {
        let system = Bounded::new().system().expect("finite");
        let problem = Problem::new(system, start, (0.0, 20.0 * h));
        match solve(&problem, Rk4, &Options::new(h)) {
            Err(SolveError::Step { error, solution }) => Ok((error, solution)),
            Err(other) => panic!("{other}"),
            Ok(_) => Err(()),
        }
    };
    // the flow itself stays where there is one, and so do small steps
    assert!(run([0.5, 1.5, 0.9], 0.005).is_err());
    let (error, solution) = run([0.5, 1.5, 0.9], 0.2).expect("a failure");
    assert!(error.step > 1, "{error}");
    assert_eq!(solution.mu.len() as u64, error.step);
    for mu in &solution.mu {
        assert!(mu[0].abs() < 1.0 && mu.iter().all(|x| x.is_finite()));
    }
    let text = error.to_string();
    assert!(text.contains("not finite"), "{text}");
    // nor does a run begin beyond
    let (error, _) = run([1.5, 0.5, 0.9], 0.005).expect("a failure");
    assert_eq!(error.step, 1);
}
