//! Steps of a variable size that a symmetric method makes reversible: an integrating step density.
//!
//! ```math
//! h_{n+1/2} = \frac{\varepsilon}{\rho_{n+1/2}}, \qquad \rho_{n+1/2} = \rho_{n-1/2} + \varepsilon\, G(\mu_n), \qquad
//! G = \frac{\mathrm{d}}{\mathrm{d}t} \ln r, \qquad r = \left(|f|^2 + (\theta\, |\mu|\, |\nabla H|)^2\right)^{a/2}
//! ```
//!
//! with a half step of rho at the start. Along a solution `$\rho' = \rho\, G$`, so that steps are as long as 1/r says, up to a factor.
//! Reading the formulas backwards gives the same with -eps: the map of (mu, rho) is symmetric where the step is, and a run from the
//! end with the last step turned round goes back over the same times. So actions and energies of reversible
//! integrable motion do not drift, as with constant steps. A step is no Poisson map any more, because its size depends on the state;
//! what a step keeps whatever its size, such as the orbit, Casimirs, quadratic invariants or the energy, stays.
//!
//! r serves every system: `$a = 3/4$`, and G costs one product of the Jacobian with the field, `$\langle f, Df\, f \rangle$`. On a Lie
//! algebra, whose Poisson matrix is linear, the field may vanish while the motion beside it is as fast as ever, as near a separatrix.
//! There the second term, with `$\theta = 1/8$`, bounds the step by the angular velocity; its derivative takes a product of the
//! Hessian with the field.
//!
//! Reference: E. Hairer, G. Söderlind, "Explicit, time reversible, adaptive step size control", SIAM Journal on Scientific Computing
//! 26 (2005) 1838–1851, [doi:10.1137/040606995](https://doi.org/10.1137/040606995).

use super::course::Course;
use super::kept::Kept;
use super::options::OptionError;
use super::problem::set_time;
use super::solve::IntegrateError;
use crate::clock::holds;
use crate::matrix::SquareMatrix;
use crate::methods::{StepFailure, StepReport};
use crate::newton::FailureReason;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The power of the size of the field that the density follows.
const POWER: f64 = 0.75;
/// On a Lie algebra the field counts as no smaller than this part of what it could be.
const FLOOR: f64 = 0.125;
/// From one step to the next the density falls to this part at least: longer steps no longer follow it, and it would pass zero.
const LEAST: f64 = 0.25;
/// A step that follows from a tolerance is no longer than this part of the time in which the field changes.
const LONGEST: f64 = 0.7;

/// How steps follow the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Density {
    /// All have the same size.
    #[default]
    Constant,
    /// Their size follows the motion, and a symmetric method stays reversible; see
    /// [`Options::reversible`](super::Options::reversible).
    Reversible,
}

/// Whether steps of a method can follow a density.
///
/// # Errors
/// Why not.
pub(super) fn check<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &Kept<'_, S, P>,
) -> Result<(), OptionError> {
    let why = if method.own_steps() {
        "the method chooses its own steps"
    } else if method.keeps() {
        "a projection behind steps takes their symmetry from them"
    } else if !method.symmetric() {
        "the method is not symmetric: a step of -h does not undo one of h"
    } else if !system.has_jacobian() {
        "the system has no Jacobian"
    } else if system.joint_count() > 0 {
        "branches of H meet at times that are known beforehand, and steps would have to end there"
    } else if S::LANES > 1 {
        "the lanes of a number would need times of their own"
    } else {
        return Ok(());
    };
    Err(OptionError::Density(why))
}

/// The state of the control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// The step in units of the density; it has the sign of the step.
    pub eps: f64,
    /// The density of the step that comes next.
    pub rho: f64,
    /// What the time has lost to round-off.
    pub lost: f64,
}

