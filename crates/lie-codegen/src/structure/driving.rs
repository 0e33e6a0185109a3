//! What forces leave of the bracket.

use crate::model::{Casimir, Model};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::proof::Prover;
use lie_symbolic::symbolic::{Graph, Symbol};

/// Work allowed for one Casimir.
const WORK: u64 = 2_000_000;

/// Marks the Casimirs that forces change: those C for which `C' = <F, grad C>` is not shown to vanish. Damping along orbits
/// changes none.
pub fn mark_kept(model: &Model, casimirs: &mut [Casimir], graph: &mut Graph) {
    let Some(driving) = model
        .driving
        .as_ref()
        .filter(|driving| driving.is_forced(&model.graph))
    else {
        return;
    };
    let rates: Vec<_> = casimirs
        .iter()
        .map(|casimir| {
            let parts = driving.force.iter().enumerate();
            let parts: Vec<_> = parts
                .map(|(i, force)| {
                    let slope = graph.derivative(casimir.expr, Symbol::Coordinate(i));
                    let slope = match &model.family {
                        Some(family) => family.at_own(graph, &[slope], model.dimension())[0],
                        None => slope,
                    };
                    graph.mul(slope, *force)
                })
                .collect();
            graph.sum(&parts)
        })
        .collect();
    let name = |symbol| model.acting_name(symbol);
    for (casimir, rate) in casimirs.iter_mut().zip(rates) {
        let budget = Budget::new(WORK);
        casimir.kept = Prover::new(graph, &budget, &driving.force, &name).vanishes(rate);
    }
}
