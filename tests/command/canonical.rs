//! `lie canonical`: brackets that are constant in other coordinates.

use crate::common::{folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn written(folder: &Path, spec: &Value) -> PathBuf {
    let name = spec["name"].as_str().expect("a name");
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// The command on a spec; the path of what it writes.
fn canonical(path: &Path) -> PathBuf {
    let out = path.with_extension("canonical.json");
    lie(&format!(
        "canonical {} --out {}",
        path.display(),
        out.display()
    ))
    .ok();
    out
}

/// Every coordinate has a speed of its own, z on the side where it is negative, and forces act, with a parameter.
fn forced() -> Value {
    json!({
        "format": 1, "name": "Forced", "state": ["x", "y", "z"],
        "poisson": ["{x, y} = (1 + x)*y", "{y, z} = 2*y*(z - 2)", "{x, z} = -(1 + x)*(z - 2)/3"],
        "parameters": {"k": "1/10"},
        "let": ["r = x*y"],
        "hamiltonian": "x^2/3 + y + y^2/4 + z^2/2 + z",
        "forces": {"x": "-k*x", "z": "k*cos(t)"},
        "observables": {"r": "r"},
        "initial": ["3/10", "4/5", "1/2"]
    })
}

/// The last row, by the names of the columns.
fn end(path: &Path, names: &[&str]) -> Vec<f64> {
    let path = path.display();
    let run = lie(&format!(
        "run {path} --method gauss16 --step 0.02 --until 4 --quiet"
    ))
    .ok();
    let (header, rows) = run.csv();
    let last = rows.last().expect("rows");
    let place = |name: &&str| header.iter().position(|column| column == *name);
    let places = names.iter().map(|name| place(name).expect("a column"));
    places.map(|place| last[place]).collect()
}

#[test]
fn the_motion_is_the_same() {
    let folder = folder();
    let forced = written(folder.path(), &forced());
    for (path, names) in [
        (
            PathBuf::from("specs/lotka_volterra.json"),
            ["y1", "y2", "y3"],
        ),
        (forced, ["x", "z", "r"]),
    ] {
        let copy = folder.path().join(path.file_name().expect("a name"));
        if copy != path {
            std::fs::copy(&path, &copy).expect("copied");
        }
        let pairs = end(&copy, &names)
            .into_iter()
            .zip(end(&canonical(&copy), &names));
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-11, "{}: {a} and {b}", path.display());
        }
    }
}

/// The Poisson defect of `gauss4`.
fn defect(path: &Path) -> f64 {
    let verify = lie(&format!(
        "verify {} --methods gauss4 --quiet --json",
        path.display()
    ))
    .ok();
    let report: Value = serde_json::from_str(&verify.stdout).expect("JSON");
    assert_eq!(report["failed"], 0, "{report:#}");
    let measured = &report["methods"]["gauss4"]["Poisson"]["measured"];
    measured.as_f64().expect("a number")
}

/// Gauss methods are Poisson maps there, and keep the Casimir; in the declared coordinates they do neither.
#[test]
fn gauss_methods_are_poisson_maps() {
    let folder = folder();
    let path = folder.path().join("species.json");
    std::fs::copy("specs/lotka_volterra.json", &path).expect("copied");
    let [there, here] = [defect(&canonical(&path)), defect(&path)];
    assert!(there < 1e-14 && here > 1e-9, "{there:e}, {here:e}");
}

/// The integral over y has no closed inverse, that over x has one on either side of where B changes its sign: the motion is the same, and Gauss
/// methods are Poisson maps.
#[test]
fn the_other_coordinate_of_a_pair_is_replaced_where_only_that_has_an_inverse() {
    let folder = folder();
    for (name, x, centre) in [("Right", "1/4", "0"), ("Left", "-7/2", "4")] {
        let mut spec = json!({
            "format": 1, "name": name, "state": ["x", "y", "z"],
            "poisson": ["{x, y} = 2/(1 + x + y^2)"],
            "parameters": {"k": "1/10"},
            "hamiltonian": format!("(x + {centre})^2/3 + y^2/4 + x*y*z/90"),
            "initial": [x, "1/5", "1/2"]
        });
        let path = written(folder.path(), &spec);
        let out = canonical(&path);
        let text = std::fs::read_to_string(&out).expect("a spec");
        assert!(text.contains(r#""state": ["int_x","y","z"]"#), "{text}");
        if centre == "0" {
            let [there, here] = [&out, &path].map(|path| defect(path));
            assert!(there < 1e-14 && here > 1e-9, "{there:e}, {here:e}");
        }
        spec["name"] = json!(format!("{name}Forced"));
        spec["forces"] = json!({"x": "k*sin(t)", "y": "k*cos(t)"});
        let path = written(folder.path(), &spec);
        let pairs = end(&path, &["x", "y"])
            .into_iter()
            .zip(end(&canonical(&path), &["x", "y"]));
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-11, "{name}: {a} and {b}");
        }
    }
}

