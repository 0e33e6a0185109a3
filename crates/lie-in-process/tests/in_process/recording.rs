//! Steps and equations that are one program have the bits of those kernel by kernel.

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_dynamic::{Declared, Dynamic, Interpreted, PATIENCE, Tolerances};
use lie_in_process::list;
use lie_jit::Jit;
use lie_methods::method;
use lie_runtime::diagnostics::AnyStepper;
use lie_runtime::newton::NewtonOptions;
use std::num::NonZero;
use std::sync::Mutex;
use std::thread;

/// A declaration of the project, run by machine code and by the interpreter, which makes all steps kernel by kernel.
struct Both {
    choices: Vec<Choice>,
    compiled: Dynamic<f64>,
    interpreted: Dynamic<f64>,
}

impl Both {
    fn new(name: &str) -> Self {
        let path = format!("{}/../../specs/{name}", env!("CARGO_MANIFEST_DIR"));
        let model = compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap();
        let choices = list::applicable(&model);
        let plan = plan(&model, &choices);
        Self {
            choices,
            compiled: Declared::new(plan.clone(), &Jit).system(&[]).unwrap(),
            interpreted: Declared::new(plan, &Interpreted).system(&[]).unwrap(),
        }
    }
}

fn stepper<'a>(
    system: &'a Dynamic<f64>,
    choice: &Choice,
    h: f64,
) -> Box<dyn AnyStepper<f64, Vec<f64>> + 'a> {
    let method = method(choice, Tolerances::default());
    method.any_stepper(system, h, &NewtonOptions::default())
}

/// A state after some steps, and how the last of them ended.
type End = (Vec<u64>, String);

/// The states after these numbers of steps, which grow, of one run.
fn ends(system: &Dynamic<f64>, choice: &Choice, h: f64, mu: &[f64], after: &[u32]) -> Vec<End> {
    let mut stepper = stepper(system, choice, h);
    let (mut mu, mut made, mut last) = (mu.to_vec(), 0, String::new());
    let end = |&steps: &u32| {
        while made < steps {
            last = format!("{:?}", stepper.step(&mut mu));
            made += 1;
        }
        (mu.iter().map(|x| x.to_bits()).collect(), last.clone())
    };
    after.iter().map(end).collect()
}

/// The state after so many steps.
fn end(system: &Dynamic<f64>, choice: &Choice, h: f64, mu: &[f64], steps: u32) -> End {
    ends(system, choice, h, mu, &[steps]).remove(0)
}

/// What was found of the methods on some declarations.
#[derive(Default)]
struct Tally {
    /// Programs of steps, and methods with a solver that have traces.
    steps: usize,
    traced: usize,
    /// The methods without either: those without a solver, and those with one.
    apart: Vec<String>,
    untraced: Vec<String>,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.steps += other.steps;
        self.traced += other.traced;
        self.apart.extend(other.apart);
        self.untraced.extend(other.untraced);
    }

    /// Takes the methods on one declaration.
    fn take(&mut self, name: &str) {
        let both = Both::new(name);
        let hurried = both.compiled.clone().without_patience();
        let Some(mu) = hurried.initial_state() else {
            return;
        };
        for choice in &both.choices {
            let label = format!("{name} {}", choice.label());
            let claims = method(choice, Tolerances::default()).claims();
            let before = hurried.steps_by_traces(choice);
            for h in [0.07, -0.07] {
                let found = end(&hurried, choice, h, &mu, 60);
                let expected = end(&both.interpreted, choice, h, &mu, 60);
                assert_eq!(found, expected, "{label}, {h}");
                // the control: another step size
                let other = end(&hurried, choice, h * (1.0 + 1e-9), &mu, 60);
                assert!(found.0 != other.0 || choice.id() == "exact", "{label}");
            }
            let is_traced = hurried.steps_by_traces(choice) > before;
            match (claims.explicit, hurried.programs(choice)) {
                (true, 0) if claims.own_steps || choice.id() == "exact" => {}
                (true, 0) => self.apart.push(label),
                (true, count) => self.steps += count,
                (false, _) if is_traced => self.traced += 1,
                (false, _) if claims.fixed_point || claims.own_steps => {}
                (false, _) => self.untraced.push(label),
            }
        }
    }
}

