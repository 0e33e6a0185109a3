//! The key `events`.

use super::line;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::entries::Awaited;
use crate::front::item;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, wrong_type};
use crate::front::schema::Event;

/// Reads events by their names. One with a mistake is left out.
pub fn read(value: Value<'_>, report: &mut Report) -> Vec<Awaited<'static>> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`events`", "an object"));
        return Vec::new();
    }
    let mut read = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("the event `{}`", member.key.text.escape_debug());
        let Some(object) = Object::read(member.value, &what, Event::KEYS, report) else {
            continue;
        };
        object.require(&what, Event::REQUIRED, report);
        let direction = object.get("direction");
        let direction = direction.map_or(Some(0), |value| direction_of(&value, report));
        let stop = object.get("stop").map_or(Some(false), |flag| {
            if flag.boolean().is_none() {
                report.push(wrong_type(&flag, "`stop`", "a boolean"));
            }
            flag.boolean()
        });
        let when = object.get("when");
        let when = when.and_then(|value| line(value, &format!("`when` of {what}"), report));
        let all = name.zip(when).zip(direction.zip(stop));
        read.extend(all.map(|((name, when), (direction, stop))| Awaited {
            name,
            when,
            direction,
            stop,
        }));
    }
    read
}

fn direction_of(value: &Value<'_>, report: &mut Report) -> Option<i8> {
    let found = match value.raw() {
        "-1" => Some(-1),
        "0" => Some(0),
        "1" => Some(1),
        _ => None,
    };
    if found.is_none() {
        let message = "the direction of an event is -1, 0 or 1";
        let help =
            "write 1 for zeros where the function rises, -1 for those where it falls, 0 for both";
        report.push(Diagnostic::new(Kind::Schema, value.origin(), message).help(help));
    }
    found
}
