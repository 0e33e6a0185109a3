//! Discrete Lagrangians in the entries of the group element against computations with the matrices themselves.
//!
//! The action is the sum of `l_d(f_k)`. Of a left-invariant system `f_k = g_k^-1 g_(k+1)`, and it is stationary where
//! `<L(f_k), rho f_k> = mu_k(rho)` and `<L(f_k), f_k rho> = mu_(k+1)(rho)` for every matrix rho of the algebra, `L_ab = dl_d/df_ab`. Of a
//! right-invariant one `f_k = g_(k+1) g_k^-1`, and both pairings change places.

#[path = "entries/bodies.rs"]
mod bodies;
#[path = "entries/matrices.rs"]
mod matrices;

use bodies::{Body, euclidean, five, general, kinetic, screws, squeezed, turning};
use lie_codegen::compile::{compile_spec, with_options};
use lie_codegen::methods::{Choice, Retraction};
use lie_codegen::plan::plan;
use lie_dynamic::{Dynamic, Interpreted};
use lie_methods::method;
use lie_runtime::DiscreteLagrangianPoisson;
use lie_runtime::methods::{DiscreteEulerPoincare, Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use matrices::{Matrix, combination, identity, inverse, largest, paired, times};

fn made(body: &Body) -> Dynamic<f64> {
    let structure = compile_spec(&body.spec()).expect("a sound declaration");
    let choice = Choice::DiscreteEulerPoincare(Retraction::Cayley);
    let choices = with_options(&structure, &[choice]);
    Dynamic::new(plan(&structure, &choices), &[], &Interpreted).expect("a system")
}

/// Momenta before and after a step by f: its pairings on both sides.
fn momenta(body: &Body, right: bool, f: &Matrix, h: f64) -> [Vec<f64>; 2] {
    let slope = (body.slope)(f, h);
    let behind = |rho: &Matrix| paired(&slope, &times(f, rho));
    let before = |rho: &Matrix| paired(&slope, &times(rho, f));
    let [one, other] = [
        body.basis.iter().map(before).collect(),
        body.basis.iter().map(behind).collect(),
    ];
    if right { [other, one] } else { [one, other] }
}

/// The Cayley map of a combination of the matrices.
fn cayley(body: &Body, x: &[f64]) -> Matrix {
    let half = combination(&body.basis, x, 0.5);
    let one = identity(half.len());
    let add = |sign: f64| -> Matrix {
        let rows = one.iter().zip(&half);
        rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + sign * b).collect())
            .collect()
    };
    times(&inverse(&add(-1.0)), &add(1.0))
}

/// A step on the matrices: the coordinates x of f by Newton's iteration with a matrix by differences, and the new momentum.
fn step(body: &Body, right: bool, mu: &[f64], h: f64) -> (Vec<f64>, Vec<f64>) {
    let n = mu.len();
    let before = |x: &[f64]| momenta(body, right, &cayley(body, x), h)[0].clone();
    let mut x = vec![0.0; n];
    for _ in 0..60 {
        let mut jacobian = vec![vec![0.0; n]; n];
        for j in 0..n {
            let moved = |by: f64| {
                let mut x = x.clone();
                x[j] += by;
                before(&x)
            };
            let (up, down) = (moved(1e-5), moved(-1e-5));
            for i in 0..n {
                jacobian[i][j] = (up[i] - down[i]) / 2e-5;
            }
        }
        let gap: Vec<f64> = before(&x).iter().zip(mu).map(|(b, m)| b - m).collect();
        let inverse = inverse(&jacobian);
        let change: Vec<f64> = inverse
            .iter()
            .map(|row| row.iter().zip(&gap).map(|(a, b)| a * b).sum())
            .collect();
        x.iter_mut()
            .zip(&change)
            .for_each(|(x, change)| *x -= change);
        if largest(&change) < 1e-16 {
            break;
        }
    }
    let after = momenta(body, right, &cayley(body, &x), h)[1].clone();
    (x, after)
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    largest(&pairs.map(|(a, b)| a - b).collect::<Vec<f64>>()) / largest(b)
}

