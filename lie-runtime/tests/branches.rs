//! Lagrangians that are not convex: several velocities with one momentum.

use crate::systems;

use lie_runtime::lagrangian::legendre;
use lie_runtime::prelude::*;
use nalgebra::SVector;
use systems::folded::Folded;

type V = SVector<f64, 3>;

/// The first velocity of a momentum between two others, by bisection.
fn bisected(momentum: f64, mut low: f64, mut high: f64) -> f64 {
    let map = |u: f64| u - u.powi(3) + 0.3 * u.powi(5);
    let rising = map(low) < map(high);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if (map(middle) < momentum) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

fn velocity(system: &Folded<f64>, x: f64) -> f64 {
    let mut xi = V::zeros();
    legendre::velocity(system, &[x, 0.9, 0.8].into(), &mut xi);
    xi[0]
}

/// The Euler–Poincaré equations in the velocity, `l'' xi' = ad*_xi l'`, by the classical method with small steps: no
/// Legendre transform.
fn in_velocities(start: V, until: f64, steps: u32) -> V {
    let system = Folded::<f64>::default();
    let h = until / f64::from(steps);
    let field = |xi: &V| {
        let mut out = *xi;
        system.euler_poincare(xi, &mut out);
        out
    };
    let mut xi = start;
    for _ in 0..steps {
        let k1 = field(&xi);
        let k2 = field(&(xi + k1 * (0.5 * h)));
        let k3 = field(&(xi + k2 * (0.5 * h)));
        let k4 = field(&(xi + k3 * h));
        xi += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
    }
    xi
}

#[test]
fn velocities_beside_between_and_behind_folds() {
    let system = Folded::default();
    // the branch through rest, and behind both folds where it is the only one
    for x in [0.0, 0.2, 0.3, -0.4, 0.409] {
        let expected = bisected(x, -0.65, 0.65);
        assert!((velocity(&system, x) - expected).abs() < 1e-12, "{x}");
    }
    for x in [0.42, 0.5, 0.83, 0.97, 1.0, 1.03, 2.0, 40.0, 1e6] {
        let expected = bisected(x, 1.2564, 30.0);
        let found = velocity(&system, x);
        assert!((found - expected).abs() < 1e-14 * expected, "{x}: {found}");
        let found = velocity(&system, -x);
        assert!((found + expected).abs() < 1e-14 * expected, "-{x}: {found}");
    }
    // along a branch the other velocity, as far as it goes
    let outer = Folded(Some([1.7, 0.45, 0.26].into()));
    for x in [0.22, 0.3, 0.41, 1.0, 7.0] {
        let expected = bisected(x, 1.2564, 30.0);
        assert!((velocity(&outer, x) - expected).abs() < 1e-12, "{x}");
    }
    for x in [0.21, 0.0, -0.5] {
        assert!(velocity(&outer, x).is_nan(), "{x}");
    }
}

#[test]
fn runs_stay_on_their_branch() {
    // beyond the folds all the time; through momenta that belong to three velocities
    for (start, between) in [([1.0, 0.9, 0.8], false), ([0.5, 1.9, 1.5], true)] {
        let u = bisected(start[0], 1.2564, 20.0);
        let first = V::from([u, start[1] / 2.0, start[2] / 3.0]);
        let until = 4.0;
        let exact = in_velocities(first, until, 40_000);
        let problem = Problem::new(Folded::default(), start, (0.0, until));
        let mut least = f64::INFINITY;
        let run = |h: f64| solve(&problem, Gauss6, &Options::new(h)).expect("a regular solution");
        let solution = run(0.05);
        for mu in &solution.mu {
            least = least.min(mu[0]);
        }
        assert_eq!(least < 0.4, between, "{least}");
        let mut end = V::zeros();
        Folded::<f64>::default().momentum(&exact, &mut end);
        let error = (solution.mu.last().expect("a row") - end).amax();
        assert!(error < 1e-7, "{start:?}: {error:e}");
        assert!(solution.drift().energy.max < 1e-7);
        // the same bits again, and with rows off the grid between
        let times: Vec<f64> = (0..=60).map(|k| f64::from(k) * until / 60.0).collect();
        let options = Options::new(0.05).save(Save::At(times));
        let rows = solve(&problem, Gauss6, &options).expect("a regular solution");
        assert_eq!(rows.mu.last(), solution.mu.last());
        for (t, mu) in rows.t.iter().zip(&rows.mu) {
            let xi = in_velocities(first, *t, 1000);
            Folded::<f64>::default().momentum(&xi, &mut end);
            assert!((mu - end).amax() < 1e-7, "{t}");
        }
    }
}

/// Where the branch ends the step is refused; it does not jump to another one.
#[test]
fn a_run_ends_with_its_branch() {
    let start = [0.5, 3.0, 2.5];
    let problem = Problem::new(Folded::default(), start, (0.0, 40.0));
    let error = solve(&problem, Gauss4, &Options::new(0.01)).expect_err("it meets the fold");
    let solution = error.solution().expect("rows");
    let last = solution.mu.last().expect("a row");
    assert!(solution.t.len() > 10, "{}", solution.t.len());
    assert!((last[0] - 0.213).abs() < 0.02, "{last:?}");
    assert!(solution.drift().energy.max < 1e-5);
}

/// Every lane has the bits of a run of its own, whichever way its path takes.
#[test]
fn lanes() {
    let momenta = [0.3, 1.0, -0.97, 0.45];
    let mut mu = SVector::<F64x4, 3>::repeat(F64x4::from_f64(0.7));
    for (lane, x) in momenta.into_iter().enumerate() {
        mu[0] = mu[0].with_lane(lane, x);
    }
    let mut xi = mu;
    legendre::velocity(&Folded::default(), &mu, &mut xi);
    for (lane, x) in momenta.into_iter().enumerate() {
        let mut alone = V::zeros();
        legendre::velocity(&Folded::default(), &[x, 0.7, 0.7].into(), &mut alone);
        for k in 0..3 {
            assert_eq!(xi[k].lane(lane), alone[k], "{x}");
        }
    }
}

/// The derivative of the velocity by the momentum is the inverse of l'', behind folds too.
#[test]
fn derivatives_behind_folds() {
    let system = Folded::<Dual<f64>>::default();
    let mut mu = SVector::from([1.0, 0.9, 0.8]).map(Dual::constant_of);
    mu[0].derivative = 1.0;
    let mut xi = mu;
    legendre::velocity(&system, &mu, &mut xi);
    let u = xi[0].value;
    let slope = 1.0 - 3.0 * u * u + 1.5 * u.powi(4);
    assert!((xi[0].derivative - 1.0 / slope).abs() < 1e-14);
    assert!(xi[1].derivative.abs() < 1e-15);
}
