//! First integrals and observables: columns of `lie run`, and what is said of those that are none.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common::{Run, folder, lie};
use serde_json::{Value, json};

/// Lagrange's top: the momentum about its own axis is constant beside the Casimirs.
fn top() -> Value {
    json!({
        "name": "LagrangeTop",
        "algebra": "se(3)",
        "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
        "parameters": { "I": 1, "J": "3/5", "k": 2 },
        "vectors": { "m": ["m1", "m2", "m3"], "g": ["g1", "g2", "g3"] },
        "let": ["w3 = m3/J"],
        "hamiltonian": "(m1^2 + m2^2)/(2*I) + m3^2/(2*J) + k*g3",
        "integrals": ["spin = m3", "power = m3^2 + I*dot(m, g)"],
        "observables": {
            "height": "g3",
            "phi": { "expression": "atan2(g2, g1)", "unwrap": true },
            "angle": { "expression": "atan2(g2, g1)" },
            "turning": "w3 + norm(cross(m, g))"
        },
        "initial": [0.3, 0.1, 2, 0.6, 0, 0.8],
        "run": { "method": "gauss6", "step": 0.05, "until": 20 }
    })
}

fn written(folder: &Path, spec: &Value) -> String {
    let path = folder.join("spec.json");
    std::fs::write(&path, spec.to_string()).unwrap();
    path.display().to_string()
}

fn run(spec: &Value, flags: &str) -> Run {
    let folder = folder();
    let path = written(folder.path(), spec);
    lie(&format!("run {path} {flags}"))
}

fn check(spec: &Value) -> Run {
    let folder = folder();
    let path = written(folder.path(), spec);
    lie(&format!("check {path}"))
}

fn column<'a>(
    header: &[String],
    rows: &'a [Vec<f64>],
    name: &str,
) -> impl Iterator<Item = f64> + 'a {
    let place = header.iter().position(|known| known == name).unwrap();
    rows.iter().map(move |row| row[place])
}

