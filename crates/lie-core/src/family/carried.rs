//! What a family carries beside its sites where something acts on them: the time with its momentum and the unit, and the rates of the Wiener
//! processes, those of the first process of all sites before those of the second.

use super::stencil::CARRIED;
use super::{Family, LateMatrix, Sites};
use crate::matrix::SquareMatrix as _;
use crate::scalar::Scalar;
use std::vec::Vec;

impl<K> Family<K> {
    /// The number of coordinates of all sites.
    pub(super) fn own<S: Scalar>(&self) -> usize
    where
        K: Sites<S>,
    {
        self.kernels().dimension() * self.count()
    }

    /// Where the momentum of the time, the time and the unit are: `{t, p} = 1` where something acts beside H.
    pub(super) fn pair<S: Scalar>(&self) -> [usize; 3]
    where
        K: Sites<S>,
    {
        let own = self.own();
        [own, own + 1, own + 2]
    }

    /// The number of coordinates: those of all sites, and where something acts beside H those that carry the time and the rates of Wiener
    /// processes.
    pub(super) fn length<S: Scalar>(&self) -> usize
    where
        K: Sites<S>,
    {
        match self.kernels().acts() {
            true => self.own() + CARRIED + self.kernels().noise_count() * self.count(),
            false => self.own(),
        }
    }

    /// The state for the coordinates of all sites.
    pub fn state<S: Scalar>(&self, mut of_sites: Vec<S>) -> Vec<S>
    where
        K: Sites<S>,
    {
        of_sites.resize(self.length(), S::zero());
        if self.kernels().acts() {
            of_sites[self.own() + CARRIED - 1] = S::one();
        }
        of_sites
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