/// Functions of each coordinate that are not linear: the motion is the same on the side of the initial state, and Gauss methods are Poisson maps.
#[test]
fn integrals_of_each_coordinate_are_undone() {
    let folder = folder();
    for (name, [a, b, c], initial) in [
        ("Powers", ["1 + x^2", "y", "z^2"], ["3/10", "1", "7/10"]),
        ("Left", ["1/x", "sqrt(y)", "z^2"], ["-7/10", "1/2", "-3/5"]),
        (
            "Within",
            ["x*(1 - x)", "cosh(y)", "exp(-z)"],
            ["3/10", "1/2", "1/5"],
        ),
        (
            "Outside",
            ["x*(1 - x)", "1/cosh(y)", "z^2 - 2"],
            ["13/10", "1/2", "-2"],
        ),
        (
            "Turned",
            ["cos(x)^2", "sqrt(1 + y^2)", "sin(z)"],
            ["7/2", "-1/2", "-1"],
        ),
        (
            "Hyperbolic",
            ["sinh(x)", "tanh(y)", "cosh(z)^2"],
            ["-1/2", "1", "1/5"],
        ),
    ] {
        let spec = json!({
            "format": 1, "name": name, "state": ["x", "y", "z"],
            "poisson": [
                format!("{{x, y}} = ({a})*({b})/4"),
                format!("{{y, z}} = ({b})*({c})/2"),
                format!("{{x, z}} = -({a})*({c})/12")
            ],
            "hamiltonian": "x^2/3 + y^2/4 + z^2/5 + x*y*z/9",
            "initial": initial
        });
        let path = written(folder.path(), &spec);
        let out = canonical(&path);
        let names = ["x", "y", "z"];
        let pairs = end(&path, &names).into_iter().zip(end(&out, &names));
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-11, "{name}: {a} and {b}");
        }
        let [there, here] = [&out, &path].map(|path| defect(path));
        assert!(there < 1e-13 && here > 1e-11, "{name}: {there:e}, {here:e}");
    }
}

/// Columns stay in their order, names that are taken are avoided, and a method that does not apply any more is replaced.
#[test]
fn what_stays_and_what_is_replaced() {
    let folder = folder();
    let mut spec = forced();
    spec["functions"] = json!({"log_x": {"table": [[0, 0], [1, 1], [2, 3], [3, 4]]}});
    spec["run"] = json!({"method": "gonzalez", "tensor": "mean", "step": 0.1, "until": 1});
    let text = spec
        .to_string()
        .replace(r#""r":"r""#, r#""r":"r","a":"x + y""#);
    let path = folder.path().join("Forced.json");
    std::fs::write(&path, text).expect("written");
    let out = canonical(&path);
    let run = lie(&format!("run {} --quiet", out.display())).ok();
    let (header, _) = run.csv();
    let own: Vec<&str> = header.iter().map(String::as_str).collect();
    assert_eq!(own[1..4], ["log_x_", "log_y", "log_z"]);
    assert_eq!(own[own.len() - 5..], ["r", "a", "x", "y", "z"]);
    let written = std::fs::read_to_string(&out).expect("a spec");
    assert!(written.contains(r#""method":"gauss10""#), "{written}");
}

#[test]
fn what_has_no_such_coordinates_says_why() {
    let folder = folder();
    let refused = |spec: &str, why: &str| {
        let run = lie(&format!("canonical {spec}"));
        assert_eq!(run.code, Some(2), "{spec}");
        assert!(run.stderr.contains(why), "{spec}: {}", run.stderr);
    };
    refused(
        "specs/canonical_pendulum.json",
        "the bracket is constant in these coordinates",
    );
    refused("specs/brackets/nambu.json", "no coordinates are known");
    refused("specs/se3_heavy_top.json", "no coordinates are known");
    let mut resting = forced();
    resting["initial"] = json!([-1, 1, 1]);
    let resting = written(folder.path(), &resting);
    refused(&resting.display().to_string(), "the brackets of `x` vanish");
    let mut damped = forced();
    damped["dissipation"] = json!([{"kind": "double-bracket", "strength": "1/5"}]);
    let damped = written(folder.path(), &damped);
    refused(
        &damped.display().to_string(),
        "`dissipation` is declared in the coordinates",
    );
    let mut by_a_vector = forced();
    by_a_vector["vectors"] = json!({"m": ["x", "y", "z"]});
    by_a_vector["forces"] = json!({"m": "-m/10"});
    let by_a_vector = written(folder.path(), &by_a_vector);
    refused(
        &by_a_vector.display().to_string(),
        "the spec in the new coordinates is refused",
    );
    // nothing is written over
    let path = written(folder.path(), &forced());
    let out = canonical(&path);
    let again = lie(&format!(
        "canonical {} --out {}",
        path.display(),
        out.display()
    ));
    assert_eq!(again.code, Some(1));
    assert!(
        again.stderr.contains("choose another name"),
        "{}",
        again.stderr
    );
}
