//! Generated kernels keep the digits of the formula that was written: systems with springs, anchors, Morse,
//! Coulomb and Lennard-Jones terms near equilibrium, against double-double. What is compared with is the
//! written formula with its derivatives by the rules of differentiation, in the same precision.

mod program;
mod random;
mod scalar;
mod system;

use lie_codegen::compile::compile_spec;
use lie_codegen::derive::{Kernel, Source};
use lie_symbolic::symbolic::Symbol;
use program::{constants, full, run};
use random::Random;
use scalar::{Number, Pair};
use system::{Length, System, Term};

/// The greatest loss against the written formula over all results, and where.
fn loss<T: Number>(system: &System, states: &[Vec<f64>], unit: f64) -> (f64, String) {
    let model = compile_spec(&system.spec()).unwrap_or_else(|e| panic!("{}: {e:?}", system.spec()));
    let mut source = Source::new(&model);
    let n = system.rest.len();
    let kernels: Vec<Kernel> = source.basic_kernels();
    let mut worst = (0.0, String::new());
    for kernel in &kernels {
        let names = [
            "hamiltonian",
            "gradient",
            "hessian",
            "vector_field",
            "jacobian",
        ];
        if !names.contains(&kernel.name) {
            continue;
        }
        let program = kernel.program(&mut source.graph);
        let prepared = constants::<T>(&program, &mut source, &system.parameters);
        let mut errors: Vec<(f64, f64)> = Vec::new();
        for state in states {
            let symbol = |s| match s {
                Symbol::Coordinate(i) => T::of(state[i]),
                Symbol::Parameter(i) => T::of(system.parameters[i]),
                other => panic!("{other:?}"),
            };
            let found = full(kernel, n, run(&program, &symbol, &prepared));
            let written = &system.results::<T>(state)[kernel.name];
            let exact = &system.results::<Pair>(state)[kernel.name];
            errors.resize(exact.len(), (0.0, 0.0));
            for (error, ((found, written), exact)) in
                errors.iter_mut().zip(found.iter().zip(written).zip(exact))
            {
                let off = |value: &T| Pair::of(value.to_f64()).sub(*exact).to_f64().abs();
                error.0 = f64::max(error.0, off(found));
                error.1 = error
                    .1
                    .max(off(written))
                    .max(2.0 * unit * exact.to_f64().abs());
                assert!(off(found).is_finite(), "{} {}", kernel.name, system.spec());
            }
        }
        for (entry, (found, written)) in errors.iter().enumerate() {
            if *found > worst.0 * written {
                let place = format!("{} {entry} of {}", kernel.name, system.spec());
                worst = (found / written, place);
            }
        }
    }
    worst
}

/// States within `2^nearness` of equilibrium.
fn states(system: &System, random: &mut Random, nearness: i32) -> Vec<Vec<f64>> {
    let mut state = || {
        let off = |x: &f64| x + (random.below(15) as f64 - 7.0) * 2f64.powi(nearness);
        system.rest.iter().map(off).collect()
    };
    (0..12).map(|_| state()).collect()
}

/// The greatest loss over that many systems.
fn audit<T: Number>(count: u64, nearness: i32, unit: f64) -> (f64, String) {
    // Where the digits go is seen with `--nocapture`.
    let losses = (0..count).map(|seed| {
        let mut random = Random(2018 + seed);
        let system = System::random(&mut random);
        let states = states(&system, &mut random, nearness);
        loss::<T>(&system, &states, unit)
    });
    let worst = losses.max_by(|a, b| a.0.total_cmp(&b.0)).expect("systems");
    println!("the greatest loss is {:.2}: {}", worst.0, worst.1);
    worst
}

#[test]
fn near_equilibrium_in_double_precision() {
    let (worst, place) = audit::<f64>(300, -34, f64::EPSILON / 2.0);
    assert!(worst <= 16.0, "{worst}: {place}");
}

#[test]
fn near_equilibrium_in_single_precision() {
    let (worst, place) = audit::<f32>(300, -18, f64::from(f32::EPSILON) / 2.0);
    assert!(worst <= 16.0, "{worst}: {place}");
}

/// A spring of stiffness 1e10 stretched by 1e-10: the control multiplies out and must fail.
#[test]
fn a_stiff_spring() {
    let system = System {
        algebra: 0,
        terms: vec![
            Term::Spring(
                0,
                Length {
                    from: 0,
                    to: Some(1),
                    rest: 1,
                },
            ),
            Term::Square(2, 2),
        ],
        parameters: vec![1e10, 0.0, 2.0],
        rest: vec![1.0, 1.0, 0.5],
    };
    let state = vec![vec![1.0 + 1e-10, 1.0, 0.5]];
    let (worst, place) = loss::<f64>(&system, &state, f64::EPSILON / 2.0);
    assert!(worst <= 4.0, "{worst}: {place}");
    let (k, x, y) = (1e10, state[0][0], state[0][1]);
    let exact = &system.results::<Pair>(&state[0])["vector_field"][2];
    let expanded = k * x * x - k * y * y;
    let lost = Pair::of(expanded).sub(*exact).to_f64().abs() / exact.to_f64().abs();
    assert!(lost > 1e-9, "the control lost {lost}");
}

