//! The path of a step along the Cayley map, in coordinates about its middle: what its equations leave, over some scalar.

use core::ops::Range;

use super::node_path::{Node, NodePath};
use crate::generic::chart::cayley_chart;
use crate::generic::tableau::{Tableau, gauss_tableau};
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::exchanging;
use crate::poisson::CayleyPoisson;
use crate::scalar::Scalar;
use crate::state::{State, copies};
use crate::structure::CotangentPoisson;

/// The path `g cay(theta(t/h))` of a step with the momenta at its nodes, see [`super::GalerkinCayley`].
#[derive(Debug)]
pub struct CayleyPath<S, V, M, const STAGES: usize> {
    step: S,
    tableau: Tableau<S, STAGES>,
    /// `e_j/b_j`, where `e_j` weighs the rate of a node in what theta changes by in the first half of the step.
    halves: [S; STAGES],
    nodes: [Node<V>; STAGES],
    /// `-theta(0)`
    first: V,
    /// `theta(1)`
    last: V,
    /// `(dcay_(-theta(0)))*` of the state from which the step starts.
    start: V,
    /// That state seen from the middle, and then with what the forces of all nodes bring there.
    middle: V,
    pushed: V,
    /// `(dcay_(theta(1)))*` of the latter, and the new state.
    end: [V; 2],
    /// `(dcay_x^-1)*`, and of the momenta the inverse of `(dcay_(-theta)^-1)*`.
    matrices: [M; 2],
    columns: [V; 6],
}

/// On which side of x the tangent stands.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    /// Of `tau(x)`: `(dcay_x^-1)* = 1 - ad*_x/2 - Q_x/4`.
    Right,
    /// The same at -x: `(dcay_(-x)^-1)* = 1 + ad*_x/2 - Q_x/4`.
    Left,
}

/// `out = (dcay_x^-1)* m`, or the same at -x.
fn tangent<S, P>(
    system: &P,
    side: Side,
    x: &P::State,
    m: &P::State,
    out: &mut P::State,
    scratch: &mut P::State,
) where
    S: Scalar,
    P: CayleyPoisson<S>,
{
    let half = S::ratio(if side == Side::Right { -1.0 } else { 1.0 }, 2.0);
    out.copy_from(m);
    system.ad_star(x, m, scratch);
    out.axpy(half, scratch);
    system.triple(x, x, m, scratch);
    out.axpy(S::ratio(-1.0, 4.0), scratch);
}

/// Sets a block on the diagonal of the matrix of [`tangent`], for an element x of the algebra of the group: it takes momenta to momenta, and
/// what the configuration is to the same.
fn set_matrix<S, P>(
    system: &P,
    (side, block): (Side, Range<usize>),
    x: &P::State,
    matrix: &mut P::Jacobian,
    [unit, column, scratch]: [&mut P::State; 3],
) where
    S: Scalar,
    P: CayleyPoisson<S>,
{
    unit.fill(S::zero());
    for k in block.clone() {
        unit.as_mut_slice()[k] = S::one();
        tangent(system, side, x, unit, column, scratch);
        unit.as_mut_slice()[k] = S::zero();
        for row in block.clone() {
            matrix.set(row, k, column.as_slice()[row]);
        }
    }
}

/// `back = (dcay_x)* mu` and `moved = Ad*_(cay x) mu`, which is `(dcay_(-x)^-1)*` of the former; of the coordinates in these blocks.
fn carry<S, P>(
    system: &P,
    blocks: impl IntoIterator<Item = Range<usize>>,
    (x, mu): (&P::State, &P::State),
    (back, moved): (&mut P::State, &mut P::State),
    matrix: &mut P::Jacobian,
    [unit, scratch]: [&mut P::State; 2],
) where
    S: Scalar,
    P: CayleyPoisson<S>,
{
    back.copy_from(mu);
    for block in blocks {
        let of_block = (Side::Right, block.clone());
        set_matrix(system, of_block, x, matrix, [unit, moved, scratch]);
        exchanging::solve_block(block, matrix, back);
    }
    tangent(system, Side::Left, x, back, moved, scratch);
}

/// The momenta, and the coordinates of the configuration.
fn blocks<S: Scalar, P: CotangentPoisson<S>>(system: &P) -> [Range<usize>; 2] {
    let momenta = system.momenta();
    [0..momenta, momenta..system.dimension()]
}

