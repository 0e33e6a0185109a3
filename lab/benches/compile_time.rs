//! Compile time of generated code: all kernels and all methods of the free rigid body in N
//! dimensions, on so(N), for each scalar type.
//!
//! `cargo bench --bench compile_time` measures and writes `lab/docs/compile_time.md`. The crates are
//! built as `lie run` builds them, the runtime beforehand.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use lie_codegen::compile::{compile_spec, expand};
use lie_codegen::methods::{Choice, Retraction};
use serde_json::{Map, Value, json};

const METHODS: [Choice; 5] = [
    Choice::Midpoint,
    Choice::Gauss(2),
    Choice::Gauss(3),
    Choice::LieMidpoint(Retraction::Exp),
    Choice::LieMidpoint(Retraction::Cayley),
];

/// Calls every kernel and makes a step of every method; `SCALAR` stands for the type.
const PROGRAM: &str = r#"
#[allow(dead_code)]
mod system;

use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use std::hint::black_box;

type S = SCALAR;
type System = system::RotationsSystem<S>;
type State = <System as Poisson<S>>::State;

fn step(system: &System, method: &impl Method<S, System>, mu: &mut State) {
    let mut stepper = method.stepper(system, S::ratio(1.0, 100.0), &NewtonOptions::default());
    let _ = black_box(stepper.step(black_box(mu), &mut ()));
}

fn main() {
    let parameters = black_box(system::Rotations::<S>::default());
    let Ok(system) = parameters.system() else { return };
    let mut mu = black_box(parameters.initial_state());
    let (mut out, mut matrix) = (system.zero_state(), system.zero_jacobian());
    let mut casimirs = vec![S::zero(); system.casimir_count()];
    black_box(system.hamiltonian(&mu));
    system.gradient(black_box(&mu), black_box(&mut out));
    system.hessian(black_box(&mu), black_box(&mut matrix));
    system.poisson_matrix(black_box(&mu), black_box(&mut matrix));
    system.vector_field(black_box(&mu), black_box(&mut out));
    system.jacobian(black_box(&mu), black_box(&mut matrix));
    system.linearize(black_box(&mu), black_box(&mut out), black_box(&mut matrix));
    system.casimirs(black_box(&mu), black_box(&mut casimirs));
    system.casimir_gradient(0, black_box(&mu), black_box(&mut out));
    let xi = black_box(out);
    system.ad(black_box(&xi), black_box(&mu), black_box(&mut out));
    system.ad_star(black_box(&xi), black_box(&mu), black_box(&mut out));
    system.ad_star_matrix(black_box(&xi), black_box(&mut matrix));
    system.triple(black_box(&xi), black_box(&xi), black_box(&mu), black_box(&mut out));
    step(&system, &ImplicitMidpoint, &mut mu);
    step(&system, &Gauss4, &mut mu);
    step(&system, &Gauss6, &mut mu);
    step(&system, &LieMidpoint::exp(), &mut mu);
    step(&system, &LieMidpoint::cayley(), &mut mu);
    step(&system, &Rk4, &mut mu);
    step(&system, &Dopri5::default(), &mut mu);
}
"#;

/// The free rigid body on so(N): basis `E_ij - E_ji`, `H = sum M_ij^2/(2 (J_i + J_j))`.
fn spec(order: usize) -> String {
    let (mut basis, mut state, mut initial) = (Vec::new(), Vec::new(), Vec::new());
    let (mut matrices, mut parameters) = (Map::new(), Map::new());
    let (mut energy, mut norm) = (Vec::new(), Vec::new());
    for i in 0..order {
        parameters.insert(format!("J{i}"), json!(format!("{}/7", 7 + 3 * i)));
        for j in i + 1..order {
            let name = format!("e{i}{j}");
            let mut matrix = vec![vec![0; order]; order];
            matrix[i][j] = 1;
            matrix[j][i] = -1;
            matrices.insert(name.clone(), json!(matrix));
            energy.push(format!("m{i}{j}^2/(2*(J{i} + J{j}))"));
            norm.push(format!("m{i}{j}^2"));
            initial.push(json!(format!("{}/10", 1 + (2 * i + 3 * j) % 7)));
            basis.push(name);
            state.push(format!("m{i}{j}"));
        }
    }
    let spec: Value = json!({
        "format": 1,
        "name": "Rotations",
        "algebra": { "basis": basis, "matrices": matrices },
        "state": state,
        "parameters": parameters,
        "hamiltonian": energy.join(" + "),
        "casimirs": [format!("norm = {}", norm.join(" + "))],
        "initial": initial,
    });
    spec.to_string()
}

