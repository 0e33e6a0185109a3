//! Branches that do not fit together: where a Hamiltonian or its gradient jumps, a method has next to no order.

use crate::ast::Declaration;
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::model::Model;
use crate::prove::joints::Joint;
use crate::structure::smoothness::joints;

/// Warns of joints at which the Hamiltonian or its gradient jumps.
pub fn check(declaration: &Declaration, model: &Model, report: &mut Report) {
    let place = declaration.energy.expression().origin;
    let warnings = joints(model)
        .into_iter()
        .filter_map(|joint| warning(&joint));
    for (message, help) in warnings {
        report.push(
            Diagnostic::new(Kind::Smoothness, place, message)
                .help(help)
                .warning(),
        );
    }
}

fn warning(joint: &Joint) -> Option<(String, &'static str)> {
    let place = &joint.place;
    match joint.jump? {
        0 => Some((
            format!(
                "the function jumps where {place}: no energy is kept across it, no method has an order there, and `taylor` and `lie-taylor` \
                 go on as if it were not there"
            ),
            "make the branches equal where they meet",
        )),
        1 => Some((
            format!(
                "the gradient jumps where {place}: a method that crosses it has order 1 there, but `taylor` and `lie-taylor`, which go on as if \
                 it were not there"
            ),
            "make the derivatives of the branches equal where they meet, or round the corner off: `sqrt(x^2 + a^2)` for `abs(x)`",
        )),
        _ => None,
    }
}
