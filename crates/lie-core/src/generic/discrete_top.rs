//! The equation of Moser and Veselov's discrete rigid body on SO(3), by unit quaternions.

use super::rotation::rotation_vector;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::SpinPoisson;

/// The discrete rigid body on so(3)*, `[e_1, e_2] = c e_3` and cyclic, for `H = <mu, A mu>/2` with any symmetric A, the inverse of the inertia I
/// where there is one.
///
/// The rotation of the step has the unit quaternion `(q0, v)`, `q0 = sqrt(1 - v.v)`. Unknown: `u = 2 I v/(c h)`, so
/// that `v = (c h/2) grad H(u)`. Equation: `r(u) = q0 u + v x u - mu = q0 u - (h/2) f(u) - mu`. New state:
/// `q0 u - v x u = mu + h f(u)`. Jacobian: `q0 - u (v^T V)/q0 - (h/2) Df(u)`, `V = (c h/2) H''`. Start: `u = mu`.
///
/// The solutions form a branch that starts at the identity and ends where the Jacobian is singular; its
/// determinant is positive on it. Where it is not at the solution that was found, or where there is no
/// `q0 > 0`, the new state is not a number.
#[derive(Debug)]
pub struct DiscreteTop<'a, S: Scalar, P: SpinPoisson<S>> {
    system: &'a P,
    step: S,
    /// `c h/2`
    half: S,
    base: P::State,
    direction: P::State,
    field: P::State,
    hessian: P::Jacobian,
    jacobian: P::Jacobian,
    spare: P::State,
}

impl<'a, S: Scalar, P: SpinPoisson<S>> DiscreteTop<'a, S, P> {
    /// The equation of a step of size h; the system has one spin.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            step: h,
            half: h * system.scale(0) * S::ratio(1.0, 2.0),
            base: zero.clone(),
            direction: zero.clone(),
            field: zero.clone(),
            hessian: system.zero_jacobian(),
            jacobian: system.zero_jacobian(),
            spare: zero,
        }
    }

    /// Sets the direction to v and returns `q0`, not a number where there is none.
    fn set_direction(&mut self, unknown: &P::State) -> S {
        self.system.gradient(unknown, &mut self.direction);
        let mut square = S::zero();
        for entry in self.direction.as_mut_slice() {
            *entry = (self.half * *entry).quantity();
            square += *entry * *entry;
        }
        (S::one() - square).sqrt().quantity()
    }

    fn write_residual(&self, real: S, unknown: &P::State, residual: &mut P::State) {
        let half = self.step * S::ratio(1.0, 2.0);
        for (row, out) in residual.as_mut_slice().iter_mut().enumerate() {
            let moved = half * self.field.as_slice()[row];
            *out = real * unknown.as_slice()[row] - moved - self.base.as_slice()[row];
        }
    }
}

impl<S: Scalar, P: SpinPoisson<S>> Equation<S> for DiscreteTop<'_, S, P> {
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.field);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.field);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let real = self.set_direction(unknown);
        self.system.vector_field(unknown, &mut self.field);
        self.write_residual(real, unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let real = self.set_direction(unknown);
        self.system
            .linearize(unknown, &mut self.field, &mut self.jacobian);
        self.system.hessian(unknown, &mut self.hessian);
        self.write_residual(real, unknown, residual);
        let half = self.step * S::ratio(1.0, 2.0);
        let inverse = (S::one() / real).quantity();
        for column in 0..self.system.dimension() {
            let mut along = S::zero();
            for (row, &v) in self.direction.as_slice().iter().enumerate() {
                along += v * (self.half * self.hessian.get(row, column));
            }
            let slope = (along * inverse).quantity();
            for (row, &u) in unknown.as_slice().iter().enumerate() {
                let identity = if row == column { real } else { S::zero() };
                let entry = identity - u * slope - half * self.jacobian.get(row, column);
                matrix.set(row, column, entry);
            }
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        let real = self.set_direction(unknown);
        let axis = core::array::from_fn(|k| self.direction.as_slice()[k]);
        for (out, entry) in xi
            .as_mut_slice()
            .iter_mut()
            .zip(rotation_vector(real, axis))
        {
            *out = entry / self.system.scale(0);
        }
        Some(Retraction::Exp)
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        let mut matrix = self.system.zero_jacobian();
        let mut residual = self.spare.clone();
        self.linearize(unknown, &mut residual, &mut matrix);
        let poison = off_the_branch(&matrix);
        mu.copy_from(&self.base);
        mu.axpy(self.step, &self.field);
        for entry in mu.as_mut_slice() {
            *entry += poison;
        }
    }
}

/// 0 where the determinant of a 3 x 3 matrix is positive, and not a number elsewhere.
pub fn off_the_branch<S: Scalar, M: SquareMatrix<S>>(matrix: &M) -> S {
    let minor = |a: usize, b: usize| {
        matrix.get(1, a) * matrix.get(2, b) - matrix.get(1, b) * matrix.get(2, a)
    };
    let determinant = matrix.get(0, 0) * minor(1, 2) - matrix.get(0, 1) * minor(0, 2)
        + matrix.get(0, 2) * minor(0, 1);
    S::select(
        S::zero().less(determinant),
        S::zero(),
        S::from_f64(f64::NAN),
    )
}
