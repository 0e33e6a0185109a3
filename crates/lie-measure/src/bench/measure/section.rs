//! The distance of runs from the exact solution on a surface of section.

use super::{Look, Plane, Wanted, worse};
use crate::facts::relative_error;
use lie_runtime::diagnostics::reference;
use lie_runtime::{Poisson, State};

/// Passages that are compared: the last ones.
const PASSAGES: usize = 32;
/// Points of the exact solution between which passages are looked for.
const POINTS: f64 = 1e6;

/// Why there is no section.
#[derive(Debug)]
pub(in crate::bench) enum NoSection {
    /// The coordinate, the value, and the least and largest value of the coordinate.
    NotPassed(usize, f64, (f64, f64)),
    /// A number becomes infinite, or the span is too long.
    Unreachable,
}

/// Exact passages through a surface.
pub(in crate::bench) struct Section<V> {
    plane: Plane,
    /// -1 for a run backwards: what is upward follows the run.
    direction: f64,
    rate: f64,
    times: Vec<f64>,
    points: Vec<V>,
    /// How many there are, of which the last are compared.
    all: usize,
}

impl<V: State<f64>> Section<V> {
    /// The passages of the solution from `mu` until a time. Without a plane: of the coordinate that moves most, at the
    /// middle of what it goes through.
    pub(in crate::bench) fn new<P: Poisson<f64, State = V>>(
        system: &P,
        mu: &V,
        until: f64,
        plane: Option<Plane>,
        rate: f64,
    ) -> Result<Self, NoSection> {
        let count = (until.abs() * rate * 4.0).ceil().max(16.0);
        if count > POINTS {
            return Err(NoSection::Unreachable);
        }
        let h = until / count;
        let mut states = vec![mu.clone()];
        for _ in 0..count as usize {
            let last = &states[states.len() - 1];
            let next = reference(system, last, h).ok_or(NoSection::Unreachable)?;
            states.push(next.mu);
        }
        let range = |coordinate: usize| {
            let values = states.iter().map(|mu| mu.as_slice()[coordinate]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            })
        };
        let plane = plane.unwrap_or_else(|| {
            let ranges = (0..mu.as_slice().len()).map(range).enumerate();
            let widest = ranges.max_by(|(_, a), (_, b)| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
            let (coordinate, (low, high)) = widest.unwrap_or((0, (0.0, 0.0)));
            let value = low + 0.5 * (high - low);
            Plane { coordinate, value }
        });
        let mut section = Self {
            plane,
            direction: until.signum(),
            rate,
            times: Vec::new(),
            points: Vec::new(),
            all: 0,
        };
        for (k, pair) in states.windows(2).enumerate() {
            if section.above(&pair[0]) < 0.0 && section.above(&pair[1]) >= 0.0 {
                let (point, time) = section
                    .carried(system, &pair[0])
                    .ok_or(NoSection::Unreachable)?;
                section.times.push(h * k as f64 + time);
                section.points.push(point);
            }
        }
        section.all = section.times.len();
        if section.all == 0 {
            let Plane { coordinate, value } = plane;
            return Err(NoSection::NotPassed(coordinate, value, range(coordinate)));
        }
        let first = section.all.saturating_sub(PASSAGES);
        section.times.drain(..first);
        section.points.drain(..first);
        Ok(section)
    }

    pub(in crate::bench) fn plane(&self) -> Plane {
        self.plane
    }

    pub(in crate::bench) fn passages(&self) -> usize {
        self.all
    }

    /// The largest distance of the points, relative to the state.
    pub(super) fn distance<P: Poisson<f64, State = V>>(
        &self,
        system: &P,
        look: &Look<'_, V>,
    ) -> Result<f64, String> {
        let mut seen = Vec::new();
        look(&Wanted::At(&self.times), &mut |time, mu| {
            seen.push((time, mu.clone()));
        })?;
        let mut largest = 0.0;
        for ((time, mu), (exact, point)) in seen.iter().zip(self.times.iter().zip(&self.points)) {
            let near = match exact - time {
                0.0 => Some(mu.clone()),
                left => reference(system, mu, left).map(|there| there.mu),
            };
            let carried = near.and_then(|near| self.carried(system, &near));
            let (on, _) = carried
                .ok_or_else(|| format!("it does not pass the section near t = {exact:.6}"))?;
            largest = worse(largest, relative_error(&on, point));
        }
        Ok(largest)
    }

    fn above(&self, mu: &V) -> f64 {
        mu.as_slice()[self.plane.coordinate] - self.plane.value
    }

    /// A state carried to the surface along the exact flow, and the time of that, by Newton's iteration in the time; the
    /// coordinate rises there.
    fn carried<P: Poisson<f64, State = V>>(&self, system: &P, mu: &V) -> Option<(V, f64)> {
        let mut near = mu.clone();
        let mut field = system.zero_state();
        let mut time = 0.0;
        for _ in 0..100 {
            system.vector_field(&near, &mut field);
            let speed = field.as_slice()[self.plane.coordinate];
            let longest = 0.25 / self.rate;
            let step = (-self.above(&near) / speed).clamp(-longest, longest);
            if !step.is_finite() {
                return None;
            }
            if step.abs() * self.rate <= 2.0 * f64::EPSILON {
                return (speed * self.direction > 0.0).then_some((near, time));
            }
            near = reference(system, &near, step)?.mu;
            time += step;
        }
        None
    }
}
