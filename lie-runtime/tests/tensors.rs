//! A Poisson tensor of the user's own, which raises the order of a discrete gradient method.
//!
//! Of a constant Poisson matrix J the mean-value method has the modified equation
//! `x' = f + h^2 f'f'f/12 + O(h^4)`, and with `f' = J H''` the tensor `J - h^2 J H'' J H'' J/12`, at the
//! midpoint, removes that term: order 4, and the tensor is antisymmetric.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, reference};
use lie_runtime::methods::{
    Compose6, Facts, MeanTensor, MeanValue, Method, MidpointTensor, PoissonTensor, Stepper,
    TensorFacts, WithTensor,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use nalgebra::{SMatrix, SVector};

/// The pendulum `H = p^2/2 - cos q` with `{q, p} = 1`.
#[derive(Clone, Debug)]
struct Pendulum;

impl<S: Scalar> Poisson<S> for Pendulum {
    type State = SVector<S, 2>;
    type Jacobian = SMatrix<S, 2, 2>;
    fn dimension(&self) -> usize {
        2
    }
    fn name(&self) -> &str {
        "Pendulum"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["q", "p"][index]
    }
    fn poisson_degree(&self) -> Option<u32> {
        Some(0)
    }

    fn zero_state(&self) -> Self::State {
        Self::State::repeat(S::zero())
    }
    fn zero_jacobian(&self) -> Self::Jacobian {
        Self::Jacobian::repeat(S::zero())
    }
    fn hamiltonian(&self, x: &Self::State) -> S {
        S::ratio(1.0, 2.0) * x[1] * x[1] - x[0].cos()
    }
    fn gradient(&self, x: &Self::State, out: &mut Self::State) {
        *out = [x[0].sin(), x[1]].into();
    }
    fn hessian(&self, x: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(x[0].cos(), S::zero(), S::zero(), S::one());
    }
    fn poisson_matrix(&self, _x: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(S::zero(), S::one(), -S::one(), S::zero());
    }
    fn jacobian(&self, x: &Self::State, out: &mut Self::Jacobian) {
        lie_runtime::generic::jacobian(self, x, out);
    }
    fn casimirs(&self, _x: &Self::State, _out: &mut [S]) {}
    fn casimir_gradient(&self, _index: usize, _x: &Self::State, _out: &mut Self::State) {}
}

lie_runtime::generic_equations!([S: Scalar] Pendulum, S: mean_value);

/// `J H'' J H'' J = -cos(q) J`, so that the tensor is `(1 + h^2 cos(q)/12) J` at the midpoint.
#[derive(Clone, Copy, Debug)]
struct Corrected;

impl TensorFacts for Corrected {
    const ORDER: u32 = 4;
    // there are no Casimirs to lose
    const QUADRATIC_CASIMIRS: bool = true;
}

type State2<S> = SVector<S, 2>;

fn middle<S: Scalar>(x: &State2<S>, y: &State2<S>) -> S {
    S::ratio(1.0, 2.0) * (x[0] + y[0])
}

impl<S: Scalar> PoissonTensor<S, Pendulum> for Corrected {
    fn matrix(
        &self,
        system: &Pendulum,
        start: &State2<S>,
        end: &State2<S>,
        h: S,
        out: &mut SMatrix<S, 2, 2>,
    ) {
        system.poisson_matrix(start, out);
        let factor = S::one() + h * h * middle(start, end).cos() * S::ratio(1.0, 12.0);
        for entry in out.iter_mut() {
            *entry *= factor;
        }
    }

    fn slope(
        &self,
        system: &Pendulum,
        start: &State2<S>,
        end: &State2<S>,
        h: S,
        xi: &State2<S>,
        out: &mut SMatrix<S, 2, 2>,
    ) {
        let mut image = system.zero_state();
        lie_runtime::generic::ad_star(system, xi, start, &mut image);
        let slope = -(h * h * middle(start, end).sin() * S::ratio(1.0, 24.0));
        out.fill(S::zero());
        for row in 0..2 {
            out[(row, 0)] = slope * image[row];
        }
    }
}

const START: [f64; 2] = [0.4, 1.1];

fn slope(method: &impl Method<f64, Pendulum>) -> f64 {
    let exact = reference(&Pendulum, &START.into(), 2.0)
        .expect("a solution")
        .mu;
    let points: Vec<(f64, f64)> = [10, 14, 20, 28, 40, 56, 80]
        .into_iter()
        .map(|steps| {
            let h = 2.0 / f64::from(steps);
            let mut mu = START.into();
            systems::steps(&Pendulum, method, h, steps, &mut mu).expect("the steps converge");
            (h, systems::distance(&mu, &exact))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}

#[test]
fn a_correction_of_order_h2_raises_the_order() {
    fn check<M: Facts + Method<f64, Pendulum>>(method: M, order: u32) {
        assert_eq!(M::ORDER, order);
        let slope = slope(&method);
        assert!((slope - f64::from(order)).abs() < 0.1, "{order}: {slope}");
    }
    check(MeanValue, 2);
    check(WithTensor::new(MeanValue, MidpointTensor), 2);
    check(WithTensor::new(MeanValue, MeanTensor), 2);
    check(WithTensor::new(MeanValue, Corrected), 4);
    check(Compose6::new(WithTensor::new(MeanValue, MeanTensor)), 6);
}

#[test]
fn the_energy_is_kept_with_any_tensor() {
    let energy = |mu: &State2<f64>| Pendulum.hamiltonian(mu);
    let newton = NewtonOptions::default();
    let mut stepper = WithTensor::new(MeanValue, Corrected).stepper(&Pendulum, 0.2, &newton);
    let mut mu: State2<f64> = START.into();
    let before = energy(&mu);
    let mut iterations = 0;
    for _ in 0..500 {
        let report = stepper.step(&mut mu, &mut ()).expect("the step converges");
        iterations += report.iterations;
        assert!((energy(&mu) - before).abs() < 2e-14);
    }
    // the slope of the tensor is right: Newton's iteration stays quadratic
    assert!(iterations <= 4 * 500, "{iterations}");
    let mut backwards = WithTensor::new(MeanValue, Corrected).stepper(&Pendulum, -0.2, &newton);
    for _ in 0..500 {
        backwards
            .step(&mut mu, &mut ())
            .expect("the step converges");
    }
    assert!(systems::distance(&mu, &State2::from(START)) < 1e-11, "{mu}");
}

/// Where the Poisson matrix is affine the two tensors give the same steps.
#[test]
fn affine_poisson_matrices_have_one_tensor() {
    let system = systems::rigid_body::RigidBody::default();
    for h in [0.1, -0.3] {
        let mut at_middle: SVector<f64, 3> = [0.6, -0.5, 0.7].into();
        let mut of_ends = at_middle;
        let method = WithTensor::new(MeanValue, MeanTensor);
        systems::steps(&system, &MeanValue, h, 10, &mut at_middle).expect("steps");
        systems::steps(&system, &method, h, 10, &mut of_ends).expect("steps");
        assert!(systems::distance(&at_middle, &of_ends) < 1e-14);
    }
}
