//! The derived equations as numbers, before they are scheduled and written out: derivatives against differences,
//! steps against the flow, discrete gradients against what defines them.

mod system;

use std::collections::HashMap;

use lie_codegen::derive::{Function, Generating, Kernel, Shape};
use lie_codegen::methods::{Gradient, Retraction};
use lie_codegen::structure::inertia::Body;
use system::{Arguments, System, distance, named, point, solution};

const GRADIENTS: [Gradient; 3] = [Gradient::Gonzalez, Gradient::MeanValue, Gradient::ItohAbe];

fn quartic() -> System {
    let text = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../specs/so3_nonpolynomial.json"
    ));
    let mut spec: serde_json::Value = serde_json::from_str(&text.expect("a spec")).expect("JSON");
    spec["hamiltonian"] = "x^2 + y^2/2 + x*y*z/3 - x^3*z/4 + y^4/5 + x^2*y*z^3/6 + z".into();
    System::of("quartic", &spec.to_string())
}

/// Every equation with all its kernels.
fn equations(system: &mut System) -> Vec<(String, i32, Vec<Kernel>)> {
    let source = &mut system.source;
    let mut all = vec![("midpoint".into(), 2, source.midpoint_kernels())];
    all.extend(source.cayley_kernels().map(|k| ("cayley".into(), 2, k)));
    all.extend(
        source
            .spherical_kernels()
            .map(|k| ("spherical".into(), 2, k)),
    );
    all.extend(
        source
            .discrete_body_kernels()
            .map(|k| ("body".into(), 2, k)),
    );
    let generating = source.cayley_generating_kernels(4);
    all.extend(generating.map(|k| ("generating4 by Cayley".into(), 4, k)));
    let second = source.second_kind_kernels();
    all.extend(second.map(|k| ("second kind".into(), 2, k)));
    all
}

#[test]
fn equations_have_their_derivatives_and_their_order() {
    let mut seen = HashMap::new();
    for name in [
        "so3_free_rigid_body",
        "so3_nonpolynomial",
        "so4_manakov",
        "heisenberg_h3",
        "sl2_quadratic",
        "toda3_solvable",
        "se3_heavy_top",
    ] {
        let mut system = System::spec(name);
        for (label, order, kernels) in equations(&mut system) {
            *seen.entry(label.clone()).or_insert(0) += 1;
            let both = named(&kernels, "linearize");
            system.check_slopes(&label, named(&kernels, "residual"), both);
            let result = kernels.iter().find(|kernel| kernel.name == "result");
            // the new state of the body is no kernel
            if label == "body" {
                continue;
            }
            system.check_order(&label, order, &|h, mu| {
                // its unknown is an increment
                let start = match label.as_str() {
                    "spherical" => vec![0.0; mu.len()],
                    _ => mu.to_vec(),
                };
                let u = solution(&system, both, h, mu, start);
                match result {
                    Some(result) => system.equation(result, h, mu, &u).0,
                    None => u,
                }
            });
        }
    }
    let least = [
        ("midpoint", 7),
        ("cayley", 3),
        ("spherical", 2),
        ("body", 2),
        ("generating4 by Cayley", 3),
        ("second kind", 4),
    ];
    for (label, least) in least {
        let count = seen.get(label).copied().unwrap_or(0);
        assert!(count >= least, "{label}: {count}");
    }
}

/// `r = U - (1 - X/2) M (1 + X/2)`, `X = h grad H(U)`, with matrices.
#[test]
fn the_discrete_body_in_four_dimensions() {
    let mut system = System::spec("so4_manakov");
    let kernels = system.source.discrete_body_kernels().expect("a body");
    let Some(Body::Many { planes, .. }) = system.source.body().cloned() else {
        panic!("a body in four dimensions")
    };
    let basic = system.source.basic_kernels();
    let matrix = |entries: &[f64], factor: f64, unit: f64| {
        let mut out = [[0.0; 4]; 4];
        for (k, row) in out.iter_mut().enumerate() {
            row[k] = unit;
        }
        for (&(from, to), entry) in planes.iter().zip(entries) {
            out[to][from] += factor * entry;
            out[from][to] -= factor * entry;
        }
        out
    };
    let times = |a: [[f64; 4]; 4], b: [[f64; 4]; 4]| -> [[f64; 4]; 4] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
    };
    let (h, mu, u) = (0.4, point(6, 4), point(6, 5));
    let (gradient, _) = system.call(named(&basic, "gradient"), h, &[("mu", &u)]);
    let left = matrix(&gradient, -h / 2.0, 1.0);
    let right = matrix(&gradient, h / 2.0, 1.0);
    let product = times(times(left, matrix(&mu, 1.0, 0.0)), right);
    let (residual, _) = system.equation(named(&kernels, "residual"), h, &mu, &u);
    for (k, &(from, to)) in planes.iter().enumerate() {
        let expected = u[k] - product[to][from];
        assert!((residual[k] - expected).abs() < 1e-15, "{k}");
    }
}

