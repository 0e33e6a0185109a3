//! Which programs compute as well as the form that was written.

use super::points::Point;
use super::program::Program;
use super::rounding::{Outcome, Places, Rounded};
use crate::symbolic::Graph;

/// A program whose error bound is this many times that of the written form is out.
const TOLERATED: f64 = 4.0;

/// The error bounds of the best reference at each point.
pub struct Judge {
    places: Places,
    /// The error of each output at each point, at least its last place; none where it is not finite.
    errors: Vec<Vec<Option<f64>>>,
    /// Whether a reference has intermediate results far out, at each point.
    leaves_range: Vec<bool>,
}

impl Judge {
    /// Measures the references.
    pub fn new(graph: &Graph, points: &[Point], references: &[&Program]) -> Self {
        let mut places = Places::new(points);
        let outcomes: Vec<Outcome> = references
            .iter()
            .map(|program| places.run(graph, program))
            .collect();
        let error = |output: usize, place: usize| {
            let bounds = outcomes
                .iter()
                .map(|outcome| outcome.results[output][place]);
            let finite = bounds.filter(|r| r.value.is_finite() && r.error.is_finite());
            finite
                .map(|r| r.error.max(r.value.abs()))
                .min_by(f64::total_cmp)
        };
        let all = 0..points.len();
        let errors = |output| all.clone().map(|place| error(output, place)).collect();
        let out = |place: usize| outcomes.iter().any(|outcome| outcome.leaves_range[place]);
        Self {
            errors: (0..outcomes[0].results.len()).map(errors).collect(),
            leaves_range: all.clone().map(out).collect(),
            places,
        }
    }

    /// How many times the error of the best reference each output has, at worst.
    pub fn losses(&mut self, graph: &Graph, program: &Program) -> Vec<f64> {
        let outcome = self.places.run(graph, program);
        let loss = |results: &[Rounded], errors: &[Option<f64>]| {
            let mut loss = 0.0f64;
            for (place, error) in errors.iter().enumerate() {
                let Some(error) = error else { continue };
                let result = results[place];
                let ratio = if result.error <= *error {
                    1.0
                } else {
                    result.error / error
                };
                // NaN is a loss too
                if ratio.is_nan() || outcome.leaves_range[place] && !self.leaves_range[place] {
                    return f64::INFINITY;
                }
                loss = loss.max(ratio);
            }
            loss
        };
        let outputs = outcome.results.iter().zip(&self.errors);
        outputs
            .map(|(results, errors)| loss(results, errors))
            .collect()
    }

    /// Whether a program may stand for the written form, by its greatest loss.
    pub fn admits(loss: f64) -> bool {
        loss <= TOLERATED
    }

    /// The greatest loss of a program.
    pub fn worst(&mut self, graph: &Graph, program: &Program) -> f64 {
        self.losses(graph, program).into_iter().fold(0.0, f64::max)
    }
}
