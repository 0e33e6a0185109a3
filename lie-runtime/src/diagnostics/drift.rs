//! How far invariants move, as maxima over windows of a run.

use crate::driver::{Observer, Progress};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use core::ops::ControlFlow;

const WINDOWS: usize = 10;

/// How far one invariant has moved from its first value: the maximum over the whole run and over
/// each tenth of it. Of several lanes, the largest.
#[derive(Clone, Debug, PartialEq)]
pub struct InvariantDrift {
    /// The invariant.
    pub name: String,
    /// Its value at the start (of the first lane).
    pub initial: f64,
    /// The largest distance from the start, in the invariant's own units.
    pub max: f64,
    /// The same over each tenth of the run.
    pub windows: [f64; WINDOWS],
}

impl InvariantDrift {
    /// One that has not moved yet, from its first value where there is one.
    pub fn new<S: Scalar>(name: &str, initial: Option<S>) -> Self {
        let initial = initial.map_or(f64::NAN, |initial| initial.to_f64());
        Self {
            name: name.to_owned(),
            initial,
            max: 0.0,
            windows: [0.0; WINDOWS],
        }
    }

    /// Takes a distance from the start at a step of a run of so many.
    pub fn record(&mut self, distance: f64, step: u64, steps: u64) {
        let window = step.saturating_sub(1).saturating_mul(WINDOWS as u64) / steps.max(1);
        let window = &mut self.windows[(window as usize).min(WINDOWS - 1)];
        *window = Scalar::max(*window, distance);
        self.max = Scalar::max(self.max, distance);
    }

    /// The maximum of the last tenth over that of the first: about 1 for an error that stays
    /// bounded, about 10 for one that grows linearly. None if the first is 0.
    pub fn growth(&self) -> Option<f64> {
        (self.windows[0] > 0.0).then(|| self.windows[WINDOWS - 1] / self.windows[0])
    }

    /// The largest distance relative to the first value. None for an invariant that is zero, or as
    /// good as zero: smaller than its own change.
    pub fn relative(&self) -> Option<f64> {
        (self.initial.abs() > self.max).then(|| self.max / self.initial.abs())
    }
}

/// The drift of energy, Casimirs and first integrals.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Of the energy: of [`Poisson::hamiltonian`], which is conserved also where H depends on the time and the energy that is
    /// shown is not.
    pub energy: InvariantDrift,
    /// Of the Casimirs, without those that have several branches ([`Poisson::casimir_is_multivalued`]) or that forces change
    /// ([`Poisson::casimir_is_kept`]).
    pub casimirs: Vec<InvariantDrift>,
    /// Of the declared first integrals ([`Poisson::quantity_is_conserved`]).
    pub integrals: Vec<InvariantDrift>,
}

/// An observer that follows the drift over every step, saved or not.
#[derive(Clone, Debug)]
pub struct DriftMonitor<S> {
    energy: S,
    /// The Casimirs that are followed, by their places.
    followed: Vec<usize>,
    casimirs: Vec<S>,
    values: Vec<S>,
    /// The first integrals by their places, with their first values, and room for the values.
    integrals: Vec<(usize, S)>,
    quantities: Vec<S>,
    drift: Drift,
}

impl<S: Scalar> DriftMonitor<S> {
    /// A monitor that has seen nothing yet.
    pub fn new() -> Self {
        Self {
            energy: S::zero(),
            followed: Vec::new(),
            casimirs: Vec::new(),
            values: Vec::new(),
            integrals: Vec::new(),
            quantities: Vec::new(),
            drift: Drift {
                energy: InvariantDrift::new::<S>("energy", None),
                casimirs: Vec::new(),
                integrals: Vec::new(),
            },
        }
    }

    /// What was measured.
    pub fn drift(&self) -> &Drift {
        &self.drift
    }
}

