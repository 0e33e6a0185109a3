//! Whether noises commute: the brackets of their fields.

use super::paths::Places;
use crate::random::Random;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::scalar::Dual;
use lie_runtime::state::State;

/// A bracket below this part of its terms is zero.
const ZERO: f64 = 1e-10;

/// Whether the fields X_k of all noises commute at some states, `[X_j, X_k] = DX_k X_j - DX_j X_k = 0`: the bracket of two combinations of all
/// of them with coefficients at random. The field of the motion is linear in the rates, and dual numbers give the derivatives to round-off.
pub(super) fn commute<P: Lift<f64>>(
    system: &P,
    lifted: &P::Lifted,
    places: Places,
    states: &[P::State],
) -> bool {
    if places.count == 1 {
        return true;
    }
    let mut random = Random::new(1);
    let mut combination = || -> Vec<f64> { (0..places.count).map(|_| random.unit()).collect() };
    states.iter().all(|mu| {
        let noises = Noises {
            system,
            lifted,
            places,
            mu,
        };
        let (a, b) = (combination(), combination());
        let (along_a, along_b) = (noises.field(&a), noises.field(&b));
        let one = noises.slope(&b, &along_a);
        let other = noises.slope(&a, &along_b);
        let largest = |values: &[f64]| values.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
        let bracket: Vec<f64> = one.iter().zip(&other).map(|(x, y)| x - y).collect();
        largest(&bracket) <= ZERO * largest(&one).max(largest(&other))
    })
}

/// The fields of the noises at a state.
struct Noises<'a, P: Lift<f64>> {
    system: &'a P,
    lifted: &'a P::Lifted,
    places: Places,
    mu: &'a P::State,
}

impl<P: Lift<f64>> Noises<'_, P> {
    fn at(&self, rates: &[f64]) -> P::State {
        let mut mu = self.mu.clone();
        self.places.rates(&mut mu).copy_from_slice(rates);
        mu
    }

    /// That of a combination, on the coordinates that move.
    fn field(&self, rates: &[f64]) -> Vec<f64> {
        let all = |rates: &[f64]| {
            let mut field = self.system.zero_state();
            self.system.vector_field(&self.at(rates), &mut field);
            self.places.values(field.as_slice()).collect::<Vec<f64>>()
        };
        let (with, without) = (all(rates), all(&vec![0.0; rates.len()]));
        with.iter().zip(&without).map(|(x, y)| x - y).collect()
    }

    /// Its derivative along a direction.
    fn slope(&self, rates: &[f64], direction: &[f64]) -> Vec<f64> {
        let all = |rates: &[f64]| {
            let mut mu = self.lifted.zero_state();
            let at = self.at(rates);
            for (entry, value) in mu.as_mut_slice().iter_mut().zip(at.as_slice()) {
                *entry = Dual::constant_of(*value);
            }
            for (place, along) in self.places.own().zip(direction) {
                mu.as_mut_slice()[place].derivative = *along;
            }
            let mut field = self.lifted.zero_state();
            self.lifted.vector_field(&mu, &mut field);
            let moving = self.places.own();
            moving
                .map(|place| field.as_slice()[place].derivative)
                .collect::<Vec<f64>>()
        };
        let (with, without) = (all(rates), all(&vec![0.0; rates.len()]));
        with.iter().zip(&without).map(|(x, y)| x - y).collect()
    }
}
