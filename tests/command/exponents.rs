//! `lie exponents`: against closed formulas and published values, and what it refuses.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{folder, lie, spec};

/// The system of Hénon and Heiles at an energy E, from x = 0, py = 0.
fn henon_heiles(folder: &Path) -> PathBuf {
    let spec = json!({
        "format": 1,
        "name": "HenonHeiles",
        "poisson": ["{x, px} = 1", "{y, py} = 1"],
        "state": ["x", "y", "px", "py"],
        "parameters": { "E": "1/8", "y0": "-1/4" },
        "hamiltonian": "(px^2 + py^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3",
        "initial": [0, "y0", "sqrt(2*E - y0^2 + 2*y0^3/3)", 0],
    });
    written(folder, "henon_heiles.json", &spec)
}

fn written(folder: &Path, name: &str, spec: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, format!("{spec:#}")).expect("the spec is written");
    path
}

#[track_caller]
fn found(path: impl AsRef<Path>, options: &str) -> Value {
    let run = lie(&format!(
        "exponents {} {options} --json",
        path.as_ref().display()
    ))
    .ok();
    serde_json::from_str(&run.stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let entries = value.as_array().expect("an array").iter();
    entries
        .map(|entry| entry.as_f64().expect("a number"))
        .collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Rounding makes a tangent longer by a part of its last digit in every step: no growth, however small its error. The control grows.
#[test]
fn round_off_is_no_growth() {
    let folder = folder();
    let spec = |sign: &str| {
        let energy = format!("p^2/2 {sign} q^2/2");
        let spec = json!({ "format": 1, "name": "Oscillator", "poisson": ["{q, p} = 1"], "state": ["q", "p"],
                           "hamiltonian": energy, "initial": [0, 0] });
        written(folder.path(), "oscillator.json", &spec)
    };
    let said = |path: PathBuf| {
        let flags = "--method gauss4 --step 0.1 --until 100";
        lie(&format!("exponents {} {flags}", path.display()))
            .ok()
            .stdout
    };
    let stable = said(spec("+"));
    assert!(stable.contains("no growth beyond round-off"), "{stable}");
    let unstable = said(spec("-"));
    assert!(unstable.contains("Lyapunov time: 1"), "{unstable}");
}

/// A free body moves on circles of its sphere: neighbours part linearly, and a finite time T sees log(T)/T.
#[test]
fn regular_motion_has_none() {
    let body = "specs/so3_free_rigid_body.json";
    let options = "--method lie-midpoint --step 0.1 --until 400";
    let all = found(body, options);
    let bound = 2.0 * 400.0_f64.ln() / 400.0;
    let values = numbers(&all["exponents"]);
    assert!(values.iter().all(|value| value.abs() < bound), "{all:#}");
    assert!(number(&all["casimir_exponents"]) < bound && number(&all["sum"]).abs() < 1e-12);
    assert_eq!(
        (&all["leaf_dimension"], &all["dimension"]),
        (&json!(2), &json!(3))
    );
    // the control: neighbours of the middle axis part exponentially
    let middle = found(body, &format!("{options} --initial 0,1,0"));
    assert!(number(&middle["exponents"][0]) > 10.0 * bound, "{middle:#}");
}

/// Of a body with moments 2, 1, 2/3 and momentum 1 the middle axis has the rate
/// `|m| sqrt((I1 - I2)(I2 - I3)/(I1 I3))/I2 = 1/2`; a step of the midpoint rule grows by `(1 + h/4)/(1 - h/4)`.
#[test]
fn a_hyperbolic_point_is_known() {
    let at = |method: &str, step: f64| {
        let all = found(
            "specs/so3_free_rigid_body.json",
            &format!("--method {method} --step {step} --until 200 --transient 100 --initial 0,1,0"),
        );
        numbers(&all["exponents"])
    };
    let is = |values: &[f64], rate: f64| {
        let known = [rate, 0.0, -rate];
        values
            .iter()
            .zip(known)
            .all(|(value, known)| (value - known).abs() < 1e-9)
    };
    let (exact, coarse) = (at("gauss6", 0.05), at("midpoint", 0.5));
    assert!(is(&exact, 0.5), "{exact:?}");
    // the exponents are those of the step, which a large one shows
    let of_step = ((1.0_f64 + 0.125) / (1.0 - 0.125)).ln() / 0.5;
    assert!(is(&coarse, of_step), "{coarse:?} {of_step}");
    assert!(!is(&coarse, 0.5) && (of_step - 0.5).abs() > 1e-3);
}

/// E. N. Lorenz, J. Atmos. Sci. 20 (1963) 130, with his parameters: exponents 0.9056, 0, -14.5723 (J. C. Sprott, Chaos and
/// Time-Series Analysis, Oxford 2003; 0.906 and -14.572 by 10^9 steps on his page lorenzle.htm), whose sum is -(sigma + 1 + b).
#[test]
fn lorenz_is_published() {
    let folder = folder();
    let lorenz = json!({
        "format": 1,
        "name": "Lorenz",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "hamiltonian": "0",
        "forces": { "x": "10*(y - x)", "y": "x*(28 - z) - y", "z": "x*y - 8/3*z" },
        "initial": [1, 2, 20],
    });
    let path = written(folder.path(), "lorenz.json", &lorenz);
    let all = found(path, "--method rk4 --step 0.01 --until 150 --transient 10");
    let (values, errors) = (numbers(&all["exponents"]), numbers(&all["errors"]));
    let is = |known: [f64; 3]| {
        let all = values.iter().zip(&errors).zip(known);
        all.into_iter()
            .all(|((value, error), known)| (value - known).abs() < 3.0 * error)
    };
    assert!(is([0.9056, 0.0, -14.5723]), "{all:#}");
    assert!(errors[0] < 0.05, "{all:#}");
    // the control: the parameters of A. Wolf and others, Physica D 16 (1985) 285, have 1.50, 0, -22.46
    assert!(!is([1.50, 0.0, -22.46]));
    assert!((number(&all["sum"]) + 41.0 / 3.0).abs() < 1e-3, "{all:#}");
}

/// In the chaotic sea at the energy 1/6 the largest exponent is about 0.13 (G. Benettin, L. Galgani, J.-M. Strelcyn, Phys. Rev. A 14
/// (1976) 2338). Runge–Kutta steps of 0.02, written in C for that alone, gave 0.126 over a time of 4e5, 0.130 over its first half, and at 1/8 0.044 and
/// 0.048 on two orbits over 1e5.
#[test]
fn henon_heiles_is_published() {
    let folder = folder();
    let path = henon_heiles(folder.path());
    let at = |options: &str| {
        let all = found(&path, &format!("{options} --until 3000"));
        (number(&all["exponents"][0]), number(&all["errors"][0]), all)
    };
    let chaotic = "--param E=0.1666 --param y0=-0.15 --count 1";
    let (midpoint, error, all) = at(&format!("--method midpoint --step 0.1 {chaotic}"));
    assert!((midpoint - 0.13).abs() < 0.03 && error < 0.03, "{all:#}");
    assert_eq!(numbers(&all["exponents"]).len(), 1);
    assert_eq!(
        (&all["sum"], &all["pairing_defect"]),
        (&Value::Null, &Value::Null)
    );
    // another method and another step see the same within the errors of both
    let (other, of_other, all) = at(&format!("--method rk4 --step 0.05 {chaotic}"));
    assert!(
        (midpoint - other).abs() < 3.0 * error.hypot(of_other),
        "{midpoint} {all:#}"
    );
    let (milder, ..) = at("--method midpoint --step 0.1 --count 1");
    assert!((0.02..0.08).contains(&milder), "{milder}");
    // the control: a regular orbit at 1/12
    let (regular, ..) = at("--method midpoint --step 0.1 --param E=1/12 --count 1");
    assert!(regular < 0.01, "{regular}");
}

/// The tangent of a Poisson map on a canonical bracket is symplectic: sums of pairs vanish to round-off, at every time.
#[test]
fn pairs_are_those_of_poisson_maps() {
    let folder = folder();
    let path = henon_heiles(folder.path());
    for method in ["midpoint", "gauss4", "compose4(midpoint)"] {
        let all = found(
            &path,
            &format!("--method {method} --step 0.25 --until 300 --seed 7"),
        );
        assert!(number(&all["pairing_defect"]) < 1e-12, "{method}: {all:#}");
        assert!(number(&all["sum"]).abs() < 1e-12, "{method}: {all:#}");
    }
    // the control: steps that are no Poisson maps, as many and as large
    let all = found(&path, "--method rk4 --step 0.25 --until 300 --seed 7");
    assert!(number(&all["pairing_defect"]) > 1e-6, "{all:#}");
    // the same seed gives the same digits, another one gives other vectors
    let again = |seed: u32| {
        found(&path, &format!("--step 0.25 --until 50 --seed {seed}"))["exponents"].take()
    };
    assert_eq!(again(7), again(7));
    assert_ne!(again(7), again(8));
}

/// The exponent of `q'' = -(1/4 + cos(2 pi t)) q` is that of its matrix over a period, which is found here by steps of our own. Time is none
/// of the coordinates.
#[test]
fn the_time_is_no_coordinate() {
    let folder = folder();
    let mathieu = json!({
        "format": 1,
        "name": "Mathieu",
        "poisson": ["{q, p} = 1"],
        "state": ["q", "p"],
        "hamiltonian": "p^2/2 + (a + b*cos(w*t))*q^2/2",
        "parameters": { "a": "1/4", "b": "1/3", "w": 1 },
        "initial": [0, 0],
    });
    let path = written(folder.path(), "mathieu.json", &mathieu);
    let period = std::f64::consts::TAU;
    let (count, mut trace) = (20_000, 0.0);
    for start in [[1.0, 0.0], [0.0, 1.0]] {
        let h = period / f64::from(count);
        let mut s = start;
        for k in 0..count {
            // Störmer and Verlet, of second order
            let rate = |t: f64| 0.25 + t.cos() / 3.0;
            let t = f64::from(k) * h;
            s[1] -= 0.5 * h * rate(t) * s[0];
            s[0] += h * s[1];
            s[1] -= 0.5 * h * rate(t + h) * s[0];
        }
        trace += s[0] * start[0] + s[1] * start[1];
    }
    let half = 0.5 * trace.abs();
    let known = (half + (half * half - 1.0).sqrt()).ln() / period;
    assert!(known > 0.05, "{known}");
    // 32 steps in a period
    let step = period / 32.0;
    let at = |from: u32, until: u32| {
        let options = format!(
            "--method gauss6 --step {step:.17} --until {:.17} --transient {:.17}",
            f64::from(until) * period,
            f64::from(from) * period,
        );
        found(&path, &options)
    };
    let all = at(20, 60);
    let values = numbers(&all["exponents"]);
    assert_eq!((values.len(), &all["dimension"]), (2, &json!(2)));
    assert!(
        (values[0] - known).abs() < 1e-7 && (values[1] + known).abs() < 1e-7,
        "{known} {all:#}"
    );
    let options = format!("--method gauss6 --step {step:.17} --until 60");
    let said = lie(&format!("exponents {} {options}", path.display()))
        .ok()
        .stdout;
    assert!(
        said.contains("1 pair on the leaf of 2 dimensions"),
        "{said}"
    );
    // the control: a time that stood still would have the exponent of 7/12, none
    assert!(number(&at(0, 20)["exponents"][0]) > 0.5 * known);
}

/// Vectors that are made orthonormal behind every step are others than those that the step before has left: no memory of a method, of series
/// or of stages, goes on from these, also where the time is carried. The sum of all is the divergence, which friction makes known.
#[test]
fn every_method_sees_the_vectors_that_are_made_orthonormal() {
    let folder = folder();
    let pendulum = json!({
        "format": 1, "name": "Damped", "poisson": ["{q, p} = 1"], "state": ["q", "p"],
        "hamiltonian": "p^2/2 - cos(q)", "forces": { "p": "-p/10 + cos(2*t)/3" }, "initial": ["1/2", 0],
    });
    let path = written(folder.path(), "damped.json", &pendulum);
    let of = |method: &str| {
        let options = format!("--method {method} --step 0.1 --until 400");
        numbers(&found(&path, &options)["exponents"])
    };
    let expected = of("gauss4");
    for method in [
        "midpoint",
        "gauss8",
        "gauss12",
        "gauss16",
        "cohen-hairer8",
        "cohen-hairer16",
        "taylor",
        "dopri5",
        "rk4",
    ] {
        let values = of(method);
        let sum: f64 = values.iter().sum();
        assert!((sum + 0.1).abs() < 1e-3, "{method}: {values:?}");
        assert!(
            (values[0] - expected[0]).abs() < 1e-2,
            "{method}: {values:?}, {expected:?}"
        );
    }
}

#[test]
fn a_step_that_fails_keeps_what_was_summed() {
    let folder = folder();
    let path = henon_heiles(folder.path());
    let call = format!(
        "exponents {} --method rk4 --step 0.05 --until 1000 --param E=1/2 --param y0=1/2",
        path.display()
    );
    let run = lie(&format!("{call} --json"));
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(
        run.stderr.contains("what was summed so far is shown"),
        "{}",
        run.stderr
    );
    let all: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert!(
        (1..20_000).contains(&all["steps"].as_u64().expect("steps")),
        "{all:#}"
    );
    assert!(
        all["stopped"].is_string() && numbers(&all["exponents"]).len() == 4,
        "{all:#}"
    );
    let text = lie(&call).stdout;
    assert!(
        text.contains("Lyapunov exponents by the tangents of"),
        "{text}"
    );
}

#[test]
fn what_is_refused_says_why() {
    let folder = folder();
    let path = henon_heiles(folder.path());
    let run = |options: &str| lie(&format!("exponents {} {options}", path.display()));
    let both = "--step 0.1 --until 10";
    run("--until 10").error("option", "command line: --step");
    run("--step 0.1").error("option", "command line: --until");
    run(&format!("{both} --count 5")).error("option", "command line: --count");
    run(&format!("{both} --count 1.5")).error("option", "command line: --count");
    run(&format!("{both} --transient 10")).error("option", "command line: --transient");
    run(&format!("{both} --transient -1")).error("option", "command line: --transient");
    run(&format!("{both} --seed 1.5")).error("option", "command line: --seed");
    run(&format!("{both} --initial 1,2")).error("state-length", "command line: --initial");
    run(&format!("{both} --method lie-midpoint")).error("method", "command line: --method");
    let body = |changes: &dyn Fn(&mut Value)| spec(folder.path(), changes);
    let family = "tests/data/families/open_chain.json";
    let refused = lie(&format!("exponents {family} {both}")).error("method", family);
    assert!(
        refused.stderr.contains("it is a family"),
        "{}",
        refused.stderr
    );
    let noisy = body(&|spec| spec["noise"] = json!([{ "hamiltonian": "x" }]));
    let refused = lie(&format!("exponents {} {both}", noisy.display()));
    let refused = refused.error("method", &format!("{}:", noisy.display()));
    assert!(refused.stderr.contains("noise"), "{}", refused.stderr);
    let without = body(&|spec| drop(spec.as_object_mut().expect("an object").remove("initial")));
    let refused = lie(&format!("exponents {} {both}", without.display()));
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("initial"), "{}", refused.stderr);
    let loose = body(&|spec| spec["run"] = json!({ "tol": 1e-6, "until": 10 }));
    lie(&format!("exponents {}", loose.display())).error("option", "command line: --step");
}
