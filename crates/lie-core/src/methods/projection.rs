//! Energy and Casimirs kept by a projection: after a step of any method the state goes back onto the level sets of the start.
//!
//! ```math
//! \mu \leftarrow \mu - \sum_i c_i\, q_i, \qquad \nabla F_i(\mu) = \sum_{j \le i} R_{ij}\, q_j, \qquad
//! \sum_{j \le i} R_{ij}\, |q_j|^2\, c_j = F_i(\mu) - F_i(\mu_0)
//! ```
//!
//! The `$F_i$` are the Casimirs and then the energy, the `$q_j$` their gradients made orthogonal one after the other: to first
//! order it is the shortest way back, and `$R |q|^2 R^T$` the Gram matrix of the gradients. What is left is of the order of the square of
//! the error of the step, so that after one or two corrections it is round-off; a third is made where the first was large. Nothing adds up,
//! since values are compared with those of the start.
//!
//! The correction is as small as the error of the step, so that the order of the method stays. It is no Poisson map and has no
//! adjoint: a method that is one or is symmetric loses that. Where gradients depend on each other, as those of energy and
//! Casimirs do at an equilibrium, the later one is left alone as long as its value is right, and the step fails where it is not
//! ([`FailureReason::DependentLevels`]). A function that has its smallest or largest value there, such as the square of another
//! that is zero, is approached by half of the way or more in each correction.
//!
//! Needs: H, the Casimirs and their gradients; at most [`MOST_LEVELS`] of them. The energy of a Hamiltonian that depends on the
//! time is no constant.
//!
//! References: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd edition, Springer 2006, section IV.4,
//! [doi:10.1007/3-540-30666-8](https://doi.org/10.1007/3-540-30666-8); projections in closed form: B. K. Tapley, "Explicit
//! invariant-preserving integration of differential equations using homogeneous projection",
//! [arXiv:2511.02131](https://arxiv.org/abs/2511.02131) (2025).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use crate::clock::holds;
use crate::newton::FailureReason;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, dot};
use thiserror::Error;

/// So many functions can be kept.
pub const MOST_LEVELS: usize = 8;
/// Corrections after which a state is given up. Where the gradients become dependent or vanish at the level set itself each is worth
/// two bits of the error or a little more.
const CORRECTIONS: u32 = 64;
/// A correction that leaves more of the error, in units of round-off, does not lead to the level. It leaves 1/2 at a double root of
/// a function, whose gradient is zero there, and 2/3 at a triple one.
const SHRINKS: f64 = 0.75;
/// A gradient of which the others leave so much of the square of its length depends on them.
const DEPENDENT: f64 = 1e-6;
/// An error of so many units of round-off that does not shrink any more is round-off.
const ROUND_OFF: f64 = 64.0;
/// The size of a function that is zero with all its terms.
const SMALLEST: f64 = 1e-30;

/// What is kept by a projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Keep {
    /// The energy.
    pub energy: bool,
    /// All Casimirs of the system.
    pub casimirs: bool,
}

impl Keep {
    /// Nothing: the method as it is.
    pub const NOTHING: Self = Self {
        energy: false,
        casimirs: false,
    };
    /// The energy alone.
    pub const ENERGY: Self = Self {
        energy: true,
        ..Self::NOTHING
    };
    /// The Casimirs alone.
    pub const CASIMIRS: Self = Self {
        casimirs: true,
        ..Self::NOTHING
    };
    /// Both.
    pub const ALL: Self = Self {
        energy: true,
        casimirs: true,
    };
}

/// Why something cannot be kept.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unkept {
    /// The Hamiltonian depends on the time.
    #[error("the energy of a Hamiltonian that depends on the time is not constant")]
    Driven,
    /// The system has no Casimirs.
    #[error("no Casimirs of the system are known")]
    NoCasimirs,
    /// It is a family, or keeps no matrix for another reason.
    #[error("the Casimirs of a large system are those of its sites, too many to be kept together")]
    OfSites,
    /// It has too many.
    #[error("{0} functions are more than the {MOST_LEVELS} that can be kept together")]
    TooMany(usize),
    /// The value of a Casimir jumps.
    #[error("a Casimir has several branches, so that its value jumps")]
    Multivalued,
    /// A value at the start is not finite.
    #[error("a value at the start is not finite")]
    NotFinite,
}

