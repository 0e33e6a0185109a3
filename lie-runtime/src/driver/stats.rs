//! The work of a run, and how it ended.

pub use crate::methods::Stats;

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// At the end of the span.
    #[default]
    Finished,
    /// Before it, at an event that ends the run, the one with this number.
    Event(usize),
    /// Before it, because an observer asked for it.
    Stopped,
    /// Before it, because a step failed.
    Failed,
}
