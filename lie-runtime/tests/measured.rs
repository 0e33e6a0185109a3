//! The program behind `lie verify` on systems written by hand: what it shows of a sound system, and that it notices a form
//! that differs and a measurement that is blind.

use crate::systems::nonpolynomial::Nonpolynomial;
use crate::systems::rigid_body::{RigidBody, dot, hat};
use crate::systems::state;
use lie_measure::Verify;
use lie_measure::facts::{Finding, Ground, Subject, Verdict, broken_measurements};
use lie_measure::verify::{Found, Options};
use lie_program::listen::listen;
use lie_program::protocol::{End, Message, Start};
use lie_runtime::prelude::*;
use nalgebra::{SMatrix, SVector};
use std::io::{self, Write as _};

fn serve<P>(program: &Verify<P>, methods: &[&str]) -> Vec<Found>
where
    P: Lift<f64> + Clone + 'static,
{
    let request = lie_measure::Request {
        methods: methods.iter().map(|&method| method.to_owned()).collect(),
        start: Start {
            initial: vec![0.6, -0.5, 0.7],
            ..Start::default()
        },
        options: Options {
            seed: 1,
            ..Options::default()
        },
    };
    let (input, mut writer) = io::pipe().expect("a pipe");
    let line = serde_json::to_string(&request).expect("text");
    writeln!(writer, "{line}").expect("the pipe takes it");
    let mut output = Vec::new();
    let code = program.serve(io::BufReader::new(input), &mut output);
    drop(writer);
    let (mut all, mut ended) = (Vec::new(), None);
    listen(&mut output.as_slice(), &mut |message| {
        match message {
            Message::Found(found) => all.push(found),
            Message::End(end) => ended = Some(end),
            Message::Progress(_) => {}
        }
        Ok(())
    })
    .expect("messages");
    assert_eq!((code, ended), (0, Some(End::Done)));
    all
}

/// The findings, with their methods.
fn findings(all: &[Found]) -> Vec<(&str, &Finding)> {
    let findings = all.iter().filter_map(|found| match found {
        Found::Finding { method, finding } => Some((method.as_str(), finding)),
        _ => None,
    });
    findings.collect()
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
    let all = serve(&program, &["lie-midpoint", "rk4"]);
    for found in &all {
        let sound = !matches!(found, Found::Broken { .. } | Found::Unsound { .. });
        assert!(sound, "{found:?}");
    }
    for (method, finding) in findings(&all) {
        assert_ne!(finding.verdict, Verdict::Fails, "{method}: {finding:?}");
    }
    let holds = |label: &str, fact: &str| {
        findings(&all).iter().any(|(method, finding)| {
            *method == label && finding.fact == fact && finding.verdict == Verdict::Holds
        })
    };
    for fact in [
        "generic form",
        "row exchanges",
        "failed steps",
        "rows",
        "group",
    ] {
        assert!(holds("lie-midpoint", fact), "{fact}");
    }
    assert!(holds("rk4", "group"));
    // four states, each with the kernels of three traits
    let kernels: Vec<_> = all
        .iter()
        .filter_map(|found| match found {
            Found::Kernel(kernel) => Some(kernel),
            _ => None,
        })
        .collect();
    assert_eq!(kernels.len(), 4 * (11 + 3 + 2));
    let ad = kernels.iter().find(|kernel| kernel.name == "ad");
    let ad = ad.expect("a kernel");
    let [xi, eta] = ad.arguments.as_slice() else {
        panic!("two arguments")
    };
    assert_eq!(ad.values[0], xi[1] * eta[2] - xi[2] * eta[1]);
    let references = all
        .iter()
        .filter(|found| matches!(found, Found::Reference(_)));
    assert_eq!(references.count(), 4);
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
    let all = serve(&program, &["midpoint"]);
    let failing: Vec<&str> = findings(&all)
        .into_iter()
        .filter(|(_, finding)| finding.verdict == Verdict::Fails)
        .map(|(_, finding)| &*finding.fact)
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
    // where no orbit is at hand a leaf is measured by the same Casimirs
    assert_eq!(broken, ["other Casimirs", "orbit", "Poisson"]);
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
