//! Which programs compute as well as the form that was written.

use super::points::Point;
use super::program::Program;
use super::rounding::{Outcome, Place};
use crate::symbolic::{Graph, Symbol};

/// A program whose error bound is this many times that of the written form is out.
const TOLERATED: f64 = 4.0;

/// The error bounds of the best reference at each point.
pub struct Judge {
    points: Vec<Point>,
    references: Vec<Reference>,
}

/// At one point.
struct Reference {
    /// The error of each output, at least its last place; none where it is not finite.
    errors: Vec<Option<f64>>,
    leaves_range: bool,
}

impl Judge {
    /// Measures the references.
    pub fn new(graph: &Graph, points: Vec<Point>, references: &[&Program]) -> Self {
        let at_point = |point: &Point| {
            let outcomes: Vec<Outcome> = references
                .iter()
                .map(|program| outcome(graph, point, program))
                .collect();
            let count = outcomes[0].results.len();
            let errors = (0..count).map(|output| {
                let bounds = outcomes.iter().map(|outcome| &outcome.results[output]);
                let finite = bounds.filter(|r| r.value.is_finite() && r.error.is_finite());
                finite
                    .map(|r| r.error.max(r.value.abs()))
                    .min_by(f64::total_cmp)
            });
            Reference {
                errors: errors.collect(),
                leaves_range: outcomes.iter().any(|outcome| outcome.leaves_range),
            }
        };
        Self {
            references: points.iter().map(at_point).collect(),
            points,
        }
    }

    /// How many times the error of the best reference each output has, at worst.
    pub fn losses(&self, graph: &Graph, program: &Program) -> Vec<f64> {
        let mut losses = vec![0.0f64; program.outputs.len()];
        for (point, reference) in self.points.iter().zip(&self.references) {
            let outcome = outcome(graph, point, program);
            let out = outcome.leaves_range && !reference.leaves_range;
            let results = outcome.results.iter().zip(&reference.errors);
            for (loss, (result, error)) in losses.iter_mut().zip(results) {
                let Some(error) = error else { continue };
                let ratio = if result.error <= *error {
                    1.0
                } else {
                    result.error / error
                };
                // NaN is a loss too
                *loss = if out || ratio.is_nan() {
                    f64::INFINITY
                } else {
                    loss.max(ratio)
                };
            }
        }
        losses
    }

    /// Whether a program may stand for the written form, by its greatest loss.
    pub fn admits(loss: f64) -> bool {
        loss <= TOLERATED
    }

    /// The greatest loss of a program.
    pub fn worst(&self, graph: &Graph, program: &Program) -> f64 {
        self.losses(graph, program).into_iter().fold(0.0, f64::max)
    }
}

fn outcome(graph: &Graph, point: &Point, program: &Program) -> Outcome {
    let value = |symbol: Symbol| point.get(&symbol).copied().unwrap_or(f64::NAN);
    Place::new(graph, &value).run(program)
}