/// The results of a kernel of a spec at a state, and the exact ones by double-double.
fn kernel<T: Number>(spec: &str, name: &str, parameters: &[f64], state: &[f64]) -> Vec<T> {
    let model = compile_spec(spec).unwrap_or_else(|e| panic!("{spec}: {e:?}"));
    let mut source = Source::new(&model);
    let kernels = source.basic_kernels();
    let kernel = kernels.iter().find(|kernel| kernel.name == name);
    let program = kernel.expect("a kernel").program(&mut source.graph);
    let prepared = constants::<T>(&program, &mut source, parameters);
    let symbol = |s| match s {
        Symbol::Coordinate(i) => T::of(state[i]),
        Symbol::Parameter(i) => T::of(parameters[i]),
        other => panic!("{other:?}"),
    };
    run(&program, &symbol, &prepared)
}

/// A system on so(3) with this Hamiltonian; its parameters are a, b, c.
fn spec(hamiltonian: &str) -> String {
    format!(
        r#"{{"format": 1, "name": "Case", "algebra": {{"basis": ["e1", "e2", "e3"],
        "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}}, "state": ["x", "y", "z"],
        "parameters": {{"a": 1, "b": 2, "c": 3}}, "hamiltonian": "{hamiltonian}"}}"#
    )
}

/// `1/r - z^2/r^3` has no digit at z = 1e8; `1/r^3` has all.
#[test]
fn the_second_derivative_of_a_radius() {
    let text = spec("sqrt(1 + z^2) + a*x + b*y + c*x*y");
    let z = 1e8;
    let hessian = kernel::<f64>(&text, "hessian", &[1.0, 2.0, 3.0], &[1.0, 1.0, z]);
    let exact = 1e-24 * (1.0 - 1.5e-16);
    let found = hessian
        .iter()
        .find(|entry| (*entry / exact - 1.0).abs() < 1e-14);
    assert!(found.is_some(), "{hessian:?}");
    // the control: by the rules of differentiation
    let r = (1.0 + z * z).sqrt();
    let ruled = 1.0 / r - z * z / (r * r * r);
    assert!((ruled / exact - 1.0).abs() > 0.5, "{ruled}");
    // in three dimensions too: (x^2 + y^2)/r^3
    let text = spec("sqrt(x^2 + y^2 + z^2) + a*x + b*y + c*x*y");
    let hessian = kernel::<f64>(&text, "hessian", &[1.0, 2.0, 3.0], &[1.0, 1.0, z]);
    let found = hessian
        .iter()
        .find(|entry| (*entry / 2e-24 - 1.0).abs() < 1e-14);
    assert!(found.is_some(), "{hessian:?}");
}

/// A prepared difference is computed before it is multiplied.
#[test]
fn a_prepared_constant() {
    let text = spec("a*(b - c)*y^2 + x^2");
    let parameters = [1.0 / 3.0, 1.0 + 1e-12, 1.0];
    let exact = Pair::of(parameters[0]).mul(Pair::of(parameters[1]).sub(Pair::of(parameters[2])));
    let energy = kernel::<f64>(&text, "hamiltonian", &parameters, &[0.0, 1.0, 0.0])[0];
    let error = Pair::of(energy).sub(exact).to_f64().abs() / exact.to_f64();
    assert!(error < 1e-15, "{error}");
    let expanded = parameters[0] * parameters[1] - parameters[0] * parameters[2];
    let lost = Pair::of(expanded).sub(exact).to_f64().abs() / exact.to_f64();
    assert!(lost > 1e-7, "the control lost {lost}");
}

/// The twelfth power of a ratio stays in range where those of its terms do not.
#[test]
fn the_power_of_a_ratio_in_single_precision() {
    let text = spec("(a/x)^12 - (a/x)^6 + (y + z)^2");
    for scale in [1e-5, 1e5] {
        let state = [1.25 * scale, 0.0, 0.0];
        let energy = kernel::<f32>(&text, "hamiltonian", &[scale, 2.0, 3.0], &state)[0];
        let exact = 0.8f64.powi(12) - 0.8f64.powi(6);
        assert!((f64::from(energy) / exact - 1.0).abs() < 3e-6, "{energy}");
        let control = (scale as f32).powi(12) * (state[0] as f32).powi(-12);
        assert!(control == 0.0 || !control.is_finite(), "{control}");
    }
}

/// Field and Jacobian are the same numbers alone and in `linearize`.
#[test]
fn kernels_agree_bit_for_bit() {
    let mut compared = 0;
    for seed in 0..60 {
        let mut random = Random(77 + seed);
        let system = System::random(&mut random);
        let text = system.spec();
        let model = compile_spec(&text).expect("a system");
        let mut source = Source::new(&model);
        let kernels = source.basic_kernels();
        let state = states(&system, &mut random, -3).remove(0);
        let mut results = |name: &str| {
            let kernel = kernels.iter().find(|kernel| kernel.name == name);
            let program = kernel.expect("a kernel").program(&mut source.graph);
            let prepared = constants::<f64>(&program, &mut source, &system.parameters);
            let symbol = |s| match s {
                Symbol::Coordinate(i) => state[i],
                Symbol::Parameter(i) => system.parameters[i],
                other => panic!("{other:?}"),
            };
            run(&program, &symbol, &prepared)
        };
        let mut apart = results("vector_field");
        apart.extend(results("jacobian"));
        let together = results("linearize");
        assert_eq!(apart.len(), together.len());
        for (a, b) in apart.iter().zip(&together) {
            assert_eq!(a.to_bits(), b.to_bits(), "{text}");
            compared += 1;
        }
    }
    assert!(compared > 500, "{compared}");
}
