//! The metriplectic term of a step along a discrete gradient.

use super::discrete_gradient::{DiscreteGradient, Entropy, GonzalezGradient, declared};
use super::kernels::multiply;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// What takes the place of `K grad S` in a step along a discrete gradient g of H, with the one of Gonzalez b of the entropy S:
///
/// `push = P K(m) P b - s w`, `P = 1 - g g^T/<g, g>`, `s = <b, v>`, `w = P b/<P b, P b>`
///
/// with the motion `v = T g` and the middle m of the step. Since `<g, push> = 0`, H changes by nothing; since `<b, w> = 1`, S changes by
/// `h <P b, K P b> >= 0`. Both hold to round-off at any step. The step stays symmetric, and of order 2: along the motion itself
/// `K g = 0` and `s = 0`. The last term is there because a discrete step may have `{S, H}` not zero; it is, for one, where S is a
/// quadratic Casimir.
///
/// Systems of this kind on the dual of a Lie algebra: A. Bloch, M. Farré Puiggalí, D. Martín de Diego, "Metriplectic Euler–Poincaré equations:
/// smooth and discrete dynamics", 2024, arXiv:2401.05220. The projection makes the discrete form one for every K.
#[derive(Clone, Debug)]
pub(super) struct Growth<S: Scalar, P: Poisson<S>> {
    entropy: GonzalezGradient<S, P, Entropy>,
    /// b, P b, K P b.
    b: P::State,
    inner: P::State,
    turned: P::State,
    metric: P::Jacobian,
    /// The push itself.
    push: P::State,
    /// `K grad S` at the middle, which is in the force.
    plain: P::State,
    slope_of_entropy: P::State,
    /// v, and what s multiplies.
    motion: P::State,
    across: P::State,
    derivative_of_b: P::Jacobian,
    /// That of the push, without that of `K grad S` at the middle.
    derivative: P::Jacobian,
    slopes: P::Jacobian,
    plain_slopes: P::Jacobian,
    hessian: P::Jacobian,
    /// Changes of b, g, P b and K P b with a coordinate.
    column: P::State,
    dg: P::State,
    inner_change: P::State,
    turned_change: P::State,
}

fn dot<S: Scalar, V: State<S>>(count: usize, a: &V, b: &V) -> S {
    let pairs = a.as_slice().iter().zip(b.as_slice()).take(count);
    let mut sum = S::zero();
    for (&a, &b) in pairs {
        sum += a * b;
    }
    sum
}

/// The inverse of a square, and 0 where that is not above another number.
fn inverse<S: Scalar>(square: S, least: S) -> S {
    let flat = square.less_equal(least);
    let inverse = S::one() / S::select(flat, S::one(), square);
    S::select(flat, S::zero(), inverse)
}

impl<S: Scalar, P: Poisson<S>> Growth<S, P> {
    /// The space of a system that is metriplectic.
    pub(super) fn of(system: &P) -> Option<Self> {
        if !system.is_metriplectic() {
            return None;
        }
        let zero = system.zero_state();
        Some(Self {
            entropy: GonzalezGradient::new(system),
            b: zero.clone(),
            inner: zero.clone(),
            turned: zero.clone(),
            metric: system.zero_jacobian(),
            push: zero.clone(),
            plain: zero.clone(),
            slope_of_entropy: zero.clone(),
            motion: zero.clone(),
            across: zero.clone(),
            derivative_of_b: system.zero_jacobian(),
            derivative: system.zero_jacobian(),
            slopes: system.zero_jacobian(),
            plain_slopes: system.zero_jacobian(),
            hessian: system.zero_jacobian(),
            column: zero.clone(),
            dg: zero.clone(),
            inner_change: zero.clone(),
            turned_change: zero,
        })
    }

    /// Sets the beginning of a step.
    pub(super) fn set_start(&mut self, system: &P, start: &P::State) {
        self.entropy.set_start(system, start);
    }

    /// Puts the push in the place of `K grad S`, with the discrete gradient g of H, the middle and the end of the step: `force` is added to the motion `T g`.
    pub(super) fn replace(
        &mut self,
        system: &P,
        [g, motion]: [&P::State; 2],
        [middle, end]: [&P::State; 2],
        force: &mut P::State,
    ) {
        self.entropy.value(system, end, &mut self.b);
        self.motion.copy_from(motion);
        self.set(system, g, middle);
        self.plain_force(system, middle);
        let count = declared(system);
        let parts = self.push.as_slice().iter().zip(self.plain.as_slice());
        let slots = force.as_mut_slice().iter_mut().zip(parts).take(count);
        for (slot, (&push, &plain)) in slots {
            *slot += push - plain;
        }
    }

    /// An entry of the derivative.
    pub(super) fn slope(&self, row: usize, column: usize) -> S {
        self.derivative.get(row, column)
    }

