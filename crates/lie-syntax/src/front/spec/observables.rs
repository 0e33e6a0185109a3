//! The key `observables`.

use super::line;
use crate::diagnostic::Report;
use crate::front::entries::{Line, Recorded};
use crate::front::item;
use crate::front::json::{Type, Value};
use crate::front::object::{Object, wrong_type};
use crate::front::schema::DescribedObservable;

/// Reads observables by their names. One with a mistake is left out.
pub fn read(value: Value<'_>, report: &mut Report) -> Vec<Recorded<'static>> {
    if value.kind() != Type::Object {
        report.push(wrong_type(&value, "`observables`", "an object"));
        return Vec::new();
    }
    let mut read = Vec::new();
    for member in value.members(report) {
        let name = item::name(&member.key.tokens(), member.key.extent(), report);
        let what = format!("the observable `{}`", member.key.text.escape_debug());
        let written = written(member.value, &what, report);
        let both = name.zip(written);
        read.extend(both.map(|(name, (value, unwrap))| Recorded {
            name,
            value,
            unwrap,
        }));
    }
    read
}

/// The expression, or an object with it.
fn written(value: Value<'_>, what: &str, report: &mut Report) -> Option<(Line<'static>, bool)> {
    if value.kind() != Type::Object {
        return Some((line(value, what, report)?, false));
    }
    let object = Object::read(value, what, DescribedObservable::KEYS, report)?;
    object.require(what, DescribedObservable::REQUIRED, report);
    let unwrap = object.get("unwrap").is_some_and(|flag| {
        if flag.boolean().is_none() {
            report.push(wrong_type(&flag, "`unwrap`", "a boolean"));
        }
        flag.boolean() == Some(true)
    });
    Some((line(object.get("expression")?, what, report)?, unwrap))
}
