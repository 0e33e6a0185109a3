//! Events: functions that can have zeros.

use super::coordinates::Whole;
use super::expressions::Lowered;
use crate::model::Event;
use lie_core::EventRule;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// The events; those that are constant along every run are mistakes.
pub fn events(whole: &Whole<'_>, lowered: &Lowered, mistakes: &mut Vec<Diagnostic>) -> Vec<Event> {
    let declared = whole.declaration.events.iter().zip(&lowered.events);
    let mut events = Vec::new();
    for (event, expr) in declared {
        let symbols = lowered.graph.symbols(*expr);
        if !symbols.iter().any(|s| matches!(s, Symbol::Coordinate(_))) {
            let name = &event.name.text;
            let message =
                format!("the function of the event `{name}` does not depend on the state");
            mistakes.push(
                Diagnostic::new(Kind::Event, event.when.origin, message)
                    .help("write a function of the state or of the time that passes through zero, such as `z - 1/2`"),
            );
        }
        events.push(Event {
            name: event.name.text.clone(),
            origin: event.when.origin,
            expr: *expr,
            rule: EventRule {
                direction: event.direction,
                stops: event.stop,
            },
        });
    }
    events
}