impl<S, V, M, const STAGES: usize> CayleyPath<S, V, M, STAGES>
where
    S: Scalar,
    V: State<S>,
    M: SquareMatrix<S>,
{
    /// Sets the coordinates of both ends and of the nodes.
    fn set_points(&mut self) {
        let one = S::one();
        self.first.fill(S::zero());
        self.last.fill(S::zero());
        for ((&b, &half), node) in self.tableau.b.iter().zip(&self.halves).zip(&self.nodes) {
            self.first.axpy(b * half, &node.rate);
            self.last.axpy(b * (one - half), &node.rate);
        }
        for i in 0..STAGES {
            let [point, ..] = &mut self.columns;
            point.fill(S::zero());
            for (j, node) in self.nodes.iter().enumerate() {
                let ratio = self.tableau.ratios[i][j] - self.halves[j];
                point.axpy(self.tableau.b[j] * ratio, &node.rate);
            }
            self.nodes[i].point.copy_from(point);
        }
    }

    /// Sets both ends; of the equations all but what one node has of another.
    fn set_ends<P>(&mut self, system: &P, base: &V)
    where
        P: CotangentPoisson<S, State = V, Jacobian = M> + CayleyPoisson<S>,
    {
        self.set_points();
        let [unit, scratch, ..] = &mut self.columns;
        let [matrix, _] = &mut self.matrices;
        let (from, to) = ((&self.first, base), (&mut self.start, &mut self.middle));
        carry(system, blocks(system), from, to, matrix, [unit, scratch]);
        self.pushed.copy_from(&self.middle);
        for i in 0..STAGES {
            self.set_node(system, i);
        }
        let [unit, scratch, ..] = &mut self.columns;
        let [matrix, _] = &mut self.matrices;
        let [back, moved] = &mut self.end;
        let from = (&self.last, &self.pushed);
        let to = (back, moved);
        carry(system, blocks(system), from, to, matrix, [unit, scratch]);
    }

    fn set_node<P>(&mut self, system: &P, i: usize)
    where
        P: CotangentPoisson<S, State = V, Jacobian = M> + CayleyPoisson<S>,
    {
        let (momenta, node) = (system.momenta(), &mut self.nodes[i]);
        let [unit, scratch, at, generator, force, xi] = &mut self.columns;
        let [matrix, inverse] = &mut self.matrices;
        let (from, to) = ((&node.point, &self.middle), (&mut *force, &mut *at));
        let [_, configuration] = blocks(system);
        carry(system, [configuration], from, to, matrix, [unit, scratch]);
        at.as_mut_slice()[..momenta].copy_from_slice(&node.momentum.as_slice()[..momenta]);
        let columns = [&mut *unit, &mut *force, &mut *scratch];
        let of_block = (Side::Left, 0..momenta);
        set_matrix(system, of_block, &node.point, matrix, columns);
        exchanging::invert_leading(momenta, matrix, inverse);
        system.generator(at, generator);
        set_velocity((self.step, inverse, momenta), node, generator, xi);
        system.ad_star(generator, at, force);
        if system.is_forced() {
            system.force(at, generator);
            force.axpy(S::one(), generator);
        }
        force.as_mut_slice()[momenta..].fill(S::zero());
        let carried = at;
        leading(momenta, inverse, &node.momentum, &mut node.of_momentum);
        leading(momenta, inverse, force, carried);
        let moved = generator;
        tangent(system, Side::Right, &node.point, carried, moved, scratch);
        self.pushed.axpy(self.step * self.tableau.b[i], moved);
        node.change.fill(S::zero());
        node.change.axpy(self.step, carried);
        add_slope(
            system,
            (&node.point, xi, &node.of_momentum),
            &mut node.change,
            [unit, scratch],
        );
    }
}

/// Sets `xi = dcay_(-theta) (h theta')` with the inverse of `(dcay_(-theta)^-1)*`, and what is left of its equation. Of the generator what
/// remains moves the momenta alone.
fn set_velocity<S: Scalar, V: State<S>, M: SquareMatrix<S>>(
    (step, inverse, momenta): (S, &M, usize),
    node: &mut Node<V>,
    generator: &mut V,
    xi: &mut V,
) {
    xi.fill(S::zero());
    for row in 0..momenta {
        let mut velocity = S::zero();
        for (k, &rate) in node.rate.as_slice()[..momenta].iter().enumerate() {
            velocity += inverse.get(k, row) * rate;
        }
        xi.as_mut_slice()[row] = velocity;
        let rest = velocity - step * generator.as_slice()[row];
        node.of_rate.as_mut_slice()[row] = rest;
        generator.as_mut_slice()[row] = S::zero();
    }
}

