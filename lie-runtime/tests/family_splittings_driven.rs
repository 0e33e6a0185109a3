//! Splittings of families that depend on the time and on inputs, with friction and with noise: their orders, and what they keep.

use crate::sites;
use crate::systems::daily;

use lie_runtime::family::{Family, Pieces, SplitMix, unit_spheres};
use lie_runtime::methods::{Gauss8, Method, Rk4, Stepper};
use lie_runtime::prelude::*;
use lie_runtime::{FoundPoisson, PieceFlows};
use sites::{end, largest_difference};

lie_poisson! {
    /// Spins on a ring with every kind of piece, each of which changes with the time.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 6; w = 3/2; J = [1, 1/2, -1/3, 3/4, 2/3, 1]; }
    let X = sum(i in 0..N: x[i]*(1 + t/9));
    inputs { u = 1/3; }
    hamiltonian = -sum(i in 0..N: J[i]*(1 + cos(w*t)/2)*(x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]) + u*sin(t)*z[i]*z[i+1])
        - sum(i in 0..N: cos(w*t)*x[i]^2/2 + sin(w*t)*y[i] + u*J[i]*(z[i] + t)^2/3) + X^2*sin(w*t)/N + t^2*u;
}

lie_poisson! {
    /// Masses on a ring of springs whose strength changes with the time.
    pub system Springs;
    algebra = heisenberg(1)^N;
    state q[i], p[i], unit[i];
    parameters { N = 6; }
    hamiltonian = sum(i in 0..N: p[i]^2/2 + (1 + sin(t)/2)*exp(q[i] - q[i+1]));
}

lie_poisson! {
    /// Spins with friction whose strength differs from site to site and changes with the time, and with a push.
    pub system Rubbed;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 5; k = 1/10; K = [1, 0, 1/2, 2, 1/3]; }
    inputs { v = 1/5; }
    hamiltonian = -sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1] + cos(t)*z[i]);
    forces { x[i] = -k*K[i]*x[i]; y[i] = v*sin(t) - k*(1 + K[i+1])*y[i]; z[i] = v*K[i]; }
}

lie_poisson! {
    /// Free spins with nothing but friction, the same for all coordinates.
    pub system Shrinking;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 4; k = 1/10; }
    hamiltonian = -sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + 2*z[i]*z[i+1] + z[i]);
    forces { x[i] = -k*x[i]; y[i] = -k*y[i]; z[i] = -k*z[i]; }
}

lie_poisson! {
    /// Spins with noise along directions, whose strength differs from site to site and changes with the time.
    pub system Noisy;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 6; w = 3/2; s = [1/2, 1/4, 1, 1/3, 0, 2/3]; }
    hamiltonian = -sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1] + cos(w*t)*x[i] + sin(w*t)*y[i]);
    noise { hamiltonian = s[i]*z[i]; hamiltonian = s[i+1]*cos(t)*(x[i] - 2*z[i])/3; }
}

lie_poisson! {
    /// Spins with a noise that commutes with itself.
    pub system Chain;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 3; s = [1/2, 1/4, 1]; }
    hamiltonian = -sum(i in 0..N-1: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]) - sum(i in 0..N: x[i]*cos(t));
    noise { hamiltonian = s[i]*(z[i] + x[i]/2); }
}

lie_poisson! {
    /// The same for three sites, written out.
    pub system Three;
    algebra = so(3)^3;
    state x0, y0, z0, x1, y1, z1, x2, y2, z2;
    hamiltonian = -(x0*x1 + y0*y1 + z0*z1 + x1*x2 + y1*y2 + z1*z2) - (x0 + x1 + x2)*cos(t);
    noise { hamiltonian = (z0 + x0/2)/2; hamiltonian = (z1 + x1/2)/4; hamiltonian = z2 + x2/2; }
    methods = [gauss8];
}

lie_poisson! {
    /// Momenta that a force pushes at random, whose squares grow by twice what it is by itself.
    pub system Pushed;
    algebra = heisenberg(1)^N;
    state q[i], p[i], unit[i];
    parameters { N = 4; s = [1/2, 1, 2, 0]; }
    hamiltonian = sum(i in 0..N: p[i]^2/2);
    noise { force(p[i] = s[i]*(1 + t)); }
}

