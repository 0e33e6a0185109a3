//! The Euler equations on the sphere: what is known exactly, and what is kept.

use lie_dense::{MatrixFlow, SkewHermitian, SpectrumMonitor, SphereEuler, StreamMap, spectrum};
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Options, Save, Solution, solve, solve_observed};
use lie_runtime::methods::{Compose4, Isospectral2, Method, Rk4};
use lie_runtime::{Poisson, State, Unknown};

type Flow = MatrixFlow<SphereEuler>;
type Harmonic = (usize, usize, (f64, f64));

fn sphere(size: usize) -> SphereEuler {
    SphereEuler::new(size).unwrap()
}

fn distance(one: &SkewHermitian, other: &SkewHermitian) -> f64 {
    let mut difference = one.clone();
    difference.axpy(-1.0, other);
    difference.max_norm()
}

fn run(
    size: usize,
    start: &[Harmonic],
    method: impl Method<f64, Flow>,
    step: f64,
    end: f64,
) -> Solution<f64, SkewHermitian> {
    let map = sphere(size);
    let w = map.vorticity(start).unwrap();
    let problem = MatrixFlow::new(map).problem(w, (0.0, end)).unwrap();
    let options = Options::new(step).save(Save::Ends);
    solve(&problem, method, &options).unwrap()
}

#[test]
fn harmonics_are_eigenmatrices_of_the_laplacian() {
    for (size, degree, order) in [
        (2, 1, 0),
        (2, 1, 1),
        (9, 8, 8),
        (24, 5, 3),
        (65, 60, 2),
        (65, 7, 7),
    ] {
        let map = sphere(size);
        let w = map.vorticity(&[(degree, order, (0.3, 0.4))]).unwrap();
        let mut p = SkewHermitian::zeros(size);
        map.stream(&w, &mut p);
        let scale = -((degree * (degree + 1)) as f64) * map.hbar();
        for value in p.as_mut_slice() {
            *value *= scale;
        }
        let error = distance(&p, &w) / w.max_norm();
        assert!(error < 1e-12, "N = {size}, ({degree}, {order}): {error:e}");
        // the control: one degree off
        let wrong = (degree as f64 + 2.0) / degree as f64;
        assert!((wrong - 1.0).abs() > 1e-3);
        let norm = w.inner(&w) / size as f64;
        let expected = if order == 0 { 0.09 } else { 2.0 * 0.25 };
        assert!((norm - expected).abs() < 1e-12, "{norm}");
    }
}

#[test]
fn products_of_first_degrees_are_those_of_rotations() {
    // [T_x, T_y] over hbar is that of the Poisson bracket {x, y} = z of coordinates: the field of a rigid rotation vanishes,
    // and two rotations about different axes turn each other
    let map = sphere(12);
    let w = map
        .vorticity(&[(1, 0, (0.4, 0.0)), (1, 1, (0.3, -0.2))])
        .unwrap();
    let flow = MatrixFlow::new(map);
    let mut field = flow.zero_state();
    flow.vector_field(&w, &mut field);
    assert!(
        field.max_norm() < 1e-13 * w.max_norm(),
        "{:e}",
        field.max_norm()
    );
    let other = flow
        .map()
        .vorticity(&[(1, 0, (0.4, 0.0)), (2, 1, (0.3, -0.2))])
        .unwrap();
    flow.vector_field(&other, &mut field);
    assert!(field.max_norm() > 1e-2 * w.max_norm());
}

#[test]
fn zonal_flows_stay() {
    let zonal = [(1, 0, (0.7, 0.0)), (3, 0, (-0.4, 0.0)), (6, 0, (0.2, 0.0))];
    let solution = run(16, &zonal, Isospectral2::new(), 0.05, 5.0);
    assert!(distance(&solution.mu[0], &solution.mu[1]) < 1e-13);
    // the control: a ripple on it
    let ripple = [zonal[0], zonal[1], zonal[2], (4, 2, (0.1, 0.0))];
    let solution = run(16, &ripple, Isospectral2::new(), 0.05, 5.0);
    assert!(distance(&solution.mu[0], &solution.mu[1]) > 1e-2);
}

#[test]
fn one_degree_stays_in_any_direction_to_the_order_of_the_method() {
    let harmonics = [(4, 0, (0.3, 0.0)), (4, 1, (0.2, -0.5)), (4, 3, (0.1, 0.3))];
    let moved = [0.05, 0.025].map(|h| {
        let solution = run(20, &harmonics, Isospectral2::new(), h, 2.0);
        distance(&solution.mu[0], &solution.mu[1])
    });
    assert!(
        moved[0] < 1e-3 && (moved[0] / moved[1] - 4.0).abs() < 0.2,
        "{moved:?}"
    );
    // with a field that vanishes
    let flow = MatrixFlow::new(sphere(20));
    let mut field = flow.zero_state();
    let w = flow.map().vorticity(&harmonics).unwrap();
    flow.vector_field(&w, &mut field);
    assert!(field.max_norm() < 1e-12, "{:e}", field.max_norm());
    // the control: one of another degree among them
    let mixed = [harmonics[0], harmonics[1], (5, 3, harmonics[2].2)];
    let solution = run(20, &mixed, Isospectral2::new(), 0.05, 5.0);
    assert!(distance(&solution.mu[0], &solution.mu[1]) > 1e-2);
}

