//! Functions of Rust in a Hamiltonian: generated code is that of the formula, methods have their orders, wrong derivatives are
//! found.
// declared by a macro within a macro, operators stand on lines of their own in clippy's eyes
#![allow(clippy::possible_missing_comma)]

use lie_runtime::prelude::*;
use lie_runtime::scalar::Dual;
use lie_runtime::{Scalar, Series};

/// `cos(3 r) + r^4/4`
fn well<S: Scalar>(r: S) -> S {
    (S::ratio(3.0, 1.0) * r).cos() + r * r * r * r * S::ratio(1.0, 4.0)
}

fn well_slope<S: Scalar>(r: S) -> S {
    let three = S::ratio(3.0, 1.0);
    r * r * r - three * (three * r).sin()
}

/// The slope with a wrong sign of one term.
fn wrong_slope<S: Scalar>(r: S) -> S {
    let three = S::ratio(3.0, 1.0);
    r * r * r + three * (three * r).sin()
}

mod potentials {
    use super::Scalar;

    /// `u^2 sin(v) + u v`
    pub fn pull<S: Scalar>(u: S, v: S) -> S {
        u * u * v.sin() + u * v
    }

    /// A function whose second derivative goes up and down with slopes of 6, and turns at each quarter from -3/2 on.
    pub fn teeth<S: Scalar>(z: S) -> S {
        let from = z + S::ratio(3.0, 2.0);
        let mut sum = from * from * from - S::ratio(3.0, 8.0) * from * from;
        for k in -5..6 {
            let over = z - S::ratio(f64::from(k), 4.0);
            let cube = S::select(over.less(S::zero()), S::zero(), over * over * over);
            sum = if k % 2 == 0 {
                sum + cube + cube
            } else {
                sum - cube - cube
            };
        }
        sum
    }
}

macro_rules! body {
    ($name:ident { $($functions:tt)* } { $($energy:tt)* } $($more:tt)*) => {
        lie_poisson! {
            /// so(3) with functions.
            pub system $name;
            algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
            state x, y, z;
            parameters { a = 1.2; }
            functions { $($functions)* }
            hamiltonian = $($energy)*;
            casimir C = x^2 + y^2 + z^2;
            methods = [midpoint, gauss4, gauss6, lie-midpoint, gonzalez, mean-value $($more)*];
        }
    };
}

body!(
    // Derivatives by dual numbers.
    Automatic { pull(u, v) = potentials::pull; well(r) = crate::own_functions::well; }
    { x^2/2 + y^2/3 + z^2/5 + well(a*z)/4 + pull(x*y, z)/3 + well(2) }
    , taylor
);
body!(
    // Declared derivatives of one of them.
    Given { pull(u, v) = potentials::pull; well(r) = crate::own_functions::well, derivatives (well_slope); }
    { x^2/2 + y^2/3 + z^2/5 + well(a*z)/4 + pull(x*y, z)/3 + well(2) }
    , taylor
);
body!(
    // The control: formulas.
    Formula { }
    { x^2/2 + y^2/3 + z^2/5 + (cos(3*a*z) + (a*z)^4/4)/4 + ((x*y)^2*sin(z) + x*y*z)/3 + cos(6) + 4 }
    , taylor
);
body!(
    // A sum of functions of one coordinate.
    Pieces { well(r) = crate::own_functions::well, derivatives (crate::own_functions::well_slope); }
    { x^2/2 + y^2/3 + z^2/5 + well(z)/4 }
    , taylor, splitting2
);
body!(
    // A function of Rust beside a table, neither of which is smooth.
    Mixed {
        teeth(z) = potentials::teeth, smooth 2;
        drag = table [(-1.5, 1), (-1, 0.4), (-0.5, 0.1), (0, 0), (0.5, 0.2), (1, 0.5), (1.5, 1.3)], degree 5;
    }
    { x^2/2 + y^2/3 + z^2/5 + 6*teeth(z) + drag(x)/9 }
);
body!(
    // The same without what is not smooth but the table.
    OfTable {
        drag = table [(-1.5, 1), (-1, 0.4), (-0.5, 0.1), (0, 0), (0.5, 0.2), (1, 0.5), (1.5, 1.3)], degree 5;
    }
    { x^2/2 + y^2/3 + z^2/5 + drag(x)/9 }
    , taylor
);
body!(
    // A derivative with a wrong sign.
    Wrong { well(r) = crate::own_functions::well, derivatives (crate::own_functions::wrong_slope); }
    { x^2/2 + y^2/3 + z^2/5 + well(z)/4 }
    , taylor
);

