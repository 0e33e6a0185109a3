//! The midpoint discrete gradient of Gonzalez.

use core::marker::PhantomData;

use super::DiscreteGradient;
use super::function::{Energy, Function};
use super::resolution::{Mean, Rule, difference_serves, largest};
use crate::clock::holds;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// The gradient at the midpoint `m = (x + y)/2`, corrected along `d = y - x`:
///
/// `g(x, y) = grad H(m) + a d`, `a = (H(y) - H(x) - <grad H(m), d>)/<d, d>`, and `grad H(m)` where d
/// is round-off of the state. Where H depends on the time, d has no entry for the momentum of that, so that
/// the time moves as it does. Derivative in y:
/// `H''(m)/2 + a 1 + d (x) [(grad H(y) - grad H(m) - H''(m) d/2) - 2 a d]/<d, d>`.
///
/// The numerator of a is `int_0^1 <grad H(x + s d) - grad H(m), d> ds`; which of the two forms is taken
/// decides the round-off of either, per lane. It vanishes for a quadratic H.
///
/// So for another [`Function`] in place of H, whose d has no entries for what the function does not depend on.
#[derive(Clone, Debug)]
pub struct GonzalezGradient<S: Scalar, P: Poisson<S>, F = Energy> {
    function: PhantomData<F>,
    rule: Rule<S>,
    start: P::State,
    before: S,
    middle: P::State,
    /// d divided by its largest entry, which keeps squares from overflow.
    direction: P::State,
    length: S,
    point: P::State,
    gradient: P::State,
    hessian: P::Jacobian,
}

impl<S: Scalar, P: Poisson<S>, F: Function<S, P>> GonzalezGradient<S, P, F> {
    /// Sets midpoint and direction, writes the gradient at the midpoint, and returns the correction
    /// `a |d|` along the direction.
    fn correction(&mut self, system: &P, end: &P::State, out: &mut P::State) -> S {
        let half = S::ratio(1.0, 2.0);
        let (x, y) = (self.start.as_slice(), end.as_slice());
        let size = self.size(system, end);
        let moved = x.iter().zip(y).enumerate();
        let moved = moved.filter(|(i, _)| F::counts(system, *i));
        let length = largest(moved.map(|(_, (&x, &y))| y - x));
        let flat = length.less_equal(S::epsilon() * size);
        self.length = S::select(flat, S::zero(), length);
        let inverse = S::one() / S::select(flat, S::one(), length);
        for index in 0..system.dimension() {
            self.middle.as_mut_slice()[index] = half * (x[index] + y[index]);
            let counts = F::counts(system, index);
            let along = (y[index] - x[index]) * inverse;
            self.direction.as_mut_slice()[index] = if counts { along } else { S::zero() };
        }
        F::gradient(system, &self.middle, out);
        let numerator = if self.rule.exact {
            self.integral(system, out).value
        } else {
            self.numerator(system, end, out, inverse)
        };
        let square = self.square(flat);
        S::select(flat, S::zero(), numerator / square)
    }

    /// The largest coordinate of both states.
    fn size(&self, system: &P, end: &P::State) -> S {
        let clock = system.clock();
        let both = [self.start.as_slice(), end.as_slice()];
        let entries = both.into_iter().flat_map(|state| state.iter().enumerate());
        let counted = entries.filter(|(i, _)| !holds(clock, *i));
        largest(counted.map(|(_, &entry)| entry))
    }

    /// The square of the direction, between 1 and n; 1 where the step is flat.
    fn square(&self, flat: S::Mask) -> S {
        let mut square = S::zero();
        for &entry in self.direction.as_slice() {
            square += entry * entry;
        }
        S::select(flat, S::one(), square)
    }

