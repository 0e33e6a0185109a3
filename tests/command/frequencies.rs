//! `lie frequencies`: against the exact motion of the free body, and what it refuses.

use serde_json::{Value, json};

use crate::common::{folder, lie, spec};

const BODY: &str = "specs/so3_free_rigid_body.json";

#[track_caller]
fn lines(call: &str, name: &str) -> Vec<Value> {
    let run = lie(&format!("frequencies {call} --json")).ok();
    let all: Value = serde_json::from_str(&run.stdout).expect("JSON");
    all["signals"][name]["lines"]
        .as_array()
        .expect("lines")
        .clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The frequency of the middle component of a body with moments a > b > c about the axis of a: L. D. Landau, E. M. Lifshitz,
/// Mechanics, section 37, with the quarter period by the arithmetic-geometric mean.
fn frequency([a, b, c]: [f64; 3], m: [f64; 3]) -> f64 {
    let twice_energy = m[0] * m[0] / a + m[1] * m[1] / b + m[2] * m[2] / c;
    let square: f64 = m.iter().map(|m| m * m).sum();
    assert!(square > twice_energy * b, "about the other axis");
    let rate = ((square - twice_energy * c) * (a - b) / (a * b * c)).sqrt();
    let modulus = (b - c) * (twice_energy * a - square) / ((a - b) * (square - twice_energy * c));
    let (mut x, mut y) = (1.0, (1.0 - modulus).sqrt());
    for _ in 0..60 {
        (x, y) = (0.5 * (x + y), (x * y).sqrt());
    }
    // K = pi/(2 agm), and sn has the period 4 K
    assert!((x - y).abs() < 1e-15);
    rate * x
}

#[test]
fn the_free_body_is_known() {
    let m = [0.9, 0.3, 0.2];
    let known = frequency([2.0, 1.0, 2.0 / 3.0], m);
    let at = |method: &str| {
        let call =
            format!("{BODY} --initial 0.9,0.3,0.2 --method {method} --step 0.2 --until 800 --of y");
        lines(&call, "y")
    };
    let found = at("taylor");
    assert_eq!(found.len(), 5, "{found:?}");
    for (k, line) in found.iter().take(3).enumerate() {
        // a sine of the motion has odd harmonics alone
        let harmonic = known * (2 * k + 1) as f64;
        let off = number(&line["frequency"]) - harmonic;
        assert!(off.abs() < 1e-9, "{k}: {off:e} {line}");
        assert!(number(&line["drift"]) < 1e-8, "{line}");
    }
    // the control: the phase error of a step of second order is seen
    let off = number(&at("lie-midpoint")[0]["frequency"]) - known;
    assert!(off.abs() > 1e-6, "{off:e}");
}

/// Halves agree on a regular orbit, and differ on a chaotic one.
#[test]
fn diffusion_tells_chaos() {
    let folder = folder();
    let system = json!({
        "format": 1,
        "name": "HenonHeiles",
        "poisson": ["{x, px} = 1", "{y, py} = 1"],
        "state": ["x", "y", "px", "py"],
        "parameters": { "E": "1/12" },
        "hamiltonian": "(px^2 + py^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3",
        "initial": [0, "-1/4", "sqrt(2*E - 1/16 - 1/96)", 0],
        "run": { "method": "gauss4", "step": 0.2, "until": 2000 },
    });
    let path = folder.path().join("henon_heiles.json");
    std::fs::write(&path, format!("{system:#}")).expect("the spec is written");
    let at = |energy: &str| {
        let found = lines(
            &format!("{} --of px,x --count 8 --param E={energy}", path.display()),
            "x",
        );
        number(&found[0]["drift"])
    };
    let (regular, chaotic) = (at("1/12"), at("0.1666"));
    assert!(regular < 1e-7 && chaotic > 1e-4, "{regular:e} {chaotic:e}");
}

/// A pendulum that hardly swings: amplitude, phase and frequency of a cosine; samples behind a start and of every other row.
#[test]
fn a_small_swing_is_a_cosine() {
    let call = "specs/canonical_pendulum.json --initial 1/10000,0 --method gauss6 --step 0.05 --every 2 --until 300.03 --of q --count 1";
    let [line] = &*lines(call, "q") else {
        panic!("one line")
    };
    // 1 - a^2/16 + ..., A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, Wiley 1979
    let known = 1.0 - 1e-8 / 16.0;
    assert!((number(&line["frequency"]) - known).abs() < 1e-11, "{line}");
    assert!(
        (number(&line["amplitude"]) / 1e-4 - 1.0).abs() < 1e-8,
        "{line}"
    );
    assert!(number(&line["phase"]).abs() < 1e-8, "{line}");
    let text = lie(&format!("frequencies {call}")).ok().stdout;
    assert!(text.contains("3001 samples at distances of 0.1"), "{text}");
}

#[test]
fn what_is_refused_says_why() {
    let run = |options: &str| lie(&format!("frequencies {BODY} {options}"));
    let both = "--step 0.1 --until 10";
    let refused = run(&format!("{both} --of x,Y,w")).error("option", "command line: --of");
    assert!(
        refused.stderr.contains("`Y`") && refused.stderr.contains("`w`"),
        "{}",
        refused.stderr
    );
    run("--step 0.1 --until 1 --of x").error("option", "command line: --until");
    run("--step 0.1 --at 1,2,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19 --of x")
        .error("option", "command line: --of");
    run(&format!("{both} --of x --param I1=1:2:3")).error("option", "command line: SPEC");
    // a column that is named twice is analysed once
    let twice = run(&format!("{both} --of x,x")).ok().stdout;
    assert_eq!(twice.matches("x: mean").count(), 1, "{twice}");
    // 0/0 at the start, and numbers behind it
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["observables"] = json!({ "ratio": "sin(x - 1)/(x - 1)" });
        spec["initial"] = json!([1, 0.5, 0.5]);
    });
    let command = format!("frequencies {} {both} --of ratio", path.display());
    let undefined = lie(&command).error("option", "command line: --of");
    assert!(
        undefined.stderr.contains("`ratio` is not finite at t = 0"),
        "{}",
        undefined.stderr
    );
    // a run that stops early: what there is of it is analysed
    let path = spec(folder.path(), |spec| {
        spec["poisson"] = json!(["{x, y} = 1"]);
        spec["state"] = json!(["x", "y"]);
        spec["hamiltonian"] = "y^2/2 - x^4".into();
        spec["initial"] = json!([1, 1]);
        for key in ["algebra", "casimirs", "parameters"] {
            spec.as_object_mut().expect("an object").remove(key);
        }
    });
    let run = lie(&format!(
        "frequencies {} --of y --method rk4 --step 0.01 --until 10",
        path.display()
    ));
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(
        run.stdout.contains("samples at distances of 0.01"),
        "{}",
        run.stdout
    );
}

