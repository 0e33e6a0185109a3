//! The Hopf map: points of `T*R^2` over each spin.

use super::StageSlopes;
use super::lifts::LinearLift;
use crate::methods::Hopf;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::SpinPoisson;

/// `J(q, p) = (2 q1 q2 + 2 p1 p2, 2 q2 p1 - 2 q1 p2, q1^2 + p1^2 - q2^2 - p2^2)/4` of the point `(q1, q2, p1, p2)` of each
/// spin.
#[inline(always)]
pub fn spins_of<S: Scalar, P: SpinPoisson<S>>(system: &P, point: &P::Spinors, out: &mut P::State) {
    let (half, quarter) = (S::ratio(1.0, 2.0), S::ratio(1.0, 4.0));
    let (points, out) = (point.as_slice(), out.as_mut_slice());
    for (z, spin) in points.chunks_exact(4).zip(system.spins()) {
        out[spin[0]] = half * (z[0] * z[1] + z[2] * z[3]);
        out[spin[1]] = half * (z[1] * z[2] - z[0] * z[3]);
        out[spin[2]] = quarter * ((z[0] * z[0] + z[2] * z[2]) - (z[1] * z[1] + z[3] * z[3]));
    }
}

/// The canonical flow of `H o J` at a point, of which `gradient` is that of H at J: over it lies `c m x grad H`.
#[inline(always)]
pub fn flow_of_spinors<S: Scalar, P: SpinPoisson<S>>(
    system: &P,
    point: &P::Spinors,
    gradient: &P::State,
    out: &mut P::Spinors,
) {
    let (points, gradient) = (point.as_slice(), gradient.as_slice());
    let half = S::ratio(1.0, 2.0);
    let flows = out.as_mut_slice().chunks_exact_mut(4);
    for (index, (flow, z)) in flows.zip(points.chunks_exact(4)).enumerate() {
        let factor = half * system.scale(index);
        let [a, b, c] = system.spins()[index].map(|k| factor * gradient[k]);
        flow[0] = (z[3] * a + z[1] * b) + z[2] * c;
        flow[1] = (z[2] * a - z[0] * b) - z[3] * c;
        flow[2] = (z[3] * b - z[1] * a) - z[0] * c;
        flow[3] = (z[1] * c - z[0] * a) - z[2] * b;
    }
}

/// The canonical flow of `H o J` at a point; along the generator where something damps.
#[inline(always)]
pub fn flow_over_spins<S: Scalar, P: SpinPoisson<S>>(
    system: &P,
    point: &P::Spinors,
    out: &mut P::Spinors,
) {
    let (mut momenta, mut generator) = (system.zero_state(), system.zero_state());
    spins_of(system, point, &mut momenta);
    system.generator(&momenta, &mut generator);
    flow_of_spinors(system, point, &generator, out);
}

/// A point over a state: that with `p1 = 0` where the third component of a spin is not negative, else that with
/// `p2 = 0`, so that nothing cancels.
pub fn spinors_of<S: Scalar, P: SpinPoisson<S>>(system: &P, mu: &P::State, out: &mut P::Spinors) {
    let (zero, two) = (S::zero(), S::ratio(2.0, 1.0));
    let points = out.as_mut_slice().chunks_exact_mut(4);
    for (z, spin) in points.zip(system.spins()) {
        let m = spin.map(|k| mu.as_slice()[k]);
        let size = m[0].abs().max(m[1].abs()).max(m[2].abs());
        let resting = size.less_equal(zero);
        let unit = S::select(resting, S::one(), size);
        let [x, y, w] = m.map(|entry| entry / unit);
        let root = (two * ((x * x + y * y + w * w).sqrt() + w.abs())).sqrt();
        // in units of the square root of the size
        let (other, length) = (two / S::select(resting, S::one(), root), unit.sqrt());
        let (x, y, root) = (length * (x * other), length * (y * other), length * root);
        let above = zero.less_equal(w);
        let parts = [
            S::select(above, root, x),
            S::select(above, x, root),
            S::select(above, zero, y),
            S::select(above, -y, zero),
        ];
        for (entry, part) in z.iter_mut().zip(parts) {
            *entry = S::select(resting, zero, part);
        }
    }
}

/// The fibre is turned by a unit complex number for each spin, which leaves the norm of points as it is: there are no labels.
impl<S: Scalar, P: SpinPoisson<S>> LinearLift<S, P> for Hopf {
    type Point = P::Spinors;
    type Labels = [S; 0];
    const GROWS: bool = false;
    const SLOPES: Option<StageSlopes> = Some(StageSlopes::Hopf);

    fn zero_point(system: &P) -> P::Spinors {
        system.zero_spinors()
    }

    fn zero_labels(_system: &P) -> [S; 0] {
        []
    }

    #[inline]
    fn lift(system: &P, mu: &P::State, _labels: &mut [S; 0], point: &mut P::Spinors) {
        spinors_of(system, mu, point);
    }

    #[inline(always)]
    fn project(system: &P, _labels: &[S; 0], point: &P::Spinors, mu: &mut P::State) {
        spins_of(system, point, mu);
    }

    #[inline(always)]
    fn flow(system: &P, _labels: &[S; 0], point: &P::Spinors, out: &mut P::Spinors) {
        system.spinor_flow(point, out);
    }
}
