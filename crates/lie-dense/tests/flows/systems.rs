//! A matrix flow as a system of the runtime: structure, methods for any field, mistakes and failures.

use lie_dense::{MatrixFlow, ShapeError, SkewHermitian, SphereEuler, StreamMap, spectrum};
use lie_runtime::driver::{OptionError, Options, Save, SolveError, solve};
use lie_runtime::methods::{Gauss4, Gauss6, ImplicitMidpoint, Isospectral2, Method, Rk4};
use lie_runtime::newton::FailureReason;
use lie_runtime::{Poisson, Scalar, SquareMatrix, State, Unknown};

/// `H = sum_jk |W_jk|^4 / 4`, which is not quadratic.
#[derive(Clone)]
struct Quartic(usize);

impl StreamMap for Quartic {
    fn name(&self) -> &str {
        "Quartic"
    }
    fn size(&self) -> usize {
        self.0
    }
    fn stream(&self, w: &SkewHermitian, p: &mut SkewHermitian) {
        for column in 0..self.0 {
            for row in column..self.0 {
                let (re, im) = w.entry(row, column);
                let square = re * re + im * im;
                p.set_lower(row, column, (-square * re, -square * im));
            }
        }
    }
    fn hamiltonian(&self, w: &SkewHermitian, p: &SkewHermitian) -> f64 {
        -0.25 * w.inner(p)
    }
}

fn draw(size: usize) -> SkewHermitian {
    let coordinates = (0..size * size).map(|k| (1.7 * k as f64 + 0.3).sin());
    SkewHermitian::from_coordinates(size, coordinates.collect()).unwrap()
}

/// `(f(x + d e_k) - f(x - d e_k)) / 2d`
fn slope(
    w: &SkewHermitian,
    k: usize,
    mut function: impl FnMut(&SkewHermitian) -> Vec<f64>,
) -> Vec<f64> {
    let distance = 1e-5;
    let mut ahead = w.clone();
    ahead.as_mut_slice()[k] += distance;
    let mut behind = w.clone();
    behind.as_mut_slice()[k] -= distance;
    let pairs = function(&ahead).into_iter().zip(function(&behind));
    pairs.map(|(a, b)| (a - b) / (2.0 * distance)).collect()
}

#[test]
fn derivatives_are_those_of_the_functions() {
    let (flow, w) = (MatrixFlow::new(Quartic(3)), draw(3));
    let zero = flow.zero_state();
    let (mut gradient, mut field) = (zero.clone(), zero.clone());
    let (mut jacobian, mut hessian) = (flow.zero_jacobian(), flow.zero_jacobian());
    let mut poisson = flow.zero_jacobian();
    flow.gradient(&w, &mut gradient);
    flow.vector_field(&w, &mut field);
    flow.jacobian(&w, &mut jacobian);
    flow.hessian(&w, &mut hessian);
    flow.poisson_matrix(&w, &mut poisson);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} {b}");
    for k in 0..9 {
        near(
            gradient.as_slice()[k],
            slope(&w, k, |w| vec![flow.hamiltonian(w)])[0],
        );
        let fields = slope(&w, k, |w| {
            let mut out = zero.clone();
            flow.vector_field(w, &mut out);
            out.as_slice().to_vec()
        });
        let gradients = slope(&w, k, |w| {
            let mut out = zero.clone();
            flow.gradient(w, &mut out);
            out.as_slice().to_vec()
        });
        let mut product = 0.0;
        for j in 0..9 {
            near(jacobian.get(j, k), fields[j]);
            near(hessian.get(j, k), gradients[j]);
            near(poisson.get(j, k), -poisson.get(k, j));
            product += poisson.get(k, j) * gradient.as_slice()[j];
        }
        near(product, field.as_slice()[k]);
    }
    for index in 0..flow.casimir_count() {
        let mut casimir = zero.clone();
        flow.casimir_gradient(index, &w, &mut casimir);
        let mut size = 0.0_f64;
        for k in 0..9 {
            let values = slope(&w, k, |w| {
                let mut out = vec![0.0; 3];
                flow.casimirs(w, &mut out);
                out
            });
            near(casimir.as_slice()[k], values[index]);
            let moved: f64 = (0..9)
                .map(|j| poisson.get(k, j) * casimir.as_slice()[j])
                .sum();
            near(moved, 0.0);
            size = size.max(casimir.as_slice()[k].abs());
        }
        assert!(size > 0.1);
    }
}

