//! `canonical2` to `canonical6`: Gauss methods in coordinates in which the bracket is constant, on the state as it was declared.

use crate::common::{folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const GUIDING_CENTRE: &str = "specs/brackets/guiding_centre.json";

fn written(folder: &Path, spec: &Value) -> String {
    let name = spec["name"].as_str().expect("a name");
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).expect("written");
    path.display().to_string()
}

/// What `lie verify` measures of methods.
fn verified(spec: &str, methods: &str) -> Value {
    let verify = lie(&format!("verify {spec} --methods {methods} --quiet --json")).ok();
    let report: Value = serde_json::from_str(&verify.stdout).expect("JSON");
    assert_eq!(report["failed"], 0, "{report:#}");
    report["methods"].clone()
}

/// The last row of a run without that of the time, by names of columns.
fn end(spec: &str, flags: &str, names: &[&str]) -> Vec<f64> {
    let run = lie(&format!("run {spec} {flags} --quiet")).ok();
    let (header, rows) = run.csv();
    let last = rows.last().expect("rows");
    let place = |name: &&str| header.iter().position(|column| column == *name);
    let places = names.iter().map(|name| place(name).expect("a column"));
    places.map(|place| last[place]).collect()
}

/// Orders, and Poisson defects at round-off. The control is Gauss
/// collocation in the declared coordinates.
#[test]
fn steps_of_a_guiding_centre_are_poisson_maps_of_their_order() {
    let methods = verified(GUIDING_CENTRE, "canonical2,canonical4,canonical6,gauss4");
    let defect = |id: &str| {
        let measured = &methods[id]["Poisson"]["measured"];
        measured.as_f64().expect("a number")
    };
    for id in ["canonical2", "canonical4", "canonical6"] {
        assert!(defect(id) < 1e-13, "{id}: {:e}", defect(id));
    }
    assert!(defect("gauss4") > 1e-9, "{:e}", defect("gauss4"));
}

/// Two pairs, one of which depends on a Casimir, beside a constant one, with forces and a parameter; in the second spec the integrals are
/// coordinates, written by hand.
fn pairs() -> [Value; 2] {
    let declared = json!({
        "format": 1, "name": "Pairs", "state": ["x", "p", "q", "y", "c", "v", "u"],
        "parameters": {"k": "1/5"},
        "poisson": ["{x, y} = 2*exp(-y)/(1 + x^2)", "{v, u} = k/(1 + c^2 + u)", "{q, p} = 1"],
        "hamiltonian": "x^2/2 + y^2 + p^2/2 + q^2/3 + x*q*y/5 + u^2/2 + v^2 + u*v*x/7",
        "forces": {"y": "-k*y", "x": "k*cos(t)"},
        "initial": ["2/5", "1/3", "-1/4", "1/2", "1/6", "-1/3", "3/4"]
    });
    let mut by_hand = declared.clone();
    by_hand["name"] = json!("ByHand");
    by_hand["state"] = json!(["x", "p", "q", "Y", "c", "v", "U"]);
    by_hand["poisson"] = json!(["{x, Y} = 2", "{v, U} = k", "{q, p} = 1"]);
    by_hand["let"] = json!([
        "y = log(Y/(1 + x^2))",
        "u = sqrt((1 + c^2)^2 + 2*U) - 1 - c^2"
    ]);
    by_hand["forces"] = json!({"Y": "-k*y*Y + 2*x*exp(y)*k*cos(t)", "x": "k*cos(t)"});
    by_hand["initial"] = json!([
        "2/5",
        "1/3",
        "-1/4",
        "29*exp(1/2)/25",
        "1/6",
        "-1/3",
        "37/48 + 9/32"
    ]);
    by_hand["observables"] = json!({"y": "y", "u": "u"});
    [declared, by_hand]
}

/// The steps are those of Gauss collocation in the coordinates, at a step at which its error is large.
#[test]
fn steps_are_those_of_gauss_in_the_coordinates() {
    let folder = folder();
    let [declared, by_hand] = pairs().map(|spec| written(folder.path(), &spec));
    let names = ["x", "p", "q", "y", "c", "v", "u"];
    for (own, gauss) in [
        ("canonical2", "midpoint"),
        ("canonical4", "gauss4"),
        ("canonical6", "gauss6"),
        ("compose4(canonical2)", "compose4(midpoint)"),
    ] {
        let run = |spec: &str, method: &str| {
            let flags = format!("--method {method} --step 0.2 --until 4");
            end(spec, &flags, &names)
        };
        let (here, there, otherwise) = (
            run(&declared, own),
            run(&by_hand, gauss),
            run(&declared, gauss),
        );
        for (k, name) in names.iter().enumerate() {
            let off = (here[k] - there[k]).abs();
            assert!(off < 1e-11, "{own}, {name}: {} and {}", here[k], there[k]);
        }
        let off = here.iter().zip(&otherwise).map(|(a, b)| (a - b).abs());
        assert!(
            off.fold(0.0, f64::max) > 1e-7,
            "{own} in declared coordinates"
        );
    }
}