/// Systems of each kind: on an algebra, with the time, canonical, by a Lagrangian.
#[test]
fn on_some_specs() {
    let names = [
        "so3_free_rigid_body",
        "so3_gravity_gradient",
        "canonical_pendulum",
        "so3_gyrostat_lagrangian",
    ];
    let names = names.map(|name| format!("{name}.json"));
    let found = on_specs(names.to_vec());
    assert!(found.apart.is_empty(), "{:#?}", found.apart);
    assert!(
        found.steps > 30 && found.traced > 80,
        "{} {}",
        found.steps,
        found.traced
    );
}

/// What is found on these specs.
fn on_specs(names: Vec<String>) -> Tally {
    let left = Mutex::new(names);
    let work = || {
        let mut tally = Tally::default();
        loop {
            // a statement of its own, so that the others do not wait
            let next = left.lock().unwrap().pop();
            match next {
                Some(name) => tally.take(&name),
                None => return tally,
            }
        }
    };
    let mut all = Tally::default();
    thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, NonZero::get);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            all.add(worker.join().unwrap());
        }
    });
    all
}

#[test]
#[ignore = "half a minute: .ci/nightly runs it"]
fn on_every_spec() {
    let folder = format!("{}/../../specs", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let names = names.filter(|name| name.ends_with(".json") && !name.contains("schema"));
    let Tally {
        steps,
        traced,
        mut apart,
        mut untraced,
    } = on_specs(names.collect());
    // the exponential of su(3) is a series that ends by the size of its terms; the quartic Lagrangian's velocity is iterated for
    apart.retain(|label| {
        let exponential = label.starts_with("su3_quadratic") && !label.ends_with("rk4");
        !exponential && !label.starts_with("so3_quartic_lagrangian")
    });
    assert!(apart.is_empty(), "{apart:#?}");
    untraced.retain(|label| !label.starts_with("so3_quartic_lagrangian"));
    println!("without traces: {untraced:#?}");
    // steps that are one program, methods with a solver that have traces, and that have none, nearly all because their steps are too
    // long; docs/back_ends.md quotes them
    assert_eq!((steps, traced, untraced.len()), (428, 884, 45));
}

/// States that do not follow, steps of another size, a step that fails and others behind it: answers that differ from those of the traces,
/// and what programs of stages side by side remember.
#[test]
fn programs_are_not_run_where_a_step_is_another_one() {
    for id in [
        "midpoint",
        "gauss4",
        "lie-midpoint",
        "generating4",
        "orbit-energy",
        "gauss8",
        "gauss16",
        "collective16",
    ] {
        let choice = Choice::from_id(id).unwrap();
        let both = Both::new("se3_heavy_top.json");
        let mu = both.compiled.initial_state().unwrap();
        // their programs are no traces, and take steps of another size
        let in_stages = ["gauss8", "gauss16", "collective16"].contains(&id);
        let run = |system: &Dynamic<f64>| {
            let mut stepper = stepper(system, &choice, 0.05);
            let (mut now, mut all) = (mu.clone(), Vec::new());
            for step in 0..400 {
                match step {
                    90 if in_stages => assert!(stepper.set_step(0.04)),
                    100 if in_stages => assert!(stepper.set_step(0.05)),
                    150 => now = mu.iter().map(|x| 0.5 - x).collect(),
                    200 => now[0] *= 1.0 + 1e-15,
                    250 => now = vec![f64::NAN; now.len()],
                    251 => now = mu.clone(),
                    300 => now = mu.iter().map(|x| 1e3 * x).collect(),
                    310 => now = vec![0.0; now.len()],
                    320 => now = mu.clone(),
                    _ => {}
                }
                let report = format!("{:?}", stepper.step(&mut now));
                let bits: Vec<u64> = now.iter().map(|x| x.to_bits()).collect();
                all.push((bits, report));
            }
            all
        };
        let (found, expected) = (run(&both.compiled), run(&both.interpreted));
        assert_eq!(both.compiled.programs(&choice) > 0, !in_stages, "{id}");
        let failed = |(_, report): &&(Vec<u64>, String)| report.starts_with("Err");
        assert!(expected.iter().filter(failed).count() > 0, "{id}");
        for (step, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "{id}, step {step}");
        }
    }
}

