//! Builds a program of `benches` with optimisation, and counts its instructions.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The program `lab/benches/NAME/main.rs`, in a crate of its own that needs the runtime with these features and what else is said;
/// none, which it says, without valgrind.
pub fn build(name: &str, features: &[&str], needs: &str) -> Option<PathBuf> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: valgrind is not installed");
        return None;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    let source = root.join("lab/benches").join(name).join("main.rs");
    let runtime = root.join("lie-runtime");
    let manifest = format!(
        "[package]\nname = \"{name}\"\nedition = \"2024\"\n\n\
         [[bin]]\nname = \"{name}\"\npath = {source:?}\n\n\
         [dependencies]\n\
         lie-runtime = {{ path = {runtime:?}, default-features = false, features = {features:?} }}\n\
         {needs}\n\n\
         [profile.release]\ncodegen-units = 1\n\n[workspace]\n"
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
    Some(folder.join("target/release").join(name))
}

/// Copies of long slices in loops: where the C library has one instruction for a whole copy, callgrind counts it once a byte.
const COPIES: &str = "glibc.cpu.x86_rep_movsb_threshold=0x7fffffffffff:glibc.cpu.x86_rep_stosb_threshold=0x7fffffffffff";

/// All instructions of a run, and what it printed.
pub fn run(program: &Path, arguments: &[&str]) -> (u64, String) {
    let output = Command::new("valgrind")
        .env("GLIBC_TUNABLES", COPIES)
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(arguments)
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
