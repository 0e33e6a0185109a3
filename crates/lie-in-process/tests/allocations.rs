//! A step of a family allocates nothing, by every method that it has.

use allocation_counter::measure;
use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_dynamic::{Declared, Dynamic, Engine, Tolerances};
use lie_in_process::list;
use lie_jit::Jit;
use lie_methods::method;
use lie_runtime::newton::NewtonOptions;

/// Steps that are made before any is counted: the first ones make room.
const FIRST: u32 = 4;

/// How often memory was asked for in so many steps; none where one of them failed.
fn allocations(system: &Dynamic<f64>, choice: &Choice, mu: &[f64], steps: u32) -> Option<u64> {
    let method = method(choice, Tolerances::default());
    let mut stepper = method.any_stepper(system, 0.07, &NewtonOptions::default());
    let mut mu = mu.to_vec();
    let mut go = |steps| (0..steps).all(|_| stepper.step(&mut mu).is_ok());
    if !go(FIRST) {
        return None;
    }
    let mut made = false;
    let found = measure(|| made = go(steps));
    made.then_some(found.count_total)
}

/// The specs of a folder with their names, in order.
fn specs(folder: &str) -> Vec<(String, String)> {
    let folder = format!("{}/../../{folder}", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "json"));
    paths.retain(|path| !path.to_string_lossy().ends_with("schema.json"));
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        (name.to_owned(), std::fs::read_to_string(path).unwrap())
    };
    paths.iter().map(read).collect()
}

/// The methods of specs that ask for memory in some of these steps, and how many were looked at.
fn asking(
    specs: &[(String, String)],
    engine: &dyn Engine,
    (hurry, parameters, steps): (bool, &[f64], u32),
) -> (Vec<String>, usize) {
    let (mut asking, mut looked) = (Vec::new(), 0);
    for (name, text) in specs {
        let model = compile_spec(text).expect("a spec that is right");
        let choices = list::applicable(&model);
        let system = Declared::new(plan(&model, &choices), engine).system(parameters);
        let mut system = system.unwrap();
        if hurry {
            system = system.without_patience();
        }
        let Some(mu) = system.initial_state() else {
            continue;
        };
        for choice in &choices {
            if let Some(count) = allocations(&system, choice, &mu, steps) {
                looked += 1;
                if count > 0 {
                    asking.push(format!("{name} {}: {count} in {steps}", choice.label()));
                }
            }
        }
    }
    (asking, looked)
}

#[test]
fn steps_of_families_allocate_nothing() {
    let specs = specs("tests/data/families");
    let (asking, looked) = asking(&specs, &Jit, (true, &[], 20));
    assert!(looked > 10, "{looked}");
    assert!(asking.is_empty(), "{asking:#?}");
}

/// The control: a step that asks for memory is counted.
#[test]
fn what_allocates_is_counted() {
    let counted = measure(|| drop(std::hint::black_box(vec![0.0; 3])));
    assert_eq!(counted.count_total, 1);
}
