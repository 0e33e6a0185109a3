// The heavy top as a system on T*SO(3), gamma a row of the group element, with a torque on the momenta that is a generic function of both, and a
// double bracket on the momenta; each may be left out. No time is in it.

use super::heavy_top::HeavyTop;
use super::rigid_body::cross;
use lie_runtime::{CayleyPoisson, CotangentPoisson, Dual, LiePoisson, Lift, Poisson, Scalar};
use nalgebra::{SMatrix, SVector};

type Vector<S> = SVector<S, 6>;
type Matrix<S> = SMatrix<S, 6, 6>;

/// What acts on the top.
#[derive(Clone, Copy, Debug)]
pub struct DrivenTop<S = f64> {
    top: HeavyTop<S>,
    /// The torque along gamma, which is constant in space.
    pub along: S,
    /// Whether a generic torque acts too.
    pub forced: bool,
    /// The strength of the double bracket; none damps where it is `None`.
    pub strength: Option<S>,
}

impl<S: Scalar> DrivenTop<S> {
    /// The top with what acts on it.
    pub fn new(along: S, forced: bool, strength: Option<S>) -> Self {
        Self {
            top: HeavyTop::default(),
            along,
            forced,
            strength,
        }
    }
}

impl<S: Scalar> Poisson<S> for DrivenTop<S> {
    type State = Vector<S>;
    type Jacobian = Matrix<S>;
    facts!(
        S,
        "DrivenTop",
        ["m1", "m2", "m3", "g1", "g2", "g3"],
        ["length", "area"]
    );
    fn hamiltonian(&self, mu: &Vector<S>) -> S {
        self.top.hamiltonian(mu)
    }
    fn gradient(&self, mu: &Vector<S>, out: &mut Vector<S>) {
        self.top.gradient(mu, out);
    }
    fn hessian(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        self.top.hessian(mu, out);
    }
    fn poisson_matrix(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        self.top.poisson_matrix(mu, out);
    }
    fn jacobian(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        lie_runtime::generic::jacobian(self, mu, out);
    }
    fn is_forced(&self) -> bool {
        true
    }
    fn force(&self, mu: &Vector<S>, out: &mut Vector<S>) {
        out.fill(S::zero());
        for k in 0..3 {
            out[k] = self.along * mu[k + 3];
            if self.forced {
                let (next, last) = (mu[(k + 1) % 3], mu[3 + (k + 2) % 3]);
                out[k] += mu[k] * next * S::ratio(1.0, 7.0) - mu[k] * S::ratio(1.0, 5.0)
                    + last.sin() * last * S::ratio(1.0, 3.0);
            }
        }
    }
    fn force_slope(&self, mu: &Vector<S>, out: &mut Matrix<S>) {
        let lifted = self.lift();
        let mut place = mu.map(Dual::constant_of);
        let mut force = lifted.zero_state();
        for column in 0..6 {
            place[column].derivative = S::one();
            lifted.force(&place, &mut force);
            place[column].derivative = S::zero();
            out.set_column(column, &force.map(|entry| entry.derivative));
        }
    }
    fn is_damped(&self) -> bool {
        self.strength.is_some()
    }
    fn damping(&self, _mu: &Vector<S>, v: &Vector<S>, out: &mut Vector<S>) {
        out.fill(S::zero());
        if let Some(strength) = self.strength {
            for k in 0..3 {
                out[k] = strength * (v[k] + v[(k + 1) % 3] * S::ratio(1.0, 5.0));
            }
        }
    }
    fn casimirs(&self, mu: &Vector<S>, out: &mut [S]) {
        self.top.casimirs(mu, out);
    }
    fn casimir_gradient(&self, index: usize, mu: &Vector<S>, out: &mut Vector<S>) {
        self.top.casimir_gradient(index, mu, out);
    }
}

impl<S: Scalar> LiePoisson<S> for DrivenTop<S> {
    fn ad(&self, xi: &Vector<S>, eta: &Vector<S>, out: &mut Vector<S>) {
        self.top.ad(xi, eta, out);
    }
    fn ad_star(&self, xi: &Vector<S>, mu: &Vector<S>, out: &mut Vector<S>) {
        self.top.ad_star(xi, mu, out);
    }
}

impl<S: Scalar> CayleyPoisson<S> for DrivenTop<S> {
    fn triple(&self, x: &Vector<S>, z: &Vector<S>, mu: &Vector<S>, out: &mut Vector<S>) {
        self.top.triple(x, z, mu, out);
    }
}

impl<S: Scalar> Lift<S> for DrivenTop<S> {
    type Lifted = DrivenTop<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        DrivenTop {
            top: self.top.lift(),
            along: Dual::constant_of(self.along),
            forced: self.forced,
            strength: self.strength.map(Dual::constant_of),
        }
    }
}

impl<S: Scalar> CotangentPoisson<S> for DrivenTop<S> {
    momenta!(S, 3);
}

/// `x` turned about itself by nothing, and any other vector by the rotation of `exp(-hat x)`: how a covector in the body is carried along.
pub fn turned(x: [f64; 3], m: [f64; 3]) -> [f64; 3] {
    // the series of exp(ad*_x) m, ad*_x m = m x x
    let (mut term, mut sum) = (m, m);
    for k in 1..40 {
        term = cross(&term, &x).map(|entry| entry / f64::from(k));
        sum = core::array::from_fn(|i| sum[i] + term[i]);
    }
    sum
}

lie_runtime::generic_equations!([S: Scalar] DrivenTop<S>, S: gauss6, exp);
lie_runtime::generic_equations!([S: Scalar] DrivenTop<S>, S: variational2_on_group, variational4_on_group, variational6_on_group);
lie_runtime::generic_equations!([S: Scalar] DrivenTop<S>, S: variational2_cayley, variational4_cayley, variational6_cayley);
