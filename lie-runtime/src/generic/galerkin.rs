//! The equation of Lie-group Galerkin methods: discrete Lagrangians of higher order in exponential coordinates.

use super::kernels::multiply;
use super::series::{Scratch, coadjoint_action_in, dexp_dual_in};
use super::tableau::gauss_tableau;
use crate::equation::Equation;
use crate::lagrangian::LagrangianPoisson;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::methods::Retraction;
use crate::newton::{dense, exchanging};
use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Mask, Scalar};
use crate::state::{Stages, State};
use nalgebra::SMatrix;

/// More terms than the series of a path within one step needs: `|ad_theta|` up to 10.
const TERMS: usize = 48;

/// One step along the path of degree s that makes the quadrature of the action stationary.
///
/// The path is `exp(theta(t/h))`, `theta(0) = 0`, a polynomial of degree s with the control points
/// `Theta_j = theta(j/s)`; the velocity at the node `c_i` of Gauss is `xi_i = dexp_(-theta_i) theta_i'`, and
/// `L = h sum_i b_i l(xi_i)`. Unknown: the control points. Equation: `p_j = dL/dTheta_j` vanishes for `j < s`, and
/// `p_s = phi1(ad*_(Theta_s)) mu`, which is `(dexp_(Theta_s)^-1)* p_s = mu`; all of it times `K^-1 W h`, with
/// the stiffness `K_jk = sum_i b_i D_ij D_ik` of the path and `W = H''(mu)`, so that the Jacobian is dimensionless.
/// It comes from dual numbers and is exact. New state: `exp(ad*_(Theta_s)) mu`, on the coadjoint orbit of mu to
/// round-off whatever the error of the unknown. Start: `Theta_j = t xi + t^2 xi'/2`, `t = h j/s`, with the velocity xi
/// of mu and its Euler–Poincaré derivative.
pub struct GalerkinStep<'a, S: Scalar, P: Lift<S>, const STAGES: usize>
where
    P::Lifted: LagrangianPoisson<Dual<S>>,
{
    system: &'a P,
    lifted: P::Lifted,
    step: S,
    base: P::State,
    weight: P::Jacobian,
    inverse_stiffness: SMatrix<S, STAGES, STAGES>,
    path: Path<S, P::State, STAGES>,
    lifted_path: Path<Dual<S>, <P::Lifted as Poisson<Dual<S>>>::State, STAGES>,
    columns: [P::State; 3],
    defects: Stages<P::State, STAGES>,
}

/// The path of a step over some scalar.
struct Path<S, V, const STAGES: usize> {
    step: S,
    /// `theta_i = sum_j points_ij Theta_j`.
    points: [[S; STAGES]; STAGES],
    /// `h theta_i' = sum_j slopes_ij Theta_j`.
    slopes: [[S; STAGES]; STAGES],
    weights: [S; STAGES],
    /// `ad_theta^k theta'`.
    powers: [V; TERMS],
    scratch: Scratch<V>,
    columns: [V; 5],
}

