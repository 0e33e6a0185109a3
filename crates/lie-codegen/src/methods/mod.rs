//! The catalogue of methods: ids, options, what they need, references. Order, symmetry and what a method preserves are
//! the constants of its type in the numeric core.

mod acting;
mod applicability;
mod choice;
mod constrained;
mod constructor;
pub mod declared;
mod options;
mod rows;
mod table;

pub use applicability::{applicability, kind_of_refusal, refusal};
pub use choice::{Choice, Unusable};
pub use lie_core::methods::Preserves;
pub use options::{Gradient, Lift, OptionError, Pieces, Retraction, Scheme, Tensor};
pub use rows::{Carrier, GenericEquation, Row};
pub use table::CATALOGUE;

/// One method of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Its id on the command line and in specs.
    pub id: &'static str,
    /// Its name in the literature.
    pub title: &'static str,
    /// Order of accuracy.
    pub order: u32,
    /// Whether `Phi_{-h} Phi_h` is the identity.
    pub symmetric: bool,
    /// Whether a step needs no equation to be solved.
    pub explicit: bool,
    /// Whether it is solved by fixed-point iteration.
    pub fixed_point: bool,
    /// What it preserves.
    pub preserves: Preserves,
    /// Whether it applies where forces act.
    pub forces: bool,
    /// Whether it applies where damping along orbits acts.
    pub damping: bool,
    /// What a system must have.
    pub needs: &'static str,
    /// Author, year, DOI.
    pub reference: &'static str,
}

/// The method of an id.
pub fn find(id: &str) -> Option<&'static Method> {
    CATALOGUE.iter().find(|method| method.id == id)
}

impl Method {
    /// The method with its options at their defaults.
    fn choice(&self) -> Option<Choice> {
        // a composition has the options of its base, too: the midpoint rule has none
        let id = if self.id.starts_with("compose") {
            format!("{}(midpoint)", self.id)
        } else {
            self.id.to_owned()
        };
        Choice::from_id(&id).ok()
    }

    /// Options by flag name, with their defaults.
    pub fn options(&self) -> Vec<(&'static str, &'static str)> {
        self.choice()
            .map_or_else(Vec::new, |choice| choice.options())
    }

    /// The values of an option that is a choice between names, the default first.
    pub fn values(&self, option: &str) -> Vec<&'static str> {
        let mut values = Vec::new();
        for variant in self.choice().iter().flat_map(Choice::variants) {
            for (name, value) in variant.options() {
                if name == option && !values.contains(&value) {
                    values.push(value);
                }
            }
        }
        values
    }
}
