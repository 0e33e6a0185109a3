//! Generic generated code costs what plain f64 code costs, and steps of methods what they did: instructions counted by
//! callgrind.
//!
//! Without valgrind this prints `skipped`. The counts of steps are in `tests/data/instructions_per_step.txt`, with the
//! compiler that they hold for: another one is not compared with them. `LIE_UPDATE_GOLDEN=1` writes them.

mod common;

use common::callgrind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// By which part the instructions of a step may change unnoticed.
const TOLERANCE: f64 = 0.03;

/// All instructions of a run with so many repetitions, and what it printed.
fn run(program: &Path, form: &str, kernel: &str, repetitions: u64) -> (u64, String) {
    callgrind::run(program, &[form, kernel, &repetitions.to_string()])
}

/// Instructions of one call, with its loop; and the numbers computed.
fn per_call(program: &Path, form: &str, kernel: &str) -> (f64, String) {
    const CALLS: u64 = 1000;
    let (few, numbers) = run(program, form, kernel, CALLS);
    let (many, _) = run(program, form, kernel, 2 * CALLS);
    let count = many.abs_diff(few) as f64 / CALLS as f64;
    println!("{form} {kernel}: {count} instructions per call");
    (count, numbers)
}

/// The program, built once; none without valgrind.
fn program() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    let program = PROGRAM.get_or_init(|| {
        let systems = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/spec-systems");
        let needs = format!("spec-systems = {{ path = {systems:?} }}");
        callgrind::build("instruction_counts", &["std"], &needs)
    });
    program.as_deref()
}

/// What counts depend on besides the code.
fn compiler() -> String {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("--version").output();
    let output = output.expect("the compiler says its version");
    let version = String::from_utf8_lossy(&output.stdout);
    format!("{}, {}", version.trim(), std::env::consts::ARCH)
}

/// Instructions of a step in the steady state.
fn per_step(program: &Path, system: &str, method: &str) -> f64 {
    const FEW: u64 = 20;
    const MANY: u64 = 120;
    let counts = [FEW, MANY].map(|steps| run(program, system, method, steps).0);
    counts[1].abs_diff(counts[0]) as f64 / (MANY - FEW) as f64
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn steps_take_as_many_instructions_as_they_did() {
    let Some(program) = program() else { return };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/instructions_per_step.txt");
    let pinned = std::fs::read_to_string(&path).expect("the pinned counts");
    let (header, rows) = pinned.split_once('\n').expect("a header");
    let update = std::env::var_os("LIE_UPDATE_GOLDEN").is_some();
    let compiler = compiler();
    if header != compiler && !update {
        println!("skipped: counted with {header}, this is {compiler}");
        return;
    }
    let mut now = format!("{compiler}\n");
    let mut changed = Vec::new();
    for row in rows.lines() {
        let fields: Vec<&str> = row.split_whitespace().collect();
        let [system, method, before] = fields[..] else {
            panic!("not a system, a method and a count: {row}");
        };
        let before: f64 = before.parse().expect("a count");
        let count = per_step(program, system, method);
        now.push_str(&format!("{system} {method} {count:.0}\n"));
        if (count - before).abs() > TOLERANCE * before {
            changed.push(format!(
                "{system} {method}: {before} before, {count:.0} now"
            ));
        }
    }
    if update {
        std::fs::write(&path, now).expect("the counts are written");
        return;
    }
    assert!(changed.is_empty(), "{}", changed.join("\n"));
    // the control: a method does not pass for another
    let [small, large] =
        ["midpoint", "gauss6"].map(|method| per_step(program, "se3_heavy_top", method));
    assert!((small - large).abs() > TOLERANCE * large);
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn generated_code_takes_as_many_instructions_as_plain_code() {
    let Some(program) = program() else { return };
    let compare = |kernel: &str, tolerance: f64| {
        let (generated, numbers) = per_call(program, "generated", kernel);
        let (plain, expected) = per_call(program, "plain", kernel);
        assert_eq!(numbers, expected, "{kernel} computes the same numbers");
        assert!(
            (generated - plain).abs() <= tolerance,
            "{kernel}: if the generated constants were reordered, so must be those of plain.rs"
        );
        generated
    };
    let field = compare("vector_field", 0.0);
    // more values than registers: one of them may be kept on the stack in one form and not the other
    compare("linearize", 2.0);
    // the control: Poisson matrix times gradient
    let (generic, _) = per_call(program, "generic", "vector_field");
    assert!(generic > 1.5 * field, "{generic} against {field}");
    // 64 entries of which some vanish: filling them with zero must not cost more than computing them
    let (su3, _) = per_call(program, "generated", "su3_linearize");
    assert!(su3 < 600.0, "{su3}");
}
