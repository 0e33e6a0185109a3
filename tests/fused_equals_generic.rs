//! Every generated kernel equals its generic reference, on random states of every system.
//!
//! References: the derivatives of H and of the Casimirs by dual numbers, the vector field as Poisson
//! matrix times gradient and the other forms of [`lie_runtime::generic`], the triple product by
//! matrices, and the generic equation of each implicit method.

#[macro_use]
#[path = "common/systems.rs"]
mod systems;
#[path = "common/vectors.rs"]
mod vectors;

use lie_runtime::generic;
use lie_runtime::{
    CayleyEquations, CayleyPoisson, Dual, Equation, GaussEquations, LieMidpointEquations,
    LiePoisson, MidpointEquations, Poisson, Scalar, SquareMatrix, State, Unknown,
};
use systems::{
    CotangentEulerArnold, Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, ManakovTop,
    NonpolynomialSpin, Pendulum, Random, Sl2Quadratic, TodaLattice, relative_distance, state,
};
use vectors::{Reference, rows};

/// Round-off of a few dozen operations on numbers near 1.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
/// Random states per system.
const STATES: usize = 20;

/// The errors of all kernels, relative to the size of what was compared.
struct Errors {
    found: Vec<(String, f64)>,
    /// The references are taken at states that differ by this factor from 1: 0, or what a control
    /// must notice.
    nudge: f64,
}

impl Errors {
    fn new(nudge: f64) -> Self {
        Self {
            found: Vec::new(),
            nudge,
        }
    }

    fn compare(&mut self, what: &str, fused: &[f64], reference: &[f64]) {
        self.found
            .push((what.to_owned(), relative_distance(fused, reference)));
    }

    /// The kernels whose error is beyond round-off; not a number counts.
    fn beyond_round_off(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for (name, error) in &self.found {
            if error.partial_cmp(&ROUND_OFF) != Some(std::cmp::Ordering::Less)
                && !names.contains(&name.as_str())
            {
                names.push(name);
            }
        }
        names
    }

    fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.found.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    fn largest(&self) -> (f64, &str) {
        let start = (0.0, "none");
        self.found
            .iter()
            .fold(start, |(largest, name), (new, error)| {
                if *error > largest {
                    (*error, new.as_str())
                } else {
                    (largest, name)
                }
            })
    }
}

