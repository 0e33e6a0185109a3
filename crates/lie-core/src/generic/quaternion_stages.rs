//! The momenta of the stages over the Hopf map, for spins.

use super::rotation::rotation_vector;
use super::stage_momenta::StageMap;
use super::tableau::Tableau;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::methods::Retraction;
use crate::scalar::Scalar;
use crate::state::{Stages, State};
use crate::structure::SpinPoisson;

/// A quaternion, the real part first.
type Quaternion<S> = [S; 4];

fn zero<S: Scalar>() -> Quaternion<S> {
    [S::zero(); 4]
}

fn real<S: Scalar>(value: S) -> Quaternion<S> {
    [value, S::zero(), S::zero(), S::zero()]
}

fn conjugate<S: Scalar>(a: Quaternion<S>) -> Quaternion<S> {
    [a[0], -a[1], -a[2], -a[3]]
}

/// The product of two quaternions.
pub fn product<S: Scalar>(a: Quaternion<S>, b: Quaternion<S>) -> Quaternion<S> {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// `a - b c`
fn minus_product<S: Scalar>(a: Quaternion<S>, b: Quaternion<S>, c: Quaternion<S>) -> Quaternion<S> {
    let product = product(b, c);
    core::array::from_fn(|k| a[k] - product[k])
}

fn inverse<S: Scalar>(a: Quaternion<S>) -> Quaternion<S> {
    let square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3];
    let inverse = S::one() / square;
    conjugate(a).map(|entry| entry * inverse)
}

/// The stages of a Gauss method on `T*R^2 = R^4`, the space of the Hopf map `J: R^4 -> so(3)*`, reduced to
/// so(3)*, for each spin alone.
///
/// Points of `R^4` are quaternions q, `J(q)` is the vector `q e_3 conj(q)` up to a factor, and an element x
/// of the algebra acts by the quaternion `B = -(c/2) x` from the left. The result of a step does
/// not depend on the point over mu, because multiplication from the right commutes with all of it. So
/// the stages are those of the factor on the left,
///
/// ```math
/// Q_i = 1 + \sum_j \mu_{ij} B_j Q_j, \qquad M_i = Q_i\, \mu\, \overline{Q_i}
/// ```
///
/// a linear system of s quaternions with the ratios `mu_ij = a_ij/b_j`, which has a solution for every step. With their
/// matrix A, `G = (1 - A B)^-1 A` and the units `i_c`,
/// `dM_i/dx_j[c] = -c Vec(G_ij i_c Q_j mu conj(Q_i))`.
#[derive(Clone, Debug)]
pub struct QuaternionStages<S, const STAGES: usize> {
    tableau: Tableau<S, STAGES>,
    /// `Q_i`
    position: [Quaternion<S>; STAGES],
    /// G
    forward: [[Quaternion<S>; STAGES]; STAGES],
}

impl<S: Scalar, const STAGES: usize> QuaternionStages<S, STAGES> {
    /// `Q` and G for one spin.
    fn solve(&mut self, scale: S, spin: &[usize; 3], x: &Stages<impl State<S>, STAGES>) {
        let half = scale * S::ratio(1.0, 2.0);
        let mut matrix = [[zero(); STAGES]; STAGES];
        for (i, row) in matrix.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let weight = half * self.tableau.ratios[i][j];
                let identity = if i == j { S::one() } else { S::zero() };
                let x = x.0[j].as_slice();
                *entry = [
                    identity,
                    weight * x[spin[0]],
                    weight * x[spin[1]],
                    weight * x[spin[2]],
                ];
            }
        }
        self.position = [real(S::one()); STAGES];
        self.forward = self.tableau.ratios.map(|row| row.map(real));
        for k in 0..STAGES {
            let pivot = inverse(matrix[k][k]);
            for entry in matrix[k].iter_mut().skip(k + 1) {
                *entry = product(pivot, *entry);
            }
            let above = matrix[k];
            self.position[k] = product(pivot, self.position[k]);
            self.forward[k] = self.forward[k].map(|entry| product(pivot, entry));
            for i in (0..STAGES).filter(|&i| i != k) {
                let multiplier = matrix[i][k];
                for (entry, above) in matrix[i].iter_mut().zip(above).skip(k + 1) {
                    *entry = minus_product(*entry, multiplier, above);
                }
                self.position[i] = minus_product(self.position[i], multiplier, self.position[k]);
                for j in 0..STAGES {
                    self.forward[i][j] =
                        minus_product(self.forward[i][j], multiplier, self.forward[k][j]);
                }
            }
        }
    }

    /// `Q_j mu conj(Q_i)`
    fn pair(&self, j: usize, i: usize, mu: Quaternion<S>) -> Quaternion<S> {
        product(product(self.position[j], mu), conjugate(self.position[i]))
    }
}

