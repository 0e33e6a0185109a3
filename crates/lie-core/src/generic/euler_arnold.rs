//! The two halves of a step on `T*G` as equations.

use super::acting::Acting;
use super::dexp_slope::DexpSlope;
use super::momenta;
use super::series::coadjoint_action_in;
use crate::clock::Clock;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::scalar::Scalar;
use crate::state::{State, copies};
use crate::structure::CotangentPoisson;

/// Which half of a step: they are adjoint to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// The force acts at the beginning, where g is.
    First,
    /// The force acts at the end.
    Second,
}

/// One half of the method [`crate::methods::EulerArnold2`], a symplectic map of `T*G` of order 1.
///
/// The state is (mu, a): the momenta, then the coordinates a of the configuration, on which the group acts.
/// With the force `F = -ad*_(0, dH/da) (0, a)` in the momenta and an element `xi = (x, 0)`:
///
/// - first half: unknown m; `nu = mu - h F(a, m)`, `x = h dH/dmu (m, a)`,
///   `r(m) = m - phi1(ad*_xi) nu`; the new state is `exp(ad*_xi) (nu, a)`;
/// - second half: unknown `y = |mu| x`, so that an angle x is solved for to round-off whatever the units of mu;
///   `(mu', a1) = exp(ad*_xi) (mu, a)`, `m = phi1(ad*_xi) mu`, `r(y) = y - |mu| h dH/dmu (m, a1)`; the new
///   state is `(mu' - h F(a1, m), a1)`.
///
/// Both are products of two coadjoint actions, of `exp(xi)` and of `exp(h (0, dH/da))`, so the coadjoint orbit
/// is kept to round-off whatever the error of the unknown. Where forces act they are added to F, at the same place, and where damping does
/// the generator takes the place of the gradient of H: the spatial momentum changes by exactly the impulses at both ends. Jacobians: by the derivatives of `phi1(ad*_xi) nu`, and
/// `exp(A) = 1 + A phi1(A)`.
#[derive(Debug)]
pub struct EulerArnoldHalf<'a, S: Scalar, P: CotangentPoisson<S>> {
    system: &'a P,
    half: Half,
    step: S,
    /// `|mu|`, or 1 where it is 0.
    size: S,
    base: P::State,
    /// (nu, a), or (mu, a) in the second half.
    start: P::State,
    /// (m, a) or (m, a1): where H is taken.
    point: P::State,
    gradient: P::State,
    /// (x, 0)
    direction: P::State,
    /// (0, h dH/da)
    force: P::State,
    hessian: P::Jacobian,
    /// The derivative of the force, where one acts.
    slope: Acting<P::Jacobian>,
    series: DexpSlope<P::State, P::Jacobian, S>,
    /// `phi1(ad*_direction)` of the start.
    sum: P::State,
    columns: [P::State; 4],
}