    /// `int_0^1 <grad H(x + s d) - grad H(m), e> ds` with the direction e.
    fn integral(&mut self, system: &P, at_middle: &P::State) -> Mean<S> {
        let rule = &self.rule;
        let mut mean = Mean::new();
        for node in 0..rule.len() {
            self.point.copy_from(&self.middle);
            let shift = rule.offset(node) * self.length;
            self.point.axpy(shift, &self.direction);
            F::gradient(system, &self.point, &mut self.gradient);
            let mut value = S::zero();
            for (index, &e) in self.direction.as_slice().iter().enumerate() {
                let entry = self.gradient.as_slice()[index];
                value += (entry - at_middle.as_slice()[index]) * e;
            }
            mean.add(rule, node, value);
        }
        mean
    }

    /// The same by whichever form keeps its digits, where H is no polynomial of known degree.
    fn numerator(&mut self, system: &P, end: &P::State, at_middle: &P::State, inverse: S) -> S {
        let after = F::value(system, end);
        let (mut along, mut terms, mut size) = (S::zero(), S::zero(), S::zero());
        let entries = at_middle.as_slice().iter().enumerate();
        for (index, &entry) in entries.filter(|(i, _)| F::counts(system, *i)) {
            along += entry * self.direction.as_slice()[index];
            terms += (entry * self.middle.as_slice()[index]).abs();
            size = size.max(entry.abs());
        }
        let difference = (after - self.before) * inverse - along;
        let energy = self.before.abs() + after.abs() + terms;
        let serves = difference_serves(energy, size * self.length);
        if serves.all() {
            return difference;
        }
        let mean = self.integral(system, at_middle);
        let stands = !serves & mean.stands_for(difference, energy, inverse);
        S::select(stands, mean.value, difference)
    }
}

impl<S: Scalar, P: Poisson<S>, F: Function<S, P>> DiscreteGradient<S, P>
    for GonzalezGradient<S, P, F>
{
    fn new(system: &P) -> Self {
        let zero = system.zero_state();
        Self {
            function: PhantomData,
            rule: Rule::of(F::degree(system)),
            start: zero.clone(),
            before: S::zero(),
            middle: zero.clone(),
            direction: zero.clone(),
            length: S::zero(),
            point: zero.clone(),
            gradient: zero,
            hessian: system.zero_jacobian(),
        }
    }

    fn set_start(&mut self, system: &P, start: &P::State) {
        self.start.copy_from(start);
        if !self.rule.exact {
            self.before = F::value(system, start);
        }
    }

    fn value(&mut self, system: &P, end: &P::State, out: &mut P::State) {
        let correction = self.correction(system, end, out);
        out.axpy(correction, &self.direction);
    }

    fn linearize(
        &mut self,
        system: &P,
        end: &P::State,
        out: &mut P::State,
        derivative: &mut P::Jacobian,
    ) {
        let half = S::ratio(1.0, 2.0);
        let correction = self.correction(system, end, out);
        F::gradient(system, end, &mut self.gradient);
        F::hessian(system, &self.middle, &mut self.hessian);
        // what the correction adds to the derivative is of the order of d; where that is below the
        // root of epsilon, so is its round-off, and neither counts
        let size = self.size(system, end);
        let near = self.length.less_equal(S::epsilon().sqrt() * size);
        let inverse = S::one() / S::select(near, S::one(), self.length);
        let inverse = S::select(near, S::zero(), inverse);
        let square = self.square(near);
        let slope = correction * inverse;
        for row in 0..system.dimension() {
            let mut bent = self.gradient.as_slice()[row] - out.as_slice()[row];
            for column in 0..system.dimension() {
                let entry = self.hessian.get(row, column);
                bent -= half * entry * (self.length * self.direction.as_slice()[column]);
            }
            let along = self.direction.as_slice()[row];
            self.point.as_mut_slice()[row] = (bent * inverse - (slope + slope) * along) / square;
        }
        for row in 0..system.dimension() {
            let along = self.direction.as_slice()[row];
            for column in 0..system.dimension() {
                let mut entry = half * self.hessian.get(row, column);
                entry += along * self.point.as_slice()[column];
                if row == column && F::counts(system, row) {
                    entry += slope;
                }
                derivative.set(row, column, entry);
            }
        }
        out.axpy(correction, &self.direction);
    }
}
