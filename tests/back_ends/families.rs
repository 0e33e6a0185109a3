//! Families: the interpreter, machine code, WebAssembly and rustc give the same bits, in every kernel at random states and in steps of every
//! method.

use crate::bits::{Differences, entries, kernels, trajectory};
use crate::random::Random;
use crate::wasmi_engine::Wasmi;
use lie_codegen::compile::compile_spec;
use lie_codegen::methods::{Choice, applicability};
use lie_codegen::plan::plan;
use lie_dynamic::{Dynamic, Engine, Interpreted};
use lie_jit::{Jit, JitWith, Registers};
use lie_methods::method;
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods as m;
use lie_runtime::{LiePoisson, Poisson, lie_poisson};

lie_poisson! { spec = "tests/data/families/cubic_lattice.json"; }
lie_poisson! { spec = "tests/data/families/damped_chain.json"; }
lie_poisson! { spec = "tests/data/families/damped_lattice.json"; }
lie_poisson! { spec = "tests/data/families/disordered_chain.json"; }
lie_poisson! { spec = "tests/data/families/disordered_lattice.json"; }
lie_poisson! { spec = "tests/data/families/driven_chain.json"; }
lie_poisson! { spec = "tests/data/families/driven_net.json"; }
lie_poisson! { spec = "tests/data/families/driven_ring.json"; }
lie_poisson! { spec = "tests/data/families/fput_chain.json"; }
lie_poisson! { spec = "tests/data/families/frustrated_net.json"; }
lie_poisson! { spec = "tests/data/families/heisenberg_chain.json"; }
lie_poisson! { spec = "tests/data/families/lattice.json"; }
lie_poisson! { spec = "tests/data/families/mean_field.json"; }
lie_poisson! { spec = "tests/data/families/mean_field_pieces.json"; }
lie_poisson! { spec = "tests/data/families/noisy_lattice.json"; }
lie_poisson! { spec = "tests/data/families/noisy_ring.json"; }
lie_poisson! { spec = "tests/data/families/open_chain.json"; }
lie_poisson! { spec = "tests/data/families/rotating_ring.json"; }
lie_poisson! { spec = "tests/data/families/su3_ring.json"; }
lie_poisson! { spec = "tests/data/families/toda_ring.json"; }
lie_poisson! { spec = "tests/data/families/xxz_chain.json"; }

/// The bracket at two states.
fn brackets<P: LiePoisson<f64, State = Vec<f64>>>(
    system: &P,
    [xi, mu]: &[Vec<f64>; 2],
) -> Vec<(&'static str, Vec<f64>)> {
    let (mut out, mut matrix) = (system.zero_state(), system.zero_jacobian());
    let mut found = Vec::new();
    system.ad(xi, mu, &mut out);
    found.push(("ad", out.clone()));
    system.ad_star(xi, mu, &mut out);
    found.push(("ad_star", out));
    system.ad_star_matrix(xi, &mut matrix);
    found.push(("ad_star_matrix", entries(&matrix)));
    found
}

/// A method by its label, for a printed system.
type Listed<'a, P> = (&'a str, Box<dyn AnyMethod<f64, P>>);

