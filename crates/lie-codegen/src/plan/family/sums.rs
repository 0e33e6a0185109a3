//! What is derived of the sums beside H: what bonds add to them, and what is recorded of them.

use super::derivation::Derivation;
use super::{BondFunctions, Input, Observed};
use crate::derive::{Argument, Kernel};
use crate::model::QuantityKind;
use crate::plan::function::Function;
use lie_symbolic::symbolic::{ExprId, Symbol};

impl Derivation<'_, '_> {
    /// What a bond adds to sums and slopes.
    pub(super) fn bonds(&mut self) -> Option<BondFunctions> {
        let (n, family) = (self.n(), self.family);
        if !family.has_bonds {
            return None;
        }
        let zero = self.planner.source.graph.integer(0);
        let own: Vec<Symbol> = (0..n)
            .map(|k| Symbol::Coordinate(family.own * n + k))
            .collect();
        let other: Vec<Symbol> = (0..n).map(|k| family.bond_symbol(k)).collect();
        let (mut summands, mut terms) = (Vec::new(), vec![Vec::new(); 2 * n]);
        for (sum, weight) in family.sums.iter().zip(&self.weights) {
            let graph = &mut self.planner.source.graph;
            if !sum.over_bonds {
                summands.push(zero);
                continue;
            }
            let summand = graph.as_written(sum.summand);
            summands.push(summand);
            for (terms, symbol) in terms.iter_mut().zip(own.iter().chain(&other)) {
                let slope = graph.derivative(summand, *symbol);
                terms.push(graph.mul(*weight, slope));
            }
        }
        let graph = &mut self.planner.source.graph;
        let slopes: Vec<ExprId> = terms.iter().map(|terms| graph.sum(terms)).collect();
        let slopes: Vec<ExprId> = slopes.into_iter().map(|slope| graph.tidy(slope)).collect();
        let argument = |name, symbols| Argument { name, symbols };
        let [_, weights] = self.at();
        let arguments = vec![
            argument("one", own),
            weights,
            argument("other", other),
            argument("value", vec![family.bond_symbol(n)]),
        ];
        let formula = ("bond_summands", "`out_k = s_k(mu_i, mu_j, value)`");
        let summands = self.vector("summands of a bond", formula, arguments.clone(), &summands);
        let formula = ("bond_slopes", "`out = dH/dmu` at both sites of a bond");
        let slopes = self.vector("slopes of a bond", formula, arguments, &slopes);
        Some(BondFunctions { summands, slopes })
    }

    /// `dH/dt`.
    pub(super) fn time_slope(&mut self) -> Option<Function> {
        let slope = self.family.time_slope?;
        let slope = self.planner.source.graph.as_written(slope);
        let formula = "`dH/dt`, a function of the sums over all sites";
        let kernel = Kernel::scalar("time_slope", formula, self.at().to_vec(), slope);
        Some(self.function("derivative of H by the time", &kernel))
    }

    /// What is set from outside.
    pub(super) fn inputs(&self) -> Vec<Input> {
        let inputs = self.planner.structure.inputs.iter();
        let inputs = inputs.map(|input| Input {
            name: input.name.clone(),
            default: input.default.to_bits(),
            sampling: input.sampling.map(f64::to_bits),
        });
        inputs.collect()
    }

    /// What is recorded of the sums.
    pub(super) fn observables(&mut self) -> Vec<Observed> {
        let quantities = self.planner.structure.quantities.iter();
        let observables = quantities.filter(|q| q.kind == QuantityKind::Observable);
        let observables = observables.map(|quantity| {
            let value = self.planner.source.graph.as_written(quantity.expr);
            let formula = "a function of the sums over all sites";
            let at = self.at().to_vec();
            let kernel = Kernel::scalar("observable", formula, at, value);
            Observed {
                name: quantity.name.clone(),
                unwrap: quantity.unwrap,
                value: self.function(&format!("observable {}", quantity.name), &kernel),
            }
        });
        observables.collect()
    }
}
