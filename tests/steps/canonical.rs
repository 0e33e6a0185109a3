//! Gauss methods in coordinates in which the bracket is constant: a guiding centre.

use crate::systems::distance;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect, reference, symmetry_defect};
use lie_runtime::methods::{Canonical2, Canonical4, Canonical6, Facts, Gauss4, Method};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{CanonicalPoisson, Lift, Poisson};

lie_poisson! {
    /// The guiding centre of a charged particle in a straight field, with a coordinate that is in no bracket, beside two species.
    pub system GuidingCentre;
    poisson {
        {x, y} = 1/(1 + x^2/4 + y^2/3 + x*y^2/5 + c*exp(y/2));
        {z, u} = 1;
        {p, q} = 2*p*(q + 1);
    }
    state x, y, z, u, p, q, c;
    let B = 1 + x^2/4 + y^2/3 + x*y^2/5 + c*exp(y/2);
    hamiltonian = u^2/2 + B/3 + x*cos(z)/4 + y^4/6 + z^2/4 + p - log(p) + q^2/2 + p*x*y/9;
    initial = [3/5, -2/5, 1/2, 3/10, 3/4, 1/5, 1/7];
    methods = [canonical2, canonical4, canonical6, gauss4];
}

fn system() -> (GuidingCentreSystem<f64>, Vec<f64>) {
    let declared = GuidingCentre::new();
    let system = declared.system().expect("constants");
    (system, declared.initial_state().as_slice().to_vec())
}

/// The local error of a step, by one with many digits: slopes near 3 and 5 for orders 2 and 4.
#[test]
fn orders_and_symmetry() {
    fn check<M>(method: &M, counts: [u32; 5])
    where
        M: Facts + Method<f64, GuidingCentreSystem<f64>> + 'static,
    {
        let (system, start) = system();
        let mut state = system.zero_state();
        state.as_mut_slice().copy_from_slice(&start);
        let options = NewtonOptions::default();
        let points = counts.map(|steps| {
            let h = 1.0 / f64::from(steps);
            let exact = reference(&system, &state, h).expect("a solution").mu;
            let mut mu = state;
            let mut stepper = method.stepper(&system, h, &options);
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            (h, distance(mu.as_slice(), exact.as_slice()))
        });
        let order = order_of_convergence(&points, 1e-14).unwrap_or_else(|| panic!("{points:?}"));
        let stated = f64::from(M::ORDER) + 1.0;
        println!("{}: {}", M::ID, order.slope);
        assert!(
            (order.slope - stated).abs() < 0.2,
            "{}: {} {points:?}",
            M::ID,
            order.slope
        );
        let off = symmetry_defect(&system, method, 0.1, &state, &options).expect("steps");
        assert!(off < 1e-14, "{}: {off:e}", M::ID);
    }
    let fine = [20, 28, 40, 56, 80];
    check(&Canonical2, fine);
    check(&Canonical4, fine);
    check(&Canonical6, [12, 16, 20, 24, 28]);
}

/// To round-off at any step; the control is Poisson to its order only.
#[test]
fn steps_are_poisson_maps() {
    let (system, start) = system();
    let dual = system.lift();
    let options = NewtonOptions::default();
    for h in [0.05, 0.2, 0.5] {
        let defects = [
            poisson_defect(&dual, &Canonical2, h, &start, &options),
            poisson_defect(&dual, &Canonical4, h, &start, &options),
            poisson_defect(&dual, &Canonical6, h, &start, &options),
        ];
        for defect in defects {
            let defect = defect.expect("the step converges");
            assert!(defect < 1e-13, "{h}: {defect:e}");
        }
    }
    let control = poisson_defect(&dual, &Gauss4, 0.2, &start, &options);
    assert!(control.expect("the step converges") > 1e-8);
}

/// The kernels by dual numbers: the field is the derivative of the coordinates along the field, the Jacobian one of the field in them, and what
/// moves the coordinates by a vector is moved back.
#[test]
fn kernels_are_derivatives_of_the_coordinates() {
    let (system, start) = system();
    let dual = system.lift();
    let n = system.dimension();
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(&start);
    let (mut field, mut along) = (system.zero_state(), system.zero_state());
    let mut pulled = system.zero_state();
    system.vector_field(&state, &mut field);
    system.canonical_field(&state, &mut along);
    let mut jacobian = system.zero_jacobian();
    system.canonical_jacobian(&state, &mut jacobian);
    // the derivative of coordinates, or of the field in them, along a vector
    let derivative = |vector: &[f64], of_field: bool| -> Vec<f64> {
        let mut point = dual.zero_state();
        for (k, entry) in point.as_mut_slice().iter_mut().enumerate() {
            *entry = Dual::constant_of(start[k]);
            entry.derivative = vector[k];
        }
        let mut out = dual.zero_state();
        match of_field {
            true => dual.canonical_field(&point, &mut out),
            false => dual.canonical(&point, &mut out),
        }
        out.as_slice()
            .iter()
            .map(|entry| entry.derivative)
            .collect()
    };
    let close = |a: f64, b: f64, what: &str| {
        assert!(
            (a - b).abs() < 1e-13 * (1.0 + a.abs()),
            "{what}: {a} and {b}"
        );
    };
    for (k, slope) in derivative(field.as_slice(), false).into_iter().enumerate() {
        close(slope, along[k], "field");
    }
    for k in 0..n {
        let unit: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == k))).collect();
        let column = derivative(&unit, false);
        let mut moved = system.zero_state();
        moved.as_mut_slice().copy_from_slice(&column);
        system.canonical_pull(&state, &moved, &mut pulled);
        for (i, &entry) in pulled.iter().enumerate() {
            close(entry, unit[i], "what is moved back");
        }
        for (i, entry) in derivative(&unit, true).into_iter().enumerate() {
            close(entry, jacobian[(i, k)], "Jacobian");
        }
    }
}
