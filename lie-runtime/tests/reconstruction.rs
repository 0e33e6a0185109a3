//! The group element beside a run: the spatial momentum, the two charts, rows off the grid.

#[path = "../../tests/common/rotation.rs"]
mod rotation;

use crate::systems;

use core::f64::consts::FRAC_PI_2;
use lie_runtime::driver::{Chart, EulerSequence, Reconstruction};
use lie_runtime::prelude::*;
use nalgebra::SVector;
use rotation::rotation;
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
                    Chart::Quaternion | Chart::Euler(_) => rotation(last),
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

/// `g0 g` of rotations by rows.
fn times(a: &[f64], b: &[f64]) -> Row {
    let entry = |k: usize| (0..3).map(|j| a[3 * (k / 3) + j] * b[3 * j + k % 3]).sum();
    (0..9).map(entry).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The rows of a run from a group element, given in the chart; from the identity where there is none.
fn from(chart: Chart, element: Option<&[f64]>, options: &Options) -> Vec<Row> {
    let system = RigidBody::<f64>::default();
    let mut group = Reconstruction::new(&system, chart);
    if let Some(element) = element {
        group = group.at(element).expect("as many entries");
    }
    let problem = Problem::new(system, BODY, (0.0, 10.0));
    solve_observed(&problem, LieMidpoint::exp(), options, &mut group).expect("the steps converge");
    group.rows().to_vec()
}

/// An attitude, in its charts.
fn charts(sequence: EulerSequence) -> [(Chart, Row); 3] {
    let angles = [0.7, -0.4 + FRAC_PI_2, 2.9];
    let q = sequence.quaternion(angles);
    [
        (Chart::Matrix, rotation(&q)),
        (Chart::Quaternion, q.to_vec()),
        (Chart::Euler(sequence), angles.to_vec()),
    ]
}

/// The equations on the group are left-invariant: from g0 on the motion is `g0 g`, g being that from the identity on.
#[test]
fn a_run_from_an_attitude_is_turned_by_it() {
    let options = Options::new(0.1);
    let identity = from(Chart::Matrix, None, &options);
    for sequence in EulerSequence::ALL {
        let all = charts(sequence);
        let start = all[0].1.clone();
        for (chart, element) in all {
            let rows = from(chart, Some(&element), &options);
            assert!(apart(&rows[0], &element) < 1e-15, "{chart:?}");
            assert_eq!(rows.len(), identity.len());
            for (row, alone) in rows.iter().zip(&identity) {
                let matrix = match chart {
                    Chart::Matrix => row.clone(),
                    Chart::Quaternion => rotation(row),
                    Chart::Euler(s) => rotation(&s.quaternion([row[0], row[1], row[2]])),
                };
                let error = apart(&matrix, &times(&start, alone));
                assert!(error < 3e-14, "{chart:?}: {error:e}");
            }
            // it is no other than the left product
            let last = identity.last().expect("rows");
            assert!(apart(&times(last, &start), &times(&start, last)) > 0.1);
        }
    }
}

/// The angles go beyond half a turn, without jumps from step to step, and rows off the grid leave them as they are.
#[test]
fn angles_are_continuous() {
    let chart = Chart::Euler(EulerSequence::Zxz);
    let step = Options::new(0.02);
    let rows = from(chart, Some(&[0.0, 1.0, 0.0]), &step);
    for pair in rows.windows(2) {
        assert!(apart(&pair[0], &pair[1]) < 0.2, "{pair:?}");
    }
    let end = rows.last().expect("rows");
    assert!(end[0].abs() > 3.0 * FRAC_PI_2, "{end:?}");
    let times = vec![2.0, 2.007, 10.0];
    let few = from(
        chart,
        Some(&[0.0, 1.0, 0.0]),
        &step.clone().save(Save::At(times)),
    );
    assert_eq!((&few[0], &few[2]), (&rows[100], end));
    assert_ne!(few[0], few[1]);
}

/// A rotation about the first axis, on the way of which `zxz` is locked twice a turn: the middle angle goes on.
#[test]
fn a_gimbal_lock_is_passed() {
    let ball = RigidBody {
        inertia: [1.0, 1.0, 1.0],
    };
    for (sequence, turning, mu) in [
        (EulerSequence::Zxz, 1, [1.0, 0.0, 0.0]),
        (EulerSequence::Zyx, 1, [0.0, 1.0, 0.0]),
        (EulerSequence::Xyz, 1, [0.0, 1.0, 0.0]),
    ] {
        let mut group = Reconstruction::new(&ball, Chart::Euler(sequence));
        let problem = Problem::new(ball, mu, (0.0, 10.0));
        // pi/2 is a step, and so in each lock a row
        let options = Options::new(FRAC_PI_2 / 8.0);
        solve_observed(&problem, LieMidpoint::exp(), &options, &mut group).expect("it turns");
        for (step, row) in group.rows().iter().enumerate().take(48) {
            let mut expected = [0.0; 3];
            expected[turning] = FRAC_PI_2 / 8.0 * step as f64;
            assert!(apart(row, &expected) < 1e-12, "{sequence:?}: {row:?}");
        }
    }
}

/// What goes on from a memory has the same bits; entries and memories of other lengths are refused.
#[test]
fn a_memory_goes_on_bit_by_bit() {
    let system = RigidBody::<f64>::default();
    for (chart, element) in charts(EulerSequence::Yxz) {
        let group = || Reconstruction::new(&system, chart);
        let problem = |span| Problem::new(system, [0.8, 0.0, 0.0], span);
        let run = |span, mut group: Reconstruction<f64, _>| {
            let options = Options::new(0.125).save(Save::Ends);
            solve_observed(&problem(span), LieMidpoint::exp(), &options, &mut group)
                .expect("it turns");
            group
        };
        let start = group().at(&element).expect("as many");
        let half = run((0.0, 4.0), start.clone());
        let rest = group().beginning_at(&half.memory()).expect("a memory");
        let rest = run((4.0, 8.0), rest);
        assert_eq!(rest.memory(), run((0.0, 8.0), start).memory());
        assert!(group().at(&element[1..]).is_none());
        assert!(group().beginning_at(&half.memory()[1..]).is_none());
        assert!(group().at_matrix(&[1.0; 4]).is_none());
    }
}

/// A matrix with few digits is made orthogonal, and is a start in every chart.
#[test]
fn a_matrix_is_a_start_in_every_chart() {
    let system = RigidBody::<f64>::default();
    let [(_, matrix), (_, quaternion), _] = charts(EulerSequence::Zyz);
    let few: Row = matrix.iter().map(|x| (x * 1e5).round() / 1e5).collect();
    assert!(defect(&few) > 1e-6);
    let at = |chart| {
        Reconstruction::new(&system, chart)
            .at_matrix(&few)
            .expect("of its size")
    };
    let made = at(Chart::Matrix).element().to_vec();
    assert!(defect(&made) < 1e-15 && apart(&made, &matrix) < 1e-5);
    let sign = quaternion[0].signum();
    let expected: Row = quaternion.iter().map(|q| sign * q).collect();
    assert!(apart(at(Chart::Quaternion).element(), &expected) < 1e-5);
    for sequence in EulerSequence::ALL {
        let angles = at(Chart::Euler(sequence)).element().to_vec();
        let back = rotation(&sequence.quaternion([angles[0], angles[1], angles[2]]));
        assert!(apart(&back, &made) < 1e-14, "{sequence:?}");
    }
    let doubled = quaternion.iter().map(|q| 2.0 * q).collect::<Row>();
    let unit = Reconstruction::new(&system, Chart::Quaternion)
        .at(&doubled)
        .expect("four");
    assert!(apart(unit.element(), &quaternion) < 1e-15);
}
