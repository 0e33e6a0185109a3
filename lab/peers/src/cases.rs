//! The cases: which system, which methods.

use crate::Case;
use crate::ours::{FUSED, Ours, solvers, to_round_off, to_the_tolerance};
use crate::trial::{Trials, euclidean};
use crate::{chain, crates, ensemble};
use lie_runtime::driver::Problem;
use lie_runtime::methods::*;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, State};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The systems as lie-poisson generates them.
pub mod systems {
    #![allow(missing_docs, dead_code, unused_imports, clippy::all)]
    include!(concat!(env!("OUT_DIR"), "/systems.rs"));
}

/// Right-hand sides for the other crates.
mod fields {
    use super::{cos, exp, rsqrt};
    include!(concat!(env!("OUT_DIR"), "/fields.rs"));
}

#[inline(always)]
fn cos(x: f64) -> f64 {
    x.cos()
}

#[inline(always)]
fn exp(x: f64) -> f64 {
    x.exp()
}

#[inline(always)]
fn rsqrt(x: f64) -> f64 {
    1.0 / x.sqrt()
}

/// What `cases.json` says of a case.
#[derive(Deserialize)]
struct Given {
    #[serde(default)]
    parameters: Vec<f64>,
    #[serde(default)]
    initial: Vec<f64>,
    until: f64,
}

impl Given {
    fn of(case: &str) -> Self {
        let text = include_str!("../cases.json");
        let mut all: BTreeMap<String, Given> = serde_json::from_str(text).expect("sound cases");
        all.remove(case)
            .unwrap_or_else(|| panic!("there is no case {case}"))
    }

    fn array<const N: usize>(values: &[f64]) -> [f64; N] {
        values.try_into().expect("as many values as the spec has")
    }
}

/// The right-hand side for the others must be the field of the spec.
fn same_field<P: Poisson<f64>>(problem: &Problem<f64, P>, field: impl Fn(&[f64], &mut [f64])) {
    let (mut ours, mut other) = (problem.system.zero_state(), problem.system.zero_state());
    problem.system.vector_field(&problem.mu0, &mut ours);
    field(problem.mu0.as_slice(), other.as_mut_slice());
    for (a, b) in ours.as_slice().iter().zip(other.as_slice()) {
        assert!(
            (a - b).abs() <= 1e-14,
            "the right-hand sides differ: {a} and {b}"
        );
    }
}

/// A ladder of steps for methods of order 8 and more, and for others.
const FINE: f64 = 1.06;
const COARSE: f64 = 1.25;

/// Those that apply to every system.
macro_rules! common {
    ($ours:ident, $quick:expr) => {
        let (all, default) = (solvers($quick), [NewtonOptions::default()]);
        $ours.by_tolerance("gauss8", Gauss8, NewtonOptions::default());
        $ours.by_tolerance("gauss16", Gauss16, NewtonOptions::default());
        $ours.by_tolerance("gauss8, converge tolerance", Gauss8, to_the_tolerance());
        $ours.by_tolerance("gauss16, converge tolerance", Gauss16, to_the_tolerance());
        $ours.by_steps("gauss16", Gauss16, FINE, &all);
        $ours.by_steps("gauss12", Gauss12, FINE, &all);
        $ours.by_steps("gauss8", Gauss8, FINE, &all);
        $ours.by_tolerance(
            "cohen-hairer16",
            CohenHairer16::new(),
            NewtonOptions::default(),
        );
        $ours.by_steps("cohen-hairer16", CohenHairer16::new(), FINE, &all);
        $ours.by_tolerance("rk4", Rk4, NewtonOptions::default());
        $ours.by_steps("rk4", Rk4, COARSE, &default);
        $ours.taylor();
        $ours.lie_taylor();
    };
}

/// A collective method, as it is by default, to the state alone, and by `--tol`.
macro_rules! collective {
    ($ours:ident, $quick:expr, $label:literal, $method:expr) => {
        $ours.by_tolerance(concat!($label, ", converge map"), $method, to_round_off());
        $ours.by_steps(
            concat!($label, ", converge map"),
            $method,
            FINE,
            &[to_round_off()],
        );
        $ours.by_steps(
            concat!($label, ", converge state"),
            $method,
            FINE,
            &solvers($quick)[1..],
        );
    };
}

macro_rules! splittings {
    ($ours:ident, $ratio:expr) => {
        let default = [NewtonOptions::default()];
        $ours.by_steps("splitting4", Splitting4::new(), $ratio, &default);
        $ours.by_steps("splitting6", Splitting6::new(), $ratio, &default);
        $ours.by_steps("splitting8", Splitting8::new(), $ratio, &default);
    };
}

macro_rules! case {
    ($case:ident, $then:ident, $given:ident, $n:literal, $module:ident, $system:expr, $ours:ident, $methods:block) => {{
        let start = Given::array::<$n>(&$given.initial);
        let problem = Problem::new($system, start, (0.0, $given.until));
        same_field(&problem, fields::$module);
        let mut trials = Trials {
            reference: &$case.reference,
            distance: euclidean,
            all: Vec::new(),
            budget: $case.budget,
        };
        let mut $ours = Ours {
            problem: &problem,
            trials: &mut trials,
            quick: $case.quick,
        };
        $methods
        if !FUSED {
            crates::measure(&mut trials, fields::$module, start, $given.until, $case.quick);
        }
        $then(&mut trials);
    }};
}

