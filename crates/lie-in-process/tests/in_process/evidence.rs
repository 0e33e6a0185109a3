//! Kernels of compiled systems before their declarations: those of the same declaration pass, and each fault is named.

use lie_codegen::compile::compile_spec;
use lie_codegen::methods::Choice;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::evidence::Evidence;
use lie_in_process::verify::options;
use lie_in_process::{Question, Work, declared};
use lie_measure::Request;
use lie_measure::verify::Found;
use lie_program::protocol::{Message, Start};
use lie_program::session::Session;

/// The text of a spec below the folder of the workspace.
fn text(name: &str) -> String {
    let path = format!("{}/../../{name}.json", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

/// The default values of the parameters.
fn values(model: &Structure) -> Vec<f64> {
    model.parameters.iter().map(|p| p.default_value).collect()
}

/// What a verification of rk4 finds of kernels and of the reference solution.
fn found(model: &Structure) -> Vec<Found> {
    let choice = Choice::from_id("rk4").unwrap();
    let system = declared(model).unwrap().system(&[]).unwrap();
    let work = Work::new(model, &[choice], Purpose::Verify, || None).unwrap();
    let request = Request {
        methods: vec!["rk4".to_owned()],
        start: Start {
            initial: system.initial_state().unwrap(),
            ..Start::default()
        },
        options: options(model, &values(model), None, 1),
    };
    let mut said = Vec::new();
    let mut session = Session::undisturbed(&mut said);
    request.put(&work, &mut session).unwrap();
    let found = said.into_iter().filter_map(|message| match message {
        Message::Found(found @ (Found::Kernel(_) | Found::Reference(_))) => Some(found),
        _ => None,
    });
    found.collect()
}

/// What speaks against these kernels, before the declaration of a spec.
fn failures(text: &str, found: &[Found]) -> Vec<String> {
    let model = compile_spec(text).unwrap();
    let mut evidence = Evidence::from_spec(text, &model, &values(&model));
    for found in found.iter().cloned() {
        match found {
            Found::Kernel(kernel) => evidence.kernel(kernel),
            Found::Reference(solution) => evidence.reference(&solution),
            _ => unreachable!("nothing else was kept"),
        }
    }
    evidence.failures()
}

#[test]
fn kernels_of_the_declaration_pass_and_those_of_another_do_not() {
    for name in [
        "specs/so3_free_rigid_body",
        "specs/se3_heavy_top",
        "specs/lotka_volterra",
    ] {
        let text = text(name);
        let found = found(&compile_spec(&text).unwrap());
        assert_eq!(failures(&text, &found), [""; 0], "{name}");
    }
    // another moment of inertia: what does not contain it is right
    let text = text("specs/so3_free_rigid_body");
    let found = found(&compile_spec(&text).unwrap());
    let other = text.replacen("\"I2\": { \"default\": 1", "\"I2\": { \"default\": 3", 1);
    assert_ne!(text, other);
    let against = failures(&other, &found);
    let named = |kernel: &str| against.iter().any(|line| line.starts_with(kernel));
    for kernel in ["hamiltonian: entry 0 is ", "vector_field: ", "jacobian: "] {
        assert!(named(kernel), "{kernel}: {against:?}");
    }
    assert!(named("the reference solution differs"), "{against:?}");
    assert!(!named("poisson_matrix") && !named("ad:"), "{against:?}");
}

#[test]
fn a_kernel_that_is_wrong_missing_or_blind_is_named() {
    let text = text("specs/so3_free_rigid_body");
    let found = found(&compile_spec(&text).unwrap());
    let changed = |change: &dyn Fn(&str, &mut Vec<f64>) -> bool| -> Vec<String> {
        let kept = found.iter().cloned().filter_map(|mut found| {
            let wanted = match &mut found {
                Found::Kernel(kernel) => change(&kernel.name, &mut kernel.values),
                _ => true,
            };
            wanted.then_some(found)
        });
        failures(&text, &kept.collect::<Vec<_>>())
    };
    assert!(changed(&|_, _| true).is_empty());
    let wrong = changed(&|name, values| {
        if name == "gradient" {
            values[1] *= 1.0 + 1e-9;
        }
        true
    });
    assert!(
        matches!(wrong.as_slice(), [line] if line.starts_with("gradient: entry 1 is ")),
        "{wrong:?}"
    );
    let missing = changed(&|name, _| name != "ad_star");
    assert_eq!(missing, ["ad_star: the judge has not seen it"]);
    let unknown = changed(&|name, values| {
        if name == "hessian" {
            values.push(0.0);
        }
        true
    });
    assert!(
        unknown.iter().any(|line| line.starts_with("hessian: ")),
        "{unknown:?}"
    );
}

#[test]
fn kernels_of_a_family_are_not_compared() {
    let text = text("tests/data/families/heisenberg_chain");
    let model = compile_spec(&text).unwrap();
    let evidence = Evidence::from_spec(&text, &model, &values(&model));
    assert!(evidence.failures().is_empty() && evidence.kernels().is_none());
    assert!(evidence.summary().contains("not compared"));
}
