//! `phi1(ad*_x) mu` with its derivatives by x, for Newton's matrices.

use super::kernels::multiply;
use super::series::{Scratch, dexp_dual_in};
use crate::matrix::SquareMatrix;
use crate::poisson::LiePoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, copies};

/// Terms of the series whose derivative is taken. Beyond them Newton's matrix is only approximate.
const TERMS: usize = 24;

/// `phi1(ad*_x) mu` with its derivatives, in closed form where the system has one.
///
/// Else `phi1(ad*_x) mu = sum_k t_k`, `t_k = (ad*_x)^k mu/(k + 1)!`, and its derivative along v is the sum of
/// `e_k = (ad*_x e_(k-1) + ad*_v t_(k-1))/(k + 1)`; `e_0 = 0`, or the derivative of mu where that moves too.
#[derive(Clone, Debug)]
pub(super) struct DexpSlope<V, M, S> {
    scratch: Scratch<V>,
    terms: [V; TERMS],
    derivative: V,
    first: V,
    second: V,
    /// The derivative by x, where it has a closed form.
    closed: M,
    /// The index of the last term in each lane.
    last: S,
}

impl<S: Scalar, V: State<S>, M: SquareMatrix<S>> DexpSlope<V, M, S> {
    pub(super) fn new(zero: &V, matrix: M) -> Self {
        Self {
            scratch: Scratch::new(zero),
            terms: copies(zero),
            derivative: zero.clone(),
            first: zero.clone(),
            second: zero.clone(),
            closed: matrix,
            last: S::zero(),
        }
    }

    /// `out = phi1(ad*_x) mu`
    pub(super) fn evaluate<P>(&mut self, system: &P, x: &V, mu: &V, out: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        if system.has_closed_exponential() {
            system.dexp_dual(x, mu, out);
            return;
        }
        self.sum(system, x, mu, out);
    }

    /// `out = phi1(ad*_x) mu`; what follows refers to it.
    pub(super) fn linearize<P>(&mut self, system: &P, x: &V, mu: &V, out: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        if system.has_closed_slope() {
            system.dexp_dual_slope(x, mu, out, &mut self.closed);
            return;
        }
        self.sum(system, x, mu, out);
    }

    fn sum<P>(&mut self, system: &P, x: &V, mu: &V, out: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        let terms = &mut self.terms;
        let keep = |index: usize, term: &V| {
            if let Some(kept) = terms.get_mut(index) {
                kept.copy_from(term);
            }
        };
        self.last = dexp_dual_in(system, x, mu, out, &mut self.scratch, keep);
    }

    /// Writes the derivative along v to `total`; x is that of the last linearization.
    pub(super) fn derivative<P>(&mut self, system: &P, x: &V, v: &V, total: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        if system.has_closed_slope() {
            multiply(&self.closed, v, total);
            return;
        }
        total.fill(S::zero());
        if v.as_slice().iter().all(|&entry| entry == S::zero()) {
            return;
        }
        self.along_both(system, x, v, total);
    }

    /// The same where mu moves too: `total` holds its derivative before, and that of `phi1(ad*_x) mu` after.
    pub(super) fn along_both<P>(&mut self, system: &P, x: &V, v: &V, total: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        if system.has_closed_slope() {
            self.derivative.copy_from(total);
            system.dexp_dual(x, &self.derivative, total);
            multiply(&self.closed, v, &mut self.first);
            total.axpy(S::one(), &self.first);
            return;
        }
        self.along_by_series(system, x, v, total);
    }

    /// The same by the series, whatever the system has.
    fn along_by_series<P>(&mut self, system: &P, x: &V, v: &V, total: &mut V)
    where
        P: LiePoisson<S, State = V, Jacobian = M>,
    {
        self.derivative.copy_from(total);
        for index in 1..TERMS {
            let counted = S::from_f64(index as f64).less_equal(self.last);
            if !counted.any() {
                break;
            }
            system.ad_star(x, &self.derivative, &mut self.first);
            system.ad_star(v, &self.terms[index - 1], &mut self.second);
            let weight = S::ratio(1.0, (index + 1) as f64);
            let parts = self.first.as_slice().iter().zip(self.second.as_slice());
            let entries = self.derivative.as_mut_slice().iter_mut();
            let entries = entries.zip(total.as_mut_slice());
            for ((derivative, total), (&first, &second)) in entries.zip(parts) {
                *derivative = (first + second) * weight;
                *total = S::select(counted, *total + *derivative, *total);
            }
        }
    }

    /// Space for sums along the same argument.
    pub(super) fn scratch(&mut self) -> &mut Scratch<V> {
        &mut self.scratch
    }
}

/// The series of `phi1(ad*_x) mu` and its derivative in x, `slope_ij = d(phi1(ad*_x) mu)_i/dx^j`.
pub fn dexp_dual_slope<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    x: &P::State,
    mu: &P::State,
    out: &mut P::State,
    slope: &mut P::Jacobian,
) {
    let zero = system.zero_state();
    let mut series = DexpSlope::new(&zero, slope.clone());
    series.sum(system, x, mu, out);
    let (mut unit, mut column) = (zero.clone(), zero);
    for k in 0..system.dimension() {
        unit.fill(S::zero());
        unit.as_mut_slice()[k] = S::one();
        column.fill(S::zero());
        series.along_by_series(system, x, &unit, &mut column);
        for (row, &entry) in column.as_slice().iter().enumerate() {
            slope.set(row, k, entry);
        }
    }
}
