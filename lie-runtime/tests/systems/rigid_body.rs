// The free rigid body on so(3)*, written by hand: `mu' = mu x (mu/I)`.

use lie_runtime::structure::{Entry, Group, Representation};
use lie_runtime::{
    CayleyPoisson, Dual, LiePoisson, Lift, MatrixGroup, MatrixPoisson, Poisson, Scalar, SpinPoisson,
};
use nalgebra::{SMatrix, SVector};

/// Principal moments of inertia.
#[derive(Clone, Copy, Debug)]
pub struct RigidBody<S = f64> {
    /// I1, I2, I3.
    pub inertia: [S; 3],
}

impl<S: Scalar> Default for RigidBody<S> {
    fn default() -> Self {
        Self {
            inertia: [S::from_f64(2.0), S::one(), S::ratio(2.0, 3.0)],
        }
    }
}

/// `out = a x b`.
pub fn cross<S: Scalar>(a: &[S], b: &[S]) -> [S; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a . b`, summed in order.
pub fn dot<S: Scalar>(a: &[S], b: &[S]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The matrix of `b -> a x b`.
pub fn hat<S: Scalar>(a: &[S]) -> SMatrix<S, 3, 3> {
    let zero = S::zero();
    SMatrix::<S, 3, 3>::new(zero, -a[2], a[1], a[2], zero, -a[0], -a[1], a[0], zero)
}

/// The triple product of so(3) in its vector representation: `-(x (z.m) + z (x.m))/2`.
pub fn so3_triple<S: Scalar>(x: &[S], z: &[S], m: &[S]) -> [S; 3] {
    let half = S::ratio(-1.0, 2.0);
    core::array::from_fn(|k| half * (x[k] * dot(z, m) + z[k] * dot(x, m)))
}

impl<S: Scalar> Poisson<S> for RigidBody<S> {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;

    // documentation, lie-dense and no-std-check include this file alone, without the macros beside it
    fn dimension(&self) -> usize {
        3
    }
    fn name(&self) -> &str {
        "RigidBody"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["x", "y", "z"][index]
    }
    fn casimir_count(&self) -> usize {
        1
    }
    fn casimir_name(&self, _index: usize) -> &str {
        "C"
    }
    fn zero_state(&self) -> Self::State {
        SVector::<S, 3>::repeat(S::zero())
    }
    fn zero_jacobian(&self) -> Self::Jacobian {
        SMatrix::<S, 3, 3>::repeat(S::zero())
    }
    fn hamiltonian(&self, mu: &Self::State) -> S {
        let mut sum = S::zero();
        for k in 0..3 {
            sum += mu[k] * mu[k] / self.inertia[k];
        }
        sum * S::ratio(1.0, 2.0)
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        for k in 0..3 {
            out[k] = mu[k] / self.inertia[k];
        }
    }
    fn hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
        for k in 0..3 {
            out[(k, k)] = S::one() / self.inertia[k];
        }
    }
    fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        *out = hat(mu.as_slice());
    }
    fn vector_field(&self, mu: &Self::State, out: &mut Self::State) {
        let mut omega = self.zero_state();
        self.gradient(mu, &mut omega);
        *out = cross(mu.as_slice(), omega.as_slice()).into();
    }
    fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        // mu x (J mu) has the derivative hat(mu) J - hat(J mu)
        let mut omega = self.zero_state();
        self.gradient(mu, &mut omega);
        let (left, right) = (hat(mu.as_slice()), hat(omega.as_slice()));
        for row in 0..3 {
            for column in 0..3 {
                out[(row, column)] =
                    left[(row, column)] / self.inertia[column] - right[(row, column)];
            }
        }
    }
    fn casimirs(&self, mu: &Self::State, out: &mut [S]) {
        out[0] = dot(mu.as_slice(), mu.as_slice());
    }
    fn casimir_gradient(&self, _index: usize, mu: &Self::State, out: &mut Self::State) {
        for k in 0..3 {
            out[k] = mu[k] + mu[k];
        }
    }
}

impl<S: Scalar> LiePoisson<S> for RigidBody<S> {
    fn ad(&self, xi: &Self::State, eta: &Self::State, out: &mut Self::State) {
        *out = cross(xi.as_slice(), eta.as_slice()).into();
    }
    fn ad_star(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
        *out = cross(mu.as_slice(), xi.as_slice()).into();
    }
    fn ad_star_matrix(&self, xi: &Self::State, out: &mut Self::Jacobian) {
        let minus: [S; 3] = core::array::from_fn(|k| -xi[k]);
        *out = hat(&minus);
    }
}

impl<S: Scalar> Lift<S> for RigidBody<S> {
    type Lifted = RigidBody<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        RigidBody {
            inertia: self.inertia.map(Dual::constant_of),
        }
    }
}

impl<S: Scalar> CayleyPoisson<S> for RigidBody<S> {
    fn triple(&self, x: &Self::State, z: &Self::State, mu: &Self::State, out: &mut Self::State) {
        *out = so3_triple(x.as_slice(), z.as_slice(), mu.as_slice()).into();
    }
}

lie_runtime::generic_equations!([S: Scalar] RigidBody<S>, S: midpoint, gauss4, gauss6, exp, cayley, generating, generating_cayley);
lie_runtime::generic_equations!([S: Scalar] RigidBody<S>, S: splitting);
lie_runtime::generic_equations!([S: Scalar] RigidBody<S>, S: discrete_gradients, orbit_energy, cohen_hairer);

const fn entry(row: u16, column: u16, value: f64) -> Entry {
    Entry::new(row, column, value)
}

/// so(3) by its vector representation.
pub const SO3: Representation = Representation {
    matrices: &[
        &[entry(1, 2, -1.0), entry(2, 1, 1.0)],
        &[entry(0, 2, 1.0), entry(2, 0, -1.0)],
        &[entry(0, 1, -1.0), entry(1, 0, 1.0)],
    ],
    dual: &[
        &[entry(1, 2, 0.5), entry(2, 1, -0.5)],
        &[entry(0, 2, -0.5), entry(2, 0, 0.5)],
        &[entry(0, 1, 0.5), entry(1, 0, -0.5)],
    ],
    skew: true,
};

impl<S: Scalar> MatrixPoisson<S> for RigidBody<S> {
    type Matrix = SMatrix<S, 3, 3>;
    fn representation(&self) -> Representation<'_> {
        SO3
    }
    fn zero_matrix(&self) -> Self::Matrix {
        SMatrix::<S, 3, 3>::repeat(S::zero())
    }
}

impl<S: Scalar> MatrixGroup<S> for RigidBody<S> {
    fn group(&self) -> Group<'_> {
        Group {
            size: 3,
            matrices: SO3.matrices,
            closed: true,
            orthogonal: true,
            right: false,
        }
    }
}

impl<S: Scalar> SpinPoisson<S> for RigidBody<S> {
    fn spins(&self) -> &[[usize; 3]] {
        &[[0, 1, 2]]
    }
    fn scale(&self, _spin: usize) -> S {
        S::one()
    }
    type Spinors = [S; 4];
    fn zero_spinors(&self) -> [S; 4] {
        [S::zero(); 4]
    }
}

lie_runtime::generic_equations!([S: Scalar] RigidBody<S>, S: isospectral2, isospectral4, isospectral6, hopf, spherical, moser_veselov);
