//! `lie equilibria` where the rank of the bracket drops: steady rotations of bodies with a constraint, and what is said of Casimirs.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{folder, lie};

fn written(folder: &Path, spec: &Value) -> PathBuf {
    let name = spec["name"].as_str().expect("a name");
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

fn found(path: &Path, options: &str) -> Value {
    let run = lie(&format!("equilibria {} {options} --json", path.display())).ok();
    serde_json::from_str(&run.stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let entries = value.as_array().expect("an array").iter();
    entries
        .map(|entry| entry.as_f64().expect("a number"))
        .collect()
}

const KINETIC: &str = "m1^2/2 + m2^2/3 + m3^2 + m1*m3/4 - m2*m3/5";

/// The body of Suslov in a potential V on se(3)*, with the constraint that it does not turn about its third axis.
fn in_potential() -> Value {
    json!({
        "format": 1,
        "name": "susp",
        "algebra": "se(3)",
        "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
        "hamiltonian": format!("{KINETIC} + g1^4/4 + g2^2*g3/3 + g3^2/2 + g1/3"),
        "constraint": ["J3 = 0"],
        "initial": ["-17/20", "-1/4", "3/5", "0", "4/5"]
    })
}

/// The motion of `(m1, m2, g)` with the reaction along the third axis: `m' = m x w + g x grad V + (0, 0, r)`, `g' = g x w`, `w3 = 0`.
fn field(x: &[f64]) -> [f64; 5] {
    let (m1, m2, g) = (x[0], x[1], [x[2], x[3], x[4]]);
    let m3 = m2 / 10.0 - m1 / 8.0;
    let (w1, w2) = (m1 + m3 / 4.0, 2.0 * m2 / 3.0 - m3 / 5.0);
    let slope = [
        g[0].powi(3) + 1.0 / 3.0,
        2.0 * g[1] * g[2] / 3.0,
        g[1] * g[1] / 3.0 + g[2],
    ];
    [
        -m3 * w2 + g[1] * slope[2] - g[2] * slope[1],
        m3 * w1 + g[2] * slope[0] - g[0] * slope[2],
        -g[2] * w2,
        g[2] * w1,
        g[0] * w2 - g[1] * w1,
    ]
}

/// All that is listed rests in equations that are written by hand. Where the rank drops it turns about g, which lies across the third axis,
/// the sum of the eigenvalues is the divergence of the motion, and there are such families on both sides of it.
#[test]
fn a_body_of_suslov_turns_steadily_in_a_potential() {
    let folder = folder();
    let path = written(folder.path(), &in_potential());
    let all = found(&path, "");
    assert_eq!(all["equilibria"].as_array().expect("a list").len(), 6);
    let low = all["lower_rank"].as_array().expect("a list");
    let every = all["equilibria"].as_array().into_iter().flatten();
    for one in every.chain(low) {
        let state = numbers(&one["state"]);
        assert!(field(&state).iter().all(|x| x.abs() < 1e-11), "{one:#}");
    }
    let mut signs = [0, 0];
    for one in low.iter().filter(|one| one["family_dimension"] == 1) {
        let state = numbers(&one["state"]);
        assert_eq!(one["rank"], 2);
        assert!(state[4] == 0.0 && state[0].abs() > 1e-3, "{one:#}");
        let moved = |i: usize, by: f64| {
            let mut other = state.clone();
            other[i] += by;
            field(&other)[i]
        };
        let divergence: f64 = (0..5)
            .map(|i| (moved(i, 1e-5) - moved(i, -1e-5)) / 2e-5)
            .sum();
        let eigenvalues = one["eigenvalues"].as_array().expect("a list").iter();
        let sum: f64 = eigenvalues.map(|z| numbers(z)[0]).sum();
        assert!(
            (sum - divergence).abs() < 1e-8,
            "{sum} {divergence} {one:#}"
        );
        // a half of the family is the other one backwards in time
        signs[usize::from(sum > 0.0)] += 1;
        // the family goes on: a state of another angle turns steadily too
        let angle = state[3].atan2(state[2]) + 0.05;
        let (c, s) = (angle.cos(), angle.sin());
        let near = (0..40_000).map(|k| {
            let w = (f64::from(k) - 20_000.0) * 5e-4;
            // w = w (c, s, 0) gives m by the inverse of the inertia on the subspace
            let (a, b, d) = (31.0 / 32.0, 97.0 / 150.0, 1.0 / 40.0);
            let det = a * b - d * d;
            let m = [(b * c - d * s) * w / det, (a * s - d * c) * w / det];
            let x = field(&[m[0], m[1], c, s, 0.0]);
            x.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
        });
        assert!(near.fold(f64::INFINITY, f64::min) < 5e-3, "{one:#}");
    }
    assert!(signs[0] > 0 && signs[1] > 0, "{low:#?}");
    let text = lie(&format!("equilibria {}", path.display())).ok().stdout;
    for what in [
        "almost-Poisson",
        "rank of the bracket: 2, and 4 generically",
    ] {
        assert!(text.contains(what), "{text}");
    }
}

/// Without a potential a line of states is at rest, and an initial state on it is taken. On a leaf of a Poisson bracket it is refused where
/// the rank drops, with the ranks.
#[test]
fn an_initial_state_where_the_rank_drops() {
    let folder = folder();
    let mut body = json!({
        "format": 1,
        "name": "susl",
        "algebra": "so(3)",
        "state": ["m1", "m2", "m3"],
        "hamiltonian": KINETIC,
        "constraint": ["e3 = 0"],
        "initial": ["-17/20", "-1/4"]
    });
    let path = written(folder.path(), &body);
    for options in ["", "--initial 4/5,1"] {
        let all = found(&path, options);
        let families = all["lower_rank"].as_array().into_iter().flatten();
        let families: Vec<&Value> = families
            .filter(|one| one["family_dimension"] == 1)
            .collect();
        assert_eq!(families.len(), 2, "{all:#}");
        for one in families {
            let state = numbers(&one["state"]);
            assert!((state[0] / 8.0 - state[1] / 10.0).abs() < 1e-14, "{one:#}");
            if !options.is_empty() {
                assert!((state[1].abs() - 1.0).abs() < 1e-9, "{one:#}");
            }
        }
    }
    let body = body.as_object_mut().expect("an object");
    body.remove("constraint");
    body["initial"] = json!([0, 0, 0]);
    let path = written(folder.path(), &body.clone().into());
    let refused = lie(&format!("equilibria {}", path.display()));
    let refused = refused.error("domain", "command line: --initial");
    let why = "the rank of the bracket is 0 there and 2 generically";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
}

/// A body whose charges change the brackets, `[J_i, J_j] = J_k - (k_i + k_j - k_k) P_k`: the Casimirs that are found differ by `(k2 - k3) |g|^2`, and
/// depend on each other in all states where k2 = k3, though the rank is 4 there as elsewhere.
#[test]
fn casimirs_that_depend_on_each_other_are_no_small_leaf() {
    let folder = folder();
    let path = written(
        folder.path(),
        &json!({
            "format": 1,
            "name": "charged",
            "algebra": {
                "basis": ["J1", "J2", "J3", "P1", "P2", "P3"],
                "brackets": [
                    "[J1, J2] = J3 - (k1 + k2 - k3)*P3", "[J2, J3] = J1 - (k2 + k3 - k1)*P1",
                    "[J3, J1] = J2 - (k3 + k1 - k2)*P2", "[J1, P2] = P3", "[J1, P3] = -P2",
                    "[J2, P3] = P1", "[J2, P1] = -P3", "[J3, P1] = P2", "[J3, P2] = -P1"
                ]
            },
            "parameters": {
                "k1": { "default": "1/3", "exact": true },
                "k2": { "default": "1/5", "exact": true },
                "k3": { "default": "1/2", "exact": true }
            },
            "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
            "hamiltonian": "m1^2/2 + m2^2/3 + m3^2 + g3",
            "initial": ["1/2", "-1/3", "2/5", "3/5", "0", "4/5"]
        }),
    );
    let control = found(&path, "");
    assert!(
        control["equilibria"]
            .as_array()
            .is_some_and(|all| !all.is_empty())
    );
    let refused = lie(&format!("equilibria {} --param k3=1/5", path.display()));
    let refused = refused.error("domain", "command line: SPEC");
    let why = "C1, C2 of charged depend on each other in all states";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
}
