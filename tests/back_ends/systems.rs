//! The interpreter, machine code, WebAssembly, CPython and rustc give the same bits: every kernel of every spec on random states, and
//! steps of every method.

use crate::bits::{Differences, STEP, entries, kernels, trajectory};
use crate::cpython::CPython;
use crate::random::Random;
use crate::wasmi_engine::Wasmi;
use lie_codegen::compile::{compile_spec, with_options};
use lie_codegen::methods::{Choice, Lift, Retraction, Tensor};
use lie_codegen::plan::{Plan, plan};
use lie_dynamic::{Dynamic, Engine, Interpreted};
use lie_jit::{Jit, JitWith, Registers};
use lie_methods::method;
use lie_runtime::methods as m;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{
    DiscreteLagrangianPoisson, LagrangianPoisson, LiePoisson, Poisson, RealizedPoisson, Scalar,
    State, Widen,
};

lie_runtime::lie_poisson! { spec = "tests/data/declarations/pass/realization.json"; }
lie_runtime::lie_poisson! { spec = "tests/data/declarations/pass/realization_with_start.json"; }
lie_runtime::lie_poisson! { spec = "tests/data/u3_nonpolynomial.json"; }

const STATES: usize = 50;

/// The choice under a label.
fn choice_of(label: &str) -> Choice {
    let id = label.split(" --").next().unwrap_or(label);
    let choice = Choice::from_id(id).unwrap();
    match (&choice, label.rsplit(' ').next()) {
        (Choice::LieMidpoint(_), Some("cayley")) => Choice::LieMidpoint(Retraction::Cayley),
        (Choice::Variational(order, _), Some("cayley")) => {
            Choice::Variational(*order, Retraction::Cayley)
        }
        (Choice::DiscreteEulerPoincare(_), Some("cayley")) => {
            Choice::DiscreteEulerPoincare(Retraction::Cayley)
        }
        (Choice::DiscreteGradient(gradient, _), Some("mean")) => {
            Choice::DiscreteGradient(*gradient, Tensor::Mean)
        }
        (Choice::Collective(order, _), Some("hopf")) => Choice::Collective(*order, Lift::Hopf),
        (Choice::Collective(order, _), Some("quaternion")) => {
            Choice::Collective(*order, Lift::Quaternion)
        }
        (Choice::Collective(order, _), Some("unitary")) => {
            Choice::Collective(*order, Lift::Unitary)
        }
        (Choice::Collective(order, _), Some("spec")) => Choice::Collective(*order, Lift::Spec),
        (Choice::Collective(order, _), Some("smallest")) => {
            Choice::Collective(*order, Lift::Smallest)
        }
        (Choice::Collective(order, _), _) => Choice::Collective(*order, Lift::Representation),
        _ => choice,
    }
}

/// Machine code in all registers that this processor has.
fn machine_code() -> Vec<JitWith> {
    let all = Registers::ALL.into_iter();
    all.filter_map(Jit::with).collect()
}

