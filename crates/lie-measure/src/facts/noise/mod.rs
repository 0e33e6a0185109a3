//! What a method does on paths of noise: how far it is from the path in the mean square, how far its means are from those of the motion, and at a
//! temperature how far those of long runs are from the means of the density that is invariant.

mod commuting;
mod orbits;
mod paths;
mod quadrature;
mod slope;
mod space;
mod stationary;
mod strong;
mod weak;

use super::findings::Finding;
use super::ground::Ground;
use commuting::commute;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::matrix::SquareMatrix;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;
use paths::Places;
use slope::{BATCHES, Slope};
use stationary::Stationary;
pub use stationary::Thermal;

/// The largest step over the time in which the motion without noise changes.
const OF_MOTION: f64 = 0.4;
/// The largest mean square of what noise adds to a step, relative to the state.
const OF_NOISE: f64 = 0.1;
/// Steps of the largest size over the span.
const FEWEST: usize = 4;
/// The fewest samples of a batch.
const FEWEST_SAMPLES: usize = 2;
/// How much smaller than the order a slope may be beside its statistical error: the steps of the ladder are no limit.
const SLACK: f64 = 0.15;
/// In standard errors of the slope.
const CERTAIN: f64 = 3.0;
/// A slope with a larger standard error tells nothing.
const COARSE: f64 = 0.25;

/// What all measurements along paths share.
pub struct Noise<V> {
    places: Places,
    seed: u64,
    start: V,
    span: f64,
    /// Whether the noises commute.
    pub commuting: bool,
    /// The paths in the mean square, each with its end.
    exact: Vec<(paths::Increments, V)>,
    /// What long runs are compared with, where a temperature is declared.
    stationary: Option<Stationary<V>>,
}

impl<V: State<f64>> Noise<V> {
    /// That of a system around its ground; none where it has no noise.
    pub(super) fn new<P>(
        system: &P,
        lifted: &P::Lifted,
        ground: &Ground<P>,
        (seed, thermal): (u64, Option<&Thermal>),
    ) -> Option<Self>
    where
        P: Lift<f64> + Poisson<f64, State = V>,
    {
        let places = Places::of(system)?;
        // the initial state may be at rest, or lie on an axis
        let mut start = ground.states.get(1).unwrap_or(&ground.states[0]).clone();
        places.rates(&mut start).fill(0.0);
        let step = match ground.step == ground.natural_step {
            true => largest_step(system, places, &start),
            false => ground.step.abs(),
        };
        let span = FEWEST as f64 * step;
        let mut noise = Self {
            places,
            seed,
            commuting: commute(system, lifted, places, &ground.states),
            start,
            span,
            exact: Vec::new(),
            stationary: thermal
                .and_then(|thermal| Stationary::new(system, &ground.states[0], seed, thermal)),
        };
        noise.exact = strong::exact(system, &noise);
        Some(noise)
    }

    /// The number of samples, so many in each batch of a system of three coordinates: more coordinates take longer, and have fewer.
    fn samples(&self, of_batch: usize) -> usize {
        let own = self.places.own().count();
        BATCHES * (of_batch * 3 / own.max(3)).max(FEWEST_SAMPLES)
    }

    /// The order of a method in the mean square.
    pub(super) fn strong_order<P>(&self, system: &P, method: &dyn AnyMethod<f64, P>) -> Finding
    where
        P: Lift<f64> + Poisson<f64, State = V>,
    {
        strong::finding(system, self, method)
    }

    /// The order of means of functions of the state (the weak order): the slope of what halving the step changes in the means of the
    /// coordinates, their squares or products, and H, over so many paths for each of four steps, four million at most; 2,000 without a number, fewer where there are more
    /// than three coordinates. A path, the one of opposite sign and both with increments that change places in pairs are one sample
    /// (M. B. Giles, L. Szpruch, 2014, doi:10.1214/13-AAP957), and the error of the slope is from twenty batches of samples.
    pub fn weak_order<P>(
        &self,
        system: &P,
        method: &dyn AnyMethod<f64, P>,
        paths: Option<usize>,
    ) -> Finding
    where
        P: Lift<f64> + Poisson<f64, State = V>,
    {
        weak::finding(system, self, method, paths)
    }

    /// The means of long runs, where a temperature is declared.
    pub(super) fn means<P>(&self, system: &P, method: &dyn AnyMethod<f64, P>) -> Vec<Finding>
    where
        P: Lift<f64> + Poisson<f64, State = V>,
    {
        let stationary = self.stationary.as_ref();
        stationary.map_or_else(Vec::new, |stationary| {
            stationary::findings(system, stationary, method)
        })
    }
}

/// The largest step at which orders are measured.
fn largest_step<P: Poisson<f64>>(system: &P, places: Places, start: &P::State) -> f64 {
    let at = |process: Option<usize>| {
        let mut mu = start.clone();
        if let Some(process) = process {
            places.rates(&mut mu)[process] = 1.0;
        }
        let (mut field, mut jacobian) = (system.zero_state(), system.zero_jacobian());
        system.vector_field(&mu, &mut field);
        system.jacobian(&mu, &mut jacobian);
        (field, jacobian)
    };
    let (still, own) = (at(None), places.own());
    let size = places.size(start.as_slice()).max(f64::MIN_POSITIVE);
    let rate = |entry: &dyn Fn(usize, usize) -> f64| {
        let rows = own
            .clone()
            .map(|i| own.clone().map(|j| entry(i, j).abs()).sum::<f64>());
        rows.fold(0.0, f64::max)
    };
    let motion = rate(&|i, j| still.1.get(i, j));
    let squares = (0..places.count).map(|process| {
        let (field, jacobian) = at(Some(process));
        let turns = rate(&|i, j| jacobian.get(i, j) - still.1.get(i, j));
        let moves = own
            .clone()
            .map(|i| (field.as_slice()[i] - still.0.as_slice()[i]).abs() / size);
        moves.fold(turns, f64::max).powi(2)
    });
    1.0 / (motion / OF_MOTION + squares.sum::<f64>() / OF_NOISE)
}

/// What a slope says of an order that is claimed, if one is.
fn judged(
    fact: &'static str,
    claim: Option<f64>,
    slope: Option<Slope>,
    (samples, what): (usize, &str),
) -> Finding {
    let order = claim.unwrap_or(0.0);
    let unresolved = |why: String| match claim {
        None => Finding::absent(fact, "not claimed").note(why),
        Some(order) => Finding::not_measurable(fact, order, order - SLACK).note(why),
    };
    let Some(slope) = slope else {
        return unresolved(format!(
            "not resolved: {samples} {what} leave too few errors that are not statistical"
        ));
    };
    let Slope { value, error, ends } = slope;
    let [(largest, first), (smallest, last)] = ends;
    let note = format!(
        "± {error:.2} by {samples} {what}, errors {first:.1e} to {last:.1e} with steps of {largest:.2e} to {smallest:.2e}"
    );
    if error > COARSE {
        return unresolved(format!("not resolved: {value:.2} {note}"));
    }
    let bound = order - SLACK - CERTAIN * error;
    Finding::at_least(fact, claim.is_some(), value, order, bound)
        .at_step(largest)
        .with_error(error)
        .note(note)
}
