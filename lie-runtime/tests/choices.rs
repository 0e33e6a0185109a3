//! `abs`, `min`, `max`, `piecewise` and functions by tables in generated code, and the order that methods have across joints.

use lie_runtime::generic::PowerSeries;
use lie_runtime::prelude::*;
use lie_runtime::scalar::Dual;
use lie_runtime::{Expand, Recurrence, Scalar, Series};

lie_poisson! {
    /// Each of them, with joints on both sides of which states lie.
    pub system Branches;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { a = 1.3; }
    functions { curve = table [(-4, 3), (-2, 1), (-1, 1/3), (0, 0), (1, 0.4), (2, 1), (4, 5)], degree 5, outside constant; }
    hamiltonian = abs(x - 2*y)*z + max(x*y, z)^2 + min(a*x, y)*x + curve(a*y + z)
        + piecewise(x < -1/10: y^2, x*y <= 1/9: exp(x), y >= z: z^3, log(3 + x));
    methods = [gauss4, taylor, lie-taylor];
}

const STARTS: [[f64; 3]; 5] = [
    [0.4, -0.3, 0.5],
    [-0.2, 0.7, 0.1],
    [0.9, 0.2, -0.6],
    [0.8, 0.9, 0.3],
    [0.8, 0.5, 1.3],
];

/// Coefficients of the field along a solution.
fn coefficients<R, V: State<f64>>(mut recurrence: R, start: &V) -> Vec<f64>
where
    R: Recurrence<f64, State = V>,
{
    let (mut row, mut field) = (start.clone(), start.clone());
    let mut rows = Vec::new();
    let mut carry = recurrence.begin(&row, &mut field);
    for k in 1..=12 {
        rows.extend_from_slice(field.as_slice());
        for (row, field) in row.as_mut_slice().iter_mut().zip(field.as_slice()) {
            *row = field / k as f64;
        }
        carry = recurrence.advance(k, carry, &row, &mut field);
    }
    rows
}

fn compare<P: Series<f64> + Expand<f64>>(system: &P, start: &P::State) {
    let plain = coefficients(PowerSeries::new(system), start);
    let written = coefficients(system.series(), start);
    for (k, (a, b)) in written.iter().zip(&plain).enumerate() {
        let size = plain[k / 3 * 3..k / 3 * 3 + 3]
            .iter()
            .fold(0.0, |m: f64, x| m + x.abs());
        assert!((a - b).abs() <= 1e-12 * size, "{k}: {a:e} {b:e}");
    }
}

#[test]
fn recurrences_are_those_of_power_series_on_every_branch() {
    let system = Branches::new().system().expect("sound");
    for start in STARTS {
        compare(&system, &start.into());
    }
}

#[test]
fn gradients_are_slopes_and_dual_numbers_agree() {
    let system = Branches::new().system().expect("sound");
    let dual = Branches::<Dual<f64>>::default().system().expect("sound");
    for start in STARTS {
        let state = start.into();
        let mut gradient = system.zero_state();
        system.gradient(&state, &mut gradient);
        for i in 0..3 {
            let h = 1e-5;
            let at = |shift: f64| {
                let mut moved = state;
                moved[i] += shift;
                system.hamiltonian(&moved)
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            assert!(
                (slope - gradient[i]).abs() < 1e-7,
                "{i}: {slope} {}",
                gradient[i]
            );
            let mut along = start.map(|value| Dual {
                value,
                derivative: 0.0,
            });
            along[i].derivative = 1.0;
            let derivative = dual.hamiltonian(&along.into()).derivative;
            assert!((derivative - gradient[i]).abs() < 1e-12 * (1.0 + gradient[i].abs()));
        }
    }
}

#[test]
fn every_lane_takes_its_own_branch() {
    type Eight = F64x8;
    let system = Branches::new().system().expect("sound");
    let lanes = Branches::<Eight>::default().system().expect("sound");
    let mut wide = [Eight::zero(); 3];
    for lane in 0..8 {
        for (wide, value) in wide.iter_mut().zip(STARTS[lane % 5]) {
            *wide = wide.with_lane(lane, value);
        }
    }
    let energy = lanes.hamiltonian(&wide.into());
    let mut field = lanes.zero_state();
    lanes.vector_field(&wide.into(), &mut field);
    for lane in 0..8 {
        let state = STARTS[lane % 5].into();
        assert_eq!(
            energy.lane(lane).to_bits(),
            system.hamiltonian(&state).to_bits()
        );
        let mut own = system.zero_state();
        system.vector_field(&state, &mut own);
        for (wide, own) in field.as_slice().iter().zip(own.as_slice()) {
            assert_eq!(wide.lane(lane).to_bits(), own.to_bits());
        }
    }
}

macro_rules! body {
    ($name:ident, $degree:literal) => {
        lie_poisson! {
            /// A rigid body with a torque along its third axis whose potential was measured to one digit: cos(3 z) at 13 places.
            pub system $name;
            algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
            state x, y, z;
            functions {
                potential = table [
                    (-1.5, -0.2), (-1.25, -0.8), (-1, -1), (-0.75, -0.6), (-0.5, 0.1), (-0.25, 0.7), (0, 1), (0.25, 0.7), (0.5, 0.1), (0.75, -0.6), (1, -1), (1.25, -0.8), (1.5, -0.2)
                ], degree $degree;
            }
            hamiltonian = x^2/2 + y^2/3 + z^2/5 + potential(z)/4;
            methods = [gauss4, gauss6];
        }
    };
}
body!(Linear, 1);
body!(Cubic, 3);
body!(Quintic, 5);
lie_poisson! {
    /// The control: the potential as a formula.
    pub system Smooth;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = x^2/2 + y^2/3 + z^2/5 + cos(3*z)/4;
    methods = [gauss4, gauss6];
}

/// Initial states on the unit sphere, whose motions cross the joints at times of their own.
fn states() -> impl Iterator<Item = [f64; 3]> {
    (0..24).map(|k| {
        let (z, angle) = (-0.8 + 0.0683 * f64::from(k), 2.4 * f64::from(k));
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    })
}

/// The end of a run, if every step succeeds.
fn run<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: P::State,
    steps: u32,
) -> Option<P::State> {
    const SPAN: f64 = 3.0;
    let h = SPAN / f64::from(steps);
    let mut mu = start;
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).ok()?;
    }
    Some(mu)
}