/// On a log-canonical bracket they are those in the coordinates of `lie canonical`.
#[test]
fn steps_of_species_are_those_in_logarithms() {
    let folder = folder();
    let spec = "specs/lotka_volterra.json";
    let out = folder.path().join("logarithms.json");
    lie(&format!("canonical {spec} --out {}", out.display())).ok();
    let names = ["y1", "y2", "y3"];
    let run = |spec: &str, method: &str| {
        let flags = format!("--method {method} --step 0.1 --until 20");
        end(spec, &flags, &names)
    };
    let (here, there) = (
        run(spec, "canonical4"),
        run(&out.display().to_string(), "gauss4"),
    );
    for (a, b) in here.iter().zip(&there) {
        assert!((a - b).abs() < 1e-11, "{a} and {b}");
    }
    let defects = verified(spec, "canonical4,gauss4");
    let defect = |id: &str| {
        defects[id]["Poisson"]["measured"]
            .as_f64()
            .expect("a number")
    };
    assert!(defect("canonical4") < 1e-13 && defect("gauss4") > 1e-9);
}

/// `lie canonical` writes pairs whose y is a function of the integral in closed form, on the side of the initial state; the motion is the same.
#[test]
fn closed_inverses_have_the_same_motion() {
    let folder = folder();
    let motion = |spec: &Value, names: &[&str]| {
        let path = written(folder.path(), spec);
        let out = folder.path().join("out.json");
        if out.exists() {
            std::fs::remove_file(&out).expect("removed");
        }
        lie(&format!("canonical {path} --out {}", out.display())).ok();
        let flags = "--method gauss16 --step 0.02 --until 1";
        let (here, there) = (
            end(&path, flags, names),
            end(&out.display().to_string(), flags, names),
        );
        for ((a, b), name) in here.iter().zip(&there).zip(names) {
            assert!((a - b).abs() < 1e-12, "{spec}, {name}: {a} and {b}");
        }
    };
    let [declared, _] = pairs();
    motion(&declared, &["x", "p", "q", "y", "c", "v", "u"]);
    for (density, initial) in [
        ("1 + x^2", -0.5),
        ("2 + y", -0.5),
        // the side where B is negative, and one where the coefficient of y vanishes on the way
        ("x + y/2", -1.5),
        ("3 + x*y", 0.5),
        ("(2*y + 1)^2", -1.5),
        ("(2*y + 1)^3*exp(x)", -1.5),
        ("sqrt(2 + y)", -0.5),
        ("cosh(1 - y)", 0.25),
        ("exp(-2*y)*cos(x)", 0.25),
    ] {
        let spec = json!({
            "format": 1, "name": "Closed", "state": ["x", "y"],
            "poisson": [format!("{{x, y}} = 1/({density})")],
            "hamiltonian": "x^2/4 + y^2/5 + x*y/7 + y/3",
            "forces": {"x": "-x/9", "y": "sin(t)/8"},
            "initial": ["-1/3", initial]
        });
        motion(&spec, &["x", "y"]);
    }
}

/// The energy has no drift, and is as that of Gauss collocation in the declared coordinates, which keeps it here because the system is
/// reversible.
#[test]
fn the_energy_of_a_guiding_centre_does_not_drift() {
    let change = |method: &str| {
        let run = lie(&format!(
            "run {GUIDING_CENTRE} --method {method} --step 0.2 --until 1000 --every 10 --quiet"
        ))
        .ok();
        let (header, rows) = run.csv();
        let place = header.iter().position(|name| name == "energy");
        let place = place.expect("a column");
        let changes = rows.iter().map(|row| row[place] - rows[0][place]);
        let changes: Vec<f64> = changes.collect();
        let tenth = changes.len() / 10;
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let drift = mean(&changes[changes.len() - tenth..]) - mean(&changes[..tenth]);
        let largest = changes.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        (largest, drift.abs())
    };
    for (method, bound) in [("canonical2", 2e-3), ("canonical4", 2e-6)] {
        let (largest, drift) = change(method);
        assert!(largest < bound, "{method}: {largest:e}");
        assert!(drift < largest / 10.0, "{method}: {drift:e} of {largest:e}");
    }
}

/// What comes to where the integral folds ends there: `Y = y^2/2` has two sides, and `y' = -1/y` comes to their border at t = y^2/2.
#[test]
fn no_step_crosses_to_another_side() {
    let folder = folder();
    let fold = json!({
        "format": 1, "name": "Fold", "state": ["x", "y"], "poisson": ["{x, y} = 1/y"],
        "hamiltonian": "x", "initial": [0, 1]
    });
    let fold = written(folder.path(), &fold);
    let run = lie(&format!(
        "run {fold} --method canonical4 --step 0.03 --until 2 --quiet"
    ));
    assert_ne!(run.code, Some(0), "{}", run.stderr);
    let (_, rows) = run.csv();
    let (last, before) = (rows.last().expect("rows"), rows.len());
    assert!(rows.iter().all(|row| row[2] > 0.0), "{last:?}");
    assert!(before > 12 && last[0] < 0.5, "{last:?}");
    let exact = (1.0 - 2.0 * last[0]).sqrt();
    assert!((last[2] - exact).abs() < 1e-13, "{last:?}, {exact}");
}

