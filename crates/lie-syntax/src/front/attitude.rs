//! The initial group element, in the form that both front ends hand on.

use lie_core::structure::EulerSequence;

use super::vectors::Value;
use crate::ast::{Attitude, AttitudeForm, Expr, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin};

const HELP: &str =
    "give one of `quaternion`, `matrix`, and `euler` with `angles`: they all say the same";
const SEQUENCES: &str = "write the axes in their order, such as `zxz` or `zyx`: three letters of x, y, z, neighbours different";

/// An initial group element as it was written.
pub struct Written {
    /// The sequence of Euler angles.
    pub euler: Option<Name>,
    /// What is given for the other keys.
    pub fields: Vec<(Name, Value)>,
    /// Where it stands.
    pub origin: Origin,
}

impl Written {
    /// What it declares.
    ///
    /// # Errors
    /// It is given in no way or in several, has another number of entries, or its sequence is none.
    pub fn attitude(self, kind: Kind) -> Result<Attitude, Box<Diagnostic>> {
        let origin = self.origin;
        let wrong = |place, message: String, help: &str| {
            Err(Diagnostic::new(kind, place, message).help(help).into())
        };
        let fields = self.fields.into_iter();
        let mut fields = fields.map(|(name, value)| (name.text.clone(), name, value));
        let first = fields.next();
        if let Some((_, other, _)) = fields.next() {
            let message = "the attitude is given twice".to_owned();
            return wrong(other.origin, message, HELP);
        }
        let form = match (self.euler, first) {
            (None, None) => return wrong(origin, "the attitude has no entries".into(), HELP),
            (Some(euler), None) => {
                let message = "the attitude has no `angles`".to_owned();
                return wrong(
                    euler.origin,
                    message,
                    "give three angles in radians: `angles`",
                );
            }
            (Some(euler), Some((key, _, value))) if key == "angles" => {
                let Ok(sequence) = euler.text.parse::<EulerSequence>() else {
                    let message = format!("`{}` is no sequence of axes", euler.text.escape_debug());
                    return wrong(euler.origin, message, SEQUENCES);
                };
                AttitudeForm::Euler(sequence, listed("angles", value, &euler, kind)?)
            }
            (Some(euler), Some(_)) => {
                let message = "the attitude is given twice".to_owned();
                return wrong(euler.origin, message, HELP);
            }
            (None, Some((key, name, value))) => match (key.as_str(), value) {
                ("quaternion", value) => {
                    AttitudeForm::Quaternion(listed("quaternion", value, &name, kind)?)
                }
                ("matrix", Value::Matrix(rows)) => AttitudeForm::Matrix(rows),
                ("matrix", _) => {
                    let message = "the matrix of the attitude is none".to_owned();
                    let help = "write its rows, as in `[[0, -1, 0], [1, 0, 0], [0, 0, 1]]`";
                    return wrong(name.origin, message, help);
                }
                _ => {
                    let message = "the angles of the attitude have no sequence".to_owned();
                    return wrong(
                        name.origin,
                        message,
                        "name their axes by `euler`, such as `zxz`",
                    );
                }
            },
        };
        Ok(Attitude { form, origin })
    }
}

/// The entries of a list of this length.
fn listed<const N: usize>(
    key: &str,
    value: Value,
    name: &Name,
    kind: Kind,
) -> Result<[Expr; N], Box<Diagnostic>> {
    let count = match &value {
        Value::Vector(entries) => entries.len(),
        Value::Scalar(_) | Value::Matrix(_) => 0,
    };
    if let Value::Vector(entries) = value
        && let Ok(entries) = <[Expr; N]>::try_from(entries)
    {
        return Ok(entries);
    }
    let message = match count {
        0 => format!("`{key}` is a list of {N} numbers"),
        _ => format!("`{key}` has {count} entries, and needs {N}"),
    };
    let help = match N {
        4 => "write the real part first, as in `[1, 0, 0, 0]`",
        _ => "write phi, theta, psi in radians, as in `[0, pi/3, 0]`",
    };
    Err(Diagnostic::new(kind, name.origin, message)
        .help(help)
        .into())
}
