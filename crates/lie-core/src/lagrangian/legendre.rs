//! The Legendre transform by Newton's iteration: velocity, Hamiltonian and Hessian of a Lagrangian that is not
//! quadratic in the velocity.
//!
//! ```math
//! l'(\xi) = \mu, \qquad H(\mu) = \langle \mu, \xi \rangle - l(\xi), \qquad
//! \nabla H(\mu) = \xi, \qquad H''(\mu) = l''(\xi)^{-1}
//! ```
//!
//! There may be several velocities with the same momentum. The one that is meant lies at the end of a path of
//! velocities: from a known one, with the momentum `$\mu_a$`, along `$l'(\xi_s) = \mu_a + s (\mu - \mu_a)$`, s from 0 to 1.
//! Newton's iteration goes there at once where its steps shrink fast enough that it cannot end elsewhere (by the
//! theorem of Newton and Kantorovich the path then lies in the ball in which it converges), and in pieces where
//! they do not. The known velocity is the rest, or that of the branch of a system
//! ([`LagrangianPoisson::branch`]), which a run carries along with the state.
//!
//! From rest the path goes on through folds of `$l'$`, where `$l''$` is singular and s turns round, to the first
//! velocity with the momentum: where there is just one, it is found behind folds too. From a branch it does not.
//! Where it ends, the result is not a number, and the driver refuses the step.
//!
//! A Lagrangian `$L(\xi, q)$` may depend on coordinates q beside the momenta, those of the group element and the time
//! ([`LagrangianPoisson::velocities`]). They are given: with `$L_{\xi}(\xi, q) = \mu$`
//!
//! ```math
//! \nabla H = (\xi, -L_q), \qquad
//! H'' = \begin{pmatrix} A^{-1} & -A^{-1} B \\ -B^T A^{-1} & B^T A^{-1} B - L_{qq} \end{pmatrix}, \qquad
//! A = L_{\xi\xi}, \; B = L_{\xi q}
//! ```
//!
//! Over dual numbers the iteration goes on after the values have converged until all derivatives have, which
//! it doubles in order each time: they are exact to round-off. Nothing is allocated.
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::LagrangianPoisson;
use super::path;
use crate::matrix::SquareMatrix;
use crate::newton::exchanging;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Iterations towards one momentum. One that shrinks the steps as fast as is asked for needs fewer.
const ITERATIONS: usize = 24;
/// The last step that needs another one, in units of round-off.
const NEAR: f64 = 1024.0;
/// How much the velocity may differ from that of the branch, relative to its size, before the branch follows.
const FOLLOW: f64 = 0.125;

/// The velocity of a momentum: `l'(out) = mu`. Coordinates that are no momenta stay what they are in mu.
// once for all that ask for it
#[inline(never)]
pub fn velocity<S: Scalar, P: LagrangianPoisson<S>>(system: &P, mu: &P::State, out: &mut P::State) {
    let count = system.velocities();
    let branch = system.branch();
    let from = if branch.is_some() {
        From::Branch
    } else {
        From::Rest
    };
    out.copy_from(mu);
    for (i, entry) in out.as_mut_slice()[..count].iter_mut().enumerate() {
        *entry = branch
            .as_ref()
            .map_or(S::zero(), |known| known.as_slice()[i]);
    }
    solve(
        count,
        |xi, momentum| {
            system.momentum(xi, momentum);
            momentum.as_mut_slice()[count..].copy_from_slice(&xi.as_slice()[count..]);
        },
        |xi, inertia| system.inertia(xi, inertia),
        mu,
        from,
        out,
        &mut system.zero_jacobian(),
    );
}

/// The velocity of a momentum, where a branch should go on from it: where it has moved away from that of the branch.
/// In lanes without a velocity that of the branch, or rest.
pub fn follow<S: Scalar, P: LagrangianPoisson<S>>(system: &P, mu: &P::State) -> Option<P::State> {
    let mut xi = system.zero_state();
    velocity(system, mu, &mut xi);
    let known = xi.finite();
    let branch = system.branch();
    if !known.any() {
        return None;
    }
    let last = branch.clone().unwrap_or_else(|| system.zero_state());
    let (mut moved, mut large) = (S::zero(), S::zero());
    let pairs = xi.as_slice().iter().zip(last.as_slice());
    for (&here, &before) in pairs.take(system.velocities()) {
        moved = moved.max((here - before).abs());
        large = large.max(before.abs());
    }
    let far = S::from_f64(FOLLOW) * large;
    if branch.is_some() && !(known & far.less(moved)).any() {
        return None;
    }
    let mut next = last;
    next.assign_where(known, &xi);
    Some(next)
}

/// The Hamiltonian `H(mu) = <mu, xi> - l(xi)`.
pub fn hamiltonian<S: Scalar, P: LagrangianPoisson<S>>(system: &P, mu: &P::State) -> S {
    let mut xi = system.zero_state();
    velocity(system, mu, &mut xi);
    let mut pairing = S::zero();
    let pairs = mu.as_slice().iter().zip(xi.as_slice());
    for (&mu, &xi) in pairs.take(system.velocities()) {
        pairing += mu * xi;
    }
    pairing - system.lagrangian(&xi)
}

/// The gradient of H: the velocity, and by the coordinates that are no momenta `-dL/dq`.
pub fn gradient<S: Scalar, P: LagrangianPoisson<S>>(system: &P, mu: &P::State, out: &mut P::State) {
    let count = system.velocities();
    velocity(system, mu, out);
    if count == mu.as_slice().len() {
        return;
    }
    let mut slope = system.zero_state();
    system.momentum(out, &mut slope);
    for (entry, &slope) in out
        .as_mut_slice()
        .iter_mut()
        .zip(slope.as_slice())
        .skip(count)
    {
        *entry = -slope;
    }
}

