//! Points of `T*H` over a rotation group with vectors.

use core::ops::Range;

use super::StageSlopes;
use super::lifts::LinearLift;
use super::quaternion_stages::product;
use crate::methods::Quaternion;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::VectorPoisson;

/// The two parts of a point.
#[inline(always)]
fn parts<S: Scalar>(point: &impl State<S>) -> [[S; 4]; 2] {
    let z = point.as_slice();
    [[z[0], z[1], z[2], z[3]], [z[4], z[5], z[6], z[7]]]
}

/// Writes the two parts of a point.
#[inline(always)]
fn write<S: Scalar>(q: [S; 4], p: [S; 4], out: &mut impl State<S>) {
    for (entry, value) in out.as_mut_slice().iter_mut().zip(q.into_iter().chain(p)) {
        *entry = value;
    }
}

/// `a q` for the label a of a vector: three entries of it, or for a single vector its length in direction k.
#[inline(always)]
fn labelled<S: Scalar>(labels: &[S], vector: usize, q: &[S; 4]) -> [S; 4] {
    if let [length] = *labels {
        return [length * -q[3], length * -q[2], length * q[1], length * q[0]];
    }
    let a = &labels[3 * vector..3 * vector + 3];
    product([S::zero(), a[0], a[1], a[2]], *q)
}

/// The imaginary part of `conj(q) m`.
#[inline(always)]
fn momentum<S: Scalar>(q: &[S; 4], m: &[S; 4]) -> [S; 3] {
    [
        (q[0] * m[1] - q[1] * m[0]) + (q[3] * m[2] - q[2] * m[3]),
        (q[0] * m[2] - q[2] * m[0]) + (q[1] * m[3] - q[3] * m[1]),
        (q[0] * m[3] - q[3] * m[0]) + (q[2] * m[1] - q[1] * m[2]),
    ]
}

/// The state `Pi = Im(conj(q) P)`, `Gamma_a = conj(q) a q` under a point.
#[inline(always)]
pub fn vectors_of<S: Scalar, P: VectorPoisson<S>>(
    system: &P,
    labels: &P::Labels,
    point: &P::Quaternions,
    out: &mut P::State,
) {
    let ([q, p], out) = (parts(point), out.as_mut_slice());
    for (&k, entry) in system.rotation().iter().zip(momentum(&q, &p)) {
        out[k] = entry;
    }
    for (index, vector) in system.vectors().iter().enumerate() {
        let turned = momentum(&q, &labelled(labels.as_slice(), index, &q));
        for (component, entry) in vector.iter().zip(turned) {
            let (k, _) = component.place();
            out[k] = component.value::<S>() * entry;
        }
    }
}

/// The canonical flow of `H o J` at a point, of which `gradient` is that of H at J: with `w = c Omega/2`,
/// `q' = q w`, `P' = P w + c sum (a q) chi_a`, where Omega and the `chi_a` are the derivatives of H by Pi and the vectors.
#[inline(always)]
pub fn flow_of_quaternions<S: Scalar, P: VectorPoisson<S>>(
    system: &P,
    labels: &P::Labels,
    point: &P::Quaternions,
    gradient: &P::State,
    out: &mut P::Quaternions,
) {
    let ([q, p], gradient) = (parts(point), gradient.as_slice());
    let (scale, zero) = (system.scale(), S::zero());
    let half = scale * S::ratio(1.0, 2.0);
    let [a, b, c] = system.rotation().map(|k| half * gradient[k]);
    let motion = [zero, a, b, c];
    let (first, mut second) = (product(q, motion), product(p, motion));
    for (index, vector) in system.vectors().iter().enumerate() {
        let [x, y, z] = core::array::from_fn(|j| {
            scale * (vector[j].value::<S>() * gradient[vector[j].place().0])
        });
        let turned = labelled(labels.as_slice(), index, &q);
        let force = product(turned, [zero, x, y, z]);
        second = core::array::from_fn(|k| second[k] + force[k]);
    }
    write(first, second, out);
}

/// The canonical flow of `H o J` at a point; along the generator where something damps.
#[inline(always)]
pub fn flow_over_quaternions<S: Scalar, P: VectorPoisson<S>>(
    system: &P,
    labels: &P::Labels,
    point: &P::Quaternions,
    out: &mut P::Quaternions,
) {
    let (mut momenta, mut generator) = (system.zero_state(), system.zero_state());
    vectors_of(system, labels, point, &mut momenta);
    system.generator(&momenta, &mut generator);
    flow_of_quaternions(system, labels, point, &generator, out);
}

