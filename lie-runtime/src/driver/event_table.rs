//! The events of a run by their names.

use super::events::Event;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use core::ops::Index;

/// When an event happened, and the states there, in order of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Occurrences<V> {
    /// Times.
    pub t: Vec<f64>,
    /// States.
    pub mu: Vec<V>,
}

/// The events of a run by their names.
#[derive(Clone, Debug, PartialEq)]
pub struct EventTable<V> {
    names: Vec<String>,
    all: Vec<Occurrences<V>>,
}

impl<V> EventTable<V> {
    /// Those of a system, none of which has happened.
    pub(super) fn of<S: Scalar, P: Poisson<S>>(system: &P) -> Self {
        let names = (0..system.event_count()).map(|index| system.event_name(index).to_owned());
        let names: Vec<String> = names.collect();
        let none = || Occurrences {
            t: Vec::new(),
            mu: Vec::new(),
        };
        Self {
            all: names.iter().map(|_| none()).collect(),
            names,
        }
    }

    /// Adds one that happened.
    pub(super) fn push(&mut self, event: &Event<V>)
    where
        V: Clone,
    {
        let occurrences = &mut self.all[event.index];
        occurrences.t.push(event.time);
        occurrences.mu.push(event.mu.clone());
    }

    /// The event of a name; none where the system declares no such event.
    pub fn get(&self, name: &str) -> Option<&Occurrences<V>> {
        let place = self.names.iter().position(|known| known == name)?;
        Some(&self.all[place])
    }

    /// All events with their names, in the order of the declaration.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Occurrences<V>)> {
        self.names.iter().map(String::as_str).zip(&self.all)
    }
}

impl<V> Index<&str> for EventTable<V> {
    type Output = Occurrences<V>;

    /// The event of a name.
    ///
    /// # Panics
    /// The system declares no such event.
    fn index(&self, name: &str) -> &Occurrences<V> {
        let Some(found) = self.get(name) else {
            panic!(
                "no event `{name}` is declared; these are: {}",
                self.names.join(", ")
            )
        };
        found
    }
}
