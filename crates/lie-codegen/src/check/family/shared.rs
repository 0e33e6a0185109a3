//! What all sites of a family share: the time and the inputs.

use crate::check::configuration::uses_time;
use crate::check::driving::held;
use crate::model::configuration::TIME;
use crate::model::{Quantity, QuantityKind, SiteSum, shared_symbol};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::Diagnostic;

/// The names of what all sites share: the time and the inputs, where something may depend on them.
pub fn names(declaration: &Declaration, mistakes: &mut Vec<Diagnostic>) -> Vec<String> {
    held::defaults(declaration, mistakes);
    if !uses_time(declaration) && declaration.inputs.is_empty() {
        return Vec::new();
    }
    let inputs = declaration.inputs.iter().map(|input| &input.name.text);
    let time = TIME.to_owned();
    [time].into_iter().chain(inputs.cloned()).collect()
}

/// The inputs as columns.
pub fn recorded(declaration: &Declaration, graph: &mut Graph) -> Vec<Quantity> {
    let inputs = declaration.inputs.iter().zip(1..);
    let inputs = inputs.map(|(input, number)| Quantity {
        name: input.name.text.clone(),
        origin: input.name.origin,
        expr: graph.symbol(shared_symbol(number)),
        kind: QuantityKind::Input,
        unwrap: false,
        multivalued: false,
    });
    inputs.collect()
}

/// `dH/dt = dF/dt + sum_k dF/dT_k sum_i ds_k/dt`, if H depends on the time. The inner sums stand behind those of the declaration, the first of
/// which is that coordinate.
pub fn time_slope(
    graph: &mut Graph,
    energy: ExprId,
    first: usize,
    sums: &mut Vec<SiteSum>,
) -> Option<ExprId> {
    let time = shared_symbol(0);
    let mut terms = vec![graph.derivative(energy, time)];
    for k in 0..sums.len() {
        let slope = graph.derivative(sums[k].summand, time);
        if !sums[k].moves || graph.is_zero(slope) {
            continue;
        }
        let inner = graph.symbol(Symbol::Coordinate(first + sums.len()));
        let outer = graph.derivative(energy, Symbol::Coordinate(first + k));
        terms.push(graph.mul(outer, inner));
        sums.push(SiteSum {
            summand: slope,
            slots: Vec::new(),
            moves: false,
            ..sums[k].clone()
        });
    }
    let slope = graph.sum(&terms);
    (!graph.is_zero(slope)).then_some(slope)
}
