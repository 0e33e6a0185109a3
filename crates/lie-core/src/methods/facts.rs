//! What is known of a method, as data; tests read it and measure.

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// What a method keeps exactly, up to round-off of arithmetic and solver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Preserves {
    /// The energy H, whatever H is.
    pub energy: bool,
    /// Every Casimir.
    pub casimirs: bool,
    /// Every Casimir of degree at most two.
    pub quadratic_casimirs: bool,
    /// The coadjoint orbit: the new state is `Ad*_g mu` for some g.
    pub orbit: bool,
    /// The Poisson structure: the step is a Poisson map.
    pub poisson: bool,
    /// The Poisson structure of a constant Poisson matrix, as that of canonical coordinates is.
    pub constant_poisson: bool,
    /// Every quadratic invariant of the equation, among them quadratic Casimirs and a quadratic H.
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
    /// The coadjoint orbit, and so every Casimir.
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
    /// The energy and Casimirs of degree at most two.
    pub const ENERGY: Self = Self {
        energy: true,
        quadratic_casimirs: true,
        ..Self::NOTHING
    };
}

impl Preserves {
    /// What is left of it where forces act, or damping along orbits. Forces leave the orbit, and no map is Poisson with either; of
    /// the energy with the momentum of the time, and of the invariants of the equation, all else stays.
    #[must_use]
    pub const fn under(self, forced: bool, damped: bool) -> Self {
        if !forced && !damped {
            return self;
        }
        Self {
            casimirs: self.casimirs && !forced,
            quadratic_casimirs: self.quadratic_casimirs && (!forced || self.quadratic_invariants),
            orbit: self.orbit && !forced,
            poisson: false,
            constant_poisson: false,
            ..self
        }
    }

    /// What is left of it on a system.
    #[must_use]
    pub fn on<S: Scalar, P: Poisson<S>>(self, system: &P) -> Self {
        self.under(system.is_forced(), system.is_damped())
    }

    /// Whether the energy of a system is kept to round-off, as of a quadratic one where quadratic invariants are. The work of noise is in
    /// no balance.
    #[must_use]
    pub fn keeps_energy<S: Scalar, P: Poisson<S>>(self, system: &P) -> bool {
        let kept = self.on(system);
        let quadratic = system
            .hamiltonian_degree()
            .is_some_and(|degree| degree <= 2);
        system.noise_count() == 0 && (kept.energy || (kept.quadratic_invariants && quadratic))
    }
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
    /// Whether a step is solved by fixed-point iteration, where each digit costs the same.
    const FIXED_POINT: bool = false;
    /// Whether a step is made of steps that the method chooses itself.
    const OWN_STEPS: bool = false;
    /// What is kept.
    const PRESERVES: Preserves;
    /// Whether a step applies where forces act, to `mu' = Pi(mu) xi + F(mu)`, with the order of the method. [`Facts::PRESERVES`] is then
    /// that of the motion without them.
    const FORCES: bool = false;
    /// Whether a step applies where the generator xi of the motion along the orbit is not the gradient of H, as with damping by a
    /// double bracket, with the order of the method. Orbit and Casimirs stay in [`Facts::PRESERVES`]; the energy falls.
    const DAMPING: bool = false;

    /// [`Facts::ORDER`]; of a method whose type is forgotten, that of the method.
    fn order(&self) -> u32 {
        Self::ORDER
    }
    /// The same of [`Facts::FIXED_POINT`].
    fn fixed_point(&self) -> bool {
        Self::FIXED_POINT
    }
    /// The same of [`Facts::OWN_STEPS`].
    fn own_steps(&self) -> bool {
        Self::OWN_STEPS
    }
    /// The same of [`Facts::SYMMETRIC`].
    fn symmetric(&self) -> bool {
        Self::SYMMETRIC
    }
}
