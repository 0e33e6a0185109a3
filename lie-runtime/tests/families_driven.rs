//! Families that depend on the time and on inputs: the same systems as one algebra of all their coordinates, orders, and the balance of the work.

use std::sync::Arc;

use crate::sites::{end, largest_difference};
use lie_runtime::methods::{CommutatorFree4, Gauss8, Gauss16, Method, Rk4, Rkmk4, Stepper};
use lie_runtime::prelude::*;

lie_poisson! {
    /// Spins on an open chain in a rotating field, with an exchange that somebody sets, friction and damping.
    pub system Chain;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 3; a = 1/10; k = 1/50; w = 3/2; B = [1, 1/2, -1/3]; }
    let R = cos(w*t)/2;
    inputs { u = 1/3, sampling = 1/4; v = 1; }
    hamiltonian = -sum(i in 0..N-1: (1 + u)*x[i]*x[i+1] + 2*y[i]*y[i+1] + z[i]*z[i+1])
        - sum(i in 0..N: R*x[i] + sin(w*t)/2*y[i] + B[i]*cos(t)*z[i]) + t^2*u;
    forces { x[i] = -k*cos(t)*(x[i] - x[i+1]); z[i] = v/20; }
    dissipation { double-bracket(strength = a); }
    observables { m = u*sum(i in 0..N: z[i]) + t; }
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// The same for three sites, written out.
    pub system Three;
    algebra = so(3)^3;
    state x0, y0, z0, x1, y1, z1, x2, y2, z2;
    parameters { a = 1/10; k = 1/50; w = 3/2; }
    inputs { u = 1/3, sampling = 1/4; v = 1; }
    hamiltonian = -((1 + u)*(x0*x1 + x1*x2) + 2*y0*y1 + z0*z1 + 2*y1*y2 + z1*z2)
        - cos(w*t)/2*(x0 + x1 + x2) - sin(w*t)/2*(y0 + y1 + y2) - cos(t)*(z0 + z1/2 - z2/3) + t^2*u;
    forces {
        x0 = -k*cos(t)*(x0 - x1); x1 = -k*cos(t)*(x1 - x2); x2 = -k*cos(t)*(x2 - x0);
        z0 = v/20; z1 = v/20; z2 = v/20;
    }
    dissipation { double-bracket(strength = a); }
    observables { m = u*(z0 + z1 + z2) + t; }
    methods = [gauss8, gauss16, rk4, cf4, rkmk4];
}

lie_poisson! {
    /// Spins on a ring in a rotating field, on which nothing else acts.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 20; w = 3/2; }
    hamiltonian = -sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1] + cos(w*t)*x[i] + sin(w*t)*y[i]);
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// Free spins with a damping of their own that changes with the time.
    pub system Damped;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 3; a = [1/10, 0, 1/3]; }
    inputs { u = 2; }
    hamiltonian = -sum(i in 0..N: z[i]);
    dissipation { double-bracket(strength = u*a[i]*(1 + cos(t)/2)); }
}

lie_poisson! {
    /// The same, with what the damping is as a force.
    pub system Pushed;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 3; a = [1/10, 0, 1/3]; }
    let c = 1 + cos(t)/2;
    inputs { u = 2; }
    hamiltonian = -sum(i in 0..N: z[i]);
    forces {
        x[i] = -u*a[i]*c*x[i]*z[i]; y[i] = -u*a[i]*c*y[i]*z[i]; z[i] = u*a[i]*c*(x[i]^2 + y[i]^2);
    }
}

/// The place in the state of [`Three`] of each number of the state of [`Chain`].
fn places() -> Vec<usize> {
    let coordinates = (0..9).map(|place| place % 3 * 3 + place / 3);
    coordinates.chain(9..14).collect()
}

/// The state of [`Three`] for one of [`Chain`].
fn written(state: &[f64]) -> <ThreeSystem as Poisson<f64>>::State {
    let mut written = Three::new().system().expect("constants").zero_state();
    for (place, value) in places().iter().zip(state) {
        written.as_mut_slice()[*place] = *value;
    }
    written
}

/// How far a state of both is apart.
fn apart(of_family: &[f64], of_three: &impl State<f64>) -> f64 {
    let three: Vec<f64> = places().iter().map(|k| of_three.as_slice()[*k]).collect();
    largest_difference(of_family, &three)
}

/// A state of the chain at a time, with values of its inputs.
fn start(seed: u64, time: f64, inputs: [f64; 2]) -> Vec<f64> {
    let chain = Chain::new().system().expect("sizes");
    let mut state = chain.state(lie_runtime::family::unit_spheres(3, 3, seed));
    assert_eq!(state[9..], [0.0, 0.0, 1.0, 1.0 / 3.0, 1.0]);
    state[10] = time;
    state[12..].copy_from_slice(&inputs);
    state
}

