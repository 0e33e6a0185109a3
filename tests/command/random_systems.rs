//! Twelve random systems (lab/tools/random_systems.py, seed 2018) by the command, against references
//! that share no code with the compiler.

use crate::common;

use crate::vectors::{Reference, number};

const FOLDER: &str = "tests/data/random";

/// The names of the systems, from their specs.
fn names() -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(FOLDER)
        .expect("the folder of random systems")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .filter_map(|file| file.strip_suffix(".json").map(str::to_owned))
        .filter(|name| !name.ends_with(".reference"))
        .collect();
    names.sort();
    names
}

/// The largest error of gauss6 with step 0.01 at the reference times, in all coordinates.
fn error(name: &str, step: &str) -> f64 {
    let reference = Reference::read(&format!("{FOLDER}/{name}.reference.json"));
    let times = reference.times();
    let run = common::lie(&format!(
        "run {FOLDER}/{name}.json --method gauss6 --step {step} --at {} --quiet",
        times.join(",")
    ));
    let (_, rows) = run.ok().csv();
    let states = reference.states();
    assert_eq!((rows.len(), states.len()), (times.len(), times.len()));
    let mut largest = 0.0_f64;
    for ((row, state), time) in rows.iter().zip(&states).zip(times) {
        assert_eq!(row[0], number(&time.into()));
        for (value, expected) in row[1..].iter().zip(state) {
            largest = lie_runtime::Scalar::max(largest, (value - expected).abs());
        }
    }
    let size = states
        .iter()
        .flatten()
        .fold(0.0_f64, |size, x| size.max(x.abs()));
    println!(
        "{name}: dimension {}, states up to {size:.1}, error {largest:.1e}",
        states[0].len()
    );
    assert!(size < 100.0, "{name}: the reference reaches {size}");
    largest
}

#[test]
fn gauss6_follows_the_references() {
    let names = names();
    assert_eq!(names.len(), 12);
    for name in &names {
        let error = error(name, "0.01");
        assert!(error < 1e-9, "{name}: {error:e}");
    }
    // the control: a step that is too large
    assert!(error(&names[1], "0.5") > 1e-9);
}