/// A declaration that lives long keeps the traces of some sets of options alone, and the others make the same steps.
#[test]
fn options_of_the_solver_do_not_pile_up() {
    let choice = Choice::from_id("midpoint").unwrap();
    let both = Both::new("so3_free_rigid_body.json");
    let mu = both.compiled.initial_state().unwrap();
    let run = |system: &Dynamic<f64>, tolerance: f64| {
        let newton = NewtonOptions {
            tolerance,
            ..NewtonOptions::default()
        };
        let method = method(&choice, Tolerances::default());
        let (mut stepper, mut mu) = (method.any_stepper(system, 0.05, &newton), mu.clone());
        for _ in 0..60 {
            stepper.step(&mut mu).unwrap();
        }
        mu
    };
    let mut counts = Vec::new();
    for set in 0..24 {
        let tolerance = 1.0 + f64::from(set);
        assert_eq!(
            run(&both.compiled, tolerance),
            run(&both.interpreted, tolerance)
        );
        counts.push(both.compiled.programs(&choice));
    }
    assert!(
        counts[15] > counts[7] && counts[7] > counts[0] && counts[0] > 0,
        "{counts:?}"
    );
    assert_eq!(counts[15], counts[23], "{counts:?}");
}

fn explicit() -> Vec<Choice> {
    ["rk4", "rkmk4", "cf4", "splitting2", "splitting6"]
        .map(|id| Choice::from_id(id).unwrap())
        .to_vec()
}

/// Traces are taken within a run, and others where the steps change.
#[test]
fn traces_within_a_run() {
    for id in [
        "gauss4",
        "gauss6",
        "lie-midpoint",
        "orbit-energy",
        "compose4(midpoint)",
    ] {
        let choice = Choice::from_id(id).unwrap();
        let both = Both::new("se3_heavy_top.json");
        let mu = both.compiled.initial_state().unwrap();
        let found = end(&both.compiled, &choice, 0.05, &mu, 3000);
        let traces = both.compiled.programs(&choice);
        assert!((1..=24).contains(&traces), "{id}: {traces}");
        let steps = both.compiled.steps_by_traces(&choice);
        assert!(steps > 1000, "{id}: {steps} of 3,000 by traces");
        assert_eq!(
            found,
            end(&both.interpreted, &choice, 0.05, &mu, 3000),
            "{id}"
        );
    }
}

#[test]
fn within_a_run() {
    let both = Both::new("so3_free_rigid_body.json");
    let mu = both.compiled.initial_state().unwrap();
    for choice in explicit() {
        let after = [PATIENCE - 1, PATIENCE, PATIENCE + 1, PATIENCE + 100];
        let expected = ends(&both.interpreted, &choice, 0.01, &mu, &after);
        for (steps, expected) in after.into_iter().zip(expected) {
            // a declaration of its own, which knows no programs yet
            let both = Both::new("so3_free_rigid_body.json");
            let found = end(&both.compiled, &choice, 0.01, &mu, steps);
            assert_eq!(found, expected, "{} {steps}", choice.label());
        }
    }
}

#[test]
fn a_step_that_is_not_finite_is_refused_and_leaves_the_state() {
    let both = Both::new("se3_heavy_top.json");
    for choice in explicit() {
        let hurried = both.compiled.clone().without_patience();
        for size in [1e200, f64::MAX, f64::INFINITY, f64::NAN] {
            let mu: Vec<f64> = (1..7).map(|k| size * f64::from(k)).collect();
            let found = end(&hurried, &choice, 0.1, &mu, 1);
            let expected = end(&both.interpreted, &choice, 0.1, &mu, 1);
            let refused = found.1.contains("NotFinite");
            assert!(refused || size.is_finite(), "{} {found:?}", choice.label());
            assert_eq!(found, expected, "{}", choice.label());
        }
    }
}

#[test]
fn the_motion_on_the_group_is_shown_all_the_same() {
    use lie_runtime::diagnostics::Motions;
    let both = Both::new("se3_heavy_top.json");
    let mu = both.compiled.initial_state().unwrap();
    for choice in explicit() {
        let hurried = both.compiled.clone().without_patience();
        let shown = |system| {
            let (mut mu, mut motions) = (mu.clone(), Motions::new());
            let mut stepper = stepper(system, &choice, 0.1);
            stepper.step(&mut mu).unwrap();
            stepper.step_with_motions(&mut mu, &mut motions).unwrap();
            format!("{mu:?} {motions:?}")
        };
        let found = shown(&hurried);
        assert!(found.len() > 100, "{found}");
        assert_eq!(found, shown(&both.interpreted), "{}", choice.label());
    }
}
