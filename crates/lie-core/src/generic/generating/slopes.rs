//! Gradients of generating functions, by adjoints: the reverse of
//! `p -> xi = grad H -> X = ad*_xi p -> w = H''X, X2 = ad*_xi X, Y = ad*_w p -> S`.
//!
//! Two rules carry all of it. For `B = ad*_u m` and a covector `lambda` in g of B, the adjoint of m
//! is `[u, lambda]` and that of u is `-ad*_lambda m`; for `w = H''(p) v`, the adjoint of v is
//! `H'' lambda` and that of p is `H'''(v, lambda, .)`.

use super::derivatives::{fifth, fourth, scale, second, seeded, slope, third};
use crate::matrix::SquareMatrix;
use crate::poisson::{CayleyPoisson, LiePoisson, Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::State;

/// `xi`, X and w at a point.
struct Flow<V> {
    xi: V,
    x: V,
    w: V,
}

impl<V> Flow<V> {
    fn at<S: Scalar, P: Lift<S> + LiePoisson<S, State = V>>(system: &P, h: S, p: &V) -> Self
    where
        V: State<S>,
    {
        let mut flow = Self {
            xi: system.zero_state(),
            x: system.zero_state(),
            w: system.zero_state(),
        };
        system.gradient(p, &mut flow.xi);
        scale(h, &mut flow.xi);
        system.ad_star(&flow.xi, p, &mut flow.x);
        second((system, h), p, &flow.x, &mut flow.w);
        flow
    }
}

/// `grad H''(X, X) = H'''(X, X, .) + 2 ([xi, w] - H'' ad*_w p)`, and `Y = ad*_w p`.
fn of_square<S: Scalar, P: Lift<S> + LiePoisson<S>>(
    system: &P,
    h: S,
    p: &P::State,
    flow: &Flow<P::State>,
    y: &mut P::State,
    out: &mut P::State,
) {
    let mut part = system.zero_state();
    third((system, h), p, &flow.x, &flow.x, out);
    system.ad(&flow.xi, &flow.w, &mut part);
    out.axpy(S::from_f64(2.0), &part);
    system.ad_star(&flow.w, p, y);
    second((system, h), p, y, &mut part);
    out.axpy(S::from_f64(-2.0), &part);
}

/// `h grad H + weight * eta`
pub(super) fn started<S: Scalar, V: State<S>>(h: S, xi: &V, weight: S, eta: &V, out: &mut V) {
    out.fill(S::zero());
    out.axpy(h, xi);
    out.axpy(weight, eta);
}

/// `grad (h H + h^3 S3)` in exponential coordinates.
pub(super) fn exp4<S: Scalar, P: Lift<S> + LiePoisson<S>>(
    system: &P,
    h: S,
    p: &P::State,
    out: &mut P::State,
) {
    let flow = Flow::at(system, S::one(), p);
    let (mut y, mut eta) = (system.zero_state(), system.zero_state());
    of_square(system, S::one(), p, &flow, &mut y, &mut eta);
    started(h, &flow.xi, h * h * h * S::ratio(1.0, 24.0), &eta, out);
}

/// 24 times the gradient of S3 of `h H` alone, for its derivative along a direction.
fn eta_of<S: Scalar, P: Lift<S> + LiePoisson<S>>(
    system: &P,
    h: S,
    p: &P::State,
    out: &mut P::State,
) {
    let flow = Flow::at(system, h, p);
    let mut y = system.zero_state();
    of_square(system, h, p, &flow, &mut y, out);
}

/// The derivatives of a function by p and by what it is computed from.
struct Adjoints<V> {
    p: V,
    x: V,
    x2: V,
    y: V,
}

impl<V> Adjoints<V> {
    /// Those of 5760 S5, where p, X, X2 and Y stand in it; what p does through eta is given.
    fn of_s5<S, P>(system: &P, h: S, p: &V, (x, x2): (&V, &V), eta: &V, through_eta: &V) -> Self
    where
        S: Scalar,
        V: State<S>,
        P: Lift<S> + LiePoisson<S, State = V>,
    {
        let number = S::from_f64;
        let zero = system.zero_state();
        let mut part = zero.clone();
        let mut of_p = zero.clone();
        of_p.axpy(number(-4.0), through_eta);
        third((system, h), p, x2, x2, &mut part);
        of_p.axpy(number(4.0), &part);
        fourth((system, h), p, x, x, x2, &mut part);
        of_p.axpy(number(12.0), &part);
        fifth((system, h), p, x, x, x, x, &mut part);
        of_p.axpy(number(3.0), &part);

        let mut of_x2 = zero.clone();
        of_x2.axpy(number(-4.0), eta);
        second((system, h), p, x2, &mut part);
        of_x2.axpy(number(8.0), &part);
        third((system, h), p, x, x, &mut part);
        of_x2.axpy(number(12.0), &part);

        let mut of_x = zero.clone();
        third((system, h), p, x, x2, &mut part);
        of_x.axpy(number(24.0), &part);
        fourth((system, h), p, x, x, x, &mut part);
        of_x.axpy(number(12.0), &part);

        let mut of_y = zero;
        of_y.axpy(number(-12.0), eta);
        Self {
            p: of_p,
            x: of_x,
            x2: of_x2,
            y: of_y,
        }
    }
}

/// The derivative by p in all, backwards through Y, w, X2, X and xi.
fn back_to_p<S: Scalar, P: Lift<S> + LiePoisson<S>>(
    system: &P,
    h: S,
    p: &P::State,
    flow: &Flow<P::State>,
    adjoints: Adjoints<P::State>,
) -> P::State {
    let Flow { xi, x, w } = flow;
    let Adjoints {
        p: mut of_p,
        x: mut of_x,
        x2: of_x2,
        y: of_y,
    } = adjoints;
    let mut part = system.zero_state();
    // Y = ad*_w p
    let mut of_w = system.zero_state();
    system.ad_star(&of_y, p, &mut part);
    of_w.axpy(-S::one(), &part);
    system.ad(w, &of_y, &mut part);
    of_p.axpy(S::one(), &part);
    // w = H''(p) X
    second((system, h), p, &of_w, &mut part);
    of_x.axpy(S::one(), &part);
    third((system, h), p, x, &of_w, &mut part);
    of_p.axpy(S::one(), &part);
    // X2 = ad*_xi X
    let mut of_xi = system.zero_state();
    system.ad(xi, &of_x2, &mut part);
    of_x.axpy(S::one(), &part);
    system.ad_star(&of_x2, x, &mut part);
    of_xi.axpy(-S::one(), &part);
    // X = ad*_xi p
    system.ad(xi, &of_x, &mut part);
    of_p.axpy(S::one(), &part);
    system.ad_star(&of_x, p, &mut part);
    of_xi.axpy(-S::one(), &part);
    // xi = grad H(p)
    second((system, h), p, &of_xi, &mut part);
    of_p.axpy(S::one(), &part);
    of_p
}

/// `grad (h H + h^3 S3 + h^5 S5)` in exponential coordinates, with
/// `5760 S5 = -4 <X2 + 3 Y, eta> + 4 H''(X2, X2) + 12 H'''(X, X, X2) + 3 H''''(X, X, X, X)`
/// and `eta = 24 grad S3`, all of them of `h H`: powers of h apart from what they multiply would leave the range of numbers.
pub(super) fn exp6<S, P>(system: &P, h: S, p: &P::State, out: &mut P::State)
where
    S: Scalar,
    P: Lift<S> + LiePoisson<S>,
    P::Lifted: LiePoisson<Dual<S>>,
{
    let zero = system.zero_state();
    let flow = Flow::at(system, h, p);
    let Flow { xi, x, .. } = &flow;
    let (mut y, mut eta) = (zero.clone(), zero.clone());
    of_square(system, h, p, &flow, &mut y, &mut eta);
    started(S::one(), xi, S::ratio(1.0, 24.0), &eta, out);

    let mut x2 = zero;
    system.ad_star(xi, x, &mut x2);
    let mut moved = x2.clone();
    moved.axpy(S::from_f64(3.0), &y);
    // through eta: its derivative is symmetric, so that its adjoint is its derivative along X2 + 3 Y
    let lifted = system.lift();
    let q = seeded(&lifted, p.as_slice(), Some(moved.as_slice()));
    let mut along = lifted.zero_state();
    eta_of(&lifted, Dual::constant_of(h), &q, &mut along);
    let mut through_eta = system.zero_state();
    slope(&along, &mut through_eta);

    let adjoints = Adjoints::of_s5(system, h, p, (x, &x2), &eta, &through_eta);
    let of_p = back_to_p(system, h, p, &flow, adjoints);
    out.axpy(S::ratio(1.0, 5760.0), &of_p);
}

/// `grad (h H + h^3 S3)` in Cayley coordinates. The gradient of `<p, T(xi, xi, xi)>` in xi is
/// `ad*_xi ad*_xi p + 3 Q`, `Q_b = T_abc^d xi^a xi^c p_d`; in p it is `T(xi, xi, xi)` itself.
pub(super) fn cayley4<S, P>(system: &P, h: S, p: &P::State, out: &mut P::State)
where
    S: Scalar,
    P: Lift<S> + CayleyPoisson<S>,
{
    let zero = system.zero_state();
    let flow = Flow::at(system, S::one(), p);
    let (mut y, mut eta, mut part) = (zero.clone(), zero.clone(), zero.clone());
    of_square(system, S::one(), p, &flow, &mut y, &mut eta);
    let mut of_xi = zero.clone();
    system.ad_star(&flow.xi, &flow.x, &mut part);
    of_xi.axpy(S::one(), &part);
    system.triple(&flow.xi, &flow.xi, p, &mut part);
    of_xi.axpy(S::from_f64(3.0), &part);
    second((system, S::one()), p, &of_xi, &mut part);
    eta.axpy(S::from_f64(-2.0), &part);
    let mut unit = zero;
    for d in 0..system.dimension() {
        unit.fill(S::zero());
        unit.as_mut_slice()[d] = S::one();
        system.triple(&flow.xi, &flow.xi, &unit, &mut part);
        let mut cube = S::zero();
        for (&a, &b) in flow.xi.as_slice().iter().zip(part.as_slice()) {
            cube += a * b;
        }
        eta.as_mut_slice()[d] += S::from_f64(-2.0) * cube;
    }
    started(h, &flow.xi, h * h * h * S::ratio(1.0, 24.0), &eta, out);
}

/// `grad (h H + h^2 S2)` in coordinates of the second kind. With the upper half U of the Poisson
/// matrix, `2 S2 = xi.U xi`: the gradient in xi is `(U + U^T) xi`, that in p is
/// `sum_j [xi_j e_j, (xi_1, …, xi_(j-1))]`.
pub(super) fn second_kind<S: Scalar, P: Lift<S> + LiePoisson<S>>(
    system: &P,
    h: S,
    p: &P::State,
    out: &mut P::State,
) {
    let zero = system.zero_state();
    let (mut xi, mut of_xi, mut part) = (zero.clone(), zero.clone(), zero.clone());
    system.gradient(p, &mut xi);
    let mut poisson_matrix = system.zero_jacobian();
    system.poisson_matrix(p, &mut poisson_matrix);
    for row in 0..system.dimension() {
        for column in row + 1..system.dimension() {
            let entry = poisson_matrix.get(row, column);
            of_xi.as_mut_slice()[row] += entry * xi.as_slice()[column];
            of_xi.as_mut_slice()[column] += entry * xi.as_slice()[row];
        }
    }
    let mut eta = zero.clone();
    second((system, S::one()), p, &of_xi, &mut eta);
    let (mut one, mut before) = (zero.clone(), zero);
    for j in 0..system.dimension() {
        one.fill(S::zero());
        one.as_mut_slice()[j] = xi.as_slice()[j];
        system.ad(&one, &before, &mut part);
        eta.axpy(S::one(), &part);
        before.as_mut_slice()[j] = xi.as_slice()[j];
    }
    started(h, &xi, h * h * S::ratio(1.0, 2.0), &eta, out);
}
