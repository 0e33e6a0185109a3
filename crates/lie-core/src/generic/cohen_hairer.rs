//! The equation of energy-preserving collocation.

use super::acting::Acting;
use super::beside::Beside;
use super::kernels::multiply;
use super::quadrature::{EnergyBalance, MAX_NODES, Quadrature};
use super::tableau::{Tableau, gauss_tableau};
use crate::clock::Clock;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{Stages, State, copies};

/// The method of Cohen and Hairer for any Poisson system.
///
/// Unknown: the increments `D_i` of the stages. With the Gauss nodes c and weights b, the Lagrange
/// polynomials `l_i` on the nodes and `L_i(t) = int_0^t l_i/b_i`, the solution is
/// `u(t) = mu + sum_i L_i(t) D_i`. Equation: `r_i = D_i - h b_i Pi(Y_i) g_i` with `Y_i = u(c_i)` and the means
/// of the gradient `g_i = (1/b_i) int_0^1 l_i(t) grad H(u(t)) dt`, by quadrature over q. New state:
/// `mu + sum_i D_i`. Jacobian, with the ratios `mu_ij = a_ij/b_j`:
/// `dr_i/dD_j = delta_ij - h b_i (mu_ij d/dY[Pi(Y_i) g_i] + Pi(Y_i) sum_q w_q l_i(t_q)/b_i L_j(t_q) H''(u(t_q)))`.
/// Start: `D_i = h b_i f(mu + c_i h f(mu))`.
///
/// Where something damps, `g_i + c G Pi(Y_i) g_i` takes the place of `g_i`, and where forces act, `F(Y_i)` is added, both at the
/// stages: H changes by `h sum_i b_i (<F(Y_i), g_i> - c <v_i, G v_i>)` with `v_i = Pi(Y_i) g_i`.
#[derive(Debug)]
pub struct CohenHairerStep<'a, S: Scalar, P: Poisson<S>, const STAGES: usize> {
    system: &'a P,
    step: S,
    tableau: Tableau<S, STAGES>,
    /// `h b_i`
    weights: [S; STAGES],
    rule: Quadrature<S>,
    /// `w_q l_i(t_q)/b_i`
    means: [[S; STAGES]; MAX_NODES],
    /// `L_i(t_q)`
    curve: [[S; STAGES]; MAX_NODES],
    base: P::State,
    point: P::State,
    field: P::State,
    /// The means of the gradient.
    gradients: [P::State; STAGES],
    poisson_matrix: P::Jacobian,
    hessian: P::Jacobian,
    beside: Acting<Beside<P::State, P::Jacobian>>,
}

