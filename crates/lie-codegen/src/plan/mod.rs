//! What is generated for a system, as plain data: names, kernels as straight-line programs, equations with their
//! eliminations, tables.
//!
//! Everything is decided here and nothing is text of a language yet: [`crate::print`] writes a plan as Rust,
//! `lie expand --plan` shows it, and another back end can run its programs. A plan can be compared, hashed, kept and
//! sent to another thread.

mod collective;
mod constants;
mod docs;
pub mod elimination;
mod energy;
mod equation;
mod family;
mod function;
mod generating;
mod lifts;
mod names;
mod own;
mod pattern;
mod planner;
mod recurrence;
mod splitting;
mod steps;
mod structure;
mod system;
mod text;

pub use constants::{Code, Constant, Constants, Prepared};
pub use equation::{
    Chart, Ending, Fused, Generating, Gradient, Guess, Item, Method, Motion, Partner, Solver,
    Sparse, Unknown,
};
pub use family::{Data, Family, FamilyForm, FamilyPiece, FamilyPieces, Push, Sum};
pub use function::Function;
pub use names::Names;
pub use own::Own;
pub use planner::{plan, plan_with};
pub use recurrence::Recurrence;
pub use splitting::{Flow, Found, FoundPart, FoundPiece, Splitting, chosen};
pub use structure::{
    Group, Inertia, Realization, Representation, Spectrum, Spins, Structure, Vectors,
};
pub use system::{Casimir, Energy, Event, Quantity, System};

use lie_symbolic::schedule::Counts;

/// The plan of a system and of the methods that were asked for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Plan {
    /// What everything is called.
    pub names: Names,
    /// Doc lines of the system, Markdown.
    pub docs: Vec<String>,
    /// The parameters, in the order of their names.
    pub parameters: Vec<Parameter>,
    /// Their defaults.
    pub defaults: Code,
    /// The initial state for given parameters, if one is declared.
    pub initial: Option<Code>,
    /// The matrix of the initial group element by rows, if one is declared.
    pub attitude: Option<Code>,
    /// What is computed once from the parameters.
    pub constants: Constants,
    /// The system: its facts and the kernels of its traits.
    pub system: System,
    /// What a system may have beyond its bracket.
    pub structure: Structure,
    /// The steps that have code of their own, in the order of their definition.
    pub items: Vec<Item>,
    /// The methods that run on generic equations, by the keys of `generic_equations!`.
    pub generic: Vec<String>,
    /// The flows of the pieces of H, where a splitting is asked for.
    pub splitting: Option<Splitting>,
    /// The flows of the pieces that were found.
    pub found: Option<Found>,
    /// The kernels of a family, which has nothing else.
    pub family: Option<Box<Family>>,
}

/// A parameter of a system.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// What it is, Markdown.
    pub doc: String,
    /// Whether it must be positive.
    pub positive: bool,
}

impl Plan {
    /// The number of coordinates n.
    pub fn dimension(&self) -> usize {
        self.names.coordinates.len()
    }

    /// The operation counts of all kernels and eliminations, by label.
    pub fn counts(&self) -> Vec<(String, Counts)> {
        let system = self.system.functions();
        let realization = self.structure.realization.iter();
        let realized = realization.flat_map(|realization| &realization.functions);
        let counted = |function: &Function| (function.label.clone(), function.program.counts);
        let lifted = self.structure.flows();
        let retraction = &self.structure.retraction;
        let canonical = &self.structure.canonical;
        let functions = system.chain(realized).chain(retraction).chain(canonical);
        let functions = functions.chain(lifted);
        let mut counts: Vec<_> = functions.map(counted).collect();
        for item in &self.items {
            counts.extend(item.functions().map(counted));
            counts.extend(item.elimination());
            counts.extend(item.recurrence());
        }
        let found = self.found.iter().flat_map(Found::flows);
        let flows = self.splitting.iter().flat_map(|splitting| &splitting.flows);
        let flows = flows.chain(found);
        counts.extend(flows.filter_map(|flow| flow.function.as_ref()).map(counted));
        let family = self.family.iter().flat_map(|family| family.functions());
        counts.extend(family.map(counted));
        counts
    }
}