/// A cosine of frequency w whose samples are pi/w apart alternates, and tells neither its amplitude nor that of a faster one; half as far it does.
#[test]
fn a_line_at_the_limit_of_the_samples_is_warned_of() {
    let folder = folder();
    let path = folder.path().join("oscillator.json");
    let text = r#"{"format": 1, "name": "Oscillator", "poisson": ["{q, p} = 1"], "state": ["q", "p"], "parameters": {"w": 1},
        "hamiltonian": "w*(p^2 + q^2)/2", "initial": ["3/5", "4/5"]}"#;
    std::fs::write(&path, text).expect("written");
    let path = path.display();
    let run = |rows: &str| {
        let call = format!(
            "frequencies {path} --method taylor --step 1/20 --param w=1 {rows} --of q --count 1"
        );
        lie(&call).ok()
    };
    let pi = std::f64::consts::PI;
    let at = run(&format!("--rows 0:{}:101", 100.0 * pi));
    let what = "`q` has a line at";
    assert!(
        at.stderr.contains("warning") && at.stderr.contains(what),
        "{}",
        at.stderr
    );
    assert!(at.stderr.contains("faster"), "{}", at.stderr);
    let below = run(&format!("--rows 0:{}:201", 100.0 * pi));
    assert!(!below.stderr.contains(what), "{}", below.stderr);
    // an amplitude of 3/5 is what the samples tell of one of 1
    assert!(below.stdout.contains("1.000000"), "{}", below.stdout);
    assert!(at.stdout.contains("6.0000000e-1"), "{}", at.stdout);
}
