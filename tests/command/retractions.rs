//! Retractions of the user's own: what is checked of them, and whether their steps are what they claim.

use crate::common::{command, folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn written(folder: &Path, spec: &Value) -> PathBuf {
    let name = spec["name"].as_str().expect("a name");
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// A body whose Hamiltonian is no quadratic form.
fn body(name: &str, retraction: &Value) -> Value {
    json!({
        "format": 1,
        "name": name,
        "algebra": {
            "basis": ["a", "b", "c"],
            "matrices": {
                "a": [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
                "b": [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
                "c": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
            }
        },
        "state": ["x", "y", "z"],
        "hamiltonian": "x^2/4 + y^2/2 + 3*z^2/4 + x*y^2*z/3 + x^3/5 + y/4",
        "retraction": retraction,
        "initial": ["3/5", "-1/2", "7/10"]
    })
}

/// The Cayley map of rotations, in closed form.
fn cayley() -> Value {
    let d = "(1 + (a^2 + b^2 + c^2)/4)";
    let over = |entry: &str| format!("({entry})/{d}");
    let diagonal = |entry: &str| format!("1 - ({entry})/(2*{d})");
    json!({ "map": [
        [diagonal("b^2 + c^2"), over("a*b/2 - c"), over("a*c/2 + b")],
        [over("a*b/2 + c"), diagonal("a^2 + c^2"), over("b*c/2 - a")],
        [over("a*c/2 - b"), over("b*c/2 + a"), diagonal("a^2 + b^2")]
    ]})
}

/// Turns about the three axes, one after the other, by a part of each angle.
fn turns(part: &str) -> [[String; 3]; 3] {
    let [a, b, c] = ["a", "b", "c"].map(|angle| format!("({part}*{angle})"));
    let text = |entry: &str| {
        let entry = entry
            .replace("sa", &format!("sin{a}"))
            .replace("ca", &format!("cos{a}"));
        let entry = entry
            .replace("sb", &format!("sin{b}"))
            .replace("cb", &format!("cos{b}"));
        entry
            .replace("sc", &format!("sin{c}"))
            .replace("cc", &format!("cos{c}"))
    };
    [
        ["cb*cc", "-cb*sc", "sb"],
        ["ca*sc + sa*sb*cc", "ca*cc - sa*sb*sc", "-sa*cb"],
        ["sa*sc - ca*sb*cc", "sa*cc + ca*sb*sc", "ca*cb"],
    ]
    .map(|row| row.map(text))
}

/// These turns from a point in the middle of the step to its two ends.
fn two_ended() -> Value {
    json!({ "map": turns("1/2"), "second": turns("-1/2") })
}

/// A heavy top on se(3), turned and moved from the middle.
fn top() -> Value {
    let matrix = |i: usize, j: usize, k: usize, l: usize| {
        let mut rows = [[0; 4]; 4];
        rows[i][j] = -1;
        rows[k][l] = 1;
        rows
    };
    let shift = |i: usize| {
        let mut rows = [[0; 4]; 4];
        rows[i][3] = 1;
        rows
    };
    let end = |part: &str| {
        let mut rows: Vec<Vec<String>> = turns(part).map(Vec::from).into();
        for (row, name) in rows.iter_mut().zip(["u", "v", "w"]) {
            row.push(format!("{part}*{name}"));
        }
        rows.push(["0", "0", "0", "1"].map(String::from).into());
        rows
    };
    json!({
        "format": 1,
        "name": "Top",
        "algebra": {
            "basis": ["a", "b", "c", "u", "v", "w"],
            "matrices": {
                "a": matrix(1, 2, 2, 1), "b": matrix(2, 0, 0, 2), "c": matrix(0, 1, 1, 0),
                "u": shift(0), "v": shift(1), "w": shift(2)
            }
        },
        "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
        "hamiltonian": "m1^2/2 + m2^2/3 + m3^2/4 + g3 + g1/5",
        "retraction": { "map": end("1/2"), "second": end("-1/2") },
        "initial": ["3/5", "-1/2", "7/10", "1/10", "2/5", "9/10"]
    })
}

#[test]
fn steps_are_symmetric_poisson_maps_of_their_order() {
    let folder = folder();
    let mut right = body("Right", &two_ended());
    right["invariance"] = json!("right");
    for spec in [
        body("Cayley", &cayley()),
        body("TwoEnded", &two_ended()),
        right,
        top(),
    ] {
        let path = written(folder.path(), &spec);
        let path = path.to_string_lossy();
        let check = lie(&format!("check {path}")).ok();
        assert!(
            check.stdout.contains("retraction: tau(x) = "),
            "{}",
            check.stdout
        );
        let spec =
            ["lie-midpoint", "compose4(lie-midpoint)"].map(|id| format!("{id} --retraction spec"));
        let methods = format!("{},{},rk4", spec[0], spec[1]);
        let arguments = ["verify", &path, "--methods", &methods, "--quiet", "--json"];
        let verify = command(arguments).output().expect("it runs");
        let report: Value = serde_json::from_slice(&verify.stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{path}: {report:#}");
        let measured =
            |method: &str, what: &str| report["methods"][method][what]["measured"].as_f64();
        for (method, order) in spec.iter().zip([2.0, 4.0]) {
            let defect = measured(method, "Poisson").expect("a number");
            assert!(defect < 1e-13, "{path}, {method}: {defect:e}");
            let slope = measured(method, "order").expect("a number");
            assert!((slope - order).abs() < 0.2, "{path}, {method}: {slope}");
        }
        // the control
        assert!(
            measured("rk4", "Poisson") > Some(1e-10),
            "{path}: {report:#}"
        );
    }
}

/// State and group element of a run, row by row.
fn run(path: &Path, retraction: &str) -> Vec<Vec<f64>> {
    let path = path.display();
    let call = format!(
        "run {path} --method lie-midpoint --retraction {retraction} --step 0.1 --until 5 --group matrix --quiet"
    );
    let (names, rows) = lie(&call).ok().csv();
    let first = names
        .iter()
        .position(|name| name == "g11")
        .expect("a group element");
    let columns = |row: Vec<f64>| [&row[1..4], &row[first..first + 9]].concat();
    rows.into_iter().map(columns).collect()
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let entries = a.iter().flatten().zip(b.iter().flatten());
    entries.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What is declared is the Cayley map: so are the steps, and the motion on the group, of both invariances.
#[test]
fn a_declared_cayley_map_makes_the_steps_of_the_built_in_one() {
    let folder = folder();
    for invariance in ["left", "right"] {
        let mut spec = body("Cayley", &cayley());
        spec["invariance"] = json!(invariance);
        let path = written(folder.path(), &spec);
        let (declared, built_in) = (run(&path, "spec"), run(&path, "cayley"));
        assert_eq!(declared.len(), 51);
        let off = difference(&declared, &built_in);
        assert!(off < 1e-12, "{invariance}: {off:e}");
        // the control: another retraction makes other steps
        let other = difference(&declared, &run(&path, "exp"));
        assert!(other > 1e-5, "{invariance}: {other:e}");
    }
}

/// Of a reduced Lagrangian `variational2` goes along the declared map: where that is the one of Cayley, by the steps of the equation in its
/// coordinates.
#[test]
fn variational_steps_of_a_lagrangian_go_along_the_declared_map() {
    let folder = folder();
    let mut spec = body("Lagrangian", &cayley());
    let own = spec.as_object_mut().expect("an object");
    own.remove("hamiltonian");
    own.insert("velocity".into(), json!(["a", "b", "c"]));
    own.insert(
        "lagrangian".into(),
        json!("a^2 + b^2/2 + c^2/3 + a^4/9 + a*b/5 + c/4"),
    );
    let path = written(folder.path(), &spec);
    let end = |retraction: &str| {
        let path = path.display();
        let call = format!(
            "run {path} --method variational2 --retraction {retraction} --step 0.1 --until 5 --quiet"
        );
        let (_, rows) = lie(&call).ok().csv();
        let rows = rows.into_iter().map(|row| row[1..4].to_vec());
        rows.collect::<Vec<Vec<f64>>>()
    };
    let declared = end("spec");
    let off = difference(&declared, &end("cayley"));
    assert!(off < 1e-12, "{off:e}");
    // the control
    assert!(difference(&declared, &end("exp")) > 1e-5);
    let verify = lie(&format!(
        "verify {} --methods variational2 --quiet --json",
        path.display()
    ))
    .ok();
    let report: Value = serde_json::from_str(&verify.stdout).expect("JSON");
    assert_eq!(report["failed"], 0, "{report:#}");
    let measured = &report["methods"]["variational2 --retraction spec"]["Poisson"]["measured"];
    assert!(measured.as_f64().expect("a number") < 1e-13, "{report:#}");
}

/// The element of a step belongs to the momenta: `Ad*_(g^-1) mu` stays.
#[test]
fn the_group_element_keeps_the_spatial_momentum() {
    let folder = folder();
    for (invariance, sign) in [("left", 1), ("right", -1)] {
        let mut spec = body("TwoEnded", &two_ended());
        spec["invariance"] = json!(invariance);
        let path = written(folder.path(), &spec);
        let rows = run(&path, "spec");
        let spatial = |row: &[f64]| -> Vec<f64> {
            let (mu, g) = row.split_at(3);
            let entry = |i: usize, j: usize| {
                if sign == 1 {
                    g[3 * i + j]
                } else {
                    g[3 * j + i]
                }
            };
            (0..3)
                .map(|i| (0..3).map(|j| entry(i, j) * mu[j]).sum())
                .collect()
        };
        let first = spatial(&rows[0]);
        for row in &rows {
            let now = spatial(row);
            let off = now.iter().zip(&first).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-13, "{invariance}: {row:?}");
        }
    }
}

#[test]
fn what_is_no_retraction_is_refused() {
    let folder = folder();
    let mut off = two_ended();
    off["second"] = json!(turns("-1/3"));
    let plane = |x: &str| json!({ "map": [["1", "0", "0"], ["0", "1", x], ["0", "0", "1"]] });
    for (retraction, message) in [
        (
            json!({ "map": turns("1") }),
            "tau(x) tau(-x) is not the identity",
        ),
        (
            json!({ "map": turns("2") }),
            "the derivative of the retraction at 0 along `a`",
        ),
        (off, "the derivative of the retraction at 0"),
        (plane("a/sqrt(b^2 + c^2)"), "has no value where x is 0"),
        (
            plane("1"),
            "`map` is not the identity where x is 0: entry 2, 3",
        ),
        (
            json!({ "map": [["1"]] }),
            "the matrices of the algebra have 3 rows and columns",
        ),
        (json!({ "map": turns("q") }), "unknown symbol `q`"),
        (
            json!({ "map": turns("x") }),
            "`x` cannot stand here: a retraction is a function of an element of the algebra",
        ),
        (json!({ "second": turns("1") }), "has no `map`"),
    ] {
        let path = written(folder.path(), &body("Wrong", &retraction));
        let checked = lie(&format!("check {}", path.display()));
        assert_eq!(checked.code, Some(2), "{message}: {}", checked.stdout);
        assert!(
            checked.stderr.contains(message),
            "{message}: {}",
            checked.stderr
        );
    }
    // series up to the second term
    let rows = json!([
        ["1 - (b^2 + c^2)/2", "a*b/2 - c", "a*c/2 + b"],
        ["a*b/2 + c", "1 - (a^2 + c^2)/2", "b*c/2 - a"],
        ["a*c/2 - b", "b*c/2 + a", "1 - (a^2 + b^2)/2"]
    ]);
    let path = written(folder.path(), &body("Series", &json!({ "map": rows })));
    let checked = lie(&format!("check {}", path.display()));
    assert!(
        checked.stderr.contains("leaves the group"),
        "{}",
        checked.stderr
    );
}

#[test]
fn where_a_retraction_does_not_apply_it_is_said() {
    let folder = folder();
    let mut plain = body("Plain", &cayley());
    plain
        .as_object_mut()
        .expect("an object")
        .remove("retraction");
    let mut pushed = body("Pushed", &cayley());
    pushed["forces"] = json!({ "x": "-x/10" });
    for (spec, message) in [
        (plain, "declare `retraction`"),
        (pushed, "a retraction is for H on an algebra alone"),
    ] {
        let path = written(folder.path(), &spec);
        let run = lie(&format!(
            "run {} --method lie-midpoint --retraction spec --step 0.1 --until 1",
            path.display()
        ));
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
    let mut timed = body("Timed", &cayley());
    timed["hamiltonian"] = json!("x^2 + y*sin(t)");
    let path = written(folder.path(), &timed);
    let checked = lie(&format!("check {}", path.display()));
    assert!(
        checked
            .stderr
            .contains("a retraction is for H on an algebra alone"),
        "{}",
        checked.stderr
    );
}
