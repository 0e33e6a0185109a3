//! Options of the iteration.

/// Which matrix an iteration solves with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Iteration {
    /// The fixed point where a Jacobian costs so much more than an iteration without one that this may pay
    /// ([`Equation::jacobian_cost`](crate::Equation::jacobian_cost)), elsewhere one Jacobian a step: an iteration of Newton's
    /// method and, where the constant of its convergence does not say that this is enough, iterations with its factors. Both
    /// start from the unknowns of the steps before, extrapolated. A lane in which updates shrink too slowly is solved by
    /// Newton's method from the guess of the equation, and so are its next steps, until something else is tried again.
    #[default]
    Automatic,
    /// Newton's method: a new Jacobian in every iteration. Converges quadratically.
    Newton,
    /// Simplified Newton: the Jacobian of the start in every iteration. Converges linearly, by a
    /// factor proportional to the change of the Jacobian.
    Simplified,
    /// Fixed point `u -> u - r(u)`, without a Jacobian. Converges linearly, by a factor
    /// proportional to the step size; fails for stiff systems. Each residual is that of the whole motion, where `Automatic` finds nodes and
    /// end of a flow by one iteration ([`Equation::approach`](crate::Equation::approach)).
    FixedPoint,
}

/// What has converged where an iteration of stages that are evaluated together ends.
///
/// From a good start the state comes to rest earlier than its derivative by the state before the step, which starts from
/// nothing: the executed step then is the exact one to round-off, its derivative is not. Methods that evaluate their stages
/// one after the other end by the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Convergence {
    /// What the method claims: the map of a method that claims to be a Poisson map, else the state.
    #[default]
    Claimed,
    /// The state, to the tolerance.
    State,
    /// The state, as far as the tolerance of a run asks: the iteration leaves three tenths of the share that a step has of it.
    /// What the method preserves is preserved as far. As [`Self::State`] where the step of a run is given.
    Tolerance,
    /// The state and its derivative, both to round-off: what the exact step preserves, a Poisson bracket for one, the
    /// executed step preserves to round-off. Does not look at the tolerance.
    Map,
}

/// Options of the solver behind implicit methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonOptions {
    /// Which matrix an iteration solves with.
    pub iteration: Iteration,
    /// Error of the unknown at which the iteration may end, in units of round-off: relative to
    /// `epsilon * max(|mu|, |u|)` in the maximum norm. The error is predicted from the last two
    /// updates, or from one and the rate at which earlier steps converged. The default 2^-10 keeps the error that is left far below round-off, so that it
    /// does not add up to a drift over millions of steps.
    pub tolerance: f64,
    /// The number of iterations after which a step has failed; of an automatic choice, those of Newton's method. Where stages are
    /// evaluated together, twice as many are made of the fixed point before, or three times as many where the map is to
    /// converge, which nothing else follows.
    pub max_iterations: u32,
    /// What has converged where an iteration ends, of methods that evaluate their stages together.
    pub convergence: Convergence,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        Self {
            iteration: Iteration::Automatic,
            tolerance: 1.0 / 1024.0,
            max_iterations: 50,
            convergence: Convergence::Claimed,
        }
    }
}

impl NewtonOptions {
    /// Newton's method alone.
    pub fn newton() -> Self {
        Self {
            iteration: Iteration::Newton,
            ..Self::default()
        }
    }

    /// For a method that claims to be a Poisson map, where nothing else is asked for.
    #[must_use]
    pub(crate) fn for_a_poisson_map(mut self) -> Self {
        if self.convergence == Convergence::Claimed {
            self.convergence = Convergence::Map;
        }
        self
    }

    /// Simplified Newton, with room for its slower convergence.
    pub fn simplified() -> Self {
        Self {
            iteration: Iteration::Simplified,
            max_iterations: 200,
            ..Self::default()
        }
    }

    /// Fixed-point iteration, with room for its slower convergence.
    pub fn fixed_point() -> Self {
        Self {
            iteration: Iteration::FixedPoint,
            max_iterations: 500,
            ..Self::default()
        }
    }
}
