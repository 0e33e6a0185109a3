// The algebra of the affine group of the line, `[a, b] = b`, with `H = k p + c p^2/2 + d q^2/2`:
// `p' = -q dH/dq`, `q' = q dH/dp`. Its open orbits are q > 0 and q < 0. The Cayley map of the representation
// `x -> [[x_a, x_b], [0, 0]]` has its pole at x_a = 2, and beyond it the sign of q changes.

use lie_runtime::structure::{Entry, Representation};
use lie_runtime::{CayleyPoisson, LiePoisson, MatrixPoisson, Poisson, Scalar, Spectrum};
use nalgebra::{SMatrix, SVector};

/// The coefficients k, c, d.
#[derive(Clone, Copy, Debug)]
pub struct AffineLine<S>(pub [S; 3]);

impl<S: Scalar> AffineLine<S> {
    /// `H = -3 p + p^2/20 + q^2/10`: q decays.
    pub fn decay() -> Self {
        Self([-3.0, 0.1, 0.2].map(S::from_f64))
    }

    /// `H = p^2/2 - q^2/2`: p becomes infinite in a finite time.
    pub fn blow_up() -> Self {
        Self([0.0, 1.0, -1.0].map(S::from_f64))
    }
}

impl<S: Scalar> Poisson<S> for AffineLine<S> {
    type State = SVector<S, 2>;
    type Jacobian = SMatrix<S, 2, 2>;
    facts!(S, "AffineLine", ["p", "q"], []);
    fn hamiltonian_degree(&self) -> Option<u32> {
        Some(2)
    }
    fn poisson_degree(&self) -> Option<u32> {
        Some(1)
    }
    fn hamiltonian(&self, mu: &Self::State) -> S {
        let ([k, c, d], half) = (self.0, S::ratio(1.0, 2.0));
        k * mu[0] + half * (c * mu[0] * mu[0] + d * mu[1] * mu[1])
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        let [k, c, d] = self.0;
        *out = SVector::<S, 2>::new(k + c * mu[0], d * mu[1]);
    }
    fn hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        let [_, c, d] = self.0;
        *out = SMatrix::<S, 2, 2>::new(c, S::zero(), S::zero(), d);
    }
    fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        *out = SMatrix::<S, 2, 2>::new(S::zero(), -mu[1], mu[1], S::zero());
    }
    fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let [k, c, d] = self.0;
        let two = S::from_f64(2.0);
        *out = SMatrix::<S, 2, 2>::new(S::zero(), -two * d * mu[1], c * mu[1], k + c * mu[0]);
    }
    fn casimirs(&self, _mu: &Self::State, _out: &mut [S]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {}
}

impl<S: Scalar> LiePoisson<S> for AffineLine<S> {
    fn ad(&self, xi: &Self::State, eta: &Self::State, out: &mut Self::State) {
        *out = SVector::<S, 2>::new(S::zero(), xi[0] * eta[1] - xi[1] * eta[0]);
    }
    fn ad_star(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
        *out = SVector::<S, 2>::new(-xi[1] * mu[1], xi[0] * mu[1]);
    }
    fn ad_star_matrix(&self, xi: &Self::State, out: &mut Self::Jacobian) {
        *out = SMatrix::<S, 2, 2>::new(S::zero(), -xi[1], S::zero(), xi[0]);
    }
}

impl<S: Scalar> CayleyPoisson<S> for AffineLine<S> {
    fn triple(&self, x: &Self::State, z: &Self::State, mu: &Self::State, out: &mut Self::State) {
        let mixed = S::ratio(1.0, 2.0) * (x[0] * z[1] + x[1] * z[0]);
        *out = SVector::<S, 2>::new(x[0] * z[0] * mu[0] + mixed * mu[1], S::zero());
    }
}

const AFFINE: Representation = Representation {
    matrices: &[&[Entry::new(0, 0, 1.0)], &[Entry::new(0, 1, 1.0)]],
    dual: &[&[Entry::new(0, 0, 1.0)], &[Entry::new(1, 0, 1.0)]],
    skew: false,
};

impl<S: Scalar> MatrixPoisson<S> for AffineLine<S> {
    type Matrix = SMatrix<S, 2, 2>;
    fn representation(&self) -> Representation<'_> {
        AFFINE
    }
    fn spectrum(&self) -> Spectrum<'_> {
        Spectrum::Bounded(&[1.0, 1.0])
    }

    fn zero_matrix(&self) -> Self::Matrix {
        SMatrix::<S, 2, 2>::repeat(S::zero())
    }
}

impl<S: Scalar> lie_runtime::Lift<S> for AffineLine<S> {
    type Lifted = AffineLine<lie_runtime::Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        AffineLine(self.0.map(lie_runtime::Dual::constant_of))
    }
}

lie_runtime::generic_equations!(
    [S: Scalar] AffineLine<S>, S: exp, cayley, generating2_cayley, generating4_cayley, isospectral2, isospectral4,
    isospectral6
);
