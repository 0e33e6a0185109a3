//! How smooth the Hamiltonian of a system is, and its Lagrangian.

use crate::model::{Family, Model};
use crate::prove::joints::{Joint, of_function};
use crate::symbolic::Symbol;

/// The joints of the Hamiltonian of a system, or of its Lagrangian.
pub fn joints(model: &Model) -> Vec<Joint> {
    let name = |symbol| model.symbol_name(symbol);
    match &model.family {
        Some(family) => of_family(model, family),
        None => of_function(&model.graph, model.hamiltonian(), &name),
    }
}

/// The joints of the summands of a family, and of the function of its sums.
fn of_family(model: &Model, family: &Family) -> Vec<Joint> {
    let sites = |symbol| match symbol {
        Symbol::Coordinate(place) => match family.names.get(place) {
            Some(name) => name.clone(),
            None => format!("sum{}", place - family.names.len() + 1),
        },
        other => model.symbol_name(other),
    };
    let summands = family.sums.iter().map(|sum| sum.summand);
    let mut all: Vec<Joint> = Vec::new();
    for function in summands.chain([family.energy]) {
        for joint in of_function(&model.graph, function, &sites) {
            if !all.contains(&joint) {
                all.push(joint);
            }
        }
    }
    all
}
