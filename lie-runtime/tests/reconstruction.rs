//! The group element beside a run: the spatial momentum, the two charts, rows off the grid.

use crate::systems;

use lie_runtime::driver::{Chart, Reconstruction};
use lie_runtime::prelude::*;
use nalgebra::SVector;
use systems::rigid_body::RigidBody;
use systems::{distance, state};

type Row = Vec<f64>;

const BODY: [f64; 3] = [0.8, 0.1, 0.6];

fn run(method: impl Method<f64, RigidBody>, chart: Chart, options: &Options) -> (Vec<Row>, Row) {
    let system = RigidBody::<f64>::default();
    let mut group = Reconstruction::new(&system, chart);
    let problem = Problem::new(system, BODY, (0.0, 10.0));
    let solution =
        solve_observed(&problem, method, options, &mut group).expect("the steps converge");
    let last = solution.last().expect("rows").1;
    (group.rows().to_vec(), last.as_slice().to_vec())
}

/// `R mu` for a matrix by rows: the momentum in space.
fn spatial(matrix: &[f64], mu: &[f64]) -> SVector<f64, 3> {
    SVector::from_fn(|row, _| (0..3).map(|k| matrix[3 * row + k] * mu[k]).sum())
}

/// The matrix of a unit quaternion.
fn rotation(q: &[f64]) -> Row {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    vec![
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

/// The largest entry of `R^T R - 1`.
fn defect(matrix: &[f64]) -> f64 {
    let mut largest = 0.0_f64;
    for a in 0..3 {
        for b in 0..3 {
            let sum: f64 = (0..3).map(|k| matrix[3 * k + a] * matrix[3 * k + b]).sum();
            let one = if a == b { 1.0 } else { 0.0 };
            largest = f64::max(largest, (sum - one).abs());
        }
    }
    largest
}

#[test]
fn a_method_of_coadjoint_form_keeps_the_momentum_in_space() {
    let options = Options::new(0.1);
    let start = state(&RigidBody::<f64>::default(), &BODY);
    macro_rules! check {
        ($method:expr) => {
            for chart in [Chart::Matrix, Chart::Quaternion] {
                let (rows, end) = run($method, chart, &options);
                assert_eq!(rows.len(), 101);
                let last = rows.last().expect("rows");
                let matrix = match chart {
                    Chart::Matrix => last.clone(),
                    Chart::Quaternion => rotation(last),
                };
                assert!(distance(&spatial(&matrix, &end), &start) < 1e-14);
                // it has gone somewhere, and stays a rotation
                assert!((matrix[0] - 1.0).abs() > 0.1 && defect(&matrix) < 1e-15);
            }
        };
    }
    check!(LieMidpoint::exp());
    check!(LieMidpoint::cayley());
    check!(lie_runtime::methods::GeneratingSecondKind2);
    check!(lie_runtime::methods::MoserVeselov);
    check!(lie_runtime::methods::Collective2::hopf());
    check!(lie_runtime::methods::Collective4::hopf());
}

/// A ball with `I = 1` turns about mu: a step of 1 is a rotation by `|mu|`, close to half a turn too.
#[test]
fn the_quaternion_of_a_long_step() {
    let ball = RigidBody {
        inertia: [1.0, 1.0, 1.0],
    };
    let third = 1.0 / 3.0;
    let axes = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [2.0 * third, -third, 2.0 * third],
        [-third, 2.0 * third, 2.0 * third],
        [2.0 * third, 2.0 * third, third],
        [-0.48, 0.64, -0.6],
    ];
    for axis in axes {
        for angle in [0.3_f64, 1.6, 2.4, 3.1, 3.13] {
            let mut group = Reconstruction::new(&ball, Chart::Quaternion);
            let problem = Problem::new(ball, axis.map(|n| angle * n), (0.0, 1.0));
            let options = Options::new(1.0);
            solve_observed(&problem, LieMidpoint::exp(), &options, &mut group)
                .expect("nothing changes");
            let (sine, cosine) = (0.5 * angle).sin_cos();
            let expected = [cosine, sine * axis[0], sine * axis[1], sine * axis[2]];
            for (entry, expected) in group.element().iter().zip(expected) {
                let error = (entry - expected).abs();
                assert!(error < 1e-14, "{axis:?} by {angle}: {error:e}");
            }
        }
    }
}

/// `R mu` is a quadratic integral of `R' = R omega^, mu' = mu x omega`, which Gauss methods keep.
#[test]
fn gauss_methods_keep_it_too_and_others_do_to_their_order() {
    let start = state(&RigidBody::<f64>::default(), &BODY);
    macro_rules! error {
        ($method:expr, $h:expr) => {{
            let (rows, end) = run($method, Chart::Matrix, &Options::new($h));
            let last = rows.last().expect("rows");
            assert!(defect(last) < 1e-14, "{:e}", defect(last));
            distance(&spatial(last, &end), &start)
        }};
    }
    assert!(error!(ImplicitMidpoint, 0.1) < 1e-14);
    assert!(error!(Gauss4, 0.1) < 1e-14);
    assert!(error!(Gauss6, 0.1) < 1e-14);
    let slope = (error!(Rk4, 0.1) / error!(Rk4, 0.05)).log2();
    assert!(slope > 3.6, "{slope}");
}

/// The element of a row off the grid is that of its time, and the run goes on from the grid.
#[test]
fn rows_off_the_grid_change_nothing() {
    let times = vec![2.0, 2.007, 2.013, 5.009, 10.0];
    for chart in [Chart::Matrix, Chart::Quaternion] {
        let on = Options::new(0.02).save(Save::At(vec![2.0, 10.0]));
        let (on, _) = run(LieMidpoint::exp(), chart, &on);
        let off = Options::new(0.02).save(Save::At(times.clone()));
        let (off, _) = run(LieMidpoint::exp(), chart, &off);
        assert_eq!((&on[0], &on[1]), (&off[0], &off[4]));
        let fine = Options::new(0.001).save(Save::At(times.clone()));
        let (fine, _) = run(LieMidpoint::exp(), chart, &fine);
        for (place, (coarse, fine)) in off.iter().zip(&fine).enumerate() {
            let pairs = coarse.iter().zip(fine);
            let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 5e-4, "row {place}: {error:e}");
        }
        assert_ne!(off[0], off[1]);
    }
}

/// One step of Newton's iteration per step keeps a rotation over many.
#[test]
fn the_matrix_stays_a_rotation() {
    let options = Options::new(0.01).save(Save::Ends);
    let system = RigidBody::<f64>::default();
    let mut group = Reconstruction::new(&system, Chart::Matrix);
    let problem = Problem::new(system, BODY, (0.0, 300.0));
    solve_observed(&problem, LieMidpoint::exp(), &options, &mut group).expect("the steps converge");
    assert!(
        defect(group.element()) < 1e-15,
        "{:e}",
        defect(group.element())
    );
}
