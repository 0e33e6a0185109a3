//! What each method costs: lines and compile time of its generated code, and instructions per step
//! of the fused form against the generic one.
//!
//! `cargo bench --bench method_costs` measures and writes `lab/docs/method_costs.md`. Instructions are
//! counted by callgrind as the difference of two runs, so that the start-up drops out; without
//! valgrind that column stays empty. Takes some minutes; with names of specs it measures those and
//! writes nothing.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use lie_codegen::compile::{compile_spec, expand, with_options};
use lie_codegen::methods::{CATALOGUE, Choice};
use lie_codegen::structure::Structure;

/// Systems by what they are called on the page.
const SYSTEMS: [(&str, &str); 4] = [
    ("so(3), free rigid body", "so3_free_rigid_body"),
    ("se(3), heavy top", "se3_heavy_top"),
    ("so(4), Manakov top", "so4_manakov"),
    ("su(3)", "su3_quadratic"),
];

/// The end of the page: where the fused form does not pay.
const OPEN: &str = r"
## Open

A ratio of 1 or more means that the fused form does not pay. Where that is so, or nearly so:

- Of `gauss4` and `gauss6` only the elimination in a fixed order is generated; residual and Jacobian are those of the generic
  equation on the generated kernels. Up to 300 multiplications are written out, more run over an index list. The list leaves
  out the zeros, but a multiplication costs more by it: `gauss4` on se(3) and so(4) has 588 of 716 multiplications left and gains
  nothing, `gauss6` on su(3) has 4356 of 5176 left and takes more instructions, as does `gauss4`. `gauss6` on se(3) and so(4), with
  1802 of 2262 left, gains; where the line between them runs is open.
- Of `lie-midpoint` and `generating2` with the exponential, and of `orbit-energy --gradient mean-value`, only the elimination is generated
  too, and on these systems it is written out: at most 17, 106 and 232 multiplications for 3, 6 and 8 coordinates. Most of a step is the series of
  the exponential and its derivative, the same code in both forms. That the fused form of `lie-midpoint` takes more
  instructions than the generic one on su(3) is not explained by this.
- Compile times are differences of two single builds: rows of the same code (`midpoint` and the methods along discrete gradients,
  for a quadratic H) differ by some tenths of a second. A difference below zero is shown as 0.0.
";

/// Makes steps of a method; `NAME` and `METHODS` are replaced.
const PROGRAM: &str = r#"
#[allow(dead_code)]
mod system;

use lie_runtime::methods::{Method, Stepper, Tolerances};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

type System = system::NAMESystem;

fn run(system: &System, method: impl Method<f64, System>, steps: u32) {
    let mut mu = system::NAME::new().initial_state();
    let mut stepper = method.stepper(system, 0.05, &NewtonOptions::default());
    let mut iterations = 0;
    for _ in 0..steps {
        match stepper.step(&mut mu, &mut ()) {
            Ok(report) => iterations += report.iterations,
            Err(failure) => panic!("{failure}"),
        }
    }
    println!("{iterations} {:?}", mu.as_slice());
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let steps: u32 = arguments[2].parse().expect("a number");
    let system = system::NAME::new().system().expect("valid");
    #[allow(unused_variables)]
    let tolerances = &Tolerances::default();
    match arguments[1].as_str() {
        METHODS
        _ => panic!("no such method"),
    }
}
"#;

/// User and system time of all children that have ended, in seconds (Linux, 100 ticks per second).
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

