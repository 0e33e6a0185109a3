//! Systems whose Hamiltonian depends on the time, by every method: the time is that of the row, and how large it is
//! changes no result.

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_codegen::structure::Structure;
use lie_dynamic::{Declared, Dynamic};
use lie_in_process::list;
use lie_in_process::members::{Member, Members, Watch};
use lie_jit::Jit;
use lie_methods::at_defaults;
use lie_runtime::Poisson;
use lie_runtime::driver::{Options, Problem, Save};
use lie_runtime::methods::Tolerances;
use lie_runtime::newton::NewtonOptions;

const STEP: f64 = 0.1;
const SYSTEMS: [&str; 3] = ["rotation", "oscillator", "top"];

fn model(name: &str) -> Structure {
    let path = format!(
        "{}/../../tests/data/driven/{name}.json",
        env!("CARGO_MANIFEST_DIR")
    );
    compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// By how much a step alone, without a driver that sets the time, misses it, in units of round-off of the time.
fn missed(system: &Dynamic<f64>, choice: &Choice) -> f64 {
    let time = 1e5;
    let clock = Poisson::<f64>::clock(system).unwrap();
    let mut mu = system.initial_state().unwrap();
    mu[clock.time] = time;
    let method = at_defaults(choice);
    let mut stepper = method.any_stepper(system, STEP, &NewtonOptions::default());
    let stepped = stepper.step(&mut mu);
    assert!(stepped.is_ok(), "{}: {stepped:?}", choice.label());
    assert_eq!(mu[clock.time + 1], 1.0, "{}", choice.label());
    (mu[clock.time] - (time + STEP)).abs() / (time * f64::EPSILON)
}

#[test]
fn the_time_moves_as_it_does() {
    for name in SYSTEMS {
        let model = model(name);
        let choices = list::applicable(&model);
        assert!(choices.len() > 20, "{name}: {}", choices.len());
        // fused and generic
        for fused in [&choices[..], &[]] {
            let system = Dynamic::new(plan(&model, fused), &[], &Jit).unwrap();
            for choice in &choices {
                let missed = missed(&system, choice);
                // a composition has up to 25 steps
                assert!(missed <= 16.0, "{name} {}: {missed}", choice.label());
            }
        }
    }
}

/// The end of a run of some steps from a time.
fn end(system: &Dynamic<f64>, choice: &Choice, from: f64, steps: u32) -> Vec<f64> {
    let problem = Problem {
        system: system.clone(),
        mu0: system.initial_state().unwrap(),
        span: (from, from + f64::from(steps) * STEP),
    };
    let solution = lie_runtime::driver::solve(
        &problem,
        lie_runtime::diagnostics::Forgotten(at_defaults(choice).as_ref()),
        &Options::new(STEP).save(Save::Ends),
    );
    let solution = solution.unwrap_or_else(|error| panic!("{}: {error}", choice.label()));
    let (time, end) = solution.last().unwrap();
    let clock = Poisson::<f64>::clock(system).unwrap();
    assert_eq!(end[clock.time], time, "{}", choice.label());
    end.iter().take(clock.momentum).copied().collect()
}

/// Every method at the time 0 and after many periods of H.
#[test]
fn the_size_of_the_time_changes_nothing() {
    let period = std::f64::consts::TAU;
    let late = 15915.0 * period;
    let distance = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    for name in SYSTEMS {
        let model = model(name);
        let choices = list::applicable(&model);
        let declared = Declared::new(plan(&model, &choices), &Jit);
        let system = declared.system(&[]).unwrap();
        for choice in &choices {
            let steps = 60;
            let early = end(&system, choice, 0.0, steps);
            let error = distance(&end(&system, choice, late, steps), &early);
            assert!(error < 3e-10, "{name} {}: {error:e}", choice.label());
            // the control: another time of the period
            let other = distance(&end(&system, choice, late + 1e-6, steps), &early);
            assert!(other > 3e-9, "{name} {}: {other:e}", choice.label());
        }
    }
}

#[test]
fn members_in_lanes_have_the_bits_of_members_alone() {
    let model = model("oscillator");
    let choices = list::applicable(&model);
    let declared = Declared::new(plan(&model, &choices), &Jit);
    let start = declared.system(&[]).unwrap().initial_state().unwrap();
    let starts: Vec<Vec<f64>> = (0..11)
        .map(|k| {
            let mut start = start.clone();
            start[0] += 0.01 * f64::from(k);
            start
        })
        .collect();
    for choice in &choices {
        let members = Members {
            declared: &declared,
            choice,
            tolerances: Tolerances::default(),
            parameters: vec![Vec::new(); starts.len()],
            starts: starts.clone(),
            count: starts.len(),
            span: (7.0, 9.0),
            held: Default::default(),
            sources: Default::default(),
            events: false,
            options: Options::new(STEP).save(Save::Ends),
        };
        let bits = |found: Vec<Member>| -> Vec<Vec<u64>> {
            let states = found.iter().map(|member| &member.states);
            states
                .map(|state| state.iter().map(|x| x.to_bits()).collect())
                .collect()
        };
        let watch = Watch::default();
        let all = bits(members.run(0..starts.len(), &watch));
        let each = (0..starts.len()).flat_map(|k| members.run(k..k + 1, &watch));
        assert_eq!(all, bits(each.collect()), "{}", choice.label());
    }
}
