//! The exact flow of Hamiltonians that are integrable in closed form.
//!
//! Two kinds are recognised by the compiler (see [`Motion`]):
//!
//! - **free rigid bodies**: a direct sum of algebras so(3) in bases with `$[e_1, e_2] = c\, e_3$` and H a quadratic form that does
//!   not couple them. In the principal axes `$\mu' = c\, \mu \times A\mu$` are Euler's equations, solved by Jacobi's elliptic functions
//!   (see [`FreeBody`]), also at equal moments and at the separatrix;
//! - **constant velocities**: H is linear, or the coordinates that it contains commute. Then `$\nabla H$` is constant along
//!   each solution, and `$\mu(h) = \mathrm{Ad}^*_{\exp(h \nabla H)}\, \mu$`.
//!
//! The state is exact at any step, to round-off times the number of steps and turns; the energy, the orbit and the Poisson structure are those of the flow. The
//! group element of a body moves by Gauss collocation with eight stages on the exact velocities, of order 16, which is the
//! order stated here; with constant velocities it is exact too.
//!
//! Needs: [`IntegrablePoisson`].
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::equal_lanes;
use super::stepper::{
    FactorSink, Method, Retraction, RungeKutta, Stage, StepFailure, StepReport, Stepper, not_finite,
};
use crate::generic::{FreeBody, Words, coadjoint_action, gauss_tableau, principal_axes};
use crate::matrix::SquareMatrix as _;
use crate::newton::NewtonOptions;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown as _, copies};
use crate::structure::{IntegrablePoisson, Motion};

/// The exact flow; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

impl Facts for Exact {
    const ID: &'static str = "exact";
    const ORDER: u32 = 16;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves {
        energy: true,
        ..Preserves::POISSON
    };
}

impl<S: Scalar, P: IntegrablePoisson<S>> Method<S, P> for Exact {
    type Stepper<'a>
        = ExactStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        ExactStepper::new(system, h)
    }
}

/// The velocities of the group element are taken at so many nodes of a step.
const NODES: usize = 8;

/// Moves a state by the exact flow.
pub struct ExactStepper<'a, S: Scalar, P: IntegrablePoisson<S>> {
    system: &'a P,
    step: S,
    /// The principal axes of each body, as rows, at its coordinates.
    axes: [P::State; 3],
    /// The rates of Euler's equations in them.
    rates: P::State,
    /// The state in the axes of each body. It goes from step to step, so that the rounding of the axes does not add up.
    place: P::State,
    /// The constants of each body where the chain of steps began, in two words, and the unit of its states: they do not
    /// change by the rounding of steps, which on one orbit is the same in each and would add up.
    constants: [P::State; 2],
    /// Where the last step ended, in the lanes in which one did.
    end: P::State,
    follows: S::Mask,
    next: P::State,
}