/// The orders of splittings of a system, whose momentum of the time is a coordinate too.
fn have_orders<K: Pieces<f64>>(system: &Family<K>, mu: &[f64]) {
    let exact = end(system, Gauss16, mu, 0.05, 20);
    let error = |end: Vec<f64>| largest_difference(&end, &exact);
    let second = [20, 40].map(|n| error(end(system, Splitting2::new(), mu, 1.0 / f64::from(n), n)));
    let fourth = [10, 20].map(|n| error(end(system, Splitting4::new(), mu, 1.0 / f64::from(n), n)));
    for (errors, expected) in [(second, 2.0), (fourth, 4.0)] {
        let found = (errors[0] / errors[1]).log2();
        assert!(
            (found - expected).abs() < 0.4,
            "{found} {expected} {errors:?}"
        );
        assert!(errors[1] > 1e-13, "{errors:?} is round-off");
    }
    assert!(largest_difference(&exact, mu) > 0.1);
    let far = end(system, Splitting4::new(), mu, 0.2, 20);
    let back = end(system, Splitting4::new(), &far, -0.2, 20);
    assert!(largest_difference(&back, mu) < 1e-11);
}

/// How far the squares of so many spins are from what they should be.
fn worst(mu: &[f64], sites: usize, expected: f64) -> f64 {
    let squares = (0..sites).map(|i| (0..3).map(|k| mu[sites * k + i].powi(2)).sum::<f64>());
    let errors = squares.map(|square| (square / expected - 1.0).abs());
    errors.fold(0.0, f64::max)
}

/// A state at a time.
fn at<K: Pieces<f64>>(system: &Family<K>, of_sites: Vec<f64>, time: f64) -> Vec<f64> {
    let own = of_sites.len();
    let mut mu = system.state(of_sites);
    mu[own + 1] = time;
    mu
}

#[test]
fn pieces_that_change_with_the_time_have_their_orders() {
    let ring = Ring::new().system().expect("sizes");
    let mu = at(&ring, unit_spheres(6, 3, 11), 0.4);
    have_orders(&ring, &mu);
    let springs = Springs::new().system().expect("sizes");
    let mut of_sites: Vec<f64> = unit_spheres(6, 3, 11);
    of_sites[12..].fill(1.0);
    have_orders(&springs, &at(&springs, of_sites, 0.3));
    // lengths of spins stay, whatever changes
    let far = end(&ring, Splitting2::new(), &mu, 0.1, 500);
    let lost = end(&ring, Rk4, &mu, 0.1, 500);
    assert!(worst(&far, 6, 1.0) < 1e-13, "{}", worst(&far, 6, 1.0));
    assert!(
        worst(&lost, 6, 1.0) > 1e-4,
        "the control: {}",
        worst(&lost, 6, 1.0)
    );
    assert!(
        (far[19] - 50.4).abs() < 1e-11,
        "the time goes on: {}",
        far[19]
    );
}

/// Splittings are Poisson maps on the sites with the time and its momentum: H with the momentum stays where it is up to the order, without drift.
#[test]
fn energy_and_momentum_of_the_time_balance_without_drift() {
    let ring = Springs::new().system().expect("sizes");
    let mut of_sites: Vec<f64> = unit_spheres(6, 3, 11);
    of_sites[12..].fill(1.0);
    let mut mu = at(&ring, of_sites, 0.0);
    let first = ring.hamiltonian(&mu);
    let mut most = [0.0_f64; 2];
    for half in &mut most {
        for _ in 0..100 {
            mu = end(&ring, Splitting4::new(), &mu, 0.05, 20);
            *half = half.max((ring.hamiltonian(&mu) - first).abs());
        }
    }
    assert!(most[1] < 1e-4 && most[1] < 4.0 * most[0], "{most:?}");
}

#[test]
fn friction_is_a_piece() {
    let rubbed = Rubbed::new().system().expect("sizes");
    let mu = at(&rubbed, unit_spheres(5, 3, 11), 0.4);
    have_orders(&rubbed, &mu);
    // alone it is exact: one step is as good as many
    let shrinking = Shrinking::new().system().expect("sizes");
    let mu = shrinking.state(unit_spheres(4, 3, 5));
    let far = end(&shrinking, Splitting2::new(), &mu, 0.2, 100);
    let rk4 = end(&shrinking, Rk4, &mu, 0.2, 100);
    let expected = (-2.0 * 0.1 * 20.0_f64).exp();
    let error = |mu: &[f64]| worst(mu, 4, expected);
    assert!(error(&far) < 2e-13, "{}", error(&far));
    assert!(error(&rk4) > 1e-7, "the control: {}", error(&rk4));
}

/// Normal numbers.
fn normals(random: &mut SplitMix, count: usize) -> Vec<f64> {
    (0..count).map(|_| random.normal()).collect()
}