impl<'a, S: Scalar, P: CotangentPoisson<S>> EulerArnoldHalf<'a, S, P> {
    /// The equation of the first half with the step h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            half: Half::First,
            step: h,
            size: S::one(),
            base: zero.clone(),
            start: zero.clone(),
            point: zero.clone(),
            gradient: zero.clone(),
            direction: zero.clone(),
            force: zero.clone(),
            hessian: system.zero_jacobian(),
            slope: Acting::of(system, || system.zero_jacobian()),
            series: DexpSlope::new(&zero, system.zero_jacobian()),
            sum: zero.clone(),
            columns: copies(&zero),
        }
    }

    /// Goes over to one of the halves.
    pub fn set_half(&mut self, half: Half) {
        self.half = half;
    }

    /// Splits h times the generator at the point into the direction and the force.
    fn split_gradient(&mut self) {
        self.system.generator(&self.point, &mut self.gradient);
        self.direction.fill(S::zero());
        self.force.fill(S::zero());
        for (index, &slope) in self.gradient.as_slice().iter().enumerate() {
            let part = if index < self.system.momenta() {
                &mut self.direction
            } else {
                &mut self.force
            };
            part.as_mut_slice()[index] = self.step * slope;
        }
    }

    /// Adds `ad*_force a`, which changes the momenta only.
    fn push_force(
        system: &P,
        force: &P::State,
        at: &P::State,
        into: &mut P::State,
        free: &mut P::State,
    ) {
        system.ad_star(force, at, free);
        for index in 0..system.momenta() {
            into.as_mut_slice()[index] += free.as_slice()[index];
        }
    }

    /// Adds h times the force that acts at the point.
    fn push_acting(
        (system, step): (&P, S),
        point: &P::State,
        into: &mut P::State,
        free: &mut P::State,
    ) {
        if system.is_forced() {
            system.force(point, free);
            for index in 0..system.momenta() {
                into.as_mut_slice()[index] += step * free.as_slice()[index];
            }
        }
    }

    /// Sets the sum.
    fn momentum(&mut self) {
        let (system, series) = (self.system, &mut self.series);
        series.linearize(system, &self.direction, &self.start, &mut self.sum);
    }

    /// First half: sets direction, force and start for the momentum m.
    fn set_first(&mut self, m: &P::Momentum) {
        self.point.copy_from(&self.base);
        self.point.as_mut_slice()[..self.system.momenta()].copy_from_slice(m.as_slice());
        self.split_gradient();
        self.start.copy_from(&self.base);
        let free = &mut self.columns[0];
        Self::push_force(self.system, &self.force, &self.base, &mut self.start, free);
        let of_step = (self.system, self.step);
        Self::push_acting(of_step, &self.point, &mut self.start, free);
    }

    /// Second half: the configuration a1 for the element x, by the action on the whole state.
    fn set_second(&mut self, y: &P::Momentum) {
        self.start.copy_from(&self.base);
        self.direction.fill(S::zero());
        for (entry, &y) in self.direction.as_mut_slice().iter_mut().zip(y.as_slice()) {
            *entry = y / self.size;
        }
        let (system, scratch) = (self.system, self.series.scratch());
        coadjoint_action_in(
            system,
            &self.direction,
            &self.base,
            &mut self.point,
            scratch,
        );
    }

    fn evaluate(&mut self, unknown: &P::Momentum, residual: &mut P::Momentum) {
        match self.half {
            Half::First => {
                self.set_first(unknown);
                self.momentum();
                for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
                    *out = unknown.as_slice()[index] - self.sum.as_slice()[index];
                }
            }
            Half::Second => {
                self.solve_point(unknown);
                self.system.generator(&self.point, &mut self.gradient);
                for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
                    let velocity = self.step * self.gradient.as_slice()[index];
                    *out = unknown.as_slice()[index] - self.size * velocity;
                }
            }
        }
    }

    fn linearize_first(&mut self, matrix: &mut P::MomentumMatrix) {
        self.system.generator_slope(&self.point, &mut self.hessian);
        if let Some(slope) = self.slope.get_mut(self.system) {
            self.system.force_slope(&self.point, slope);
        }
        let [along, force, total, free] = &mut self.columns;
        for column in 0..self.system.momenta() {
            along.fill(S::zero());
            force.fill(S::zero());
            total.fill(S::zero());
            for row in 0..self.system.dimension() {
                let part = if row < self.system.momenta() {
                    &mut *along
                } else {
                    &mut *force
                };
                part.as_mut_slice()[row] = self.step * self.hessian.get(row, column);
            }
            Self::push_force(self.system, force, &self.base, total, free);
            if let Some(slope) = self.slope.get(self.system) {
                for row in 0..self.system.momenta() {
                    total.as_mut_slice()[row] += self.step * slope.get(row, column);
                }
            }
            self.series
                .along_both(self.system, &self.direction, along, total);
            for row in 0..self.system.momenta() {
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - total.as_slice()[row]);
            }
        }
    }

    fn linearize_second(&mut self, matrix: &mut P::MomentumMatrix) {
        self.system.generator_slope(&self.point, &mut self.hessian);
        let [unit, total, first, second] = &mut self.columns;
        for column in 0..self.system.momenta() {
            unit.fill(S::zero());
            unit.as_mut_slice()[column] = S::one();
            self.series
                .derivative(self.system, &self.direction, unit, total);
            // exp(A) = 1 + A phi1(A): the derivative of the action along the unit
            self.system.ad_star(unit, &self.sum, first);
            self.system.ad_star(&self.direction, total, second);
            for row in 0..self.system.momenta() {
                let mut slope = S::zero();
                for inner in 0..self.system.dimension() {
                    let moved = if inner < self.system.momenta() {
                        total.as_slice()[inner]
                    } else {
                        first.as_slice()[inner] + second.as_slice()[inner]
                    };
                    slope += self.hessian.get(row, inner) * moved;
                }
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - self.step * slope);
            }
        }
    }

    /// The element of each of the two actions of a solved half, in their order.
    pub(crate) fn factors(&mut self, unknown: &P::Momentum) -> [&P::State; 2] {
        match self.half {
            Half::First => {
                self.set_first(unknown);
                [&self.force, &self.direction]
            }
            Half::Second => {
                self.solve_point(unknown);
                self.set_force();
                [&self.direction, &self.force]
            }
        }
    }

    /// Second half: the point (m, a1) of an unknown; `columns[2]` holds `(mu', a1)`.
    fn solve_point(&mut self, unknown: &P::Momentum) {
        self.set_second(unknown);
        self.momentum();
        self.columns[2].copy_from(&self.point);
        let point = self.point.as_mut_slice();
        point[..self.system.momenta()]
            .copy_from_slice(&self.sum.as_slice()[..self.system.momenta()]);
    }

    /// The force at the point, the direction kept.
    fn set_force(&mut self) {
        self.system.generator(&self.point, &mut self.gradient);
        self.force.fill(S::zero());
        for index in self.system.momenta()..self.system.dimension() {
            self.force.as_mut_slice()[index] = self.step * self.gradient.as_slice()[index];
        }
    }
}

