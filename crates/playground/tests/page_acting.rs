//! What acts beside the Hamiltonian, in a page: columns, events, inputs, noise.

use lie_playground::Session;
use serde_json::{Value, json};

fn asked(session: &mut Session, request: &Value) -> Value {
    serde_json::from_str(&session.answer(&request.to_string())).expect("JSON")
}

fn open(session: &mut Session, spec: &Value, more: &Value) -> Value {
    let mut request = json!({ "declaration": spec.to_string(), "method": "gauss4", "step": 0.05 });
    let all = request.as_object_mut().expect("an object");
    all.extend(more.as_object().expect("an object").clone());
    asked(session, &request)
}

fn rows(answer: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(answer["rows"].clone()).unwrap_or_else(|_| panic!("{answer}"))
}

/// A body with drag, a motor, something to read off, and an event.
fn driven() -> Value {
    json!({
        "name": "Driven", "algebra": "so(3)", "state": ["x", "y", "z"],
        "inputs": { "u": { "default": 0 } },
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6",
        "forces": { "x": "-x/10", "z": "u" },
        "observables": { "size": "sqrt(x^2 + y^2 + z^2)" },
        "events": { "across": { "when": "y" }, "high": { "when": "z - 3", "stop": true } },
        "initial": [0.9, 0.4, 0.3]
    })
}

#[test]
fn columns_events_and_inputs() {
    let mut session = Session::default();
    let about = open(&mut session, &driven(), &json!({}));
    assert_eq!(about["coordinates"], json!(["x", "y", "z"]), "{about}");
    assert_eq!(about["invariants"], json!(["energy - work"]));
    assert_eq!(about["quantities"], json!(["work", "size", "u"]));
    assert_eq!(about["events"], json!(["across", "high"]));
    assert_eq!(about["inputs"], json!([{ "name": "u", "value": 0.0 }]));
    let first = asked(&mut session, &json!({ "steps": 400, "every": 10 }));
    let seen = rows(&first);
    assert_eq!((seen.len(), seen[0].len()), (41, 1 + 3 + 1 + 1 + 3 + 3));
    let (start, end) = (&seen[0], &seen[40]);
    // drag takes energy, and the balance is the error of the method
    assert!(end[4] < 0.8 * start[4] && end[6] < 0.0, "{end:?}");
    assert!((end[5] - start[5]).abs() < 1e-4, "{start:?} {end:?}");
    assert_ne!(end[5], start[5], "it has an error");
    let size = end[1..4].iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((end[7] - size).abs() < 1e-15 && end[8] == 0.0, "{end:?}");
    // each change of the sign of y between rows of all steps is an event
    let mut again = Session::default();
    open(&mut again, &driven(), &json!({}));
    let steps = rows(&asked(&mut again, &json!({ "steps": 400 })));
    let changes = steps
        .windows(2)
        .filter(|pair| pair[0][2] * pair[1][2] < 0.0);
    let events = first["events"].as_array().expect("a list");
    assert_eq!(events.len(), changes.count());
    assert!(!events.is_empty());
    // the motor turns it about z until the other event ends the run
    let second = asked(
        &mut session,
        &json!({ "steps": 4000, "every": 10, "inputs": { "u": 0.5 } }),
    );
    let last = rows(&second).pop().expect("a row");
    assert!((last[3] - 3.0).abs() < 1e-12 && last[8] == 0.5, "{last:?}");
    assert!(last[0] < 220.0);
    let stopped = second["stopped"].as_str().expect("it stops");
    assert!(stopped.contains("high"), "{stopped}");
    let wrong = asked(&mut session, &json!({ "steps": 1, "inputs": { "v": 1 } }));
    assert_eq!(wrong["error"], "there is no input `v`");
}

/// A spin at a temperature.
fn spin() -> Value {
    json!({
        "name": "Spin", "algebra": "so(3)", "state": ["x", "y", "z"],
        "hamiltonian": "z", "casimirs": ["C = x^2 + y^2 + z^2"],
        "dissipation": [{ "kind": "double-bracket", "strength": "1", "temperature": "3/10" }],
        "initial": [0.6, 0, 0.8]
    })
}

#[test]
fn noise_has_a_seed_and_requests_go_on() {
    let end = |seed: u64, steps: &[u64]| {
        let mut session = Session::default();
        let about = open(&mut session, &spin(), &json!({ "seed": seed }));
        assert_eq!(about["noises"], 3, "{about}");
        assert_eq!(
            about["invariants"],
            json!(["C"]),
            "no balance has the noise"
        );
        let answers = steps.iter().map(|steps| {
            let answer = asked(&mut session, &json!({ "steps": steps, "every": 40 }));
            rows(&answer).pop().expect("a row")
        });
        answers.last().expect("an answer")
    };
    let whole = end(1, &[200]);
    let square: f64 = whole[1..4].iter().map(|x| x * x).sum();
    assert!((square - 1.0).abs() < 1e-12, "{whole:?}");
    let parts = end(1, &[80, 120]);
    let pairs = whole[1..4].iter().zip(&parts[1..4]);
    assert!(
        pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-11),
        "{whole:?} {parts:?}"
    );
    assert_ne!(whole[1..4], end(2, &[200])[1..4]);
}

#[test]
fn a_family_with_damping_runs() {
    let spec = json!({
        "name": "Chain", "algebra": "so(3)^N", "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 4 },
        "hamiltonian": "sum(i in 0..N: -x[i]*x[i+1] - y[i]*y[i+1] - z[i]*z[i+1] - z[i]/2)",
        "dissipation": [{ "kind": "double-bracket", "strength": "1/5" }],
        "initial": { "random": "unit-sphere", "seed": 1 }
    });
    let mut session = Session::default();
    let about = open(&mut session, &spec, &json!({ "method": "rk4" }));
    assert_eq!(
        about["coordinates"].as_array().map(Vec::len),
        Some(12),
        "{about}"
    );
    let seen = rows(&asked(&mut session, &json!({ "steps": 400, "every": 100 })));
    assert!(
        seen.windows(2).all(|pair| pair[1][13] < pair[0][13]),
        "H falls"
    );
}

/// The words that follow a mark in a text.
fn words_behind<'a>(text: &'a str, mark: &str) -> Vec<&'a str> {
    let end = |rest: &str| rest.find(|c: char| !c.is_alphanumeric() && c != '-' && c != '_');
    let parts = text.split(mark).skip(1);
    parts
        .map(|rest| &rest[..end(rest).unwrap_or(rest.len())])
        .filter(|word| !word.is_empty())
        .collect()
}

/// What the page reads of an answer is in it, and what it looks for in the page too.
#[test]
fn the_page_reads_what_is_there() {
    let (script, head) = (
        include_str!("../page/page.js"),
        include_str!("../page/head.html"),
    );
    let mut session = Session::default();
    let about = open(&mut session, &driven(), &json!({}));
    let answer = asked(&mut session, &json!({ "steps": 200 }));
    for (mark, found) in [("about.", &about), ("answer.", &answer)] {
        let read = words_behind(script, mark);
        assert!(read.len() > 1, "{mark}");
        for key in read {
            assert!(found.get(key).is_some(), "{mark}{key} in {found}");
        }
    }
    for id in words_behind(script, "$(\"") {
        // the module comes behind the head
        let there = id == "module" || head.contains(&format!("id=\"{id}\""));
        assert!(there, "{id}");
    }
}
