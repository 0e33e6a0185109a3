//! Euler angles along a step.

use super::super::group_matrix::exponential;
use super::{Reconstruction, coefficients, combine, represent};
use crate::methods::RungeKutta;
use crate::scalar::{Scalar, largest};
use crate::state::State;
use crate::structure::MatrixGroup;

/// Euler angles are followed in parts of so many radians, at most so many of them.
const PART: f64 = 0.5;
const MOST_PARTS: f64 = 10_000.0;

impl<S: Scalar, V: State<S>> Reconstruction<S, V> {
    /// The sum of the velocities at the stages, each by its weight.
    pub(super) fn total<P>(&self, system: &P, method: RungeKutta) -> V
    where
        P: MatrixGroup<S, State = V>,
    {
        let (_, b) = coefficients::<S>(method, self.velocities.len());
        let mut total = system.zero_state();
        combine(&b, &self.velocities, &mut total);
        total
    }

    /// Follows Euler angles along a step: by the rotations of its velocities, one after the other, each in parts of half a radian. So a step
    /// may turn by more than half a turn. The angle of a rotation is that of the length of a velocity.
    pub(super) fn follow<P>(&mut self, system: &P, velocities: &[V], turn: fn(f64) -> f64)
    where
        P: MatrixGroup<S, State = V>,
    {
        if !self.element.has_angles() {
            return;
        }
        let mut parts = Vec::new();
        for velocity in velocities {
            let mut square = S::zero();
            for &entry in represent(system, velocity).entries() {
                square += entry * entry;
            }
            let angle = largest((square * S::ratio(1.0, 2.0)).sqrt());
            if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&angle) {
                continue;
            }
            let count = (turn(angle) / PART).ceil().clamp(1.0, MOST_PARTS);
            let scale = S::from_f64(turn(angle) / angle / count);
            let mut part = velocity.clone();
            for entry in part.as_mut_slice() {
                *entry *= scale;
            }
            let part = exponential(&represent(system, &part));
            parts.extend(std::iter::repeat_n(part, count as usize));
        }
        self.element.follow(&system.group(), &parts);
    }
}