#[test]
fn columns_stand_behind_the_casimirs() {
    let run = run(&top(), "--quiet").ok();
    let (header, rows) = run.csv();
    let expected = "t m1 m2 m3 g1 g2 g3 energy C1 C2 spin power angle height phi turning";
    assert_eq!(header.join(" "), expected);
    let of = |name: &str| column(&header, &rows, name).collect::<Vec<f64>>();
    let [m1, m2, m3, g1, g2, g3] = ["m1", "m2", "m3", "g1", "g2", "g3"].map(of);
    assert_eq!(of("height"), g3);
    assert_eq!(of("spin"), m3);
    for (row, turning) in of("turning").into_iter().enumerate() {
        let (m, g) = ([m1[row], m2[row], m3[row]], [g1[row], g2[row], g3[row]]);
        let cross = |i: usize| m[(i + 1) % 3] * g[(i + 2) % 3] - m[(i + 2) % 3] * g[(i + 1) % 3];
        let norm = (0..3).map(|i| cross(i) * cross(i)).sum::<f64>().sqrt();
        assert!((turning - (m3[row] / 0.6 + norm)).abs() < 1e-13);
    }
    // the angle goes round several times, without a jump; as it is it jumps
    let (phi, angle) = (of("phi"), of("angle"));
    let jump = |angles: &[f64]| {
        let steps = angles.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    assert!(jump(&phi) < PI && jump(&angle) > PI);
    assert!((phi[phi.len() - 1] - phi[0]).abs() > 2.0 * TAU);
    for (phi, angle) in phi.iter().zip(&angle) {
        let turns = (phi - angle) / TAU;
        assert!((turns - turns.round()).abs() < 1e-13);
    }
    // rows far apart are on the same branch: every step is looked at
    let few = self::run(&top(), "--quiet --every 100").ok().csv();
    let last = |(header, rows): (Vec<String>, Vec<Vec<f64>>)| {
        column(&header, &rows, "phi").last().unwrap()
    };
    assert_eq!(last(few), phi[phi.len() - 1]);
}

#[test]
fn their_drift_is_said() {
    let said = run(&top(), "--every 10").ok().stderr;
    assert!(
        said.contains(", spin ") && said.contains(", power "),
        "{said}"
    );
    assert!(!said.contains("height") && !said.contains("phi"), "{said}");
    // a method that keeps them less well shows it
    let worst = |method: &str| {
        let (header, rows) = run(&top(), &format!("--quiet --method {method} --step 0.2"))
            .ok()
            .csv();
        let power: Vec<f64> = column(&header, &rows, "power").collect();
        power
            .iter()
            .map(|p| (p - power[0]).abs())
            .fold(0.0, f64::max)
    };
    assert!(worst("gauss6") < 1e-12);
    assert!(worst("rk4") > 1e-8);
}

#[test]
fn other_forms_have_them_too() {
    let json: Value =
        serde_json::from_str(&run(&top(), "--quiet --format json").ok().stdout).unwrap();
    let columns = json["columns"].as_array().unwrap();
    assert_eq!(columns.last().unwrap(), "turning");
    let lines = run(&top(), "--quiet --format jsonl --every 100")
        .ok()
        .stdout;
    assert!(lines.lines().nth(1).unwrap().contains("\"phi\""), "{lines}");
    let folder = folder();
    let path = written(folder.path(), &top());
    let picture = folder.path().join("p.svg");
    let to = picture.display();
    lie(&format!(
        "run {path} --quiet --plot {to} --out {}/a.csv",
        folder.path().display()
    ))
    .ok();
    let svg = std::fs::read_to_string(&picture).unwrap();
    assert!(svg.contains("Observables") && svg.contains("turning"));
    lie(&format!(
        "run {path} --quiet --plot {to} --picture phase:height,phi --out {}/a.csv",
        folder.path().display()
    ))
    .ok();
    let svg = std::fs::read_to_string(&picture).unwrap();
    assert!(svg.contains("height") && svg.contains("phi"));
    let refused = lie(&format!(
        "run {path} --quiet --plot {to} --picture phase:heigth,phi"
    ));
    let refused = refused.error("option", "command line: --picture");
    assert!(
        refused.stderr.contains("did you mean `height`"),
        "{}",
        refused.stderr
    );
}

/// Angles that turn several times in a step, as one by `--tol` may be: the phase of a symmetric body, z = 17, is -17 t. The control
/// is what the branch nearest to the last value would be.
#[test]
fn fast_angles_are_followed() {
    let spec = json!({
        "name": "Spinner", "algebra": "so(3)", "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/2 + z^2",
        "observables": { "phase": { "expression": "atan2(y, x)", "unwrap": true } },
        "initial": [0.6, 0.3, 17],
    });
    for pace in [
        "--method gauss16 --step 0.5",
        "--method taylor --tol 1e-10",
        "--tol 1e-9",
    ] {
        let (header, rows) = run(&spec, &format!("--quiet --until 50 {pace}")).ok().csv();
        let phases: Vec<f64> = column(&header, &rows, "phase").collect();
        let turned = phases[phases.len() - 1] - phases[0];
        assert!((turned.abs() - 850.0).abs() < 0.1, "{pace}: {turned}");
        assert!(
            phases.len() < 600,
            "{pace}: {} rows are no long steps",
            phases.len()
        );
    }
}

#[test]
fn a_run_goes_on_with_its_angles() {
    let folder = folder();
    let path = written(folder.path(), &top());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let whole = format!("run {path} --quiet --step 0.01 --until 100 --every 10");
    lie(&format!(
        "{whole} --checkpoint {} --out {}",
        at("a"),
        at("whole.csv")
    ))
    .ok();
    // ended by its own time, and made longer by a checkpoint of one that goes further
    let (first, second) = (at("ck"), at("part.csv"));
    let mut child = crate::common::command(
        format!("{whole} --checkpoint {first} --checkpoint-every 2000 --out {second}").split(' '),
    )
    .spawn()
    .unwrap();
    while !Path::new(&first).exists() || std::fs::metadata(&second).is_ok_and(|f| f.len() < 20_000)
    {
        if child.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::yield_now();
    }
    let _ = child.kill();
    let _ = child.wait();
    lie(&format!("resume {first}")).ok();
    let read = |path: &str| std::fs::read_to_string(path).unwrap();
    assert_eq!(read(&second), read(&at("whole.csv")));
}

#[test]
fn what_is_no_integral_is_refused() {
    let mut spec = top();
    spec["integrals"] = json!(["spin = m3", "tilt = m1"]);
    let said = check(&spec).error("integral", "").stderr;
    assert!(
        said.contains("`tilt` is not a first integral: {tilt, H} = "),
        "{said}"
    );
    assert!(said.contains("spec.json:1:"), "{said}");
    // with the right inertia it is one, with another it is none
    spec["integrals"] = json!(["spin = m3"]);
    check(&spec).ok();
    spec["hamiltonian"] = json!("m1^2/(2*I) + m2^2/(3*I) + m3^2/(2*J) + k*g3");
    let said = check(&spec).error("integral", "").stderr;
    assert!(said.contains("m1*m2"), "{said}");
    // noise has a name there that people know
    spec["integrals"] = json!(["spin = m3"]);
    spec["hamiltonian"] = json!("m1^2/(2*I) + m2^2/(2*I) + m3^2/(2*J) + k*g3");
    spec["noise"] = json!([{ "hamiltonian": "m1/10" }]);
    let said = check(&spec).error("integral", "").stderr;
    let named = said.contains("dW1/dt, where the W are the processes of the noise");
    assert!(named && !said.contains("_w1"), "{said}");
    spec.as_object_mut().unwrap().remove("noise");
    spec["integrals"] = json!(["m3 = 1"]);
    check(&spec).error("duplicate-name", "");
    spec["integrals"] = json!(["m3"]);
    check(&spec).error("syntax", "");
    spec["integrals"] = json!(["spin = m3 = 1"]);
    check(&spec).error("syntax", "");
}

#[test]
fn the_time_may_stand_in_them() {
    let particle = json!({
        "name": "Particle",
        "poisson": ["{q, p} = 1"],
        "state": ["q", "p"],
        "parameters": { "m": 2 },
        "hamiltonian": "p^2/(2*m)",
        "integrals": ["start = q - p*t/m"],
        "observables": { "clock": "t", "product": "t*p" },
        "initial": [1, 3],
        "run": { "method": "midpoint", "step": 0.1, "until": 10 }
    });
    let (header, rows) = run(&particle, "--quiet").ok().csv();
    assert_eq!(header.join(" "), "t q p energy start clock product");
    for row in &rows {
        assert_eq!(row[0], row[5]);
        assert!((row[4] - 1.0).abs() < 1e-13 && (row[6] - 3.0 * row[0]).abs() < 1e-12);
    }
    let mut wrong = particle.clone();
    wrong["integrals"] = json!(["start = q - p*t"]);
    check(&wrong).error("integral", "");
    // of a system with an algebra too
    let mut spec = top();
    spec["observables"]["clock"] = json!("t");
    let (header, rows) = run(&spec, "--quiet --every 50").ok().csv();
    let clock: Vec<f64> = column(&header, &rows, "clock").collect();
    assert_eq!(clock, column(&header, &rows, "t").collect::<Vec<f64>>());
}

#[test]
fn momenta_in_space_are_integrals_on_the_group() {
    let spec = json!({
        "name": "Body",
        "algebra": {
            "named": "so(3)",
            "matrices": {
                "e1": [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
                "e2": [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
                "e3": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
            }
        },
        "group": "R",
        "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6 + R33",
        "integrals": ["L3 = R31*x + R32*y + R33*z"],
        "initial": [0.3, 0.5, 0.7],
        "run": { "method": "gauss4", "step": 0.1, "until": 10 }
    });
    let (header, rows) = run(&spec, "--quiet").ok().csv();
    let l3: Vec<f64> = column(&header, &rows, "L3").collect();
    assert!(l3.iter().all(|l| (l - l3[0]).abs() < 1e-13));
    let mut others = spec.clone();
    others["integrals"] = json!(["L1 = R11*x + R12*y + R13*z"]);
    let said = check(&others).error("integral", "").stderr;
    assert!(said.contains("{L1, H} ="), "{said}");
    // without the weight all three are, and their brackets are those of the algebra
    others["hamiltonian"] = json!("x^2/2 + y^2/4 + z^2/6");
    others["integrals"] = json!([
        "L1 = R11*x + R12*y + R13*z",
        "L2 = R21*x + R22*y + R23*z",
        "L3 = R31*x + R32*y + R33*z"
    ]);
    let said = check(&others).ok().stdout;
    assert!(
        said.contains("first integrals, proven:") && said.contains("{L1, L2} = "),
        "{said}"
    );
}

#[test]
fn a_transform_without_expression_is_no_hindrance() {
    let spec = json!({
        "name": "Quartic",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "velocity": ["a", "b", "c"],
        "lagrangian": "(a^2 + b^2)/2 + c^2/3 + c^4/4 + (a^2 + b^2)^2/8",
        "integrals": ["axis = z"],
        "initial": [0.3, 0.5, 0.7],
        "run": { "method": "midpoint", "step": 0.1, "until": 5 }
    });
    let (header, rows) = run(&spec, "--quiet").ok().csv();
    assert!(column(&header, &rows, "axis").all(|z| (z - 0.7).abs() < 1e-13));
    let mut wrong = spec.clone();
    wrong["integrals"] = json!(["axis = x"]);
    check(&wrong).error("integral", "");
}

#[test]
fn names_and_forms_are_checked() {
    for (observables, kind, text) in [
        (
            json!({ "m1": "g3" }),
            "duplicate-name",
            "the observable `m1` has the name of a coordinate",
        ),
        (
            json!({ "k": "g3" }),
            "duplicate-name",
            "the observable `k` has the name of a parameter",
        ),
        (
            json!({ "spin": "g3" }),
            "duplicate-name",
            "the observable `spin` has the name of a first integral",
        ),
        (
            json!({ "work": "g3" }),
            "reserved-name",
            "`work` is the column",
        ),
        (json!({ "t": "g3" }), "reserved-name", "`t`"),
        (json!({ "energy": "g3" }), "reserved-name", "`energy`"),
        (json!({ "a": "g4" }), "unknown-symbol", "g4"),
        (json!({ "a": { "unwrap": true } }), "schema", "`expression`"),
        (
            json!({ "a": { "expression": "g3", "unwrap": 1 } }),
            "schema",
            "`unwrap`",
        ),
        (
            json!({ "a": { "expression": "g3", "unwarp": true } }),
            "schema",
            "did you mean `unwrap`?",
        ),
        (json!(["a = g3"]), "schema", "an object"),
        (json!({ "a": "" }), "syntax", "is missing"),
    ] {
        let mut spec = top();
        spec["observables"] = observables;
        let said = check(&spec).error(kind, "").stderr;
        assert!(said.contains(text), "{said}");
    }
    let chain = json!({
        "name": "Chain",
        "algebra": "so(3)^N",
        "parameters": { "N": 4 },
        "state": ["x[i]", "y[i]", "z[i]"],
        "hamiltonian": "sum(i in 0..N: x[i]*x[i+1])",
        "observables": { "first": "x[0]" }
    });
    let said = check(&chain).error("syntax", "").stderr;
    assert!(
        said.contains("observables of a family are functions of sums"),
        "{said}"
    );
    let mut chain = chain;
    chain["observables"] = json!({});
    chain["integrals"] = json!(["m = sum(i in 0..N: z[i])"]);
    let said = check(&chain).error("schema", "").stderr;
    assert!(
        said.contains("first integrals of a family are not proven"),
        "{said}"
    );
}

#[test]
fn verify_measures_them() {
    let folder = folder();
    let path = written(folder.path(), &top());
    let said = lie(&format!("verify {path} --method midpoint --json"))
        .ok()
        .stdout;
    assert!(said.contains("declared integrals"), "{said}");
    assert!(said.contains("quantities"), "{said}");
}

#[test]
fn check_tells_programs_of_them() {
    let folder = folder();
    let path = written(folder.path(), &top());
    let said: Value =
        serde_json::from_str(&lie(&format!("check {path} --json")).ok().stdout).unwrap();
    assert_eq!(
        said["integrals"][0],
        json!({ "name": "spin", "expression": "m3" })
    );
    assert_eq!(
        said["integral_brackets"],
        json!([{ "of": ["spin", "power"], "value": "0" }])
    );
    assert_eq!(said["observables"][2]["name"], "phi");
    assert_eq!(said["observables"][2]["unwrap"], true);
}

#[test]
fn the_report_shows_them() {
    let folder = folder();
    let path = written(folder.path(), &top());
    let page = folder.path().join("page.html");
    lie(&format!(
        "report {path} --quiet --no-bench --out {}",
        page.display()
    ))
    .ok();
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("First integrals:") && page.contains("Observables:"));
    assert!(page.contains("turning"));
}