    fn plain_force(&mut self, system: &P, middle: &P::State) {
        system.entropy_gradient(middle, &mut self.slope_of_entropy);
        multiply(&self.metric, &self.slope_of_entropy, &mut self.plain);
    }

    /// `out = P v`.
    fn project(count: usize, g: &P::State, v: &P::State, out: &mut P::State) {
        let along = dot(count, g, v) * inverse(dot(count, g, g), S::zero());
        out.fill(S::zero());
        for index in 0..count {
            let entry = v.as_slice()[index] - along * g.as_slice()[index];
            out.as_mut_slice()[index] = entry;
        }
    }

    fn set(&mut self, system: &P, g: &P::State, middle: &P::State) {
        let count = declared(system);
        system.metric(middle, &mut self.metric);
        Self::project(count, g, &self.b, &mut self.inner);
        multiply(&self.metric, &self.inner, &mut self.turned);
        Self::project(count, g, &self.turned, &mut self.push);
        // where grad S is along grad H, b and g are parallel but for round-off: s vanishes, and w has no bound
        let least = S::epsilon() * S::from_f64(64.0);
        let least = least * least * dot(count, &self.b, &self.b);
        let weight = inverse(dot(count, &self.inner, &self.inner), least);
        let lost = self.lost(count);
        for index in 0..count {
            let across = weight * self.inner.as_slice()[index];
            self.across.as_mut_slice()[index] = across;
            self.push.as_mut_slice()[index] -= lost * across;
        }
    }

    /// s, and 0 where it is round-off.
    fn lost(&self, count: usize) -> S {
        let pairs = self.b.as_slice().iter().zip(self.motion.as_slice());
        let (mut sum, mut size) = (S::zero(), S::zero());
        for (&b, &v) in pairs.take(count) {
            sum += b * v;
            size += (b * v).abs();
        }
        let flat = sum
            .abs()
            .less_equal(size * S::epsilon() * S::from_f64(64.0));
        S::select(flat, S::zero(), sum)
    }

    /// Computes the derivative in the end of the step of what [`Growth::replace`] adds to the force, with the
    /// derivatives of g and of the motion. What s multiplies is held: s vanishes along the motion.
    pub(super) fn linearize(
        &mut self,
        system: &P,
        [g, motion]: [&P::State; 2],
        [middle, end]: [&P::State; 2],
        [slope_of_g, slope_of_motion]: [&P::Jacobian; 2],
    ) {
        let (count, half) = (declared(system), S::ratio(1.0, 2.0));
        self.entropy
            .linearize(system, end, &mut self.b, &mut self.derivative_of_b);
        self.motion.copy_from(motion);
        self.set(system, g, middle);
        self.plain_force(system, middle);
        system.metric_slope(middle, &self.inner, &mut self.slopes);
        system.metric_slope(middle, &self.slope_of_entropy, &mut self.plain_slopes);
        system.entropy_hessian(middle, &mut self.hessian);
        let square = inverse(dot(count, g, g), S::zero());
        let column_of = |matrix: &P::Jacobian, column: usize, out: &mut P::State| {
            for (row, slot) in out.as_mut_slice().iter_mut().enumerate() {
                *slot = matrix.get(row, column);
            }
        };
        // -dP v of a change of g
        let bent = |dg: &P::State, v: &P::State, row: usize| {
            let (along, slope, across) = (
                dot(count, g, v) * square,
                dot(count, dg, v) * square,
                dot(count, g, dg) * square,
            );
            let (g, dg) = (g.as_slice()[row], dg.as_slice()[row]);
            dg * along + g * (slope - (along + along) * across)
        };
        for column in 0..system.dimension() {
            column_of(slope_of_g, column, &mut self.dg);
            column_of(&self.derivative_of_b, column, &mut self.column);
            Self::project(count, g, &self.column, &mut self.inner_change);
            for row in 0..count {
                let entry = bent(&self.dg, &self.b, row);
                self.inner_change.as_mut_slice()[row] -= entry;
            }
            multiply(&self.metric, &self.inner_change, &mut self.turned_change);
            for row in 0..count {
                self.turned_change.as_mut_slice()[row] += half * self.slopes.get(row, column);
            }
            Self::project(count, g, &self.turned_change, &mut self.inner_change);
            let mut lost = dot(count, &self.column, &self.motion);
            for row in 0..count {
                lost += self.b.as_slice()[row] * slope_of_motion.get(row, column);
            }
            for row in 0..count {
                let mut entry =
                    self.inner_change.as_slice()[row] - bent(&self.dg, &self.turned, row);
                entry -= lost * self.across.as_slice()[row];
                let mut plain = self.plain_slopes.get(row, column);
                for index in 0..count {
                    plain += self.metric.get(row, index) * self.hessian.get(index, column);
                }
                entry -= half * plain;
                self.derivative.set(row, column, entry);
            }
        }
    }
}