impl<S: Scalar> Default for DriftMonitor<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar, P: Poisson<S>> Observer<S, P> for DriftMonitor<S> {
    fn start(&mut self, system: &P, _progress: Progress, mu: &P::State) {
        let count = system.casimir_count();
        self.energy = system.hamiltonian(mu);
        self.followed = (0..count)
            .filter(|&place| !system.casimir_is_multivalued(place) && system.casimir_is_kept(place))
            .collect();
        self.values = vec![S::zero(); count];
        system.casimirs(mu, &mut self.values);
        self.casimirs.clone_from(&self.values);
        let casimirs = self.followed.iter().map(|&place| {
            InvariantDrift::new(system.casimir_name(place), Some(self.casimirs[place]))
        });
        let count = system.quantity_count();
        self.quantities = vec![S::zero(); count];
        let conserved = (0..count).filter(|&place| system.quantity_is_conserved(place));
        let conserved: Vec<usize> = conserved.collect();
        if !conserved.is_empty() {
            system.quantities(mu, &mut self.quantities);
        }
        let integrals = conserved.into_iter();
        self.integrals = integrals
            .map(|place| (place, self.quantities[place]))
            .collect();
        let integrals = self
            .integrals
            .iter()
            .map(|&(place, first)| InvariantDrift::new(system.quantity_name(place), Some(first)));
        self.drift = Drift {
            energy: InvariantDrift::new("energy", Some(self.energy)),
            casimirs: casimirs.collect(),
            integrals: integrals.collect(),
        };
    }

    fn step(&mut self, system: &P, progress: Progress, mu: &P::State) -> ControlFlow<()> {
        let Progress { step, steps, .. } = progress;
        let change = (system.hamiltonian(mu) - self.energy).abs();
        self.drift.energy.record(largest(change), step, steps);
        system.casimirs(mu, &mut self.values);
        for (drift, &place) in self.drift.casimirs.iter_mut().zip(&self.followed) {
            let change = (self.values[place] - self.casimirs[place]).abs();
            drift.record(largest(change), step, steps);
        }
        if !self.integrals.is_empty() {
            system.quantities(mu, &mut self.quantities);
        }
        for (drift, &(place, first)) in self.drift.integrals.iter_mut().zip(&self.integrals) {
            let change = (self.quantities[place] - first).abs();
            drift.record(largest(change), step, steps);
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_tells_bounded_from_linear() {
        let mut bounded = InvariantDrift::new("C", Some(1.0));
        let mut linear = bounded.clone();
        for step in 1..=1000 {
            bounded.record(1e-3, step, 1000);
            linear.record(1e-6 * step as f64, step, 1000);
        }
        assert_eq!(bounded.growth(), Some(1.0));
        assert!((linear.growth().unwrap() - 10.0).abs() < 1e-9);
        assert_eq!(bounded.relative(), Some(1e-3));
    }

    #[test]
    fn what_jumps_is_not_followed() {
        use crate::driver::Progress;
        use crate::test_systems::{Spring, Winding};
        let progress = |step| Progress {
            step,
            steps: 2,
            time: 0.1 * step as f64,
        };
        let mut monitor = DriftMonitor::new();
        monitor.start(&Winding(Spring), progress(0), &[-1.0, 0.1].into());
        let _ = monitor.step(&Winding(Spring), progress(1), &[-1.0, -0.1].into());
        // the angle has jumped by 2 pi, which is no drift; the square of the radius has none
        let drift = monitor.drift();
        assert_eq!(drift.casimirs.len(), 1);
        assert_eq!(drift.casimirs[0].name, "square");
        assert_eq!(drift.casimirs[0].max, 0.0);
        let _ = monitor.step(&Winding(Spring), progress(2), &[-1.0, 0.0].into());
        assert!((monitor.drift().casimirs[0].max - 0.01).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_a_number_is_kept() {
        let mut drift = InvariantDrift::new("C", Some(1.0));
        drift.record(f64::NAN, 1, 2);
        drift.record(1.0, 2, 2);
        assert!(drift.max.is_nan());
    }

    #[test]
    fn nothing_relative_of_zero() {
        let mut drift = InvariantDrift::new("C", Some(1e-17));
        drift.record(1e-16, 1, 1);
        assert_eq!(drift.relative(), None);
        assert_eq!(InvariantDrift::new("C", Some(1.0)).growth(), None);
    }
}
