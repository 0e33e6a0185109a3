//! Fuses the method with two systems: its equation is run over expressions, and what it computes is written out.

#![allow(missing_docs)]

use lie_codegen::compile::{compile_spec, expand_with};
use lie_codegen::derive::trace::{Formulas, step};
use lie_codegen::plan::Own;
use std::path::Path;

#[allow(dead_code)]
#[path = "src/trapezoid.rs"]
mod trapezoid;

const TRAPEZOID: Own = Own {
    name: "Trapezoid",
    method: "crate::trapezoid::Trapezoid",
    equation: "crate::trapezoid::TrapezoidEquation",
    docs: &[
        "The implicit trapezoidal rule, unknown `u = mu1`: `u - mu - (h/2) (f(mu) + f(u)) = 0`.",
    ],
    formulas: Formulas {
        residual: "`r = u - mu - (h/2) (f(mu) + f(u))`",
        linearize: "`r = u - mu - (h/2) (f(mu) + f(u))` and `dr/du = 1 - (h/2) Df(u)`",
        result: "`mu1 = u`",
    },
    trace: |system, h| step(trapezoid::TrapezoidEquation::new(system, h)),
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?;
    for spec in ["so3_free_rigid_body", "se3_heavy_top"] {
        let path = format!("{}/../../specs/{spec}.json", env!("CARGO_MANIFEST_DIR"));
        println!("cargo::rerun-if-changed={path}");
        let model = compile_spec(&std::fs::read_to_string(&path)?)
            .map_err(|mistakes| format!("{path}: {mistakes:?}"))?;
        let code = expand_with(&model, &[], &[TRAPEZOID])?;
        std::fs::write(Path::new(&out).join(format!("{spec}.rs")), code)?;
    }
    println!("cargo::rerun-if-changed=src/trapezoid.rs");
    Ok(())
}