/// Wall and processor time.
#[derive(Clone, Copy)]
struct Cost {
    wall: Duration,
    /// Of children that have ended, in seconds; none where the system does not tell.
    processor: Option<f64>,
}

/// User and system time of all children that have ended (Linux, 100 ticks per second).
fn children() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    let ticks = fields
        .split_whitespace()
        .skip(13)
        .take(2)
        .map(str::parse::<f64>);
    Some(ticks.sum::<Result<f64, _>>().ok()? / 100.0)
}

/// Builds a crate; the target folder is shared so that the runtime is built once.
fn build(folder: &Path, name: &str, system: &str, scalar: &str) -> Cost {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let package = folder.join(name);
    let write = |file: &str, text: &str| {
        std::fs::write(package.join(file), text).expect("the file is written")
    };
    std::fs::create_dir_all(package.join("src")).expect("a folder");
    write("src/system.rs", system);
    write("src/main.rs", &PROGRAM.replace("SCALAR", scalar));
    let runtime = root.join("lie-runtime");
    write(
        "Cargo.toml",
        &format!(
            "[package]\nname = \"{name}\"\nedition = \"2024\"\n\n[dependencies]\n\
         lie-runtime = {{ path = {runtime:?}, default-features = false, features = [\"std\", \"lanes\"] }}\n\n\
             [profile.release]\ncodegen-units = 1\npanic = \"abort\"\n\n\
         [workspace]\n"
        ),
    );
    std::fs::copy(root.join("Cargo.lock"), package.join("Cargo.lock"))
        .expect("the lock file is copied");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let (start, before) = (Instant::now(), children());
    let output = Command::new(cargo)
        .args([
            "build",
            "--release",
            "--offline",
            "--quiet",
            "--manifest-path",
        ])
        .arg(package.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(folder.join("target"))
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let processor = children().zip(before).map(|(after, before)| after - before);
    Cost {
        wall: start.elapsed(),
        processor,
    }
}

fn table() -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("compile_time");
    let _ = std::fs::remove_dir_all(&folder);
    let mut table = String::from(
        "| system | n | lines | generation | f64 | f32 | F64x8 |\n|---|---|---|---|---|---|---|\n",
    );
    for order in 3..=7 {
        let dimension = order * (order - 1) / 2;
        let start = Instant::now();
        let model = compile_spec(&spec(order)).expect("the spec is valid");
        let system = expand(&model, &METHODS);
        let generation = start.elapsed().as_secs_f64();
        if order == 3 {
            build(&folder, "warm", &system, "f64");
        }
        let lines = system.lines().count();
        let _ = write!(
            table,
            "| so({order}) | {dimension} | {lines} | {generation:.2} s |"
        );
        for scalar in ["f64", "f32", "F64x8"] {
            let name = format!("n{dimension}_{}", scalar.to_lowercase());
            let cost = build(&folder, &name, &system, scalar);
            let wall = cost.wall.as_secs_f64();
            let _ = match cost.processor {
                Some(processor) => write!(table, " {wall:.1} s ({processor:.1} s) |"),
                None => write!(table, " {wall:.1} s |"),
            };
        }
        table.push('\n');
        println!("{}", table.lines().last().unwrap_or_default());
    }
    table
}

/// The output of a command, on one line.
fn tell(command: &str, argument: &str) -> String {
    let output = Command::new(command).arg(argument).output();
    output.map_or_else(
        |_| String::new(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    )
}

fn main() {
    let table = table();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let text = format!(
        "# Compile time\n\n\
         `cargo bench --bench compile_time`, {}, {}, {cores} cores.\n\n\
         Free rigid body in N dimensions on so(N), n = N (N - 1)/2: every kernel and a step of every method\n\
         (midpoint, gauss4, gauss6, lie-midpoint with exp and cayley fused; rk4, dopri5), compiled\n\
         as `lie run` does (opt-level 3, one codegen unit) after the runtime. Wall time, and in parentheses processor time of all\n\
         threads together. Generation is reading, checking, deriving and printing the spec.\n\n{table}",
        tell("date", "+%Y-%m-%d"),
        tell("rustc", "--version"),
    );
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("lab/docs/compile_time.md");
    std::fs::write(&path, text).expect("lab/docs/compile_time.md is written");
    println!("written to {}", path.display());
}
