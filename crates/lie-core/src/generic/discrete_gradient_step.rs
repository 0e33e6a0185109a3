//! The equation of the discrete gradient methods.

use super::acting::Acting;
use super::beside::Beside;
use super::discrete_gradient::DiscreteGradient;
use super::kernels::multiply;
use super::metriplectic::Growth;
use super::tensor::{MidpointTensor, PoissonTensor};
use crate::clock::Clock;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// A discrete gradient method for any Poisson system.
///
/// Unknown: the new state u. Equation: `r(u) = u - mu - h T(mu, u) g(mu, u)` with the discrete gradient g
/// and the tensor T, by default `Pi((mu + u)/2)`. Jacobian: `1 - h d/du[T g] - h T dg/du`, g fixed in the
/// first derivative. Start: `mu + h f(mu)`.
///
/// Where something damps, `g + c G T g` takes the place of g, and where forces act, `F(m)` is added, both at `m = (mu + u)/2`: H changes
/// by `h <F(m), g> - h c <T g, G T g>` exactly. A metriplectic term `K grad S` has a form of its own, with which H stays and S never falls.
#[derive(Debug)]
pub struct DiscreteGradientStep<'a, S: Scalar, P: Poisson<S>, G, T = MidpointTensor> {
    system: &'a P,
    gradient: G,
    tensor: T,
    step: S,
    base: P::State,
    xi: P::State,
    field: P::State,
    poisson_matrix: P::Jacobian,
    derivative: P::Jacobian,
    beside: Acting<Beside<P::State, P::Jacobian>>,
    growth: Option<Growth<S, P>>,
}

impl<'a, S: Scalar, P: Poisson<S>, G: DiscreteGradient<S, P>> DiscreteGradientStep<'a, S, P, G> {
    /// The equation of a step of size h with the Poisson matrix at the midpoint.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_tensor(system, MidpointTensor, h)
    }
}

impl<'a, S, P, G, T> DiscreteGradientStep<'a, S, P, G, T>
where
    S: Scalar,
    P: Poisson<S>,
    G: DiscreteGradient<S, P>,
    T: PoissonTensor<S, P>,
{
    /// The equation of a step of size h with a tensor.
    pub fn with_tensor(system: &'a P, tensor: T, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            gradient: G::new(system),
            tensor,
            step: h,
            base: zero.clone(),
            xi: zero.clone(),
            field: zero,
            poisson_matrix: system.zero_jacobian(),
            derivative: system.zero_jacobian(),
            beside: Acting::of(system, || Beside::new(system)),
            growth: Growth::of(system),
        }
    }

    /// Sets a matrix to the derivative of `T xi` at a fixed direction xi.
    fn set_slope(&mut self, unknown: &P::State, matrix: &mut P::Jacobian) {
        let (system, xi) = (self.system, &self.xi);
        self.tensor
            .slope(system, &self.base, unknown, self.step, xi, matrix);
    }

    /// Sets the field `T g` with the discrete gradient already computed; leaves the direction of the motion in its place.
    fn set_field(&mut self, unknown: &P::State) {
        let matrix = &mut self.poisson_matrix;
        self.tensor
            .matrix(self.system, &self.base, unknown, self.step, matrix);
        multiply(matrix, &self.xi, &mut self.field);
        if let Some(beside) = self.beside.get_mut(self.system) {
            beside.set_middle(self.system, &self.base, unknown);
            if let Some(growth) = &mut self.growth {
                let motion = [&self.xi, &self.field];
                growth.replace(
                    self.system,
                    motion,
                    [&beside.middle, unknown],
                    &mut beside.force,
                );
            }
            beside.act(self.system, matrix, &mut self.xi, &mut self.field);
        }
    }

    /// The derivative of what is metriplectic, with the discrete gradient and its derivative already computed; uses the matrix.
    fn linearize_growth(&mut self, unknown: &P::State, matrix: &mut P::Jacobian) {
        let (Some(growth), Some(beside)) = (&mut self.growth, self.beside.get_mut(self.system))
        else {
            return;
        };
        let (system, base) = (self.system, &self.base);
        let tensor = &mut self.poisson_matrix;
        self.tensor.matrix(system, base, unknown, self.step, tensor);
        self.tensor
            .slope(system, base, unknown, self.step, &self.xi, matrix);
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let mut sum = matrix.get(row, column);
                for inner in 0..system.dimension() {
                    sum += tensor.get(row, inner) * self.derivative.get(inner, column);
                }
                matrix.set(row, column, sum);
            }
        }
        multiply(tensor, &self.xi, &mut self.field);
        beside.set_middle(system, base, unknown);
        let motion = [&self.xi, &self.field];
        let slopes = [&self.derivative, &*matrix];
        growth.linearize(system, motion, [&beside.middle, unknown], slopes);
    }

    /// `r = u - mu - h T g` with the discrete gradient already computed.
    fn write_residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_field(unknown);
        let (base, field) = (self.base.as_slice(), self.field.as_slice());
        for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
            *out = unknown.as_slice()[index] - base[index] - self.step * field[index];
        }
    }
}

