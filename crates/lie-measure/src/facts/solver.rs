//! Whether the iteration behind implicit steps solves equations whose solution is known.
//!
//! Steps of sound methods hide much of it: a wrong update is mended by the next, pivots are large enough, iterations
//! end long before their limit. Here all of that is asked for by itself.

use lie_runtime::equation::Equation;
use lie_runtime::newton::{FailureReason, Iteration, Newton, NewtonOptions, NewtonReport};
use lie_runtime::state::Unknown;
use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 4>;
type Matrix = SMatrix<f64, 4, 4>;

/// What is solved for.
const SOLUTION: [f64; 4] = [0.7, -0.4, 0.9, 0.3];
/// Errors in units of epsilon. The matrices are well conditioned; an iteration of fixed point that halves its
/// updates at most ends where they are some hundred units.
const EXACT: f64 = 64.0;
const LINEAR: f64 = 4096.0;

/// `r(u) = A (u - s) + b (u o u - s o s)` with the solution s, products `o` entry by entry.
struct Known {
    matrix: Matrix,
    bend: f64,
}

impl Equation<f64> for Known {
    type State = Vector;
    type Unknown = Vector;
    type Matrix = Matrix;

    fn zero_unknown(&self) -> Vector {
        Vector::zeros()
    }
    fn zero_matrix(&self) -> Matrix {
        Matrix::zeros()
    }
    fn set_base(&mut self, _mu: &Vector) {}
    fn initial_guess(&mut self, unknown: &mut Vector) {
        unknown.fill(0.0);
    }
    fn residual(&mut self, unknown: &Vector, residual: &mut Vector) {
        let gap = unknown - Vector::from(SOLUTION);
        let sum = unknown + Vector::from(SOLUTION);
        *residual = self.matrix * gap + gap.component_mul(&sum) * self.bend;
    }
    fn linearize(&mut self, unknown: &Vector, residual: &mut Vector, matrix: &mut Matrix) {
        self.residual(unknown, residual);
        *matrix = self.matrix + Matrix::from_diagonal(unknown) * (2.0 * self.bend);
    }
    fn result(&mut self, unknown: &Vector, mu: &mut Vector) {
        *mu = *unknown;
    }
}

/// A matrix near `diagonal`, without symmetry.
fn near(diagonal: f64) -> Matrix {
    Matrix::from_fn(|i, j| {
        let one = if i == j { diagonal } else { 0.0 };
        one + 0.05 * (1.3 + 2.9 * i as f64 + 4.7 * j as f64).sin()
    })
}

/// The work of a solution, and its error.
fn solved(equation: &mut Known, options: &NewtonOptions) -> Option<(NewtonReport, f64)> {
    let mut unknown = Vector::zeros();
    let report = Newton::new(equation, options).solve(equation, &mut unknown, 1.0);
    let error = (unknown - Vector::from(SOLUTION)).max_norm();
    report.ok().map(|report| (report, error))
}

/// A linear equation.
fn straight() -> Known {
    Known {
        matrix: near(1.0),
        bend: 0.0,
    }
}

/// The diagonal is zero: no order that is fixed beforehand has pivots there.
fn without_diagonal() -> Known {
    let mut matrix = near(1.0);
    for row in 0..4 {
        matrix[(row, row)] = 0.0;
    }
    matrix[(0, 1)] = 1.0;
    matrix[(1, 2)] = -1.2;
    matrix[(2, 3)] = 0.9;
    matrix[(3, 0)] = 1.1;
    Known { matrix, bend: 0.0 }
}

/// Of a linear equation the first update is the solution, the second is round-off.
fn in_two(mut equation: Known, options: &NewtonOptions, pivoted: bool) -> bool {
    solved(&mut equation, options).is_some_and(|(report, error)| {
        let newton = options.iteration == Iteration::Newton;
        let factored = if newton { 2 } else { 1 };
        report.iterations == 2
            && (report.pivoted != 0) == pivoted
            && (pivoted || report.factorizations == factored)
            && error <= EXACT * f64::EPSILON
    })
}

/// Of one that is not linear, after so many iterations at most.
fn bent(options: &NewtonOptions, most: u32) -> bool {
    let mut equation = straight();
    equation.bend = 0.2;
    solved(&mut equation, options)
        .is_some_and(|(report, error)| report.iterations <= most && error <= EXACT * f64::EPSILON)
}

/// With updates that shrink slowly, and as fast as in a step.
fn by_fixed_point() -> bool {
    [0.35, 0.9].into_iter().all(|diagonal| {
        let mut equation = Known {
            matrix: near(diagonal),
            bend: 0.0,
        };
        solved(&mut equation, &NewtonOptions::fixed_point())
            .is_some_and(|(_, error)| error <= LINEAR * f64::EPSILON)
    })
}

/// Whether the iteration ends where it is told to, and says so.
fn limited() -> bool {
    [0, 1].into_iter().all(|max_iterations| {
        let mut equation = straight();
        let options = NewtonOptions {
            max_iterations,
            ..NewtonOptions::newton()
        };
        let mut unknown = Vector::zeros();
        let outcome = Newton::new(&equation, &options).solve(&mut equation, &mut unknown, 1.0);
        outcome.is_err_and(|failure| {
            failure.reason == FailureReason::NotConverged
                && failure.lanes == 1
                && failure.report.iterations == max_iterations
        })
    })
}

/// What of the iteration does not do what it is for.
pub(super) fn unsound() -> Vec<&'static str> {
    let (newton, simplified) = (NewtonOptions::newton(), NewtonOptions::simplified());
    let exchanging = |options| in_two(without_diagonal(), options, true);
    let sound = [
        (
            "Newton's iteration",
            in_two(straight(), &newton, false) && bent(&newton, 6),
        ),
        (
            "simplified iteration",
            in_two(straight(), &simplified, false) && bent(&simplified, 60),
        ),
        ("fixed-point iteration", by_fixed_point()),
        (
            "elimination with row exchanges",
            exchanging(&newton) && exchanging(&simplified),
        ),
        ("limit of iterations", limited()),
    ];
    let unsound = sound.into_iter().filter(|(_, sound)| !sound);
    unsound.map(|(what, _)| what).collect()
}