impl<'a, S: Scalar, P: Poisson<S>, const STAGES: usize> CohenHairerStep<'a, S, P, STAGES> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let tableau = gauss_tableau::<S, STAGES>();
        let rule = Quadrature::of_hamiltonian(system, STAGES);
        let mut means = [[S::zero(); STAGES]; MAX_NODES];
        let mut curve = means;
        for node in 0..rule.len() {
            let (offset, weight) = rule.node(node);
            let t = S::ratio(1.0, 2.0) + offset;
            for i in 0..STAGES {
                means[node][i] = weight * lagrange(&tableau.c, i, t) / tableau.b[i];
                let mut sum = S::zero();
                for (&b, &c) in tableau.b.iter().zip(&tableau.c) {
                    sum += b * lagrange(&tableau.c, i, t * c);
                }
                curve[node][i] = t * sum / tableau.b[i];
            }
        }
        Self {
            system,
            step: h,
            weights: tableau.b.map(|b| h * b),
            tableau,
            rule,
            means,
            curve,
            base: zero.clone(),
            point: zero.clone(),
            field: zero.clone(),
            gradients: copies(&zero),
            poisson_matrix: system.zero_jacobian(),
            hessian: system.zero_jacobian(),
            beside: Acting::of(system, || Beside::new(system)),
        }
    }

    /// Whether the quadrature is not exact, so that a step may be too large for it.
    pub fn may_be_unresolved(&self) -> bool {
        !self.rule.is_exact()
    }

    /// Sets the point to `mu + sum_j weights_j D_j`.
    fn set_point(&mut self, weights: &[S; STAGES], increments: &Stages<P::State, STAGES>) {
        for (index, point) in self.point.as_mut_slice().iter_mut().enumerate() {
            let mut sum = S::zero();
            for (&weight, increment) in weights.iter().zip(&increments.0) {
                sum += weight * increment.as_slice()[index];
            }
            *point = self.base.as_slice()[index] + sum;
        }
    }

    /// Adds the gradient at the point to the means.
    fn add_gradient(&mut self, node: usize) {
        self.system.gradient(&self.point, &mut self.field);
        for (gradient, &weight) in self.gradients.iter_mut().zip(&self.means[node]) {
            gradient.axpy(weight, &self.field);
        }
    }

    /// Sets the means of the gradient.
    fn set_gradients(&mut self, unknown: &Stages<P::State, STAGES>) {
        for gradient in &mut self.gradients {
            gradient.fill(S::zero());
        }
        for node in 0..self.rule.len() {
            self.set_point(&{ self.curve[node] }, unknown);
            self.add_gradient(node);
        }
    }

    /// Sets the field `Pi(Y_i) g_i`; leaves `Y_i` in the point and `Pi(Y_i)` in the matrix, and the direction of the motion in the place
    /// of the mean of the gradient.
    fn set_field(&mut self, stage: usize, unknown: &Stages<P::State, STAGES>) {
        self.set_point(&{ self.tableau.ratios[stage] }, unknown);
        let matrix = &mut self.poisson_matrix;
        self.system.poisson_matrix(&self.point, matrix);
        multiply(matrix, &self.gradients[stage], &mut self.field);
        if let Some(beside) = self.beside.get_mut(self.system) {
            beside.set_at(self.system, &self.point);
            let gradient = &mut self.gradients[stage];
            beside.act(self.system, matrix, gradient, &mut self.field);
        }
    }

    /// `r_i = D_i - h b_i Pi(Y_i) g_i`, and what [`Self::set_field`] leaves.
    fn write_residual(
        &mut self,
        stage: usize,
        unknown: &Stages<P::State, STAGES>,
        residual: &mut P::State,
    ) {
        self.set_field(stage, unknown);
        let pairs = unknown.0[stage]
            .as_slice()
            .iter()
            .zip(self.field.as_slice());
        for (out, (&increment, &field)) in residual.as_mut_slice().iter_mut().zip(pairs) {
            *out = increment - self.weights[stage] * field;
        }
    }

    /// Adds to the derivatives of the mean of a stage those of what damps there.
    fn damp_blocks(
        &mut self,
        stage: usize,
        unknown: &Stages<P::State, STAGES>,
        blocks: &mut [P::Jacobian; STAGES],
    ) {
        self.set_point(&{ self.tableau.ratios[stage] }, unknown);
        let Some(beside) = self.beside.get_mut(self.system) else {
            return;
        };
        let system = self.system;
        beside.set_at(system, &self.point);
        system.poisson_matrix(&self.point, &mut self.poisson_matrix);
        let (tensor, slope) = (&self.poisson_matrix, &mut self.hessian);
        system.poisson_slope(&self.point, &self.gradients[stage], slope);
        for (block, &ratio) in blocks.iter_mut().zip(&self.tableau.ratios[stage]) {
            beside.damp_columns(system, block, |block, column, v| {
                for (row, entry) in v.as_mut_slice().iter_mut().enumerate() {
                    *entry = ratio * slope.get(row, column);
                    for inner in 0..system.dimension() {
                        *entry += tensor.get(row, inner) * block.get(inner, column);
                    }
                }
            });
        }
    }
}

/// The Lagrange polynomial of a node at t.
pub(super) fn lagrange<S: Scalar>(nodes: &[S], index: usize, t: S) -> S {
    let mut product = S::one();
    for (other, &node) in nodes.iter().enumerate() {
        if other != index {
            product *= (t - node) / (nodes[index] - node);
        }
    }
    product
}

