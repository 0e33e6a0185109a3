//! The equation of Lie-group Galerkin methods: discrete Lagrangians of higher order in exponential coordinates.

mod body_velocity;
mod cayley_path;
mod node_path;
mod on_group;
mod path;
mod phase_path;

pub use on_group::{GalerkinAlong, GalerkinCayley, GalerkinOnGroup};

use super::kernels::multiply;
use super::series::coadjoint_action_in;
use crate::equation::Equation;
use crate::lagrangian::LagrangianPoisson;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::exchanging;
use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::{Stages, State, copies};
use path::Path;

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
    inverse_stiffness: [[S; STAGES]; STAGES],
    path: Path<S, P::State, STAGES>,
    lifted_path: Path<Dual<S>, LiftedState<S, P>, STAGES>,
    lifted_base: LiftedState<S, P>,
    lifted_controls: Stages<LiftedState<S, P>, STAGES>,
    lifted_defects: Stages<LiftedState<S, P>, STAGES>,
    columns: [P::State; 3],
    defects: Stages<P::State, STAGES>,
    moved: Stages<P::State, STAGES>,
}

type LiftedState<S, P> = <<P as Lift<S>>::Lifted as Poisson<Dual<S>>>::State;

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
        let lifted_zero = lifted.zero_state();
        let path = Path::new(&zero, h);
        let mut stiffness = [[S::zero(); STAGES]; STAGES];
        for j in 0..STAGES {
            for k in 0..STAGES {
                for (weight, slopes) in path.weights.iter().zip(&path.slopes) {
                    stiffness[j][k] += *weight * slopes[j] * slopes[k];
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
            lifted_path: Path::new(&lifted_zero, Dual::constant_of(h)),
            lifted_controls: Stages(copies(&lifted_zero)),
            lifted_defects: Stages(copies(&lifted_zero)),
            lifted_base: lifted_zero,
            path,
            lifted,
            columns: copies(&zero),
            defects: Stages(copies(&zero)),
            moved: Stages(copies(&zero)),
        }
    }

    /// Applies `K^-1 W h` to the stages of the defect; leaves the result in `moved`.
    fn precondition(&mut self) {
        let [sum, column, _] = &mut self.columns;
        for (j, part) in self.moved.0.iter_mut().enumerate() {
            sum.fill(S::zero());
            for (k, entry) in self.defects.0.iter().enumerate() {
                sum.axpy(self.inverse_stiffness[j][k] * self.step, entry);
            }
            multiply(&self.weight, sum, column);
            part.copy_from(column);
        }
    }
}

/// A vector without derivative.
fn lift<S: Scalar>(vector: &impl State<S>, out: &mut impl State<Dual<S>>) {
    let pairs = out.as_mut_slice().iter_mut().zip(vector.as_slice());
    pairs.for_each(|(out, &value)| *out = Dual::constant_of(value));
}

impl<S, P, const STAGES: usize> Equation<S> for GalerkinStep<'_, S, P, STAGES>
where
    S: Scalar,
    P: Lift<S> + LagrangianPoisson<S>,
    P::Lifted: LagrangianPoisson<Dual<S>>,
{
    crate::generic::unknown_of_stages!();

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
        self.path
            .defect(self.system, unknown, &self.base, &mut self.defects);
        self.precondition();
        for (part, moved) in residual.0.iter_mut().zip(&self.moved.0) {
            part.copy_from(moved);
        }
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        lift(&self.base, &mut self.lifted_base);
        for (control, lifted) in unknown.0.iter().zip(&mut self.lifted_controls.0) {
            lift(control, lifted);
        }
        for stage in 0..STAGES {
            for index in 0..self.system.dimension() {
                let seed = |controls: &mut Stages<LiftedState<S, P>, STAGES>, slope: S| {
                    controls.0[stage].as_mut_slice()[index].derivative = slope;
                };
                seed(&mut self.lifted_controls, S::one());
                self.lifted_path.defect(
                    &self.lifted,
                    &self.lifted_controls,
                    &self.lifted_base,
                    &mut self.lifted_defects,
                );
                seed(&mut self.lifted_controls, S::zero());
                for (part, value) in self.defects.0.iter_mut().zip(&self.lifted_defects.0) {
                    let pairs = part.as_mut_slice().iter_mut().zip(value.as_slice());
                    pairs.for_each(|(out, value)| *out = value.derivative);
                }
                self.precondition();
                for (row_stage, part) in self.moved.0.iter().enumerate() {
                    let block = &mut matrix.0[row_stage][stage];
                    for (row, &entry) in part.as_slice().iter().enumerate() {
                        block.set(row, index, entry);
                    }
                }
            }
        }
        self.residual(unknown, residual);
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