/// Builds a crate; the target folder is shared so that the runtime is built once. Returns the
/// program and the seconds of processor time, of wall time where the system does not tell.
fn build(
    folder: &Path,
    name: &str,
    model: &Structure,
    fused: &[Choice],
    run: &[Choice],
) -> (PathBuf, f64) {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let package = folder.join(name);
    let write = |file: &str, text: &str| {
        std::fs::write(package.join(file), text).expect("the file is written")
    };
    std::fs::create_dir_all(package.join("src")).expect("a folder");
    write("src/system.rs", &expand(model, fused));
    let mut arms = String::new();
    for choice in run {
        let _ = writeln!(
            arms,
            "{:?} => run(&system, {}, steps),",
            choice.label(),
            choice.constructor()
        );
    }
    let main = PROGRAM
        .replace("NAME", &model.name)
        .replace("METHODS", &arms);
    write("src/main.rs", &main);
    let runtime = root.join("lie-runtime");
    write(
        "Cargo.toml",
        &format!(
            "[package]\nname = \"{name}\"\nedition = \"2024\"\n\n[dependencies]\n\
             lie-runtime = {{ path = {runtime:?}, default-features = false, features = [\"std\"] }}\n\n\
             [profile.release]\ncodegen-units = 1\npanic = \"abort\"\n\n[workspace]\n"
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
        .env_remove("CARGO_BUILD_TARGET")
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let processor = children().zip(before).map(|(after, before)| after - before);
    let seconds = processor.unwrap_or_else(|| start.elapsed().as_secs_f64());
    (folder.join("target/release").join(name), seconds)
}

/// Instructions and iterations of a run; none without valgrind, or where the run fails.
fn count(program: &Path, label: &str, steps: u32) -> Option<(u64, u64)> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([label, &steps.to_string()])
        .output()
        .ok()?;
    if !output.status.success() {
        return None;
    }
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = report.lines().find(|line| line.contains("Collected"))?;
    let instructions = line.split_whitespace().last()?.parse().ok()?;
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let iterations = printed.split_whitespace().next()?.parse().ok()?;
    Some((instructions, iterations))
}

/// Instructions and iterations per step.
fn per_step(program: &Path, label: &str) -> Option<(f64, f64)> {
    const FEW: u32 = 10;
    const MANY: u32 = 60;
    let (few, many) = (count(program, label, FEW)?, count(program, label, MANY)?);
    let steps = f64::from(MANY - FEW);
    Some((
        (many.0 - few.0) as f64 / steps,
        (many.1 - few.1) as f64 / steps,
    ))
}

/// Every built method that applies to a system, with its options.
fn choices(model: &Structure) -> Vec<Choice> {
    let plain: Vec<Choice> = CATALOGUE
        .iter()
        .filter_map(|method| Choice::from_id(method.id).ok())
        .collect();
    with_options(model, &plain)
}

fn section(folder: &Path, title: &str, name: &str) -> String {
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join(format!("specs/{name}.json"));
    let text = std::fs::read_to_string(path).expect("the spec");
    let model = compile_spec(&text).expect("the spec is valid");
    let choices = choices(&model);
    let bare = expand(&model, &[]).lines().count();
    let (fused, _) = build(folder, &format!("{name}_fused"), &model, &choices, &choices);
    let (generic, _) = build(folder, &format!("{name}_generic"), &model, &[], &choices);
    let (_, empty) = build(folder, &format!("{name}_empty"), &model, &[], &[]);
    let mut table = format!(
        "\n## {title}\n\n`specs/{name}.json`, n = {}; {bare} lines and {empty:.1} s without any fused method.\n\n\
         | method | lines | compile time | fused | generic | ratio | iterations |\n|---|---|---|---|---|---|---|\n",
        model.dimension()
    );
    let mut builds = 0;
    for choice in &choices {
        let lines = expand(&model, std::slice::from_ref(choice)).lines().count() - bare;
        let mut seconds = String::new();
        if lines > 0 && Choice::from_id(&choice.id()).as_ref() == Ok(choice) {
            builds += 1;
            let name = format!("{name}_{builds}");
            let one = std::slice::from_ref(choice);
            let (_, whole) = build(folder, &name, &model, one, one);
            seconds = format!("{:.1} s", (whole - empty).max(0.0));
        }
        let label = choice.label();
        let _ = write!(table, "| {label} | {lines} | {seconds} |");
        match (per_step(&fused, &label), per_step(&generic, &label)) {
            (Some((ours, iterations)), Some((theirs, _))) if lines > 0 => {
                let ratio = ours / theirs;
                let _ = write!(
                    table,
                    " {ours:.0} | {theirs:.0} | {ratio:.2} | {iterations:.1} |"
                );
            }
            (Some((ours, iterations)), _) => {
                let _ = write!(table, " | {ours:.0} | | {iterations:.1} |");
            }
            (None, _) => table.push_str(" | | | |"),
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
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("method_costs");
    let _ = std::fs::remove_dir_all(&folder);
    let mut text = format!(
        "# What each method costs\n\n\
         `cargo bench --bench method_costs`, {}, {}.\n\n\
         *Lines* and *compile time* are what fused code for this method alone adds to the generated system and to\n\
         its compilation (processor time, opt-level 3, one codegen unit, after the runtime; a loop of steps included;\n\
         of the default options only). *Fused* and *generic* are instructions per step at h = 0.05\n\
         from the initial state of the declaration, counted by callgrind, with the fused form and with the generic\n\
         form on the generated kernels; a method without a fused form has the second column only. *Iterations* are the solver's, per step, with or without\n\
         a Jacobian, as the automatic choice has it.\n",
        tell("date", "+%Y-%m-%d"),
        tell("rustc", "--version"),
    );
    let only: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    for (title, name) in SYSTEMS {
        if only.is_empty() || only.iter().any(|wanted| wanted == name) {
            let section = section(&folder, title, name);
            text.push_str(&section);
        }
    }
    if !only.is_empty() {
        return;
    }
    text.push_str(OPEN);
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("lab/docs/method_costs.md");
    std::fs::write(&path, text).expect("lab/docs/method_costs.md is written");
    println!("written to {}", path.display());
}
