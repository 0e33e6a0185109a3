//! Joints, where branches of H meet, and the orders that methods have across them.

use lie_codegen::methods::CATALOGUE;
use lie_symbolic::prove::joints::{Joint, reached};
use serde_json::{Value, json};

/// The methods with the reason why they do not apply.
pub type Methods = [(&'static str, Option<String>)];

/// The methods that apply, with their orders and those that they have across the joints.
pub fn orders_across<'a>(
    joints: &'a [Joint],
    methods: &'a Methods,
) -> impl Iterator<Item = (&'static str, u32, Option<u32>)> + 'a {
    let apply = methods.iter().filter(|(_, reason)| reason.is_none());
    apply.filter_map(|(id, _)| {
        let method = CATALOGUE.iter().find(|method| method.id == *id)?;
        let across = match ends_at_joints(id) {
            true => Some(method.order),
            false => reached(joints, method.order),
        };
        Some((*id, method.order, across))
    })
}

/// Whether a method ends its steps at joints, and keeps its order.
pub fn ends_at_joints(id: &str) -> bool {
    matches!(id, "taylor" | "lie-taylor")
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
    let orders = orders_across(joints, methods).map(|(id, _, order)| (id.to_owned(), order.into()));
    Value::Object(orders.collect())
}
