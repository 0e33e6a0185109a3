//! Generating functions stay of bounded size: written out, by duals, or left to the generic form.

use lie_codegen::compile::{compile_spec, expand};
use lie_codegen::methods::{Choice, Retraction};

const SIX: Choice = Choice::Generating(6, Retraction::Exp);

/// The code of a system on so(4) with and without the function of order 6, and what it adds.
fn added(hamiltonian: &str) -> (String, usize) {
    let path = format!(
        "{}/../../specs/so4_manakov.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).unwrap();
    let mut spec: serde_json::Value = serde_json::from_str(&text).unwrap();
    spec["hamiltonian"] = hamiltonian.into();
    let model = compile_spec(&spec.to_string()).unwrap();
    let with = expand(&model, &[SIX]);
    let lines = with.lines().count() - expand(&model, &[]).lines().count();
    (with, lines)
}

#[test]
fn a_quadratic_function_is_written_out() {
    let (code, lines) = added("m12^2 + m13^2/2 + m14^2/3 + m23^2/4 + m24^2/5 + m34^2/6");
    assert!(code.contains("ManakovTopGenerating6"));
    assert!(!code.contains("linearize_by_duals"));
    assert!(lines < 2500, "{lines}");
}

#[test]
fn a_long_hessian_comes_from_duals() {
    let (code, lines) = added(
        "sin(m12*m13 + m14) + exp(m23*m24/4)*cos(m34) + sqrt(1 + m12^2 + m34^2)*m13*m24 + m14^2*m23^3",
    );
    assert!(code.contains("linearize_by_duals"), "{lines}");
    assert!(lines < 6000, "{lines}");
}

#[test]
fn what_swells_is_left_to_the_generic_form() {
    let (code, lines) = added(
        "exp(sin(m12*m13*m14) + cos(m23*m24*m34))*sqrt(1 + m12^2*m34^2 + exp(m13*m24)*sin(m14*m23))",
    );
    assert!(!code.contains("ManakovTopGenerating6"), "{lines}");
    assert!(lines < 100, "{lines}");
}
