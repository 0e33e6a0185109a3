//! Generating functions of any Poisson bracket in the coordinates (X, p) of its flat spray, by dual numbers.
//!
//! With `g = h grad H`, `f = Pi g`, `w = h H'' f`, `a = Pi'[f] g`, `c = Pi''[f, f] g`, `eta = 24 h^3 grad S3`:
//! `24 h^3 S3 = <w, f>`, and
//! `5760 h^5 S5 = -4 <a, eta> + 12 <w, Pi eta> + 4 h H''(a, a) + 12 <w, c> + 12 h H'''(f, f, a) + 3 h H''''(f, f, f, f)`.

use super::derivatives::{fourth, scale, second, seeded, third};
use super::slopes::started;
use crate::generic::multiply;
use crate::matrix::SquareMatrix;
use crate::poisson::{Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::{State, dot};

/// g, f and w at a point, and the Poisson matrix.
struct Flow<V, M> {
    g: V,
    f: V,
    w: V,
    matrix: M,
}

impl<V, M> Flow<V, M> {
    fn at<S, P>(system: &P, h: S, x: &V) -> Self
    where
        S: Scalar,
        P: Lift<S> + Poisson<S, State = V, Jacobian = M>,
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let mut flow = Self {
            g: system.zero_state(),
            f: system.zero_state(),
            w: system.zero_state(),
            matrix: system.zero_jacobian(),
        };
        system.gradient(x, &mut flow.g);
        scale(h, &mut flow.g);
        system.poisson_matrix(x, &mut flow.matrix);
        multiply(&flow.matrix, &flow.g, &mut flow.f);
        second((system, h), x, &flow.f, &mut flow.w);
        flow
    }
}

/// `eta = h H'''(f, f, .) + 2 (D(Pi g)^T w - h H'' Pi w)`, 24 times the gradient of S3 of `h H`.
fn third_order<S: Scalar, P: Lift<S>>(
    system: &P,
    h: S,
    x: &P::State,
    flow: &Flow<P::State, P::Jacobian>,
    eta: &mut P::State,
) {
    let two = S::from_f64(2.0);
    let (mut part, mut turned) = (system.zero_state(), system.zero_state());
    third((system, h), x, &flow.f, &flow.f, eta);
    let mut matrix = system.zero_jacobian();
    system.poisson_slope(x, &flow.g, &mut matrix);
    for (column, entry) in eta.as_mut_slice().iter_mut().enumerate() {
        for (row, &w) in flow.w.as_slice().iter().enumerate() {
            *entry += two * matrix.get(row, column) * w;
        }
    }
    multiply(&flow.matrix, &flow.w, &mut turned);
    second((system, h), x, &turned, &mut part);
    eta.axpy(-two, &part);
}

/// `grad (h H + h^3 S3)`.
pub(super) fn fourth_order<S: Scalar, P: Lift<S>>(
    system: &P,
    h: S,
    x: &P::State,
    out: &mut P::State,
) {
    // S3 of H alone: its cube with h may leave the range of numbers
    let flow = Flow::at(system, S::one(), x);
    let mut eta = system.zero_state();
    third_order(system, S::one(), x, &flow, &mut eta);
    started(h, &flow.g, h * h * h * S::ratio(1.0, 24.0), &eta, out);
}

/// `5760 h^5 S5`.
fn fifth<S: Scalar, P: Lift<S>>(system: &P, h: S, x: &P::State) -> S {
    let zero = system.zero_state();
    let number = S::from_f64;
    let flow = Flow::at(system, h, x);
    let Flow { g, f, w, matrix } = &flow;
    let mut eta = zero.clone();
    third_order(system, h, x, &flow, &mut eta);
    // a, and c: the derivative along f of the first, where g and the last f are held
    let lifted = system.lift();
    let moved = seeded(&lifted, x.as_slice(), Some(f.as_slice()));
    let held = seeded(&lifted, g.as_slice(), None);
    let mut slopes = lifted.zero_jacobian();
    lifted.poisson_slope(&moved, &held, &mut slopes);
    let (mut a, mut c) = (zero.clone(), zero.clone());
    for row in 0..system.dimension() {
        for (column, &f) in f.as_slice().iter().enumerate() {
            let entry = slopes.get(row, column);
            a.as_mut_slice()[row] += entry.value * f;
            c.as_mut_slice()[row] += entry.derivative * f;
        }
    }
    let (mut part, mut turned) = (zero.clone(), zero);
    multiply(matrix, &eta, &mut turned);
    let mut sum = number(12.0) * (dot(w, &turned) + dot(w, &c)) - number(4.0) * dot(&a, &eta);
    second((system, h), x, &a, &mut part);
    sum += number(4.0) * dot(&part, &a);
    third((system, h), x, f, f, &mut part);
    sum += number(12.0) * dot(&part, &a);
    fourth((system, h), x, f, f, f, &mut part);
    sum + number(3.0) * dot(&part, f)
}

/// `grad (h H + h^3 S3 + h^5 S5)`.
pub(super) fn sixth_order<S, P>(system: &P, h: S, x: &P::State, out: &mut P::State)
where
    S: Scalar,
    P: Lift<S>,
{
    let flow = Flow::at(system, h, x);
    let mut eta = system.zero_state();
    third_order(system, h, x, &flow, &mut eta);
    started(S::one(), &flow.g, S::ratio(1.0, 24.0), &eta, out);
    let lifted = system.lift();
    let h = Dual::constant_of(h);
    let mut along = seeded(&lifted, x.as_slice(), None);
    for (index, entry) in out.as_mut_slice().iter_mut().enumerate() {
        along.as_mut_slice()[index].derivative = S::one();
        *entry += S::ratio(1.0, 5760.0) * fifth(&lifted, h, &along).derivative;
        along.as_mut_slice()[index].derivative = S::zero();
    }
}
