//! What is known of a method, as data; tests read it and measure.

/// What a method keeps exactly, up to round-off of arithmetic and solver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Preserves {
    /// The energy H, whatever H is.
    pub energy: bool,
    /// Every Casimir.
    pub casimirs: bool,
    /// The coadjoint orbit: the new state is `Ad*_g mu` for some g.
    pub orbit: bool,
    /// The Poisson structure: the step is a Poisson map.
    pub poisson: bool,
    /// Every quadratic invariant of the equation, among them quadratic Casimirs and a quadratic H.
    pub quadratic_invariants: bool,
    /// Every linear invariant of the equation.
    pub linear_invariants: bool,
}

/// The constants of a method.
pub trait Facts {
    /// The method's id on the command line and in declarations.
    const ID: &'static str;
    /// The order of convergence.
    const ORDER: u32;
    /// Whether a step of -h undoes a step of h.
    const SYMMETRIC: bool;
    /// Whether a step needs no solver.
    const EXPLICIT: bool;
    /// What is kept.
    const PRESERVES: Preserves;
}
