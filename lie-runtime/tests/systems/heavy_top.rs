// The heavy top on se(3)*: state (m, gamma), `m' = m x Omega + gamma x H_gamma`,
// `gamma' = gamma x Omega`.

use super::rigid_body::{cross, dot, hat, so3_triple};
use lie_runtime::structure::{Entry, Representation};
use lie_runtime::{
    CayleyPoisson, CotangentPoisson, Dual, LiePoisson, Lift, MatrixPoisson, Poisson, Scalar,
    generic,
};
use nalgebra::{SMatrix, SVector};

/// Moments of inertia and the gradient of the potential energy, `mgl chi`.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop<S = f64> {
    /// I1, I2, I3.
    pub inertia: [S; 3],
    /// mgl times the axis to the centre of mass.
    pub weight: [S; 3],
}

impl<S: Scalar> Default for HeavyTop<S> {
    fn default() -> Self {
        Self {
            inertia: [S::from_f64(2.0), S::from_f64(1.5), S::one()],
            weight: [S::ratio(1.0, 3.0), S::ratio(1.0, 7.0), S::one()],
        }
    }
}

/// The initial state of the reference data.
pub const START: [f64; 6] = [0.4, 0.3, 0.9, 0.36, 0.48, 0.8];

type Vector<S> = SVector<S, 6>;
type Matrix<S> = SMatrix<S, 6, 6>;

impl<S: Scalar> Poisson<S> for HeavyTop<S> {
    type State = Vector<S>;
    type Jacobian = Matrix<S>;
    facts!(
        S,
        "HeavyTop",
        ["m1", "m2", "m3", "g1", "g2", "g3"],
        ["length", "area"]
    );
    fn hamiltonian(&self, mu: &Vector<S>) -> S {
        let mut kinetic = S::zero();
        for k in 0..3 {
            kinetic += mu[k] * mu[k] / self.inertia[k];
        }
        kinetic * S::ratio(1.0, 2.0) + dot(&self.weight, &mu.as_slice()[3..])
    }
    fn gradient(&self, mu: &Vector<S>, out: &mut Vector<S>) {
        for k in 0..3 {
            out[k] = mu[k] / self.inertia[k];
            out[k + 3] = self.weight[k];
        }
    }
    fn hessian(&self, _mu: &Vector<S>, out: &mut Matrix<S>) {
        *out = self.zero_jacobian();
        for k in 0..3 {
            out[(k, k)] = S::one() / self.inertia[k];
        }
    }
    fn poisson_matrix(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        let (m, gamma) = (hat(&mu.as_slice()[..3]), hat(&mu.as_slice()[3..]));
        for row in 0..3 {
            for column in 0..3 {
                out[(row, column)] = m[(row, column)];
                out[(row, column + 3)] = gamma[(row, column)];
                out[(row + 3, column)] = gamma[(row, column)];
                out[(row + 3, column + 3)] = S::zero();
            }
        }
    }
    fn jacobian(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        generic::jacobian(self, mu, out);
    }
    fn casimirs(&self, mu: &Vector<S>, out: &mut [S]) {
        let (m, gamma) = mu.as_slice().split_at(3);
        out[0] = dot(gamma, gamma);
        out[1] = dot(m, gamma);
    }
    fn casimir_gradient(&self, index: usize, mu: &Vector<S>, out: &mut Vector<S>) {
        for k in 0..3 {
            out[k] = if index == 0 { S::zero() } else { mu[k + 3] };
            out[k + 3] = if index == 0 {
                mu[k + 3] + mu[k + 3]
            } else {
                mu[k]
            };
        }
    }
}

/// A vector of six from two of three.
fn join<S: Scalar>(first: [S; 3], second: [S; 3]) -> Vector<S> {
    Vector::from_fn(|row, _| if row < 3 { first[row] } else { second[row - 3] })
}

fn sum<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    core::array::from_fn(|k| a[k] + b[k])
}

