//! What is generated for every spec is the committed plan; for one of them the committed code, and for two others what
//! their code has beside that, with a digest of all of it.
//!
//! `LIE_UPDATE_GOLDEN=1 cargo test --test generated` writes `tests/golden/` anew. A plan has the formula, the operation
//! count and a digest of each kernel; `lie expand` prints the code of any spec. The crate `spec-systems` compiles the
//! code of all of them, and the other tests run it.

use lie_codegen::compile::{compile_spec, expand, with_options};
use lie_codegen::golden::Golden;
use lie_codegen::methods::Choice;
use spec_systems::methods::{GENERATED, GENERATING, METHODS};
use std::path::PathBuf;

/// The system whose code is kept in full: a Lie algebra with everything.
const IN_FULL: (&str, &str) = ("so3_free_rigid_body", "FreeRigidBody");

/// Systems of which the rest is kept: a semidirect product, a bracket of no algebra.
const BESIDE: [(&str, &str); 2] = [
    ("se3_heavy_top", "HeavyTop"),
    ("lotka_volterra", "LotkaVolterra"),
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

/// The code of a system with fused code for these methods.
fn code(name: &str, methods: &[&str]) -> String {
    let text = std::fs::read_to_string(format!("specs/{name}.json")).expect("the spec");
    let model = compile_spec(&text).expect("a valid spec");
    let choices = methods.iter().map(|id| Choice::from_id(id).expect("an id"));
    let choices = with_options(&model, &choices.collect::<Vec<_>>());
    expand(&model, &choices)
}

/// The hash function of Fowler, Noll and Vo, 64 bits (RFC 9923).
fn digest(text: &str) -> u64 {
    let begin = 0xcbf2_9ce4_8422_2325;
    text.bytes().fold(begin, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// One method of each kind: the others have code of the same forms.
fn of_each_kind() -> Vec<&'static str> {
    let again = [
        "gauss6",
        "cohen-hairer2",
        "cohen-hairer6",
        "collective2",
        "collective6",
    ];
    METHODS
        .into_iter()
        .filter(|id| !again.contains(id))
        .collect()
}

fn golden() -> Golden {
    let mut golden = Golden::new("tests/golden");
    for path in specs() {
        golden.plan(path, &METHODS);
    }
    let full = code(IN_FULL.0, &of_each_kind());
    let mut digests = format!(
        "{:016x} {}\n",
        digest(&code(IN_FULL.0, &METHODS)),
        IN_FULL.0
    );
    for (name, system) in BESIDE {
        let code = code(name, &METHODS);
        digests += &format!("{:016x} {name}\n", digest(&code));
        let rest = crate::items::beside(&code, system, &full, IN_FULL.1);
        let head = format!(
            "// What the code of `{system}` has beside that of `{}`.\n",
            IN_FULL.1
        );
        golden.text(&format!("{name}.rs"), head + &rest);
    }
    golden.text(&format!("{}.rs", IN_FULL.0), full);
    golden.text("code.digests", digests);
    golden
}

#[test]
fn plans_and_code_are_the_committed_ones_each_time() {
    let expanded = golden();
    expanded.check().unwrap();
    assert_eq!(format!("{expanded:?}"), format!("{:?}", golden()));
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
