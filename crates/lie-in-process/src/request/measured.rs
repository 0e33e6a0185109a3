//! What measurements are asked for beside methods and a start.

use super::plan::Planner;
use super::{Request, constant};
use crate::message::Message;
use crate::spec::Spec;

/// The longest span of a comparison that is taken from a spec, and that of one that says nothing.
const SPANS: (f64, f64) = (20.0, 10.0);

/// The end of a comparison of methods: as asked for, else that of the spec, if it is not too long.
///
/// # Errors
/// There is nothing to integrate.
pub fn span(spec: &Spec, request: &Request) -> Result<f64, Message> {
    let planner = Planner::new(spec, request);
    let Some(given) = planner.requested("until") else {
        let declared = planner.in_spec("until");
        let declared = declared.iter().find_map(|given| constant(&given.text).ok());
        let (longest, usual) = SPANS;
        let from = planner.in_spec("from");
        let from = from.iter().find_map(|given| constant(&given.text).ok());
        let span = declared.map(|end| end - from.unwrap_or(0.0));
        return Ok(span.map_or(usual, |span| span.clamp(-longest, longest)));
    };
    let value = given.number()?;
    if value == 0.0 {
        let example = request.front.assignment("until", "10");
        let message = given.wrong("there is nothing to integrate until t = 0");
        return Err(message.help(format!("give an end such as {example}")));
    }
    Ok(value)
}

/// The step at which facts are measured, where one is asked for.
///
/// # Errors
/// It measures nothing.
pub fn step_of_facts(spec: &Spec, request: &Request) -> Result<Option<f64>, Message> {
    let Some(given) = Planner::new(spec, request).requested("step") else {
        return Ok(None);
    };
    let value = given.number()?;
    if value == 0.0 {
        let example = request.front.assignment("step", "0.1");
        let message = given.wrong("a step of zero measures nothing");
        return Err(message.help(format!("leave it out, or give a step such as {example}")));
    }
    Ok(Some(value))
}