/// Values that are kept: those of the Casimirs, and then the energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels<S> {
    keep: Keep,
    casimirs: usize,
    values: [S; MOST_LEVELS],
}

impl<S: Scalar> Levels<S> {
    /// Those of a system at a state.
    ///
    /// # Errors
    /// Why they cannot be kept.
    pub fn at<P: Poisson<S>>(system: &P, mu: &P::State, keep: Keep) -> Result<Self, Unkept> {
        let casimirs = if keep.casimirs {
            system.casimir_count()
        } else {
            0
        };
        let count = casimirs + usize::from(keep.energy);
        if keep.energy && system.clock().is_some() {
            return Err(Unkept::Driven);
        }
        if keep.casimirs && casimirs == 0 {
            return Err(Unkept::NoCasimirs);
        }
        if keep.casimirs && !system.has_jacobian() {
            return Err(Unkept::OfSites);
        }
        if count > MOST_LEVELS {
            return Err(Unkept::TooMany(count));
        }
        if (0..casimirs).any(|index| system.casimir_is_multivalued(index)) {
            return Err(Unkept::Multivalued);
        }
        let mut levels = Self {
            keep,
            casimirs,
            values: [S::zero(); MOST_LEVELS],
        };
        levels.values = levels.measured(system, mu);
        match levels.values.iter().all(|value| value.finite().all()) {
            true => Ok(levels),
            false => Err(Unkept::NotFinite),
        }
    }

    /// How many there are.
    fn count(&self) -> usize {
        self.casimirs + usize::from(self.keep.energy)
    }

    /// The functions at a state.
    fn measured<P: Poisson<S>>(&self, system: &P, mu: &P::State) -> [S; MOST_LEVELS] {
        let mut values = [S::zero(); MOST_LEVELS];
        if self.keep.casimirs {
            system.casimirs(mu, &mut values[..self.casimirs]);
        }
        if self.keep.energy {
            values[self.casimirs] = system.hamiltonian(mu);
        }
        values
    }
}

/// Brings states back onto levels.
#[derive(Clone, Debug)]
pub struct Projection<S, V> {
    levels: Levels<S>,
    /// The gradients, made orthogonal by a correction.
    gradients: [Option<V>; MOST_LEVELS],
    /// How far the functions are from their levels, and the sizes of their terms.
    off: [S; MOST_LEVELS],
    sizes: [S; MOST_LEVELS],
    /// The bits of the lanes in whose corrections a gradient whose function was off its level depended on the others, or was zero.
    dependent: u64,
    point: V,
    corrected: V,
}

impl<S: Scalar, V: State<S>> Projection<S, V> {
    /// Onto these levels of a system.
    pub fn new<P: Poisson<S, State = V>>(system: &P, levels: Levels<S>) -> Self {
        let used = |index| (index < levels.count()).then(|| system.zero_state());
        Self {
            gradients: core::array::from_fn(used),
            off: [S::zero(); MOST_LEVELS],
            sizes: [S::one(); MOST_LEVELS],
            dependent: 0,
            point: system.zero_state(),
            corrected: system.zero_state(),
            levels,
        }
    }

