//! Taylor series in any units: powers of two in state, parameters and time change no digit, and far from 1 nothing is lost.

use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Recurrence, Series};

lie_poisson! {
    /// A free rigid body.
    pub system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2.0; I2 = 1.5; I3 = 1.0; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    methods = [taylor, lie-taylor];
}

lie_poisson! {
    /// A heavy top.
    pub system Top;
    algebra = se(3);
    state m1, m2, m3, g1, g2, g3;
    parameters { I1 = 2.0; I2 = 1.5; I3 = 1.0; w = 0.9; }
    hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + w*(g1/3 + g2/7 + g3);
    methods = [taylor, lie-taylor];
}

lie_poisson! {
    /// A spin in a field that turns, with an anisotropy.
    pub system Driven;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { a = 0.7; b = 1.1; w = 1.3; }
    hamiltonian = a*z^2 + b*(x*cos(w*t) + y*sin(w*t));
    initial = [3/5, -1/2, 7/10];
    methods = [taylor, lie-taylor];
}

lie_poisson! {
    /// A magnetic moment in tesla and seconds.
    pub system Macrospin;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { gam = 176085900000.0; B = 0.02; K = 0.5; }
    hamiltonian = -gam*(B*x + K*z^2/2);
    methods = [taylor, lie-taylor];
}

/// The state after steps of a grid.
fn run<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: P::State,
    h: f64,
    steps: u32,
) -> P::State {
    let mut mu = start;
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("the step is made");
    }
    mu
}

fn two(exponent: i32) -> f64 {
    2_f64.powi(exponent)
}

const BODY: [f64; 3] = [0.6, -0.5, 0.7];
const TOP: [f64; 6] = [0.4, -0.2, 0.9, 0.3, 0.5, 0.8];

/// A body whose state and moments are multiplied by powers of two, and its state in the first units.
fn body<M: Method<f64, BodySystem>>(method: &M, state: i32, moments: i32) -> [f64; 3] {
    let mut body = Body::new();
    for moment in [&mut body.I1, &mut body.I2, &mut body.I3] {
        *moment *= two(moments);
    }
    let h = 0.9 * two(moments - state);
    let start = BODY.map(|x| x * two(state)).into();
    let end = run(&body.system().expect("sound"), method, start, h, 20);
    core::array::from_fn(|i| end[i] * two(-state))
}

/// A top with other units of momentum, gravity, and time.
fn top<M: Method<f64, TopSystem>>(method: &M, [m, g, t]: [i32; 3]) -> [f64; 6] {
    let mut top = Top::new();
    for moment in [&mut top.I1, &mut top.I2, &mut top.I3] {
        *moment *= two(m + t);
    }
    top.w *= two(m - g - t);
    let scale = |i: usize| two(if i < 3 { m } else { g });
    let start: [f64; 6] = core::array::from_fn(|i| TOP[i] * scale(i));
    let end = run(
        &top.system().expect("sound"),
        method,
        start.into(),
        0.7 * two(t),
        20,
    );
    core::array::from_fn(|i| end[i] / scale(i))
}

/// A driven spin with another unit of time.
fn driven<M: Method<f64, DrivenSystem>>(method: &M, t: i32) -> [f64; 3] {
    let mut spin = Driven::new();
    for rate in [&mut spin.a, &mut spin.b, &mut spin.w] {
        *rate *= two(-t);
    }
    let system = spin.system().expect("sound");
    let end = run(&system, method, spin.initial_state(), 0.8 * two(t), 20);
    core::array::from_fn(|i| end.as_slice()[i])
}

fn distance<const N: usize>(one: [f64; N], other: [f64; N]) -> f64 {
    let pairs = one.iter().zip(&other);
    pairs.map(|(a, b)| (a - b).abs()).fold(
        0.0,
        |far: f64, d| if d > far || d.is_nan() { d } else { far },
    )
}

macro_rules! methods {
    ($check:ident) => {
        $check!("taylor", Taylor::default());
        $check!("taylor at 1e-7", Taylor::with_tolerance(1e-7));
        $check!("lie-taylor", LieTaylor::default());
        $check!("lie-taylor at 1e-5", LieTaylor::with_tolerance(1e-5));
    };
}