/// A point over a state, with its labels. A single vector is `r conj(q) k q`, with the entry of q that is largest chosen
/// positive and another one 0, so that nothing cancels; several are their own labels, and q = 1.
pub fn quaternion_of<S: Scalar, P: VectorPoisson<S>>(
    system: &P,
    mu: &P::State,
    labels: &mut P::Labels,
    point: &mut P::Quaternions,
) {
    let (one, zero) = (S::one(), S::zero());
    let mu = mu.as_slice();
    let mut q = [one, zero, zero, zero];
    let vectors = system.vectors();
    let vector = |index: usize| -> [S; 3] {
        core::array::from_fn(|j| {
            let component = &vectors[index][j];
            mu[component.place().0] / component.value::<S>()
        })
    };
    if let [length] = labels.as_mut_slice() {
        (q, *length) = turn_to(vector(0));
    } else {
        for (index, label) in labels.as_mut_slice().chunks_exact_mut(3).enumerate() {
            label.copy_from_slice(&vector(index));
        }
    }
    let [a, b, c] = system.rotation().map(|k| mu[k]);
    let momentum = product(q, [zero, a, b, c]);
    write(q, momentum, point);
}

/// A unit quaternion and a length with `v = length conj(q) k q`.
fn turn_to<S: Scalar>(v: [S; 3]) -> ([S; 4], S) {
    let (one, zero, half) = (S::one(), S::zero(), S::ratio(1.0, 2.0));
    let size = v[0].abs().max(v[1].abs()).max(v[2].abs());
    let resting = size.less_equal(zero);
    let unit = S::select(resting, one, size);
    let [x, y, z] = v.map(|entry| entry / unit);
    let length = (x * x + y * y + z * z).sqrt();
    let length = S::select(resting, one, length);
    let [x, y, z] = [x / length, y / length, S::select(resting, one, z / length)];
    let large = (half * (one + z.abs())).sqrt();
    let (x, y) = (x * half / large, y * half / large);
    let above = zero.less_equal(z);
    let q = [
        S::select(above, large, y),
        S::select(above, y, large),
        S::select(above, -x, zero),
        S::select(above, zero, x),
    ];
    (q, S::select(resting, zero, length * unit))
}

/// The fibre over a state is moved by `P -> P + s q`, in which P drifts: P is kept orthogonal to q.
impl<S: Scalar, P: VectorPoisson<S>> LinearLift<S, P> for Quaternion {
    type Point = P::Quaternions;
    type Labels = P::Labels;
    const GROWS: bool = false;
    const SLOPES: Option<StageSlopes> = Some(StageSlopes::Quaternion);

    fn zero_point(system: &P) -> P::Quaternions {
        system.zero_quaternions()
    }

    fn zero_labels(system: &P) -> P::Labels {
        system.zero_labels()
    }

    fn momenta(_system: &P) -> Option<Range<usize>> {
        Some(4..8)
    }

    #[inline]
    fn lift(system: &P, mu: &P::State, labels: &mut P::Labels, point: &mut P::Quaternions) {
        quaternion_of(system, mu, labels, point);
    }

    #[inline(always)]
    fn project(system: &P, labels: &P::Labels, point: &P::Quaternions, mu: &mut P::State) {
        vectors_of(system, labels, point, mu);
    }

    #[inline(always)]
    fn flow(system: &P, labels: &P::Labels, point: &P::Quaternions, out: &mut P::Quaternions) {
        system.quaternion_flow(labels, point, out);
    }

    #[inline(always)]
    fn settle(_system: &P, point: &mut P::Quaternions, slopes: &mut P::Quaternions) {
        let [q, p] = parts(point);
        let along = (q[0] * p[0] + q[1] * p[1]) + (q[2] * p[2] + q[3] * p[3]);
        let square = (q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]);
        let shear = along / square;
        write(q, core::array::from_fn(|k| p[k] - shear * q[k]), point);
        let [f, g] = parts(slopes);
        write(f, core::array::from_fn(|k| g[k] - shear * f[k]), slopes);
    }
}
