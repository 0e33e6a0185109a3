//! The path of a step, `exp(theta(t/h))` with a polynomial theta, and the derivatives of its action.

use super::body_velocity::BodyVelocity;
use crate::generic::series::{Scratch, dexp_dual_in};
use crate::generic::tableau::gauss_tableau;
use crate::lagrangian::LagrangianPoisson;
use crate::scalar::Scalar;
use crate::state::{Stages, State, copies};

/// The path of a step over some scalar.
pub(super) struct Path<S, V, const STAGES: usize> {
    step: S,
    /// `theta_i = sum_j points_ij Theta_j`.
    points: [[S; STAGES]; STAGES],
    /// `h theta_i' = sum_j slopes_ij Theta_j`.
    pub(super) slopes: [[S; STAGES]; STAGES],
    pub(super) weights: [S; STAGES],
    body: BodyVelocity<S, V>,
    pub(super) scratch: Scratch<V>,
    columns: [V; 2],
}

impl<S: Scalar, V: State<S>, const STAGES: usize> Path<S, V, STAGES> {
    pub(super) fn new(zero: &V, h: S) -> Self {
        let tableau = gauss_tableau::<S, STAGES>();
        let nodes = tableau.c;
        let basis = |f: fn(S, usize, usize) -> S| -> [[S; STAGES]; STAGES] {
            core::array::from_fn(|i| core::array::from_fn(|j| f(nodes[i], j + 1, STAGES)))
        };
        Self {
            step: h,
            points: basis(lagrange),
            slopes: basis(lagrange_slope),
            weights: tableau.b,
            body: BodyVelocity::new(zero),
            scratch: Scratch::new(zero),
            columns: copies(zero),
        }
    }

    /// `r_j = p_j`, and in the last place `p_s - phi1(ad*_(Theta_s)) mu`.
    pub(super) fn defect<P>(
        &mut self,
        system: &P,
        controls: &Stages<V, STAGES>,
        mu: &V,
        out: &mut Stages<V, STAGES>,
    ) where
        P: LagrangianPoisson<S, State = V>,
    {
        for part in &mut out.0 {
            part.fill(S::zero());
        }
        for node in 0..STAGES {
            self.add_node(system, node, controls, out);
        }
        let [sum, ..] = &mut self.columns;
        let end = &controls.0[STAGES - 1];
        if system.has_closed_exponential() {
            system.dexp_dual(end, mu, sum);
        } else {
            dexp_dual_in(system, end, mu, sum, &mut self.scratch, |_, _| ());
        }
        out.0[STAGES - 1].axpy(-S::one(), sum);
    }

    /// Adds what one node contributes to every `p_j`: with `m = l'(xi)` and q the derivative by theta of
    /// `<m, dexp_(-theta) theta'>`, it is `b (D_j (dexp_(-theta))* m + h P_j q)`.
    fn add_node<P>(
        &mut self,
        system: &P,
        node: usize,
        controls: &Stages<V, STAGES>,
        out: &mut Stages<V, STAGES>,
    ) where
        P: LagrangianPoisson<S, State = V>,
    {
        let [theta, other] = &mut self.columns;
        theta.fill(S::zero());
        other.fill(S::zero());
        for (j, control) in controls.0.iter().enumerate() {
            theta.axpy(self.points[node][j], control);
            other.axpy(self.slopes[node][j] / self.step, control);
        }
        self.body.set(system, theta, other);
        system.momentum(&self.body.xi, other);
        self.body.pull(system, theta, other);
        let weight = self.weights[node];
        for (j, part) in out.0.iter_mut().enumerate() {
            part.axpy(weight * self.slopes[node][j], &self.body.adjoint);
            part.axpy(weight * self.step * self.points[node][j], &self.body.slope);
        }
    }
}

/// The polynomial of degree s that is 1 at `j/s` and 0 at the other multiples of `1/s` in [0, 1].
fn lagrange<S: Scalar>(t: S, j: usize, s: usize) -> S {
    let mut product = S::one();
    for k in (0..=s).filter(|&k| k != j) {
        product *= (S::from_f64(s as f64) * t - S::from_f64(k as f64))
            * S::ratio(1.0, j as f64 - k as f64);
    }
    product
}

/// Its derivative.
fn lagrange_slope<S: Scalar>(t: S, j: usize, s: usize) -> S {
    let mut sum = S::zero();
    for left_out in (0..=s).filter(|&k| k != j) {
        let mut product = S::ratio(s as f64, j as f64 - left_out as f64);
        for k in (0..=s).filter(|&k| k != j && k != left_out) {
            product *= (S::from_f64(s as f64) * t - S::from_f64(k as f64))
                * S::ratio(1.0, j as f64 - k as f64);
        }
        sum += product;
    }
    sum
}
