//! The methods that a declaration names, in `methods` and in `run`: each must be built, and apply
//! to the system.

use super::{Choice, kind_of_refusal, refusal};
use crate::structure::Structure;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin, Report};

/// Reports the methods of the declaration that cannot be had, with the reason.
pub fn check(structure: &Structure, report: &mut Report) {
    for name in &structure.methods {
        check_one(structure, &name.text, name.origin, report);
    }
    for option in structure
        .run
        .iter()
        .filter(|option| option.name.text == "method")
    {
        if let Some((id, origin)) = option.values.first() {
            check_one(structure, id, *origin, report);
        }
    }
}

fn check_one(structure: &Structure, id: &str, origin: Origin, report: &mut Report) {
    let (kind, (message, help)) = match Choice::from_id(id) {
        Err(unusable) => (Kind::Method, (unusable.message, unusable.help)),
        // it is had with those of its options that apply
        Ok(choice) => {
            let refused = |choice: &Choice| refusal(structure, choice).is_some();
            match refusal(structure, &choice) {
                Some(reason) if choice.variants().iter().all(refused) => {
                    (kind_of_refusal(&choice), reason)
                }
                _ => return,
            }
        }
    };
    report.push(Diagnostic::new(kind, origin, message).help(help));
}
