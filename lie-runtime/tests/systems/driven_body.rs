// A body on so(3)* with the time beside it, `H(t, m) = m . m/(2 I) + x^4/20 + y/3 + (3/10) sin(t) z`, with a force that is a generic
// function of m and t, and a double bracket with a generic metric; each may be left out.

use super::rigid_body::{cross, dot, so3_triple};
use lie_runtime::scalar::Truncated;
use lie_runtime::{
    CayleyPoisson, Clock, CotangentPoisson, Dual, Expand, LiePoisson, Lift, Poisson, Scalar, Widen,
};
use nalgebra::{SMatrix, SVector};

/// What acts on the body.
#[derive(Clone, Copy, Debug)]
pub struct DrivenBody<S = f64> {
    /// Whether the force does.
    pub forced: bool,
    /// The strength of the double bracket; none damps where it is `None`.
    pub strength: Option<S>,
}

/// Where the coordinates begin: m, the momentum of the time, the time and the unit.
pub const START: [f64; 6] = [0.6, -0.5, 0.7, 0.0, 0.3, 1.0];
const MOMENTUM: usize = 3;
const TIME: usize = 4;
const UNIT: usize = 5;

type Vector<S> = SVector<S, 6>;

/// The metric of the double bracket, symmetric and positive.
pub fn metric<S: Scalar>(v: [S; 3]) -> [S; 3] {
    let [tenth, fifth] = [S::ratio(1.0, 10.0), S::ratio(1.0, 5.0)];
    [
        v[0] + fifth * v[1],
        fifth * v[0] + S::ratio(3.0, 2.0) * v[1] + tenth * v[2],
        tenth * v[1] + S::ratio(4.0, 5.0) * v[2],
    ]
}

impl<S: Scalar> DrivenBody<S> {
    /// The body without force and damping.
    pub fn free() -> Self {
        Self {
            forced: false,
            strength: None,
        }
    }

    fn over<T>(&self, scalar: impl Fn(S) -> T) -> DrivenBody<T> {
        DrivenBody {
            forced: self.forced,
            strength: self.strength.map(scalar),
        }
    }

    fn moments() -> [S; 3] {
        [S::ratio(1.0, 2.0), S::one(), S::ratio(3.0, 2.0)]
    }

    fn momenta(mu: &Vector<S>) -> [S; 3] {
        [mu[0], mu[1], mu[2]]
    }

    /// The force on the momenta, none where it is left out.
    pub fn torque(&self, mu: &Vector<S>) -> [S; 3] {
        if !self.forced {
            return [S::zero(); 3];
        }
        let (m, t) = (Self::momenta(mu), mu[TIME]);
        let part = |n: f64, d: f64| S::ratio(n, d);
        let cubic = m[0] * dot(&m, &m) * part(1.0, 7.0);
        let last = (t + t).cos() * part(1.0, 2.0);
        [
            t.sin() * part(1.0, 3.0) - m[0] * part(1.0, 5.0) - cubic,
            m[0] * part(1.0, 9.0) - m[1] * part(1.0, 4.0),
            last - m[2] * m[2] * part(1.0, 6.0),
        ]
    }

    /// `c <v, G v>` with `v = m x grad H`, the power that the double bracket takes.
    pub fn loss(&self, mu: &Vector<S>) -> S {
        let Some(strength) = self.strength else {
            return S::zero();
        };
        let mut gradient = self.zero_state();
        self.gradient(mu, &mut gradient);
        let v = cross(&Self::momenta(mu), gradient.as_slice());
        strength * dot(&v, &metric(v))
    }
}

