//! What `lie check` says of joints, where branches of H meet, and of the orders that methods have across them.

use std::fmt::Write as _;

use lie_in_process::report::joints::{Methods, ends_at_joints, orders_across};
use lie_symbolic::prove::joints::{Joint, reached};

/// The joints by lines, and what methods lose.
pub(super) fn write(joints: &[Joint], methods: &Methods, text: &mut String) -> std::fmt::Result {
    if joints.is_empty() {
        return Ok(());
    }
    writeln!(text, "  joints, where branches of H meet:")?;
    for joint in joints {
        let smoothness = match joint.is_known {
            true => "steps of a run end there, and no method loses its order".to_owned(),
            false => smoothness(joint.jump),
        };
        writeln!(text, "    {}: {smoothness}", joint.place)?;
    }
    if joints.iter().all(|joint| joint.is_known) {
        return Ok(());
    }
    let series = orders_across(joints, methods).filter(|(id, ..)| ends_at_joints(id));
    let series: Vec<&str> = series.map(|(id, ..)| id).collect();
    if !series.is_empty() {
        let title = "    steps that end at them, and the whole order: ";
        super::list(text, title, &series)?;
    }
    let Some(most) = reached(joints, u32::MAX) else {
        return writeln!(
            text,
            "    no order is known of a method whose steps cross a joint that was not decided"
        );
    };
    let lose = orders_across(joints, methods)
        .filter(|(id, order, _)| *order > most && !ends_at_joints(id));
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