const START: [f64; 3] = [0.6, -0.4, 0.7];

/// Energy, gradient, field and Jacobian at a state.
fn kernels<S: Scalar, P>(system: &P, state: [S; 3]) -> Vec<S>
where
    P: Poisson<S>,
    P::State: From<[S; 3]>,
{
    let mu: P::State = state.into();
    let (mut gradient, mut field) = (system.zero_state(), system.zero_state());
    system.gradient(&mu, &mut gradient);
    system.vector_field(&mu, &mut field);
    let mut all = vec![system.hamiltonian(&mu)];
    all.extend_from_slice(gradient.as_slice());
    all.extend_from_slice(field.as_slice());
    all
}

fn close<S: Scalar>(name: &str, found: &[S], expected: &[S], units: f64) {
    assert_eq!(found.len(), expected.len());
    let epsilon = S::epsilon().lane(0).to_f64();
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        for lane in 0..S::LANES {
            let [a, b] = [a, b].map(|x| x.lane(lane).to_f64());
            let error = (a - b).abs();
            assert!(
                error <= units * epsilon * (1.0 + b.abs()),
                "{name} {k}: {a} {b}"
            );
        }
    }
}

macro_rules! compare {
    ($scalar:ty, $state:expr) => {{
        let state: [$scalar; 3] = $state;
        let formula = Formula::<$scalar>::default().system().expect("sound");
        let automatic = Automatic::<$scalar>::default().system().expect("sound");
        let given = Given::<$scalar>::default().system().expect("sound");
        let expected = kernels(&formula, state);
        close("automatic", &kernels(&automatic, state), &expected, 40.0);
        close("given", &kernels(&given, state), &expected, 40.0);
    }};
}

#[test]
fn kernels_are_those_of_the_formula_in_every_scalar() {
    compare!(f64, START);
    compare!(f32, START.map(|x| x as f32));
    let mut lanes = START.map(F64x8::from_f64);
    for lane in 0..8 {
        lanes[lane % 3] = lanes[lane % 3].with_lane(lane, 0.11 * lane as f64 - 0.4);
    }
    compare!(F64x8, lanes);
    let mut dual = START.map(Dual::constant_of);
    dual[2] = Dual::variable(START[2]);
    compare!(Dual<f64>, dual);
}

fn end<P>(system: &P, method: &impl Method<f64, P>, h: f64, steps: u32) -> P::State
where
    P: Poisson<f64>,
    P::State: From<[f64; 3]>,
{
    let mut mu: P::State = START.into();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}

#[test]
fn steps_are_those_of_the_formula() {
    let formula = Formula::new().system().expect("sound");
    let automatic = Automatic::new().system().expect("sound");
    let given = Given::new().system().expect("sound");
    macro_rules! same {
        ($($method:expr),*) => {$({
            let expected = end(&formula, &$method, 0.05, 40);
            let own = [end(&automatic, &$method, 0.05, 40), end(&given, &$method, 0.05, 40)];
            for own in own {
                close(stringify!($method), own.as_slice(), expected.as_slice(), 400.0);
            }
        })*};
    }
    same!(
        ImplicitMidpoint,
        Gauss4,
        Gauss6,
        LieMidpoint::exp(),
        Rk4,
        Gonzalez,
        MeanValue
    );
    // the control: another step size ends elsewhere
    let other = end(&formula, &ImplicitMidpoint, 0.04, 50);
    let own = end(&given, &ImplicitMidpoint, 0.05, 40);
    assert!((other[0] - own[0]).abs() > 1e-6);
}

/// A Taylor series runs on the plain form: the compiler has no rule for a function that it does not know.
#[test]
fn taylor_series_are_those_of_the_formula() {
    fn coefficients<P>(system: &P) -> Vec<f64>
    where
        P: Series<f64>,
        P::State: From<[f64; 3]>,
    {
        use lie_runtime::Recurrence;
        let mut recurrence = system.series();
        let (mut row, mut field): (P::State, P::State) = (START.into(), START.into());
        let mut all = Vec::new();
        let mut carry = recurrence.begin(&row, &mut field);
        for k in 1..=8 {
            all.extend_from_slice(field.as_slice());
            for (row, field) in row.as_mut_slice().iter_mut().zip(field.as_slice()) {
                *row = field / f64::from(k);
            }
            carry = recurrence.advance(k as usize, carry, &row, &mut field);
        }
        all
    }
    let expected = coefficients(&Formula::new().system().expect("sound"));
    let given = coefficients(&Given::new().system().expect("sound"));
    let size = expected.iter().fold(0.0, |sum: f64, x| sum + x.abs());
    for (k, (a, b)) in given.iter().zip(&expected).enumerate() {
        assert!((a - b).abs() <= 1e-13 * size, "{k}: {a} {b}");
    }
}

