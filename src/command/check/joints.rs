//! What `lie check` says of joints, where branches of H meet, and of the orders that methods have across them.

use std::fmt::Write as _;

use lie_codegen::methods::CATALOGUE;
use lie_codegen::structure::smoothness::{Joint, reached};
use serde_json::{Value, json};

/// The methods with the reason why they do not apply.
type Methods = [(&'static str, Option<String>)];

/// The methods that apply, with their orders and those that they have across the joints.
fn across<'a>(
    joints: &'a [Joint],
    methods: &'a Methods,
) -> impl Iterator<Item = (&'static str, u32, Option<u32>)> + 'a {
    let apply = methods.iter().filter(|(_, reason)| reason.is_none());
    apply.filter_map(|(id, _)| {
        let method = CATALOGUE.iter().find(|method| method.id == *id)?;
        Some((*id, method.order, reached(joints, method.order)))
    })
}

/// The joints by lines, and what methods lose.
pub(super) fn write(joints: &[Joint], methods: &Methods, text: &mut String) -> std::fmt::Result {
    if joints.is_empty() {
        return Ok(());
    }
    writeln!(text, "  joints, where branches of H meet:")?;
    for joint in joints {
        writeln!(text, "    {}: {}", joint.place, smoothness(joint.jump))?;
    }
    let Some(most) = reached(joints, u32::MAX) else {
        return writeln!(
            text,
            "    no order is known of a method whose steps cross a joint that was not decided"
        );
    };
    let lose = across(joints, methods).filter(|(_, order, _)| *order > most);
    let lose: Vec<String> = lose
        .map(|(id, order, _)| format!("{id} ({order})"))
        .collect();
    let title = match most {
        0 => "    no order where a step crosses them: ".to_owned(),
        most => format!(
            "    order {most} where steps cross them, in place of the order in parentheses: "
        ),
    };
    let lose: Vec<&str> = lose.iter().map(String::as_str).collect();
    match lose.is_empty() {
        true => writeln!(text, "    every method that applies keeps its order"),
        false => super::list(text, &title, &lose),
    }
}

/// What is continuous at a joint, by the order of the first derivative that jumps.
fn smoothness(jump: Option<u32>) -> String {
    match jump {
        None => "whether H is continuous there, or how smooth, could not be decided".to_owned(),
        Some(0) => "H jumps".to_owned(),
        Some(1) => "H is continuous, its gradient jumps; methods have order 1 at most".to_owned(),
        Some(2) => "H is once continuously differentiable, the second derivative jumps; methods have order 2 at most".to_owned(),
        Some(jump) => format!(
            "H is {} times continuously differentiable, the derivative of order {jump} jumps; methods have order {jump} at most",
            jump - 1
        ),
    }
}

/// The joints for programs: `differentiable` is -1 where H jumps, null where it is not decided.
pub(super) fn json(joints: &[Joint]) -> Value {
    let joints = joints.iter();
    joints
        .map(|joint| {
            json!({
                "place": joint.place,
                "differentiable": joint.jump.map(|jump| i64::from(jump) - 1),
                "order": joint.jump,
            })
        })
        .collect()
}

/// The orders across the joints, of the methods that apply; null of H without joints, and of a method where none is known.
pub(super) fn orders(joints: &[Joint], methods: &Methods) -> Value {
    if joints.is_empty() {
        return Value::Null;
    }
    let orders = across(joints, methods).map(|(id, _, order)| (id.to_owned(), order.into()));
    Value::Object(orders.collect())
}
