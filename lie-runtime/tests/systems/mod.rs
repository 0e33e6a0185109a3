//! Systems written by hand, and what tests do with them.
#![allow(dead_code, reason = "each test file uses a part")]

/// The number of steps of a long run: a few day by day, where the build is not optimised, and many in the nightly one, which is.
pub const fn daily(few: u32, many: u32) -> u32 {
    if cfg!(debug_assertions) { few } else { many }
}

/// Runs on a stack that has room for eight lanes of nested solvers without optimisation.
pub fn deep(run: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(1 << 25).spawn(run);
    let ended = thread.expect("a thread").join();
    ended.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
}

/// What a system says of itself: its scalar, its name, and those of its coordinates and Casimirs.
macro_rules! facts {
    ($scalar:ty, $name:literal, $coordinates:expr, $casimirs:expr) => {
        fn dimension(&self) -> usize {
            $coordinates.len()
        }
        fn name(&self) -> &str {
            $name
        }
        fn coordinate(&self, index: usize) -> &str {
            $coordinates[index]
        }
        fn casimir_count(&self) -> usize {
            let names: &[&str] = &$casimirs;
            names.len()
        }
        fn casimir_name(&self, index: usize) -> &str {
            let names: &[&str] = &$casimirs;
            names[index]
        }
        fn zero_state(&self) -> Self::State {
            let zero = <$scalar as lie_runtime::Scalar>::zero();
            Self::State::from_array_storage(nalgebra::ArrayStorage([[zero; _]; _]))
        }
        fn zero_jacobian(&self) -> Self::Jacobian {
            let zero = <$scalar as lie_runtime::Scalar>::zero();
            Self::Jacobian::from_array_storage(nalgebra::ArrayStorage([[zero; _]; _]))
        }
    };
}

/// What `Poisson` asks of so(3)* beside H, with the Casimir `x^2 + y^2 + z^2`.
macro_rules! so3_poisson {
    ($scalar:ty) => {
        fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            *out = super::rigid_body::hat(mu.as_slice());
        }
        fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            lie_runtime::generic::jacobian(self, mu, out);
        }
        fn casimirs(&self, mu: &Self::State, out: &mut [$scalar]) {
            out[0] = super::rigid_body::dot(mu.as_slice(), mu.as_slice());
        }
        fn casimir_gradient(&self, _index: usize, mu: &Self::State, out: &mut Self::State) {
            *out = mu + mu;
        }
    };
}

/// What `LiePoisson` asks of so(3).
macro_rules! so3_algebra {
    ($scalar:ty) => {
        fn ad(&self, xi: &Self::State, eta: &Self::State, out: &mut Self::State) {
            *out = super::rigid_body::cross::<$scalar>(xi.as_slice(), eta.as_slice()).into();
        }
        fn ad_star(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
            *out = super::rigid_body::cross::<$scalar>(mu.as_slice(), xi.as_slice()).into();
        }
        fn ad_star_matrix(&self, xi: &Self::State, out: &mut Self::Jacobian) {
            lie_runtime::generic::ad_star_matrix(self, xi, out);
        }
    };
}

/// The method of `CayleyPoisson` on so(3).
macro_rules! so3_cayley {
    ($scalar:ty) => {
        fn triple(
            &self,
            x: &nalgebra::SVector<$scalar, 3>,
            z: &nalgebra::SVector<$scalar, 3>,
            mu: &nalgebra::SVector<$scalar, 3>,
            out: &mut nalgebra::SVector<$scalar, 3>,
        ) {
            let triple = super::rigid_body::so3_triple(x.as_slice(), z.as_slice(), mu.as_slice());
            *out = triple.into();
        }
    };
}