impl Control {
    /// With a first step of a size, where the density grows like that.
    pub(super) fn begin(step: f64, growth: f64) -> Result<Self, FailureReason> {
        // rho = 1 at the start, and half a step later 1 + eps G/2
        let part = 1.0 - 0.5 * step * growth;
        let eps = step / part;
        let control = Self {
            eps,
            rho: eps / step,
            lost: 0.0,
        };
        control.checked(1.0)
    }

    /// The size of the next step.
    pub(super) fn step(&self) -> f64 {
        self.eps / self.rho
    }

    /// Behind a step that ended at a time, where the density grows like that: the time, and the control of the next step.
    pub(super) fn after(self, time: f64, growth: f64) -> Result<(f64, Self), FailureReason> {
        let longer = self.step() + self.lost;
        let next = time + longer;
        let control = Self {
            rho: self.rho + self.eps * growth,
            lost: longer - (next - time),
            ..self
        };
        let control = control.checked(self.rho)?;
        match next + control.step() == next {
            true => Err(FailureReason::StepVanishes),
            false => Ok((next, control)),
        }
    }

    /// Whether the density is not far from the one before.
    fn checked(self, before: f64) -> Result<Self, FailureReason> {
        let ratio = self.rho / before;
        match self.eps.is_finite() && ratio >= LEAST && ratio.is_finite() {
            true => Ok(self),
            false => Err(FailureReason::NoDensity),
        }
    }

    /// Whether it is one of a run with a first step like that.
    pub(super) fn is_of(&self, step: f64) -> bool {
        let size = self.step();
        self.rho > 0.0 && size.is_finite() && size * step > 0.0 && self.lost.is_finite()
    }
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// Begins with the given step.
    pub(super) fn begin_control(
        &mut self,
        system: &P,
        mu: &P::State,
    ) -> Result<(), IntegrateError> {
        let growth = Growth::new(system).at(system, mu);
        let control = Control::begin(self.step, growth).map_err(|why| self.unsteered(why))?;
        let here = (self.index, self.grid.time(self.index));
        self.grid = self.grid.changed_from(here, self.step);
        self.control = Some(control);
        Ok(())
    }

    /// Behind a step: the size of the next one. The state has the time that is reached.
    #[inline(never)]
    pub(super) fn steer(
        &mut self,
        growth: &mut Growth<S, P>,
        system: &P,
        mu: &mut P::State,
    ) -> Result<f64, IntegrateError> {
        let Some(control) = self.control else {
            return Ok(self.grid.step());
        };
        let before = self.grid.time(self.index - 1);
        let growth = growth.at(system, mu);
        let (time, control) = control
            .after(before, growth)
            .map_err(|why| self.unsteered(why))?;
        self.control = Some(control);
        self.grid = (self.grid).changed_from((self.index, time), control.step());
        set_time(system, mu, time);
        Ok(control.step())
    }

    /// The state at the end of the span from that of the last grid point, by a shorter step that does not count.
    pub(super) fn at_the_end(
        &mut self,
        system: &P,
        mut mu: P::State,
    ) -> Result<P::State, IntegrateError> {
        if self.grid.length(self.index) != 0.0 {
            let (stats, piece) = (self.stats, (self.grid.time(self.index), self.grid.end));
            self.in_pieces(system, &[piece], &mut mu, &mut ())?;
            self.stats = stats;
        }
        Ok(mu)
    }

    /// The error where no step follows.
    fn unsteered(&self, reason: FailureReason) -> IntegrateError {
        let (lanes, report) = (1, StepReport::default());
        let failure = StepFailure {
            reason,
            lanes,
            report,
        };
        IntegrateError::from(self.failed(failure))
    }
}

/// How fast the density grows along the motion.
pub(super) struct Growth<S: Scalar, P: Poisson<S>> {
    field: P::State,
    gradient: P::State,
    jacobian: P::Jacobian,
    /// Of it as of the Jacobian only the entries are written that are not zero everywhere.
    hessian: P::Jacobian,
    /// Whether the Poisson matrix is linear.
    is_linear: bool,
}

