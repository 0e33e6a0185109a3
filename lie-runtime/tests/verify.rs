//! The program behind `lie verify` on systems written by hand: what it shows of a sound system, and that it notices a form
//! that differs and a measurement that is blind.

mod systems;

use lie_runtime::diagnostics::verify::{Ground, Subject, broken_measurements};
use lie_runtime::prelude::*;
use lie_runtime::program::measure::Verify;
use nalgebra::{SMatrix, SVector};
use std::io::{self, Write as _};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::{RigidBody, dot, hat};
use systems::state;

type Lines = Vec<Vec<String>>;

fn serve<P>(program: &Verify<P>, methods: &[&str]) -> Lines
where
    P: Lift<f64> + Clone + 'static,
{
    let (input, mut writer) = io::pipe().expect("a pipe");
    for method in methods {
        writeln!(writer, "method {method}").expect("the pipe takes it");
    }
    write!(writer, "initial 0.6 -0.5 0.7\nrun\n").expect("the pipe takes it");
    let (mut output, mut messages) = (Vec::new(), Vec::new());
    let code = program.serve(io::BufReader::new(input), &mut output, &mut messages);
    drop(writer);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&messages));
    let text = String::from_utf8(output).expect("text");
    let fields = |line: &str| line.split('\t').map(str::to_owned).collect();
    text.lines().map(fields).collect()
}

fn body(_parameters: &[f64]) -> Result<RigidBody, ParameterError> {
    Ok(RigidBody::default())
}

#[test]
fn a_sound_system_passes() {
    let program = Verify::new(&[], body)
        .with_orbits()
        .with_group()
        .with_cayley()
        .method("lie-midpoint", |_| LieMidpoint::exp())
        .method("rk4", |_| Rk4)
        .plain("lie-midpoint", body, |_| LieMidpoint::exp());
    let lines = serve(&program, &["lie-midpoint", "rk4"]);
    let of = |kind: &str| {
        lines
            .iter()
            .filter(|line| line[0] == kind)
            .collect::<Vec<_>>()
    };
    assert!(of("broken").is_empty(), "{:?}", of("broken"));
    for finding in of("finding") {
        assert_ne!(finding[6], "fails", "{finding:?}");
    }
    let facts = |label: &str| {
        let of_label = of("finding")
            .into_iter()
            .filter(|f| f[1] == label && f[6] == "holds");
        of_label.map(|f| f[2].clone()).collect::<Vec<_>>()
    };
    assert!(of("unsound").is_empty(), "{:?}", of("unsound"));
    for fact in [
        "generic form",
        "row exchanges",
        "failed steps",
        "rows",
        "group",
    ] {
        assert!(
            facts("lie-midpoint").iter().any(|known| known == fact),
            "{fact}"
        );
    }
    assert!(facts("rk4").iter().any(|fact| fact == "group"));
    // four states, each with the kernels of three traits
    let kernels = of("kernel");
    assert_eq!(kernels.len(), 4 * (11 + 3 + 2));
    let ad = kernels
        .iter()
        .find(|line| line[1] == "ad")
        .expect("a kernel");
    let vector = |text: &str| -> Vec<f64> {
        text.split(' ')
            .map(|number| number.parse().expect("a number"))
            .collect()
    };
    let (xi, eta) = ad[2].split_once('|').expect("two arguments");
    let (xi, eta, out) = (vector(xi), vector(eta), vector(&ad[3]));
    assert_eq!(out[0], xi[1] * eta[2] - xi[2] * eta[1]);
    assert_eq!(of("reference").len(), 4);
}

#[test]
fn another_form_is_noticed() {
    let other = |_: &[f64]| {
        let inertia = [2.0 + 1e-9, 1.0, 2.0 / 3.0];
        Ok(RigidBody { inertia })
    };
    let program = Verify::new(&[], body)
        .method("midpoint", |_| ImplicitMidpoint)
        .plain("midpoint", other, |_| ImplicitMidpoint);
    let lines = serve(&program, &["midpoint"]);
    let failing: Vec<&str> = lines
        .iter()
        .filter(|line| line[0] == "finding" && line[6] == "fails")
        .map(|line| line[2].as_str())
        .collect();
    assert_eq!(failing, ["generic form"]);
}

