//! The equation of Lie-group Galerkin methods in phase space: with forces, damping, the group element and the time.

use super::node_path::{Along, NodePath};
use crate::clock::Clock;
use crate::equation::Equation;
use crate::generic::momenta;
use crate::generic::tableau::gauss_tableau;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::methods::{Cayley, Exp, Retraction};
use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::{Stages, State, copies};
use crate::structure::CotangentPoisson;

/// One step along the path of degree s for which the sum of action and work of the forces is stationary, the discrete
/// Lagrange–d'Alembert principle with the quadrature of Gauss, on a system that carries the group element or the time.
///
/// The state is (mu, a): the momenta, then the coordinates a of the configuration, on which the group acts. The path is
/// `g exp(theta(t/h))`, theta a polynomial of degree s with `theta(0) = 0`; at the node `c_i` it has the configuration
/// `a_i = exp(ad*_(theta_i)) a` and a momentum `m_i`. With the generator `(xi, v)` of the motion and the force F there,
///
/// ```text
/// dexp_(-theta_i) theta_i' = h xi_i,   f_i = F_i + ad*_(0, v_i) (0, a_i)
/// nu = mu + h sum_i b_i exp(-ad*_(theta_i)) f_i,   mu1 = exp(ad*_(theta(1))) nu,   a1 = exp(ad*_(theta(1))) a
/// (dexp_(-theta_i))* m_i + sum_j (b_j - a_ij) q_j = phi1(ad*_(theta(1))) nu
/// q_i = d/dtheta <m_i, dexp_(-theta) theta_i'> + h (dexp_(-theta_i))* f_i
/// ```
///
/// The first and the last line are Gauss collocation in the coordinates theta and their momenta, for which any generator and any force
/// keep the order 2s; a generator that is a gradient makes the step the variational one, [`super::GalerkinStep`] of a reduced
/// Lagrangian. The line between them is the balance of the spatial momentum: it changes by exactly the impulses of the forces, each carried to space
/// by the group element of its node, whatever the error of the unknown.
///
/// Along the Cayley map the coordinates are those about the middle of the step, see [`GalerkinCayley`].
///
/// Unknown: `|mu| theta_i'` and `m_i` of each node, a pair, so that an angle is solved for to round-off whatever the units of mu. The
/// Jacobian comes from dual numbers and is exact. Start: along the field.
pub struct GalerkinAlong<'a, S, P, T, const STAGES: usize>
where
    S: Scalar,
    P: Lift<S> + CotangentPoisson<S>,
    P::Lifted: CotangentPoisson<Dual<S>>,
    T: Along<S, P, STAGES> + Along<Dual<S>, P::Lifted, STAGES>,
{
    system: &'a P,
    lifted: P::Lifted,
    step: S,
    /// `|mu|`, or 1 where it is 0.
    size: S,
    base: P::State,
    lifted_base: LiftedState<S, P>,
    path: <T as Along<S, P, STAGES>>::Path,
    lifted_path: <T as Along<Dual<S>, P::Lifted, STAGES>>::Path,
    columns: [P::State; 3],
}

/// Along the exponential map.
pub type GalerkinOnGroup<'a, S, P, const STAGES: usize> = GalerkinAlong<'a, S, P, Exp, STAGES>;

/// Along the Cayley map, on systems with a closed representation.
///
/// The path is `g cay(theta(t/h))` with `theta(1/2) = 0`, so that it is the same backwards, and every order is symmetric. With
/// `e_j` the weight of the rate of a node in the change of theta over the first half of the step, (M, A) the state seen from the middle,
/// `Ad*_(cay -theta(0)) (mu, a)`, and N what M becomes by the impulses, the equations are
///
/// ```text
/// dcay_(-theta_i) theta_i' = h xi_i,   theta_i = sum_j (a_ij - e_j) theta_j',   a_i = Ad*_(cay theta_i) A
/// N = M + h sum_i b_i Ad*_(cay -theta_i) f_i,   mu1 = Ad*_(cay theta(1)) N,   a1 = Ad*_(cay theta(1)) A
/// (dcay_(-theta_i))* m_i + sum_j (b_j - a_ij - b_j e_i/b_i) q_j = (1 - e_i/b_i) (dcay_(theta(1)))* N + (e_i/b_i) (dcay_(theta(0)))* M
/// ```
///
/// They are those of the paths that move as a whole and have theta vary, with the ends fixed: the step is variational too. It is no collocation
/// in fixed coordinates, and its order, by slope, is the same 2s. With one node theta is 0 there and the step is by `cay(x/2)` twice,
/// where that of a reduced Lagrangian ([`crate::generic::CayleyVariational`]) is by `cay(x)`.
pub type GalerkinCayley<'a, S, P, const STAGES: usize> = GalerkinAlong<'a, S, P, Cayley, STAGES>;

type LiftedState<S, P> = <<P as Lift<S>>::Lifted as Poisson<Dual<S>>>::State;
/// Rate and momentum of a node.
type Pair<V> = Stages<V, 2>;