impl<S, P, G, T> Equation<S> for DiscreteGradientStep<'_, S, P, G, T>
where
    S: Scalar,
    P: Poisson<S>,
    G: DiscreteGradient<S, P>,
    T: PoissonTensor<S, P>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.gradient.set_start(self.system, mu);
        if let Some(growth) = &mut self.growth {
            growth.set_start(self.system, mu);
        }
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.field);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step, &self.field);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.gradient.value(self.system, unknown, &mut self.xi);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let derivative = &mut self.derivative;
        self.gradient
            .linearize(self.system, unknown, &mut self.xi, derivative);
        self.linearize_growth(unknown, matrix);
        if self.system.is_damped() {
            self.set_slope(unknown, matrix);
        }
        self.write_residual(unknown, residual);
        if let Some(beside) = self.beside.get_mut(self.system) {
            beside.linearize(self.system, S::ratio(1.0, 2.0));
            if self.system.is_damped() {
                let (tensor, system) = (&self.poisson_matrix, self.system);
                beside.damp_columns(system, &mut self.derivative, |derivative, column, v| {
                    for (row, entry) in v.as_mut_slice().iter_mut().enumerate() {
                        *entry = matrix.get(row, column);
                        for inner in 0..system.dimension() {
                            *entry += tensor.get(row, inner) * derivative.get(inner, column);
                        }
                    }
                });
            }
        }
        self.set_slope(unknown, matrix);
        for row in 0..self.system.dimension() {
            for column in 0..self.system.dimension() {
                let mut sum = matrix.get(row, column);
                for inner in 0..self.system.dimension() {
                    let slope = self.derivative.get(inner, column);
                    sum += self.poisson_matrix.get(row, inner) * slope;
                }
                if let Some(beside) = self.beside.get(self.system) {
                    sum += beside.slope(row, column);
                }
                if let Some(growth) = &self.growth {
                    sum += growth.slope(row, column);
                }
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - self.step * sum);
            }
        }
    }

    fn resolved(&mut self, unknown: &P::State, _end: &P::State) -> S::Mask {
        self.gradient.resolved(self.system, unknown)
    }

    fn velocity(&mut self, unknown: &P::State, _stage: usize, xi: &mut P::State) -> usize {
        self.gradient.value(self.system, unknown, xi);
        if self.system.is_damped() {
            self.xi.copy_from(xi);
            self.set_field(unknown);
            xi.copy_from(&self.xi);
        }
        for entry in xi.as_mut_slice() {
            *entry *= self.step;
        }
        1
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        mu.copy_from(unknown);
        let beside = self.beside.get(self.system);
        if let (Some(_), Some(Clock { momentum, .. })) = (beside, self.system.clock()) {
            // no residual depends on it, and no test of convergence
            self.gradient.value(self.system, unknown, &mut self.xi);
            self.set_field(unknown);
            let moved = self.step * self.field.as_slice()[momentum];
            mu.as_mut_slice()[momentum] = self.base.as_slice()[momentum] + moved;
        }
    }
}
