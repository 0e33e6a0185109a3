//! The implicit trapezoidal rule, `u = mu + (h/2) (f(mu) + f(u))`: a method that the catalogue does not have.

use lie_core::methods::{Facts, ImplicitStepper, Method, Preserves};
use lie_core::newton::{NewtonOptions, dense};
use lie_core::{Equation, Implicit, Poisson, Scalar, State};

/// The implicit trapezoidal rule: order 2, symmetric, conjugate to the midpoint rule.
///
/// Reference: E. Hairer, C. Lubich and G. Wanner (2006), Geometric Numerical Integration, section VI.8.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trapezoid;

impl Facts for Trapezoid {
    const ID: &'static str = "trapezoid";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::LINEAR;
}

impl<S: Scalar, P: Implicit<S, Self>> Method<S, P> for Trapezoid {
    type Stepper<'a>
        = ImplicitStepper<S, P::Equation<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        ImplicitStepper::new(system.equation(self, h), system.zero_state(), newton)
    }
}

/// One step, unknown the state at its end: `r(u) = u - mu - (h/2) (f(mu) + f(u))`.
#[derive(Debug)]
pub struct TrapezoidEquation<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    half: S,
    base: P::State,
    /// `f(mu)`
    start: P::State,
    /// `f(u)`
    end: P::State,
}

impl<'a, S: Scalar, P: Poisson<S>> TrapezoidEquation<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            half: h * S::ratio(1.0, 2.0),
            base: zero.clone(),
            start: zero.clone(),
            end: zero,
        }
    }

    fn write_residual(&self, unknown: &P::State, residual: &mut P::State) {
        let (base, start, end) = (
            self.base.as_slice(),
            self.start.as_slice(),
            self.end.as_slice(),
        );
        for (i, out) in residual.as_mut_slice().iter_mut().enumerate() {
            *out = unknown.as_slice()[i] - base[i] - self.half * (start[i] + end[i]);
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Equation<S> for TrapezoidEquation<'_, S, P> {
    type State = P::State;
    type Unknown = P::State;
    type Matrix = P::Jacobian;

    fn zero_unknown(&self) -> P::State {
        self.system.zero_state()
    }

    fn zero_matrix(&self) -> P::Jacobian {
        self.system.zero_jacobian()
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.system.vector_field(mu, &mut self.start);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        unknown.copy_from(&self.base);
        unknown.axpy(self.half + self.half, &self.start);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.system.vector_field(unknown, &mut self.end);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.system.linearize(unknown, &mut self.end, matrix);
        self.write_residual(unknown, residual);
        dense::identity_minus(self.half, matrix);
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        mu.copy_from(unknown);
    }
}
