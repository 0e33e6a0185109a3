//! The declared functions that are recorded beside a run: angles without their jumps.

use crate::poisson::Poisson;
use crate::scalar::{Scalar, nearest_branch};

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
                *value = nearest_branch(*value, *last);
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