fn end<M: StreamMap>(
    map: M,
    start: &SkewHermitian,
    method: impl Method<f64, MatrixFlow<M>>,
    step: f64,
) -> SkewHermitian {
    let problem = MatrixFlow::new(map)
        .problem(start.clone(), (0.0, 1.0))
        .unwrap();
    let options = Options::new(step).save(Save::Ends);
    solve(&problem, method, &options).unwrap().mu.remove(1)
}

fn distance(one: &SkewHermitian, other: &SkewHermitian) -> f64 {
    let mut difference = one.clone();
    difference.axpy(-1.0, other);
    difference.max_norm()
}

#[test]
fn methods_for_any_field_agree() {
    let map = || SphereEuler::new(20).unwrap();
    let start = map().random(5, 2).unwrap();
    let exact = end(map(), &start, Gauss6, 0.01);
    assert!(distance(&end(map(), &start, Gauss4, 0.01), &exact) < 1e-6);
    assert!(distance(&end(map(), &start, Rk4, 0.005), &exact) < 1e-6);
    let midpoint = distance(&end(map(), &start, ImplicitMidpoint, 0.01), &exact);
    assert!(midpoint < 1e-2 && midpoint > 1e-6, "{midpoint:e}");
}

#[test]
fn a_hamiltonian_of_degree_four_keeps_the_spectrum() {
    let start = draw(5);
    let found = end(Quartic(5), &start, Isospectral2::new(), 0.02);
    let changed = |end: &SkewHermitian| {
        let pairs = spectrum(end).into_iter().zip(spectrum(&start));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, Scalar::max)
    };
    assert!(distance(&found, &start) > 0.1);
    assert!(changed(&found) < 1e-14, "{:e}", changed(&found));
    assert!(changed(&end(Quartic(5), &start, ImplicitMidpoint, 0.02)) > 1e-7);
}

#[test]
fn too_large_steps_fail_with_what_to_do() {
    let map = SphereEuler::new(16).unwrap();
    let start = map.random(6, 5).unwrap();
    let problem = MatrixFlow::new(map)
        .problem(start.clone(), (0.0, 30.0))
        .unwrap();
    let Err(SolveError::Step { error, solution }) =
        solve(&problem, Isospectral2::new(), &Options::new(3.0))
    else {
        panic!("a step of 3 is too large");
    };
    let reason = error.failure.reason;
    let reasons = [
        FailureReason::Diverged,
        FailureReason::NotConverged,
        FailureReason::NotFinite,
    ];
    assert!(reasons.contains(&reason), "{reason:?}");
    assert_eq!((error.step, error.time), (1, 0.0));
    assert!(error.to_string().contains("take a smaller step"), "{error}");
    assert_eq!(solution.mu, [start]);
}

#[test]
fn shapes_that_do_not_fit_are_said() {
    let flow = MatrixFlow::new(SphereEuler::new(8).unwrap());
    let error = flow
        .problem(SkewHermitian::zeros(9), (0.0, 1.0))
        .err()
        .unwrap();
    assert_eq!(
        error,
        ShapeError::Size {
            system: 8,
            state: 9
        }
    );
    assert!(error.to_string().contains("8 x 8") && error.to_string().contains("9 x 9"));
    let error = SkewHermitian::from_coordinates(3, vec![0.0; 8]).unwrap_err();
    assert!(
        error.to_string().contains("9 real coordinates, not 8"),
        "{error}"
    );
    let error =
        SkewHermitian::from_entries(2, |row, column| ((row + column) as f64, 0.0)).unwrap_err();
    assert_eq!(error, ShapeError::NotSkew { row: 1, column: 0 });
    let error = SkewHermitian::from_entries(2, |_, _| (f64::NAN, 0.0)).unwrap_err();
    assert_eq!(error, ShapeError::NotSkew { row: 0, column: 0 });
    assert!(SphereEuler::new(1).is_err());
    let sphere = SphereEuler::new(4).unwrap();
    for (degree, order) in [(4, 0), (2, 3)] {
        let error = sphere
            .vorticity(&[(degree, order, (1.0, 0.0))])
            .unwrap_err();
        assert!(matches!(error, ShapeError::Harmonic { .. }), "{error}");
    }
}

#[test]
fn a_problem_by_hand_with_another_size_is_refused() {
    let problem = lie_runtime::driver::Problem::new(
        MatrixFlow::new(SphereEuler::new(8).unwrap()),
        SkewHermitian::zeros(9),
        (0.0, 1.0),
    );
    let error = solve(&problem, Isospectral2::new(), &Options::new(0.1)).expect_err("another size");
    assert!(
        matches!(error, SolveError::Option(OptionError::StateLength { .. })),
        "{error}"
    );
}
