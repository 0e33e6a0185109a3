// The free rigid body in four dimensions, written with matrices: `M' = [M, Omega]`, `Omega = grad H(M)`.

use lie_runtime::structure::Plane;
use lie_runtime::{InertiaPoisson, LiePoisson, Poisson, generic};
use nalgebra::{SMatrix, SVector};

type Vector = SVector<f64, 6>;
type Matrix = SMatrix<f64, 6, 6>;
type Square = SMatrix<f64, 4, 4>;

const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// The moments along the axes.
#[derive(Clone, Copy, Debug)]
pub struct Body4(pub [f64; 4]);

/// `sum_k x_k (E_(to, from) - E_(from, to))`
pub fn matrix(x: &Vector) -> Square {
    let mut out = Square::zeros();
    for (&(from, to), &x) in PLANES.iter().zip(x.iter()) {
        out[(to, from)] = x;
        out[(from, to)] = -x;
    }
    out
}

/// The coordinates of an antisymmetric matrix.
pub fn coordinates(matrix: &Square) -> Vector {
    Vector::from_fn(|k, _| matrix[(PLANES[k].1, PLANES[k].0)])
}

impl Poisson<f64> for Body4 {
    type State = Vector;
    type Jacobian = Matrix;
    facts!(f64, "Body4", ["a", "b", "c", "d", "e", "f"], []);
    fn hamiltonian_degree(&self) -> Option<u32> {
        Some(2)
    }
    fn hamiltonian(&self, mu: &Vector) -> f64 {
        let mut gradient = self.zero_state();
        self.gradient(mu, &mut gradient);
        0.5 * gradient.dot(mu)
    }
    fn gradient(&self, mu: &Vector, out: &mut Vector) {
        for (k, &(from, to)) in PLANES.iter().enumerate() {
            out[k] = mu[k] / (self.0[from] + self.0[to]);
        }
    }
    fn hessian(&self, _mu: &Vector, out: &mut Matrix) {
        *out = self.zero_jacobian();
        for (k, &(from, to)) in PLANES.iter().enumerate() {
            out[(k, k)] = 1.0 / (self.0[from] + self.0[to]);
        }
    }
    fn poisson_matrix(&self, mu: &Vector, out: &mut Matrix) {
        for k in 0..6 {
            let mut unit = self.zero_state();
            unit[k] = 1.0;
            let mut column = unit;
            self.ad_star(&unit, mu, &mut column);
            out.set_column(k, &column);
        }
    }
    fn jacobian(&self, mu: &Vector, out: &mut Matrix) {
        generic::jacobian(self, mu, out);
    }
    fn casimirs(&self, _mu: &Vector, _out: &mut [f64]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Vector, _out: &mut Vector) {}
}

impl LiePoisson<f64> for Body4 {
    fn ad(&self, xi: &Vector, eta: &Vector, out: &mut Vector) {
        let (xi, eta) = (matrix(xi), matrix(eta));
        *out = coordinates(&(xi * eta - eta * xi));
    }
    fn ad_star(&self, xi: &Vector, mu: &Vector, out: &mut Vector) {
        let (xi, mu) = (matrix(xi), matrix(mu));
        *out = coordinates(&(mu * xi - xi * mu));
    }
    fn ad_star_matrix(&self, xi: &Vector, out: &mut Matrix) {
        generic::ad_star_matrix(self, xi, out);
    }
}

const TURNS: [Plane; 6] = [
    Plane::new(0, 1),
    Plane::new(0, 2),
    Plane::new(0, 3),
    Plane::new(1, 2),
    Plane::new(1, 3),
    Plane::new(2, 3),
];

impl InertiaPoisson<f64> for Body4 {
    type Matrix = Square;
    fn planes(&self) -> &[Plane] {
        &TURNS
    }
    fn zero_matrix(&self) -> Square {
        Square::zeros()
    }
    fn moment(&self, axis: usize) -> f64 {
        self.0[axis]
    }
}

lie_runtime::generic_equations!([] Body4, f64: moser_veselov_n);
