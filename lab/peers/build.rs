//! Writes, for each case of `cases.json`, the system that lie-poisson generates from its spec, and its right-hand side
//! as it stands in that file for the other crates.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use lie_codegen::compile::{compile_spec, expand, with_options};
use lie_codegen::methods::Choice;
use serde::Deserialize;

/// Methods that are given code of their own, where they apply.
const METHODS: [&str; 16] = [
    "rk4",
    "gauss8",
    "gauss12",
    "gauss16",
    "collective8",
    "collective12",
    "collective16",
    "cohen-hairer16",
    "splitting4",
    "splitting6",
    "splitting8",
    "exact",
    "taylor",
    "lie-taylor",
    "rkmk6",
    "spherical-midpoint",
];

#[derive(Deserialize)]
struct Case {
    /// Empty for a case that has a program of its own.
    #[serde(default)]
    spec: String,
    /// The spec of a family.
    #[serde(default)]
    family: String,
    #[serde(default)]
    initial: Vec<f64>,
    #[serde(default)]
    field: Vec<String>,
}

fn main() {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let cases = here.join("cases.json");
    let specs = here.join("../../specs");
    println!("cargo::rerun-if-changed={}", cases.display());
    println!("cargo::rerun-if-changed={}", specs.display());
    let text = std::fs::read_to_string(&cases).expect("cases.json can be read");
    let mut cases: BTreeMap<String, Case> =
        serde_json::from_str(&text).expect("cases.json is sound");
    let families = here.join("../../tests/data/families");
    println!("cargo::rerun-if-changed={}", families.display());
    let of_families = cases.values().filter(|case| !case.family.is_empty());
    let of_families: Vec<String> = of_families
        .map(|case| system(&families, &case.family))
        .collect();
    cases.retain(|_, case| !case.spec.is_empty());
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let written = cases.values().map(|case| system(&specs, &case.spec));
    let written: String = written.chain(of_families).collect();
    write(&out.join("systems.rs"), &written);
    write(&out.join("fields.rs"), &fields(&cases));
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).expect("the output folder can be written");
}

/// A module with the system of a spec.
fn system(folder: &Path, name: &str) -> String {
    let spec = folder.join(name).with_extension("json");
    let spec = std::fs::read_to_string(&spec).expect("the spec can be read");
    let model = compile_spec(&spec).expect("the spec is sound");
    let choices = METHODS.map(|id| Choice::from_id(id).expect("a method"));
    let code = expand(&model, &with_options(&model, &choices));
    format!("pub mod {name} {{\n{code}\n}}\n")
}

/// A function for each case: straight code with literal constants, inlined.
fn fields(cases: &BTreeMap<String, Case>) -> String {
    let mut text = String::new();
    for case in cases.values() {
        let name = &case.spec;
        writeln!(
            text,
            "#[inline(always)]\npub fn {name}(y: &[f64], d: &mut [f64]) {{"
        )
        .unwrap();
        let size = case.initial.len();
        writeln!(text, "let y: &[f64; {size}] = y.try_into().unwrap();").unwrap();
        writeln!(text, "let d: &mut [f64; {size}] = d.try_into().unwrap();").unwrap();
        for index in 0..size {
            writeln!(text, "let y{index} = y[{index}];").unwrap();
        }
        for line in &case.field {
            let (left, right) = line.split_once(" = ").expect("an assignment");
            match left.strip_prefix('d').and_then(|k| k.parse::<usize>().ok()) {
                Some(index) => writeln!(text, "d[{index}] = {right};").unwrap(),
                None => writeln!(text, "let {left} = {right};").unwrap(),
            }
        }
        text.push_str("}\n");
    }
    text
}