/// Compares a printed family with those of its spec that are made at run time: kernels at random states, and steps of these
/// methods, which are all that apply.
fn compare<P: LiePoisson<f64, State = Vec<f64>>>(
    spec: &str,
    printed: &P,
    parameters: &[(&str, f64)],
    methods: &[Listed<'_, P>],
) {
    let file = format!(
        "{}/tests/data/families/{spec}.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let model = compile_spec(&std::fs::read_to_string(file).unwrap()).unwrap();
    let listed = |id: &str| methods.iter().any(|(label, _)| *label == id);
    for (id, reason) in applicability(&model) {
        let composed = id.starts_with("compose");
        assert!(
            composed || reason.is_none() == listed(id),
            "{spec} {id}: {reason:?}"
        );
    }
    let values = model.parameters.iter().map(|known| {
        let mut given = parameters.iter();
        let given = given.find(|(name, _)| *name == known.name);
        given.map_or(known.default_value, |(_, value)| *value)
    });
    let values: Vec<f64> = values.collect();
    let n = printed.dimension();
    let plan = plan(&model, &[]);
    let mut random = Random(7);
    let states: Vec<_> = (0..5)
        .map(|_| [random.numbers(n), random.numbers(n)])
        .collect();
    let of_printed: Vec<_> = states
        .iter()
        .map(|states| [kernels(printed, &states[1]), brackets(printed, states)])
        .collect();
    let start = Dynamic::new(plan.clone(), &values, &Interpreted).unwrap();
    let start = start.initial_state().unwrap_or_else(|| random.numbers(n));
    let runs: Vec<_> = methods
        .iter()
        .map(|(_, method)| trajectory(printed, method.as_ref(), &start).unwrap())
        .collect();
    let mut differences = Differences::default();
    let machine_code: Vec<JitWith> = Registers::ALL.into_iter().filter_map(Jit::with).collect();
    let machine_code = machine_code.iter().map(|engine| engine as &dyn Engine);
    for engine in machine_code.chain([&Interpreted as &dyn Engine, &Wasmi]) {
        let made = Dynamic::new(plan.clone(), &values, engine).unwrap();
        assert_eq!(
            (made.dimension(), made.has_jacobian()),
            (n, printed.has_jacobian())
        );
        let names = |k: usize| {
            (
                printed.coordinate(k).to_owned(),
                made.coordinate(k).to_owned(),
            )
        };
        assert!((0..n).map(names).all(|(printed, made)| printed == made));
        for (states, printed) in states.iter().zip(&of_printed) {
            let made = [kernels(&made, &states[1]), brackets(&made, states)];
            for ((name, printed), (_, made)) in printed.iter().flatten().zip(made.iter().flatten())
            {
                differences.compare(&format!("{spec} {name} {}", engine.name()), printed, made);
            }
        }
        for ((label, _), printed) in methods.iter().zip(&runs) {
            let of_made = method(&Choice::from_id(label).unwrap(), Default::default());
            let made = trajectory(&made, of_made.as_ref(), &start).unwrap();
            differences.compare(&format!("{spec} {label} {}", engine.name()), printed, &made);
        }
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

/// The methods for every family.
macro_rules! methods {
    ($($more:literal $method:expr),*) => {
        &[
            ("gauss8", Box::new(m::Gauss8)),
            ("gauss10", Box::new(m::Gauss10)),
            ("gauss12", Box::new(m::Gauss12)),
            ("gauss14", Box::new(m::Gauss14)),
            ("gauss16", Box::new(m::Gauss16)),
            ("rk4", Box::new(m::Rk4)),
            ("dopri5", Box::new(m::Dopri5 { rtol: 1e-6, atol: 1e-9 })),
            $(($more, Box::new($method)),)*
        ]
    };
}

/// The same with the splittings.
macro_rules! splittings {
    () => {
        methods!(
            "splitting1" m::Splitting1::new(), "splitting2" m::Splitting2::new(), "splitting4" m::Splitting4::new(),
            "splitting6" m::Splitting6::new(), "splitting8" m::Splitting8::new()
        )
    };
}

#[test]
fn rings() {
    // columns of an odd and of an even number, and sites that are all ends
    for n in [23.0, 10.0, 2.0] {
        let ring = HeisenbergChain { N: n, J: 0.75 }.system().unwrap();
        compare(
            "heisenberg_chain",
            &ring,
            &[("N", n), ("J", 0.75)],
            splittings!(),
        );
    }
    let ring = XxzChain {
        N: 11.0,
        ..XxzChain::new()
    }
    .system()
    .unwrap();
    compare("xxz_chain", &ring, &[("N", 11.0)], splittings!());
    compare(
        "su3_ring",
        &Su3Ring::new().system().unwrap(),
        &[],
        methods!(),
    );
}

#[test]
fn chains_and_lattices() {
    let chain = OpenChain {
        N: 12.0,
        ..OpenChain::new()
    }
    .system()
    .unwrap();
    compare("open_chain", &chain, &[("N", 12.0)], methods!());
    let lattice = Lattice { N: 4.0, M: 5.0 }.system().unwrap();
    compare(
        "lattice",
        &lattice,
        &[("N", 4.0), ("M", 5.0)],
        splittings!(),
    );
}

#[test]
fn lattices_of_three_dimensions() {
    let lattice = CubicLattice::new().system().unwrap();
    compare("cubic_lattice", &lattice, &[], splittings!());
}

#[test]
fn mean_fields() {
    // more sites than are added at a time
    let field = MeanField {
        N: 13.0,
        ..MeanField::new()
    }
    .system()
    .unwrap();
    compare("mean_field", &field, &[("N", 13.0)], methods!());
    let field = MeanFieldPieces {
        N: 9.0,
        ..MeanFieldPieces::new()
    }
    .system()
    .unwrap();
    compare("mean_field_pieces", &field, &[("N", 9.0)], splittings!());
}

#[test]
fn coefficients_that_differ_from_site_to_site() {
    let chain = DisorderedChain::new().system().unwrap();
    compare("disordered_chain", &chain, &[], splittings!());
    let lattice = DisorderedLattice::new().system().unwrap();
    compare("disordered_lattice", &lattice, &[], splittings!());
}

#[test]
fn functions_of_two_coordinates() {
    let ring = TodaRing::new().system().unwrap();
    compare("toda_ring", &ring, &[], splittings!());
    let chain = FputChain::new().system().unwrap();
    compare("fput_chain", &chain, &[], splittings!());
}

#[test]
fn damped_chains() {
    let chain = DampedChain::new().system().unwrap();
    compare("damped_chain", &chain, &[], methods!());
}

#[test]
fn damped_lattices() {
    let lattice = DampedLattice::new().system().unwrap();
    compare("damped_lattice", &lattice, &[], methods!());
}

#[test]
fn noise_on_sites() {
    let ring = NoisyRing::new().system().unwrap();
    compare("noisy_ring", &ring, &[], splittings!());
    let lattice = NoisyLattice::new().system().unwrap();
    compare("noisy_lattice", &lattice, &[], splittings!());
}

#[test]
fn bonds_between_any_two_sites() {
    let net = FrustratedNet::new().system().unwrap();
    compare("frustrated_net", &net, &[], methods!());
}

#[test]
fn driven_chains() {
    let chain = DrivenChain::new().system().unwrap();
    compare("driven_chain", &chain, &[], methods!());
}

#[test]
fn driven_nets() {
    let net = DrivenNet::new().system().unwrap();
    compare("driven_net", &net, &[], methods!());
}

#[test]
fn what_depends_on_the_time_and_on_inputs() {
    let ring = RotatingRing::new().system().unwrap();
    compare("rotating_ring", &ring, &[], splittings!());
    assert!(!ring.is_autonomous() && ring.quantity_count() == 0);
    let ring = DrivenRing::new().system().unwrap();
    compare("driven_ring", &ring, &[], splittings!());
}