/// Steps of the program and of the matrices from the same states, and what the motion on the group keeps.
fn agrees(body: &Body, h: f64, steps: usize) {
    let system = made(body);
    let method = DiscreteEulerPoincare::cayley();
    let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
    let mut mu = body.start.clone();
    let mut g = identity(body.basis[0].len());
    let (mut worst, mut drift, mut other) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..steps {
        let before = mu.clone();
        stepper.step(&mut mu, &mut ()).expect("a step");
        let (x, after) = step(body, body.right, &before, h);
        worst = worst.max(gap(&mu, &after)).max(gap(stepper.unknown(), &x));
        let (_, turned) = step(body, !body.right, &before, h);
        other = other.max(gap(&mu, &turned));
        // what is kept: of a left-invariant system mu(g^-1 rho g), of a right-invariant one mu(g rho g^-1)
        let f = cayley(body, stepper.unknown());
        let slope = (body.slope)(&f, h);
        g = if body.right {
            times(&f, &g)
        } else {
            times(&g, &f)
        };
        let (left, right) = if body.right {
            (g.clone(), inverse(&g))
        } else {
            (inverse(&g), g.clone())
        };
        let kept = body.basis.iter().map(|rho| {
            let rho = times(&times(&left, rho), &right);
            let moved = if body.right {
                times(&rho, &f)
            } else {
                times(&f, &rho)
            };
            paired(&slope, &moved)
        });
        drift = drift.max(gap(&kept.collect::<Vec<f64>>(), &body.start));
    }
    println!(
        "{}: {worst:.1e} in a step, {other:.1e} of the other side, momentum {drift:.1e}",
        body.name
    );
    assert!(worst < 2e-13, "{}: {worst:e}", body.name);
    assert!(drift < 2e-12, "{}: {drift:e}", body.name);
    // the control: the pairings of the other invariance
    assert!(other > 1e-2, "{}: {other:e}", body.name);
}

#[test]
fn right_invariant_systems() {
    agrees(&turning(true), 0.2, 100);
    agrees(&euclidean(true), 0.2, 100);
    // and what was there before
    agrees(&turning(false), 0.2, 20);
    agrees(&euclidean(false), 0.2, 20);
}

#[test]
fn matrices_of_five_and_six_rows() {
    agrees(&five(false), 0.1, 20);
    agrees(&five(true), 0.1, 20);
    agrees(&screws(false), 0.1, 20);
    agrees(&screws(true), 0.1, 20);
}

/// Moser and Veselov's body in five dimensions by its own method.
#[test]
fn the_body_in_five_dimensions() {
    let body = five(false);
    let structure = compile_spec(&body.spec()).expect("a sound declaration");
    let choices = [
        Choice::DiscreteEulerPoincare(Retraction::Cayley),
        Choice::MoserVeselov,
    ];
    let system = Dynamic::new(plan(&structure, &choices), &[], &Interpreted).expect("a system");
    for h in [0.1, -0.2] {
        let [mut one, mut other] = [body.start.clone(), body.start.clone()];
        let newton = NewtonOptions::default();
        let methods = choices
            .each_ref()
            .map(|choice| method(choice, Default::default()));
        let [mut first, mut second] = methods
            .each_ref()
            .map(|m| m.any_stepper(&system, h, &newton));
        let mut single = 0.0_f64;
        for _ in 0..50 {
            let mut from_the_same = one.clone();
            second.step(&mut from_the_same).expect("a step");
            first.step(&mut one).expect("a step");
            second.step(&mut other).expect("a step");
            single = single.max(gap(&one, &from_the_same));
        }
        println!(
            "h = {h}: {single:.1e} in a step, {:.1e} in 50",
            gap(&one, &other)
        );
        assert!(
            single < 1e-14 && gap(&one, &other) < 1e-12,
            "{h}: {single:e}"
        );
        assert!(gap(&one, &body.start) > 0.1, "it moves");
    }
}