/// A Poisson matrix that is zero over dual numbers: the defect of every map is zero.
#[derive(Clone, Copy)]
struct Blind<const BLIND: bool>;

macro_rules! of_nonpolynomial {
    ($($name:ident($($argument:ident: $type:ty),*) $(-> $result:ty)?;)*) => {
        $(fn $name(&self, $($argument: $type),*) $(-> $result)? {
            Poisson::<S>::$name(&Nonpolynomial, $($argument),*)
        })*
    };
}

impl<S: Scalar, const BLIND: bool> Poisson<S> for Blind<BLIND> {
    type State = SVector<S, 3>;
    type Jacobian = SMatrix<S, 3, 3>;
    fn dimension(&self) -> usize {
        3
    }
    fn casimir_count(&self) -> usize {
        1
    }
    fn name(&self) -> &str {
        "Blind"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["x", "y", "z"][index]
    }
    fn casimir_name(&self, index: usize) -> &str {
        ["C"][index]
    }
    of_nonpolynomial! {
        zero_state() -> SVector<S, 3>;
        zero_jacobian() -> SMatrix<S, 3, 3>;
        hamiltonian(mu: &SVector<S, 3>) -> S;
        gradient(mu: &SVector<S, 3>, out: &mut SVector<S, 3>);
        hessian(mu: &SVector<S, 3>, out: &mut SMatrix<S, 3, 3>);
        jacobian(mu: &SVector<S, 3>, out: &mut SMatrix<S, 3, 3>);
    }
    fn vector_field(&self, mu: &SVector<S, 3>, out: &mut SVector<S, 3>) {
        Poisson::<S>::vector_field(&Nonpolynomial, mu, out);
    }
    fn poisson_matrix(&self, mu: &SVector<S, 3>, out: &mut SMatrix<S, 3, 3>) {
        *out = hat(mu.as_slice());
        if BLIND {
            *out = SMatrix::<S, 3, 3>::repeat(S::zero());
        }
    }
    fn casimirs(&self, mu: &SVector<S, 3>, out: &mut [S]) {
        // of no use to a measurement: it does not change
        out[0] = dot(mu.as_slice(), mu.as_slice()) - dot(mu.as_slice(), mu.as_slice());
    }
    fn casimir_gradient(&self, index: usize, mu: &SVector<S, 3>, out: &mut SVector<S, 3>) {
        Poisson::<S>::casimir_gradient(&Nonpolynomial, index, mu, out);
    }
}

impl<S: Scalar, const BLIND: bool> Lift<S> for Blind<BLIND> {
    type Lifted = Blind<true>;
    fn lift(&self) -> Blind<true> {
        Blind
    }
}

#[test]
fn a_blind_measurement_is_noticed() {
    let subject = || Subject {
        method: Box::new(Rk4),
        lifted: Box::new(Rk4),
        composed: false,
        with_tolerance: None,
        plain: None,
        beside: false,
    };
    let system = Blind::<false>;
    let start = state(&system, &[0.6, -0.5, 0.7]);
    let ground = Ground::new(&system, &start, 1, None).expect("something moves");
    let broken = broken_measurements(&system, &Lift::<f64>::lift(&system), &ground, &subject());
    assert_eq!(broken, ["other Casimirs", "Poisson"]);
    // the sound system has no such measurement
    let start = state(&Nonpolynomial, &[0.6, -0.5, 0.7]);
    let ground = Ground::new(&Nonpolynomial, &start, 1, None).expect("something moves");
    let ground = ground.with_orbits();
    let subject = Subject {
        method: Box::new(Rk4),
        lifted: Box::new(Rk4),
        composed: false,
        with_tolerance: None,
        plain: None,
        beside: false,
    };
    let broken = broken_measurements(&Nonpolynomial, &Nonpolynomial, &ground, &subject);
    assert!(broken.is_empty(), "{broken:?}");
}
