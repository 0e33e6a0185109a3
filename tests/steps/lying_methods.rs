//! Methods that claim what they do not keep: the verification says so.

use lie_measure::facts::Verdict;
use lie_measure::verify::{Found, Options};
use lie_measure::{Request, Verify};
use lie_program::listen::listen;
use lie_program::protocol::{Message, Start};
use lie_runtime::methods::{Facts, ImplicitMidpoint, Method, Preserves, Rk4};
use lie_runtime::prelude::*;
use spec_systems::so3_nonpolynomial::{NonpolynomialSpin, NonpolynomialSpinSystem};
use std::io::Write as _;

lie_poisson! {
    system Canonical;
    poisson { {q, p} = 1; }
    state q, p;
    hamiltonian = p^2/2 - cos(q);
}

lie_poisson! {
    system Quadratic;
    poisson { {x, y} = x*y; }
    state x, y;
    hamiltonian = x + y - log(x) - 2*log(y);
}

/// The Runge–Kutta method under a false flag.
#[derive(Clone, Copy)]
struct Lying<const WHAT: usize>;

const CLAIMS: [&str; 8] = [
    "order",
    "symmetric",
    "energy",
    "quadratic Casimirs",
    "orbit",
    "Poisson",
    "quadratic integrals",
    "nothing",
];

impl<const WHAT: usize> Facts for Lying<WHAT> {
    const ID: &'static str = "lying";
    const ORDER: u32 = if WHAT == 0 { 5 } else { 4 };
    const SYMMETRIC: bool = WHAT == 1;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves {
        energy: WHAT == 2,
        quadratic_casimirs: WHAT == 3,
        orbit: WHAT == 4,
        poisson: WHAT == 5,
        constant_poisson: WHAT == 8,
        quadratic_invariants: WHAT == 6,
        ..Preserves::LINEAR
    };
}

impl<S: Scalar, P: Poisson<S>, const WHAT: usize> Method<S, P> for Lying<WHAT> {
    type Stepper<'a>
        = <Rk4 as Method<S, P>>::Stepper<'a>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        Rk4.stepper(system, h, newton)
    }
}

/// An implicit method that says that it is explicit.
struct Implicit;

impl Facts for Implicit {
    const ID: &'static str = "implicit";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves::QUADRATIC;
}

impl<S: Scalar> Method<S, NonpolynomialSpinSystem<S>> for Implicit {
    type Stepper<'a> = <ImplicitMidpoint as Method<S, NonpolynomialSpinSystem<S>>>::Stepper<'a>;

    fn stepper<'a>(
        &self,
        system: &'a NonpolynomialSpinSystem<S>,
        h: S,
        newton: &NewtonOptions,
    ) -> Self::Stepper<'a> {
        ImplicitMidpoint.stepper(system, h, newton)
    }
}

/// The facts of each method that fail, as the program reports them.
fn failing() -> Vec<(String, String)> {
    let mut labels = CLAIMS.to_vec();
    labels.push("explicit");
    let program = Verify::new(&[], |_: &[f64]| NonpolynomialSpin::new().system())
        .with_orbits()
        .method("order", |_| Lying::<0>)
        .method("symmetric", |_| Lying::<1>)
        .method("energy", |_| Lying::<2>)
        .method("quadratic Casimirs", |_| Lying::<3>)
        .method("orbit", |_| Lying::<4>)
        .method("Poisson", |_| Lying::<5>)
        .method("quadratic integrals", |_| Lying::<6>)
        .method("nothing", |_| Lying::<7>)
        .method("explicit", |_| Implicit);
    examine(&program, &labels, &[0.6, -0.5, 0.7])
}

