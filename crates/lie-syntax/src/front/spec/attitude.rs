//! The key `attitude`.

use super::vectors;
use crate::ast::Name;
use crate::diagnostic::Report;
use crate::front::attitude::Written;
use crate::front::json::Value;
use crate::front::object::{Object, string};
use crate::front::{Names, schema};

/// `{"quaternion": [1, 0, 0, 0]}`, `{"matrix": [[…]]}`, `{"euler": "zxz", "angles": […]}`
pub fn read(value: Value<'_>, names: &Names, report: &mut Report) -> Option<Written> {
    let origin = value.head();
    let object = Object::read(value, "the attitude", schema::Attitude::KEYS, report)?;
    object.require("the attitude", schema::Attitude::REQUIRED, report);
    let (mut euler, mut fields) = (None, Vec::new());
    for member in object.members() {
        if member.key.text == "euler" {
            let sequence = string(member.value, "`euler`", report)?;
            euler = Some(Name {
                origin: sequence.extent(),
                text: sequence.text.into_owned(),
            });
            continue;
        }
        let name = Name {
            text: member.key.text.to_string(),
            origin: member.key.extent(),
        };
        fields.push((name, vectors::vector(member.value, names, report)?));
    }
    Some(Written {
        euler,
        fields,
        origin,
    })
}
