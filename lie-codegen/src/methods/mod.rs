//! The catalogue of methods: ids, options, what they need, references. What a method preserves is
//! a constant of its type in the runtime; a test of the root package holds both tables together.

mod applicability;
mod choice;
mod table;

pub use applicability::{applicability, refusal};
pub use choice::Unusable;
pub use choice::{Choice, Retraction};
pub use table::CATALOGUE;

/// What a method preserves up to round-off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Preserves {
    /// The energy.
    pub energy: bool,
    /// Every Casimir.
    pub casimirs: bool,
    /// Casimirs (and other first integrals) of degree at most two.
    pub quadratic_casimirs: bool,
    /// The coadjoint orbit.
    pub orbit: bool,
    /// The Poisson structure.
    pub poisson: bool,
}

impl Preserves {
    /// Nothing beyond linear first integrals.
    pub const NOTHING: Self = Self {
        energy: false,
        casimirs: false,
        quadratic_casimirs: false,
        orbit: false,
        poisson: false,
    };
    /// Casimirs of degree at most two.
    pub const QUADRATIC: Self = Self {
        quadratic_casimirs: true,
        ..Self::NOTHING
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
    /// Options by flag name, with their defaults.
    pub options: &'static [(&'static str, &'static str)],
    /// Author, year, DOI.
    pub reference: &'static str,
    /// Whether it is built.
    pub availability: Availability,
}

/// The method of an id.
pub fn find(id: &str) -> Option<&'static Method> {
    CATALOGUE.iter().find(|method| method.id == id)
}
