//! `lie equilibria` far from the scale of the initial state.

use serde_json::{Value, json};

use crate::common::{folder, lie};

fn found(call: &str) -> Value {
    let run = lie(&format!("equilibria {call} --json")).ok();
    serde_json::from_str(&run.stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let entries = value.as_array().expect("an array").iter();
    entries
        .map(|entry| entry.as_f64().expect("a number"))
        .collect()
}

/// The axes of the rigid body at momenta from 10^-15 to 10^15: six equilibria, four of them stable, and of the others the rate is half the
/// momentum, as with moments 2, 1, 2/3.
#[test]
fn a_level_tells_its_own_scale() {
    for level in ["1", "1e16", "1e-16", "1e30", "1e-30"] {
        let all = found(&format!(
            "specs/so3_free_rigid_body.json --casimir norm2={level}"
        ));
        let size = level.parse::<f64>().expect("a number").sqrt();
        let equilibria = all["equilibria"].as_array().expect("a list");
        assert_eq!(equilibria.len(), 6, "{level}: {all:#}");
        assert_eq!(
            (&all["paths"]["real"], &all["paths"]["lost"]),
            (&json!(6), &json!(0))
        );
        let mut seen = [0; 6];
        for one in equilibria {
            let state = numbers(&one["state"]);
            let axis = (0..3).find(|i| state[*i] != 0.0).expect("an axis");
            assert!(
                (state[axis].abs() / size - 1.0).abs() < 1e-14,
                "{level}: {one:#}"
            );
            assert_eq!(
                state.iter().filter(|x| **x == 0.0).count(),
                2,
                "{level}: {one:#}"
            );
            seen[2 * axis + usize::from(state[axis] > 0.0)] += 1;
            let growth = numbers(&one["eigenvalues"][0])[0] / size;
            let rate = if axis == 1 { 0.5 } else { 0.0 };
            assert!((growth - rate).abs() < 1e-12, "{level}: {one:#}");
            assert_eq!(
                (&one["proven"], one["stability"] == "unstable"),
                (&json!(true), axis == 1)
            );
        }
        assert_eq!(seen, [1; 6], "{level}");
    }
}

/// `p^2/2 - q^2/2 + q^4/4 + q/10` in units from 10^-12 to 10^12 of the initial state: the roots of `q^3 - q + 1/10`, and no others.
#[test]
fn units_hide_no_equilibrium() {
    let folder = folder();
    let cubic = |q: f64| q * q * q - q + 0.1;
    let root = |mut a: f64, mut b: f64| {
        for _ in 0..200 {
            let c = 0.5 * (a + b);
            if cubic(c) * cubic(a) > 0.0 {
                a = c
            } else {
                b = c
            }
        }
        a
    };
    let mut roots = [root(-2.0, -0.6), root(-0.5, 0.5), root(0.6, 2.0)];
    roots.sort_by(f64::total_cmp);
    for power in [0, 6, -6, 12, -12, 5] {
        let [q, p] = ["q", "p"].map(|x| match power {
            power if power < 0 => format!("({x}*10^{})", -power),
            power => format!("({x}/10^{power})"),
        });
        let path = folder.path().join("units.json");
        let spec = json!({
            "format": 1,
            "name": "Units",
            "poisson": ["{q, p} = 1"],
            "state": ["q", "p"],
            "hamiltonian": format!("{p}^2/2 - {q}^2/2 + {q}^4/4 + {q}/10"),
            "initial": [1.2, 0.1]
        });
        std::fs::write(&path, spec.to_string()).expect("written");
        let all = found(&path.display().to_string());
        let equilibria = all["equilibria"].as_array().expect("a list").iter();
        let mut states: Vec<Vec<f64>> = equilibria.map(|one| numbers(&one["state"])).collect();
        states.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(states.len(), 3, "{power}: {all:#}");
        for (state, root) in states.iter().zip(roots) {
            let off = state[0] / 10.0_f64.powi(power) - root;
            assert!(
                off.abs() < 1e-12 && state[1] == 0.0,
                "{power}: {state:?} {root}"
            );
        }
    }
}

/// Where coordinates have scales that are far apart, paths find nothing, and nothing is said to be complete: a top with a force of 10^-8
/// whose momentum is 10^8 along it sleeps.
#[test]
fn nothing_is_complete_where_scales_differ() {
    let complete = "no isolated equilibrium is missing";
    let text = |options: &str| {
        lie(&format!("equilibria specs/se3_heavy_top.json {options}"))
            .ok()
            .stdout
    };
    assert!(text("").contains(complete));
    for options in ["--casimir length2=1e-16", "--casimir length2=1e16"] {
        let text = text(options);
        assert!(!text.contains(complete), "{options}: {text}");
    }
}

/// Branches over the first moment at any level: each axis changes its stability where the moment passes 2/3 and 1, and on the middle axis i the
/// rate is `|m| sqrt((I_i - I_j) (I_k - I_i)/(I_j I_k))/I_i`.
#[test]
fn branches_are_followed_at_the_scale_of_the_level() {
    for level in ["1", "1e16", "1e-16"] {
        let call =
            format!("specs/so3_free_rigid_body.json --casimir norm2={level} --param I1=0.5:2.5:21");
        let all = found(&call);
        let size = level.parse::<f64>().expect("a number").sqrt();
        let branches = all["branches"].as_array().expect("a list").iter();
        let axes: Vec<&Value> = branches
            .filter(|one| one["family_dimension"] == 0)
            .collect();
        assert_eq!(axes.len(), 6, "{level}");
        let mut changes = 0;
        for branch in axes {
            let points = branch["points"].as_array().expect("a list");
            assert_eq!(points.len(), 21, "{level}");
            for point in points.iter().filter(|point| point["threshold"].is_null()) {
                let state = numbers(&point["state"]);
                let i = (0..3)
                    .find(|i| state[*i].abs() > 0.5 * size)
                    .expect("an axis");
                assert!(
                    (state[i].abs() / size - 1.0).abs() < 1e-12,
                    "{level}: {point}"
                );
                let moments = [point["value"].as_f64().expect("a number"), 1.0, 2.0 / 3.0];
                let [j, k] = [(i + 1) % 3, (i + 2) % 3].map(|k| moments[k]);
                let square = (moments[i] - j) * (k - moments[i]) / (j * k);
                let rate = square.max(0.0).sqrt() / moments[i];
                let growth = point["growth"].as_f64().expect("a number") / size;
                assert!((growth - rate).abs() < 1e-7, "{level}: {point} {rate}");
            }
            for change in branch["changes"].as_array().expect("a list") {
                let at = change["value"].as_f64().expect("a number");
                let error = change["error"].as_f64().expect("a number");
                let off = (at - 1.0).abs().min((at - 2.0 / 3.0).abs());
                assert!(off <= error && error < 1e-9, "{level}: {change}");
                changes += 1;
            }
        }
        assert_eq!(changes, 8, "{level}");
    }
}
