//! Generated kernels against generic ones.

use lie_runtime::generic;
use lie_runtime::{Dual, LiePoisson, Poisson, Scalar, State, Unknown};

use crate::errors::{Errors, entries, nudged};
use crate::systems::{Random, state};

/// Derivatives along each coordinate of several functions of the state: `out[function][coordinate]`.
pub fn derivatives<Q: Poisson<Dual<f64>>>(
    dual: &Q,
    mu: &[f64],
    functions: usize,
    evaluate: impl Fn(&Q::State, &mut [Dual<f64>]),
) -> Vec<f64> {
    let mut all = vec![0.0; functions * dual.dimension()];
    let mut values = vec![Dual::zero(); functions];
    for column in 0..dual.dimension() {
        let mut seeded = dual.zero_state();
        for (row, entry) in seeded.as_mut_slice().iter_mut().enumerate() {
            *entry = Dual::new(mu[row], if row == column { 1.0 } else { 0.0 });
        }
        evaluate(&seeded, &mut values);
        for (function, value) in values.iter().enumerate() {
            all[function * dual.dimension() + column] = value.derivative;
        }
    }
    all
}

/// The kernels of a system against a reference with the same parameters.
pub fn kernels<P, Q>(
    fused: &P,
    reference: &P,
    dual: &Q,
    mu: &[f64],
    random: &mut Random,
    errors: &mut Errors,
) where
    P: LiePoisson<f64>,
    Q: LiePoisson<Dual<f64>>,
{
    of_poisson(fused, reference, dual, mu, random, errors);
    of_algebra(fused, reference, mu, random, errors);
}

/// The kernels that every Poisson system has.
pub fn of_poisson<P, Q>(
    fused: &P,
    reference: &P,
    dual: &Q,
    mu: &[f64],
    random: &mut Random,
    errors: &mut Errors,
) where
    P: Poisson<f64>,
    Q: Poisson<Dual<f64>>,
{
    let other = nudged(mu, errors);
    let (mu, nu) = (state(fused, mu), state(fused, &other));
    let mut vector = [fused.zero_state(), fused.zero_state()];
    let mut matrix = [fused.zero_jacobian(), fused.zero_jacobian()];

    // derivatives of H
    let slope = derivatives(dual, &other, 1, |mu, out| out[0] = dual.hamiltonian(mu));
    fused.gradient(&mu, &mut vector[0]);
    errors.compare("gradient", vector[0].as_slice(), &slope);
    let slope = derivatives(dual, &other, fused.dimension(), |mu, out| {
        let mut gradient = dual.zero_state();
        dual.gradient(mu, &mut gradient);
        out.copy_from_slice(gradient.as_slice());
    });
    fused.hessian(&mu, &mut matrix[0]);
    errors.compare("hessian", &entries(&matrix[0]), &slope);

    // the vector field
    fused.vector_field(&mu, &mut vector[0]);
    generic::vector_field(reference, &nu, &mut vector[1]);
    errors.compare("vector_field", vector[0].as_slice(), vector[1].as_slice());
    fused.jacobian(&mu, &mut matrix[0]);
    generic::jacobian(reference, &nu, &mut matrix[1]);
    errors.compare("jacobian", &entries(&matrix[0]), &entries(&matrix[1]));
    let slope = derivatives(dual, &other, fused.dimension(), |mu, out| {
        let mut field = dual.zero_state();
        dual.vector_field(mu, &mut field);
        out.copy_from_slice(field.as_slice());
    });
    errors.compare("jacobian", &entries(&matrix[0]), &slope);
    fused.linearize(&mu, &mut vector[0], &mut matrix[0]);
    generic::linearize(reference, &nu, &mut vector[1], &mut matrix[1]);
    errors.compare(
        "linearize, field",
        vector[0].as_slice(),
        vector[1].as_slice(),
    );
    errors.compare(
        "linearize, jacobian",
        &entries(&matrix[0]),
        &entries(&matrix[1]),
    );

    // the derivative of the Poisson matrix against a vector
    let coordinates = random.numbers(fused.dimension());
    let xi = state(fused, &coordinates);
    let turned = nudged(&coordinates, errors);
    fused.poisson_slope(&mu, &xi, &mut matrix[0]);
    let slope = derivatives(dual, &other, fused.dimension(), |mu, out| {
        let (xi, mut image) = (state(dual, &turned), dual.zero_state());
        generic::ad_star(dual, &xi, mu, &mut image);
        out.copy_from_slice(image.as_slice());
    });
    errors.compare("poisson_slope", &entries(&matrix[0]), &slope);

    casimirs(fused, dual, &mu, nu.as_slice(), errors);
}