/// `out = A m` with the leading block of A; the other entries are 0.
fn leading<S: Scalar, V: State<S>, M: SquareMatrix<S>>(
    size: usize,
    matrix: &M,
    m: &V,
    out: &mut V,
) {
    out.fill(S::zero());
    for row in 0..size {
        let mut sum = S::zero();
        for (column, &entry) in m.as_slice()[..size].iter().enumerate() {
            sum += matrix.get(row, column) * entry;
        }
        out.as_mut_slice()[row] = sum;
    }
}

/// Adds the derivative by theta of `<m, dcay_(-theta) theta'>`. With `p = (dcay_(-theta))* m` and `xi = dcay_(-theta) theta'` held it is that of
/// `-<p, xi + [theta, xi]/2 - theta xi theta/4>`: `ad*_xi p/2` and half of `<p, e_b xi theta + theta xi e_b>/2`.
fn add_slope<S, P>(
    system: &P,
    (theta, xi, p): (&P::State, &P::State, &P::State),
    out: &mut P::State,
    [unit, scratch]: [&mut P::State; 2],
) where
    S: Scalar,
    P: CotangentPoisson<S> + CayleyPoisson<S>,
{
    let (half, momenta) = (S::ratio(1.0, 2.0), system.momenta());
    system.ad_star(xi, p, scratch);
    out.axpy(half, scratch);
    unit.fill(S::zero());
    for b in 0..momenta {
        unit.as_mut_slice()[b] = S::one();
        system.triple(unit, theta, p, scratch);
        unit.as_mut_slice()[b] = S::zero();
        let pairs = scratch.as_slice()[..momenta].iter().zip(xi.as_slice());
        let product = pairs.fold(S::zero(), |sum, (&a, &x)| sum + a * x);
        out.as_mut_slice()[b] += half * product;
    }
}

impl<S, P, const STAGES: usize> NodePath<S, P, STAGES>
    for CayleyPath<S, P::State, P::Jacobian, STAGES>
where
    S: Scalar,
    P: CotangentPoisson<S> + CayleyPoisson<S>,
{
    fn new(system: &P, h: S) -> Self {
        const { assert!(STAGES <= 3, "the halves are those of up to three nodes") };
        let zero = system.zero_state();
        let tableau = gauss_tableau::<S, STAGES>();
        let (half, three_quarters) = (S::ratio(1.0, 2.0), S::ratio(3.0, 4.0));
        let halves = tableau
            .c
            .map(|c| half + three_quarters * (S::one() - (c + c)));
        Self {
            step: h,
            tableau,
            halves,
            nodes: core::array::from_fn(|_| Node::new(&zero)),
            first: zero.clone(),
            last: zero.clone(),
            start: zero.clone(),
            middle: zero.clone(),
            pushed: zero.clone(),
            end: copies(&zero),
            matrices: copies(&system.zero_jacobian()),
            columns: copies(&zero),
        }
    }

    fn nodes(&self) -> &[Node<P::State>; STAGES] {
        &self.nodes
    }

    fn nodes_mut(&mut self) -> &mut [Node<P::State>; STAGES] {
        &mut self.nodes
    }

    fn set(&mut self, system: &P, base: &P::State) {
        self.set_ends(system, base);
        let one = S::one();
        for i in 0..STAGES {
            let half = self.halves[i];
            let [total, ..] = &mut self.columns;
            total.fill(S::zero());
            total.axpy(half - one, &self.end[0]);
            total.axpy(-half, &self.start);
            let weights = self.tableau.b.iter().zip(&self.tableau.ratios[i]);
            for ((&b, &ratio), node) in weights.zip(&self.nodes) {
                total.axpy(b * (one - ratio - half), &node.change);
            }
            self.nodes[i].of_momentum.axpy(one, total);
        }
    }

    fn move_to_end(&mut self, system: &P, base: &P::State, mu: &mut P::State) {
        self.set_ends(system, base);
        mu.copy_from(&self.end[1]);
    }

    fn earlier_factor(&mut self, xi: &mut P::State) -> Option<Retraction> {
        self.set_points();
        xi.copy_from(&self.first);
        Some(Retraction::Cayley)
    }

    fn factor(&mut self, xi: &mut P::State) -> Retraction {
        self.set_points();
        xi.copy_from(&self.last);
        Retraction::Cayley
    }

    fn within_chart(&mut self, system: &P) -> S::Mask {
        self.set_points();
        cayley_chart(system, &self.first) & cayley_chart(system, &self.last)
    }
}
