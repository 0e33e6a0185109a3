//! The methods that get fused code: each must be built, and apply to the system.

use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::methods::{Choice, refusal};
use crate::model::Model;

/// Reports the methods of the declaration that cannot be had, with the reason.
pub fn check(model: &Model, report: &mut Report) {
    for name in &model.methods {
        let (message, help) = match Choice::from_id(&name.text) {
            Err(unusable) => (unusable.message, unusable.help),
            Ok(choice) => match refusal(model, choice) {
                Some(reason) => reason,
                None => continue,
            },
        };
        report.push(Diagnostic::new(Kind::Method, name.origin, message).help(help));
    }
}
