//! Taylor coefficients of a solution by power series: the field is evaluated over truncated series, from the
//! beginning for each order.

use crate::poisson::Poisson;
use crate::recurrence::{Expand, GradientRecurrence, Recurrence};
use crate::scalar::{Scalar, Truncated};
use crate::state::State;

/// The plain form of [`Recurrence`]: `f_k` is the coefficient k of the field over series of k + 1 terms.
pub struct PowerSeries<S: Scalar, P: Expand<S>> {
    system: P::Expanded,
    /// The coordinates as series.
    series: <P::Expanded as Poisson<Truncated<S>>>::State,
    out: <P::Expanded as Poisson<Truncated<S>>>::State,
    generator: P::State,
}

impl<S: Scalar, P: Expand<S>> PowerSeries<S, P> {
    /// The recurrence of a system.
    pub fn new(system: &P) -> Self {
        let expanded = system.expand();
        let series = expanded.zero_state();
        Self {
            out: series.clone(),
            series,
            system: expanded,
            generator: system.zero_state(),
        }
    }

    /// Takes a coefficient of the state and computes one of field and generator.
    fn next(&mut self, k: usize, coefficient: &P::State, field: &mut P::State) {
        let coordinates = self.series.as_mut_slice().iter_mut();
        for (series, &next) in coordinates.zip(coefficient.as_slice()) {
            let known = *series;
            *series =
                Truncated::from_fn(k + 1, |j| if j < k { known.coefficient(j) } else { next });
        }
        self.system.vector_field(&self.series, &mut self.out);
        take(k, &self.out, field);
        self.system.generator(&self.series, &mut self.out);
        take(k, &self.out, &mut self.generator);
    }
}

/// One coefficient of each entry.
fn take<S: Scalar, W: State<Truncated<S>>, V: State<S>>(k: usize, series: &W, out: &mut V) {
    for (entry, series) in out.as_mut_slice().iter_mut().zip(series.as_slice()) {
        *entry = series.coefficient(k);
    }
}

impl<S: Scalar, P: Expand<S>> Recurrence<S> for PowerSeries<S, P> {
    type State = P::State;
    type Carry = ();

    fn begin(&mut self, mu: &P::State, field: &mut P::State) {
        self.next(0, mu, field);
    }

    fn advance(&mut self, k: usize, _carry: (), coefficient: &P::State, field: &mut P::State) {
        self.next(k, coefficient, field);
    }
}

impl<S: Scalar, P: Expand<S>> GradientRecurrence<S> for PowerSeries<S, P> {
    fn gradient(&self) -> &P::State {
        &self.generator
    }
}
