//! From a problem to a solution: the loop over the time grid, what is saved, and observers.

mod assess;
mod by_stages;
mod checks;
mod course;
mod curve;
mod error;
mod grid;
mod group_matrix;
mod joints;
mod kept;
mod milestone;
mod observer;
mod options;
pub mod pace;
mod problem;
mod pulse;
pub mod reconstruction;
mod shorter;
mod solution;
mod solve;
mod stats;
mod trial;
mod watch;

pub use crate::methods::Keep;
pub use error::{SolveError, StepError};
pub use grid::{Grid, Place};
pub use milestone::{Division, MILESTONE, Milestone};
pub use observer::{EveryStep, Motion, Observer, Progress, Recorder};
pub use options::{OptionError, Options, Pace, Save};
pub use pace::{Assessed, Chosen};
pub use problem::{IntoState, Problem, set_time};
pub use reconstruction::{Chart, Reconstruction};
pub use solution::Solution;
pub use solve::{IntegrateError, integrate, solve, solve_observed, take_up};
pub use stats::{Stats, Status};
pub use watch::Watched;
