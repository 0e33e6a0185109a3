//! The methods that a declaration names, in `methods` and in `run`.

use super::{Choice, refusal};
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::model::Model;

/// Reports methods that do not exist, are not built, or that the system cannot carry.
pub fn check(model: &Model, report: &mut Report) {
    let mut seen: Vec<&str> = Vec::new();
    for Name { text, origin } in &model.methods {
        if seen.contains(&text.as_str()) {
            report.push(
                Diagnostic::new(Kind::Method, *origin, format!("the method `{text}` is listed twice"))
                    .help("list it once"),
            );
        }
        seen.push(text);
        check_one(model, text, *origin, report);
    }
    for option in model.run.iter().filter(|option| option.name.text == "method") {
        if let Some((text, origin)) = option.values.first() {
            check_one(model, text, *origin, report);
        }
    }
}

fn check_one(model: &Model, id: &str, origin: Origin, report: &mut Report) {
    match Choice::from_id(id) {
        Err(unusable) => report.push(Diagnostic::new(Kind::Method, origin, unusable.message).help(unusable.help)),
        Ok(choice) => {
            if let Some((reason, help)) = refusal(model, choice) {
                report.push(
                    Diagnostic::new(Kind::Method, origin, format!("`{id}` does not apply: {reason}")).help(help),
                );
            }
        }
    }
}