#[test]
fn three_sites_are_one_system() {
    let (chain, three) = (
        Chain::new().system().expect("sizes"),
        Three::new().system().expect("constants"),
    );
    assert_eq!(chain.dimension(), three.dimension());
    assert_eq!((chain.input_count(), three.input_count()), (2, 2));
    assert_eq!(chain.clock(), three.clock());
    assert!(!chain.is_autonomous() && !three.is_autonomous());
    let names = |k: usize| [chain.quantity_name(k), three.quantity_name(k)].map(str::to_owned);
    assert_eq!(chain.quantity_count(), 4);
    for k in 0..4 {
        let [one, other] = names(k);
        assert_eq!(one, other);
    }
    let mut moved = 0.0_f64;
    for seed in 0..20 {
        let time = (seed as f64).sin() * 3.0;
        let state = start(seed, time, [0.3 * time, 0.7 - time]);
        let other = written(&state);
        let (mut field, mut expected) = (state.clone(), three.zero_state());
        chain.vector_field(&state, &mut field);
        three.vector_field(&other, &mut expected);
        assert!(apart(&field, &expected) < 1e-14, "{seed}");
        moved = moved.max(field[9].abs());
        chain.gradient(&state, &mut field);
        three.gradient(&other, &mut expected);
        assert!(apart(&field, &expected) < 1e-14, "{seed}");
        assert!((chain.energy(&state) - three.energy(&other)).abs() < 1e-14);
        let (mut recorded, mut theirs) = ([0.0; 4], [0.0; 4]);
        chain.quantities(&state, &mut recorded);
        three.quantities(&other, &mut theirs);
        assert!(largest_difference(&recorded, &theirs) < 1e-14, "{seed}");
        // the control: the time and the inputs are in all of it
        for place in [10, 12, 13] {
            let mut later = state.clone();
            later[place] += 0.5;
            let mut other = state.clone();
            chain.vector_field(&later, &mut other);
            chain.vector_field(&state, &mut field);
            assert!(largest_difference(&field, &other) > 1e-3, "{place}");
        }
    }
    assert!(moved > 0.1, "{moved}");
}

