//! The means of the gradient in energy-preserving collocation, at all stages in one number.

use core::array::from_fn;

use super::acting::Acting;
use super::beside::Beside;
use super::cohen_hairer::lagrange;
use super::diagonals::{diagonals, product, product_from};
use super::kernels::multiply;
use super::quadrature::{MAX_NODES, Quadrature};
use super::stage_work::At;
use super::tableau::gauss_tableau;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Numbers of nodes that are looked at together.
const BLOCK: usize = 8;
const MAX_BLOCKS: usize = MAX_NODES / BLOCK;

/// `g_i = (1/b_i) int_0^1 l_i(t) grad H(u(t)) dt` along the polynomial `u(t) = mu + sum_j L_j(t) D_j` of a step of
/// Gauss collocation with increments D, by quadrature with nodes in blocks of eight; `l_i` is the Lagrange polynomial of
/// stage i and `L_i` its integral from 0, divided by `b_i`.
#[derive(Clone, Debug)]
pub struct MeanGradients<S: Scalar, V, M, const STAGES: usize> {
    /// `None` for a quadratic H: the mean is the gradient at the stage.
    blocks: Option<[Block<S>; MAX_BLOCKS]>,
    count: usize,
    point: V,
    gradient: V,
    matrix: M,
    means: V,
    beside: Acting<Beside<V, M>>,
}

/// Eight nodes `t_q` of a rule with weights `w_q`, as diagonals of matrices.
#[derive(Clone, Copy, Debug)]
struct Block<S: Scalar> {
    /// `L_j(t_q)`
    curve: [S::Wide; BLOCK],
    /// `w_q l_i(t_q)/b_i`
    means: [S::Wide; BLOCK],
}

impl<S, V, M, const STAGES: usize> MeanGradients<S, V, M, STAGES>
where
    S: Scalar,
    V: State<S::Wide>,
    M: SquareMatrix<S::Wide>,
{
    /// For a system, of which `wide` is the form over eight numbers.
    pub fn new<P, W>(system: &P, wide: &W) -> Self
    where
        P: Poisson<S>,
        W: Poisson<S::Wide, State = V, Jacobian = M>,
    {
        let rule = Quadrature::of_hamiltonian(system, STAGES);
        let quadratic = system
            .hamiltonian_degree()
            .is_some_and(|degree| degree <= 2);
        let zero = wide.zero_state();
        Self {
            blocks: (!quadratic).then(|| from_fn(|index| Block::new::<STAGES>(&rule, index))),
            count: rule.len().div_ceil(BLOCK),
            point: zero.clone(),
            gradient: zero.clone(),
            matrix: wide.zero_jacobian(),
            means: zero,
            beside: Acting::of(wide, || Beside::new(wide)),
        }
    }

    /// Whether they are the gradients at the stages, as of a quadratic H.
    pub fn are_at_stages(&self) -> bool {
        self.blocks.is_none()
    }

    /// The means at all stages of a step.
    #[inline(always)]
    pub fn means<W>(&mut self, wide: &W, at: &At<'_, V>) -> &V
    where
        W: Poisson<S::Wide, State = V, Jacobian = M>,
    {
        let Some(blocks) = &self.blocks else {
            wide.generator(at.points, &mut self.means);
            return &self.means;
        };
        self.means.fill(S::Wide::zero());
        for block in &blocks[..self.count] {
            let entries = self.point.as_mut_slice().iter_mut();
            let lines = at.base.as_slice().iter().zip(at.increments.as_slice());
            for (point, (y, increments)) in entries.zip(lines) {
                *point = product_from::<S, BLOCK>(*y, &block.curve, *increments);
            }
            wide.gradient(&self.point, &mut self.gradient);
            let means = self.means.as_mut_slice().iter_mut();
            for (mean, &gradient) in means.zip(self.gradient.as_slice()) {
                *mean += product::<S, BLOCK>(&block.means, gradient);
            }
        }
        &self.means
    }

    /// The slopes `Pi(Y_i) g_i` at all stages of a step, with what acts beside H.
    #[inline(always)]
    pub fn slopes<W>(&mut self, wide: &W, at: &At<'_, V>, out: &mut V)
    where
        W: Poisson<S::Wide, State = V, Jacobian = M>,
    {
        if self.are_at_stages() {
            wide.vector_field(at.points, out);
            return;
        }
        self.means(wide, at);
        wide.poisson_matrix(at.points, &mut self.matrix);
        multiply(&self.matrix, &self.means, out);
        if let Some(beside) = self.beside.get_mut(wide) {
            beside.set_at(wide, at.points);
            beside.act(wide, &self.matrix, &mut self.means, out);
        }
    }

    /// The directions of the motion at all stages of a step: the means, with what damps; `out` is space for the slopes.
    pub fn directions<W>(&mut self, wide: &W, at: &At<'_, V>, out: &mut V) -> &V
    where
        W: Poisson<S::Wide, State = V, Jacobian = M>,
    {
        if !wide.is_damped() || self.are_at_stages() {
            return self.means(wide, at);
        }
        self.slopes(wide, at, out);
        &self.means
    }
}

impl<S: Scalar> Block<S> {
    /// The nodes of a rule from `8 index` on; a node that is not there counts nothing.
    fn new<const STAGES: usize>(rule: &Quadrature<S>, index: usize) -> Self {
        let tableau = gauss_tableau::<S, STAGES>();
        let node = |place: usize| {
            let node = BLOCK * index + place;
            (node < rule.len()).then(|| rule.node(node))
        };
        let half = S::ratio(1.0, 2.0);
        let curve = |place: usize, j: usize| {
            let Some((offset, _)) = node(place) else {
                return S::zero();
            };
            let t = half + offset;
            let pairs = tableau.b.iter().zip(&tableau.c);
            let sum = pairs.fold(S::zero(), |sum, (&b, &c)| {
                sum + b * lagrange(&tableau.c, j, t * c)
            });
            t * sum / tableau.b[j]
        };
        let mean = |i: usize, place: usize| {
            let Some((offset, weight)) = node(place) else {
                return S::zero();
            };
            weight * lagrange(&tableau.c, i, half + offset) / tableau.b[i]
        };
        Self {
            curve: diagonals(BLOCK, STAGES, &curve),
            means: diagonals(STAGES, BLOCK, &mean),
        }
    }
}
