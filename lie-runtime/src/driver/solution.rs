//! What a run has saved.

use super::event_table::EventTable;
use super::pace::{Assessed, Chosen};
use super::stats::{Stats, Status};
use crate::diagnostics::{Drift, InvariantDrift};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;
use std::io;

/// The saved states of a run with energy, Casimirs and declared functions, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<S, V> {
    /// Times.
    pub t: Vec<f64>,
    /// States.
    pub mu: Vec<V>,
    /// Energies H(mu).
    pub energy: Vec<S>,
    /// Casimirs, all of a row together.
    pub casimirs: Vec<Vec<S>>,
    /// Declared functions of the state ([`Poisson::quantities`]), all of a row together.
    pub quantities: Vec<Vec<S>>,
    /// The events that the system declares, by their names: `solution.events["down"].t` and `.mu`.
    pub events: EventTable<V>,
    /// The work of the run.
    pub stats: Stats,
    /// The step that was chosen, where the options gave a tolerance.
    pub chosen: Option<Chosen>,
    /// The last and smallest step, where the one that was chosen had to be shortened on the way.
    pub shortened: Option<f64>,
    /// The error at the end, where the options asked for it.
    pub assessed: Option<Assessed>,
    /// From when on the steps of a run with a tolerance are too long for it, and could not be made shorter.
    pub lost: Option<f64>,
    /// By which factor the steps differ that the tolerance allows along the run, where it is so large that steps which follow the motion
    /// would be faster.
    pub uneven: Option<f64>,
    /// How the run ended.
    pub status: Status,
    /// The names of the coordinates.
    pub coordinates: Vec<String>,
    /// The names of the Casimirs.
    pub casimir_names: Vec<String>,
    /// The names of the declared functions.
    pub quantity_names: Vec<String>,
    /// Which of them are first integrals.
    pub(super) conserved: Vec<bool>,
}

impl<S, V> Solution<S, V> {
    /// Nothing saved yet.
    pub(super) fn empty<P: Poisson<S>>(system: &P) -> Self
    where
        S: Scalar,
    {
        let coordinates = (0..system.dimension()).map(|i| system.coordinate(i).to_owned());
        let casimirs = (0..system.casimir_count()).map(|i| system.casimir_name(i).to_owned());
        let quantities = 0..system.quantity_count();
        let names = quantities
            .clone()
            .map(|i| system.quantity_name(i).to_owned());
        Self {
            t: Vec::new(),
            mu: Vec::new(),
            energy: Vec::new(),
            casimirs: Vec::new(),
            quantities: Vec::new(),
            events: EventTable::of(system),
            stats: Stats::default(),
            chosen: None,
            shortened: None,
            assessed: None,
            lost: None,
            uneven: None,
            status: Status::Finished,
            coordinates: coordinates.collect(),
            casimir_names: casimirs.collect(),
            quantity_names: names.collect(),
            conserved: quantities
                .map(|i| system.quantity_is_conserved(i))
                .collect(),
        }
    }

    /// The number of rows.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// No rows: the run failed before the first.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// The state saved at a time, to the last digits of the time; none if that time was not saved.
    pub fn at(&self, time: f64) -> Option<&V> {
        let scale = time
            .abs()
            .max(self.t.first()?.abs())
            .max(self.t.last()?.abs());
        let close = |&saved: &f64| (saved - time).abs() <= 1e-14 * scale;
        self.t.iter().position(close).map(|index| &self.mu[index])
    }

    /// The values of a declared function in all rows, by its name.
    pub fn quantity(&self, name: &str) -> Option<impl Iterator<Item = &S>> {
        let place = self.quantity_names.iter().position(|known| known == name)?;
        Some(self.quantities.iter().map(move |row| &row[place]))
    }

    /// The last row: its time and state.
    pub fn last(&self) -> Option<(f64, &V)> {
        Some((*self.t.last()?, self.mu.last()?))
    }
}

impl<S: Scalar, V> Solution<S, V> {
    /// How far energy, Casimirs and first integrals have moved from their first value, over the saved states.
    /// For the maximum over every step let a [`crate::diagnostics::DriftMonitor`] look on.
    pub fn drift(&self) -> Drift {
        let rows = self.t.len();
        let follow = |name: &str, value: &dyn Fn(usize) -> S| {
            let mut drift = InvariantDrift::new(name, (rows > 0).then(|| value(0)));
            for row in 1..rows {
                let change = (value(row) - value(0)).abs();
                drift.record(largest(change), row as u64, rows as u64 - 1);
            }
            drift
        };
        Drift {
            energy: follow("energy", &|row| self.energy[row]),
            casimirs: (self.casimir_names.iter().enumerate())
                .map(|(index, name)| follow(name, &|row| self.casimirs[row][index]))
                .collect(),
            integrals: (self.quantity_names.iter().enumerate())
                .filter(|(index, _)| self.conserved[*index])
                .map(|(index, name)| follow(name, &|row| self.quantities[row][index]))
                .collect(),
        }
    }
}

impl<S: Scalar<Mask = bool>, V: State<S>> Solution<S, V> {
    /// Writes the rows as CSV: a header `t,<coordinates>,energy,<Casimirs>,<declared functions>`, then numbers with as
    /// many digits as reading them back needs.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, mut writer: impl io::Write) -> io::Result<()> {
        write!(writer, "t")?;
        for name in &self.coordinates {
            write!(writer, ",{name}")?;
        }
        write!(writer, ",energy")?;
        for name in self.casimir_names.iter().chain(&self.quantity_names) {
            write!(writer, ",{name}")?;
        }
        writeln!(writer)?;
        for (row, &time) in self.t.iter().enumerate() {
            write!(writer, "{time:?}")?;
            let invariants = core::iter::once(&self.energy[row]).chain(&self.casimirs[row]);
            let recorded = invariants.chain(&self.quantities[row]);
            for value in self.mu[row].as_slice().iter().chain(recorded) {
                write!(writer, ",{:?}", value.to_f64())?;
            }
            writeln!(writer)?;
        }
        writer.flush()
    }
}