/// The error of a Rossby–Haurwitz wave on a rotation, whose coefficient turns by `m Omega (1 - 2/(l (l+1))) t`, when it is
/// compared with a wave of another degree.
fn wave_error(method: impl Method<f64, Flow>, step: f64, compared: f64) -> f64 {
    let (omega, degree, order, end) = (0.8, 4_usize, 3_usize, 4.0);
    let start = [
        (1, 0, (2.0 * omega / 3.0_f64.sqrt(), 0.0)),
        (degree, order, (0.5, 0.2)),
    ];
    let solution = run(16, &start, method, step, end);
    let (re, im) = sphere(16)
        .coefficient(&solution.mu[1], degree, order)
        .unwrap();
    let angle = -(order as f64) * omega * (1.0 - 2.0 / (compared * (compared + 1.0))) * end;
    let expected = (
        0.5 * angle.cos() - 0.2 * angle.sin(),
        0.5 * angle.sin() + 0.2 * angle.cos(),
    );
    (re - expected.0).hypot(im - expected.1)
}

#[test]
fn rossby_haurwitz_waves_turn_with_their_frequency() {
    let errors = [0.02, 0.01, 0.005].map(|h| wave_error(Isospectral2::new(), h, 4.0));
    for pair in errors.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        assert!((slope - 2.0).abs() < 0.05, "{errors:?}");
    }
    assert!(errors[2] < 2e-3, "{errors:?}");
    // composed to order 4
    let fourth = [0.05, 0.025].map(|h| wave_error(Compose4::new(Isospectral2::new()), h, 4.0));
    let slope = (fourth[0] / fourth[1]).log2();
    assert!((slope - 4.0).abs() < 0.2, "{fourth:?}");
    assert!(wave_error(Rk4, 0.01, 4.0) < 1e-4);
    // the control: the frequency of another degree
    assert!(wave_error(Isospectral2::new(), 0.02, 5.0) > 0.05);
}

#[test]
fn order_two_on_a_turbulent_state() {
    let map = sphere(12);
    let start = map.random(6, 7).unwrap();
    let end = |method: &dyn Fn(&lie_runtime::driver::Problem<f64, Flow>) -> SkewHermitian| {
        let problem = MatrixFlow::new(map.clone())
            .problem(start.clone(), (0.0, 2.0))
            .unwrap();
        method(&problem)
    };
    let reference = end(&|problem| {
        let options = Options::new(0.005).save(Save::Ends);
        solve(problem, Rk4, &options).unwrap().mu.remove(1)
    });
    let errors = [0.04, 0.02, 0.01].map(|h| {
        let found = end(&|problem| {
            let options = Options::new(h).save(Save::Ends);
            solve(problem, Isospectral2::new(), &options)
                .unwrap()
                .mu
                .remove(1)
        });
        distance(&found, &reference)
    });
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.1, "{errors:?}");
    }
}

#[test]
fn the_spectrum_stays_and_the_energy_stays_near() {
    let drifts =
        |method: &dyn Fn(&lie_runtime::driver::Problem<f64, Flow>, &mut SpectrumMonitor) -> f64| {
            let map = sphere(16);
            let start = map.random(8, 3).unwrap();
            let problem = MatrixFlow::new(map).problem(start, (0.0, 40.0)).unwrap();
            let mut monitor = SpectrumMonitor::new();
            let energy = method(&problem, &mut monitor);
            (monitor.change / monitor.radius(), energy)
        };
    let options = Options::new(0.02).save(Save::Every(100));
    let (change, energy) = drifts(&|problem, monitor| {
        let mut drift = DriftMonitor::new();
        solve_observed(
            problem,
            Isospectral2::new(),
            &options,
            (&mut *monitor, &mut drift),
        )
        .unwrap();
        for casimir in &drift.drift().casimirs {
            assert!(casimir.relative().unwrap() < 1e-13, "{casimir:?}");
        }
        drift.drift().energy.relative().unwrap()
    });
    assert!(change < 1e-14, "{change:e}");
    assert!(energy < 1e-3, "{energy:e}");
    // the control
    let (change, _) = drifts(&|problem, monitor| {
        solve_observed(problem, Rk4, &options, monitor).unwrap();
        0.0
    });
    assert!(change > 1e-8, "{change:e}");
}

#[test]
fn casimirs_are_sums_of_powers_of_the_spectrum() {
    let map = sphere(9);
    let mut w = map.random(8, 11).unwrap();
    w.add_to_diagonal(0.3);
    let flow = MatrixFlow::new(map);
    let mut casimirs = [0.0; 3];
    flow.casimirs(&w, &mut casimirs);
    let eigenvalues = spectrum(&w);
    for (power, casimir) in (2..).zip(casimirs) {
        let sum: f64 = eigenvalues.iter().map(|value| value.powi(power)).sum();
        assert!(
            (sum - casimir).abs() < 1e-12 * sum.abs(),
            "{power}: {sum} {casimir}"
        );
    }
}
