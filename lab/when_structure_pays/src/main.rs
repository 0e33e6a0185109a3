//! The measurements of `lab/docs/when_structure_pays.md`: one table on standard output, one picture to the file that is named.
//!
//! ```text
//! cargo run --release -- drift-body|drift-top|section|chain FILE.svg [NAME]
//! ```
//!
//! With a name only methods whose names contain it.

mod chain;
mod contest;
mod drift;
mod frequency;
mod peers;
mod systems;
mod table;
mod top;

use contest::{Entrant, Problem, Setting, ours};
use drift::Span;
use lie_runtime::Poisson;
use lie_runtime::methods::*;
use std::error::Error;
use systems::{Body, BodySystem, SpinChain, SpinChainSystem, Top, TopSystem};

type Outcome = Result<(), Box<dyn Error>>;

fn drift_body(file: &str, name: &str) -> Outcome {
    let system = Body::new().system()?;
    let problem = Problem {
        system,
        start: [1.1_f64.cos(), 0.0, 1.1_f64.sin()].into(),
        delta: 10.0,
        outside: format!(
            "{{\"name\": \"body\", \"I1\": 2.0, \"I2\": 1.0, \"I3\": {:?}}}",
            2.0 / 3.0
        ),
    };
    type P = BodySystem<f64>;
    let mut entrants: Vec<Entrant<P>> = vec![
        ours("splitting2", false, false, |_| Box::new(Splitting2::new())),
        ours("splitting4", false, false, |_| Box::new(Splitting4::new())),
        ours("splitting6", false, false, |_| Box::new(Splitting6::new())),
        ours("spherical-midpoint", false, false, |_| {
            Box::new(SphericalMidpoint)
        }),
        ours("collective16", false, false, |_| {
            Box::new(Collective16::smallest())
        }),
        ours("gauss16", false, false, |_| Box::new(Gauss16::default())),
        ours("midpoint", false, false, |_| Box::new(ImplicitMidpoint)),
        ours("lie-taylor", false, true, |tol| {
            Box::new(LieTaylor::with_tolerance(tol))
        }),
        ours("exact", false, false, |_| Box::new(Exact)),
        ours("rk4", true, false, |_| Box::new(Rk4)),
        ours("taylor", true, true, |tol| {
            Box::new(Taylor::with_tolerance(tol))
        }),
    ];
    entrants.extend(peers::solvers::<P, 3>());
    entrants.extend(peers::heyoka());
    entrants.retain(|entrant| entrant.name.contains(name));
    drifts(
        "Free rigid body",
        &problem,
        &entrants,
        &Span {
            first: 3,
            last: 7,
            most: 0.25e-6,
            wide: 0.7e-6,
        },
        &[0.1e-6, 0.25e-6],
        file,
    )
}

fn drifts<P: Poisson<f64>>(
    name: &str,
    problem: &Problem<P>,
    entrants: &[Entrant<P>],
    span: &Span,
    costs: &[f64],
    file: &str,
) -> Outcome {
    let found = drift::measure(problem, entrants, span);
    print!("{}", drift::table(problem, entrants, &found, span, costs));
    std::fs::write(file, drift::picture(name, entrants, &found, span))?;
    Ok(())
}

/// What every contest on a heavy top has.
fn top_entrants() -> Vec<Entrant<TopSystem<f64>>> {
    type P = TopSystem<f64>;
    let mut entrants: Vec<Entrant<P>> = vec![
        ours("splitting2", false, false, |_| Box::new(Splitting2::new())),
        ours("splitting4", false, false, |_| Box::new(Splitting4::new())),
        ours("splitting6", false, false, |_| Box::new(Splitting6::new())),
        ours("lie-midpoint", false, false, |_| {
            Box::new(LieMidpoint::exp())
        }),
        ours("collective16", false, false, |_| {
            Box::new(Collective16::smallest())
        }),
        ours("gauss16", false, false, |_| Box::new(Gauss16::default())),
        ours("midpoint", false, false, |_| Box::new(ImplicitMidpoint)),
        ours("lie-taylor", false, true, |tol| {
            Box::new(LieTaylor::with_tolerance(tol))
        }),
        ours("rk4", true, false, |_| Box::new(Rk4)),
        ours("taylor", true, true, |tol| {
            Box::new(Taylor::with_tolerance(tol))
        }),
    ];
    entrants.extend(peers::solvers::<P, 6>());
    entrants.extend(peers::heyoka());
    entrants
}