impl<S: Scalar, P: Poisson<S>> Growth<S, P> {
    pub(super) fn new(system: &P) -> Self {
        Self {
            field: system.zero_state(),
            gradient: system.zero_state(),
            jacobian: system.zero_jacobian(),
            hessian: system.zero_jacobian(),
            is_linear: is_linear(system),
        }
    }

    /// G at a state; 0 where nothing moves.
    pub(super) fn at(&mut self, system: &P, mu: &P::State) -> f64 {
        let Square { size, slope, .. } = self.square(system, mu);
        match size > 0.0 {
            true => POWER * slope / size,
            false => 0.0,
        }
    }

    /// The longest first step from a state that a run by a tolerance takes, so that the control can follow the motion where the
    /// tolerance asks for less: `0.7 |f|/|Df f|`, with the second term beside the field.
    pub(super) fn longest(&mut self, system: &P, mu: &P::State) -> f64 {
        let Square { size, change, .. } = self.square(system, mu);
        match change > 0.0 {
            true => LONGEST * (size / change).sqrt(),
            false => f64::INFINITY,
        }
    }

    fn square(&mut self, system: &P, mu: &P::State) -> Square {
        let clock = system.clock();
        let places = || (0..mu.as_slice().len()).filter(|&k| !holds(clock, k));
        let dot = |a: &P::State, b: &P::State| -> f64 {
            let (a, b) = (a.as_slice(), b.as_slice());
            places().map(|k| (a[k] * b[k]).to_f64()).sum()
        };
        // the time and its momentum move the field, but do not count as parts of it
        let image = |row: usize, matrix: &P::Jacobian, field: &P::State| {
            let entries = field.as_slice().iter().enumerate();
            entries.fold(S::zero(), |sum, (k, &f)| sum + matrix.get(row, k) * f)
        };
        system.linearize(mu, &mut self.field, &mut self.jacobian);
        let mut square = Square {
            size: dot(&self.field, &self.field),
            slope: 0.0,
            change: 0.0,
        };
        for row in places() {
            let image = image(row, &self.jacobian, &self.field);
            square.slope += (self.field.as_slice()[row] * image).to_f64();
            square.change += (image * image).to_f64();
        }
        if self.is_linear {
            system.gradient(mu, &mut self.gradient);
            system.hessian(mu, &mut self.hessian);
            let (sizes, speeds) = (dot(mu, mu), dot(&self.gradient, &self.gradient));
            let faster = places().map(|row| {
                let image = image(row, &self.hessian, &self.field);
                (self.gradient.as_slice()[row] * image).to_f64()
            });
            let faster: f64 = faster.sum();
            let larger = dot(mu, &self.field);
            square.size += FLOOR * FLOOR * sizes * speeds;
            square.slope += FLOOR * FLOOR * (sizes * faster + speeds * larger);
        }
        square
    }
}

/// Whether the Poisson matrix is linear: twice a state has twice the matrix, and in binary that is exact.
fn is_linear<S: Scalar, P: Poisson<S>>(system: &P) -> bool {
    let clock = system.clock();
    let [once, twice] = [1.0, 2.0].map(|factor| {
        let (mut mu, mut matrix) = (system.zero_state(), system.zero_jacobian());
        for (k, entry) in mu.as_mut_slice().iter_mut().enumerate() {
            *entry = S::from_f64(factor * (1.0 + 0.375 * k as f64));
        }
        system.poisson_matrix(&mu, &mut matrix);
        matrix
    });
    let count = system.zero_state().as_slice().len();
    let places = || (0..count).filter(|&k| !holds(clock, k));
    places().all(|row| {
        places().all(|column| {
            let [once, twice] = [&once, &twice].map(|matrix| matrix.get(row, column).to_f64());
            twice == once + once
        })
    })
}

/// `|f|^2`, with the second term on a Lie algebra, half of its derivative along the motion, and `|Df f|^2`.
struct Square {
    size: f64,
    slope: f64,
    change: f64,
}
