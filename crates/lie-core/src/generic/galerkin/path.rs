//! The path of a step, `exp(theta(t/h))` with a polynomial theta, and the derivatives of its action.

use crate::generic::series::{Scratch, dexp_dual_in};
use crate::generic::tableau::gauss_tableau;
use crate::lagrangian::LagrangianPoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{Stages, State};

/// More terms than the series of a path within one step needs: `|ad_theta|` up to 10.
const TERMS: usize = 48;

/// The path of a step over some scalar.
pub(super) struct Path<S, V, const STAGES: usize> {
    step: S,
    /// `theta_i = sum_j points_ij Theta_j`.
    points: [[S; STAGES]; STAGES],
    /// `h theta_i' = sum_j slopes_ij Theta_j`.
    pub(super) slopes: [[S; STAGES]; STAGES],
    pub(super) weights: [S; STAGES],
    /// `ad_theta^k theta'`.
    powers: [V; TERMS],
    pub(super) scratch: Scratch<V>,
    columns: [V; 5],
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
            powers: core::array::from_fn(|_| zero.clone()),
            scratch: Scratch::new(zero),
            columns: core::array::from_fn(|_| zero.clone()),
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
    ///
    /// `xi = sum_k c_k w_k`, `c_k = (-1)^k/(k + 1)!`, `w_k = [theta, w_(k-1)]`, `w_0 = theta'`; backwards
    /// `a_k = c_k m + ad*_theta a_(k+1)`, so that `a_0 = (dexp_(-theta))* m` and `q = -sum_(k>0) ad*_(w_(k-1)) a_k`.
    fn add_node<P>(
        &mut self,
        system: &P,
        node: usize,
        controls: &Stages<V, STAGES>,
        out: &mut Stages<V, STAGES>,
    ) where
        P: LagrangianPoisson<S, State = V>,
    {
        let (coefficients, last) = self.velocity(system, node, controls);
        let [theta, xi, momentum, adjoint, moved] = &mut self.columns;
        system.momentum(xi, momentum);
        // xi is no longer needed: its place takes q
        let q = xi;
        q.fill(S::zero());
        adjoint.fill(S::zero());
        for k in (0..=last).rev() {
            system.ad_star(theta, adjoint, moved);
            adjoint.copy_from(moved);
            adjoint.axpy(coefficients[k], momentum);
            if k > 0 {
                system.ad_star(&self.powers[k - 1], adjoint, moved);
                q.axpy(-S::one(), moved);
            }
        }
        let weight = self.weights[node];
        for (j, part) in out.0.iter_mut().enumerate() {
            part.axpy(weight * self.slopes[node][j], adjoint);
            part.axpy(weight * self.step * self.points[node][j], q);
        }
    }

    /// Computes theta, the `w_k` and xi at a node: the first two columns and the powers. Returns the `c_k`, as far as they
    /// are needed, and the last k; xi is no number where the series does not end.
    fn velocity<P>(
        &mut self,
        system: &P,
        node: usize,
        controls: &Stages<V, STAGES>,
    ) -> ([S; TERMS], usize)
    where
        P: LagrangianPoisson<S, State = V>,
    {
        let [theta, xi, ..] = &mut self.columns;
        theta.fill(S::zero());
        let first = &mut self.powers[0];
        first.fill(S::zero());
        for (j, control) in controls.0.iter().enumerate() {
            theta.axpy(self.points[node][j], control);
            first.axpy(self.slopes[node][j] / self.step, control);
        }
        xi.copy_from(first);
        let unchanging = S::epsilon() * S::ratio(1.0, 8.0) * xi.max_norm();
        let mut coefficients = [S::zero(); TERMS];
        coefficients[0] = S::one();
        let mut active = S::Mask::splat(true);
        let mut small_before = S::Mask::splat(false);
        let mut coefficient = S::one();
        let mut last = 0;
        for k in 1..TERMS {
            let (before, after) = self.powers.split_at_mut(k);
            let power = &mut after[0];
            system.ad(theta, &before[k - 1], power);
            coefficient *= S::ratio(-1.0, (k + 1) as f64);
            coefficients[k] = S::select(active, coefficient, S::zero());
            xi.axpy(coefficients[k], power);
            last = k;
            let small = (coefficient.abs() * power.max_norm()).less_equal(unchanging);
            active = active & !(small & small_before);
            small_before = small;
            if !active.any() {
                break;
            }
        }
        if active.any() {
            let not_a_number = S::zero() / S::zero();
            for entry in xi.as_mut_slice() {
                *entry = S::select(active, not_a_number, *entry);
            }
        }
        (coefficients, last)
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