impl<'a, S, P, T, const STAGES: usize> GalerkinAlong<'a, S, P, T, STAGES>
where
    S: Scalar,
    P: Lift<S> + CotangentPoisson<S>,
    P::Lifted: CotangentPoisson<Dual<S>>,
    T: Along<S, P, STAGES> + Along<Dual<S>, P::Lifted, STAGES>,
{
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let lifted = system.lift();
        Self {
            system,
            step: h,
            size: S::one(),
            base: zero.clone(),
            path: NodePath::new(system, h),
            lifted_path: NodePath::new(&lifted, Dual::constant_of(h)),
            lifted_base: lifted.zero_state(),
            lifted,
            columns: copies(&zero),
        }
    }

    /// Gives the path the rates and momenta of an unknown.
    fn set_nodes(&mut self, unknown: &Stages<Pair<P::Momentum>, STAGES>) {
        for (node, pair) in self.path.nodes_mut().iter_mut().zip(&unknown.0) {
            let [rate, momentum] = &pair.0;
            let momenta = momentum.as_slice().len();
            for (out, &y) in node.rate.as_mut_slice().iter_mut().zip(rate.as_slice()) {
                *out = y / self.size;
            }
            node.momentum.as_mut_slice()[..momenta].copy_from_slice(momentum.as_slice());
        }
    }

    /// The derivative of what is left along an entry of the rate or the momentum of a node, where `of_rate` and `of_momentum` then are.
    fn differentiate(&mut self, stage: usize, part: usize, index: usize) {
        let seed = |path: &mut <T as Along<Dual<S>, P::Lifted, STAGES>>::Path, slope: S| {
            let node = &mut path.nodes_mut()[stage];
            let of = if part == 0 {
                &mut node.rate
            } else {
                &mut node.momentum
            };
            of.as_mut_slice()[index].derivative = slope;
        };
        seed(&mut self.lifted_path, S::one());
        self.lifted_path.set(&self.lifted, &self.lifted_base);
        seed(&mut self.lifted_path, S::zero());
    }
}

/// A vector without derivative.
fn lift<S: Scalar>(vector: &impl State<S>, out: &mut impl State<Dual<S>>) {
    let pairs = out.as_mut_slice().iter_mut().zip(vector.as_slice());
    pairs.for_each(|(out, &value)| *out = Dual::constant_of(value));
}

impl<S, P, T, const STAGES: usize> Equation<S> for GalerkinAlong<'_, S, P, T, STAGES>
where
    S: Scalar,
    P: Lift<S> + CotangentPoisson<S>,
    P::Lifted: CotangentPoisson<Dual<S>>,
    T: Along<S, P, STAGES> + Along<Dual<S>, P::Lifted, STAGES>,
{
    type State = P::State;
    type Unknown = Stages<Pair<P::Momentum>, STAGES>;
    type Matrix = StageMatrix<StageMatrix<P::MomentumMatrix, 2>, STAGES>;

    fn zero_unknown(&self) -> Self::Unknown {
        let zero = copies(&self.system.zero_momentum());
        Stages(copies(&Stages(zero)))
    }

    fn zero_matrix(&self) -> Self::Matrix {
        let block = StageMatrix(copies(&copies(&self.system.zero_momentum_matrix())));
        StageMatrix(copies(&copies(&block)))
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.size = momenta::size(self.system, mu);
    }

    fn scale(&self, _mu: &P::State) -> S {
        self.size
    }

    #[inline]
    fn clock(&self) -> Option<Clock> {
        self.system.clock()
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        let (momenta, nodes) = (self.system.momenta(), gauss_tableau::<S, STAGES>().c);
        let [field, point, generator] = &mut self.columns;
        self.system.vector_field(&self.base, field);
        for (pair, c) in unknown.0.iter_mut().zip(nodes) {
            point.copy_from(&self.base);
            point.axpy(c * self.step, field);
            self.system.generator(point, generator);
            let [rate, momentum] = &mut pair.0;
            momentum
                .as_mut_slice()
                .copy_from_slice(&point.as_slice()[..momenta]);
            for (out, &xi) in rate.as_mut_slice().iter_mut().zip(generator.as_slice()) {
                *out = self.size * self.step * xi;
            }
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        self.set_nodes(unknown);
        self.path.set(self.system, &self.base);
        for (pair, node) in residual.0.iter_mut().zip(self.path.nodes()) {
            let [rate, momentum] = &mut pair.0;
            let momenta = momentum.as_slice().len();
            for (out, &rest) in rate.as_mut_slice().iter_mut().zip(node.of_rate.as_slice()) {
                *out = self.size * rest;
            }
            momentum
                .as_mut_slice()
                .copy_from_slice(&node.of_momentum.as_slice()[..momenta]);
        }
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        self.residual(unknown, residual);
        lift(&self.base, &mut self.lifted_base);
        let nodes = self.path.nodes().iter();
        for (node, lifted) in nodes.zip(self.lifted_path.nodes_mut()) {
            lift(&node.rate, &mut lifted.rate);
            lift(&node.momentum, &mut lifted.momentum);
        }
        // the unknown of a rate is |mu| times it
        let columns = [S::one() / self.size, S::one()];
        let rows = [self.size, S::one()];
        for stage in 0..STAGES {
            for (part, &of_column) in columns.iter().enumerate() {
                for index in 0..self.system.momenta() {
                    self.differentiate(stage, part, index);
                    for (row_stage, node) in self.lifted_path.nodes().iter().enumerate() {
                        let blocks = &mut matrix.0[row_stage][stage];
                        for (row_part, left) in
                            [&node.of_rate, &node.of_momentum].into_iter().enumerate()
                        {
                            let block = &mut blocks.0[row_part][part];
                            for row in 0..self.system.momenta() {
                                let slope = left.as_slice()[row].derivative;
                                block.set(row, index, rows[row_part] * of_column * slope);
                            }
                        }
                    }
                }
            }
        }
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        self.set_nodes(unknown);
        self.path.move_to_end(self.system, &self.base, mu);
    }

    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        self.set_nodes(unknown);
        self.path.within_chart(self.system)
    }

    fn earlier_factor(&mut self, unknown: &Self::Unknown, xi: &mut P::State) -> Option<Retraction> {
        self.set_nodes(unknown);
        self.path.earlier_factor(xi)
    }

    fn group_factor(&mut self, unknown: &Self::Unknown, xi: &mut P::State) -> Option<Retraction> {
        self.set_nodes(unknown);
        Some(self.path.factor(xi))
    }
}
