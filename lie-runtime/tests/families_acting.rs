//! What acts on the sites of a family: the same systems as one algebra of all their coordinates, and what damping and noise keep.

use crate::sites;

use lie_runtime::methods::{Gauss8, Gauss16, Method, Rk4, Stepper};
use lie_runtime::prelude::*;
use sites::{end, largest_difference};

lie_poisson! {
    /// Spins on an open chain with everything that may act on a site.
    pub system Chain;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 3; J = 1; a = 1/10; T = 1/4; k = 1/50; B = [1, 1/2, -1/3]; }
    hamiltonian = -J*sum(i in 0..N-1: x[i]*x[i+1] + 2*y[i]*y[i+1] + z[i]*z[i+1]) - sum(i in 0..N: B[i]*z[i]);
    forces { x[i] = -k*(x[i] - x[i+1]); z[i] = -k*B[i+1]*z[i]; }
    dissipation {
        double-bracket(strength = a, metric = [[1, 0, 1/4], [0, 2, 0], [1/4, 0, 1]], temperature = T);
        rayleigh(matrix = [[k, 0, 0], [0, k, 0], [0, 0, 2*k]]);
    }
    noise { hamiltonian = sin(x[i])/5; force(y[i] = x[i]/8); }
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// The same for three sites, written out.
    pub system Three;
    algebra = so(3)^3;
    state x0, y0, z0, x1, y1, z1, x2, y2, z2;
    parameters { J = 1; a = 1/10; T = 1/4; k = 1/50; }
    hamiltonian = -J*(x0*x1 + 2*y0*y1 + z0*z1 + x1*x2 + 2*y1*y2 + z1*z2) - z0 - z1/2 + z2/3;
    forces {
        x0 = -k*(x0 - x1); x1 = -k*(x1 - x2); x2 = -k*(x2 - x0);
        z0 = -k*z0/2; z1 = k*z1/3; z2 = -k*z2;
    }
    dissipation {
        double-bracket(strength = a, metric = [
            [1, 0, 1/4, 0, 0, 0, 0, 0, 0], [0, 2, 0, 0, 0, 0, 0, 0, 0], [1/4, 0, 1, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, 1, 0, 1/4, 0, 0, 0], [0, 0, 0, 0, 2, 0, 0, 0, 0], [0, 0, 0, 1/4, 0, 1, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, 1, 0, 1/4], [0, 0, 0, 0, 0, 0, 0, 2, 0], [0, 0, 0, 0, 0, 0, 1/4, 0, 1]
        ], temperature = T);
        rayleigh(matrix = [
            [k, 0, 0, 0, 0, 0, 0, 0, 0], [0, k, 0, 0, 0, 0, 0, 0, 0], [0, 0, 2*k, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, k, 0, 0, 0, 0, 0], [0, 0, 0, 0, k, 0, 0, 0, 0], [0, 0, 0, 0, 0, 2*k, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, k, 0, 0], [0, 0, 0, 0, 0, 0, 0, k, 0], [0, 0, 0, 0, 0, 0, 0, 0, 2*k]
        ]);
    }
    noise {
        hamiltonian = sin(x0)/5; hamiltonian = sin(x1)/5; hamiltonian = sin(x2)/5;
        force(y0 = x0/8); force(y1 = x1/8); force(y2 = x2/8);
    }
    methods = [gauss8];
}

lie_poisson! {
    /// Spins on a ring that damping alone acts on.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 40; a = 1/10; T = 0; }
    hamiltonian = -sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1] + z[i]/2);
    dissipation { double-bracket(strength = a, temperature = T); }
    initial = random(unit-sphere, 1);
}

/// The place in the state of [`Three`] of each number of the state of [`Chain`].
fn places() -> Vec<usize> {
    let coordinates = (0..9).map(|place| place % 3 * 3 + place / 3);
    // the momentum of the time, the time, the unit
    let carried = 9..12;
    // the noise of a dissipation has a process for each coordinate, the others one for each entry
    let warm = (0..9).map(|place| 12 + place % 3 * 3 + place / 3);
    let entries = 21..27;
    coordinates
        .chain(carried)
        .chain(warm)
        .chain(entries)
        .collect()
}

