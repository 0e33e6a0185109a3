//! What acts beside the Hamiltonian.

use lie_symbolic::symbolic::ExprId;

/// Forces and dissipation of a system: `mu' = Pi(mu) xi + F`.
#[derive(Clone, Debug)]
pub struct Driving {
    /// The force F, 0 where none acts.
    pub force: Vec<ExprId>,
    /// What the generator xi has beside the gradient of H. The component along the time is the power `<F, grad H> - c |v|^2_G` of what
    /// acts, `v = Pi grad H`, which the momentum of the time gives: H with that momentum stays constant.
    pub damping: Vec<ExprId>,
    /// What was declared, in its order.
    pub declared: Vec<Acting>,
}

/// One thing that acts.
#[derive(Clone, Debug)]
pub enum Acting {
    /// A force on a coordinate.
    Force(usize, ExprId),
    /// A double bracket with its strength and its metric, the identity where there is none.
    DoubleBracket(ExprId, Option<Vec<Vec<ExprId>>>),
    /// An entropy with the metric.
    Metriplectic(ExprId, Vec<Vec<ExprId>>),
    /// A matrix that takes `R grad H`.
    Rayleigh(Vec<Vec<ExprId>>),
}

impl Driving {
    /// Whether forces act, and not damping along orbits alone.
    pub fn is_forced(&self) -> bool {
        let along = |acting: &Acting| matches!(acting, Acting::DoubleBracket(..));
        !self.declared.iter().all(along)
    }

    /// Whether damping along orbits acts.
    pub fn is_damped(&self) -> bool {
        let along = |acting: &Acting| matches!(acting, Acting::DoubleBracket(..));
        self.declared.iter().any(along)
    }
}