impl<S: Scalar, P: Poisson<S>, const STAGES: usize> Equation<S>
    for CohenHairerStep<'_, S, P, STAGES>
{
    crate::generic::unknown_of_stages!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        // the slope at the base is kept in the last increment until that one is due
        self.system
            .vector_field(&self.base, &mut unknown.0[STAGES - 1]);
        for stage in 0..STAGES {
            self.point.copy_from(&self.base);
            self.point
                .axpy(self.tableau.c[stage] * self.step, &unknown.0[STAGES - 1]);
            self.system.vector_field(&self.point, &mut self.field);
            unknown.0[stage].fill(S::zero());
            unknown.0[stage].axpy(self.weights[stage], &self.field);
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        self.set_gradients(unknown);
        for (stage, residual) in residual.0.iter_mut().enumerate() {
            self.write_residual(stage, unknown, residual);
        }
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        let pairs = || {
            (0..self.system.dimension())
                .flat_map(|row| (0..self.system.dimension()).map(move |column| (row, column)))
        };
        for gradient in &mut self.gradients {
            gradient.fill(S::zero());
        }
        for block in matrix.0.as_flattened_mut() {
            for (row, column) in pairs() {
                block.set(row, column, S::zero());
            }
        }
        // the blocks first collect the means of the Hessian
        for node in 0..self.rule.len() {
            self.set_point(&{ self.curve[node] }, unknown);
            self.add_gradient(node);
            self.system.hessian(&self.point, &mut self.hessian);
            for (blocks, &mean) in matrix.0.iter_mut().zip(&self.means[node]) {
                for (block, &curve) in blocks.iter_mut().zip(&self.curve[node]) {
                    let weight = mean * curve;
                    for (row, column) in pairs() {
                        let term = weight * self.hessian.get(row, column);
                        block.set(row, column, block.get(row, column) + term);
                    }
                }
            }
        }
        for (stage, blocks) in matrix.0.iter_mut().enumerate() {
            if self.system.is_damped() {
                self.damp_blocks(stage, unknown, blocks);
            }
            self.write_residual(stage, unknown, &mut residual.0[stage]);
            if let Some(beside) = self.beside.get_mut(self.system) {
                beside.linearize(self.system, S::one());
            }
            let slope = &mut self.hessian;
            self.system
                .poisson_slope(&self.point, &self.gradients[stage], slope);
            for (other, block) in blocks.iter_mut().enumerate() {
                for column in 0..self.system.dimension() {
                    for (row, entry) in self.point.as_mut_slice().iter_mut().enumerate() {
                        *entry = block.get(row, column);
                    }
                    multiply(&self.poisson_matrix, &self.point, &mut self.field);
                    for (row, &entry) in self.field.as_slice().iter().enumerate() {
                        let unit = stage == other && row == column;
                        let identity = if unit { S::one() } else { S::zero() };
                        let ratio = self.tableau.ratios[stage][other];
                        let mut slope = ratio * self.hessian.get(row, column) + entry;
                        if let Some(beside) = self.beside.get(self.system) {
                            slope += ratio * beside.slope(row, column);
                        }
                        block.set(row, column, identity - self.weights[stage] * slope);
                    }
                }
            }
        }
    }

    fn resolved(&mut self, unknown: &Self::Unknown, end: &P::State) -> S::Mask {
        if self.rule.is_exact() {
            return S::Mask::splat(true);
        }
        let before = self.system.hamiltonian(&self.base);
        let mut balance = EnergyBalance::new(before, self.system.hamiltonian(end));
        if balance.is_even().all() {
            return S::Mask::splat(true);
        }
        for node in 0..self.rule.len() {
            self.set_point(&{ self.curve[node] }, unknown);
            self.system.gradient(&self.point, &mut self.field);
            let (means, weight) = (&self.means[node], self.rule.node(node).1);
            let here = self.field.as_slice().iter().zip(self.point.as_slice());
            let coordinates = here.enumerate().map(|(k, (&gradient, &at))| {
                let mut velocity = S::zero();
                for (&mean, increment) in means.iter().zip(&unknown.0) {
                    velocity += mean / weight * increment.as_slice()[k];
                }
                (gradient, at, velocity)
            });
            balance.add(&self.rule, node, coordinates);
        }
        balance.holds()
    }

    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut P::State) -> usize {
        self.set_gradients(unknown);
        if self.system.is_damped() {
            self.set_field(stage, unknown);
        }
        xi.fill(S::zero());
        xi.axpy(self.step, &self.gradients[stage]);
        STAGES
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        self.set_point(&[S::one(); STAGES], unknown);
        mu.copy_from(&self.point);
        let beside = self.beside.get(self.system);
        if let (Some(_), Some(Clock { momentum, .. })) = (beside, self.system.clock()) {
            // no residual depends on it, and no test of convergence
            self.set_gradients(unknown);
            let mut moved = S::zero();
            for stage in 0..STAGES {
                self.set_field(stage, unknown);
                moved += self.weights[stage] * self.field.as_slice()[momentum];
            }
            mu.as_mut_slice()[momentum] = self.base.as_slice()[momentum] + moved;
        }
    }
}
