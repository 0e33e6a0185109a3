//! The declared functions that are recorded beside a run: angles without their jumps.

use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest, nearest_branch};
use crate::state::State;

/// The values of [`Poisson::quantities`] along a run. An angle whose jumps are taken out ([`Poisson::quantity_unwraps`]) is shown on
/// the branch `q + 2 pi k` that is nearest to where its rates at the last state and at this one lead, `q_0 + h (q'_0 + q'_1)/2`; where it is
/// looked at after every step, that is the right one unless this is off by more than pi.
#[derive(Clone, Debug)]
pub struct Quantities<S> {
    values: Vec<S>,
    angles: Vec<Angle<S>>,
    /// The time of the last state.
    time: f64,
}

/// An angle that is followed.
#[derive(Clone, Debug)]
struct Angle<S> {
    /// Its place among the quantities.
    place: usize,
    /// Its last value, and its rate there.
    last: Option<S>,
    rate: Option<S>,
}

impl<S: Scalar> Quantities<S> {
    /// Before the first state of a run.
    pub fn new<P: Poisson<S>>(system: &P) -> Self {
        let count = system.quantity_count();
        let angles = (0..count).filter(|&place| system.quantity_unwraps(place));
        let angle = |place| Angle {
            place,
            last: None,
            rate: None,
        };
        Self {
            values: vec![S::zero(); count],
            angles: angles.map(angle).collect(),
            time: 0.0,
        }
    }

    /// Whether states between those that are recorded matter, since there are angles to follow.
    pub fn has_angles(&self) -> bool {
        !self.angles.is_empty()
    }

    /// The values at a time and a state, the next one of the run.
    pub fn at<P: Poisson<S>>(&mut self, system: &P, time: f64, mu: &P::State) -> &[S] {
        if self.values.is_empty() {
            return &self.values;
        }
        system.quantities(mu, &mut self.values);
        // no work is not minus nothing
        self.values.iter_mut().for_each(|value| *value += S::zero());
        if self.angles.is_empty() {
            return &self.values;
        }
        let rates = self.rates(system, mu);
        let half = S::from_f64(0.5 * (time - self.time));
        for (angle, rate) in self.angles.iter_mut().zip(rates) {
            let value = &mut self.values[angle.place];
            if let Some(last) = angle.last {
                let led = angle
                    .rate
                    .map_or(last, |before| last + half * (before + rate));
                *value = nearest_branch(*value, S::select(led.finite(), led, last));
            }
            let finite = value.finite();
            // one that has no value is followed from where it had one
            angle.last = Some(S::select(finite, *value, angle.last.unwrap_or(S::zero())));
            angle.rate = Some(rate);
        }
        self.time = time;
        &self.values
    }

    /// The rates of the angles along the field, by a difference; 0 where noise moves them.
    fn rates<P: Poisson<S>>(&self, system: &P, mu: &P::State) -> Vec<S> {
        let (mut field, mut there) = (system.zero_state(), mu.clone());
        system.vector_field(mu, &mut field);
        let size = largest(system.norm(mu)).max(f64::MIN_POSITIVE);
        let short = f64::EPSILON.sqrt() * size / largest(system.norm(&field));
        if !short.is_finite() || short == 0.0 || system.noise_count() > 0 {
            return vec![S::zero(); self.angles.len()];
        }
        there.axpy(S::from_f64(short), &field);
        let mut moved = vec![S::zero(); self.values.len()];
        system.quantities(&there, &mut moved);
        let rate = |angle: &Angle<S>| {
            let value = self.values[angle.place];
            (nearest_branch(moved[angle.place], value) - value) / S::from_f64(short)
        };
        self.angles.iter().map(rate).collect()
    }

    /// The last values of the angles with their rates, and the time, from which a run that is taken up again goes on; nothing where there
    /// are none.
    pub fn angles(&self) -> Vec<S> {
        let known = |angle: &Angle<S>| [angle.last, angle.rate].map(|x| x.unwrap_or(S::zero()));
        let mut all: Vec<S> = self.angles.iter().flat_map(known).collect();
        if !all.is_empty() {
            all.push(S::from_f64(self.time));
        }
        all
    }

    /// Goes on from such values; where they are as many as there should be.
    pub fn take_up(&mut self, known: &[S]) {
        if let Some((time, angles)) = known.split_last()
            && angles.len() == 2 * self.angles.len()
        {
            self.time = time.lane(0).to_f64();
            for (angle, known) in self.angles.iter_mut().zip(angles.chunks(2)) {
                (angle.last, angle.rate) = (Some(known[0]), Some(known[1]));
            }
        }
    }
}