impl<S: Scalar> Poisson<S> for DrivenBody<S> {
    type State = Vector<S>;
    type Jacobian = SMatrix<S, 6, 6>;
    facts!(S, "DrivenBody", ["x", "y", "z", "p", "t", "1"], ["C"]);
    fn clock(&self) -> Option<Clock> {
        Some(Clock {
            momentum: MOMENTUM,
            time: TIME,
        })
    }
    fn hamiltonian(&self, mu: &Self::State) -> S {
        self.energy(mu) + mu[MOMENTUM]
    }
    fn energy(&self, mu: &Self::State) -> S {
        let [x, y, z] = Self::moments();
        let kinetic = x * mu[0] * mu[0] + y * mu[1] * mu[1] + z * mu[2] * mu[2];
        let square = mu[0] * mu[0];
        let bent = square * square * S::ratio(1.0, 20.0) + mu[1] * S::ratio(1.0, 3.0);
        kinetic * S::ratio(1.0, 2.0) + bent + mu[TIME].sin() * mu[2] * S::ratio(3.0, 10.0)
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        let ([x, y, z], t) = (Self::moments(), mu[TIME]);
        let weight = S::ratio(3.0, 10.0);
        out[0] = x * mu[0] + mu[0] * mu[0] * mu[0] * S::ratio(1.0, 5.0);
        out[1] = y * mu[1] + S::ratio(1.0, 3.0);
        out[2] = z * mu[2] + weight * t.sin();
        out[MOMENTUM] = S::one();
        out[TIME] = weight * t.cos() * mu[2];
        out[UNIT] = S::zero();
    }
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let ([x, y, z], t) = (Self::moments(), mu[TIME]);
        let weight = S::ratio(3.0, 10.0);
        *out = self.zero_jacobian();
        out[(0, 0)] = x + mu[0] * mu[0] * S::ratio(3.0, 5.0);
        out[(1, 1)] = y;
        out[(2, 2)] = z;
        out[(2, TIME)] = weight * t.cos();
        out[(TIME, 2)] = weight * t.cos();
        out[(TIME, TIME)] = -weight * t.sin() * mu[2];
    }
    fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            out[(i, j)] = -mu[k];
            out[(j, i)] = mu[k];
        }
        out[(TIME, MOMENTUM)] = mu[UNIT];
        out[(MOMENTUM, TIME)] = -mu[UNIT];
    }
    fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        lie_runtime::generic::jacobian(self, mu, out);
    }
    fn is_forced(&self) -> bool {
        self.forced || self.is_damped()
    }
    fn force(&self, mu: &Self::State, out: &mut Self::State) {
        let mut gradient = self.zero_state();
        self.gradient(mu, &mut gradient);
        let torque = self.torque(mu);
        out.fill(S::zero());
        for k in 0..3 {
            out[k] = torque[k];
        }
        out[MOMENTUM] = self.loss(mu) - dot(&torque, gradient.as_slice());
    }
    fn force_slope(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let lifted = self.lift();
        let mut q: Vector<Dual<S>> = mu.map(Dual::constant_of);
        let mut force = lifted.zero_state();
        for column in 0..6 {
            q[column].derivative = S::one();
            lifted.force(&q, &mut force);
            q[column].derivative = S::zero();
            for row in 0..6 {
                out[(row, column)] = force[row].derivative;
            }
        }
    }
    fn is_damped(&self) -> bool {
        self.strength.is_some()
    }
    fn damping(&self, _mu: &Self::State, v: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
        if let Some(strength) = self.strength {
            let turned = metric(Self::momenta(v));
            for k in 0..3 {
                out[k] = strength * turned[k];
            }
        }
    }
    fn casimirs(&self, mu: &Self::State, out: &mut [S]) {
        let m = Self::momenta(mu);
        out[0] = dot(&m, &m);
    }
    fn casimir_gradient(&self, _index: usize, mu: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
        for k in 0..3 {
            out[k] = mu[k] + mu[k];
        }
    }
}

impl<S: Scalar> LiePoisson<S> for DrivenBody<S> {}

impl<S: Scalar> CayleyPoisson<S> for DrivenBody<S> {
    fn triple(&self, x: &Self::State, z: &Self::State, mu: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
        let triple = so3_triple(x.as_slice(), z.as_slice(), mu.as_slice());
        out.as_mut_slice()[..3].copy_from_slice(&triple);
    }
}

impl<S: Scalar> Lift<S> for DrivenBody<S> {
    type Lifted = DrivenBody<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        self.over(Dual::constant_of)
    }
}

impl<S: Scalar> Widen<S> for DrivenBody<S> {
    type Widened = DrivenBody<S::Wide>;
    fn widen(&self) -> Self::Widened {
        self.over(S::widen)
    }
}

impl<S: Scalar> Expand<S> for DrivenBody<S> {
    type Expanded = DrivenBody<Truncated<S>>;
    fn expand(&self) -> Self::Expanded {
        self.over(Truncated::constant_of)
    }
}

/// The momentum of the time and the three others.
impl<S: Scalar> CotangentPoisson<S> for DrivenBody<S> {
    momenta!(S, 4);
}

lie_runtime::generic_equations!([S: Scalar] DrivenBody<S>, S: midpoint, gauss4, gauss6, exp, cayley);
lie_runtime::generic_equations!([S: Scalar] DrivenBody<S>, S: discrete_gradients, orbit_energy, cohen_hairer, taylor, lie_taylor);
