//! The equation of Gauss collocation in canonical coordinates.

use super::tableau::{gauss_ratio, gauss_weight};
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::scalar::{Mask, Scalar};
use crate::state::{Stages, State, copies};
use crate::structure::CanonicalPoisson;

/// Gauss collocation with one stage less than `STAGES` in coordinates w in which the Poisson matrix is constant.
///
/// Unknown: the states `Y_i` of the stages, and behind them that of the end. Equation:
/// `r_i = w'(Y_i)^-1 (w(Y_i) - w(mu) - h sum_j a_ij g(Y_j))` with the tableau (a, b, c), the step size h and the field `g = w' f`; of the end
/// the weights b are in the place of a row of a. New state: the last of them. Jacobian:
/// `dr_i/dY_j = delta_ij - h a_ij w'(Y_i)^-1 g'(Y_j)`, without what vanishes along with r. Start: `Y_i = mu + c_i h f(mu)`.
#[derive(Debug)]
pub struct CanonicalGauss<'a, S: Scalar, P: CanonicalPoisson<S>, const STAGES: usize> {
    system: &'a P,
    /// `h a_ij`, behind the rows of the stages `h b_j`.
    weights: [[S; STAGES]; STAGES],
    base: P::State,
    /// `w(mu)`
    start: P::State,
    fields: [P::State; STAGES],
    change: P::State,
    pulled: P::State,
    jacobian: P::Jacobian,
}

impl<'a, S: Scalar, P: CanonicalPoisson<S>, const STAGES: usize> CanonicalGauss<'a, S, P, STAGES> {
    /// The stages of the method, without the end.
    const INNER: usize = STAGES - 1;

    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        const { assert!(STAGES > 1, "a stage and the end") };
        let zero = system.zero_state();
        let weight = |i: usize, j: usize| {
            if j == Self::INNER {
                return S::zero();
            }
            let weight = h * gauss_weight(Self::INNER, j);
            match i == Self::INNER {
                true => weight,
                false => weight * gauss_ratio(Self::INNER, i, j),
            }
        };
        Self {
            system,
            weights: core::array::from_fn(|i| core::array::from_fn(|j| weight(i, j))),
            base: zero.clone(),
            start: zero.clone(),
            fields: copies(&zero),
            change: zero.clone(),
            pulled: zero,
            jacobian: system.zero_jacobian(),
        }
    }

    /// `r_i` at a stage, with the fields already computed.
    fn write_residual(&mut self, stage: usize, state: &P::State, residual: &mut P::State) {
        self.system.canonical(state, &mut self.change);
        self.change.axpy(-S::one(), &self.start);
        for (&weight, field) in self.weights[stage].iter().zip(&self.fields[..Self::INNER]) {
            self.change.axpy(-weight, field);
        }
        self.system.canonical_pull(state, &self.change, residual);
    }

    fn set_fields(&mut self, unknown: &Stages<P::State, STAGES>) {
        for (state, field) in unknown.0.iter().zip(&mut self.fields[..Self::INNER]) {
            self.system.canonical_field(state, field);
        }
    }

    /// The block of a stage and of another one, whose Jacobian stands ready.
    fn write_block(&mut self, weight: S, state: &P::State, block: &mut P::Jacobian) {
        for column in 0..self.system.dimension() {
            for (row, entry) in self.change.as_mut_slice().iter_mut().enumerate() {
                *entry = -(weight * self.jacobian.get(row, column));
            }
            let (change, pulled) = (&self.change, &mut self.pulled);
            self.system.canonical_pull(state, change, pulled);
            for (row, &entry) in self.pulled.as_slice().iter().enumerate() {
                block.set(row, column, entry);
            }
        }
    }
}

impl<S: Scalar, P: CanonicalPoisson<S>, const STAGES: usize> Equation<S>
    for CanonicalGauss<'_, S, P, STAGES>
{
    crate::generic::unknown_of_stages!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.system.canonical(mu, &mut self.start);
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        self.system.vector_field(&self.base, &mut self.change);
        for (stage, state) in unknown.0.iter_mut().enumerate() {
            // the node of a stage is the sum of its row
            let row = self.weights[stage].iter();
            let length = row.fold(S::zero(), |sum, &weight| sum + weight);
            state.copy_from(&self.base);
            state.axpy(length, &self.change);
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        self.set_fields(unknown);
        for (stage, state) in unknown.0.iter().enumerate() {
            self.write_residual(stage, state, &mut residual.0[stage]);
        }
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        self.residual(unknown, residual);
        for (other, there) in unknown.0.iter().enumerate() {
            if other < Self::INNER {
                let jacobian = &mut self.jacobian;
                self.system.canonical_jacobian(there, jacobian);
            }
            for (stage, state) in unknown.0.iter().enumerate() {
                let block = &mut matrix.0[stage][other];
                let weight = self.weights[stage][other];
                self.write_block(weight, state, block);
                if stage == other {
                    for k in 0..self.system.dimension() {
                        block.set(k, k, S::one() + block.get(k, k));
                    }
                }
            }
        }
    }

    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        let mut within = S::Mask::splat(true);
        for state in &unknown.0 {
            let side = &mut self.change;
            self.system.canonical_sides(&self.base, state, side);
            for &side in side.as_slice() {
                within = within & S::zero().less(side);
            }
        }
        within
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        mu.copy_from(&unknown.0[Self::INNER]);
    }
}