impl<S, P, const STAGES: usize> StageMap<S, P, STAGES> for QuaternionStages<S, STAGES>
where
    S: Scalar,
    P: SpinPoisson<S>,
{
    // imaginary quaternions have no real eigenvalues
    fn everywhere(_system: &P) -> bool {
        true
    }

    fn new(_system: &P, tableau: &Tableau<S, STAGES>) -> Self {
        Self {
            tableau: *tableau,
            position: [zero(); STAGES],
            forward: [[zero(); STAGES]; STAGES],
        }
    }

    fn momenta(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
    ) {
        for (index, spin) in system.spins().iter().enumerate() {
            self.solve(system.scale(index), spin, x);
            let base = at(spin, mu.as_slice());
            for (i, out) in out.0.iter_mut().enumerate() {
                let momentum = self.pair(i, i, base);
                for (k, &coordinate) in spin.iter().enumerate() {
                    out.as_mut_slice()[coordinate] = momentum[k + 1];
                }
            }
        }
    }

    fn linearize(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
        slopes: &mut StageMatrix<P::Jacobian, STAGES>,
    ) {
        for (index, spin) in system.spins().iter().enumerate() {
            let scale = system.scale(index);
            self.solve(scale, spin, x);
            let base = at(spin, mu.as_slice());
            for (i, row) in slopes.0.iter_mut().enumerate() {
                for (j, block) in row.iter_mut().enumerate() {
                    let pair = self.pair(j, i, base);
                    if i == j {
                        let out = out.0[i].as_mut_slice();
                        for (k, &coordinate) in spin.iter().enumerate() {
                            out[coordinate] = pair[k + 1];
                        }
                    }
                    let factor = self.forward[i][j].map(|entry| -(scale * entry));
                    for (c, &column) in spin.iter().enumerate() {
                        let mut unit = zero();
                        unit[c + 1] = S::one();
                        let slope = product(product(factor, unit), pair);
                        for (k, &row) in spin.iter().enumerate() {
                            block.set(row, column, slope[k + 1]);
                        }
                    }
                }
            }
        }
    }

    fn group_factor(
        &mut self,
        system: &P,
        x: &Stages<P::State, STAGES>,
        xi: &mut P::State,
    ) -> Option<Retraction> {
        for (index, spin) in system.spins().iter().enumerate() {
            let scale = system.scale(index);
            self.solve(scale, spin, x);
            // Q = 1 + sum_i B_i Q_i turns the momentum, its conjugate the group element
            let mut end = real(S::one());
            let minus = -scale * S::ratio(1.0, 2.0);
            for (stage, x) in self.position.iter().zip(&x.0) {
                let motion = at(spin, x.as_slice()).map(|entry| minus * entry);
                let moved = product(motion, *stage);
                end = core::array::from_fn(|k| end[k] + moved[k]);
            }
            let axis = [-end[1], -end[2], -end[3]];
            for (&k, entry) in spin.iter().zip(rotation_vector(end[0], axis)) {
                xi.as_mut_slice()[k] = entry / scale;
            }
        }
        Some(Retraction::Exp)
    }
}

/// The momentum of a spin as a quaternion.
fn at<S: Scalar>(spin: &[usize; 3], mu: &[S]) -> Quaternion<S> {
    [S::zero(), mu[spin[0]], mu[spin[1]], mu[spin[2]]]
}
