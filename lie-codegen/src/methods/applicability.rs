//! Which methods a system can carry.

use super::{Availability, CATALOGUE, Choice, Retraction};
use crate::diagnostic::Kind;
use crate::model::Model;
use crate::structure::separable;

/// Why a method does not apply to a system, with the nearest one that does; `None` if it applies.
pub fn refusal(model: &Model, choice: &Choice) -> Option<(String, String)> {
    if let Choice::Compose(_, _, base) = choice {
        return refusal(model, base);
    }
    if let Choice::Splitting(order, _) = choice {
        return separable::refusal(model, *order);
    }
    let Choice::LieMidpoint(Retraction::Cayley) = choice else {
        return None;
    };
    let reason = match &model.representation {
        None => {
            "the Cayley map needs a matrix representation, and the algebra declares no `matrices`"
        }
        Some(representation) if representation.triple.is_none() => {
            "the Cayley map needs a representation whose span is closed under (abc + cba)/2, \
             and the declared `matrices` are not"
        }
        Some(_) => return None,
    };
    Some((
        reason.into(),
        "use `lie-midpoint` with `--retraction exp`, which works for every Lie algebra".into(),
    ))
}

/// The kind of the mistake to ask for a method of a system that cannot carry it.
pub fn kind_of_refusal(choice: &Choice) -> Kind {
    match choice.solved() {
        Choice::Splitting(..) => Kind::Splitting,
        _ => Kind::Method,
    }
}

/// Every method of the catalogue with the reason why it cannot be used, if there is one.
pub fn applicability(model: &Model) -> Vec<(&'static str, Option<String>)> {
    CATALOGUE
        .iter()
        .map(|method| {
            let composition = method.id.starts_with("compose");
            let reason = match (method.availability, Choice::from_id(method.id)) {
                (Availability::Planned, _) => Some("not built yet".to_string()),
                // the midpoint rule applies to every system
                (Availability::Built, _) if composition => None,
                (Availability::Built, Err(unusable)) => Some(unusable.message),
                (Availability::Built, Ok(choice)) => {
                    refusal(model, &choice).map(|(reason, _)| reason)
                }
            };
            (method.id, reason)
        })
        .collect()
}
