//! The method on T*G, with the heavy top by hand: its equation in the group, order, symmetry, structure, factors.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::{EulerArnoldHalf, Half, coadjoint_action};
use lie_runtime::methods::{EulerArnold2, FactorSink, Retraction, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Lift, Unknown};
use nalgebra::SVector;
use systems::heavy_top::{HeavyTop, START};
use systems::{distance, state, steps};

type Vector = SVector<f64, 6>;

/// The state of the heavy top at t = 1.
const END: [f64; 6] = [
    0.702124293102685,
    -0.19397034937192864,
    0.8493552060006306,
    0.6478081064813676,
    0.2690475836433316,
    0.712711761452489,
];

fn moved(h: f64, count: u32, start: &Vector) -> Vector {
    let mut mu = *start;
    steps(&HeavyTop::default(), &EulerArnold2, h, count, &mut mu).expect("the steps converge");
    mu
}

#[test]
fn order_and_symmetry() {
    let start = Vector::from(START);
    let errors: Vec<(f64, f64)> = [16, 24, 32, 48, 64]
        .map(|count| {
            let h = 1.0 / f64::from(count);
            (h, distance(&moved(h, count, &start), &Vector::from(END)))
        })
        .to_vec();
    let slope = order_of_convergence(&errors, 3e-14).expect("points").slope;
    assert!((slope - 2.0).abs() < 0.05, "{slope}");
    let back = moved(-0.3, 1, &moved(0.3, 1, &start));
    assert!(distance(&back, &start) < 2e-15, "{back}");
}

#[test]
fn structure_is_kept() {
    let (system, start) = (HeavyTop::default(), Vector::from(START));
    let newton = NewtonOptions::default();
    let defect = poisson_defect(&system.lift(), &EulerArnold2, 0.4, &START, &newton);
    let defect = defect.expect("a step");
    assert!(defect < 4e-15, "{defect:e}");
    let end = moved(0.2, 500, &start);
    let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
    system.casimirs(&start, &mut before);
    system.casimirs(&end, &mut after);
    for (before, after) in before.iter().zip(after) {
        assert!((before - after).abs() < 500.0 * 4e-16, "{before} {after}");
    }
    let drift = (system.hamiltonian(&end) - system.hamiltonian(&start)).abs();
    assert!(drift < 2e-3, "{drift:e}");
}

struct Collect(Vec<Vector>);

impl FactorSink<Vector> for Collect {
    fn push(&mut self, retraction: Retraction, xi: &Vector) {
        assert_eq!(retraction, Retraction::Exp);
        self.0.push(*xi);
    }
}

/// The factors that a step shows are those by which it moved the state.
#[test]
fn factors_move_the_state() {
    let (system, start) = (HeavyTop::default(), Vector::from(START));
    for h in [0.3, -0.2] {
        let mut shown = Collect(Vec::new());
        let mut end = start;
        let mut stepper = EulerArnold2.stepper(&system, h, &NewtonOptions::default());
        stepper.step(&mut end, &mut shown).expect("it converges");
        let mut mu = start;
        for xi in &shown.0 {
            let mut next = mu;
            coadjoint_action(&system, xi, &mu, &mut next);
            mu = next;
        }
        assert_eq!(shown.0.len(), 4);
        assert!(distance(&mu, &end) < 1e-15, "{mu} {end}");
    }
}

/// The Jacobians of both halves against dual numbers, away from a solution.
#[test]
fn jacobians_are_derivatives() {
    let system = HeavyTop::default();
    let lifted = system.lift();
    for half in [Half::First, Half::Second] {
        let mut plain = EulerArnoldHalf::new(&system, 0.3);
        let mut dual = EulerArnoldHalf::new(&lifted, Dual::constant_of(0.3));
        plain.set_half(half);
        dual.set_half(half);
        plain.set_base(&state(&system, &START));
        dual.set_base(&state(&lifted, &START));
        let unknown = SVector::from([0.5, -0.2, 0.7]);
        let (mut residual, mut matrix) = (unknown, plain.zero_matrix());
        plain.linearize(&unknown, &mut residual, &mut matrix);
        for column in 0..3 {
            let mut seeded = unknown.map(Dual::constant_of);
            seeded[column].derivative = 1.0;
            let mut out = dual.zero_unknown();
            dual.residual(&seeded, &mut out);
            for row in 0..3 {
                let error = (matrix[(row, column)] - out[row].derivative).abs();
                assert!(error < 2e-15, "{half:?} ({row}, {column}): {error:e}");
                assert!((residual.entry(row) - out[row].value).abs() < 1e-15);
            }
        }
    }
}