fn top_outside(parameters: [f64; 7]) -> String {
    let names = ["I1", "I2", "I3", "mgl", "c1", "c2", "c3"];
    let pairs = names
        .iter()
        .zip(parameters)
        .map(|(name, value)| format!("\"{name}\": {value:?}"));
    format!(
        "{{\"name\": \"top\", {}}}",
        pairs.collect::<Vec<_>>().join(", ")
    )
}

fn a_top(parameters: [f64; 7]) -> Result<TopSystem<f64>, Box<dyn Error>> {
    let [i1, i2, i3, mgl, c1, c2, c3] = parameters;
    Ok(Top {
        I1: i1,
        I2: i2,
        I3: i3,
        mgl,
        c1,
        c2,
        c3,
    }
    .system()?)
}

fn drift_top(file: &str, name: &str) -> Outcome {
    let parameters = [2.0, 1.5, 1.0, 1.0, 1.0 / 3.0, 1.0 / 7.0, 1.0];
    let problem = Problem {
        system: a_top(parameters)?,
        start: [0.4, 0.3, 0.9, 0.36, 0.48, 0.8].into(),
        delta: 10.0,
        outside: top_outside(parameters),
    };
    let mut entrants = top_entrants();
    entrants.retain(|entrant| entrant.name.contains(name));
    drifts(
        "Heavy top",
        &problem,
        &entrants,
        &Span {
            first: 3,
            last: 6,
            most: 3e-6,
            wide: 8e-6,
        },
        &[0.5e-6, 2.5e-6],
        file,
    )
}

fn section(file: &str, name: &str) -> Outcome {
    let parameters = [1.0, 1.05, 1.5, 1.0, 0.05, 0.0, 1.0];
    let problem = Problem {
        system: a_top(parameters)?,
        start: [0.4, 0.1, 1.8, 0.6, 0.0, 0.8].into(),
        delta: 0.5,
        outside: top_outside(parameters),
    };
    let until = 3e5;
    let mut entrants = top_entrants();
    let taylor = entrants
        .iter()
        .find(|entrant| entrant.name == "taylor")
        .ok_or("no reference")?;
    let exact = top::look(&problem, taylor, Setting::Tolerance(1e-16), until)?;
    entrants.retain(|entrant| entrant.name.contains(name));
    let (text, picture) = top::report(&problem, &entrants, &exact, until, &[0.5e-6, 2e-6]);
    print!("{text}");
    std::fs::write(file, picture)?;
    Ok(())
}

fn spins(file: &str, name: &str) -> Outcome {
    type P = SpinChainSystem<f64>;
    let start = chain::sample(0.6, 8, 2018);
    let mut state = SpinChain::new().system()?.zero_state();
    lie_runtime::State::as_mut_slice(&mut state).copy_from_slice(&start);
    let problem = Problem {
        system: SpinChain::new().system()?,
        start: state,
        delta: 1.0,
        outside: "{\"name\": \"chain\", \"n\": 8}".to_owned(),
    };
    let mut entrants: Vec<Entrant<P>> = vec![
        ours("spherical-midpoint", false, false, |_| {
            Box::new(SphericalMidpoint)
        }),
        ours("collective16", false, false, |_| {
            Box::new(Collective16::smallest())
        }),
        ours("gauss16", false, false, |_| Box::new(Gauss16::default())),
        ours("midpoint", false, false, |_| Box::new(ImplicitMidpoint)),
        ours("lie-taylor", false, true, |tol| {
            Box::new(LieTaylor::with_tolerance(tol))
        }),
        ours("rk4", true, false, |_| Box::new(Rk4)),
        ours("taylor", true, true, |tol| {
            Box::new(Taylor::with_tolerance(tol))
        }),
    ];
    entrants.extend(peers::solvers::<P, 24>());
    entrants.extend(peers::heyoka());
    entrants.retain(|entrant| entrant.name.contains(name));
    let (text, picture) = chain::report(&problem, &entrants, 2e5, &[3e-6, 10e-6]);
    print!("{text}");
    std::fs::write(file, picture)?;
    Ok(())
}

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let name = words.get(2).copied().unwrap_or_default().to_owned();
    words.truncate(2);
    match words[..] {
        ["drift-body", file] => drift_body(file, &name),
        ["drift-top", file] => drift_top(file, &name),
        ["section", file] => section(file, &name),
        ["chain", file] => spins(file, &name),
        _ => Err(
            "usage: when-structure-pays drift-body|drift-top|section|chain FILE.svg [NAME]".into(),
        ),
    }
}
