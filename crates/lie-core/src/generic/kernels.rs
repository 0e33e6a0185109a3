//! Vector field, Jacobian and coadjoint action from the Poisson matrix, gradient and Hessian.

use crate::lagrangian::LagrangianPoisson;
use crate::matrix::SquareMatrix;
use crate::newton::exchanging;
use crate::poisson::{LiePoisson, Lift, Poisson};
use crate::scalar::{Dual, Scalar};
use crate::state::State;

/// Matrix times vector: `out_i = sum_j matrix_ij vector_j`, summed in order of j.
pub fn multiply<S: Scalar, M: SquareMatrix<S>, V: State<S>>(matrix: &M, vector: &V, out: &mut V) {
    let vector = vector.as_slice();
    for (row, out) in out.as_mut_slice().iter_mut().enumerate() {
        let mut sum = S::zero();
        for (column, &entry) in vector.iter().enumerate() {
            sum += matrix.get(row, column) * entry;
        }
        *out = sum;
    }
}

/// `out = h xi(mu)` with the generator xi, grad H where nothing damps.
pub(crate) fn direction<S: Scalar, P: Poisson<S>>(
    system: &P,
    h: S,
    mu: &P::State,
    out: &mut P::State,
) {
    system.generator(mu, out);
    for entry in out.as_mut_slice() {
        *entry *= h;
    }
}

/// The vector field `f = Pi(mu) xi(mu)` with the generator `xi`, grad H where nothing damps, and the force beside it.
pub fn vector_field<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State, out: &mut P::State) {
    let mut generator = system.zero_state();
    system.generator(mu, &mut generator);
    let mut poisson_matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut poisson_matrix);
    multiply(&poisson_matrix, &generator, out);
    if system.is_forced() {
        let force = &mut generator;
        system.force(mu, force);
        let slots = out.as_mut_slice().iter_mut();
        slots
            .zip(force.as_slice())
            .for_each(|(slot, &f)| *slot += f);
    }
}

/// The Jacobian of the vector field, `Df = D(Pi xi) + Pi(mu) Dxi(mu)` with the generator `xi(mu)` fixed in the first term, which for a
/// Lie algebra is `ad*_xi`, and that of the force beside it. Where nothing damps, `Dxi = H''`.
pub fn jacobian<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State, out: &mut P::Jacobian) {
    let mut generator = system.zero_state();
    system.generator(mu, &mut generator);
    system.poisson_slope(mu, &generator, out);
    let mut poisson_matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut poisson_matrix);
    let mut slope = system.zero_jacobian();
    system.generator_slope(mu, &mut slope);
    for row in 0..system.dimension() {
        for column in 0..system.dimension() {
            let mut sum = out.get(row, column);
            for middle in 0..system.dimension() {
                sum += poisson_matrix.get(row, middle) * slope.get(middle, column);
            }
            out.set(row, column, sum);
        }
    }
    if system.is_forced() {
        system.force_slope(mu, &mut slope);
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let sum = out.get(row, column) + slope.get(row, column);
                out.set(row, column, sum);
            }
        }
    }
}

/// What damps, beside the gradient: adds `c G Pi(mu) xi` to `xi = grad H`.
pub fn add_damping<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State, xi: &mut P::State) {
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut matrix);
    let (mut rate, mut damping) = (system.zero_state(), system.zero_state());
    multiply(&matrix, xi, &mut rate);
    system.damping(mu, &rate, &mut damping);
    xi.axpy(S::one(), &damping);
}

/// The same for the derivative: adds `c G (D(Pi grad H) + Pi(mu) H'')` to H'', with grad H fixed in the first term.
pub fn add_damping_slope<S: Scalar, P: Poisson<S>>(
    system: &P,
    mu: &P::State,
    slope: &mut P::Jacobian,
) {
    let mut gradient = system.zero_state();
    system.gradient(mu, &mut gradient);
    let (mut turned, mut matrix) = (system.zero_jacobian(), system.zero_jacobian());
    system.poisson_slope(mu, &gradient, &mut turned);
    system.poisson_matrix(mu, &mut matrix);
    let (mut rate, mut damping) = (system.zero_state(), gradient);
    for column in 0..system.dimension() {
        for (row, rate) in rate.as_mut_slice().iter_mut().enumerate() {
            *rate = turned.get(row, column);
            for middle in 0..system.dimension() {
                *rate += matrix.get(row, middle) * slope.get(middle, column);
            }
        }
        system.damping(mu, &rate, &mut damping);
        for (row, &entry) in damping.as_slice().iter().enumerate() {
            slope.set(row, column, slope.get(row, column) + entry);
        }
    }
}

/// The Hessian of H by its gradient over dual numbers, column by column: what a system has that was declared for
/// methods without derivatives of the field.
pub fn hessian_by_duals<S: Scalar, P: Lift<S>>(system: &P, mu: &P::State, out: &mut P::Jacobian) {
    let lifted = system.lift();
    columns_by_duals(&lifted, mu.as_slice(), out, |q, out| {
        lifted.gradient(q, out)
    });
}

/// The Jacobian of the vector field by the field over dual numbers, column by column.
pub fn jacobian_by_duals<S: Scalar, P: Lift<S>>(system: &P, mu: &P::State, out: &mut P::Jacobian) {
    let lifted = system.lift();
    columns_by_duals(&lifted, mu.as_slice(), out, |q, out| {
        lifted.vector_field(q, out)
    });
}