/// A discrete gradient is symmetric in its ends, a gradient where they meet, and gives the change of H:
/// `<g(mu, u), u - mu> = H(u) - H(mu)`.
#[test]
fn discrete_gradients_are_what_they_are_called() {
    let mut systems = [
        quartic(),
        System::spec("heisenberg_h3"),
        System::spec("so3_free_rigid_body"),
    ];
    for (system, degree) in systems.iter_mut().zip([6, 4, 2]) {
        let basic = system.source.basic_kernels();
        for gradient in GRADIENTS {
            let label = format!("{gradient:?}");
            let kernels = system.source.gradient_kernels(gradient, degree);
            let value = named(&kernels, "value");
            system.check_slopes(&label, value, named(&kernels, "linearize"));
            for seed in 0..5 {
                let (mu, u) = (point(3, seed), point(3, seed + 7));
                let (there, _) = system.equation(value, 0.0, &mu, &u);
                let (back, _) = system.equation(value, 0.0, &u, &mu);
                let scale = there.iter().fold(1.0, |a: f64, x| a.max(x.abs()));
                assert!(distance(&there, &back) < 1e-14 * scale, "{label}");
                let along: f64 = (0..3).map(|k| there[k] * (u[k] - mu[k])).sum();
                let change = system.energy(&u) - system.energy(&mu);
                assert!(
                    (along - change).abs() < 1e-14 * scale,
                    "{label}: {along} {change}"
                );
                let near: Vec<f64> = mu.iter().map(|m| m + 1e-9).collect();
                let (limit, _) = system.equation(value, 0.0, &mu, &near);
                let (exact, _) = system.call(named(&basic, "gradient"), 0.0, &[("mu", &mu)]);
                assert!(distance(&limit, &exact) < 1e-7 * scale, "{label}");
            }
            let kernels = system.source.discrete_gradient_kernels(gradient, degree);
            let (first, both) = (named(&kernels, "residual"), named(&kernels, "linearize"));
            system.check_slopes(&label, first, both);
            let system = &*system;
            let step = |h: f64, mu: &[f64]| {
                let start = system.exact(0.8 * h, mu);
                solution(system, both, h, mu, start)
            };
            system.check_order(&label, 2, &step);
            let mu = point(3, 3);
            let change = system.energy(&step(0.08, &mu)) - system.energy(&mu);
            assert!(change.abs() < 1e-14, "{label}: {change:e}");
        }
    }
}

