//! Directions: motions are those of textbooks, and what would run backwards in time is told.

use std::path::Path;

use crate::common::markdown::{blocks, links, read};
use crate::common::{Run, command, folder, lie};
use lie_codegen::compile::compile_spec;
use lie_in_process::report::signs;
use lie_program::protocol::Start;
use serde_json::{Value, json};

/// Runs `lie` on a spec.
fn of(spec: &Value, call: &str, flags: &str) -> Run {
    let folder = folder();
    let path = folder.path().join("system.json");
    std::fs::write(&path, spec.to_string()).expect("the spec is written");
    let path = path.to_str().expect("UTF-8");
    let words = [
        &[call, path][..],
        &flags.split_whitespace().collect::<Vec<_>>(),
    ]
    .concat();
    command(words).output().expect("lie starts").into()
}

fn canonical(algebra: &str, hamiltonian: &str, initial: &[f64]) -> Value {
    json!({ "format": 1, "name": "System", "algebra": algebra, "hamiltonian": hamiltonian, "initial": initial })
}

/// The state at a time, without what follows it.
fn at(spec: &Value, time: f64, dimension: usize) -> Vec<f64> {
    let step = 0.1 * time.signum();
    let flags = format!("--method gauss16 --step {step} --quiet --at {time}");
    let run = of(spec, "run", &flags).ok();
    run.csv().1[0][1..=dimension].to_vec()
}

#[track_caller]
fn near(found: &[f64], expected: &[f64], what: &str) {
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() < 1e-9,
            "{what}: {found:?} instead of {expected:?}"
        );
    }
    assert_eq!(found.len(), expected.len());
}

/// Oscillators of different frequencies on algebras with canonical pairs: the names of the pairs, where they start, and
/// where the brackets are in the state.
#[test]
fn oscillators_run_forwards_from_minus_one() {
    const T: f64 = 1.5;
    for (algebra, state, pairs, units) in [
        ("heisenberg(1)", "q p z", &[(0, 1)][..], &[2][..]),
        ("heisenberg(2)", "q1 q2 p1 p2 z", &[(0, 2), (1, 3)], &[4]),
        ("diamond", "n q p z", &[(1, 2)], &[3]),
        ("oscillator(2)", "n q1 q2 p1 p2 z", &[(1, 3), (2, 4)], &[5]),
        (
            "heisenberg(1)^2",
            "q1 p1 z1 q2 p2 z2",
            &[(0, 1), (3, 4)],
            &[2, 5],
        ),
        ("bianchi(II)", "x y z", &[(1, 2)], &[0]),
        ("upper(3)", "m12 m13 m23", &[(0, 2)], &[1]),
    ] {
        let names: Vec<&str> = state.split(' ').collect();
        let (mut terms, mut initial) = (Vec::new(), vec![0.0; names.len()]);
        for (k, (q, p)) in pairs.iter().enumerate() {
            terms.push(format!(
                "{}^2/2 + {}*{}^2/2",
                names[*p],
                (k + 1).pow(2),
                names[*q]
            ));
            (initial[*q], initial[*p]) = (0.3, 0.4);
        }
        let energy = terms.join(" + ");
        let run = |sign: f64, invariance: &str, time: f64| {
            let mut initial = initial.clone();
            units.iter().for_each(|unit| initial[*unit] = sign);
            let mut spec = canonical(algebra, &energy, &initial);
            spec["invariance"] = invariance.into();
            at(&spec, time, names.len())
        };
        let expected = |sign: f64| {
            let mut state = initial.clone();
            units.iter().for_each(|unit| state[*unit] = sign);
            for (k, (q, p)) in pairs.iter().enumerate() {
                let w = (k + 1) as f64;
                let (sine, cosine) = (w * T).sin_cos();
                (state[*q], state[*p]) =
                    (0.3 * cosine + 0.4 / w * sine, 0.4 * cosine - 0.3 * w * sine);
            }
            state
        };
        // the number of oscillations moves the other coordinate of an oscillator algebra
        let compared = |mut state: Vec<f64>| {
            if names[0] == "n" {
                state[0] = 0.0;
            }
            state
        };
        near(&compared(run(-1.0, "left", T)), &expected(-1.0), algebra);
        if pairs.len() == 1 {
            near(&compared(run(1.0, "right", T)), &expected(1.0), algebra);
            // the other sign is the motion backwards
            near(&compared(run(1.0, "left", -T)), &expected(1.0), algebra);
            let backwards = compared(run(1.0, "left", T));
            assert!((backwards[pairs[0].0] - expected(1.0)[pairs[0].0]).abs() > 0.1);
        }
    }
}