/// The end of the chain written out, after so many steps.
fn end_of_three<M: Method<f64, ThreeSystem>>(
    method: M,
    state: &[f64],
    h: f64,
    steps: u32,
) -> Vec<f64> {
    let three = Three::new().system().expect("constants");
    let mut mu = written(state);
    let mut stepper = method.stepper(&three, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    places().iter().map(|k| mu.as_slice()[*k]).collect()
}

#[test]
fn steps_of_both_are_the_same() {
    let chain = Chain::new().system().expect("sizes");
    let state = start(1, 0.4, [0.2, 0.9]);
    let gauss = end(&chain, Gauss8, &state, 0.1, 50);
    let difference = largest_difference(&gauss, &end_of_three(Gauss8, &state, 0.1, 50));
    assert!(difference < 1e-13, "{difference}");
    let rk4 = end(&chain, Rk4, &state, 0.1, 50);
    let difference = largest_difference(&rk4, &end_of_three(Rk4, &state, 0.1, 50));
    assert!(difference < 1e-13, "{difference}");
    assert!(largest_difference(&rk4, &gauss) > 1e-6, "the control");
    // the time goes on, and inputs stay
    assert!((gauss[10] - 5.4).abs() < 1e-13 && gauss[12..] == state[12..]);
}

#[test]
fn methods_of_groups_for_one_system_go_to_the_ends_of_the_family() {
    let chain = Chain::new().system().expect("sizes");
    let state = start(1, 0.4, [0.2, 0.9]);
    let exact = end(&chain, Gauss16::new(), &state, 0.05, 40);
    let errors = |end: &dyn Fn(f64, u32) -> Vec<f64>| {
        [20_u32, 40, 80].map(|steps| {
            let end = end(2.0 / f64::from(steps), steps);
            // the work is a coordinate, too
            largest_difference(&end, &exact)
        })
    };
    let ends: [&dyn Fn(f64, u32) -> Vec<f64>; 4] = [
        &|h, steps| end_of_three(CommutatorFree4, &state, h, steps),
        &|h, steps| end_of_three(Rkmk4, &state, h, steps),
        &|h, steps| end(&chain, Rk4, &state, h, steps),
        &|h, steps| end_of_three(Rk4, &state, h, steps),
    ];
    for end in ends {
        let [coarse, middle, fine] = errors(end);
        let slopes = [(coarse / middle).log2(), (middle / fine).log2()];
        assert!(
            slopes.iter().all(|slope| (3.6..4.7).contains(slope)),
            "{slopes:?}"
        );
        assert!(fine < 1e-5, "{fine}");
    }
}

#[test]
fn the_energy_changes_by_the_work() {
    let chain = Chain::new().system().expect("sizes");
    let run = |method: &dyn Fn(&[f64]) -> Vec<f64>| {
        let mut mu = start(1, 0.0, [0.2, 0.9]);
        let (first, mut most) = (chain.energy(&mu), 0.0_f64);
        let mut reached = 0.0_f64;
        for _ in 0..200 {
            mu = method(&mu);
            let energy = chain.energy(&mu);
            let mut recorded = [0.0; 4];
            chain.quantities(&mu, &mut recorded);
            most = most.max((energy - first - recorded[0]).abs() / energy.abs().max(1.0));
            reached = reached.max(recorded[0].abs());
        }
        (most, reached)
    };
    let (gauss, work) = run(&|mu| end(&chain, Gauss16::new(), mu, 0.05, 10));
    assert!(gauss < 2e-13 && work > 1.0, "{gauss} {work}");
    let (rk4, _) = run(&|mu| end(&chain, Rk4, mu, 0.05, 10));
    assert!(rk4 > 1e-8, "the control: {rk4}");
}

#[test]
fn a_field_that_rotates_is_at_rest_in_a_frame_that_does() {
    // mu = R(w t) nu: nu moves by H at t = 0 with w times the sum of z, which is constant
    let ring = Ring::new().system().expect("sizes");
    let mut mu = Ring::new().initial_state().expect("a seed");
    assert_eq!((mu.len(), ring.quantity_count()), (63, 0));
    let kept = |mu: &Vec<f64>| ring.energy(mu) + 1.5 * mu[40..60].iter().sum::<f64>();
    let (first, start) = (kept(&mu), ring.energy(&mu));
    let whole = ring.hamiltonian(&mu);
    let (mut most, mut varies) = (0.0_f64, 0.0_f64);
    for _ in 0..50 {
        mu = end(&ring, Gauss16::new(), &mu, 0.1, 5);
        most = most.max((kept(&mu) - first).abs());
        varies = varies.max((ring.energy(&mu) - start).abs());
    }
    assert!(most < 1e-12 && varies > 0.5, "{most} {varies}");
    assert!((ring.hamiltonian(&mu) - whole).abs() < 1e-12);
}

#[test]
fn tables_and_closures_set_what_all_sites_share() {
    let chain = Chain::new().system().expect("sizes");
    let three = Three::new().system().expect("constants");
    let state = start(1, 0.0, [1.0 / 3.0, 1.0]);
    let options = Options::new(0.05);
    let sources = || {
        let table = Source::Table {
            times: [0.0, 0.42, 1.0, 1.3].into(),
            values: [0.5, -0.5, 1.0, 0.0].into(),
        };
        let closure = Source::Controller(Arc::new(|time: f64, mu: &[f64], _: &[f64]| {
            (2.0 * time).sin() + mu[0]
        }));
        [table, closure]
    };
    let [table, closure] = sources();
    let held = Held::of(&chain, 0.0, (1, &[0])).expect("inputs");
    let held = held.with(0, table).with(1, closure);
    let problem = Problem::new(chain.clone(), state.clone(), (0.0, 2.0));
    let of_family = solve_observed(&problem, Gauss8, &options, held).expect("a run");
    let [table, closure] = sources();
    let held = Held::of(&three, 0.0, (1, &[0])).expect("inputs");
    let held = held.with(0, table).with(1, closure);
    let problem = Problem::new(three, written(&state), (0.0, 2.0));
    let of_three = solve_observed(&problem, Gauss8, &options, held).expect("a run");
    assert_eq!(of_family.t.len(), of_three.t.len());
    for (one, other) in of_family.mu.iter().zip(&of_three.mu) {
        assert!(apart(one, other) < 1e-12);
    }
    let last = of_family.mu.last().expect("rows");
    let balance = chain.hamiltonian(last) - chain.hamiltonian(&of_family.mu[0]);
    assert!(balance.abs() < 1e-11, "{balance}");
    // the control: without sources they are at their defaults
    let problem = Problem::new(chain, state, (0.0, 2.0));
    let plain = solve(&problem, Gauss8, &options).expect("a run");
    assert!(largest_difference(plain.mu.last().expect("rows"), last) > 0.1);
}

#[test]
fn a_strength_differs_from_site_to_site_and_with_the_time() {
    let damped = Damped::new().system().expect("sizes");
    let pushed = Pushed::new().system().expect("sizes");
    assert!(damped.is_damped() && pushed.is_forced() && damped.is_autonomous());
    let mut state = damped.state(lie_runtime::family::unit_spheres(3, 3, 5));
    let mut fields = [state.clone(), state.clone(), state.clone()];
    for time in [0.0, 1.0, 3.0] {
        state[10] = time;
        damped.vector_field(&state, &mut fields[0]);
        pushed.vector_field(&state, &mut fields[1]);
        assert!(largest_difference(&fields[0], &fields[1]) < 1e-15);
        assert!(fields[0][9] > 0.05, "the damping takes energy");
        // the control: half of the input damps half as much
        state[12] = 1.0;
        damped.vector_field(&state, &mut fields[2]);
        assert!((fields[2][9] - fields[0][9] / 2.0).abs() < 1e-15);
        state[12] = 2.0;
        // the second spin turns alone
        let [x, y] = [state[1], state[4]];
        assert_eq!([fields[0][1], fields[0][4], fields[0][7]], [-y, x, 0.0]);
    }
}
