//! Why a method is the one it is, where a tolerance has chosen it.

use lie_codegen::methods::Choice;
use lie_codegen::model::Driving;
use lie_in_process::request::Plan;

use crate::command::fold::folded;
use crate::compiler::Spec;
use crate::render;

/// Says it of the first plan whose method was chosen.
pub(super) fn say(spec: &Spec, plans: &[Plan]) {
    let Some(plan) = plans.iter().find(|plan| plan.picked) else {
        return;
    };
    let mut options = spec.model.run.iter();
    let of_spec = options.find(|option| option.name.text == "method");
    let of_spec = of_spec.and_then(|option| option.values.first());
    let id = plan.method.id();
    let of_spec = of_spec.filter(|(method, _)| method.trim() != id);
    let replaced = of_spec.map_or(String::new(), |(method, _)| {
        format!(" in place of {}, which the spec names", method.trim())
    });
    let series = matches!(plan.method, Choice::Taylor | Choice::LieTaylor);
    let why = match plan.kept(spec).is_empty() {
        true if series => "branches of H or of a force meet, and its steps end there".to_owned(),
        true => {
            let order = plan.method.entry().map_or(0, |entry| entry.order);
            let model = &spec.model;
            let forced = |driving: &Driving| driving.is_forced(&model.graph);
            match &model.driving {
                None => format!(
                    "it applies to every system, has order {order}, and keeps quadratic Casimirs and a quadratic energy to round-off"
                ),
                Some(driving) if !forced(driving) => format!(
                    "it applies to every system, has order {order}, and keeps quadratic Casimirs to round-off"
                ),
                Some(_) => format!("it applies to every system and has order {order}"),
            }
        }
        false => {
            "something is to be kept, and it is explicit, as a projection behind its steps needs"
                .to_owned()
        }
    };
    let text = format!("{id} was picked{replaced}: {why}; --method chooses another");
    render::say(&folded(&text));
}
