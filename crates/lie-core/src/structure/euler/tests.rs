//! Angles and back, for all sequences.

use super::*;
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use std::vec::Vec;

type Matrix = [[f64; 3]; 3];

fn times(a: Matrix, b: Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The textbook's matrix of a turn about an axis.
fn about(axis: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        1 => [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        _ => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    }
}

fn of_angles(sequence: EulerSequence, angles: [f64; 3]) -> Matrix {
    let [a, b, c] = sequence.axes();
    let first = times(about(a, angles[0]), about(b, angles[1]));
    times(first, about(c, angles[2]))
}

fn of_quaternion([w, x, y, z]: [f64; 4]) -> Matrix {
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

fn distance(a: Matrix, b: Matrix) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Numbers in [-1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn quaternion(&mut self) -> [f64; 4] {
        loop {
            let q: [f64; 4] = core::array::from_fn(|_| self.next());
            let square: f64 = q.iter().map(|x| x * x).sum();
            if (0.01..1.0).contains(&square) {
                return q.map(|x| x / square.sqrt());
            }
        }
    }
}

fn middle(sequence: EulerSequence) -> [f64; 2] {
    match sequence.is_proper() {
        true => [0.0, PI],
        false => [-FRAC_PI_2, FRAC_PI_2],
    }
}

#[test]
fn the_sequences_are_all_that_there_are() {
    for a in 0..3 {
        for b in (0..3).filter(|b| *b != a) {
            for c in (0..3).filter(|c| *c != b) {
                let mut all = EulerSequence::ALL.iter();
                let sequence = all.find(|s| s.axes() == [a, b, c]).expect("it is there");
                let name: std::string::String =
                    [a, b, c].iter().map(|k| ['x', 'y', 'z'][*k]).collect();
                assert_eq!(sequence.name(), name);
                assert_eq!(name.parse(), Ok(*sequence));
            }
        }
    }
    for wrong in ["", "zz", "xxy", "xyy", "ZXZ", "zxzx", "abc"] {
        assert_eq!(wrong.parse::<EulerSequence>(), Err(NoSequence));
    }
}

#[test]
fn the_quaternion_is_that_of_three_turns() {
    let mut random = Random(1);
    for sequence in EulerSequence::ALL {
        for _ in 0..200 {
            let angles = core::array::from_fn(|_| 7.0 * random.next());
            let matrix = of_quaternion(sequence.quaternion(angles));
            let error = distance(matrix, of_angles(sequence, angles));
            assert!(error < 2e-15, "{}: {error:e}", sequence.name());
        }
    }
}

#[test]
fn angles_of_random_rotations_lead_back() {
    let mut random = Random(2);
    for sequence in EulerSequence::ALL {
        let [low, high] = middle(sequence);
        for _ in 0..500 {
            let q = random.quaternion();
            // the length does not matter, nor the sign
            let length = 3.0 * random.next();
            let [phi, theta, psi] = sequence.angles(q.map(|x| length * x));
            let outer = phi.abs().max(psi.abs());
            assert!(outer <= PI + 1e-15 && (low..=high).contains(&theta));
            let error = distance(of_angles(sequence, [phi, theta, psi]), of_quaternion(q));
            assert!(error < 4e-15, "{}: {error:e}", sequence.name());
        }
    }
}

/// At a lock, and from 1e-16 to 1e-3 beside it, the rotation is the same to round-off.
#[test]
fn angles_near_a_lock_lead_back() {
    let mut random = Random(3);
    for sequence in EulerSequence::ALL {
        for end in middle(sequence) {
            for exponent in 3..18 {
                let off = match exponent {
                    17 => 0.0,
                    _ => 10.0_f64.powi(-exponent),
                };
                let angles = [3.0 * random.next(), end + off, 3.0 * random.next()];
                let found = sequence.angles(sequence.quaternion(angles));
                assert!(found.iter().all(|angle| angle.is_finite()));
                let error = distance(of_angles(sequence, found), of_angles(sequence, angles));
                assert!(error < 2e-14, "{} {off:e}: {error:e}", sequence.name());
                if off == 0.0 {
                    assert_eq!(found[2], 0.0, "{}", sequence.name());
                }
            }
        }
    }
}

#[test]
fn the_last_angle_of_a_lock_is_none() {
    for (sequence, q, expected) in [
        ("zxz", [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ("xyz", [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        (
            "zxz",
            [0.6, 0.0, 0.0, 0.8],
            [2.0 * 0.8_f64.atan2(0.6), 0.0, 0.0],
        ),
        (
            "zxz",
            [0.0, 0.6, 0.8, 0.0],
            [2.0 * 0.8_f64.atan2(0.6), PI, 0.0],
        ),
        ("zyx", [0.5, -0.5, 0.5, 0.5], [FRAC_PI_2, FRAC_PI_2, 0.0]),
    ] {
        let sequence: EulerSequence = sequence.parse().unwrap();
        let found = sequence.angles(q);
        let error = distance(of_angles(sequence, found), of_quaternion(q));
        assert!(error < 1e-15, "{}: {found:?}", sequence.name());
        for (found, expected) in found.iter().zip(expected) {
            let apart = (found - expected).rem_euclid(TAU);
            assert!(
                apart.min(TAU - apart) < 1e-15,
                "{}: {found}",
                sequence.name()
            );
        }
    }
}

/// A body that turns about one axis, then about another, through locks on its way.
#[test]
fn followed_angles_are_continuous_through_a_lock() {
    for sequence in EulerSequence::ALL {
        let [a, b, c] = sequence.axes();
        let start: [f64; 3] = [0.4, middle(sequence)[0] + 0.3, -0.7];
        let mut angles = start;
        let mut rows = Vec::new();
        // the middle angle once around, twice through each lock
        for step in 0..=1000 {
            let theta = start[1] + TAU * f64::from(step) / 1000.0;
            let q = sequence.quaternion([start[0], theta, start[2]]);
            let sign = if step % 2 == 0 { 1.0 } else { -1.0 };
            angles = sequence.angles_near(q.map(|x| sign * x), angles);
            rows.push(angles);
            assert!(
                (angles[0] - start[0]).abs() < 1e-9,
                "{}: {angles:?}",
                sequence.name()
            );
            assert!(
                (angles[1] - theta).abs() < 1e-9,
                "{}: {angles:?}",
                sequence.name()
            );
        }
        assert!((rows[1000][1] - start[1] - TAU).abs() < 1e-12);
        // in the lock itself the first angle stays where it was, whatever the two turns add up to
        if a == c {
            let q = sequence.quaternion([1.2, 0.0, 0.0]);
            let [phi, theta, psi] = sequence.angles_near(q, [0.7, 0.1, 0.3]);
            assert!(
                (phi - psi - 0.4).abs() < 1e-15 && theta == 0.0,
                "{phi} {psi}"
            );
            assert!((phi + psi - 1.2).abs() < 1e-15);
        }
        // many turns of the outer angles, which are counted
        let mut angles = [0.0, start[1], 0.0];
        for step in 1..=400 {
            let turn = 0.1 * f64::from(step);
            let q = sequence.quaternion([turn, start[1], -2.0 * turn]);
            angles = sequence.angles_near(q, angles);
        }
        assert!((angles[0] - 40.0).abs() < 1e-12 && (angles[2] + 80.0).abs() < 1e-12);
        assert!(b != a);
    }
}

#[test]
fn lanes_have_the_angles_of_each() {
    type Wide = <f64 as Scalar>::Wide;
    let mut random = Random(4);
    let all: [[f64; 4]; 8] = core::array::from_fn(|lane| match lane {
        0 => [1.0, 0.0, 0.0, 0.0],
        1 => [0.0, 0.6, 0.8, 0.0],
        _ => random.quaternion(),
    });
    let wide: [Wide; 4] = core::array::from_fn(|k| f64::gather(all.map(|q| q[k])));
    for sequence in EulerSequence::ALL {
        let found = sequence.angles(wide).map(f64::scatter);
        let near = sequence
            .angles_near(wide, [1.0, 2.0, 3.0].map(f64::widen))
            .map(f64::scatter);
        for (lane, q) in all.iter().enumerate() {
            assert_eq!(found.map(|angle| angle[lane]), sequence.angles(*q));
            let alone = sequence.angles_near(*q, [1.0, 2.0, 3.0]);
            assert_eq!(near.map(|angle| angle[lane]), alone);
        }
    }
}