/// The Hessian `H''(mu) = l''(xi)^-1`, with the blocks of the [module's text](self) where not all coordinates are momenta.
pub fn hessian<S: Scalar, P: LagrangianPoisson<S>>(
    system: &P,
    mu: &P::State,
    out: &mut P::Jacobian,
) {
    let mut xi = system.zero_state();
    velocity(system, mu, &mut xi);
    let mut inertia = system.zero_jacobian();
    system.inertia(&xi, &mut inertia);
    let (count, size) = (system.velocities(), inertia.dimension());
    let whole = (count < size).then(|| inertia.clone());
    exchanging::invert_leading(count, &mut inertia, out);
    let Some(whole) = whole else { return };
    for column in count..size {
        for row in 0..count {
            let products = (0..count).map(|k| out.get(row, k) * whole.get(k, column));
            let sum = products.fold(S::zero(), |sum, product| sum + product);
            out.set(row, column, -sum);
            out.set(column, row, -sum);
        }
    }
    for row in count..size {
        for column in count..size {
            let products = (0..count).map(|k| whole.get(k, row) * out.get(k, column));
            let sum = products.fold(whole.get(row, column), |sum, product| sum + product);
            out.set(row, column, -sum);
        }
    }
}

/// The largest of the first values, derivatives left aside.
pub(super) fn size<S: Scalar>(vector: &impl State<S>, count: usize) -> S {
    let entries = vector.as_slice()[..count].iter();
    entries.fold(S::zero(), |norm, entry| norm.max(entry.abs()))
}

/// Where a path of velocities begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum From {
    /// At rest: the path may pass folds.
    Rest,
    /// At a velocity of the branch that is meant: the path ends at a fold.
    Branch,
}

/// Solves `map(xi) = mu` for a map with the derivative `slope`, along a path that begins at `xi`; `matrix` is space for
/// the latter. The first `count` components are looked for, and of the derivative no others are used. The others are given: alike in `mu`, `xi`
/// and the value of the map. Their sizes say nothing of how near a velocity is. The lanes without a solution are not a number.
pub fn solve<S, V, M>(
    count: usize,
    map: impl Fn(&V, &mut V),
    slope: impl Fn(&V, &mut M),
    mu: &V,
    from: From,
    xi: &mut V,
    matrix: &mut M,
) where
    S: Scalar,
    V: State<S>,
    M: SquareMatrix<S>,
{
    let start = xi.clone();
    let mut step = mu.clone();
    slope(&start, matrix);
    let sign_at_start = exchanging::solve_block(0..count, matrix, &mut step);
    let reached = newton(count, &map, &slope, mu, xi, matrix);
    let mut failed = !reached;
    for lane in 0..S::LANES {
        let mut end = start.clone();
        if failed.lane(lane)
            && path::follow(count, (&map, &slope), mu, from, lane, &mut end, matrix)
        {
            let only = S::Mask::from_bits(1 << lane);
            xi.assign_where(only, &end);
            failed = failed & !only;
        }
    }
    // values that are near enough are at round-off after one more iteration, and the number of derivatives
    // that are exact doubles in each
    for _ in 0..=(S::DERIVATIVES + 1).ilog2() + u32::from(S::DERIVATIVES > 0) {
        map(xi, &mut step);
        step.axpy(-S::one(), mu);
        slope(xi, matrix);
        let sign = exchanging::solve_block(0..count, matrix, &mut step);
        failed = failed | (sign * sign_at_start).less(S::zero());
        xi.axpy(-S::one(), &step);
    }
    let not_a_number = S::zero() / S::zero();
    for entry in xi.as_mut_slice() {
        *entry = S::select(failed, not_a_number, *entry);
    }
}

/// Newton's iteration for `map(xi) = mu` from `xi`. Returns the lanes that have come near the solution with steps each
/// of which was at most a quarter of the one before.
pub(super) fn newton<S, V, M>(
    count: usize,
    map: &impl Fn(&V, &mut V),
    slope: &impl Fn(&V, &mut M),
    mu: &V,
    xi: &mut V,
    matrix: &mut M,
) -> S::Mask
where
    S: Scalar,
    V: State<S>,
    M: SquareMatrix<S>,
{
    let quarter = S::ratio(1.0, 4.0);
    let mut step = mu.clone();
    let mut bound = S::from_f64(f64::INFINITY);
    let mut open = S::Mask::splat(true);
    let mut near = S::Mask::splat(false);
    for _ in 0..ITERATIONS {
        map(xi, &mut step);
        step.axpy(-S::one(), mu);
        slope(xi, matrix);
        let defect = size(&step, count);
        let speed = size(xi, count);
        let terms = size(mu, count) + largest(matrix, count) * speed;
        let round_off = S::from_f64(16.0) * S::epsilon() * terms;
        exchanging::solve_block(0..count, matrix, &mut step);
        let length = size(&step, count);
        let close = length.less_equal(S::from_f64(NEAR) * S::epsilon() * speed)
            | (defect.less_equal(round_off) & length.finite());
        near = near | (open & close);
        open = open & !close & length.less_equal(bound) & length.finite();
        xi.subtract_where(open, &step);
        bound = quarter * length;
        if !open.any() {
            break;
        }
    }
    near
}

/// The largest entry of the first rows and columns, derivatives left aside.
fn largest<S: Scalar, M: SquareMatrix<S>>(matrix: &M, size: usize) -> S {
    (0..size * size).fold(S::zero(), |norm, index| {
        norm.max(matrix.get(index / size, index % size).abs())
    })
}

#[cfg(test)]
mod tests;
