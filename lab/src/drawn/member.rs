//! Members: a system with a state and a time, and where it leads.

use super::Chance;
use super::algebra::{Algebra, all};
use super::energy::{Energy, Kind};
use super::system::{Drawn, Square};
use lie_runtime::diagnostics::reference;
use lie_runtime::prelude::*;
use std::sync::Arc;

/// A system with a state, a time, and where it is then.
#[derive(Clone, Debug)]
pub struct Member {
    /// From which it was drawn.
    pub seed: u64,
    /// The system.
    pub system: Drawn,
    /// What kind of function H is.
    pub kind: Kind,
    /// The state at time 0.
    pub start: Vec<f64>,
    /// The end of the span.
    pub span: f64,
    /// The state there.
    pub end: Vec<f64>,
    /// By how much two ways to it differ, relative to the state.
    pub doubt: f64,
    /// By how much small relative changes of the states on the way are larger at the end, relative to it; at least 1.
    pub growth: f64,
    /// Drawings that were not kept before this one.
    pub refused: u32,
}

/// The largest entry.
pub fn size(mu: &[f64]) -> f64 {
    mu.iter().fold(
        0.0,
        |most: f64, x| if x.is_nan() { *x } else { most.max(x.abs()) },
    )
}

/// The largest distance of two states relative to the second one.
pub fn off(one: &[f64], other: &[f64]) -> f64 {
    let differences: Vec<f64> = one.iter().zip(other).map(|(a, b)| a - b).collect();
    size(&differences) / size(other)
}

/// A change of a state so small that it grows linearly.
const CHANGE: f64 = 1e-7;
/// States from which changes start.
const PLACES: usize = 3;
/// The largest state over that at the start that a drawing may reach.
const LARGEST: f64 = 30.0;

impl Member {
    /// The member of a number: the algebras in turn, and the kinds of Hamiltonians. Where a solution leaves for infinity, rests,
    /// or cannot be told, it is drawn anew.
    pub fn draw(number: u64) -> Self {
        let algebras = all();
        let algebra = &algebras[number as usize % algebras.len()];
        let kind = Kind::ALL[(number as usize / algebras.len()) % 4];
        let mut chance = Chance::new(number);
        for refused in 0.. {
            if let Some(member) = Self::try_draw(number, algebra, kind, refused, &mut chance) {
                return member;
            }
        }
        unreachable!("some drawing is kept")
    }

    fn try_draw(
        seed: u64,
        algebra: &Algebra,
        kind: Kind,
        refused: u32,
        chance: &mut Chance,
    ) -> Option<Self> {
        let algebra = if chance.holds(0.5) {
            algebra.in_another_basis(chance)
        } else {
            algebra.clone()
        };
        let dimension = algebra.dimension();
        let scale = chance.size_between(0.3, 3.0);
        let separable = chance.holds(0.25);
        let energy = Energy::draw(kind, dimension, scale, separable, chance);
        let system = Drawn::new(Arc::new(algebra), energy);
        let start = state(dimension, scale, chance);
        let rate = rate(&system, &start)?;
        let span = chance.size_between(15.0, 300.0) / rate;
        let far = reference(&system, &start, span)?;
        let end = far.mu;
        let moved = off(&start, &end);
        let by_series = series(&system, &start, span)?;
        // round-off is measured against the largest state on the way
        let largest = by_series.1.max(size(&start));
        // what is no number is left out too
        let sound =
            moved > 1e-3 && largest < LARGEST * size(&start) && size(&end) > largest / LARGEST;
        if !sound {
            return None;
        }
        let growth = growth(&system, &start, span, &end, chance)?;
        let doubt = (far.error / size(&end)).max(off(&by_series.0, &end));
        let end = by_series.0;
        Some(Self {
            seed,
            system,
            kind,
            start,
            span,
            end,
            doubt,
            growth,
            refused,
        })
    }
}

/// A state of a size; one in five is near an axis.
fn state(dimension: usize, scale: f64, chance: &mut Chance) -> Vec<f64> {
    let mut state: Vec<f64> = chance.numbers(dimension);
    let axis = chance.below(dimension);
    if chance.holds(0.2) {
        let near = chance.size_between(1e-4, 1e-1);
        for (k, entry) in state.iter_mut().enumerate() {
            *entry *= if k == axis { 1.0 } else { near };
        }
        state[axis] = 1.0_f64.copysign(state[axis]);
    }
    state.iter_mut().for_each(|entry| *entry *= scale);
    state
}

/// How fast the motion is: the velocity over the state, or the norm of the derivative of the field where that is larger.
pub(crate) fn rate(system: &Drawn, mu: &Vec<f64>) -> Option<f64> {
    let mut field: Vec<f64> = Poisson::<f64>::zero_state(system);
    let mut jacobian: Square<f64> = Poisson::<f64>::zero_jacobian(system);
    system.linearize(mu, &mut field, &mut jacobian);
    let rows = (0..mu.len()).map(|i| {
        (0..mu.len())
            .map(|j| jacobian.get(i, j).powi(2))
            .sum::<f64>()
    });
    let rate = rows.sum::<f64>().sqrt().max(size(&field) / size(mu));
    (rate.is_finite() && rate > 0.0).then_some(rate)
}

/// The end by Taylor series to round-off, and the largest state on the way.
fn series(system: &Drawn, start: &[f64], span: f64) -> Option<(Vec<f64>, f64)> {
    let mut mu = start.to_vec();
    let mut largest = size(&mu);
    let mut stepper = Taylor::default().stepper(system, span / 200.0, &NewtonOptions::default());
    for _ in 0..200 {
        stepper.step(&mut mu, &mut ()).ok()?;
        largest = largest.max(size(&mu));
        let bounded = largest < 1e3 * size(start);
        if !bounded {
            return None;
        }
    }
    Some((mu, largest))
}

/// The largest growth of changes at the start and at two later times.
fn growth(
    system: &Drawn,
    start: &[f64],
    span: f64,
    end: &[f64],
    chance: &mut Chance,
) -> Option<f64> {
    let ahead = |from: &[f64], time: f64| -> Option<Vec<f64>> {
        if time == 0.0 {
            return Some(from.to_vec());
        }
        let method = Dopri5 {
            rtol: 1e-11,
            atol: 1e-11 * size(start),
        };
        let problem = Problem::new(system.clone(), from.to_vec(), (0.0, time));
        let options = Options::new(time).save(Save::Ends);
        solve(&problem, method, &options).ok()?.mu.pop()
    };
    let end = &ahead(start, span).filter(|found| off(found, end) < 1e-4)?;
    let mut growth = 1.0_f64;
    for place in 0..PLACES {
        let time = span * place as f64 / PLACES as f64;
        let middle = ahead(start, time)?;
        for _ in 0..2 {
            let mut changed = middle.clone();
            for entry in &mut changed {
                *entry += CHANGE * size(&middle) * chance.number();
            }
            let by = off(&changed, &middle);
            growth = growth.max(off(&ahead(&changed, span - time)?, end) / by);
        }
    }
    growth.is_finite().then_some(growth)
}
