//! What a member gives, and what threads that run members have in common.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use lie_program::protocol::Event;
use lie_runtime::driver::OptionError;

/// The rows of a member, as many as it came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Member {
    /// Their times.
    pub times: Vec<f64>,
    /// Their states, one behind the other.
    pub states: Vec<f64>,
    /// When and why it ended early, if it did.
    pub failed: Option<(f64, String)>,
    /// Where an event ended it, if one did.
    pub stopped: Option<Stop>,
    /// Its events in order of the run, where they are kept.
    pub events: Vec<Event>,
    /// Options that suit no member.
    pub refused: Option<OptionError>,
}

/// An event that ended a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Which of the declared events it is.
    pub event: usize,
    /// When it happened.
    pub time: f64,
}

impl Member {
    pub(super) fn failing(time: f64, why: String) -> Self {
        Self {
            failed: Some((time, why)),
            ..Self::default()
        }
    }
}

/// What threads that run members have in common.
#[derive(Debug, Default)]
pub struct Watch {
    /// Whether all is to end early.
    pub stop: AtomicBool,
    /// So many members are done.
    pub done: AtomicUsize,
    /// Whether there was no memory for a row, which ends all.
    full: AtomicBool,
}

impl Watch {
    pub(super) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Whether there was no memory for a row.
    pub fn full(&self) -> bool {
        self.full.load(Ordering::Relaxed)
    }

    /// Ends all, since there is no memory for a row.
    pub(super) fn is_full(&self) {
        self.full.store(true, Ordering::Relaxed);
        self.stop.store(true, Ordering::Relaxed);
    }

    pub(super) fn done(&self, members: usize) {
        self.done.fetch_add(members, Ordering::Relaxed);
    }
}