impl<S: Scalar> LiePoisson<S> for HeavyTop<S> {
    fn ad(&self, xi: &Vector<S>, eta: &Vector<S>, out: &mut Vector<S>) {
        let ((a, u), (b, v)) = (xi.as_slice().split_at(3), eta.as_slice().split_at(3));
        *out = join(cross(a, b), sum(cross(a, v), cross(u, b)));
    }
    fn ad_star(&self, xi: &Vector<S>, mu: &Vector<S>, out: &mut Vector<S>) {
        let ((a, u), (m, gamma)) = (xi.as_slice().split_at(3), mu.as_slice().split_at(3));
        *out = join(sum(cross(m, a), cross(gamma, u)), cross(gamma, a));
    }
    fn ad_star_matrix(&self, xi: &Vector<S>, out: &mut Matrix<S>) {
        generic::ad_star_matrix(self, xi, out);
    }
}

impl<S: Scalar> Lift<S> for HeavyTop<S> {
    type Lifted = HeavyTop<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        HeavyTop {
            inertia: self.inertia.map(Dual::constant_of),
            weight: self.weight.map(Dual::constant_of),
        }
    }
}

impl<S: Scalar> CayleyPoisson<S> for HeavyTop<S> {
    /// In the 4x4 representation (hat a, u; 0, 0), with x = (a, u), z = (c, w), mu = (m, gamma):
    /// `-(a (c.m) + c (a.m))/2 + (w x (gamma x a) + u x (gamma x c))/2` and 0.
    fn triple(&self, x: &Vector<S>, z: &Vector<S>, mu: &Vector<S>, out: &mut Vector<S>) {
        let ((a, u), (c, w)) = (x.as_slice().split_at(3), z.as_slice().split_at(3));
        let (m, gamma) = mu.as_slice().split_at(3);
        let half = S::ratio(1.0, 2.0);
        let moved = sum(cross(w, &cross(gamma, a)), cross(u, &cross(gamma, c)));
        *out = join(
            sum(so3_triple(a, c, m), moved.map(|entry| half * entry)),
            [S::zero(); 3],
        );
    }
}

lie_runtime::generic_equations!([S: Scalar] HeavyTop<S>, S: midpoint, gauss4, gauss6, exp, cayley, generating, generating_cayley);
lie_runtime::generic_equations!([S: Scalar] HeavyTop<S>, S: splitting);
lie_runtime::generic_equations!([S: Scalar] HeavyTop<S>, S: discrete_gradients, orbit_energy, cohen_hairer);

const fn entry(row: u16, column: u16, value: f64) -> Entry {
    Entry::new(row, column, value)
}

/// se(3) by its 4 x 4 matrices.
const SE3: Representation = Representation {
    matrices: &[
        &[entry(1, 2, -1.0), entry(2, 1, 1.0)],
        &[entry(0, 2, 1.0), entry(2, 0, -1.0)],
        &[entry(0, 1, -1.0), entry(1, 0, 1.0)],
        &[entry(0, 3, 1.0)],
        &[entry(1, 3, 1.0)],
        &[entry(2, 3, 1.0)],
    ],
    dual: &[
        &[entry(1, 2, 0.5), entry(2, 1, -0.5)],
        &[entry(0, 2, -0.5), entry(2, 0, 0.5)],
        &[entry(0, 1, 0.5), entry(1, 0, -0.5)],
        &[entry(3, 0, 1.0)],
        &[entry(3, 1, 1.0)],
        &[entry(3, 2, 1.0)],
    ],
    skew: false,
};

impl<S: Scalar> MatrixPoisson<S> for HeavyTop<S> {
    type Matrix = SMatrix<S, 4, 4>;
    fn representation(&self) -> Representation<'_> {
        SE3
    }
    fn zero_matrix(&self) -> Self::Matrix {
        SMatrix::<S, 4, 4>::repeat(S::zero())
    }
}

lie_runtime::generic_equations!([S: Scalar] HeavyTop<S>, S: isospectral2, isospectral4, isospectral6);

/// A system on T*SO(3): gamma is a row of the group element.
impl<S: Scalar> CotangentPoisson<S> for HeavyTop<S> {
    momenta!(S, 3);
}