/// The slope of the root of the mean square of the errors, and how many runs failed.
fn slope<P>(
    system: &P,
    ends: &[P::State],
    method: &impl Method<f64, P>,
    steps: &[u32],
) -> (f64, usize)
where
    P: Poisson<f64>,
    P::State: From<[f64; 3]>,
{
    let mut points = Vec::new();
    let mut failed = 0;
    for &steps in steps {
        let (mut sum, mut count) = (0.0, 0.0);
        for (start, exact) in states().zip(ends) {
            let Some(end) = run(system, method, start.into(), steps) else {
                failed += 1;
                continue;
            };
            let pairs = end.as_slice().iter().zip(exact.as_slice());
            sum += pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            count += 1.0;
        }
        points.push((f64::from(steps).recip().ln(), 0.5 * f64::ln(sum / count)));
    }
    let mean =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let products: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let squares: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    (products / squares, failed)
}

/// The slopes of rk4, gauss4 and gauss6.
fn slopes<P>(name: &str, system: &P) -> [f64; 3]
where
    P: Poisson<f64>,
    Gauss4: Method<f64, P>,
    Gauss6: Method<f64, P>,
    P::State: From<[f64; 3]>,
{
    let fine = [150, 225, 337, 506, 759, 1139];
    let steps = [40, 60, 90, 135, 202, 303];
    let coarse = [16, 20, 26, 33, 42, 54, 69, 88];
    let ends: Vec<P::State> = states()
        .map(|start| run(system, &Rk4, start.into(), 30_000).expect("explicit"))
        .collect();
    let all = [
        slope(system, &ends, &Rk4, &fine),
        slope(system, &ends, &Gauss4, &steps),
        slope(system, &ends, &Gauss6, &coarse),
    ];
    println!("{name}: rk4, gauss4, gauss6: slopes and failed runs {all:.2?}");
    all.map(|(slope, _)| slope)
}

#[test]
fn across_joints_methods_have_the_order_of_the_first_derivative_that_jumps() {
    let order = |slopes: [f64; 3], expected: [f64; 3]| {
        for (slope, expected) in slopes.into_iter().zip(expected) {
            assert!(
                (slope - expected).abs() < 0.5,
                "{slopes:?} in place of {expected}"
            );
        }
    };
    order(
        slopes("degree 1", &Linear::new().system().expect("sound")),
        [1.0, 1.0, 1.0],
    );
    order(
        slopes("degree 3", &Cubic::new().system().expect("sound")),
        [3.0, 3.0, 3.0],
    );
    order(
        slopes("degree 5", &Quintic::new().system().expect("sound")),
        [4.0, 4.0, 5.0],
    );
    order(
        slopes("smooth", &Smooth::new().system().expect("sound")),
        [4.0, 4.0, 6.0],
    );
}

lie_poisson! {
    /// A table that the motion leaves.
    pub system Short;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    functions { f = table [(-1, 1), (-1/2, 0), (0, 1/3), (1/2, 1)]; }
    hamiltonian = x^2/2 + y^2/3 + f(z);
}

#[test]
fn a_step_that_leaves_a_table_fails_and_keeps_the_state() {
    let system = Short::new().system().expect("sound");
    let inside = [0.6, 0.2, 0.45].into();
    assert!(system.hamiltonian(&inside).is_finite());
    assert!(system.hamiltonian(&[0.6, 0.2, 0.55].into()).is_nan());
    let mut gradient = system.zero_state();
    system.gradient(&[0.6, 0.2, 0.55].into(), &mut gradient);
    assert!(gradient[2].is_nan());
    let mut left = false;
    let mut mu = inside;
    let mut stepper = Gauss4.stepper(&system, 0.1, &NewtonOptions::default());
    for _ in 0..400 {
        let before = mu;
        if stepper.step(&mut mu, &mut ()).is_err() {
            assert_eq!(before, mu);
            left = true;
            break;
        }
        assert!(mu[2] <= 0.5);
    }
    assert!(left, "the motion stays inside: {mu}");
}
