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

/// The velocity of a momentum: `l'(out) = mu`.
// once for all that ask for it
#[inline(never)]
pub fn velocity<S: Scalar, P: LagrangianPoisson<S>>(system: &P, mu: &P::State, out: &mut P::State) {
    let branch = system.branch();
    let from = if branch.is_some() {
        From::Branch
    } else {
        From::Rest
    };
    match &branch {
        Some(branch) => out.copy_from(branch),
        None => out.fill(S::zero()),
    }
    solve(
        |xi, momentum| system.momentum(xi, momentum),
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
    let mut moved = S::zero();
    for (&here, &before) in xi.as_slice().iter().zip(last.as_slice()) {
        moved = moved.max((here - before).abs());
    }
    let far = S::from_f64(FOLLOW) * size(&last);
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
    for (&mu, &xi) in mu.as_slice().iter().zip(xi.as_slice()) {
        pairing += mu * xi;
    }
    pairing - system.lagrangian(&xi)
}

/// The Hessian `H''(mu) = l''(xi)^-1`.
pub fn hessian<S: Scalar, P: LagrangianPoisson<S>>(
    system: &P,
    mu: &P::State,
    out: &mut P::Jacobian,
) {
    let mut xi = system.zero_state();
    velocity(system, mu, &mut xi);
    let mut inertia = system.zero_jacobian();
    system.inertia(&xi, &mut inertia);
    exchanging::invert(&mut inertia, out);
}

/// The largest value, derivatives left aside.
pub(super) fn size<S: Scalar>(vector: &impl State<S>) -> S {
    let entries = vector.as_slice().iter();
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
/// the latter. The lanes without a solution are not a number.
pub fn solve<S, V, M>(
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
    let sign_at_start = exchanging::solve(matrix, &mut step);
    let reached = newton(&map, &slope, mu, xi, matrix);
    let mut failed = !reached;
    for lane in 0..S::LANES {
        let mut end = start.clone();
        if failed.lane(lane) && path::follow(&map, &slope, mu, from, lane, &mut end, matrix) {
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
        let sign = exchanging::solve(matrix, &mut step);
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
        let defect = size(&step);
        let round_off = S::from_f64(16.0) * S::epsilon() * (size(mu) + largest(matrix) * size(xi));
        exchanging::solve(matrix, &mut step);
        let length = size(&step);
        let close = length.less_equal(S::from_f64(NEAR) * S::epsilon() * size(xi))
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

/// The largest entry, derivatives left aside.
fn largest<S: Scalar, M: SquareMatrix<S>>(matrix: &M) -> S {
    let size = matrix.dimension();
    (0..size * size).fold(S::zero(), |norm, index| {
        norm.max(matrix.get(index / size, index % size).abs())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Dual;
    use nalgebra::{SMatrix, SVector};

    type V<S> = SVector<S, 1>;

    /// Solves `map(xi) = mu` in one variable.
    fn root<S: Scalar>(map: fn(S) -> S, slope: fn(S) -> S, mu: S) -> S {
        let mut xi = V::from([S::zero()]);
        let mut matrix = SMatrix::<S, 1, 1>::repeat(S::zero());
        solve(
            |xi: &V<S>, out: &mut V<S>| out[0] = map(xi[0]),
            |xi: &V<S>, out: &mut SMatrix<S, 1, 1>| out[(0, 0)] = slope(xi[0]),
            &V::from([mu]),
            From::Rest,
            &mut xi,
            &mut matrix,
        );
        xi[0]
    }

    /// `l = -sqrt(1 - xi^2)`: `mu = xi/sqrt(1 - xi^2)`, a full step from rest leaves the domain.
    fn relativistic<S: Scalar>(xi: S) -> S {
        xi / (S::one() - xi * xi).sqrt()
    }

    fn relativistic_slope<S: Scalar>(xi: S) -> S {
        let root = (S::one() - xi * xi).sqrt();
        S::one() / (root * root * root)
    }

    fn cubic<S: Scalar>(xi: S) -> S {
        xi + xi * xi * xi
    }

    fn cubic_slope<S: Scalar>(xi: S) -> S {
        S::one() + S::from_f64(3.0) * xi * xi
    }

    /// `l = xi^2/2 - xi^4/12` has momenta up to 2/3 on the branch through rest, and beyond its folds others.
    #[test]
    fn no_velocity_beyond_a_fold() {
        fn map<S: Scalar>(xi: S) -> S {
            xi - xi * xi * xi * S::ratio(1.0, 3.0)
        }
        fn slope<S: Scalar>(xi: S) -> S {
            S::one() - xi * xi
        }
        for mu in [0.0, 0.3, -0.6] {
            let xi = root::<f64>(map, slope, mu);
            assert!(xi.abs() < 1.0 && (map(xi) - mu).abs() < 1e-15, "{mu}: {xi}");
        }
        for mu in [0.7, 3.0, -5.0] {
            assert!(root::<f64>(map, slope, mu).is_nan(), "{mu}");
        }
    }

    #[test]
    fn closed_forms() {
        for mu in [0.0, 1e-12, 0.3, -1.0, 7.0, 1e3] {
            let xi = root(relativistic, relativistic_slope, mu);
            let exact = mu / (1.0 + mu * mu).sqrt();
            assert!(
                (xi - exact).abs() <= 4e-16 * exact.abs(),
                "{mu}: {xi} {exact}"
            );
            // sinh(3 arsinh) solves the cubic
            let xi = root(cubic, cubic_slope, mu);
            let c = 2.0 / 3.0_f64.sqrt();
            let exact = c * ((1.5 * 3.0_f64.sqrt() * mu).asinh() / 3.0).sinh();
            assert!(
                (xi - exact).abs() <= 1e-15 * exact.abs(),
                "{mu}: {xi} {exact}"
            );
            let single = root(cubic, cubic_slope, mu as f32);
            assert!(
                (f64::from(single) - exact).abs() <= 4e-7 * exact.abs(),
                "{mu}"
            );
        }
    }

    /// `xi = mu/sqrt(1 + mu^2)` has the derivatives `r^-3`, `-3 mu r^-5`, `(12 mu^2 - 3) r^-7`.
    #[test]
    fn derivatives_are_exact() {
        let mu = 0.75_f64;
        let nested = Dual::new(
            Dual::new(Dual::variable(mu), Dual::one()),
            Dual::new(Dual::one(), Dual::zero()),
        );
        let xi = root(relativistic, relativistic_slope, nested);
        let r = (1.0 + mu * mu).sqrt();
        let first = xi.value.value.derivative;
        assert!((first - r.powi(-3)).abs() < 1e-15);
        let second = xi.value.derivative.derivative;
        assert!((second + 3.0 * mu * r.powi(-5)).abs() < 4e-15);
        let third = xi.derivative.derivative.derivative;
        assert!((third - (12.0 * mu * mu - 3.0) * r.powi(-7)).abs() < 4e-14);
    }

    #[test]
    fn what_has_no_velocity_is_not_a_number() {
        // l = log cosh xi: |mu| < 1
        let map = |xi: f64| xi.tanh();
        let slope = |xi: f64| 1.0 - xi.tanh().powi(2);
        assert!((root(map, slope, 0.5) - 0.5_f64.atanh()).abs() < 1e-15);
        assert!(root(map, slope, 1.5).is_nan());
        assert!(root(map, slope, f64::NAN).is_nan());
        // singular at rest
        assert!(!root(|xi: f64| xi.powi(3), |xi| 3.0 * xi * xi, 1.0).is_finite());
    }

    #[cfg(feature = "lanes")]
    #[test]
    fn a_lane_has_the_bits_of_a_run_of_its_own() {
        use crate::scalar::F64x4;
        let values = [0.3, 2000.0, -5.0, 1e-9];
        let mut mu = F64x4::zero();
        for (lane, value) in values.into_iter().enumerate() {
            mu = mu.with_lane(lane, value);
        }
        let xi = root(relativistic, relativistic_slope, mu);
        for (lane, value) in values.into_iter().enumerate() {
            assert_eq!(xi.lane(lane), root(relativistic, relativistic_slope, value));
        }
    }
}
