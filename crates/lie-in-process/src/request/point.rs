//! Where a system starts.

use lie_program::protocol::Start;

use super::Request;
use super::plan::Planner;
use crate::message::Message;
use crate::spec::Spec;

/// The values of the parameters and the initial state, in order.
#[derive(Clone)]
pub struct Point {
    /// Values of the parameters.
    pub parameters: Vec<f64>,
    /// The initial state.
    pub initial: Vec<f64>,
}

impl Point {
    /// The same as programs take it.
    pub fn named(self, spec: &Spec) -> Start {
        let names = spec.model.parameters.iter().map(|p| p.name.clone());
        Start {
            parameters: names.zip(self.parameters).collect(),
            initial: self.initial,
        }
    }
}

/// Where a system starts, alone.
///
/// # Errors
/// Every mistake.
pub fn start(spec: &Spec, request: &Request) -> Result<Point, Vec<Message>> {
    let mut planner = Planner::new(spec, request);
    match planner.start() {
        Some(start) if planner.mistakes.is_empty() => Ok(start),
        _ => Err(planner.mistakes),
    }
}