/// The kernels of the algebra.
fn of_algebra<P: LiePoisson<f64>>(
    fused: &P,
    reference: &P,
    mu: &[f64],
    random: &mut Random,
    errors: &mut Errors,
) {
    let other = nudged(mu, errors);
    let (mu, nu) = (state(fused, mu), state(fused, &other));
    let mut vector = [fused.zero_state(), fused.zero_state()];
    let mut matrix = [fused.zero_jacobian(), fused.zero_jacobian()];
    let coordinates = random.numbers(fused.dimension());
    let (xi, other) = (
        state(fused, &coordinates),
        state(fused, &nudged(&coordinates, errors)),
    );
    let eta = state(fused, &random.numbers(fused.dimension()));
    fused.coadjoint_action(&xi, &mu, &mut vector[0]);
    generic::coadjoint_action(reference, &other, &nu, &mut vector[1]);
    let [left, right] = [&vector[0], &vector[1]].map(State::as_slice);
    errors.compare("coadjoint_action", left, right);
    fused.dexp_dual(&xi, &mu, &mut vector[0]);
    generic::dexp_dual(reference, &other, &nu, &mut vector[1]);
    let [left, right] = [&vector[0], &vector[1]].map(State::as_slice);
    errors.compare("dexp_dual", left, right);
    let [left, right] = &mut matrix;
    fused.dexp_dual_slope(&xi, &mu, &mut vector[0], left);
    generic::dexp_dual_slope(reference, &other, &nu, &mut vector[1], right);
    errors.compare("dexp_dual_slope", &entries(left), &entries(right));
    fused.ad_star(&xi, &mu, &mut vector[0]);
    generic::ad_star(reference, &other, &nu, &mut vector[1]);
    errors.compare("ad_star", vector[0].as_slice(), vector[1].as_slice());
    let pairing = |a: &P::State, b: &P::State| -> f64 {
        a.as_slice()
            .iter()
            .zip(b.as_slice())
            .map(|(a, b)| a * b)
            .sum()
    };
    fused.ad(&xi, &eta, &mut vector[0]);
    errors.compare(
        "ad",
        &[pairing(&mu, &vector[0])],
        &[pairing(&vector[1], &eta)],
    );
    fused.ad_star_matrix(&xi, &mut matrix[0]);
    generic::ad_star_matrix(reference, &other, &mut matrix[1]);
    errors.compare("ad_star_matrix", &entries(&matrix[0]), &entries(&matrix[1]));
    // {mu_i, mu_j} = -<mu, [e_i, e_j]>
    fused.poisson_matrix(&mu, &mut matrix[0]);
    let unit = |index: usize| {
        let mut unit = vec![0.0; fused.dimension()];
        unit[index] = 1.0;
        state(fused, &unit)
    };
    let mut brackets = Vec::new();
    for row in 0..fused.dimension() {
        for column in 0..fused.dimension() {
            reference.ad(&unit(row), &unit(column), &mut vector[0]);
            brackets.push(-pairing(&nu, &vector[0]));
        }
    }
    errors.compare("poisson_matrix", &entries(&matrix[0]), &brackets);
}

/// Gradients of the Casimirs, which the Poisson matrix takes to zero.
pub fn casimirs<P, Q>(fused: &P, dual: &Q, mu: &P::State, other: &[f64], errors: &mut Errors)
where
    P: Poisson<f64>,
    Q: Poisson<Dual<f64>>,
{
    let slopes = derivatives(dual, other, fused.casimir_count(), |mu, out| {
        dual.casimirs(mu, out)
    });
    let (mut gradient, mut image) = (fused.zero_state(), fused.zero_state());
    for (index, slope) in slopes.chunks(fused.dimension()).enumerate() {
        fused.casimir_gradient(index, mu, &mut gradient);
        errors.compare("casimir_gradient", gradient.as_slice(), slope);
        assert!(
            Unknown::<f64>::max_norm(&gradient) > 1e-3,
            "Casimir {index} is constant"
        );
        generic::ad_star(fused, &gradient, mu, &mut image);
        let zero = vec![errors.nudge; fused.dimension()];
        errors.compare("bracket of a Casimir", image.as_slice(), &zero);
    }
}
