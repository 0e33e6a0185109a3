//! Options of the iteration.

/// Which matrix an iteration solves with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Iteration {
    /// The fixed point where a Jacobian costs so much more than a residual that this may pay
    /// ([`Equation::jacobian_cost`](crate::Equation::jacobian_cost)), Newton's method elsewhere. A lane in which the
    /// updates of the fixed point shrink too slowly is solved by Newton's method from the start of the step, and so
    /// are its next steps, until the fixed point is tried again.
    #[default]
    Automatic,
    /// Newton's method: a new Jacobian in every iteration. Converges quadratically.
    Newton,
    /// Simplified Newton: the Jacobian of the start in every iteration. Converges linearly, by a
    /// factor proportional to the change of the Jacobian.
    Simplified,
    /// Fixed point `u -> u - r(u)`, without a Jacobian. Converges linearly, by a factor
    /// proportional to the step size; fails for stiff systems.
    FixedPoint,
}

/// Options of the solver behind implicit methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonOptions {
    /// Which matrix an iteration solves with.
    pub iteration: Iteration,
    /// Error of the unknown at which the iteration may end, in units of round-off: relative to
    /// `epsilon * max(|mu|, |u|)` in the maximum norm. The error is predicted from the last two
    /// updates. The default 2^-10 keeps the error that is left far below round-off, so that it
    /// does not add up to a drift over millions of steps.
    pub tolerance: f64,
    /// The number of iterations after which a step has failed; of an automatic choice, those of Newton's method.
    pub max_iterations: u32,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        Self {
            iteration: Iteration::Automatic,
            tolerance: 1.0 / 1024.0,
            max_iterations: 50,
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
