//! A method that is asked for has its equation written out, and no other has.

use lie_codegen::compile::{compile_spec, expand};
use lie_codegen::methods::{Choice, Gradient, Lift, Retraction, Tensor};

/// The names of the types in the code of a spec with some methods.
fn types(spec: &str, choices: &[Choice]) -> Vec<String> {
    let path = format!("{}/../specs/{spec}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a spec");
    let model = compile_spec(&text).expect("a sound declaration");
    let code = expand(&model, choices);
    let lines = code
        .lines()
        .filter_map(|line| line.trim().strip_prefix("pub struct "));
    lines
        .map(|line| {
            line.split(['<', '(', ' ', ';'])
                .next()
                .expect("a name")
                .to_owned()
        })
        .collect()
}

#[test]
fn what_is_asked_for_is_written_out() {
    use Choice::{
        CohenHairer, Collective, DiscreteGradient, Gauss, Generating, GeneratingSecondKind2,
        Isospectral, LieMidpoint, Midpoint, MoserVeselov, OrbitEnergy, SphericalMidpoint,
        Splitting,
    };
    use Retraction::{Cayley, Exp};
    let spec = "so3_free_rigid_body";
    let plain = types(spec, &[]);
    for (choice, equation) in [
        (Midpoint, "Midpoint"),
        (Gauss(2), "Gauss4"),
        (Gauss(3), "Gauss6"),
        (LieMidpoint(Exp), "ExpMidpoint"),
        (LieMidpoint(Cayley), "CayleyMidpoint"),
        // of order 2 these are the equations of the retraction
        (Generating(2, Exp), "ExpMidpoint"),
        (Generating(2, Cayley), "CayleyMidpoint"),
        (Isospectral(2), "CayleyMidpoint"),
        (Collective(2, Lift::Representation), "CayleyMidpoint"),
        (Generating(4, Exp), "Generating4"),
        (Generating(6, Exp), "Generating6"),
        (Generating(4, Cayley), "CayleyGenerating4"),
        (GeneratingSecondKind2, "SecondKind2Equation"),
        (Isospectral(4), "Isospectral4"),
        (Collective(4, Lift::Representation), "Isospectral4"),
        (Collective(2, Lift::Hopf), "Hopf2"),
        (Collective(4, Lift::Hopf), "Hopf4"),
        (SphericalMidpoint, "SphericalMidpoint"),
        (MoserVeselov, "MoserVeselov"),
        (Splitting(2, Default::default()), "Splitting"),
    ] {
        let found = types(spec, std::slice::from_ref(&choice));
        let new: Vec<&String> = found.iter().filter(|name| !plain.contains(name)).collect();
        assert!(
            new.iter()
                .any(|name| name.ends_with(&format!("Body{equation}"))),
            "{choice:?}: {new:?}"
        );
        // eliminations and functions beside it, but no other equation
        let others = new.iter().filter(|name| !name.contains("Elimination"));
        assert!(others.count() <= 2, "{choice:?}: {new:?}");
    }
    let plain = types("so3_nonpolynomial", &[]);
    for choice in [
        DiscreteGradient(Gradient::Gonzalez, Tensor::default()),
        OrbitEnergy(Gradient::MeanValue),
        CohenHairer(4),
    ] {
        let found = types("so3_nonpolynomial", std::slice::from_ref(&choice));
        assert!(found.len() > plain.len(), "{choice:?}: {found:?}");
    }
}

/// Second derivatives are written out for methods that solve equations, and where no method is named.
#[test]
fn methods_without_equations_have_no_second_derivatives() {
    let path = format!("{}/../specs/su3_quadratic.json", env!("CARGO_MANIFEST_DIR"));
    let model = compile_spec(&std::fs::read_to_string(path).expect("a spec")).expect("sound");
    let lines = |choices: &[Choice]| {
        let code = expand(&model, choices);
        (code.contains("by_duals"), code.lines().count())
    };
    let (plain, all) = lines(&[]);
    let (explicit, few) = lines(&[Choice::Rk4]);
    let (mixed, _) = lines(&[Choice::Rk4, Choice::Midpoint]);
    assert_eq!([plain, explicit, mixed], [false, true, false]);
    assert!(few + 150 < all, "{few} of {all} lines");
}