/// Initial states on the unit sphere, whose motions cross the joints at times of their own.
fn states() -> impl Iterator<Item = [f64; 3]> {
    (0..24).map(|k| {
        let (z, angle) = (-0.8 + 0.0683 * f64::from(k), 2.4 * f64::from(k));
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    })
}

fn run<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: P::State,
    steps: u32,
) -> P::State {
    let mut mu = start;
    let mut stepper = method.stepper(system, 3.0 / f64::from(steps), &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}

/// A system with the ends of its runs.
struct Known<'a, P: Poisson<f64>>(&'a P, Vec<P::State>);

impl<'a, P> Known<'a, P>
where
    P: Poisson<f64>,
    P::State: From<[f64; 3]>,
{
    fn new(system: &'a P) -> Self {
        let ends = states().map(|start| run(system, &Rk4, start.into(), 30_000));
        Self(system, ends.collect())
    }
}

/// The slope of the root of the mean square of the errors.
fn slope<P>(name: &str, known: &Known<P>, method: &impl Method<f64, P>, steps: &[u32]) -> f64
where
    P: Poisson<f64>,
    P::State: From<[f64; 3]>,
{
    let Known(system, ends) = known;
    let points = steps.iter().map(|&steps| {
        let squares = states().zip(ends).map(|(start, exact)| {
            let end = run(*system, method, start.into(), steps);
            let pairs = end.as_slice().iter().zip(exact.as_slice());
            pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
        });
        (f64::from(steps).recip().ln(), 0.5 * f64::ln(squares.sum()))
    });
    let points: Vec<(f64, f64)> = points.collect();
    let mean =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let products: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let squares: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    println!("{name}: {:.2}", products / squares);
    products / squares
}

const FINE: [u32; 5] = [150, 225, 337, 506, 759];
const STEPS: [u32; 6] = [40, 60, 90, 135, 202, 303];
const COARSE: [u32; 6] = [20, 26, 33, 42, 54, 69];

#[test]
fn methods_have_their_orders_with_a_function_of_rust() {
    let system = Pieces::new().system().expect("sound");
    let system = Known::new(&system);
    for (slope, order) in [
        (slope("midpoint", &system, &ImplicitMidpoint, &FINE), 2.0),
        (slope("gauss4", &system, &Gauss4, &STEPS), 4.0),
        (slope("gauss6", &system, &Gauss6, &COARSE), 6.0),
        (slope("strang", &system, &Splitting2::new(), &FINE), 2.0),
    ] {
        assert!((slope - order).abs() < 0.3, "{slope} in place of {order}");
    }
}

#[test]
fn beside_a_table_methods_have_the_order_of_what_is_least_smooth() {
    let mixed = Mixed::new().system().expect("sound");
    let table = OfTable::new().system().expect("sound");
    let (mixed, table) = (Known::new(&mixed), Known::new(&table));
    for (slope, order) in [
        (slope("mixed, rk4", &mixed, &Rk4, &FINE), 3.0),
        (slope("mixed, gauss4", &mixed, &Gauss4, &STEPS), 3.0),
        (slope("mixed, gauss6", &mixed, &Gauss6, &COARSE), 3.0),
        (slope("table, rk4", &table, &Rk4, &FINE), 4.0),
        (slope("table, gauss4", &table, &Gauss4, &STEPS), 4.0),
    ] {
        assert!((slope - order).abs() < 0.5, "{slope} in place of {order}");
    }
}

#[test]
#[cfg(debug_assertions)]
fn a_wrong_derivative_is_noticed() {
    let wrong = Wrong::new().system().expect("sound");
    let right = Pieces::new().system().expect("sound");
    kernels(&right, START);
    let panic = std::panic::catch_unwind(|| kernels(&wrong, START)).expect_err("a panic");
    let message = panic.downcast_ref::<String>().expect("a message");
    let expected = "the declared derivative of `well` by its argument 1 is";
    assert!(message.starts_with(expected), "{message}");
}
