//! What the flows of a family do beside moving sites: the time, its momentum, and what follows them.

use super::Pieces;
use super::energy::Totals;
use super::rates::{Rate, coefficients};
use super::shape::{Fixed, Shape as _};
use super::sites::Sums;
use super::splitting::{FamilyFlows, Piece};
use super::stencil::{around, carried};
use crate::poisson::Poisson as _;
use crate::scalar::Scalar;

impl<S, K> FamilyFlows<'_, S, K>
where
    S: Scalar,
    K: Pieces<S>,
{
    /// 1 where a state carries the time, whose momentum is the first piece; else 0.
    pub(super) fn carries_time(&self) -> usize {
        usize::from(self.family.kernels().is_timed())
    }

    /// Copies what a state carries beside its sites, and the rates of noise into the order of the flows.
    pub(super) fn take_shared(&mut self, from: &[S], into: &mut [S]) {
        into.copy_from_slice(from);
        self.turn += 1;
        let kernels = self.family.kernels();
        let known = kernels.data_places().len() * self.family.count();
        if self.data.len() > known {
            let rates = &from[carried(kernels)..];
            self.columns.gather(rates, &mut self.data[known..]);
        }
    }

    /// The flow of the momentum of the time, with what H is beside its pieces: the time moves.
    pub(super) fn advance(&mut self, t: S, mu: &mut [S]) {
        let rest = |mu: &[S]| self.family.kernels().rest(&self.family.shared(mu));
        let [momentum, time, _] = self.family.pair();
        let before = rest(mu);
        mu[time] += t;
        let change = rest(mu) - before;
        mu[momentum] -= change;
        self.turn += 1;
    }

    /// The momentum of the time moves by what a piece of H changes with the time, which is constant along the flow of the piece.
    pub(super) fn take_from_momentum(
        &self,
        piece: &Piece<S>,
        t: S,
        sums: &Sums<K, S>,
        mu: &mut [S],
    ) {
        let (kernels, own) = (self.family.kernels(), self.family.own());
        let mut slope = Totals::<Fixed<1>, S>::new(1);
        slope.add(&[kernels.time_slope_of_sums(piece.place, sums)]);
        for line in 0..self.family.lines() {
            self.strips(piece, line, |strip| {
                slope.add(&[kernels.time_slopes(piece.place, (sums, &self.data), &strip, mu)]);
            });
        }
        mu[own] -= t * slope.end()[0];
    }

    /// The flow of a force that does work: the momentum of the time moves by what H loses.
    pub(super) fn work(&mut self, place: usize, t: S, mu: &mut [S]) {
        let before = self.energy(mu);
        let piece = &self.pieces[place];
        let sums = self.sums(piece, mu);
        self.sites(piece, t, &sums, mu);
        let change = self.energy(mu) - before;
        mu[self.family.own()] -= change;
    }

    /// H at a state in the order of the flows.
    fn energy(&mut self, mu: &[S]) -> S {
        let own = self.family.own();
        let all = S::zero().less_equal(S::zero());
        self.columns
            .scatter(all, &mu[..own], &mut self.state[..own]);
        self.state[own..].copy_from_slice(&mu[own..]);
        self.family.energy(&self.state)
    }

    /// Computes the rates of an exchange again where they depend on what has changed since.
    pub(super) fn refresh(&mut self, place: usize, mu: &[S]) {
        let (family, turn) = (self.family, self.turn);
        let kernels = family.kernels();
        if kernels.shared_count() == 0 {
            return;
        }
        let Some(mut rate) = self.pieces[place].exchange.take() else {
            return;
        };
        let (piece, shared) = (&self.pieces[place], family.shared(mu));
        // what is no exchange has no rate to begin with
        let speed = |at: &_| {
            let speed = kernels.shared_exchange(piece.place, at, &shared);
            speed.unwrap_or(S::zero())
        };
        match &mut rate {
            Rate::Same(rate) => {
                *rate = speed(&K::Around::make(around(kernels), |_| S::zero()));
            }
            Rate::Each { at: known, .. } if *known == turn => {}
            Rate::Each {
                rates,
                most,
                at: known,
            } => {
                (*known, *most) = (turn, S::zero());
                for line in 0..family.lines() {
                    self.strips(piece, line, |strip| {
                        let first = strip.places[0];
                        let of_strip = rates[first..][..strip.count].iter_mut();
                        for (rate, place) in of_strip.zip(first..) {
                            let at = coefficients(kernels, &self.data, strip.sites, place);
                            *rate = speed(&at);
                            *most = most.max(rate.abs());
                        }
                    });
                }
            }
        }
        self.pieces[place].exchange = Some(rate);
    }
}