#[test]
fn what_acts_on_three_sites_is_what_acts_on_one_system() {
    let family = Chain::new().system().expect("sizes");
    let three = Three::new().system().expect("constants");
    // one system has a coin behind its noises
    assert_eq!(family.dimension() + 1, three.dimension());
    assert!(three.tosses_coin() && !family.tosses_coin());
    assert_eq!((family.noise_count(), three.noise_count()), (15, 16));
    let places = places();
    let (mut moved, mut rates) = (0.0_f64, 0.0_f64);
    for seed in 0..20 {
        let mut state: Vec<f64> = lie_runtime::family::unit_spheres(9, 3, seed);
        state[11] = 1.0;
        let mut written = three.zero_state();
        for (place, value) in places.iter().zip(&state) {
            written.as_mut_slice()[*place] = *value;
        }
        let (mut field, mut expected) = (state.clone(), three.zero_state());
        family.vector_field(&state, &mut field);
        three.vector_field(&written, &mut expected);
        for (k, place) in places.iter().enumerate() {
            let (field, expected) = (field[k], expected.as_slice()[*place]);
            assert!((field - expected).abs() < 3e-15, "{k}: {field} {expected}");
        }
        moved = moved.max(field[9].abs());
        let extended = family.energy(&state) + state[9];
        assert_eq!(family.hamiltonian(&state), extended);
        assert!((family.energy(&state) - three.energy(&written)).abs() < 2e-15);
        // the control: noise is a part of the field
        state[12..].fill(0.0);
        let mut quiet = state.clone();
        family.vector_field(&state, &mut quiet);
        rates = rates.max(largest_difference(&quiet[..9], &field[..9]));
        assert_eq!(quiet[9], field[9], "noise does no work");
    }
    assert!(moved > 0.1 && rates > 0.1, "{moved} {rates}");
}

#[test]
fn steps_of_both_are_the_same() {
    let family = Chain::new().system().expect("sizes");
    let three = Three::new().system().expect("constants");
    let mut start = Chain::new().initial_state().expect("a seed");
    let rates = start[12..].iter_mut().zip(0_u8..);
    rates.for_each(|(rate, k)| *rate = (1.7 * f64::from(k)).sin());
    let places = places();
    let mut written = three.zero_state();
    for (place, value) in places.iter().zip(&start) {
        written.as_mut_slice()[*place] = *value;
    }
    let of_family = end(&family, Gauss8, &start, 0.1, 50);
    let mut stepper = Gauss8.stepper(&three, 0.1, &NewtonOptions::default());
    for _ in 0..50 {
        stepper.step(&mut written, &mut ()).expect("a step");
    }
    for (k, place) in places.iter().enumerate().take(10) {
        let (value, expected) = (of_family[k], written.as_slice()[*place]);
        assert!((value - expected).abs() < 2e-13, "{k}: {value} {expected}");
    }
    assert!(largest_difference(&of_family[..9], &start[..9]) > 0.1);
}

#[test]
fn damping_keeps_every_spin_and_the_balance_and_lowers_the_energy() {
    let ring = Ring::new().system().expect("sizes");
    let start = Ring::new().initial_state().expect("a seed");
    let casimirs = |mu: &Vec<f64>| {
        let mut values = [0.0; 3];
        ring.casimirs(mu, &mut values);
        values
    };
    let run = |method: &dyn Fn(&Vec<f64>) -> Vec<f64>| {
        let (mut mu, mut energy) = (start.clone(), ring.energy(&start));
        let first = energy;
        for _ in 0..40 {
            mu = method(&mu);
            let next = ring.energy(&mu);
            assert!(next < energy, "{next} {energy}");
            energy = next;
        }
        let mut work = [0.0];
        ring.quantities(&mu, &mut work);
        let length = casimirs(&mu)
            .into_iter()
            .map(|c| (c - 1.0).abs())
            .fold(0.0, f64::max);
        (
            length,
            (energy - first - work[0]).abs() / first.abs(),
            energy / first,
        )
    };
    let gauss = run(&|mu| end(&ring, Gauss16::new(), mu, 0.05, 5));
    let rk4 = run(&|mu| end(&ring, Rk4, mu, 0.05, 5));
    assert!(gauss.0 < 4e-15 && gauss.1 < 1e-12, "{gauss:?}");
    assert!(gauss.2.abs() > 2.0, "the energy falls by much: {gauss:?}");
    assert!(rk4.0 > 1e-7 && rk4.1 > 1e-8, "the control: {rk4:?}");
}