/// All entries, row after row.
fn entries<M: SquareMatrix<f64>>(matrix: &M) -> Vec<f64> {
    let size = matrix.dimension();
    let places = (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
    places
        .map(|(row, column)| matrix.get(row, column))
        .collect()
}

fn unknown_entries<U: Unknown<f64>>(unknown: &U) -> Vec<f64> {
    (0..unknown.len())
        .map(|index| unknown.entry(index))
        .collect()
}

/// A state near the initial one.
fn near<D: Declared>(random: &mut Random) -> Vec<f64> {
    let initial = D::initial::<f64>();
    initial
        .as_slice()
        .iter()
        .map(|x| x + 0.5 * random.number())
        .collect()
}

fn nudged(values: &[f64], errors: &Errors) -> Vec<f64> {
    values.iter().map(|x| x * (1.0 + errors.nudge)).collect()
}

/// Derivatives along each coordinate of several functions of the state: `out[function][coordinate]`.
fn derivatives<Q: Poisson<Dual<f64>>>(
    dual: &Q,
    mu: &[f64],
    functions: usize,
    evaluate: impl Fn(&Q::State, &mut [Dual<f64>]),
) -> Vec<f64> {
    let mut all = vec![0.0; functions * Q::DIM];
    let mut values = vec![Dual::zero(); functions];
    for column in 0..Q::DIM {
        let mut seeded = dual.zero_state();
        for (row, entry) in seeded.as_mut_slice().iter_mut().enumerate() {
            *entry = Dual::new(mu[row], if row == column { 1.0 } else { 0.0 });
        }
        evaluate(&seeded, &mut values);
        for (function, value) in values.iter().enumerate() {
            all[function * Q::DIM + column] = value.derivative;
        }
    }
    all
}

/// The kernels of a system against a reference with the same parameters.
fn kernels<P, Q>(
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
    let other = nudged(mu, errors);
    let (mu, nu) = (state(fused, mu), state(fused, &other));
    let mut vector = [fused.zero_state(), fused.zero_state()];
    let mut matrix = [fused.zero_jacobian(), fused.zero_jacobian()];

    // derivatives of H
    let slope = derivatives(dual, &other, 1, |mu, out| out[0] = dual.hamiltonian(mu));
    fused.gradient(&mu, &mut vector[0]);
    errors.compare("gradient", vector[0].as_slice(), &slope);
    let slope = derivatives(dual, &other, P::DIM, |mu, out| {
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
    let slope = derivatives(dual, &other, P::DIM, |mu, out| {
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

    // the algebra
    let coordinates = random.numbers(P::DIM);
    let (xi, other) = (
        state(fused, &coordinates),
        state(fused, &nudged(&coordinates, errors)),
    );
    let eta = state(fused, &random.numbers(P::DIM));
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
        let mut unit = vec![0.0; P::DIM];
        unit[index] = 1.0;
        state(fused, &unit)
    };
    let mut brackets = Vec::new();
    for row in 0..P::DIM {
        for column in 0..P::DIM {
            reference.ad(&unit(row), &unit(column), &mut vector[0]);
            brackets.push(-pairing(&nu, &vector[0]));
        }
    }
    errors.compare("poisson_matrix", &entries(&matrix[0]), &brackets);

    casimirs(fused, dual, &mu, nu.as_slice(), errors);
}

/// Gradients of the Casimirs, which the Poisson matrix takes to zero.
fn casimirs<P, Q>(fused: &P, dual: &Q, mu: &P::State, other: &[f64], errors: &mut Errors)
where
    P: LiePoisson<f64>,
    Q: LiePoisson<Dual<f64>>,
{
    let slopes = derivatives(dual, other, P::CASIMIRS, |mu, out| dual.casimirs(mu, out));
    let (mut gradient, mut image) = (fused.zero_state(), fused.zero_state());
    for (index, slope) in slopes.chunks(P::DIM).enumerate() {
        fused.casimir_gradient(index, mu, &mut gradient);
        errors.compare("casimir_gradient", gradient.as_slice(), slope);
        assert!(
            Unknown::<f64>::max_norm(&gradient) > 1e-3,
            "Casimir {index} is constant"
        );
        fused.ad_star(&gradient, mu, &mut image);
        let zero = vec![errors.nudge; P::DIM];
        errors.compare("bracket of a Casimir", image.as_slice(), &zero);
    }
}

/// An equation against its generic form: start, residual, Jacobian, correction, result.
fn equation<F, G>(
    name: &str,
    fused: &mut F,
    reference: &mut G,
    mu: &F::State,
    random: &mut Random,
    errors: &mut Errors,
) where
    F: Equation<f64>,
    G: Equation<f64, State = F::State, Unknown = F::Unknown>,
{
    fused.set_base(mu);
    let mut base = mu.clone();
    base.as_mut_slice()
        .iter_mut()
        .for_each(|x| *x *= 1.0 + errors.nudge);
    reference.set_base(&base);
    let (mut unknown, mut start) = (fused.zero_unknown(), fused.zero_unknown());
    fused.initial_guess(&mut start);
    reference.initial_guess(&mut unknown);
    errors.compare(
        &format!("{name}, initial_guess"),
        &unknown_entries(&start),
        &unknown_entries(&unknown),
    );
    // off the solution, as in the first iterations
    for index in 0..unknown.len() {
        unknown.set_entry(index, unknown.entry(index) + 0.05 * random.number());
    }
    let mut other = unknown.clone();
    for index in 0..unknown.len() {
        other.set_entry(index, unknown.entry(index) * (1.0 + errors.nudge));
    }
    let mut residuals = [fused.zero_unknown(), fused.zero_unknown()];
    fused.residual(&unknown, &mut residuals[0]);
    reference.residual(&other, &mut residuals[1]);
    let [left, right] = residuals.each_ref().map(unknown_entries);
    errors.compare(&format!("{name}, residual"), &left, &right);
    let (mut left, mut right) = (fused.zero_matrix(), reference.zero_matrix());
    fused.linearize(&unknown, &mut residuals[0], &mut left);
    errors.compare(
        &format!("{name}, residual of linearize"),
        &unknown_entries(&residuals[0]),
        &unknown_entries(&residuals[1]),
    );
    reference.linearize(&other, &mut residuals[1], &mut right);
    errors.compare(
        &format!("{name}, Jacobian"),
        &entries(&left),
        &entries(&right),
    );
    assert!(
        fused.factor(&mut left) && reference.factor(&mut right),
        "{name}: the pivots are near 1"
    );
    fused.solve(&left, &mut residuals[0]);
    reference.solve(&right, &mut residuals[1]);
    let [left, right] = residuals.each_ref().map(unknown_entries);
    errors.compare(&format!("{name}, correction"), &left, &right);
    let (mut end, mut expected) = (mu.clone(), mu.clone());
    fused.result(&unknown, &mut end);
    reference.result(&other, &mut expected);
    errors.compare(
        &format!("{name}, result"),
        end.as_slice(),
        expected.as_slice(),
    );
}

/// The equations that every Lie–Poisson system has.
fn equations<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: MidpointEquations<f64>
        + GaussEquations<f64, 1>
        + GaussEquations<f64, 2>
        + GaussEquations<f64, 3>
        + LieMidpointEquations<f64>,
{
    let left = &mut fused.midpoint_equation(h);
    equation(
        "midpoint",
        left,
        &mut generic::Midpoint::new(reference, h),
        mu,
        random,
        errors,
    );
    let left = &mut GaussEquations::<f64, 1>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 1>::new(reference, h);
    equation("gauss2", left, right, mu, random, errors);
    let left = &mut GaussEquations::<f64, 2>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 2>::new(reference, h);
    equation("gauss4", left, right, mu, random, errors);
    let left = &mut GaussEquations::<f64, 3>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 3>::new(reference, h);
    equation("gauss6", left, right, mu, random, errors);
    let left = &mut fused.exp_equation(h);
    equation(
        "exp",
        left,
        &mut generic::ExpMidpoint::new(reference, h),
        mu,
        random,
        errors,
    );
}

fn cayley_equation<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: CayleyEquations<f64>,
{
    let left = &mut fused.cayley_equation(h);
    equation(
        "cayley",
        left,
        &mut generic::CayleyMidpoint::new(reference, h),
        mu,
        random,
        errors,
    );
}

/// All that every system has, on random states.
fn all<D: Declared>(fused: &D::System<f64>, nudge: f64) -> Errors {
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let (reference, dual) = (D::declared::<f64>(), D::declared::<Dual<f64>>());
    for _ in 0..STATES {
        let mu = near::<D>(&mut random);
        kernels(fused, &reference, &dual, &mu, &mut random, &mut errors);
        let mu = state(fused, &mu);
        let h = 0.1 * random.number();
        equations(fused, &reference, &mu, h, &mut random, &mut errors);
    }
    errors
}

/// The Cayley equation on random states.
fn cayley<D: Declared>(fused: &D::System<f64>, nudge: f64) -> Errors
where
    D::System<f64>: CayleyEquations<f64>,
{
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let reference = D::declared::<f64>();
    for _ in 0..STATES {
        let mu = state(fused, &near::<D>(&mut random));
        let h = 0.1 * random.number();
        cayley_equation(fused, &reference, &mu, h, &mut random, &mut errors);
    }
    errors
}

/// Square matrices of the declared representation, row after row.
struct Representation {
    size: usize,
    basis: Vec<Vec<f64>>,
}

impl Representation {
    fn of(name: &str) -> Self {
        let file = Reference::vector(name);
        let matrices = file.0["matrix_representation"]
            .as_array()
            .expect("matrices");
        let basis: Vec<Vec<f64>> = matrices
            .iter()
            .map(|matrix| rows(matrix).concat())
            .collect();
        Self {
            size: basis[0].len().isqrt(),
            basis,
        }
    }

    fn element(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.size * self.size];
        for (matrix, x) in self.basis.iter().zip(coordinates) {
            sum.iter_mut()
                .zip(matrix)
                .for_each(|(sum, entry)| *sum += x * entry);
        }
        sum
    }

    fn product(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let n = self.size;
        let entry =
            |row: usize, column: usize| (0..n).map(|k| a[row * n + k] * b[k * n + column]).sum();
        (0..n * n)
            .map(|index| entry(index / n, index % n))
            .collect()
    }

    /// The coordinates of a matrix in the span of the basis, by the normal equations.
    fn coordinates(&self, matrix: &[f64]) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let count = self.basis.len();
        let mut rows: Vec<Vec<f64>> = (self.basis.iter())
            .map(|a| {
                self.basis
                    .iter()
                    .map(|b| dot(a, b))
                    .chain([dot(a, matrix)])
                    .collect()
            })
            .collect();
        for pivot in 0..count {
            let row = rows[pivot].clone();
            for other in (0..count).filter(|&other| other != pivot) {
                let factor = rows[other][pivot] / row[pivot];
                rows[other]
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(x, y)| *x -= factor * y);
            }
        }
        let coordinates: Vec<f64> = (0..count)
            .map(|index| rows[index][count] / rows[index][index])
            .collect();
        assert!(
            relative_distance(&self.element(&coordinates), matrix) < ROUND_OFF,
            "not in the span"
        );
        coordinates
    }
}

/// The triple product `out_b = <mu, (x e_b z + z e_b x)/2>` by products of matrices.
fn triple<D: Declared>(nudge: f64) -> Errors
where
    D::System<f64>: CayleyPoisson<f64>,
{
    let mut random = Random(2018);
    let mut errors = Errors::new(nudge);
    let system = D::declared::<f64>();
    let representation = Representation::of(D::FILE);
    let dimension = representation.basis.len();
    for _ in 0..STATES {
        let [x, z, mu] = [(); 3].map(|()| random.numbers(dimension));
        let mut out = system.zero_state();
        let [a, b, c] = [&x, &z, &mu].map(|coordinates| state(&system, coordinates));
        system.triple(&a, &b, &c, &mut out);
        let [x, z] =
            [&nudged(&x, &errors), &z].map(|coordinates| representation.element(coordinates));
        let mut expected = Vec::new();
        for e in &representation.basis {
            let product =
                |a: &[f64], b: &[f64]| representation.product(&representation.product(a, e), b);
            let (xez, zex) = (product(&x, &z), product(&z, &x));
            let half_sum: Vec<f64> = xez.iter().zip(&zex).map(|(a, b)| (a + b) / 2.0).collect();
            let coordinates = representation.coordinates(&half_sum);
            expected.push(coordinates.iter().zip(&mu).map(|(a, b)| a * b).sum::<f64>());
        }
        errors.compare("triple", out.as_slice(), &expected);
    }
    errors
}

fn check<D: Declared>(errors: &Errors) {
    let (largest, name) = errors.largest();
    println!("{}: largest error {largest:.1e} ({name})", D::FILE);
    assert_eq!(
        errors.beyond_round_off(),
        [""; 0],
        "{}: {largest:e} ({name})",
        D::FILE
    );
}

macro_rules! cayley_test {
    ($system:ident, cayley) => {
        #[test]
        fn cayley() {
            use super::*;
            super::check::<$system>(&super::cayley::<$system>(&$system::declared::<f64>(), 0.0));
            super::check::<$system>(&super::triple::<$system>(0.0));
        }
    };
    ($system:ident, exp) => {};
}

macro_rules! tests {
    ($file:ident, $system:ident, $cayley:ident) => {
        mod $file {
            #[test]
            fn fused_equals_generic() {
                use super::*;
                check::<$system>(&all::<$system>(&$system::declared::<f64>(), 0.0));
            }
            cayley_test!($system, $cayley);
        }
    };
}

each_system!(tests);

/// States that differ by 1e-9 are noticed by every comparison.
#[test]
fn every_comparison_notices_another_state() {
    let system = NonpolynomialSpin::declared::<f64>();
    for errors in [
        all::<NonpolynomialSpin>(&system, 1e-9),
        cayley::<NonpolynomialSpin>(&system, 1e-9),
        triple::<NonpolynomialSpin>(1e-9),
    ] {
        let mut noticed = errors.beyond_round_off();
        noticed.sort_unstable();
        assert_eq!(noticed, errors.names());
    }
}

/// A kernel with one coefficient changed by 1e-9 is noticed.
#[test]
fn a_changed_coefficient_is_noticed() {
    let changed = HeavyTop {
        I1: 2.0 * (1.0 + 1e-9),
        ..HeavyTop::<f64>::default()
    };
    let changed = changed.system().expect("valid parameters");
    let errors = all::<HeavyTop>(&changed, 0.0);
    let noticed = errors.beyond_round_off();
    let of_the_algebra = [
        "ad",
        "ad_star",
        "ad_star_matrix",
        "poisson_matrix",
        "casimir_gradient",
        "bracket of a Casimir",
    ];
    for name in errors.names() {
        // the results of these are sums of the unknown
        let of_the_unknown = name.ends_with(", result")
            && (name.starts_with("gauss") || name.starts_with("midpoint"));
        let expected = !of_the_algebra.contains(&name) && !of_the_unknown;
        assert_eq!(noticed.contains(&name), expected, "{name}");
    }
    let errors = cayley::<HeavyTop>(&changed, 0.0);
    assert_eq!(errors.beyond_round_off().len(), errors.names().len());
}
