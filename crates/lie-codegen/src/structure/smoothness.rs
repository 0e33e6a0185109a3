//! How smooth the Hamiltonian of a system is, and its Lagrangian.

use super::Structure;
use crate::model::{Configuration, Family, Model};
use lie_symbolic::prove::joints::{Joint, find_joints};
use lie_symbolic::symbolic::Symbol;
use lie_syntax::diagnostic::{Diagnostic, Kind, Report};

/// The joints of the Hamiltonian of a system, or of its Lagrangian.
pub fn joints(model: &Model) -> Vec<Joint> {
    let name = |symbol| model.symbol_name(symbol);
    match &model.family {
        Some(family) => of_family(model, family),
        None => {
            let force = model.driving.iter().flat_map(|driving| &driving.force);
            let clock = model.configuration.as_ref().and_then(Configuration::clock);
            let known = |symbol| match symbol {
                Symbol::Coordinate(place) => clock.is_some_and(|clock| clock.time == place),
                symbol => matches!(symbol, Symbol::Parameter(_)),
            };
            let mut all = find_joints(&model.graph, model.hamiltonian(), &name, &known);
            for force in force {
                let joints = find_joints(&model.graph, *force, &name, &known);
                // a rate that jumps is what a gradient is that does
                let joints = joints.into_iter().map(|joint| Joint {
                    jump: joint.jump.map(|jump| jump + 1),
                    ..joint
                });
                all.extend(joints);
            }
            all
        }
    }
}

/// The joints of the summands of a family, and of the function of its sums.
fn of_family(model: &Model, family: &Family) -> Vec<Joint> {
    let sites = |symbol| match symbol {
        Symbol::Coordinate(place) => match family.names.get(place) {
            Some(name) => name.clone(),
            None => format!("sum{}", place - family.names.len() + 1),
        },
        other => model.acting_name(other),
    };
    let moving = family.sums.iter().filter(|sum| sum.moves);
    let summands = moving.map(|sum| sum.summand);
    let mut all: Vec<Joint> = Vec::new();
    for function in summands.chain([family.energy]) {
        for joint in find_joints(&model.graph, function, &sites, &|_| false) {
            if !all.contains(&joint) {
                all.push(joint);
            }
        }
    }
    all
}

/// Warns of joints at which the Hamiltonian or its gradient jumps: there a method has next to no order.
pub fn check(structure: &Structure, report: &mut Report) {
    for (message, help) in structure.joints.iter().filter_map(warning) {
        report.push(
            Diagnostic::new(Kind::Smoothness, structure.energy_origin, message)
                .help(help)
                .warning(),
        );
    }
}

fn warning(joint: &Joint) -> Option<(String, &'static str)> {
    if joint.is_known {
        return None;
    }
    let place = &joint.place;
    match joint.jump? {
        0 => Some((
            format!(
                "the function jumps where {place}: no energy is kept across it, and no method has an order there but `taylor` and \
                 `lie-taylor`, which end their steps there"
            ),
            "make the branches equal where they meet",
        )),
        1 => Some((
            format!(
                "the gradient jumps where {place}: a method that crosses it has order 1 there, but `taylor` and `lie-taylor`, which end \
                 their steps there"
            ),
            "make the derivatives of the branches equal where they meet, or round the corner off: `sqrt(x^2 + a^2)` for `abs(x)`",
        )),
        _ => None,
    }
}
