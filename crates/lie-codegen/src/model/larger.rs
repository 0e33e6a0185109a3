//! What makes the algebra of a system larger than the declared one.

use super::{Acting, Model};
use lie_symbolic::symbolic::Symbol;

impl Model {
    /// Why a method that knows the declared algebra alone does not apply, whatever that algebra is: the group element, a cocycle, the time, or
    /// what was declared that the time is carried for. None of a system on the declared algebra.
    pub fn why_not_declared_algebra(&self) -> Option<String> {
        let configuration = self.configuration.as_ref()?;
        let mut parts = Vec::new();
        if configuration.group.is_some() {
            parts.push("the group element");
        }
        if configuration.idle {
            parts.push("the cocycle");
        } else if configuration.time {
            let acting = self.acts();
            if acting.is_empty() || self.contains_time() {
                parts.push("the time");
            }
            parts.extend(acting);
        }
        let verb = match parts.as_slice() {
            [one] if !one.ends_with('s') => "makes",
            _ => "make",
        };
        let last = parts.pop()?;
        let list = match parts.is_empty() {
            true => last.to_owned(),
            false => format!("{} and {last}", parts.join(", ")),
        };
        Some(format!(
            "it is for the declared algebra alone, and {list} {verb} that larger"
        ))
    }

    /// What is declared that the time is carried for, each once, by its kind.
    fn acts(&self) -> Vec<&'static str> {
        let mut kinds = Vec::new();
        if !self.inputs.is_empty() {
            kinds.push("inputs");
        }
        let declared = self.driving.iter().flat_map(|driving| &driving.declared);
        for acting in declared {
            let kind = match acting {
                Acting::Force(..) => "forces",
                Acting::DoubleBracket(..) | Acting::Metriplectic(..) | Acting::Rayleigh(_) => {
                    "dissipation"
                }
                Acting::HamiltonianNoise(_) | Acting::ForceNoise(_) => "noise",
                Acting::Temperature(_) => "its temperature",
            };
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }

    /// Whether the time stands in a declared function.
    fn contains_time(&self) -> bool {
        let Some(clock) = self.configuration.as_ref().and_then(|c| c.clock()) else {
            return false;
        };
        let driving = self.driving.iter();
        let acting = driving.flat_map(|driving| driving.force.iter().chain(&driving.damping));
        let recorded = self.quantities.iter().map(|quantity| quantity.expr);
        let recorded = recorded.chain(self.events.iter().map(|event| event.expr));
        let mut all = std::iter::once(self.hamiltonian())
            .chain(acting.copied())
            .chain(recorded);
        all.any(|function| {
            let symbols = self.graph.symbols(function);
            symbols.contains(&Symbol::Coordinate(clock.time))
        })
    }
}
