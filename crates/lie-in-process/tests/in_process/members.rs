//! Members in lanes have the bits of members alone, whatever the method, the parameters and what is saved.

use lie_codegen::compile::{compile_spec, with_options};
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_codegen::structure::Structure;
use lie_dynamic::{Declared, Engine, Interpreted, Tolerances};
use lie_in_process::list;
use lie_in_process::members::{LANES, Member, Members, Watch};
use lie_jit::{Jit, Registers};
use lie_runtime::driver::{Options, Save};

const COUNT: usize = 19;
const STEP: f64 = 0.1;
const END: f64 = 4.0;

fn model(name: &str) -> Structure {
    let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
    compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Numbers between -1/2 and 1/2.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 2018_u64;
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// Members around the declared state: from close to it to far from it, so that iterations have different lengths.
fn starts(declared: &Declared) -> Vec<Vec<f64>> {
    let start = declared.system(&[]).unwrap().initial_state().unwrap();
    let mut number = numbers();
    let far = [1e-6, 1e-3, 0.1, 0.3, 1.0];
    (0..COUNT)
        .map(|member| {
            let size = far[member % far.len()];
            start.iter().map(|x| x + size * number()).collect()
        })
        .collect()
}

fn bits(members: &[Member]) -> Vec<Vec<u64>> {
    let all = members.iter();
    all.map(|member| {
        let numbers = member.times.iter().chain(&member.states);
        numbers.map(|x| x.to_bits()).collect()
    })
    .collect()
}

fn all(members: &Members<'_>) -> Vec<Member> {
    let watch = Watch::default();
    let found = members.run(0..members.starts.len(), &watch);
    assert_eq!(watch.done.into_inner(), found.len());
    found
}

/// Each in a call of its own: groups of one are not run in lanes.
fn alone(members: &Members<'_>) -> Vec<Member> {
    let watch = Watch::default();
    let each = 0..members.starts.len();
    each.flat_map(|member| members.run(member..member + 1, &watch))
        .collect()
}

/// What is different between members in lanes and alone, by method; the control differs in the last digits of one member's start.
fn different(name: &str, engine: &dyn Engine) -> (usize, Vec<String>) {
    let model = model(name);
    let choices = list::applicable(&model);
    let declared = Declared::new(plan(&model, &choices), engine);
    let starts = starts(&declared);
    let (mut compared, mut different) = (0, Vec::new());
    for choice in &choices {
        let mut members = Members {
            declared: &declared,
            choice,
            tolerances: Tolerances::default(),
            parameters: vec![Vec::new()],
            starts: starts.clone(),
            count: COUNT,
            options: Options::new(STEP).save(Save::Ends),
            span: (0.0, END),
            held: Default::default(),
            sources: Default::default(),
            events: false,
        };
        let expected = alone(&members);
        let found = all(&members);
        if bits(&found) != bits(&expected) || failures(&found) != failures(&expected) {
            different.push(choice.label());
        }
        compared += usize::from(members.takes_lanes());
        members.starts[9][0] *= 1.0 + 1e-9;
        if bits(&all(&members)) == bits(&expected) && expected[9].failed.is_none() {
            different.push(format!("{} does not see a change", choice.label()));
        }
    }
    (compared, different)
}

fn failures(members: &[Member]) -> Vec<Option<(f64, String)>> {
    members.iter().map(|member| member.failed.clone()).collect()
}

fn has_the_bits_of_members_alone(name: &str) {
    let widest = Registers::widest();
    let others = Registers::ALL
        .into_iter()
        .filter(|registers| Some(*registers) != widest);
    let mut engines: Vec<Box<dyn Engine>> = vec![Box::new(Jit)];
    engines.extend(
        others
            .filter_map(Jit::with)
            .map(|engine| Box::new(engine) as Box<dyn Engine>),
    );
    for engine in engines {
        let (compared, different) = different(name, engine.as_ref());
        let engine = engine.name();
        assert!(compared >= 4, "{name}, {engine}: {compared}");
        assert!(different.is_empty(), "{name}, {engine}: {different:?}");
    }
}

#[test]
fn every_method_on_a_body() {
    has_the_bits_of_members_alone("so3_free_rigid_body");
}

#[test]
fn every_method_on_a_top() {
    has_the_bits_of_members_alone("se3_heavy_top");
}

#[test]
fn every_method_on_a_pendulum() {
    has_the_bits_of_members_alone("e2_pendulum");
}

#[test]
fn every_method_without_an_algebra() {
    has_the_bits_of_members_alone("lotka_volterra");
}

/// The heavy top with its first moment of inertia from member to member.
fn sweep<'a>(declared: &'a Declared, choice: &'a Choice, save: Save) -> Members<'a> {
    let defaults = declared.system(&[]).unwrap().parameters().to_vec();
    let of_member = |member: usize| {
        let mut values = defaults.clone();
        values[0] *= 1.0 + 0.1 * member as f64;
        values
    };
    Members {
        declared,
        choice,
        tolerances: Tolerances::default(),
        parameters: (0..COUNT).map(of_member).collect(),
        starts: starts(declared),
        count: COUNT,
        options: Options::new(STEP).save(save),
        span: (0.0, END),
        held: Default::default(),
        sources: Default::default(),
        events: false,
    }
}

fn top(choices: &[Choice], engine: &dyn Engine) -> Declared {
    let model = model("se3_heavy_top");
    Declared::new(plan(&model, &with_options(&model, choices)), engine)
}

fn choices() -> Vec<Choice> {
    [
        "rk4",
        "gauss4",
        "gauss16",
        "taylor",
        "dopri5",
        "lie-midpoint",
    ]
    .map(|id| Choice::from_id(id).unwrap())
    .to_vec()
}

#[test]
fn parameters_and_rows_of_each_member() {
    let choices = choices();
    let declared = top(&choices, &Jit);
    for choice in &choices {
        let saves = [
            (Save::Ends, 1),
            (Save::Every(7), 7),
            (Save::At(vec![0.0, 0.25, 1.0, 3.99]), 4),
        ];
        for (save, rows) in saves {
            let members = sweep(&declared, choice, save);
            let (found, expected) = (all(&members), alone(&members));
            assert_eq!(bits(&found), bits(&expected), "{}", choice.label());
            assert!(found.iter().all(|member| member.times.len() == rows));
            let mut swapped = members;
            swapped.parameters.swap(3, 4);
            assert_ne!(bits(&all(&swapped)), bits(&expected), "{}", choice.label());
        }
    }
}

#[test]
fn members_that_fail_fail_as_alone_and_leave_the_others_as_they_are() {
    let choices = choices();
    let declared = top(&choices, &Jit);
    for choice in &choices {
        for save in [Save::Ends, Save::Every(1)] {
            let whole = all(&sweep(&declared, choice, save.clone()));
            let mut members = sweep(&declared, choice, save);
            // not finite from the start; later; no system
            members.starts[2][0] = f64::NAN;
            members.starts[5][0] = 1e160;
            members.parameters[12][0] = 0.0;
            let (found, expected) = (all(&members), alone(&members));
            assert_eq!(bits(&found), bits(&expected), "{}", choice.label());
            assert_eq!(failures(&found), failures(&expected), "{}", choice.label());
            for (member, (found, whole)) in found.iter().zip(&whole).enumerate() {
                let broken = [2, 5, 12].contains(&member);
                assert_eq!(
                    found.failed.is_some(),
                    broken,
                    "{}: {member}",
                    choice.label()
                );
                assert_eq!(found == whole, !broken, "{}: {member}", choice.label());
            }
        }
    }
}

#[test]
fn a_group_that_fails_late_keeps_its_rows() {
    let choices = [Choice::from_id("midpoint").unwrap()];
    let declared = top(&choices, &Jit);
    let mut members = sweep(&declared, &choices[0], Save::Every(1));
    members.options = Options::new(30.0).save(Save::Every(1));
    members.span.1 = 300.0;
    let (found, expected) = (all(&members), alone(&members));
    assert_eq!(failures(&found), failures(&expected));
    assert_eq!(bits(&found), bits(&expected));
    let late = found
        .iter()
        .any(|member| member.failed.is_some() && member.times.len() > 1);
    let good = found.iter().any(|member| member.failed.is_none());
    assert!(late && good, "{:?}", failures(&found));
}

#[test]
fn with_a_tolerance_members_are_alone() {
    let gauss4 = Choice::from_id("gauss4").unwrap();
    let declared = top(std::slice::from_ref(&gauss4), &Jit);
    let mut members = sweep(&declared, &gauss4, Save::Ends);
    assert!(members.takes_lanes());
    members.options = Options::tolerance(1e-6);
    assert!(!members.takes_lanes());
    assert_eq!(LANES, 8);
}

/// Members one by one, by the interpreter, which makes all steps kernel by kernel.
fn kernel_by_kernel(members: &Members<'_>) -> Vec<Member> {
    let each = members.starts.iter().zip(&members.parameters);
    let run = |(start, parameters): (&Vec<f64>, &Vec<f64>)| {
        let declared = top(std::slice::from_ref(members.choice), &Interpreted);
        let one = Members {
            declared: &declared,
            parameters: vec![parameters.clone()],
            starts: vec![start.clone()],
            count: 1,
            options: members.options.clone(),
            held: members.held.clone(),
            sources: members.sources.clone(),
            events: false,
            ..*members
        };
        let member = all(&one).remove(0);
        assert_eq!(declared.system(&[]).unwrap().programs(members.choice), 0);
        member
    };
    each.map(run).collect()
}

#[test]
fn steps_and_equations_that_are_one_program() {
    for id in [
        "rk4",
        "cf4",
        "splitting4",
        "compose4(splitting2)",
        "gauss4",
        "lie-midpoint",
        "orbit-energy",
    ] {
        let choice = Choice::from_id(id).unwrap();
        let declared = top(std::slice::from_ref(&choice), &Jit);
        let mut members = sweep(&declared, &choice, Save::Every(50));
        members.options = Options::new(STEP / 10.0).save(Save::Every(50));
        assert!(members.takes_lanes(), "{id}");
        members.starts[2][0] = f64::NAN;
        members.parameters[12][0] = 0.0;
        let found = all(&members);
        assert!(declared.system(&[]).unwrap().programs(&choice) > 0, "{id}");
        let expected = kernel_by_kernel(&members);
        assert_eq!(bits(&found), bits(&expected), "{id}");
        assert_eq!(failures(&found), failures(&expected), "{id}");
        let failed = found.iter().filter(|member| member.failed.is_some());
        assert_eq!(failed.count(), 2, "{id}");
    }
}
