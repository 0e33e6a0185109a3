//! The block `attitude` of the macro: the group element at the start of a declared system.

use lie_runtime::driver::{Chart, EulerSequence, Reconstruction};
use lie_runtime::prelude::*;

mod tilted {
    use lie_runtime::prelude::*;
    lie_poisson! {
        /// A body that is tilted at the start.
        pub system Tilted;
        algebra = so(3);
        state x, y, z;
        parameters { a = 1/2; }
        hamiltonian = x^2/4 + y^2/3 + z^2/2;
        initial = [4/5, 1/10, 3/5];
        attitude { euler = zxz; angles = [a, 1, -2*a]; }
    }
}

mod moved {
    use lie_runtime::prelude::*;
    lie_poisson! {
        pub system Moved;
        algebra = se(3);
        state x, y, z, u, v, w;
        hamiltonian = x^2/4 + y^2/3 + z^2/2 + u^2 + v^2/2 + w^2/3;
        initial = [4/5, 1/10, 3/5, 1, 0, 0];
        attitude { quaternion = [3/5, 0, 4/5, 0]; }
    }
}

mod entries {
    use lie_runtime::prelude::*;
    lie_poisson! {
        pub system Entries;
        algebra = so(3);
        group R;
        state x, y, z;
        parameters { a = 1/2; }
        hamiltonian = x^2/4 + y^2/3 + z^2/2 + R33;
        initial = [4/5, 1/10, 3/5];
        attitude { matrix = [[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]]; }
    }
}

mod right {
    use lie_runtime::prelude::*;
    lie_poisson! {
        pub system Right;
        algebra = so(3);
        state x, y, z;
        hamiltonian = x^2/4 + y^2/3 + z^2/2;
        invariance = right;
        initial = [4/5, 1/10, 3/5];
        attitude { euler = xyz; angles = [1/2, 1, -2]; }
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_declared_system_begins_at_its_attitude() {
    for a in [0.5, -1.25] {
        let body = tilted::Tilted { a };
        let element = body.initial_attitude();
        let system = body.system().unwrap();
        for sequence in EulerSequence::ALL {
            let chart = Chart::Euler(sequence);
            let group = Reconstruction::new(&system, chart);
            let angles = group.at_matrix(&element).unwrap().element().to_vec();
            if sequence == EulerSequence::Zxz {
                assert!(distance(&angles, &[a, 1.0, -2.0 * a]) < 1e-15);
            }
            let q = sequence.quaternion([angles[0], angles[1], angles[2]]);
            let other = EulerSequence::Zxz.quaternion([a, 1.0, -2.0 * a]);
            let along: f64 = q.iter().zip(other).map(|(a, b)| a * b).sum();
            assert!((along.abs() - 1.0).abs() < 1e-15, "{sequence:?}");
        }
        let mut angles = Reconstruction::new(&system, Chart::Euler(EulerSequence::Zxz));
        angles = angles.at_matrix(&element).unwrap();
        let problem = Problem::new(system, body.initial_state(), (0.0, 10.0));
        solve_observed(
            &problem,
            LieMidpoint::exp(),
            &Options::new(0.1),
            &mut angles,
        )
        .unwrap();
        assert!(distance(&angles.rows()[0], &[a, 1.0, -2.0 * a]) < 1e-15);
        assert!(distance(angles.element(), &angles.rows()[0]) > 0.5);
    }
    // in another scalar too
    let single = tilted::Tilted::<f32>::default().initial_attitude();
    let double = tilted::Tilted::new().initial_attitude();
    let pairs = single.iter().zip(double);
    assert!(
        pairs
            .into_iter()
            .all(|(a, b)| (f64::from(*a) - b).abs() < 1e-7)
    );
}

#[test]
fn a_rotation_of_space_has_no_translation() {
    let body = moved::Moved::new();
    let element = body.initial_attitude();
    let turn = [
        -0.28, 0.0, 0.96, 0.0, 0.0, 1.0, 0.0, 0.0, -0.96, 0.0, -0.28, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    assert!(distance(&element, &turn) < 1e-15);
    let system = body.system().unwrap();
    let options = Options::new(0.1);
    let mut rows = Vec::new();
    for start in [None, Some(element)] {
        let mut group = Reconstruction::new(&system, Chart::Matrix);
        if let Some(element) = start {
            group = group.at_matrix(&element).unwrap();
        }
        let problem = Problem::new(system.clone(), body.initial_state(), (0.0, 5.0));
        solve_observed(&problem, LieMidpoint::exp(), &options, &mut group).unwrap();
        rows.push(group.element().to_vec());
    }
    // g = g0 g_id
    let product: Vec<f64> = (0..16)
        .map(|k| {
            (0..4)
                .map(|j| turn[4 * (k / 4) + j] * rows[0][4 * j + k % 4])
                .sum()
        })
        .collect();
    assert!(distance(&rows[1], &product) < 1e-13);
    assert!(rows[0][3].abs() > 0.1 && distance(&rows[1], &rows[0]) > 0.1);
}

#[test]
fn entries_of_the_state_are_those_of_the_attitude() {
    for a in [0.5, 2.0_f64] {
        let (s, c) = a.sin_cos();
        let turn = [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
        let body = entries::Entries { a };
        assert!(distance(&body.initial_attitude(), &turn) < 1e-15);
        let state = body.initial_state();
        assert!(distance(&state.as_slice()[3..], &turn) < 1e-15);
        assert!(distance(&state.as_slice()[..3], &[0.8, 0.1, 0.6]) < 1e-15);
    }
}

/// `g' = xi g`: what is given for the start stands on the right of the motion from the identity on.
#[test]
fn a_right_invariant_system_is_turned_from_the_right() {
    let body = right::Right::new();
    let start = body.initial_attitude();
    let system = body.system().unwrap();
    let run = |mut group: Reconstruction<f64, _>| {
        let problem = Problem::new(system.clone(), body.initial_state(), (0.0, 5.0));
        solve_observed(&problem, Gauss6, &Options::new(0.1), &mut group).unwrap();
        group.element().to_vec()
    };
    let alone = run(Reconstruction::new(&system, Chart::Matrix));
    let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
        let entry = |k: usize| (0..3).map(|j| a[3 * (k / 3) + j] * b[3 * j + k % 3]).sum();
        (0..9).map(entry).collect()
    };
    let matrix = run(Reconstruction::new(&system, Chart::Matrix)
        .at_matrix(&start)
        .unwrap());
    assert!(distance(&matrix, &product(&alone, &start)) < 1e-13);
    assert!(distance(&matrix, &product(&start, &alone)) > 0.1);
    let chart = Chart::Euler(EulerSequence::Xyz);
    let angles = run(Reconstruction::new(&system, chart)
        .at(&[0.5, 1.0, -2.0])
        .unwrap());
    let back = Reconstruction::new(&system, chart).at(&angles).unwrap();
    let q = Reconstruction::new(&system, Chart::Quaternion)
        .at_matrix(&matrix)
        .unwrap();
    let other = EulerSequence::Xyz.quaternion([angles[0], angles[1], angles[2]]);
    let along: f64 = q.element().iter().zip(other).map(|(a, b)| a * b).sum();
    assert!((along.abs() - 1.0).abs() < 1e-14 && back.element() == angles);
}