/// The flow of a piece `f_i(mu_i)` of H solves `mu' = f_i'(mu_i) Pi(mu) e_i`, in every closed form: rotations, boosts,
/// stretches, shears.
#[test]
fn flows_of_pieces_are_exact() {
    let boost = r#"{"format": 1, "name": "Boost", "state": ["x", "y", "z"], "parameters": {"k": {"value": "3/2", "exact": true}},
        "algebra": {"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = 2*k*e3", "[e2, e3] = -3*k*e1", "[e3, e1] = k*e2"]},
        "hamiltonian": "x^2/2 + cos(y) + z^4/4 + z"}"#;
    let shear = r#"{"format": 1, "name": "Filiform", "state": ["x", "y", "z", "u", "v"],
        "algebra": {"basis": ["e1", "e2", "e3", "e4", "e5"], "brackets": ["[e1, e2] = e3", "[e1, e3] = 2*e4", "[e1, e4] = e5"]},
        "hamiltonian": "x^3/3 + y^2 + z^2/2"}"#;
    let stretch = r#"{"format": 1, "name": "Stretch", "state": ["x", "y", "z", "u"],
        "algebra": {"basis": ["e1", "e2", "e3", "e4"], "brackets": ["[e1, e2] = 2*e2", "[e1, e3] = -2*e3", "[e1, e4] = e4/3"]},
        "hamiltonian": "x^2/2 + y^2/2 + z + u^2"}"#;
    // stretches along lines that are no axes, one by the inverse of the other
    let slanted = r#"{"format": 1, "name": "Slanted", "state": ["x", "y", "z", "u", "v"],
        "algebra": {"basis": ["e1", "e2", "e3", "e4", "e5"], "brackets": ["[e1, e2] = e2 + 2*e3", "[e1, e4] = -e4 - e5/2"]},
        "hamiltonian": "x^2/2 + sin(y) + z^2 + u^2 + v"}"#;
    let mut systems = vec![
        System::of("slanted", slanted),
        System::of("boost", boost),
        System::of("filiform", shear),
        System::of("stretch", stretch),
    ];
    for name in [
        "so3_free_rigid_body",
        "toda3_solvable",
        "so4_manakov",
        "e2_pendulum",
    ] {
        systems.push(System::spec(name));
    }
    for system in &mut systems {
        let basic = system.source.basic_kernels();
        let pieces = system.source.splitting_kernels().expect("H is separable");
        assert!(!pieces.is_empty());
        for piece in pieces {
            let kernel = piece.kernel.as_ref().expect("a closed form");
            let Shape::Vector(rows) = &kernel.shape else {
                panic!("a vector")
            };
            let n = system.source.dimension;
            let (t, mu) = (0.3, point(n, 6));
            let outputs = system.outputs(kernel, t, &[("mu", &mu)]);
            let mut moved = mu.clone();
            for ((row, update), value) in rows.iter().zip(&piece.updates).zip(outputs) {
                use lie_codegen::derive::Update::{Add, Divide, Multiply, Replace, Subtract};
                match update {
                    Add => moved[*row] += value,
                    Subtract => moved[*row] -= value,
                    Multiply => moved[*row] *= value,
                    Divide => moved[*row] /= value,
                    Replace => moved[*row] = value,
                }
            }
            let k = piece.coordinate;
            let system = &*system;
            let exact = system.flow(t, &mu, &|mu| {
                let (gradient, _) = system.call(named(&basic, "gradient"), 0.0, &[("mu", mu)]);
                let (_, matrix) = system.call(&system.matrix, 0.0, &[("mu", mu)]);
                matrix.iter().map(|row| row[k] * gradient[k]).collect()
            });
            let error = distance(&moved, &exact);
            assert!(error < 1e-10, "{} {k}: {error:e}", system.name);
        }
    }
}

/// `exp(ad*_xi) mu` and `phi1(ad*_xi) mu`, by their series; `ad*_xi mu = Pi(mu) xi`.
fn action(system: &System, xi: &[f64], mu: &[f64]) -> [Vec<f64>; 2] {
    let (mut moved, mut mean, mut term) = (mu.to_vec(), mu.to_vec(), mu.to_vec());
    for k in 1..25 {
        let (_, matrix) = system.call(&system.matrix, 0.0, &[("mu", &term)]);
        let rows = matrix.iter();
        let next =
            rows.map(|row| row.iter().zip(xi).map(|(a, x)| a * x).sum::<f64>() / f64::from(k));
        term = next.collect();
        for i in 0..mu.len() {
            moved[i] += term[i];
            mean[i] += term[i] / f64::from(k + 1);
        }
    }
    [moved, mean]
}

