//! The declared functions that are recorded beside a run: angles without their jumps.

use crate::poisson::Poisson;
use crate::scalar::Scalar;
use core::f64::consts::TAU;

/// The values of [`Poisson::quantities`] along a run. An angle whose jumps are taken out ([`Poisson::quantity_unwraps`]) is shown on
/// the branch that is nearest to its last value, `q + 2 pi k`; where it is looked at after every step, that is the right one
/// unless it turns by more than pi in a step.
#[derive(Clone, Debug)]
pub struct Quantities<S> {
    values: Vec<S>,
    /// The angles, by their places, with their last values.
    angles: Vec<(usize, Option<S>)>,
}

impl<S: Scalar> Quantities<S> {
    /// Before the first state of a run.
    pub fn new<P: Poisson<S>>(system: &P) -> Self {
        let count = system.quantity_count();
        let angles = (0..count).filter(|&place| system.quantity_unwraps(place));
        Self {
            values: vec![S::zero(); count],
            angles: angles.map(|place| (place, None)).collect(),
        }
    }

    /// Whether states between those that are recorded matter, since there are angles to follow.
    pub fn has_angles(&self) -> bool {
        !self.angles.is_empty()
    }

    /// The values at a state, the next one of the run.
    pub fn at<P: Poisson<S>>(&mut self, system: &P, mu: &P::State) -> &[S] {
        if self.values.is_empty() {
            return &self.values;
        }
        system.quantities(mu, &mut self.values);
        // no work is not minus nothing
        self.values.iter_mut().for_each(|value| *value += S::zero());
        for (place, last) in &mut self.angles {
            let value = &mut self.values[*place];
            if let Some(last) = last {
                *value = nearest(*value, *last);
            }
            let finite = value.finite();
            // one that has no value is followed from where it had one
            *last = Some(S::select(finite, *value, last.unwrap_or(S::zero())));
        }
        &self.values
    }

    /// The last values of the angles, from which a run that is taken up again goes on.
    pub fn angles(&self) -> Vec<S> {
        let lasts = self.angles.iter();
        lasts.map(|(_, last)| last.unwrap_or(S::zero())).collect()
    }

    /// Goes on from such values; where they are as many as there are angles.
    pub fn take_up(&mut self, angles: &[S]) {
        if angles.len() == self.angles.len() {
            for ((_, last), angle) in self.angles.iter_mut().zip(angles) {
                *last = Some(*angle);
            }
        }
    }
}

/// `value + 2 pi k` within pi of the last value, lane by lane.
fn nearest<S: Scalar>(value: S, last: S) -> S {
    let mut found = value;
    for lane in 0..S::LANES {
        let turns = ((last.lane(lane) - value.lane(lane)).to_f64() / TAU).round();
        if turns != 0.0 && turns.is_finite() {
            let turn = S::Lane::constant(TAU, 2.449_293_598_294_706_4e-16);
            let value = value.lane(lane) + S::Lane::from_f64(turns) * turn;
            found = found.with_lane(lane, value);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Scalar;
    use core::f64::consts::PI;

    #[test]
    fn the_nearest_branch_is_taken() {
        for k in -5..5 {
            let branch = f64::from(k) * TAU;
            for offset in [-3.1, -1.0, 0.0, 1.0, 3.1] {
                let found: f64 = nearest(0.5 + offset, branch + 0.5);
                assert!(
                    (found - (branch + 0.5 + offset)).abs() < 1e-13,
                    "{k} {offset}"
                );
            }
        }
        assert_eq!(nearest(PI - 0.1, -PI + 0.1 + TAU), PI - 0.1);
        assert!(nearest(f64::NAN, 1.0).is_nan());
    }

    #[test]
    fn lanes_are_unwrapped_each_by_itself() {
        type Wide = <f64 as Scalar>::Wide;
        let lanes = |of: &dyn Fn(usize) -> f64| {
            (0..Wide::LANES).fold(Wide::zero(), |all, lane| all.with_lane(lane, of(lane)))
        };
        let (value, last) = (lanes(&|k| 0.1 * k as f64), lanes(&|k| 7.0 * k as f64));
        let found = nearest(value, last);
        for lane in 0..Wide::LANES {
            let alone = nearest(0.1 * lane as f64, 7.0 * lane as f64);
            assert_eq!(found.lane(lane), alone);
            assert!((alone - 7.0 * lane as f64).abs() <= PI);
        }
    }
}