/// The plan of a spec with these methods.
fn planned(spec: &str, ids: &[&str]) -> Plan {
    let text = std::fs::read_to_string(format!("{}/{spec}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let model = compile_spec(&text).unwrap();
    let choices: Vec<Choice> = ids.iter().map(|id| Choice::from_id(id).unwrap()).collect();
    plan(&model, &with_options(&model, &choices))
}

/// A plan as a system made at run time, by an engine.
fn made(plan: &Plan, engine: &dyn Engine) -> Dynamic<f64> {
    Dynamic::new(plan.clone(), &[], engine).unwrap()
}

/// The initial state of a spec.
fn start_of(spec: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(format!("{}/{spec}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let model = compile_spec(&text).unwrap();
    model.initial_values(&model.defaults()).unwrap()
}

/// Those of a Lie algebra.
fn algebra<P: LiePoisson<f64>>(
    system: &P,
    xi: &[f64],
    mu: &[f64],
) -> Vec<(&'static str, Vec<f64>)> {
    let state = |values: &[f64]| {
        let mut state = system.zero_state();
        state.as_mut_slice().copy_from_slice(values);
        state
    };
    let (xi, mu) = (state(xi), state(mu));
    let (mut out, mut matrix) = (system.zero_state(), system.zero_jacobian());
    let mut found = Vec::new();
    system.ad(&xi, &mu, &mut out);
    found.push(("ad", out.as_slice().to_vec()));
    system.ad_star(&xi, &mu, &mut out);
    found.push(("ad_star", out.as_slice().to_vec()));
    system.ad_star_matrix(&xi, &mut matrix);
    found.push(("ad_star_matrix", entries(&matrix)));
    system.coadjoint_action(&xi, &mu, &mut out);
    found.push(("coadjoint_action", out.as_slice().to_vec()));
    system.dexp_dual(&xi, &mu, &mut out);
    found.push(("dexp_dual", out.as_slice().to_vec()));
    system.dexp_dual_slope(&xi, &mu, &mut out, &mut matrix);
    found.push((
        "dexp_dual_slope",
        [out.as_slice(), &entries(&matrix)].concat(),
    ));
    found
}

/// Those of a system by its Lagrangian.
fn lagrangian<P: LagrangianPoisson<f64>>(
    system: &P,
    xi: &[f64],
    mu: &[f64],
) -> Vec<(&'static str, Vec<f64>)> {
    let mut found = algebra(system, xi, mu);
    let (mut velocity, mut out) = (system.zero_state(), system.zero_state());
    let mut matrix = system.zero_jacobian();
    velocity.as_mut_slice().copy_from_slice(xi);
    found.push(("lagrangian", vec![system.lagrangian(&velocity)]));
    system.momentum(&velocity, &mut out);
    found.push(("momentum", out.as_slice().to_vec()));
    system.inertia(&velocity, &mut matrix);
    found.push(("inertia", entries(&matrix)));
    system.euler_poincare(&velocity, &mut out);
    found.push(("euler_poincare", out.as_slice().to_vec()));
    found
}

/// Those of a system by its discrete Lagrangian.
fn discrete<P: DiscreteLagrangianPoisson<f64>>(
    system: &P,
    x: &[f64],
    mu: &[f64],
) -> Vec<(&'static str, Vec<f64>)> {
    let mut found = algebra(system, x, mu);
    let (mut point, mut out) = (system.zero_state(), system.zero_state());
    let mut matrix = system.zero_jacobian();
    point.as_mut_slice().copy_from_slice(x);
    let value = system.discrete_lagrangian(STEP, &point);
    found.push(("discrete_lagrangian", vec![value]));
    system.discrete_slope(STEP, &point, &mut out);
    found.push(("discrete_slope", out.as_slice().to_vec()));
    system.discrete_curvature(STEP, &point, &mut matrix);
    found.push(("discrete_curvature", entries(&matrix)));
    found
}

/// Those of a declared realization.
fn realized<P: RealizedPoisson<f64>>(
    system: &P,
    xi: &[f64],
    mu: &[f64],
) -> Vec<(&'static str, Vec<f64>)> {
    let (mut z, mut v, mut start) = (
        system.zero_point(),
        system.zero_point(),
        system.zero_point(),
    );
    for (i, (z, v)) in z
        .as_mut_slice()
        .iter_mut()
        .zip(v.as_mut_slice())
        .enumerate()
    {
        (*z, *v) = (
            mu[i % mu.len()] + 0.3 * i as f64,
            xi[i % xi.len()] - 0.7 * i as f64,
        );
    }
    let (mut covector, mut out) = (system.zero_state(), system.zero_state());
    let (mut point, mut matrix) = (system.zero_point(), system.zero_point_matrix());
    covector.as_mut_slice().copy_from_slice(xi);
    system.start(&mut start);
    let mut found = vec![("start", start.as_slice().to_vec())];
    system.momentum_map(&z, &mut out);
    found.push(("momentum_map", out.as_slice().to_vec()));
    system.pullback(&z, &covector, &mut point);
    found.push(("pullback", point.as_slice().to_vec()));
    system.pushforward(&z, &v, &mut out);
    found.push(("pushforward", out.as_slice().to_vec()));
    system.curvature(&z, &covector, &mut matrix);
    found.push(("curvature", entries(&matrix)));
    found
}

/// Compares a printed system with those made at run time.
macro_rules! compare {
    ($differences:ident, $spec:ident, $system:ident, $algebra:tt, $methods:tt) => {{
        use spec_systems::$spec::$system;
        let spec = concat!("specs/", stringify!($spec), ".json");
        compare!($differences, spec => $system, $algebra, $methods);
    }};
    ($differences:ident, $spec:expr => $system:ident, [$($algebra:ident)?], [$($id:literal $method:expr),* $(,)?]) => {{
        let printed = $system::new().system().unwrap();
        let spec = $spec;
        let machine_code = machine_code();
        let machine_code = machine_code.iter().map(|engine| engine as &dyn Engine);
        let engines: Vec<&dyn Engine> =
            machine_code.chain([&Interpreted as &dyn Engine, &Wasmi, &CPython]).collect();
        let plan = planned(spec, &spec_systems::methods::METHODS);
        let start: Vec<f64> = $system::new().initial_state().as_slice().to_vec();
        let systems: Vec<_> = engines.iter().map(|engine| (engine.name(), made(&plan, *engine))).collect();
        for (engine, made) in &systems {
            let name = |what: &str| format!("{spec} {engine} {what}");
            let mut random = Random(2018);
            for _ in 0..STATES {
                let near = |random: &mut Random| -> Vec<f64> {
                    let shifts = random.numbers(start.len());
                    start.iter().zip(shifts).map(|(x, shift)| x + 0.5 * shift).collect()
                };
                let mu = near(&mut random);
                for ((what, a), (_, b)) in kernels(&printed, &mu).iter().zip(kernels(made, &mu)) {
                    $differences.compare(&name(what), a, &b);
                }
                $(
                    let xi = near(&mut random);
                    let pairs = $algebra(&printed, &xi, &mu);
                    for ((what, a), (_, b)) in pairs.iter().zip($algebra(made, &xi, &mu)) {
                        $differences.compare(&name(what), a, &b);
                    }
                )?
            }
        }
        $({
            let choice = choice_of($id);
            let steps = trajectory(&printed, &$method, &start);
            let method = method(&choice, Default::default());
            for (engine, made) in &systems {
                let name = format!("{spec} {engine} {}", $id);
                match (&steps, trajectory(made, method.as_ref(), &start)) {
                    (Ok(printed), Ok(made)) => $differences.compare(&name, printed, &made),
                    (printed, made) => $differences.0.push(format!("{name} {printed:?} {made:?}")),
                }
            }
        })*
    }};
}

/// The methods of every Poisson system, and those of a Lie algebra, with others.
macro_rules! each {
    ($differences:ident, $($spec:ident $system:ident;)+) => {
        $(compare!($differences, $spec, $system, [], [
            "midpoint" m::ImplicitMidpoint, "gauss4" m::Gauss4, "gauss6" m::Gauss6, "gauss16" m::Gauss16,
            "gonzalez" m::Gonzalez, "mean-value" m::MeanValue, "itoh-abe" m::ItohAbe,
            "cohen-hairer4" m::CohenHairer4::new(), "rk4" m::Rk4, "dopri5" m::Dopri5 { rtol: 1e-6, atol: 1e-9 },
            "compose4(midpoint)" m::Compose4::new(m::ImplicitMidpoint),
        ]);)+
    };
    ($differences:ident, algebra $($spec:ident $system:ident [$($id:literal $method:expr),* $(,)?];)+) => {
        $(compare!($differences, $spec, $system, [algebra], [
            "midpoint" m::ImplicitMidpoint, "gauss4" m::Gauss4, "gauss6" m::Gauss6, "gauss16" m::Gauss16,
            "lie-midpoint" m::LieMidpoint::exp(), "lie-euler" m::LieEuler, "rkmk4" m::Rkmk4, "cg3" m::CrouchGrossman3,
            "gonzalez" m::Gonzalez, "mean-value" m::MeanValue, "itoh-abe" m::ItohAbe,
            "orbit-energy" m::OrbitEnergy::gonzalez(), "cohen-hairer4" m::CohenHairer4::new(),
            "generating4" m::Generating4::exp(), "generating-second-kind2" m::GeneratingSecondKind2,
            "rk4" m::Rk4, "dopri5" m::Dopri5 { rtol: 1e-6, atol: 1e-9 },
            "compose4(lie-midpoint)" m::Compose4::new(m::LieMidpoint::exp()),
            "taylor" m::Taylor::with_tolerance(1e-6), "lie-taylor" m::LieTaylor::with_tolerance(1e-6),
            "cf4" m::CommutatorFree4, "compose8(midpoint)" m::Compose8::new(m::ImplicitMidpoint),
            $($id $method),*
        ]);)+
    };
}

#[test]
fn rigid_bodies_and_spins() {
    let mut differences = Differences::default();
    each! { differences, algebra
        so3_free_rigid_body FreeRigidBody [
            "splitting2" m::Splitting2::new(), "spherical-midpoint" m::SphericalMidpoint,
            "moser-veselov" m::MoserVeselov, "exact" m::Exact, "isospectral2" m::Isospectral2::new(),
            "isospectral12" m::Isospectral12::new(), "collective8 --lift hopf" m::Collective8::hopf(),
            "gonzalez --tensor mean" m::WithTensor::new(m::Gonzalez, m::MeanTensor), "collective4" m::Collective4::representation(),
            "isospectral6" m::Isospectral6::new(), "collective6 --lift hopf" m::Collective6::hopf(),
            "lie-midpoint --retraction cayley" m::LieMidpoint::cayley(),
        ];
        so3_nonpolynomial NonpolynomialSpin [
            "spherical-midpoint" m::SphericalMidpoint, "isospectral4" m::Isospectral4::new(),
            "collective4 --lift hopf" m::Collective4::hopf(),
            "lie-midpoint --retraction cayley" m::LieMidpoint::cayley(),
        ];
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn other_algebras() {
    let mut differences = Differences::default();
    each! { differences, algebra
        se3_heavy_top HeavyTop [
            "splitting2" m::Splitting2::new(), "lie-midpoint --retraction cayley" m::LieMidpoint::cayley(),
            "isospectral4" m::Isospectral4::new(), "collective8 --lift quaternion" m::Collective8::quaternion(),
            "collective10 --lift smallest" m::Collective10::smallest(),
        ];
        se3_kirchhoff KirchhoffBody ["splitting4" m::Splitting4::new()];
        e2_pendulum Pendulum ["splitting2" m::Splitting2::new()];
        toda3_solvable TodaLattice [];
        heisenberg_h3 Heisenberg [];
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn large_algebras() {
    let mut differences = Differences::default();
    each! { differences, algebra
        so4_manakov ManakovTop ["isospectral4" m::Isospectral4::new(), "moser-veselov" m::MoserVeselov];
        so3_cotangent_group CotangentBody ["euler-arnold2" m::EulerArnold2];
        su3_quadratic Su3Quadratic [
            "isospectral4" m::Isospectral4::new(), "collective16 --lift unitary" m::Collective16::unitary(),
            "collective8 --lift smallest" m::Collective8::smallest(),
        ];
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn brackets_without_an_algebra() {
    let mut differences = Differences::default();
    each! { differences, canonical_pendulum CanonicalPendulum; lotka_volterra LotkaVolterra; se2_circulation BodyWithCirculation; }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn lagrangians() {
    let mut differences = Differences::default();
    compare!(differences, so3_gyrostat_lagrangian, Gyrostat, [lagrangian], [
        "midpoint" m::ImplicitMidpoint, "gauss4" m::Gauss4, "lie-midpoint" m::LieMidpoint::exp(),
        "lie-midpoint --retraction cayley" m::LieMidpoint::cayley(), "rk4" m::Rk4,
        "variational2" m::Variational2::exp(), "variational2 --retraction cayley" m::Variational2::cayley(),
        "variational4" m::Variational4::exp(), "variational6" m::Variational6::exp(),
    ]);
    // H is a Legendre transform by Newton's iteration
    compare!(differences, so3_quartic_lagrangian, QuarticBody, [lagrangian], [
        "midpoint" m::ImplicitMidpoint, "gauss4" m::Gauss4, "lie-midpoint" m::LieMidpoint::exp(),
        "gonzalez" m::Gonzalez, "rkmk4" m::Rkmk4, "rk4" m::Rk4,
        "variational2" m::Variational2::exp(), "variational2 --retraction cayley" m::Variational2::cayley(),
        "variational4" m::Variational4::exp(), "variational6" m::Variational6::exp(),
    ]);
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn discrete_lagrangians() {
    let mut differences = Differences::default();
    compare!(differences, so3_discrete_lagrangian, DiscreteBody, [discrete], [
        "midpoint" m::ImplicitMidpoint, "lie-midpoint" m::LieMidpoint::exp(), "rk4" m::Rk4,
        "discrete-euler-poincare --retraction cayley" m::DiscreteEulerPoincare::cayley(),
        "discrete-euler-poincare" m::DiscreteEulerPoincare::exp(),
    ]);
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

#[test]
fn realizations() {
    const WITHOUT_START: &str = "tests/data/declarations/pass/realization.json";
    const WITH_START: &str = "tests/data/declarations/pass/realization_with_start.json";
    let mut differences = Differences::default();
    compare!(differences, WITHOUT_START => Broken, [realized], [
        "collective2 --lift spec" m::Collective2::given(), "collective4 --lift spec" m::Collective4::given(),
        "collective6 --lift spec" m::Collective6::given(),
    ]);
    compare!(differences, WITH_START => AngularMomentum, [realized], [
        "collective2 --lift spec" m::Collective2::given(), "collective4 --lift spec" m::Collective4::given(),
        "collective6 --lift spec" m::Collective6::given(),
    ]);
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

/// The flow on factors of Hermitian matrices, as it is written out, and the start over a state.
#[test]
fn flows_over_a_unitary_representation() {
    const SPEC: &str = "tests/data/u3_nonpolynomial.json";
    let mut differences = Differences::default();
    let (printed, start) = (Threefold::new().system().unwrap(), start_of(SPEC));
    let expected = trajectory(&printed, &m::Collective16::unitary(), &start).unwrap();
    let plan = planned(SPEC, &["collective16"]);
    let machine_code = machine_code();
    let machine_code = machine_code.iter().map(|engine| engine as &dyn Engine);
    for engine in machine_code.chain([&Interpreted as &dyn Engine, &Wasmi, &CPython]) {
        let system = made(&plan, engine);
        for lift in [Lift::Unitary, Lift::Smallest] {
            let method = method(&Choice::Collective(16, lift), Default::default());
            let found = trajectory(&system, method.as_ref(), &start).unwrap();
            let name = format!("{} {}", engine.name(), lift.name());
            differences.compare(&name, &expected, &found);
        }
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

/// A Jacobian with a row of the identity, of an unknown that the iteration leaves out, is no singular one, whether its elimination is
/// written out or not.
#[test]
fn unknowns_left_out_of_long_eliminations() {
    let spec = "specs/so3_cotangent_euler_arnold.json";
    let id = "generating-second-kind2";
    let plan = planned(spec, &[id]);
    let method = method(&Choice::from_id(id).unwrap(), Default::default());
    for engine in [&Interpreted as &dyn Engine, &Jit] {
        let system = made(&plan, engine);
        let mut mu = start_of(spec);
        let mut stepper = method.any_stepper(&system, STEP, &NewtonOptions::newton());
        for step in 0..200 {
            let report = stepper.step(&mut mu).unwrap();
            assert_eq!(report.pivoted, 0, "{} step {step}", engine.name());
        }
    }
}

/// What machine code for lanes computes in each of them is what the code for numbers does.
#[test]
fn lanes_are_numbers_side_by_side() {
    type Wide = <f64 as Scalar>::Wide;
    let mut differences = Differences::default();
    let piecewise = r#"{"format": 1, "name": "Pieces", "algebra": "so(3)",
        "hamiltonian": "piecewise(x < 0: sin(x)*y, cbrt(x) + atan2(y, z)) + max(y, z)^2 + exp(z)^(1/3)"}"#;
    let specs = ["so3_nonpolynomial", "se3_heavy_top", "su3_quadratic"];
    let texts = specs.map(|spec| {
        let path = format!("{}/specs/{spec}.json", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    });
    for text in texts.iter().map(String::as_str).chain([piecewise]) {
        let model = compile_spec(text).unwrap();
        for engine in machine_code() {
            let system = Dynamic::new(plan(&model, &[]), &[], &engine).unwrap();
            let (n, wide) = (system.dimension(), system.widen());
            let mut random = Random(2018);
            for _ in 0..STATES {
                let lanes: Vec<Vec<f64>> =
                    (0..Wide::LANES).map(|_| random.numbers(2 * n)).collect();
                let pack = |from: usize| -> Vec<Wide> {
                    let of = |k: usize| {
                        let mut number = Wide::zero();
                        for (lane, values) in lanes.iter().enumerate() {
                            number = number.with_lane(lane, values[from + k]);
                        }
                        number
                    };
                    (0..n).map(of).collect()
                };
                let (mu, xi) = (pack(0), pack(n));
                let mut all = [wide.zero_state(), wide.zero_state(), wide.zero_state()];
                wide.vector_field(&mu, &mut all[0]);
                wide.coadjoint_action(&xi, &mu, &mut all[1]);
                wide.dexp_dual(&xi, &mu, &mut all[2]);
                for (lane, values) in lanes.iter().enumerate() {
                    let (mu, xi) = (values[..n].to_vec(), values[n..].to_vec());
                    let mut expected = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
                    system.vector_field(&mu, &mut expected[0]);
                    system.coadjoint_action(&xi, &mu, &mut expected[1]);
                    system.dexp_dual(&xi, &mu, &mut expected[2]);
                    for (wide, expected) in all.iter().zip(&expected) {
                        let own: Vec<f64> = wide.iter().map(|number| number.lane(lane)).collect();
                        differences.compare(&model.name, expected, &own);
                    }
                }
            }
        }
    }
    assert!(differences.0.is_empty(), "{}", differences.0.join("\n"));
}

/// The comparison fails where a bit differs.
#[test]
fn a_bit_that_differs_is_seen() {
    let mut differences = Differences::default();
    differences.compare("equal", &[0.1, 0.0], &[0.1, -0.0]);
    assert!(differences.0.is_empty());
    differences.compare(
        "different",
        &[0.1],
        &[f64::from_bits(0.1_f64.to_bits() + 1)],
    );
    assert_eq!(differences.0.len(), 1);
}
