//! A method that is asked for has its equation planned, and no other has.

use lie_codegen::compile::{compile_spec, expand};
use lie_codegen::methods::{Choice, Gradient, Lift, Pieces, Retraction, Scheme, Tensor};
use lie_codegen::plan::{Item, Method, Plan, Solver, plan};

fn planned(spec: &str, choice: &Choice) -> Plan {
    let path = format!("{}/../../specs/{spec}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a spec");
    let model = compile_spec(&text).expect("a sound declaration");
    plan(&model, std::slice::from_ref(choice))
}

/// The methods that have an equation of their own; Gauss collocation that is asked for may be the generic one.
fn methods(plan: &Plan) -> Vec<&Choice> {
    let methods = plan.items.iter().filter_map(|item| match item {
        Item::Method(Method::Catalogue(Choice::Gauss(_)), Solver::Generic(_)) => None,
        Item::Method(Method::Catalogue(choice), _) => Some(choice),
        _ => None,
    });
    methods.collect()
}

#[test]
fn what_is_asked_for_is_planned() {
    use Choice::{
        Collective, Gauss, Generating, GeneratingSecondKind2, Isospectral, LieMidpoint, Midpoint,
        MoserVeselov, SphericalMidpoint,
    };
    use Retraction::{Cayley, Exp};
    // a method, that whose equation it solves, and how many definitions this is made of
    for (choice, solved, definitions) in [
        (Midpoint, Midpoint, 1),
        (Gauss(2), Gauss(2), 1),
        (Gauss(3), Gauss(3), 1),
        (LieMidpoint(Cayley), LieMidpoint(Cayley), 1),
        (LieMidpoint(Exp), LieMidpoint(Exp), 1),
        (Generating(2, Exp), LieMidpoint(Exp), 1),
        (Generating(2, Cayley), LieMidpoint(Cayley), 1),
        (Isospectral(2), LieMidpoint(Cayley), 1),
        (Collective(2, Lift::Representation), LieMidpoint(Cayley), 1),
        (Generating(4, Exp), Generating(4, Exp), 2),
        (Generating(6, Exp), Generating(6, Exp), 2),
        (Generating(4, Cayley), Generating(4, Cayley), 1),
        (GeneratingSecondKind2, GeneratingSecondKind2, 1),
        (Isospectral(4), Isospectral(4), 1),
        (Collective(4, Lift::Representation), Isospectral(4), 1),
        (Collective(4, Lift::Hopf), Collective(4, Lift::Hopf), 1),
        (SphericalMidpoint, SphericalMidpoint, 1),
        (MoserVeselov, MoserVeselov, 1),
    ] {
        let plan = planned("so3_free_rigid_body", &choice);
        assert_eq!(methods(&plan), [&solved], "{choice:?}");
        assert_eq!(plan.items.len(), definitions + 1, "{choice:?}");
    }
    // what would save under a twentieth of a step stays generic, and the exponential where it has no closed form
    for (spec, choice) in [
        ("su3_quadratic", LieMidpoint(Exp)),
        ("su3_quadratic", Generating(2, Exp)),
        ("so3_free_rigid_body", Collective(2, Lift::Hopf)),
    ] {
        let plan = planned(spec, &choice);
        assert!(plan.items.is_empty(), "{choice:?}");
    }
    for (spec, stages, planned_too) in [
        ("so3_free_rigid_body", 2, true),
        ("se3_heavy_top", 2, false),
        ("se3_heavy_top", 3, true),
        ("su3_quadratic", 2, false),
        ("su3_quadratic", 3, false),
    ] {
        let gauss = planned(spec, &Gauss(stages));
        assert_eq!(methods(&gauss).len(), usize::from(planned_too), "{spec}");
        // collocation that keeps a quadratic energy is Gauss collocation, with or without
        let collocation = planned(spec, &Choice::CohenHairer(2 * stages as u32));
        assert_eq!(methods(&collocation).len(), 1, "{spec}");
    }
    let splitting = |pieces| {
        let plan = planned(
            "so3_free_rigid_body",
            &Choice::Splitting(2, Scheme::Strang, pieces),
        );
        assert!(plan.items.is_empty());
        let found = plan.found.as_ref().map_or(0, |found| found.flows().count());
        (plan.splitting.is_some(), found)
    };
    assert_eq!(splitting(Pieces::Coordinate), (true, 0));
    assert_eq!(splitting(Pieces::Found), (false, 2));
}

/// Where H is not quadratic, the methods that keep the energy have equations of their own.
#[test]
fn energy_methods_are_planned() {
    for choice in [
        Choice::DiscreteGradient(Gradient::Gonzalez, Tensor::default()),
        Choice::OrbitEnergy(Gradient::MeanValue),
        Choice::CohenHairer(4),
    ] {
        let plan = planned("so3_nonpolynomial", &choice);
        assert_eq!(methods(&plan), [&choice]);
        assert_eq!(plan.items.len(), 2, "{choice:?}");
    }
}

/// A plan is data: it goes to other threads, equal declarations have equal ones, and another method makes another.
#[test]
fn plans_are_compared_hashed_and_sent() {
    use std::collections::HashSet;
    let plans: Vec<Plan> = std::thread::scope(|scope| {
        let spawn = |choice| scope.spawn(move || planned("se3_heavy_top", &choice));
        let threads = [Choice::Midpoint, Choice::Midpoint, Choice::Gauss(2)].map(spawn);
        let join = |thread: std::thread::ScopedJoinHandle<'_, Plan>| thread.join().expect("a plan");
        threads.into_iter().map(join).collect()
    });
    assert_eq!(plans[0], plans[1]);
    assert_ne!(plans[0], plans[2]);
    assert_eq!(plans.into_iter().collect::<HashSet<_>>().len(), 2);
}

/// Second derivatives are written out for methods that solve equations, and where no method is named.
#[test]
fn methods_without_equations_have_no_second_derivatives() {
    let path = format!(
        "{}/../../specs/su3_quadratic.json",
        env!("CARGO_MANIFEST_DIR")
    );
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
