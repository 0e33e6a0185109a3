//! The generated code of every spec is the committed one.
//!
//! `LIE_UPDATE_GOLDEN=1 cargo test --test golden` writes `tests/golden/` anew. This file does not
//! compile what it compares, so that it can repair it; `vectors`, `fused_equals_generic`,
//! `orders_and_symmetry` and `lanes` compile and run the golden files.

use lie_codegen::golden::Golden;
use std::path::PathBuf;

/// Every family of methods with fused code; of `lie-midpoint` both retractions where they apply.
const METHODS: [&str; 17] = [
    "midpoint",
    "gauss4",
    "gauss6",
    "lie-midpoint",
    "splitting2",
    "gonzalez",
    "mean-value",
    "itoh-abe",
    "orbit-energy",
    "cohen-hairer2",
    "cohen-hairer4",
    "cohen-hairer6",
    "collective2",
    "collective4",
    "collective6",
    "spherical-midpoint",
    "moser-veselov",
];

/// Methods whose code is much: for some systems only, in a folder of their own.
const GENERATING: [&str; 3] = ["generating4", "generating6", "generating-second-kind2"];
const GENERATED: [&str; 7] = [
    "e2_pendulum",
    "heisenberg_h3",
    "se3_heavy_top",
    "so3_free_rigid_body",
    "so3_nonpolynomial",
    "so4_manakov",
    "toda3_solvable",
];

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
        golden.spec(path, &METHODS);
    }
    golden
}

#[test]
fn generated_code_is_the_committed_one() {
    golden().check().unwrap_or_else(|stale| panic!("{stale}"));
}

#[test]
fn generating_functions_are_the_committed_ones() {
    let mut golden = Golden::new("tests/golden/generating");
    for name in GENERATED {
        golden.spec(format!("specs/{name}.json"), &GENERATING);
    }
    golden.check().unwrap_or_else(|stale| panic!("{stale}"));
}

/// The tests that run the golden files name each of them once.
#[test]
fn every_golden_file_is_compiled_and_run() {
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
            systems.contains(&format!("../golden/{name}.rs")),
            "{name} is not compiled"
        );
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
