//! Generates the code of every spec.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use lie_codegen::compile::{compile_spec, expand, with_options};
use lie_codegen::methods::Choice;

#[path = "src/methods.rs"]
mod methods;

fn main() {
    let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs");
    println!("cargo::rerun-if-changed={}", specs.display());
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let all = stems(&specs);
    module(&specs, &out.join("systems.rs"), &all, &methods::METHODS);
    let generated = methods::GENERATED.map(str::to_owned);
    let file = out.join("generating.rs");
    module(&specs, &file, &generated, &methods::GENERATING);
}

/// The names of the specs, without their schema.
fn stems(specs: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(specs).expect("the folder of specs");
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let names = names.map(|name| name.to_string_lossy().into_owned());
    let stems = names.filter_map(|name| name.strip_suffix(".json").map(str::to_owned));
    let mut stems: Vec<String> = stems.filter(|stem| !stem.ends_with(".schema")).collect();
    stems.sort();
    stems
}

/// Writes a file with a module for each spec.
fn module(specs: &Path, file: &Path, stems: &[String], ids: &[&str]) {
    let mut text = String::new();
    for stem in stems {
        let code = code(&specs.join(format!("{stem}.json")), ids);
        writeln!(text, "pub mod {stem} {{\n{code}\n}}").expect("a string takes all");
    }
    std::fs::write(file, text).expect("the output folder can be written");
}

fn code(spec: &Path, ids: &[&str]) -> String {
    let text = std::fs::read_to_string(spec).expect("the spec can be read");
    let model = compile_spec(&text).expect("the spec is sound");
    let choices = ids.iter().map(|id| Choice::from_id(id).expect("a method"));
    expand(&model, &with_options(&model, &choices.collect::<Vec<_>>()))
}