#[test]
fn what_has_no_such_coordinates_says_why() {
    for (spec, why, help) in [
        (
            "canonical_pendulum",
            "constant in the coordinates that are declared",
            "`gauss4`",
        ),
        ("brackets/nambu", "no coordinates are known", "`k-hj4`"),
        ("se3_heavy_top", "no coordinates are known", "`generating4`"),
    ] {
        let run = lie(&format!(
            "run specs/{spec}.json --method canonical4 --until 1"
        ));
        assert_eq!(run.code, Some(2), "{spec}");
        for text in [why, help] {
            assert!(run.stderr.contains(text), "{spec}: {}", run.stderr);
        }
    }
}

#[test]
fn the_report_names_the_class_and_the_integral() {
    let check = lie(&format!("check {GUIDING_CENTRE}")).ok();
    let line = check.stdout.lines().find(|line| line.contains("bracket: "));
    let line = line.expect("a class");
    for part in [
        "conjugate pairs",
        "in the place of y beside x",
        "`canonical2` to `canonical6`",
    ] {
        assert!(line.contains(part), "{line}");
    }
    let path = PathBuf::from(GUIDING_CENTRE);
    let json = lie(&format!("check {} --json", path.display())).ok();
    let report: Value = serde_json::from_str(&json.stdout).expect("JSON");
    assert_eq!(report["bracket_class"], "conjugate pairs");
}

#[test]
fn an_inverse_that_is_not_closed_names_the_method() {
    let run = lie(&format!("canonical {GUIDING_CENTRE}"));
    assert_eq!(run.code, Some(2));
    for text in ["`y` has no closed form", "`canonical4`"] {
        assert!(run.stderr.contains(text), "{}", run.stderr);
    }
}

/// A momentum of the field `p + q y`, whose integral is quadratic with parameters: from y = -3 on the root and the linear term cancel, and at
/// y = -2 their sum is 0.
#[test]
fn the_inverse_of_a_quadratic_integral_does_not_cancel() {
    let folder = folder();
    let spec = json!({
        "format": 1, "name": "Linear", "state": ["x", "y"], "poisson": ["{x, y} = 1/(p + q*y)"],
        "parameters": { "p": 1, "q": 1 }, "hamiltonian": "x", "initial": [0, -3]
    });
    let spec = written(folder.path(), &spec);
    let new = folder.path().join("new.json");
    lie(&format!("canonical {spec} --out {}", new.display())).ok();
    let y = |path: &str, until: &str| {
        let flags = format!("--method gauss10 --step 0.5 --until {until}");
        end(path, &flags, &["y"])[0]
    };
    // y' = -1/(1 + y), so that y + y^2/2 = 3/2 - t
    for (until, exact) in [("1", -1.0 - 2.0_f64.sqrt()), ("1.5", -2.0)] {
        let found = y(&new.display().to_string(), until);
        assert!((found - exact).abs() < 1e-13, "t = {until}: {found}");
    }
}

/// A force by the name of a vector acts on what a new coordinate is a function of.
#[test]
fn forces_on_vectors_are_refused_where_coordinates_mix() {
    let folder = folder();
    let spec = |forces: Value| {
        json!({
            "format": 1, "name": "Pushed", "state": ["x", "y", "z", "w"],
            "poisson": ["{x, y} = 1/(1 + x^2)", "{z, w} = 1"],
            "vectors": { "a": ["x", "z", "w"] },
            "hamiltonian": "x^2/2 + y^2/2 + z^2 + w^2/3", "forces": forces, "initial": [0.3, 0.1, 0.2, -0.4]
        })
    };
    let by_vector = written(folder.path(), &spec(json!({ "a": "-a/3" })));
    let refused = lie(&format!("canonical {by_vector}"));
    assert_eq!(refused.code, Some(2), "{}", refused.stdout);
    assert!(
        refused
            .stderr
            .contains("the force on `a` is one on several coordinates"),
        "{}",
        refused.stderr
    );
    let before = end(
        &by_vector,
        "--method gauss16 --step 0.05 --until 1",
        &["x", "y", "z", "w"],
    );
    let each = json!({ "x": "-x/3", "z": "-z/3", "w": "-w/3" });
    let by_coordinates = written(folder.path(), &spec(each));
    let new = folder.path().join("new.json");
    lie(&format!(
        "canonical {by_coordinates} --out {}",
        new.display()
    ))
    .ok();
    let after = end(
        &new.display().to_string(),
        "--method gauss16 --step 0.05 --until 1",
        &["x", "y", "z", "w"],
    );
    for (a, b) in before.iter().zip(&after) {
        assert!((a - b).abs() < 1e-13, "{before:?} {after:?}");
    }
}