#[test]
fn families_of_oscillators_run_forwards_from_minus_one() {
    let spec = json!({
        "format": 1, "name": "Chain", "algebra": "oscillator(1)^L",
        "state": ["n[i]", "q[i]", "p[i]", "z[i]"], "parameters": { "L": 2 },
        "hamiltonian": "sum(i in 0..L: p[i]^2/2 + q[i]^2/2)",
    });
    let flags = "--method gauss16 --step 0.1 --at 1 --initial 0,0,0.3,0.1,0.4,0.2,-1,";
    let run = of(&spec, "run", &format!("{flags}-1")).ok();
    let (sine, cosine) = 1.0_f64.sin_cos();
    let row = &run.csv().1[0];
    near(&row[3..4], &[0.3 * cosine + 0.4 * sine], "q[0]");
    near(&row[5..6], &[0.4 * cosine - 0.3 * sine], "p[0]");
    assert!(!run.stderr.contains("note:"), "{}", run.stderr);
    let run = of(&spec, "run", &format!("{flags}1")).ok();
    let note = "note: {q[i], p[i]} = -z[i] is negative at 1 of 2 sites";
    assert!(said(&run).contains(note), "{}", run.stderr);
}

/// A textbook's equations, by the classical Runge–Kutta method with small steps.
fn textbook(field: impl Fn(&[f64]) -> Vec<f64>, start: &[f64], time: f64) -> Vec<f64> {
    const STEPS: usize = 20_000;
    let h = time / STEPS as f64;
    let mut y = start.to_vec();
    let moved = |y: &[f64], k: &[f64], h: f64| -> Vec<f64> {
        y.iter().zip(k).map(|(y, k)| y + h * k).collect()
    };
    for _ in 0..STEPS {
        let k1 = field(&y);
        let k2 = field(&moved(&y, &k1, h / 2.0));
        let k3 = field(&moved(&y, &k2, h / 2.0));
        let k4 = field(&moved(&y, &k3, h));
        for i in 0..y.len() {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    y
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A spec of the page on signs.
fn of_page(name: &str) -> Value {
    let page = read("docs/book/src/signs.md");
    let before = format!("<!-- file: {name}.json -->");
    let found = blocks(&page)
        .into_iter()
        .find(|block| block.before == before);
    serde_json::from_str(&found.expect("a block of JSON").text).expect("JSON")
}

#[test]
fn the_systems_of_the_page_move_as_in_textbooks() {
    // J' = grad H x J, q' = dH/dp
    let dicke = |y: &[f64]| {
        let (w, w0, g) = (1.0, 1.2, 0.5);
        let slope = [2.0 * g * y[3], 0.0, w0];
        let spin = cross(slope, [y[0], y[1], y[2]]);
        [&spin[..], &[w * y[4], -w * y[3] - 2.0 * g * y[0], 0.0]].concat()
    };
    // m' = m x grad H
    let magnet = |y: &[f64]| {
        let (mass, k, slope) = (2.0, 1.0, 1.0 / 3.0);
        let moment = cross([y[0], y[1], y[2]], [-slope * y[3], 0.0, -1.0]);
        [&moment[..], &[y[4] / mass, -k * y[3] + slope * y[0], 0.0]].concat()
    };
    let ring = |y: &[f64]| {
        let spring = |i: usize| (y[i % 4] - y[(i + 1) % 4]).exp();
        let forces = (0..4).map(|i| spring(i + 3) - spring(i));
        let mut slopes = y[4..8].to_vec();
        slopes.extend(forces);
        slopes.push(0.0);
        slopes
    };
    type Slopes<'a> = &'a dyn Fn(&[f64]) -> Vec<f64>;
    let systems: [(&str, Slopes<'_>, &[f64]); 3] = [
        ("dicke", &dicke, &[0.6, 0.0, -0.8, 0.5, 0.0, 1.0]),
        ("magnet", &magnet, &[0.6, 0.0, 0.8, 0.5, 0.0, -1.0]),
        (
            "toda_ring",
            &ring,
            &[0.0, 0.5, -0.25, 0.0, 0.5, -0.5, 0.25, -0.25, -1.0],
        ),
    ];
    for (name, field, start) in systems {
        let mut spec = of_page(name);
        near(
            &at(&spec, 5.0, start.len()),
            &textbook(field, start, 5.0),
            name,
        );
        let last = start.len() - 1;
        // control: with the other unit the positions go the other way
        spec["initial"][last] = json!(-start[last]);
        let wrong = at(&spec, 5.0, start.len());
        let right = textbook(field, start, 5.0);
        let apart = (0..last).map(|i| (wrong[i] - right[i]).abs());
        assert!(apart.fold(0.0, f64::max) > 0.1, "{name}");
    }
    // a pendulum by other programs
    let mut pendulum = of_page("backwards");
    pendulum["initial"] = json!([0.3, 1, -1]);
    let expected = [0.1089473932480415, -1.0380121497827088, -1.0];
    near(&at(&pendulum, 3.0, 3), &expected, "pendulum");
    // toda(2) in Flaschka's variables is two particles
    let open = canonical("toda(2)", "b1^2/2 + b2^2/2 + a1^2", &[0.3, -0.2, 0.4]);
    let apart = 2.0 * (0.8_f64).ln();
    let two = |y: &[f64]| {
        let force = (y[0] - y[1]).exp();
        vec![y[2], y[3], -force, force]
    };
    let end = textbook(two, &[apart, 0.0, 0.6, -0.4], 2.0);
    let flaschka = [
        end[2] / 2.0,
        end[3] / 2.0,
        ((end[0] - end[1]) / 2.0).exp() / 2.0,
    ];
    near(&at(&open, 2.0, 3), &flaschka, "toda(2)");
}

/// Specs in the pages of the book and of the repository start forwards in time.
#[test]
fn no_example_starts_backwards() {
    let mut specs: Vec<(String, String)> = Vec::new();
    for page in links(&read("docs/book/src/SUMMARY.md")) {
        let text = read(&format!("docs/book/src/{page}"));
        let mut told = 0;
        for block in blocks(&text) {
            let meant = block.before == "<!-- file: backwards.json -->";
            if block.language == "json" && !meant {
                specs.push((format!("{page}, line {}", block.line), block.text));
            } else if block.language == "text" {
                told += block.text.matches("backwards in time").count();
            }
        }
        assert_eq!(told > 0, page == "signs.md", "{page}");
    }
    for entry in
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("specs")).expect("specs")
    {
        let path = entry.expect("an entry").path();
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        // this one has the initial state of the public vectors, and says so
        if path.is_file() && !name.ends_with("schema") && name != "heisenberg_h3" {
            specs.push((name, std::fs::read_to_string(&path).expect("a spec")));
        }
    }
    let mut pairs = 0;
    for (name, text) in &specs {
        let Ok(model) = compile_spec(text) else {
            continue;
        };
        let parameters = model.defaults();
        let Some(initial) = model.initial_values(&parameters) else {
            continue;
        };
        pairs += model.directions.pairs.len();
        let start = Start {
            initial,
            ..Start::default()
        };
        assert_eq!(signs::note(&model, std::iter::once(&start)), None, "{name}");
    }
    assert!(
        specs.len() > 20 && pairs > 5,
        "{} specs, {pairs} pairs",
        specs.len()
    );
}

const NOTE: &str = "note: {q, p} = -z is -1.0 at the initial state: mechanics in q and p runs backwards in time there";

fn pendulum(unit: f64) -> Value {
    canonical("heisenberg(1)", "p^2/2 - cos(q)", &[0.3, 1.0, unit])
}

/// The text of stderr in one line.
fn said(run: &Run) -> String {
    let words: Vec<&str> = run.stderr.split_whitespace().collect();
    words.join(" ")
}

#[test]
fn a_run_that_starts_backwards_says_so_once() {
    let flags = "--method gauss4 --step 0.1 --until 1";
    let run = of(&pendulum(1.0), "run", flags).ok();
    assert_eq!(said(&run).matches(NOTE).count(), 1, "{}", run.stderr);
    for remedy in ["start from z < 0", "\"invariance\": \"right\""] {
        assert!(said(&run).contains(remedy), "{remedy}: {}", run.stderr);
    }
    assert!(!run.stdout.contains("note"), "rows are rows");
    // once for several methods and states
    let several = format!("{flags} --method rk4 --param k=1:2:3");
    let mut spec = pendulum(1.0);
    spec["parameters"] = json!({ "k": 1 });
    spec["hamiltonian"] = "p^2/2 - k*cos(q)".into();
    let run = of(&spec, "run", &several).ok();
    let note = "{q, p} = -z is negative in 3 of 3 runs";
    assert_eq!(said(&run).matches(note).count(), 1, "{}", run.stderr);
    assert_eq!(said(&run).matches("note:").count(), 1, "{}", run.stderr);
    // remedies that work, quiet, and a state where neither sign is taken
    for (unit, invariance, more) in [
        (-1.0, "left", ""),
        (1.0, "right", ""),
        (1.0, "left", "--initial 0.3,1,-2"),
        (1.0, "left", "--quiet"),
        (0.0, "left", ""),
    ] {
        let mut spec = pendulum(unit);
        spec["invariance"] = invariance.into();
        let run = of(&spec, "run", &format!("{flags} {more}")).ok();
        assert!(!run.stderr.contains("note:"), "{}", run.stderr);
    }
    let mut spec = pendulum(-1.0);
    spec["invariance"] = "right".into();
    let run = of(&spec, "run", flags).ok();
    assert!(said(&run).contains("{q, p} = z is -1.0"), "{}", run.stderr);
    assert!(!said(&run).contains("invariance"), "{}", run.stderr);
}

#[test]
fn explicit_brackets_are_told_by_their_names() {
    let general = |bracket: &str, state: &[&str], initial: &[f64]| {
        let energy = format!("{}^2 + {}^2", state[0], state[1]);
        let spec = json!({ "format": 1, "name": "System", "poisson": [bracket], "state": state,
            "parameters": { "k": -2 }, "hamiltonian": energy, "initial": initial });
        let run = of(&spec, "run", "--method midpoint --step 0.1 --until 0.2").ok();
        said(&run).contains("backwards in time")
    };
    let two = &[0.1, 0.2];
    assert!(general("{q, p} = -1", &["q", "p"], two));
    assert!(general("{p, q} = 1", &["p", "q"], two));
    assert!(general("{q, p} = k", &["q", "p"], two));
    assert!(general("{u, v} = w", &["u", "v", "w"], &[0.1, 0.2, -1.0]));
    assert!(general("{u, v} = w^3", &["u", "v", "w"], &[0.1, 0.2, -1.0]));
    // controls
    assert!(!general("{q, p} = 1", &["q", "p"], two));
    assert!(!general("{p, q} = -1", &["p", "q"], two));
    assert!(!general("{u, v} = w", &["u", "v", "w"], &[0.1, 0.2, 1.0]));
    // a sign that is written is meant: a vortex of the other sense
    assert!(!general("{x, y} = -1", &["x", "y"], two));
    assert!(!general("{p1, p2} = k", &["p1", "p2"], two));
    // not a constant of the motion
    assert!(!general("{q, p} = q*p", &["q", "p"], &[-0.1, 0.2]));
}

#[test]
fn check_lists_brackets_with_their_signs() {
    let words = |run: Run| {
        run.ok()
            .stdout
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let text = words(of(&pendulum(1.0), "check", ""));
    for part in [
        "Poisson brackets: {q, p} = -z",
        "mechanics runs forwards where z < 0, backwards in time where z > 0; backwards at the initial state",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let text = words(of(&of_page("magnet"), "check", ""));
    assert!(text.contains("; forwards at the initial state"), "{text}");
    assert!(
        text.contains("turns as a body in its own frame or a magnetic moment"),
        "{text}"
    );
    let text = words(of(&of_page("dicke"), "check", ""));
    assert!(text.contains("turns as a textbook spin"), "{text}");
    let json: Value =
        serde_json::from_str(&of(&pendulum(1.0), "check", "--json").ok().stdout).expect("JSON");
    assert_eq!(json["brackets"], json!(["{q, p} = -z"]));
    let pair = json!({ "position": "q", "momentum": "p", "bracket": "-z", "forwards": "z < 0", "initial": "backwards" });
    assert_eq!(json["canonical"], json!([pair]));
    let json = lie("check specs/so3_free_rigid_body.json --json")
        .ok()
        .stdout;
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        json["brackets"],
        json!(["{x, y} = -z", "{x, z} = y", "{y, z} = -x"])
    );
    assert_eq!(json["canonical"], json!([]));
}

#[test]
fn new_systems_and_reports_say_the_sign() {
    let folder = folder();
    let new = |name: &str, algebra: &str| -> (Run, Value) {
        let mut call = command(["new", name, "--algebra", algebra]);
        let made = Run::from(
            call.current_dir(folder.path())
                .output()
                .expect("lie starts"),
        )
        .ok();
        let path = folder.path().join(format!("{name}.json"));
        let text = std::fs::read_to_string(path).expect("the spec");
        (made, serde_json::from_str(&text).expect("JSON"))
    };
    let (made, spec) = new("particle", "heisenberg(1)");
    let why = "starts from z = -1, since {q, p} = -z: so mechanics runs forwards in time";
    assert!(made.stdout.contains(why), "{}", made.stdout);
    assert!(spec["description"].to_string().contains(why), "{spec}");
    assert_eq!(spec["initial"][2], "-1");
    let run = of(&spec, "run", "--until 0.1").ok();
    assert!(!run.stderr.contains("note:"), "{}", run.stderr);
    let (_, spec) = new("several", "so(3) + heisenberg(1)^2");
    let initial = spec["initial"].as_array().expect("a list");
    assert_eq!(
        initial.iter().filter(|value| **value == "-1").count(),
        2,
        "{spec}"
    );
    let (made, _) = new("body", "so(3)");
    assert!(!made.stdout.contains("mechanics"), "{}", made.stdout);
    // a page on a system that runs backwards
    let path = folder.path().join("backwards.json");
    std::fs::write(&path, pendulum(1.0).to_string()).expect("the spec");
    let flags = [
        "--method",
        "gauss4",
        "--step",
        "0.1",
        "--until",
        "1",
        "--no-bench",
    ];
    let mut call = command(["report".as_ref(), path.as_os_str()]);
    Run::from(
        call.args(flags)
            .current_dir(folder.path())
            .output()
            .expect("lie starts"),
    )
    .ok();
    let page = std::fs::read_to_string(folder.path().join("backwards.html")).expect("the page");
    let words = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(
        words.matches("note: {q, p} = -z is -1.0").count(),
        1,
        "{words}"
    );
    assert!(words.contains("{q, p} = -z does not change in time"));
}

/// Rows of three numbers as `numpy.save` writes them.
fn npy(numbers: &[f64]) -> Vec<u8> {
    let rows = numbers.len() / 3;
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, 3), }}");
    let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    file.extend(format!("{header:<117}\n").bytes());
    file.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    file
}

/// What is carried beside the sites of a family, the time, inputs and the noise of each, is no site.
#[test]
fn the_time_is_no_site() {
    let mut chain = json!({
        "name": "Chain",
        "algebra": "heisenberg(1)^N",
        "state": ["q[i]", "p[i]", "c[i]"],
        "parameters": { "N": 3 },
        "inputs": {},
        "hamiltonian": "sum(i in 0..N: p[i]^2/2 + q[i]^2/2)",
        "initial": [],
        "run": { "method": "splitting4", "step": 0.1, "until": 0.2 }
    });
    let noise = json!([{ "force": { "p[i]": "0.1" } }]);
    for (key, value) in [
        ("inputs", json!({})),
        (
            "hamiltonian",
            json!("sum(i in 0..N: p[i]^2/2 + q[i]^2*cos(t)/2)"),
        ),
        ("forces", json!({ "p[i]": "-0.1*p[i]" })),
        (
            "inputs",
            json!({ "u": { "default": 0 }, "v": { "default": 1 } }),
        ),
        ("noise", noise),
    ] {
        let mut spec = chain.clone();
        spec[key] = value;
        spec.as_object_mut().unwrap().remove("initial");
        let with = |units: &str, flags: &str| {
            let call = format!("--initial=1,0,0,0,1,0,{units} {flags}");
            said(&of(&spec, "run", &call).ok())
        };
        let right = with("-1,-1,-2", "");
        assert!(!right.contains("backwards"), "{key}: {right}");
        let one = with("-1,3,-2", "");
        assert!(one.contains("is negative at 1 of 3 sites"), "{key}: {one}");
    }
    chain["forces"] = json!({ "p[i]": "-0.1*p[i]" });
    for (units, says) in [
        ([-1, -1, -1], "; forwards at the initial state"),
        ([1, 1, 1], "; backwards at the initial state"),
        ([1, -1, 1], "; forwards at some sites of the initial state"),
    ] {
        let folder = folder();
        let file = folder.path().join("start.npy");
        let rows = units.map(|unit| [1.0, 0.0, f64::from(unit)]);
        std::fs::write(&file, npy(rows.as_flattened())).unwrap();
        chain["initial"] = json!({ "npy": file });
        let told = of(&chain, "check", "").ok();
        let words: Vec<&str> = told.stdout.split_whitespace().collect();
        assert!(words.join(" ").contains(says), "{says}: {}", told.stdout);
    }
}