/// The step `mu1 = exp(ad*_xi) mu`, `xi = grad S(p)`, `p = phi1(ad*_xi) mu` has the order of the generating function.
#[test]
fn generating_functions_have_their_order() {
    for name in [
        "so3_free_rigid_body",
        "so3_nonpolynomial",
        "heisenberg_h3",
        "sl2_quadratic",
    ] {
        let mut system = System::spec(name);
        for order in [4, 6] {
            let generating = Generating::First(Retraction::Exp, order);
            let function: Function = system
                .source
                .generating_function(generating)
                .expect("it is small");
            let both = function.linearize.as_ref().expect("it is small");
            let n = system.source.dimension;
            let (h, p) = (0.3, point(n, 2));
            let (value, slopes) = system.call(both, h, &[("p", &p)]);
            let gradient = |p: &[f64]| system.call(&function.gradient, h, &[("p", p)]).0;
            assert!(distance(&value, &gradient(&p)) < 1e-13);
            for j in 0..n {
                let side = |shift: f64| {
                    let mut p = p.clone();
                    p[j] += shift;
                    gradient(&p)
                };
                let (up, down) = (side(1e-4), side(-1e-4));
                for i in 0..n {
                    let error = ((up[i] - down[i]) / 2e-4 - slopes[i][j]).abs();
                    assert!(error < 1e-6, "{name} {order} ({i}, {j}): {error:e}");
                    assert!(function.pattern[i][j] || slopes[i][j] == 0.0);
                }
            }
            let mu: Vec<f64> = point(n, 3);
            let errors = [0.4, 0.2].map(|h| {
                let mut p = mu.clone();
                let mut moved = mu.clone();
                for _ in 0..100 {
                    let (xi, _) = system.call(&function.gradient, h, &[("p", &p)]);
                    [moved, p] = action(&system, &xi, &mu);
                }
                distance(&moved, &system.exact(h, &mu))
            });
            let slope = (errors[0] / errors[1]).log2();
            let expected = f64::from(order + 1);
            assert!((slope - expected).abs() < 0.8, "{name} {order}: {errors:?}");
        }
    }
}

/// The map of a realization with its derivatives, and that it carries the canonical bracket to that of the state.
#[test]
fn realizations_with_their_derivatives() {
    let mut system = System::spec("so3_free_rigid_body");
    assert!(system.source.realization_kernels().is_none());
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../specs/so3_free_rigid_body.json"
    );
    let text = std::fs::read_to_string(path).expect("a spec");
    let mut spec: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    spec["realization"] = serde_json::json!({
        "positions": ["q1", "q2", "q3"],
        "momenta": ["p1", "p2", "p3"],
        "map": ["x = q3*p2 - q2*p3", "y = q1*p3 - q3*p1", "z = q2*p1 - q1*p2"]
    });
    system = System::of("realized body", &spec.to_string());
    let kernels = system.source.realization_kernels().expect("it has one");
    let (z, v, xi) = (point(6, 1), point(6, 2), point(3, 3));
    let map = |z: &[f64]| {
        system
            .call(named(&kernels, "momentum_map"), 0.0, &[("z", z)])
            .0
    };
    let pullback = |z: &[f64]| {
        let arguments: Arguments<'_> = &[("z", z), ("xi", &xi)];
        system.call(named(&kernels, "pullback"), 0.0, arguments).0
    };
    let [a, b, c] = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| z[j] * z[3 + i] - z[i] * z[3 + j]);
    assert!(distance(&map(&z)[..3], &[a, b, c]) < 1e-15);
    let moved = |shift: f64, i: usize| {
        let mut z = z.clone();
        z[i] += shift;
        z
    };
    let arguments: Arguments<'_> = &[("z", &z), ("v", &v), ("xi", &xi)];
    let (forward, _) = system.call(named(&kernels, "pushforward"), 0.0, arguments);
    let (_, curvature) = system.call(named(&kernels, "curvature"), 0.0, arguments);
    let mut along = vec![0.0; 3];
    for i in 0..6 {
        // the map is quadratic: differences are exact
        let (up, down) = (map(&moved(0.5, i)), map(&moved(-0.5, i)));
        let slope: f64 = (0..3).map(|k| xi[k] * (up[k] - down[k])).sum();
        assert!((slope - pullback(&z)[i]).abs() < 1e-14);
        (0..3).for_each(|k| along[k] += (up[k] - down[k]) * v[i]);
        let (up, down) = (pullback(&moved(0.5, i)), pullback(&moved(-0.5, i)));
        for j in 0..6 {
            assert!(
                (up[j] - down[j] - curvature[j][i]).abs() < 1e-14,
                "({i}, {j})"
            );
        }
    }
    assert!(distance(&forward[..3], &along) < 1e-14);
}
