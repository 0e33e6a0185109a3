//! What a family carries beside its sites where something acts on them or depends on the time: the momentum of the time, the time, the unit, the
//! inputs, and the rates of the Wiener processes, those of the first process of all sites before those of the second.

use super::shape::Shape as _;
use super::sites::{Sums, width};
use super::stencil::{UNIT, carried, inputs};
use super::{Family, LateMatrix, Sites};
use crate::matrix::SquareMatrix as _;
use crate::poisson::Lift as _;
use crate::scalar::{Dual, Scalar};
use std::vec::Vec;

impl<K> Family<K> {
    /// The number of coordinates of all sites.
    pub(super) fn own<S: Scalar>(&self) -> usize
    where
        K: Sites<S>,
    {
        self.kernels().dimension() * self.count()
    }

    /// Where the momentum of the time, the time and the unit are: `{t, p} = 1` where the time is carried.
    pub(super) fn pair<S: Scalar>(&self) -> [usize; 3]
    where
        K: Sites<S>,
    {
        let own = self.own();
        [own, own + 1, own + 2]
    }

    /// The number of coordinates: those of all sites, and where the time is carried those that carry it, the inputs and the rates of Wiener
    /// processes.
    pub(super) fn length<S: Scalar>(&self) -> usize
    where
        K: Sites<S>,
    {
        let kernels = self.kernels();
        match kernels.is_timed() {
            true => self.own() + carried(kernels) + kernels.noise_count() * self.count(),
            false => self.own(),
        }
    }

    /// Where an input is.
    pub(super) fn input<S: Scalar>(&self, index: usize) -> usize
    where
        K: Sites<S>,
    {
        self.own() + UNIT + 1 + index
    }

    /// The state for the coordinates of all sites.
    pub fn state<S: Scalar>(&self, mut of_sites: Vec<S>) -> Vec<S>
    where
        K: Sites<S>,
    {
        of_sites.resize(self.length(), S::zero());
        if self.kernels().is_timed() {
            let [.., unit] = self.pair();
            of_sites[unit] = S::one();
        }
        for index in 0..inputs(self.kernels()) {
            of_sites[self.input(index)] = self.kernels().input_default(index);
        }
        of_sites
    }

    /// Zeros in place of the sums, and behind them what all sites share.
    pub(super) fn shared<S: Scalar>(&self, mu: &[S]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let zeros = K::Sums::make(width(self.kernels()), |_| S::zero());
        self.with_shared(zeros, mu)
    }

    /// The sums with what all sites share behind them.
    pub(super) fn with_shared<S: Scalar>(&self, mut sums: Sums<K, S>, mu: &[S]) -> Sums<K, S>
    where
        K: Sites<S>,
    {
        let behind = &mut sums.as_mut()[self.kernels().count()..];
        if let [first, rest @ ..] = behind {
            let [_, time, _] = self.pair();
            *first = mu[time];
            rest.copy_from_slice(&mu[self.input(0)..][..rest.len()]);
        }
        sums
    }

    /// The derivatives of H by the inputs, by dual numbers: no motion asks for them.
    pub(super) fn set_input_slopes<S: Scalar>(&self, mu: &[S], out: &mut [S])
    where
        K: Sites<S>,
    {
        let count = inputs(self.kernels());
        if count == 0 {
            return;
        }
        let lifted = self.lift();
        let mut at: Vec<Dual<S>> = mu.iter().map(|value| Dual::constant_of(*value)).collect();
        for place in (0..count).map(|index| self.input(index)) {
            at[place] = Dual::variable(mu[place]);
            out[place] = lifted.kernels().energy(&lifted.totals(&at)).derivative;
            at[place] = Dual::constant_of(mu[place]);
        }
    }

    /// Sets what is carried beside the sites: the entries of the momentum of the time and of the time, and 0.
    pub(super) fn set_carried<S: Scalar>(&self, out: &mut [S], [momentum, time]: [S; 2])
    where
        K: Sites<S>,
    {
        let out = &mut out[self.own()..];
        if let [first, second, rest @ ..] = out {
            (*first, *second) = (momentum, time);
            rest.fill(S::zero());
        }
    }

    /// The brackets of the time and its momentum, in the Poisson matrix.
    pub(super) fn set_pair<S: Scalar>(&self, mu: &[S], out: &mut LateMatrix<S>)
    where
        K: Sites<S>,
    {
        let [momentum, time, unit] = self.pair();
        out.set(time, momentum, mu[unit]);
        out.set(momentum, time, -mu[unit]);
    }

    /// The same against a fixed vector, by the unit.
    pub(super) fn set_pair_slope<S: Scalar>(&self, xi: &[S], out: &mut LateMatrix<S>)
    where
        K: Sites<S>,
    {
        let [momentum, time, unit] = self.pair();
        out.set(time, unit, xi[momentum]);
        out.set(momentum, unit, -xi[time]);
    }
}