/// The gradient of a Casimir by the values of all Casimirs over dual numbers, entry by entry; `values` is scratch space
/// for them.
pub fn casimir_gradient_by_duals<S: Scalar, P: Lift<S>>(
    system: &P,
    index: usize,
    mu: &P::State,
    out: &mut P::State,
    values: &mut [Dual<S>],
) {
    let lifted = system.lift();
    let mut q = lifted.zero_state();
    for (entry, &coordinate) in q.as_mut_slice().iter_mut().zip(mu.as_slice()) {
        *entry = Dual::constant_of(coordinate);
    }
    for (place, out) in out.as_mut_slice().iter_mut().enumerate() {
        q.as_mut_slice()[place].derivative = S::one();
        lifted.casimirs(&q, values);
        q.as_mut_slice()[place].derivative = S::zero();
        *out = values[index].derivative;
    }
}

/// `out_ij = dv_i/dmu_j` of a vector v that is computed over dual numbers.
fn columns_by_duals<S: Scalar, L: Poisson<Dual<S>>, M: SquareMatrix<S>>(
    lifted: &L,
    mu: &[S],
    out: &mut M,
    vector: impl Fn(&L::State, &mut L::State),
) {
    let (mut q, mut value) = (lifted.zero_state(), lifted.zero_state());
    for (entry, &coordinate) in q.as_mut_slice().iter_mut().zip(mu) {
        *entry = Dual::constant_of(coordinate);
    }
    for column in 0..mu.len() {
        q.as_mut_slice()[column].derivative = S::one();
        vector(&q, &mut value);
        q.as_mut_slice()[column].derivative = S::zero();
        for (row, entry) in value.as_slice().iter().enumerate() {
            out.set(row, column, entry.derivative);
        }
    }
}

/// The vector field and its Jacobian together.
pub fn linearize<S: Scalar, P: Poisson<S>>(
    system: &P,
    mu: &P::State,
    field: &mut P::State,
    out: &mut P::Jacobian,
) {
    vector_field(system, mu, field);
    jacobian(system, mu, out);
}

/// The derivative of `mu -> Pi(mu) xi` for a Poisson matrix that is affine in mu, as that of a Lie
/// algebra is: column j is `(Pi(e_j) - Pi(0)) xi`.
pub fn poisson_slope<S: Scalar, P: Poisson<S>>(system: &P, xi: &P::State, out: &mut P::Jacobian) {
    let mut matrix = system.zero_jacobian();
    let (mut at_origin, mut column) = (system.zero_state(), system.zero_state());
    system.poisson_matrix(&system.zero_state(), &mut matrix);
    multiply(&matrix, xi, &mut at_origin);
    for k in 0..system.dimension() {
        let mut unit = system.zero_state();
        unit.as_mut_slice()[k] = S::one();
        system.poisson_matrix(&unit, &mut matrix);
        multiply(&matrix, xi, &mut column);
        let pairs = column.as_slice().iter().zip(at_origin.as_slice());
        for (row, (&entry, &origin)) in pairs.enumerate() {
            out.set(row, k, entry - origin);
        }
    }
}

/// The bracket by the coadjoint action: `<e^k, [xi, eta]> = <ad*_xi e^k, eta>` with the unit covector `e^k`.
pub fn ad<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    xi: &P::State,
    eta: &P::State,
    out: &mut P::State,
) {
    let (mut unit, mut column) = (system.zero_state(), system.zero_state());
    for k in 0..system.dimension() {
        unit.as_mut_slice()[k] = S::one();
        system.ad_star(xi, &unit, &mut column);
        unit.as_mut_slice()[k] = S::zero();
        let products = column.as_slice().iter().zip(eta.as_slice());
        out.as_mut_slice()[k] = products.fold(S::zero(), |sum, (&c, &e)| sum + c * e);
    }
}

/// The coadjoint action by the Poisson matrix: `ad*_xi mu = Pi(mu) xi`.
pub fn ad_star<S: Scalar, P: Poisson<S>>(
    system: &P,
    xi: &P::State,
    mu: &P::State,
    out: &mut P::State,
) {
    let mut poisson_matrix = system.zero_jacobian();
    system.poisson_matrix(mu, &mut poisson_matrix);
    multiply(&poisson_matrix, xi, out);
}

/// The matrix of `ad*_xi` from its columns `ad*_xi e_k`.
pub fn ad_star_matrix<S: Scalar, P: LiePoisson<S>>(
    system: &P,
    xi: &P::State,
    out: &mut P::Jacobian,
) {
    let mut column = system.zero_state();
    for k in 0..system.dimension() {
        let mut unit = system.zero_state();
        unit.as_mut_slice()[k] = S::one();
        system.ad_star(xi, &unit, &mut column);
        for (row, &entry) in column.as_slice().iter().enumerate() {
            out.set(row, k, entry);
        }
    }
}

/// The Euler–Poincaré equations as a field of velocities: `xi' = l''(xi)^-1 ad*_xi l'(xi)`.
pub fn euler_poincare<S: Scalar, P: LagrangianPoisson<S>>(
    system: &P,
    xi: &P::State,
    out: &mut P::State,
) {
    let mut momentum = system.zero_state();
    system.momentum(xi, &mut momentum);
    system.ad_star(xi, &momentum, out);
    let mut inertia = system.zero_jacobian();
    system.inertia(xi, &mut inertia);
    exchanging::solve(&mut inertia, out);
}