#[test]
fn powers_of_two_change_no_digit() {
    macro_rules! check {
        ($name:literal, $method:expr) => {
            let method = $method;
            for k in [-20, -7, 1, 20] {
                let same = |one: &[f64], other: &[f64], what: &str| {
                    assert_eq!(one, other, "{}: {what}, 2^{k}", $name);
                };
                let first = body(&method, 0, 0);
                same(&body(&method, k, 0), &first, "state of a body");
                same(&body(&method, 0, k), &first, "moments of a body");
                same(&body(&method, k, -k), &first, "state and moments of a body");
                let first = top(&method, [0; 3]);
                same(&top(&method, [k, k, 0]), &first, "state of a top");
                same(&top(&method, [0, 0, k]), &first, "time of a top");
                same(&top(&method, [k, k, -k]), &first, "state and time of a top");
                same(
                    &driven(&method, k),
                    &driven(&method, 0),
                    "time of a driven spin",
                );
            }
        };
    }
    methods!(check);
    // the control: a method with an absolute tolerance
    let method = Dopri5::default();
    assert_ne!(body(&method, 20, 0), body(&method, 0, 0));
}

#[test]
fn nothing_is_lost_far_from_one() {
    macro_rules! check {
        ($name:literal, $method:expr) => {
            let method = $method;
            let (of_body, of_top) = (body(&method, 0, 0), top(&method, [0; 3]));
            let of_spin = driven(&method, 0);
            for k in [-300, -100, 100, 300] {
                let bodies = [body(&method, k, 0), body(&method, 0, k), body(&method, k, -k)];
                for (end, what) in bodies.into_iter().zip(["state", "moments", "both"]) {
                    let error = distance(end, of_body);
                    assert!(error < 1e-14, "{}, body, {what} 2^{k}: {error:e}", $name);
                }
                for units in [[k, k, 0], [0, 0, k], [k, 2 * k, -k]] {
                    let error = distance(top(&method, units), of_top);
                    // where the units differ, so does the coordinate to which the tolerance is relative
                    let allowed = match units[0] == units[1] {
                        true => 1e-14,
                        false => 3e-13 + 300.0 * method.tolerance,
                    };
                    assert!(error < allowed, "{}, top, 2^{units:?}: {error:e}", $name);
                }
                let error = distance(driven(&method, k), of_spin);
                assert!(error < 1e-14, "{}, spin, 2^{k}: {error:e}", $name);
            }
        };
    }
    methods!(check);
    // the control: with an absolute tolerance a small state loses digits
    let method = Dopri5 {
        rtol: 1e-13,
        atol: 1e-13,
    };
    assert!(distance(body(&method, -100, 0), body(&method, 0, 0)) > 1e-10);
}

#[test]
fn a_macrospin_in_tesla_and_seconds() {
    // exact rotations and DOP853 at 1e-13
    let exact = [0.7472169603839807, -0.2093899972421327, 0.6307318314222656];
    let system = Macrospin::new().system().expect("sound");
    for (h, steps) in [(2e-9, 1), (1e-9, 2), (1e-12, 2000)] {
        let start = [0.6, 0.48, 0.64];
        let taylor = run(&system, &Taylor::default(), start.into(), h, steps);
        let lie = run(&system, &LieTaylor::default(), start.into(), h, steps);
        for end in [taylor, lie] {
            let error = distance(end.into(), exact);
            assert!(error < 1e-11, "{h:e}: {error:e}");
        }
    }
}

/// The control: coefficients per second, or per unit of a slow time, do not go as far as the orders do.
#[test]
fn coefficients_in_the_unit_of_time_of_the_declaration_overflow_and_vanish() {
    let coefficient = |gam: f64| {
        let system = Macrospin {
            gam,
            ..Macrospin::new()
        }
        .system()
        .expect("sound");
        let mut recurrence = system.series();
        let (mut row, mut field) = (BODY.into(), system.zero_state());
        let mut carry = recurrence.begin(&row, &mut field);
        for k in 1..=32 {
            row = field / f64::from(k);
            carry = recurrence.advance(k as usize, carry, &row, &mut field);
        }
        field.abs().max()
    };
    assert!(coefficient(1.0) > 1e-60);
    assert!(!coefficient(176_085_900_000.0).is_finite());
    assert_eq!(coefficient(1e-12), 0.0);
}
