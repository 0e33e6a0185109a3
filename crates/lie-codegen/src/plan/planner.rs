//! The state of a plan in the making.

use super::constants::Table;
use super::equation::{Item, Solver, Unknown};
use super::names::Names;
use super::own::Own;
use super::pattern::Pattern;
use super::splitting::chosen;
use super::system::System;
use super::{Parameter, Plan};
use crate::derive::Source;
use crate::methods::Choice;
use crate::model::Model;
use crate::structure::{Structure, exponential};

/// The plan of a checked system with fused code for these methods; all others run on the generic forms.
pub fn plan(structure: &Structure, choices: &[Choice]) -> Plan {
    plan_with(structure, choices, &[])
}

/// The same with methods that a user wrote; those that have no formula ([`Own::check`]) stay generic.
pub fn plan_with(structure: &Structure, choices: &[Choice], own: &[Own]) -> Plan {
    if let Some(family) = &structure.family {
        return super::family::plan(structure, family);
    }
    let (mut planner, begun) = Planner::begin(structure, choices);
    for method in own {
        planner.own(method);
    }
    planner.finish(begun)
}

/// What is planned of the system and the methods of the catalogue.
struct Begun {
    system: System,
    structure: super::Structure,
    generic: Vec<String>,
}

/// A plan in the making.
pub(super) struct Planner<'a> {
    pub(super) structure: &'a Structure,
    pub(super) source: Source,
    pub(super) names: Names,
    /// The methods whose equations get fused code.
    pub(super) methods: Vec<Choice>,
    /// The constants of the system.
    pub(super) constants: Table,
    pub(super) items: Vec<Item>,
    /// Equations that several methods share, by a key.
    pub(super) known: Vec<(String, Solver)>,
    /// The patterns that have an elimination, by one block, and its name.
    pub(super) eliminations: Vec<(Unknown, Pattern, String)>,
}

impl<'a> Planner<'a> {
    fn begin(structure: &'a Structure, choices: &[Choice]) -> (Self, Begun) {
        let mut planner = Self::new(structure, choices);
        let begun = Begun {
            system: planner.system(),
            structure: planner.structure(),
            generic: planner.equations(),
        };
        (planner, begun)
    }

    fn new(structure: &'a Structure, choices: &[Choice]) -> Self {
        let mut source = Source::new(structure);
        let solved = choices.iter().map(Choice::solved);
        if choices.is_empty() || choices.iter().any(|c| c.solved().follows_exponentials()) {
            let algebra = structure.bracket.algebra();
            source.exponential = algebra.and_then(|a| exponential::closed_form(&a.exact));
        }
        Self {
            structure,
            source,
            names: Names::new(structure),
            // without an expression of H there is nothing to fuse
            methods: solved
                .filter(|_| structure.energy.expression().is_some())
                .cloned()
                .collect(),
            constants: Table::default(),
            items: Vec::new(),
            known: Vec::new(),
            eliminations: Vec::new(),
        }
    }

    /// What is left once all kernels are known: flows, and the constants that they use.
    fn finish(mut self, begun: Begun) -> Plan {
        let Begun {
            system,
            structure,
            generic,
        } = begun;
        let chosen = chosen(self.structure);
        let splitting = self.splitting(chosen.as_ref());
        let found = self.found_splitting(chosen.as_ref());
        let defaults: Vec<_> = self
            .structure
            .parameters
            .iter()
            .map(|p| p.default)
            .collect();
        let defaults = self.preparation(&defaults);
        let table = std::mem::take(&mut self.constants);
        let constants = self.prepared(&table, "_k");
        let initial = self.structure.initial.as_ref();
        let initial = initial.map(|initial| self.preparation(initial));
        let attitude = self.structure.attitude.as_ref();
        let attitude = attitude.map(|attitude| self.preparation(&attitude.matrix));
        let (splitting, generic) = match splitting {
            Some(Ok(splitting)) => (Some(splitting), generic),
            Some(Err(key)) => (None, [generic, vec![key]].concat()),
            None => (None, generic),
        };
        Plan {
            names: self.names,
            docs: super::docs::docs(self.structure),
            parameters: parameters(self.structure),
            defaults,
            initial,
            attitude,
            constants,
            system,
            structure,
            items: self.items,
            generic,
            splitting,
            found,
            family: None,
        }
    }

    /// Whether fused code is wanted for a method.
    pub(super) fn is_requested(&self, choice: &Choice) -> bool {
        self.methods.contains(choice)
    }
}

pub(super) fn parameters(model: &Model) -> Vec<Parameter> {
    let described = model.parameters.iter().map(|p| {
        let mut doc = described(&p.name, p.unit.as_deref(), p.description.as_deref());
        if p.positive {
            doc.push_str(" Positive.");
        }
        Parameter {
            doc,
            positive: p.positive,
        }
    });
    described.collect()
}

/// What a parameter is, for people.
pub(super) fn described(name: &str, unit: Option<&str>, description: Option<&str>) -> String {
    let what = description.map_or_else(|| format!("The parameter `{name}`"), str::to_owned);
    match unit {
        Some(unit) => format!("{what} \\[{unit}]."),
        None => format!("{what}."),
    }
}
