//! Gauss methods in coordinates that are each a function of one: `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)` with `a_i` that are not linear.

use crate::systems::distance;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect, reference};
use lie_runtime::methods::{Canonical2, Canonical4, Facts, Gauss4, Method};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{CanonicalPoisson, Lift};
use nalgebra::Vector3;

type Vector = Vector3<f64>;

lie_poisson! {
    /// Constant in `atan(x)`, `log(y)` and `-1/z`.
    pub system Mixed;
    poisson {
        {x, y} = (1 + x^2)*y;
        {y, z} = 2*y*z^2;
        {x, z} = -(1 + x^2)*z^2/3;
    }
    state x, y, z;
    hamiltonian = x^2/2 + y - log(y)/2 + z^2/3 + x*y*z/5;
    casimir C = log(y) + 6*atan(x) - 3/z;
    initial = [3/10, 1, 7/10];
    methods = [canonical2, canonical4, gauss4];
}

lie_poisson! {
    /// A pair on a circle and a bounded interval: `{phi, s} = cos(phi)^2 s (1 - s)`, beside a root.
    pub system Bounded;
    poisson {
        {phi, s} = cos(phi)^2*s*(1 - s);
        {s, r} = s*(1 - s)*sqrt(r);
    }
    state phi, s, r;
    hamiltonian = phi^2/2 + 2*s^2 + r^2/4 + phi*s*r/3;
    initial = [1/5, 2/5, 4/5];
    methods = [canonical2, canonical4, gauss4];
}

fn mixed() -> (MixedSystem<f64>, Vector) {
    let declared = Mixed::new();
    (
        declared.system().expect("constants"),
        declared.initial_state(),
    )
}

/// The slope of the local error, by one with many digits.
#[test]
fn orders() {
    fn check<M: Facts + Method<f64, MixedSystem<f64>> + 'static>(method: &M) {
        let (system, start) = mixed();
        let points = [12.0, 16.0, 24.0, 32.0, 48.0].map(|steps: f64| {
            let h = 1.0 / steps;
            let exact = reference(&system, &start, h).expect("a solution").mu;
            let mut mu = start;
            let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            (h, distance(mu.as_slice(), exact.as_slice()))
        });
        let order = order_of_convergence(&points, 1e-14).unwrap_or_else(|| panic!("{points:?}"));
        let stated = f64::from(M::ORDER) + 1.0;
        let off = (order.slope - stated).abs();
        assert!(off < 0.2, "{}: {} {points:?}", M::ID, order.slope);
    }
    check(&Canonical2);
    check(&Canonical4);
}

/// To round-off at any step; the control is Poisson to its order only.
#[test]
fn steps_are_poisson_maps() {
    let options = NewtonOptions::default();
    let (system, start) = mixed();
    let dual = system.lift();
    let bounded = Bounded::new();
    let other = bounded.system().expect("constants").lift();
    let from = bounded.initial_state();
    for h in [0.05, 0.2, 0.4] {
        let defects = [
            poisson_defect(&dual, &Canonical2, h, start.as_slice(), &options),
            poisson_defect(&dual, &Canonical4, h, start.as_slice(), &options),
            poisson_defect(&other, &Canonical2, h, from.as_slice(), &options),
            poisson_defect(&other, &Canonical4, h, from.as_slice(), &options),
        ];
        for defect in defects {
            let defect = defect.expect("the step converges");
            assert!(defect < 1e-13, "{h}: {defect:e}");
        }
    }
    let controls = [
        poisson_defect(&dual, &Gauss4, 0.2, start.as_slice(), &options),
        poisson_defect(&other, &Gauss4, 0.2, from.as_slice(), &options),
    ];
    for control in controls {
        assert!(control.expect("the step converges") > 1e-8);
    }
}

/// The Casimir to round-off, which the same method in the declared coordinates loses.
#[test]
fn the_casimir_is_kept() {
    fn moved<M: Method<f64, MixedSystem<f64>>>(method: &M) -> f64 {
        let (system, start) = mixed();
        let casimir = |mu: &Vector| {
            let mut value = [0.0];
            system.casimirs(mu, &mut value);
            value[0]
        };
        let mut stepper = method.stepper(&system, 0.1, &NewtonOptions::default());
        let mut mu = start;
        let offs = (0..1000).map(|_| {
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            (casimir(&mu) - casimir(&start)).abs()
        });
        offs.fold(0.0, f64::max)
    }
    let kept = moved(&Canonical4);
    assert!(kept < 1e-12, "{kept:e}");
    let control = moved(&Gauss4);
    assert!(control > 1e-9, "{control:e}");
}

/// Logarithms of what has no square among the numbers have their value.
#[test]
fn small_numbers_have_their_logarithm() {
    let bounded = Bounded::new();
    let system = bounded.system().expect("constants");
    let mut values = Vector::zeros();
    for s in [1e-170, -1e-170, 1e-300] {
        system.canonical(&Vector::new(0.1, s, 0.5), &mut values);
        let off = values[1] / f64::ln(f64::abs(s)) - 1.0;
        assert!(off.abs() < 1e-15, "{s:e}: {}", values[1]);
    }
}

/// A step that would pass a zero of an `a_i`, or go round through infinity, is refused: the slopes have the same sign there.
#[test]
fn no_side_is_left() {
    let (system, start) = mixed();
    let mut side = Vector::zeros();
    system.canonical_sides(&start, &Vector::new(-4.0, 0.2, 3.0), &mut side);
    assert!(side.iter().all(|value| *value > 0.0), "{side:?}");
    system.canonical_sides(&start, &Vector::new(0.3, 1.0, -0.7), &mut side);
    assert!(side[2] < 0.0, "{side:?}");
    let bounded = Bounded::new();
    let system = bounded.system().expect("constants");
    for (other, place) in [
        (Vector::new(2.5, 0.4, 0.8), 0),
        (Vector::new(6.5, 0.4, 0.8), 0),
        (Vector::new(0.2, 1.4, 0.8), 1),
    ] {
        system.canonical_sides(&bounded.initial_state(), &other, &mut side);
        assert!(side[place] < 0.0, "{other:?}: {side:?}");
    }
    // of two zeros both signs count
    system.canonical_sides(
        &Vector::new(0.2, -0.5, 0.8),
        &Vector::new(0.2, 1.5, 0.8),
        &mut side,
    );
    assert!(side[1] < 0.0, "{side:?}");
}
