//! What is generated for every spec is the committed plan, and for three of them the committed code.
//!
//! `LIE_UPDATE_GOLDEN=1 cargo test --test golden` writes `tests/golden/` anew. A plan has the formula, the operation
//! count and a digest of each kernel; `lie expand` prints the code of any spec. The crate `spec-systems` compiles the
//! code of all of them, and the other tests run it.

use lie_codegen::golden::Golden;
use spec_systems::methods::{GENERATED, GENERATING, METHODS};
use std::path::PathBuf;

/// Systems whose code is kept in full: a Lie algebra with everything, a semidirect product, a bracket of no algebra.
const IN_FULL: [&str; 3] = ["so3_free_rigid_body", "se3_heavy_top", "lotka_volterra"];

/// The systems of `specs/`, without their schema.
fn specs() -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir("specs")
        .expect("the folder of specs")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "json")
        })
        .filter(|path| !path.to_string_lossy().ends_with(".schema.json"))
        .collect();
    paths.sort();
    paths
}

fn golden() -> Golden {
    let mut golden = Golden::new("tests/golden");
    for path in specs() {
        golden.plan(path, &METHODS);
    }
    for name in IN_FULL {
        golden.spec(format!("specs/{name}.json"), &METHODS);
    }
    golden
}

#[test]
fn plans_and_code_are_the_committed_ones() {
    golden().check().unwrap();
}

#[test]
fn generating_functions_are_the_committed_ones() {
    let mut golden = Golden::new("tests/golden/generating");
    for name in GENERATED {
        golden.plan(format!("specs/{name}.json"), &GENERATING);
    }
    golden.check().unwrap();
}

/// The tests that go through all systems name each of them once.
#[test]
fn every_spec_is_run() {
    let systems = std::fs::read_to_string("tests/common/systems.rs").expect("the list of systems");
    let specs = specs();
    assert!(specs.len() >= 10, "{specs:?}");
    for path in specs {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        assert!(
            systems.contains(&format!("$check!({name}, ")),
            "{name} is not run"
        );
    }
}

#[test]
fn two_expansions_are_equal() {
    assert_eq!(format!("{:?}", golden()), format!("{:?}", golden()));
}
