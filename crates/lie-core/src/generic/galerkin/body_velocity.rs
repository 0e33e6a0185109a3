//! The velocity of a path `exp(theta(t))` in the frame of the body, and its derivatives.

use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, copies};

/// More terms than the series of a path within one step needs: `|ad_theta|` up to 10.
const TERMS: usize = 48;

/// `xi = dexp_(-theta) theta'` and what a momentum m makes of it: `xi = sum_k c_k w_k`, `c_k = (-1)^k/(k + 1)!`,
/// `w_k = [theta, w_(k-1)]`, `w_0 = theta'`.
pub(super) struct BodyVelocity<S, V> {
    /// `w_k`
    powers: [V; TERMS],
    /// `c_k`, as far as they are needed.
    coefficients: [S; TERMS],
    /// The last k.
    last: usize,
    pub(super) xi: V,
    /// `(dexp_(-theta))* m`
    pub(super) adjoint: V,
    /// The derivative of `<m, xi>` by theta.
    pub(super) slope: V,
    moved: V,
}

impl<S: Scalar, V: State<S>> BodyVelocity<S, V> {
    pub(super) fn new(zero: &V) -> Self {
        Self {
            powers: copies(zero),
            coefficients: [S::zero(); TERMS],
            last: 0,
            xi: zero.clone(),
            adjoint: zero.clone(),
            slope: zero.clone(),
            moved: zero.clone(),
        }
    }

    /// Sets xi for a point of the path and its derivative; it is no number where the series does not end.
    pub(super) fn set<P>(&mut self, system: &P, theta: &V, rate: &V)
    where
        P: LiePoisson<S, State = V>,
    {
        self.powers[0].copy_from(rate);
        self.xi.copy_from(rate);
        let unchanging = S::epsilon() * S::ratio(1.0, 8.0) * system.norm(&self.xi);
        self.coefficients = [S::zero(); TERMS];
        self.coefficients[0] = S::one();
        let mut active = S::Mask::splat(true);
        let mut small_before = S::Mask::splat(false);
        let mut coefficient = S::one();
        self.last = 0;
        for k in 1..TERMS {
            let (before, after) = self.powers.split_at_mut(k);
            let power = &mut after[0];
            system.ad(theta, &before[k - 1], power);
            coefficient *= S::ratio(-1.0, (k + 1) as f64);
            self.coefficients[k] = S::select(active, coefficient, S::zero());
            self.xi.axpy(self.coefficients[k], power);
            self.last = k;
            let small = (coefficient.abs() * system.norm(power)).less_equal(unchanging);
            active = active & !(small & small_before);
            small_before = small;
            if !active.any() {
                break;
            }
        }
        if active.any() {
            let not_a_number = S::zero() / S::zero();
            for entry in self.xi.as_mut_slice() {
                *entry = S::select(active, not_a_number, *entry);
            }
        }
    }

    /// Sets what a momentum makes of xi: backwards `a_k = c_k m + ad*_theta a_(k+1)`, so that `a_0 = (dexp_(-theta))* m`
    /// and the derivative by theta is `-sum_(k>0) ad*_(w_(k-1)) a_k`.
    pub(super) fn pull<P>(&mut self, system: &P, theta: &V, momentum: &V)
    where
        P: LiePoisson<S, State = V>,
    {
        self.slope.fill(S::zero());
        self.adjoint.fill(S::zero());
        for k in (0..=self.last).rev() {
            system.ad_star(theta, &self.adjoint, &mut self.moved);
            self.adjoint.copy_from(&self.moved);
            self.adjoint.axpy(self.coefficients[k], momentum);
            if k > 0 {
                system.ad_star(&self.powers[k - 1], &self.adjoint, &mut self.moved);
                self.slope.axpy(-S::one(), &self.moved);
            }
        }
    }
}
