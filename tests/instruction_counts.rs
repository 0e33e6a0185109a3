//! Generic generated code costs what plain f64 code costs: instructions counted by callgrind.
//!
//! Without valgrind this prints `skipped`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds `benches/instruction_counts` with optimisation, in a crate of its own that needs the
/// runtime alone.
fn build() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instruction_counts");
    std::fs::create_dir_all(&folder).expect("a folder");
    let source = root.join("benches/instruction_counts/main.rs");
    let runtime = root.join("lie-runtime");
    let systems = root.join("spec-systems");
    let manifest = format!(
        "[package]\nname = \"instruction_counts\"\nedition = \"2024\"\n\n\
         [[bin]]\nname = \"instruction_counts\"\npath = {source:?}\n\n\
         [dependencies]\n\
         lie-runtime = {{ path = {runtime:?}, default-features = false, features = [\"std\"] }}\n\
         spec-systems = {{ path = {systems:?} }}\n\n\
         [workspace]\n"
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("the manifest is written");
    std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))
        .expect("the lock file is copied");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args([
            "build",
            "--release",
            "--offline",
            "--quiet",
            "--manifest-path",
        ])
        .arg(folder.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(folder.join("target"))
        .env_remove("CARGO_BUILD_TARGET")
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    folder.join("target/release/instruction_counts")
}

/// All instructions of a run with so many repetitions, and what it printed.
fn run(program: &Path, form: &str, kernel: &str, repetitions: u64) -> (u64, String) {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([form, kernel, &repetitions.to_string()])
        .output()
        .expect("valgrind starts");
    let report = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{report}");
    let collected = report
        .lines()
        .find_map(|line| line.split_once("Collected :"));
    let (_, count) = collected.unwrap_or_else(|| panic!("no count in {report}"));
    let count = count.trim().parse().expect("a count");
    (count, String::from_utf8_lossy(&output.stdout).into_owned())
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

#[test]
fn generated_code_takes_as_many_instructions_as_plain_code() {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: valgrind is not installed");
        return;
    }
    let program = build();
    let compare = |kernel: &str, tolerance: f64| {
        let (generated, numbers) = per_call(&program, "generated", kernel);
        let (plain, expected) = per_call(&program, "plain", kernel);
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
    let (generic, _) = per_call(&program, "generic", "vector_field");
    assert!(generic > 1.5 * field, "{generic} against {field}");
    // 64 entries of which some vanish: filling them with zero must not cost more than computing them
    let (su3, _) = per_call(&program, "generated", "su3_linearize");
    assert!(su3 < 600.0, "{su3}");
}