    /// Brings a state back in some lanes. Returns those in which it cannot be: the level set is too far, or gradients depend on
    /// each other there ([`reason`](Self::reason)); the state is untouched in these.
    pub fn bring_back<P: Poisson<S, State = V>>(
        &mut self,
        system: &P,
        lanes: S::Mask,
        mu: &mut V,
    ) -> S::Mask {
        self.point.copy_from(mu);
        self.differentiate(system);
        let (mut active, mut lost) = (lanes, S::Mask::splat(false));
        self.dependent = 0;
        let mut before = S::from_f64(f64::INFINITY);
        for correction in 0..CORRECTIONS {
            let off = self.measure(system);
            let smaller = off.less_equal(before * S::from_f64(SHRINKS));
            let at_round_off = off.less_equal(S::from_f64(ROUND_OFF)) & !smaller;
            let there = off.less_equal(S::one()) | at_round_off;
            lost = lost | (active & !there & !smaller);
            active = active & !there & smaller;
            if !active.any() {
                break;
            }
            if correction > 0 {
                self.differentiate(system);
            }
            self.correct(active);
            before = S::select(active, off, before);
        }
        lost = lost | active;
        mu.assign_where(lanes & !lost, &self.point);
        lost
    }

    /// Why the last state could not be brought back in a lane of these.
    pub fn reason(&self, lost: S::Mask) -> FailureReason {
        match lost.bits() & self.dependent {
            0 => FailureReason::OffLevel,
            _ => FailureReason::DependentLevels,
        }
    }

    /// Computes the gradients at the point, and from them how large the terms of the functions are.
    fn differentiate<P: Poisson<S, State = V>>(&mut self, system: &P) {
        let clock = system.clock();
        for (index, gradient) in self.gradients.iter_mut().flatten().enumerate() {
            if index < self.levels.casimirs {
                system.casimir_gradient(index, &self.point, gradient);
            } else {
                system.gradient(&self.point, gradient);
            }
            let mut size = self.levels.values[index].abs() + S::from_f64(SMALLEST);
            let entries = gradient.as_mut_slice().iter_mut().enumerate();
            for ((place, slope), &entry) in entries.zip(self.point.as_slice()) {
                if holds(clock, place) {
                    *slope = S::zero();
                }
                size += (*slope * entry).abs();
            }
            self.sizes[index] = size;
        }
    }

    /// How far the point is off the levels: the largest error in units of round-off.
    fn measure<P: Poisson<S, State = V>>(&mut self, system: &P) -> S {
        let values = self.levels.measured(system, &self.point);
        let mut errors = [S::zero(); MOST_LEVELS];
        for (index, error) in errors[..self.levels.count()].iter_mut().enumerate() {
            self.off[index] = values[index] - self.levels.values[index];
            *error = self.off[index].abs() / (S::epsilon() * self.sizes[index]);
        }
        S::largest_magnitude(&errors)
    }

    /// One correction of the point, in some lanes.
    fn correct(&mut self, lanes: S::Mask) {
        self.corrected.copy_from(&self.point);
        let mut lengths = [S::zero(); MOST_LEVELS];
        // one over the squares of the lengths of the gradients
        let mut inverses = [S::zero(); MOST_LEVELS];
        for index in 0..self.levels.count() {
            let (before, rest) = self.gradients.split_at_mut(index);
            let Some(gradient) = &mut rest[0] else {
                continue;
            };
            let whole = dot(gradient, gradient);
            let mut left = self.off[index];
            for ((direction, &inverse), &length) in
                before.iter().flatten().zip(&inverses).zip(&lengths)
            {
                let part = dot(gradient, direction);
                gradient.axpy(-(part * inverse), direction);
                left -= part * length;
            }
            let size = dot(gradient, gradient);
            let dependent = size.less_equal(S::epsilon() * whole);
            let round_off = S::from_f64(ROUND_OFF) * S::epsilon() * self.sizes[index];
            let is_off = !self.off[index].abs().less_equal(round_off);
            let nearly = size.less_equal(S::from_f64(DEPENDENT) * whole);
            self.dependent |= (lanes & nearly & is_off).bits();
            inverses[index] = S::select(dependent, S::zero(), S::one() / size);
            lengths[index] = left * inverses[index];
            self.corrected.axpy(-lengths[index], gradient);
        }
        self.point.assign_where(lanes, &self.corrected);
    }
}