impl<S: Scalar, V: State<S>, const STAGES: usize> Path<S, V, STAGES> {
    fn new(zero: &V, h: S) -> Self {
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
    fn defect<P>(
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
        dexp_dual_in(system, end, mu, sum, &mut self.scratch, |_, _| ());
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
        let [theta, xi, momentum, adjoint, moved] = &mut self.columns;
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

impl<'a, S, P, const STAGES: usize> GalerkinStep<'a, S, P, STAGES>
where
    S: Scalar,
    P: Lift<S> + LagrangianPoisson<S>,
    P::Lifted: LagrangianPoisson<Dual<S>>,
{
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let lifted = system.lift();
        let path = Path::new(&zero, h);
        let mut stiffness = SMatrix::<S, STAGES, STAGES>::repeat(S::zero());
        for j in 0..STAGES {
            for k in 0..STAGES {
                for (weight, slopes) in path.weights.iter().zip(&path.slopes) {
                    stiffness[(j, k)] += *weight * slopes[j] * slopes[k];
                }
            }
        }
        let mut inverse_stiffness = stiffness;
        exchanging::invert(&mut stiffness, &mut inverse_stiffness);
        Self {
            system,
            step: h,
            base: zero.clone(),
            weight: system.zero_jacobian(),
            inverse_stiffness,
            lifted_path: Path::new(&lifted.zero_state(), Dual::constant_of(h)),
            path,
            lifted,
            columns: core::array::from_fn(|_| zero.clone()),
            defects: Stages(core::array::from_fn(|_| zero.clone())),
        }
    }

    /// Applies `K^-1 W h` to the stages of a vector.
    fn precondition(
        &mut self,
        vector: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
    ) {
        let [sum, moved, _] = &mut self.columns;
        for (j, part) in out.0.iter_mut().enumerate() {
            sum.fill(S::zero());
            for (k, entry) in vector.0.iter().enumerate() {
                sum.axpy(self.inverse_stiffness[(j, k)] * self.step, entry);
            }
            multiply(&self.weight, sum, moved);
            part.copy_from(moved);
        }
    }
}

impl<S, P, const STAGES: usize> Equation<S> for GalerkinStep<'_, S, P, STAGES>
where
    S: Scalar,
    P: Lift<S> + LagrangianPoisson<S>,
    P::Lifted: LagrangianPoisson<Dual<S>>,
{
    type State = P::State;
    type Unknown = Stages<P::State, STAGES>;
    type Matrix = StageMatrix<P::Jacobian, STAGES>;

    fn zero_unknown(&self) -> Self::Unknown {
        Stages(core::array::from_fn(|_| self.system.zero_state()))
    }

    fn zero_matrix(&self) -> Self::Matrix {
        StageMatrix(core::array::from_fn(|_| {
            core::array::from_fn(|_| self.system.zero_jacobian())
        }))
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.system.hessian(mu, &mut self.weight);
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        let [xi, action, slope] = &mut self.columns;
        self.system.velocity(&self.base, xi);
        self.system.ad_star(xi, &self.base, action);
        multiply(&self.weight, action, slope);
        for (j, control) in unknown.0.iter_mut().enumerate() {
            let time = self.step * S::ratio((j + 1) as f64, STAGES as f64);
            control.fill(S::zero());
            control.axpy(time, xi);
            control.axpy(S::ratio(1.0, 2.0) * time * time, slope);
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        let mut defects = self.defects.clone();
        self.path
            .defect(self.system, unknown, &self.base, &mut defects);
        self.precondition(&defects, residual);
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        let lifted = |system: &P::Lifted, vector: &P::State| {
            let mut out = system.zero_state();
            let pairs = out.as_mut_slice().iter_mut().zip(vector.as_slice());
            pairs.for_each(|(out, &value)| *out = Dual::constant_of(value));
            out
        };
        let mu = lifted(&self.lifted, &self.base);
        let mut controls = Stages(core::array::from_fn(|j| {
            lifted(&self.lifted, &unknown.0[j])
        }));
        let mut values = controls.clone();
        let (mut column, mut moved) = (self.defects.clone(), self.defects.clone());
        for stage in 0..STAGES {
            for index in 0..P::DIM {
                controls.0[stage].as_mut_slice()[index].derivative = S::one();
                self.lifted_path
                    .defect(&self.lifted, &controls, &mu, &mut values);
                controls.0[stage].as_mut_slice()[index].derivative = S::zero();
                for (part, value) in column.0.iter_mut().zip(&values.0) {
                    let pairs = part.as_mut_slice().iter_mut().zip(value.as_slice());
                    pairs.for_each(|(out, value)| *out = value.derivative);
                }
                self.precondition(&column, &mut moved);
                for (row_stage, part) in moved.0.iter().enumerate() {
                    let block = &mut matrix.0[row_stage][stage];
                    for (row, &entry) in part.as_slice().iter().enumerate() {
                        block.set(row, index, entry);
                    }
                }
            }
        }
        self.residual(unknown, residual);
    }

    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        dense::factor(matrix)
    }

    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        dense::solve(factors, residual);
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        let (end, scratch) = (&unknown.0[STAGES - 1], &mut self.path.scratch);
        coadjoint_action_in(self.system, end, &self.base, mu, scratch);
    }

    fn group_factor(&mut self, unknown: &Self::Unknown, xi: &mut P::State) -> Option<Retraction> {
        xi.copy_from(&unknown.0[STAGES - 1]);
        Some(Retraction::Exp)
    }
}