#[test]
fn noise_keeps_every_spin() {
    let noisy = Noisy {
        N: 2.0,
        s: vec![0.5, 1.0],
        ..Noisy::new()
    };
    let noisy = noisy.system().expect("sizes");
    let mut random = SplitMix::new(7);
    let (h, newton) = (0.02_f64, NewtonOptions::default());
    let mut split = noisy.state(unit_spheres(2, 3, 11));
    let mut lost = split.clone();
    let first = split.len() - noisy.noise_count();
    assert_eq!(noisy.noise_count(), 4);
    let mut splitting = Splitting2::new().stepper(&noisy, h, &newton);
    let mut rk4 = Method::<f64, _>::stepper(&Rk4, &noisy, h, &newton);
    let mut most = 0.0_f64;
    for _ in 0..daily(20_000, 100_000) {
        for (k, normal) in normals(&mut random, 4).into_iter().enumerate() {
            split[first + k] = normal / h.sqrt();
            lost[first + k] = split[first + k];
        }
        splitting.step(&mut split, &mut ()).expect("a step");
        rk4.step(&mut lost, &mut ()).expect("a step");
        most = most.max(worst(&split, 2, 1.0));
    }
    assert!(most < 2e-13, "{most:e}");
    let lost = worst(&lost, 2, 1.0);
    assert!(lost > 1e-3, "the control: {lost:e}");
}

#[test]
fn noise_that_commutes_has_strong_order_one() {
    let chain = Chain::new().system().expect("sizes");
    let three = Three::new().system().expect("constants");
    assert_eq!((chain.noise_count(), three.noise_count()), (3, 4));
    let (fine, span) = (512_usize, 1.0);
    let steps = [8_usize, 16, 32, 64];
    let mut squares = [0.0_f64; 4];
    let mut random = SplitMix::new(3);
    let newton = NewtonOptions::default();
    for path in 0..40 {
        let start: Vec<f64> = unit_spheres(3, 3, path);
        let h = span / fine as f64;
        let all = normals(&mut random, 3 * fine);
        let increments: Vec<f64> = all.into_iter().map(|n| n * h.sqrt()).collect();
        // the same motion written out, with short steps
        let mut written = three.zero_state();
        for (k, value) in start.iter().enumerate() {
            written.as_mut_slice()[k % 3 * 3 + k / 3] = *value;
        }
        written.as_mut_slice()[11] = 1.0;
        let mut reference = Gauss8.stepper(&three, h, &newton);
        for step in increments.chunks(3) {
            for (k, part) in step.iter().enumerate() {
                written.as_mut_slice()[12 + k] = part / h;
            }
            reference.step(&mut written, &mut ()).expect("a step");
        }
        for (sum, count) in squares.iter_mut().zip(steps) {
            let h = span / count as f64;
            let mut mu = chain.state(start.clone());
            let mut stepper = Splitting2::new().stepper(&chain, h, &newton);
            for part in increments.chunks(3 * fine / count) {
                for k in 0..3 {
                    let whole: f64 = part.iter().skip(k).step_by(3).sum();
                    mu[12 + k] = whole / h;
                }
                stepper.step(&mut mu, &mut ()).expect("a step");
            }
            for (k, one) in mu.iter().enumerate().take(9) {
                let other = written.as_slice()[k % 3 * 3 + k / 3];
                *sum += (one - other).powi(2);
            }
        }
    }
    let errors = squares.map(|sum| (sum / 40.0).sqrt());
    let slope = (errors[0] / errors[3]).log2() / 3.0;
    assert!((slope - 1.0).abs() < 0.2, "{slope} {errors:?}");
    assert!(errors[3] > 1e-4 && errors[0] < 0.3, "{errors:?}");
}

#[test]
fn noise_as_a_force_pushes() {
    let pushed = Pushed::new().system().expect("sizes");
    let mut of_sites = vec![0.0; 12];
    of_sites[4..8].fill(1.0);
    of_sites[8..].fill(1.0);
    let mut mu = at(&pushed, of_sites, 0.5);
    let rates = [1.0, -2.0, 0.5, 3.0];
    mu[15..].copy_from_slice(&rates);
    let end = end(&pushed, Splitting2::new(), &mu, 0.1, 1);
    for (i, (rate, s)) in rates.iter().zip([0.5, 1.0, 2.0, 0.0]).enumerate() {
        // the strength is that of the middle of the step
        let expected = 1.0 + 0.1 * s * 1.55 * rate;
        assert!((end[4 + i] - expected).abs() < 1e-15, "{i}");
        // half of the motion before the push and half behind it
        let moved = 0.05 * (1.0 + expected);
        assert!(
            (end[i].abs() - moved).abs() < 1e-15,
            "{i} {} {moved}",
            end[i]
        );
    }
    // noise does no work
    assert_eq!(end[12], mu[12]);
    assert_eq!(FoundPoisson::<f64>::found(&pushed).pieces(), 3);
}