/// The methods of `MatrixPoisson` on so(3).
macro_rules! so3_matrices {
    ($scalar:ty) => {
        type Matrix = nalgebra::SMatrix<$scalar, 3, 3>;
        fn representation(&self) -> lie_runtime::structure::Representation<'_> {
            super::rigid_body::SO3
        }
        fn zero_matrix(&self) -> Self::Matrix {
            nalgebra::SMatrix::<$scalar, 3, 3>::repeat(<$scalar as lie_runtime::Scalar>::zero())
        }
    };
}

/// What `CotangentPoisson` asks of a system with so many momenta.
macro_rules! momenta {
    ($scalar:ty, $count:literal) => {
        type Momentum = nalgebra::SVector<$scalar, $count>;
        type MomentumMatrix = nalgebra::SMatrix<$scalar, $count, $count>;
        fn momenta(&self) -> usize {
            $count
        }
        fn zero_momentum(&self) -> Self::Momentum {
            Self::Momentum::repeat(<$scalar as lie_runtime::Scalar>::zero())
        }
        fn zero_momentum_matrix(&self) -> Self::MomentumMatrix {
            Self::MomentumMatrix::repeat(<$scalar as lie_runtime::Scalar>::zero())
        }
    };
}

pub mod affine_line;
pub mod body4;
pub mod damped_body;
pub mod driven_body;
pub mod driven_top;
pub mod folded;
pub mod forced_top;
pub mod heavy_top;
pub mod logarithmic;
pub mod nonpolynomial;
pub mod quartic;
pub mod quartic_lagrangian;
pub mod rigid_body;
pub mod saddle;

use lie_runtime::methods::{Method, StepFailure, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Equation, Implicit, Poisson, Scalar, SquareMatrix, State, Unknown};

/// A state from f64 coordinates.
pub fn state<S: Scalar, P: Poisson<S>>(system: &P, coordinates: &[f64]) -> P::State {
    let mut state = system.zero_state();
    for (entry, &coordinate) in state.as_mut_slice().iter_mut().zip(coordinates) {
        *entry = S::from_f64(coordinate);
    }
    state
}

/// Some steps of a method with default options.
pub fn steps<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    h: f64,
    count: u32,
    mu: &mut P::State,
) -> Result<(), StepFailure> {
    let mut stepper = method.stepper(system, S::from_f64(h), &NewtonOptions::default());
    for _ in 0..count {
        stepper.step(mu, &mut ())?;
    }
    Ok(())
}

/// The largest distance of two states.
pub fn distance<S: Scalar>(a: &impl State<S>, b: &impl State<S>) -> f64 {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs
        .map(|(&a, &b)| (a - b).abs().to_f64())
        .fold(0.0, f64::max)
}

/// Checks the Jacobian of a step's equation, where its iteration begins, against differences of the residual. How far it is from the identity.
#[track_caller]
pub fn jacobian_against_differences<P: Implicit<f64, M>, M>(
    system: &P,
    method: &M,
    h: f64,
    start: &[f64],
) -> f64 {
    let mut equation = system.equation(method, h);
    equation.set_base(&state(system, start));
    let mut unknown = equation.zero_unknown();
    equation.initial_guess(&mut unknown);
    let (mut residual, mut matrix) = (unknown.clone(), equation.zero_matrix());
    equation.linearize(&unknown, &mut residual, &mut matrix);
    let mut largest = 0.0_f64;
    for column in 0..unknown.len() {
        let sides = [1e-5, -1e-5].map(|shift| {
            let (mut moved, mut out) = (unknown.clone(), residual.clone());
            moved.set_entry(column, unknown.entry(column) + shift);
            equation.residual(&moved, &mut out);
            out
        });
        for row in 0..unknown.len() {
            let slope = (sides[0].entry(row) - sides[1].entry(row)) / 2e-5;
            let entry = matrix.get(row, column);
            assert!(
                (slope - entry).abs() < 1e-8,
                "({row}, {column}): {slope} {entry}"
            );
            largest = largest.max((entry - f64::from(u8::from(row == column))).abs());
        }
    }
    largest
}
