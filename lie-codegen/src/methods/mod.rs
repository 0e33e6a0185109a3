//! The catalogue of methods: ids, options, what they need, references. What a method preserves is
//! a constant of its type in the runtime; a test of the root package holds both tables together.

mod applicability;
mod choice;
mod constructor;
mod options;
mod table;

pub use applicability::{applicability, kind_of_refusal, refusal};
pub use choice::{Choice, Unusable};
pub use options::{Gradient, Lift, OptionError, Retraction, Scheme, Tensor};
pub use table::CATALOGUE;

/// What a method preserves up to round-off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Preserves {
    /// The energy.
    pub energy: bool,
    /// Every Casimir.
    pub casimirs: bool,
    /// Every Casimir of degree at most two.
    pub quadratic_casimirs: bool,
    /// The coadjoint orbit.
    pub orbit: bool,
    /// The Poisson structure.
    pub poisson: bool,
    /// The Poisson structure of a constant Poisson matrix, as that of canonical coordinates is.
    pub constant_poisson: bool,
    /// Every quadratic invariant of the equation.
    pub quadratic_invariants: bool,
    /// Every linear invariant of the equation.
    pub linear_invariants: bool,
}

impl Preserves {
    /// Nothing at all.
    pub const NOTHING: Self = Self {
        energy: false,
        casimirs: false,
        quadratic_casimirs: false,
        orbit: false,
        poisson: false,
        constant_poisson: false,
        quadratic_invariants: false,
        linear_invariants: false,
    };
    /// Linear invariants of the equation: what every Runge–Kutta method keeps.
    pub const LINEAR: Self = Self {
        linear_invariants: true,
        ..Self::NOTHING
    };
    /// Quadratic and linear invariants of the equation, and so quadratic Casimirs and constant
    /// Poisson matrices.
    pub const QUADRATIC: Self = Self {
        quadratic_casimirs: true,
        quadratic_invariants: true,
        constant_poisson: true,
        ..Self::LINEAR
    };
    /// The coadjoint orbit and with it every Casimir.
    pub const ORBIT: Self = Self {
        casimirs: true,
        quadratic_casimirs: true,
        orbit: true,
        ..Self::NOTHING
    };
    /// The orbit and the Poisson structure.
    pub const POISSON: Self = Self {
        poisson: true,
        ..Self::ORBIT
    };
    /// The orbit and the energy.
    pub const ORBIT_ENERGY: Self = Self {
        energy: true,
        ..Self::ORBIT
    };
    /// Energy and quadratic Casimirs.
    pub const ENERGY: Self = Self {
        energy: true,
        quadratic_casimirs: true,
        ..Self::NOTHING
    };
}

/// Whether a method can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Availability {
    /// It is built.
    Built,
    /// Its name is kept; it is not built yet.
    Planned,
}

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
    /// What it preserves.
    pub preserves: Preserves,
    /// What a system must have.
    pub needs: &'static str,
    /// Author, year, DOI.
    pub reference: &'static str,
    /// Whether it is built.
    pub availability: Availability,
}

/// The method of an id.
pub fn find(id: &str) -> Option<&'static Method> {
    CATALOGUE.iter().find(|method| method.id == id)
}

impl Method {
    /// The method with its options at their defaults; none while it is not built.
    fn choice(&self) -> Option<Choice> {
        // a composition has the options of its base, too: the midpoint rule has none
        let id = if self.id.starts_with("compose") {
            format!("{}(midpoint)", self.id)
        } else {
            self.id.to_owned()
        };
        Choice::from_id(&id).ok()
    }

    /// Options by flag name, with their defaults; none while the method is not built.
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