/// The chain of spins.
fn with_chain(case: &Case, then: &mut dyn FnMut(&mut Trials<'_>)) {
    let given = case.initial.as_ref().expect("an initial state");
    let start = chain::state(given);
    let reference = chain::state(&case.reference);
    let until = Given::of("D").until;
    let chain = systems::heisenberg_chain::HeisenbergChain {
        N: (given.len() / 3) as f64,
        J: 1.0,
    };
    let system = chain.system().expect("a number of spins");
    let problem = Problem::new(system, start.clone(), (0.0, until));
    same_field(&problem, chain::field);
    let mut trials = Trials {
        reference: &reference,
        distance: chain::distance,
        all: Vec::new(),
        budget: case.budget,
    };
    let mut ours = Ours {
        problem: &problem,
        trials: &mut trials,
        quick: case.quick,
    };
    let (all, default) = (solvers(case.quick), [NewtonOptions::default()]);
    ours.by_tolerance("gauss16", Gauss16, default[0]);
    ours.by_steps("gauss16", Gauss16, FINE, &all);
    ours.by_steps("gauss12", Gauss12, FINE, &all);
    ours.by_steps("gauss8", Gauss8, FINE, &all);
    ours.by_tolerance("rk4", Rk4, default[0]);
    ours.by_steps("rk4", Rk4, COARSE, &default);
    splittings!(ours, FINE);
    ours.by_tolerance("splitting4", Splitting4::new(), default[0]);
    ours.by_tolerance("splitting6", Splitting6::new(), default[0]);
    ours.by_tolerance("splitting8", Splitting8::new(), default[0]);
    if !FUSED {
        crates::measure_large(&mut trials, chain::field, &start, until, case.quick);
    }
    then(&mut trials);
}

/// Many bodies.
fn with_ensemble(case: &Case, then: &mut dyn FnMut(&mut Trials<'_>)) {
    let given = Given::of("C");
    let start = case.initial.as_ref().expect("initial states");
    let groups = ensemble::groups(Given::array(&given.parameters), start, given.until);
    let mut trials = Trials {
        reference: &case.reference,
        distance: ensemble::distance,
        all: Vec::new(),
        budget: case.budget,
    };
    let mut ours = ensemble::Ensemble {
        groups: &groups,
        trials: &mut trials,
    };
    ours.measure(given.until, case.quick);
    then(&mut trials);
}

/// Tries everything on a case, and shows what came of it.
pub fn with(case: &Case, then: &mut dyn FnMut(&mut Trials<'_>)) {
    use systems::*;
    let given = Given::of(&case.case);
    let sound = "a sound system";
    let quick = case.quick;
    match case.case.as_str() {
        "A" => {
            let values = Given::array(&given.parameters);
            let system = so3_free_rigid_body::FreeRigidBody::from_values(&values);
            let system = system.system().expect(sound);
            case!(case, then, given, 3, so3_free_rigid_body, system, ours, {
                common!(ours, quick);
                collective!(ours, quick, "collective16 hopf", Collective16::hopf());
                splittings!(ours, COARSE);
                ours.with_steps("exact, the end alone", Exact, 1);
                ours.with_steps("exact, at 1,000 steps", Exact, 1000);
            });
        }
        "B" => {
            let values = Given::array(&given.parameters);
            let system = se3_heavy_top::HeavyTop::from_values(&values);
            let system = system.system().expect(sound);
            case!(case, then, given, 6, se3_heavy_top, system, ours, {
                common!(ours, quick);
                collective!(
                    ours,
                    quick,
                    "collective16 quaternion",
                    Collective16::quaternion()
                );
                splittings!(ours, COARSE);
            });
        }
        "N" => {
            let system = so3_nonpolynomial::NonpolynomialSpin::<f64>::new();
            let system = system.system().expect(sound);
            case!(case, then, given, 3, so3_nonpolynomial, system, ours, {
                common!(ours, quick);
                collective!(ours, quick, "collective16 hopf", Collective16::hopf());
            });
        }
        "U" => {
            let system = su3_quadratic::Su3Quadratic::<f64>::new();
            let system = system.system().expect(sound);
            case!(case, then, given, 8, su3_quadratic, system, ours, {
                common!(ours, quick);
                collective!(
                    ours,
                    quick,
                    "collective16 representation",
                    Collective16::representation()
                );
            });
        }
        "K" => {
            let system = se3_kirchhoff::KirchhoffBody::<f64>::new();
            let system = system.system().expect(sound);
            case!(case, then, given, 6, se3_kirchhoff, system, ours, {
                common!(ours, quick);
                collective!(
                    ours,
                    quick,
                    "collective16 quaternion",
                    Collective16::quaternion()
                );
            });
        }
        "C" => with_ensemble(case, then),
        "D" => with_chain(case, then),
        other => panic!("there is no case {other}"),
    }
}