/// What fails of these methods of a program.
fn examine<P: Lift<f64> + Clone + 'static>(
    program: &Verify<P>,
    labels: &[&str],
    initial: &[f64],
) -> Vec<(String, String)> {
    let request = Request {
        methods: labels.iter().map(|&label| label.to_owned()).collect(),
        start: Start {
            initial: initial.to_vec(),
            ..Start::default()
        },
        options: Options {
            seed: 3,
            ..Options::default()
        },
    };
    let line = serde_json::to_string(&request).expect("text");
    // the input must not end before the program does
    let (input, mut writer) = std::io::pipe().expect("a pipe");
    writeln!(writer, "{line}").expect("a request");
    let mut output = Vec::new();
    let code = program.serve(std::io::BufReader::new(input), &mut output);
    drop(writer);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&output));
    let mut failing = Vec::new();
    listen(&mut output.as_slice(), &mut |message| {
        if let Message::Found(Found::Finding { method, finding }) = message
            && finding.verdict == Verdict::Fails
        {
            failing.push((method, finding.fact.into_owned()));
        }
        Ok(())
    })
    .expect("messages");
    failing
}

#[test]
fn every_lie_is_found_and_nothing_else() {
    let failing = failing();
    let expected = |what: &str| {
        let facts = failing.iter().filter(|(method, _)| method == what);
        facts.map(|(_, fact)| fact.as_str()).collect::<Vec<_>>()
    };
    for what in [
        "order",
        "symmetric",
        "energy",
        "orbit",
        "Poisson",
        "explicit",
    ] {
        assert_eq!(expected(what), [what]);
    }
    assert_eq!(expected("quadratic Casimirs"), ["quadratic Casimirs"]);
    assert_eq!(expected("quadratic integrals"), ["quadratic integrals"]);
    assert!(expected("nothing").is_empty());
}

lie_poisson! {
    system Species;
    poisson {
        {x, y} = -x*y/2;
        {x, z} = x*z/2;
        {y, z} = -y*z;
    }
    state x, y, z;
    hamiltonian = 2*x + y + 2*z + log(y) - 2*log(z);
    casimir C = 2*log(x) + log(y) + log(z);
}

/// Of brackets of coordinates, constant and quadratic ones: what is Poisson if they are constant, and symplectic leaves. Two coordinates
/// have an open one, on which every map stays.
#[test]
fn lies_about_brackets_of_coordinates() {
    let labels = ["constant", "orbit", "midpoint", "nothing"];
    let found = |failing: &[(String, String)], what: &str| {
        let facts = failing.iter().filter(|(method, _)| method == what);
        facts.map(|(_, fact)| fact.clone()).collect::<Vec<_>>()
    };
    let program = Verify::new(&[], |_: &[f64]| Canonical::new().system())
        .method("constant", |_| Lying::<8>)
        .method("orbit", |_| Lying::<4>)
        .method("midpoint", |_| ImplicitMidpoint)
        .method("nothing", |_| Lying::<7>);
    let failing = examine(&program, &labels, &[0.6, -0.5]);
    assert_eq!(found(&failing, "constant"), ["Poisson"]);
    assert_eq!(failing.len(), 1, "{failing:?}");
    let program = Verify::new(&[], |_: &[f64]| Quadratic::new().system())
        .method("constant", |_| Lying::<8>)
        .method("orbit", |_| Lying::<4>)
        .method("midpoint", |_| ImplicitMidpoint)
        .method("nothing", |_| Lying::<7>);
    let failing = examine(&program, &labels, &[1.6, 0.5]);
    assert!(failing.is_empty(), "{failing:?}");
    let program = Verify::new(&[], |_: &[f64]| Species::new().system())
        .method("orbit", |_| Lying::<4>)
        .method("along leaves", |_| OrbitEnergy::gonzalez())
        .method("nothing", |_| Lying::<7>);
    let labels = ["orbit", "along leaves", "nothing"];
    let failing = examine(&program, &labels, &[1.0, 1.9, 0.5]);
    assert_eq!(found(&failing, "orbit"), ["orbit"]);
    assert_eq!(failing.len(), 1, "{failing:?}");
}
