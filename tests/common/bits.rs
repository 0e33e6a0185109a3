//! What systems of several back ends compute, and what differs between them, bit for bit.

use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, SquareMatrix, State};

pub const STEPS: usize = 40;
pub const STEP: f64 = 0.05;

/// What differs, by name.
#[derive(Default)]
pub struct Differences(pub Vec<String>);

impl Differences {
    pub fn compare(&mut self, what: &str, printed: &[f64], made: &[f64]) {
        // a zero has no sign here: what fills in is negated or subtracted from 0
        let same = |(a, b): (&f64, &f64)| (a + 0.0).to_bits() == (b + 0.0).to_bits();
        if let Some(place) = printed.iter().zip(made).position(|pair| !same(pair)) {
            let (printed, made) = (printed[place], made[place]);
            self.0
                .push(format!("{what}: {printed:?} {made:?} at {place}"));
        }
    }
}

pub fn entries<M: SquareMatrix<f64>>(matrix: &M) -> Vec<f64> {
    let n = matrix.dimension();
    let places = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    places.map(|(i, j)| matrix.get(i, j)).collect()
}

/// The kernels of a system at a state.
pub fn kernels<P: Poisson<f64>>(system: &P, mu: &[f64]) -> Vec<(&'static str, Vec<f64>)> {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(mu);
    let (mut out, mut matrix) = (system.zero_state(), system.zero_jacobian());
    let mut found = vec![
        ("hamiltonian", vec![system.hamiltonian(&state)]),
        ("energy", vec![system.energy(&state)]),
    ];
    system.gradient(&state, &mut out);
    found.push(("gradient", out.as_slice().to_vec()));
    system.vector_field(&state, &mut out);
    found.push(("vector_field", out.as_slice().to_vec()));
    system.hessian(&state, &mut matrix);
    found.push(("hessian", entries(&matrix)));
    system.poisson_matrix(&state, &mut matrix);
    found.push(("poisson_matrix", entries(&matrix)));
    system.jacobian(&state, &mut matrix);
    found.push(("jacobian", entries(&matrix)));
    system.linearize(&state, &mut out, &mut matrix);
    found.push(("linearize", [out.as_slice(), &entries(&matrix)].concat()));
    let mut casimirs = vec![0.0; system.casimir_count()];
    system.casimirs(&state, &mut casimirs);
    found.push(("casimirs", casimirs));
    let mut quantities = vec![0.0; system.quantity_count()];
    system.quantities(&state, &mut quantities);
    found.push(("quantities", quantities));
    for index in 0..system.casimir_count() {
        system.casimir_gradient(index, &state, &mut out);
        found.push(("casimir_gradient", out.as_slice().to_vec()));
    }
    found
}

/// The states along a trajectory.
pub fn trajectory<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &[f64],
) -> Result<Vec<f64>, String> {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(mu);
    let mut stepper = method.any_stepper(system, STEP, &NewtonOptions::default());
    let mut all = Vec::new();
    for _ in 0..STEPS {
        stepper
            .step(&mut state)
            .map_err(|failure| format!("{failure:?}"))?;
        all.extend_from_slice(state.as_slice());
    }
    Ok(all)
}
