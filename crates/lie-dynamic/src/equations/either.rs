//! One of two equations, where the plan decides.

use lie_runtime::methods::Retraction;
use lie_runtime::{Equation, Scalar};

/// Either of two equations in the same unknown.
pub enum Either<A, B> {
    /// The first.
    First(A),
    /// The second.
    Second(B),
}

macro_rules! either {
    ($either:expr, $equation:ident => $value:expr) => {
        match $either {
            Either::First($equation) => $value,
            Either::Second($equation) => $value,
        }
    };
}

impl<S, A, B> Equation<S> for Either<A, B>
where
    S: Scalar,
    A: Equation<S>,
    B: Equation<S, State = A::State, Unknown = A::Unknown, Matrix = A::Matrix>,
{
    type State = A::State;
    type Unknown = A::Unknown;
    type Matrix = A::Matrix;

    fn zero_unknown(&self) -> Self::Unknown {
        either!(self, equation => equation.zero_unknown())
    }
    fn zero_matrix(&self) -> Self::Matrix {
        either!(self, equation => equation.zero_matrix())
    }
    fn set_base(&mut self, mu: &Self::State) {
        either!(self, equation => equation.set_base(mu));
    }
    fn scale(&self, mu: &Self::State) -> S {
        either!(self, equation => equation.scale(mu))
    }
    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        either!(self, equation => equation.initial_guess(unknown));
    }
    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        either!(self, equation => equation.residual(unknown, residual));
    }
    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        either!(self, equation => equation.linearize(unknown, residual, matrix));
    }
    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        either!(self, equation => equation.factor(matrix))
    }
    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        either!(self, equation => equation.solve(factors, residual));
    }
    fn jacobian_cost(&self) -> f64 {
        either!(self, equation => equation.jacobian_cost())
    }
    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State) {
        either!(self, equation => equation.result(unknown, mu));
    }
    fn resolved(&mut self, unknown: &Self::Unknown, end: &Self::State) -> S::Mask {
        either!(self, equation => equation.resolved(unknown, end))
    }
    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        either!(self, equation => equation.within_chart(unknown))
    }
    fn group_factor(
        &mut self,
        unknown: &Self::Unknown,
        xi: &mut Self::State,
    ) -> Option<Retraction> {
        either!(self, equation => equation.group_factor(unknown, xi))
    }
    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut Self::State) -> usize {
        either!(self, equation => equation.velocity(unknown, stage, xi))
    }
}