impl<'a, S: Scalar, P: IntegrablePoisson<S>> ExactStepper<'a, S, P> {
    fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let mut stepper = Self {
            system,
            step: h,
            axes: copies(&zero),
            rates: zero.clone(),
            place: zero.clone(),
            constants: copies(&zero),
            end: zero.clone(),
            follows: S::Mask::splat(false),
            next: zero,
        };
        if system.motion() == Motion::Bodies {
            stepper.set_axes();
        }
        stepper
    }

    /// The principal axes of the bodies: H is a quadratic form with a constant matrix.
    fn set_axes(&mut self) {
        let mut hessian = self.system.zero_jacobian();
        self.system.hessian(&self.next, &mut hessian);
        for (index, body) in self.system.bodies().iter().enumerate() {
            let (axes, [first, second, third]) =
                principal_axes(body.map(|i| body.map(|j| hessian.get(i, j))));
            let scale = self.system.body_scale(index);
            let rates = [third - second, first - third, second - first];
            for (place, &k) in body.iter().enumerate() {
                for (row, axis) in self.axes.iter_mut().zip(axes) {
                    row.as_mut_slice()[k] = axis[place];
                }
                self.rates.as_mut_slice()[k] = scale * rates[place];
            }
        }
    }

    fn axes_of(&self, body: &[usize; 3]) -> [[S; 3]; 3] {
        core::array::from_fn(|row| body.map(|k| self.axes[row].as_slice()[k]))
    }

    /// Moves the bodies.
    fn move_bodies(&mut self, mu: &P::State) {
        let follows = self.follows & equal_lanes(self.system.clock(), &self.end, mu);
        for index in 0..self.system.bodies().len() {
            let body = self.system.bodies()[index];
            let axes = self.axes_of(&body);
            let fresh = into(&axes, at(mu.as_slice(), &body));
            let [old, rates] = [&self.place, &self.rates].map(|v| at(v.as_slice(), &body));
            let y = core::array::from_fn(|i| S::select(follows, old[i], fresh[i]));
            let (motion, constants) = self.chain(&body, follows, rates, y);
            let moved = motion.moved(y, motion.functions(self.step));
            let moved = motion.restored(moved, constants);
            put(self.place.as_mut_slice(), &body, moved);
            put(self.next.as_mut_slice(), &body, back(&axes, moved));
        }
    }

    /// The motion of a body from y, and its constants from the beginning of the chain, which is here in lanes where none
    /// goes on.
    fn chain(
        &mut self,
        body: &[usize; 3],
        follows: S::Mask,
        rates: [S; 3],
        y: [S; 3],
    ) -> (FreeBody<S>, [Words<S>; 2]) {
        let [high, low] = self.constants.each_mut().map(P::State::as_mut_slice);
        let &[first, second, unit] = body;
        high[unit] = S::select(follows, high[unit], FreeBody::unit(y));
        let motion = FreeBody::new(rates, y, high[unit]);
        for (k, fresh) in [first, second].into_iter().zip(motion.constants(y)) {
            high[k] = S::select(follows, high[k], fresh.high);
            low[k] = S::select(follows, low[k], fresh.low);
        }
        let kept = [first, second].map(|k| Words {
            high: high[k],
            low: low[k],
        });
        (motion, kept)
    }

    /// Gives away h times the velocities at the nodes of Gauss, from the state before the step.
    fn give_velocities<K: FactorSink<P::State>>(&mut self, mu: &P::State, sink: &mut K) {
        let tableau = gauss_tableau::<S, NODES>();
        let times = S::gather(tableau.c.map(|c| c * self.step));
        let (mut xi, mut there) = (mu.clone(), mu.clone());
        for node in 0..NODES {
            for index in 0..self.system.bodies().len() {
                let body = self.system.bodies()[index];
                let axes = self.axes_of(&body);
                let y = into(&axes, at(mu.as_slice(), &body));
                let rates = at(self.rates.as_slice(), &body);
                let motion = FreeBody::new(rates, y, FreeBody::unit(y));
                let functions = motion.widen().functions(times);
                let functions = functions.map(|wide| S::scatter(wide)[node]);
                put(
                    there.as_mut_slice(),
                    &body,
                    back(&axes, motion.moved(y, functions)),
                );
            }
            self.system.gradient(&there, &mut xi);
            for entry in xi.as_mut_slice() {
                *entry *= self.step;
            }
            let (index, count) = (node, NODES);
            sink.push_velocity(RungeKutta::Gauss, Stage { index, count }, &xi);
        }
    }
}

/// The coordinates of a body.
fn at<S: Copy>(state: &[S], body: &[usize; 3]) -> [S; 3] {
    body.map(|k| state[k])
}

fn put<S: Copy>(state: &mut [S], body: &[usize; 3], values: [S; 3]) {
    for (&k, value) in body.iter().zip(values) {
        state[k] = value;
    }
}

/// From the basis to the principal axes.
fn into<S: Scalar>(axes: &[[S; 3]; 3], [x, y, z]: [S; 3]) -> [S; 3] {
    axes.map(|axis| (axis[0] * x + axis[1] * y) + axis[2] * z)
}

/// From the principal axes to the basis.
fn back<S: Scalar>(axes: &[[S; 3]; 3], [x, y, z]: [S; 3]) -> [S; 3] {
    core::array::from_fn(|k| (axes[0][k] * x + axes[1][k] * y) + axes[2][k] * z)
}

impl<S: Scalar, P: IntegrablePoisson<S>> Stepper<S> for ExactStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let report = StepReport {
            evaluations: 1,
            substeps: 1,
            ..StepReport::default()
        };
        let motion = self.system.motion();
        match motion {
            Motion::Bodies => self.move_bodies(mu),
            Motion::Uniform => {
                self.system.gradient(mu, &mut self.place);
                for entry in self.place.as_mut_slice() {
                    *entry *= self.step;
                }
                coadjoint_action(self.system, &self.place, mu, &mut self.next);
            }
        }
        let good = self.next.finite();
        if sink.is_active() && good.any() {
            if motion == Motion::Uniform {
                super::implicit::clear(&mut self.place, !good);
                sink.push(Retraction::Exp, &self.place);
            } else {
                self.give_velocities(&{ mu.clone() }, sink);
            }
        }
        mu.assign_where(good, &self.next);
        self.end.copy_from(mu);
        self.follows = good;
        if good.all() {
            Ok(report)
        } else {
            Err(not_finite((!good).bits(), report))
        }
    }
}