impl<S: Scalar, P: CotangentPoisson<S>> Equation<S> for EulerArnoldHalf<'_, S, P> {
    type State = P::State;
    type Unknown = P::Momentum;
    type Matrix = P::MomentumMatrix;

    fn zero_unknown(&self) -> P::Momentum {
        self.system.zero_momentum()
    }

    fn zero_matrix(&self) -> P::MomentumMatrix {
        self.system.zero_momentum_matrix()
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.size = momenta::size(self.system, mu);
    }

    fn scale(&self, _mu: &P::State) -> S {
        self.size
    }

    #[inline]
    fn clock(&self) -> Option<Clock> {
        self.system.clock()
    }

    fn initial_guess(&mut self, unknown: &mut P::Momentum) {
        let half = self.step * S::ratio(1.0, 2.0);
        self.system.vector_field(&self.base, &mut self.gradient);
        self.point.copy_from(&self.base);
        self.point.axpy(half, &self.gradient);
        if self.half == Half::Second {
            let point = self.point.clone();
            self.system.generator(&point, &mut self.point);
            for entry in self.point.as_mut_slice() {
                *entry *= self.step * self.size;
            }
        }
        let guess = &self.point.as_slice()[..self.system.momenta()];
        unknown.as_mut_slice().copy_from_slice(guess);
    }

    fn residual(&mut self, unknown: &P::Momentum, residual: &mut P::Momentum) {
        self.evaluate(unknown, residual);
    }

    fn linearize(
        &mut self,
        unknown: &P::Momentum,
        residual: &mut P::Momentum,
        matrix: &mut P::MomentumMatrix,
    ) {
        self.evaluate(unknown, residual);
        match self.half {
            Half::First => self.linearize_first(matrix),
            Half::Second => self.linearize_second(matrix),
        }
    }

    fn result(&mut self, unknown: &P::Momentum, mu: &mut P::State) {
        match self.half {
            Half::First => {
                self.set_first(unknown);
                let (system, scratch) = (self.system, self.series.scratch());
                coadjoint_action_in(system, &self.direction, &self.start, mu, scratch);
            }
            Half::Second => {
                self.solve_point(unknown);
                self.set_force();
                mu.copy_from(&self.columns[2]);
                let free = &mut self.columns[0];
                Self::push_force(self.system, &self.force, &self.point, mu, free);
                let of_step = (self.system, self.step);
                Self::push_acting(of_step, &self.point, mu, free);
            }
        }
    }
}