/// Errors at time 1 against the flow of `mu' = -+ad*_xi mu`, written by hand.
#[test]
fn orders_of_right_invariant_systems() {
    for (body, order) in [
        (turning(true), 2.0),
        (euclidean(true), 1.0),
        (turning(false), 2.0),
    ] {
        let system = made(&body);
        let end = |steps: u32| {
            let h = 1.0 / f64::from(steps);
            let method = DiscreteEulerPoincare::cayley();
            let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
            let mut mu = body.start.clone();
            for _ in 0..steps {
                stepper.step(&mut mu, &mut ()).expect("a step");
            }
            mu
        };
        let ends = [32, 64, 128].map(end);
        let exact = bodies::flow(&body, body.right, 1.0);
        let errors = ends.each_ref().map(|end| gap(end, &exact));
        for pair in errors.windows(2) {
            let slope = (pair[0] / pair[1]).log2();
            println!("{} {}: {errors:?}, order {slope:.2}", body.name, body.right);
            assert!((slope - order).abs() < 0.1, "{}: {errors:?}", body.name);
        }
        // the control: the flow of the other invariance is another one
        let other = bodies::flow(&body, !body.right, 1.0);
        assert!(gap(&ends[2], &other) > 0.1, "{}", body.name);
    }
}

/// Near the identity the slope of many rows keeps its digits: `(J_i + J_j) x_ij/h`, where `g - 1` has 6 digits less than g.
#[test]
fn digits_near_the_identity() {
    let body = five(false);
    let system = made(&body);
    let (h, scale) = (0.5, 1e-7);
    let x: Vec<f64> = body.start.iter().map(|m| scale * m).collect();
    let mut out = vec![0.0; x.len()];
    system.discrete_slope(h, &x, &mut out);
    let expected: Vec<f64> = kinetic(&body)
        .iter()
        .zip(&x)
        .map(|(j, x)| j * x / h)
        .collect();
    // the next terms are smaller by x^2
    for (found, expected) in out.iter().zip(&expected) {
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{found:e} {expected:e}"
        );
    }
}

/// The same by minors, where the function has nothing but what is near the identity.
#[test]
fn digits_near_the_identity_by_minors() {
    let body = general();
    let system = made(&body);
    let (h, scale) = (0.5, 1e-10);
    let x: Vec<f64> = body.start.iter().map(|m| scale * m).collect();
    let mut out = vec![0.0; x.len()];
    system.discrete_slope(h, &x, &mut out);
    // the next terms are smaller by x
    for (found, x) in out.iter().zip(&x) {
        let expected = x / h;
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{found:e} {expected:e}"
        );
    }
}

/// Where a leading minor of `1 - X/2` vanishes, and the Cayley map does not care.
#[test]
fn an_elimination_without_a_pivot() {
    let body = squeezed();
    let system = made(&body);
    let (h, x) = (0.3, [2.0, 1.5, -2.0, 0.3, 0.2, -0.5]);
    let [before, _] = momenta(&body, false, &cayley(&body, &x), h);
    // by differences of l_d on the matrices
    let value = |x: &[f64]| (body.value)(&cayley(&body, x), h);
    let mut slope = vec![0.0; x.len()];
    system.discrete_slope(h, &x.to_vec(), &mut slope);
    assert!(before.iter().chain(&slope).all(|m| m.is_finite()));
    let found = system.discrete_lagrangian(h, &x.to_vec());
    assert!(
        (found / value(&x) - 1.0).abs() < 1e-13,
        "{found} {}",
        value(&x)
    );
    for (a, slope) in slope.iter().enumerate() {
        let moved = |by: f64| {
            let mut x = x;
            x[a] += by;
            value(&x)
        };
        let expected = (moved(1e-5) - moved(-1e-5)) / 2e-5;
        assert!(
            (slope - expected).abs() < 1e-7 * largest(&before),
            "{a}: {slope} {expected}"
        );
    }
}
