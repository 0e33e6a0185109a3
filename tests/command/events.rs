//! Events of a run: the table, what stops, what is refused.

use std::path::Path;

use crate::common::{Run, csv, folder, lie};
use serde_json::{Value, json};

/// A body of revolution: x + i y = r exp(-i z t) with z = 1.7, up to the sign of the rotation.
fn body() -> Value {
    json!({
        "name": "Body",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/2 + z^2",
        "events": {
            "zero": { "when": "x" },
            "low": { "when": "y", "direction": -1 }
        },
        "initial": [0.6, 0.3, 1.7],
        "run": { "method": "gauss12", "step": 0.5, "until": 20 }
    })
}

fn call(spec: &Value, flags: &str) -> (Run, String) {
    let folder = folder();
    let [path, table] = ["spec.json", "events.csv"].map(|name| folder.path().join(name));
    std::fs::write(&path, spec.to_string()).unwrap();
    let call = format!(
        "run {} --events {} {flags}",
        path.display(),
        table.display()
    );
    let run = lie(&call);
    (run, std::fs::read_to_string(&table).unwrap_or_default())
}

fn check(spec: &Value) -> Run {
    let folder = folder();
    let path = folder.path().join("spec.json");
    std::fs::write(&path, spec.to_string()).unwrap();
    lie(&format!("check {}", path.display()))
}

/// The rows of an event: time and state.
fn of<'a>(table: &'a str, name: &'a str) -> Vec<Vec<f64>> {
    let lines = table.lines().skip(1);
    let rows = lines.filter_map(|line| line.split_once(',').filter(|(event, _)| *event == name));
    rows.map(|(_, rest)| rest.split(',').map(|x| x.parse().unwrap()).collect())
        .collect()
}

#[test]
fn a_table_has_them_in_order_of_time() {
    let (run, table) = call(&body(), "");
    let run = run.ok();
    assert_eq!(table.lines().next(), Some("event,t,x,y,z"));
    let (zero, low) = (of(&table, "zero"), of(&table, "low"));
    assert_eq!(zero.len() + low.len() + 1, table.lines().count());
    let said = format!("events: low {}, zero {}", low.len(), zero.len());
    assert!(run.stderr.contains(&said), "{}", run.stderr);
    let times = |rows: &[Vec<f64>]| rows.iter().map(|row| row[0]).collect::<Vec<f64>>();
    let gaps = |times: &[f64], gap: f64| {
        let mut pairs = times.windows(2);
        pairs.all(|pair| (pair[1] - pair[0] - gap).abs() < 1e-12)
    };
    // half a turn from zero to zero, a whole one from fall to fall
    let half = std::f64::consts::PI / 1.7;
    assert!(zero.len() > 9 && gaps(&times(&zero), half));
    assert!(low.len() > 4 && gaps(&times(&low), 2.0 * half));
    assert!(zero.iter().all(|row| row[1].abs() < 1e-14));
    assert!(low.iter().all(|row| row[2].abs() < 1e-14));
    let lines = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse::<f64>().unwrap());
    assert!(lines.collect::<Vec<f64>>().is_sorted());
    // the rows are those of a run without events
    let mut without = body();
    without.as_object_mut().unwrap().remove("events");
    let folder = folder();
    let path = folder.path().join("spec.json");
    std::fs::write(&path, without.to_string()).unwrap();
    let plain = lie(&format!("run {}", path.display())).ok();
    assert_eq!(plain.stdout, run.stdout);
    assert!(!plain.stderr.contains("event"), "{}", plain.stderr);
}

#[test]
fn one_that_stops_ends_the_run_in_order() {
    let mut spec = body();
    spec["events"]["low"]["stop"] = json!(true);
    for flags in [
        "",
        "--step 0.07 --every 3",
        "--at 0,0.3,1,5,20",
        "--tol 1e-10",
        "--method exact --step 7",
        "--from 3 --until 40",
    ] {
        let (run, table) = call(&spec, flags);
        let run = run.ok();
        let (header, rows) = run.csv();
        assert_eq!(header.join(","), "t,x,y,z,energy,C1");
        let low = of(&table, "low");
        assert_eq!(low.len(), 1, "{flags}: {table}");
        let last = rows.last().unwrap();
        assert_eq!(&last[..4], low[0].as_slice(), "{flags}");
        assert!(last[2].abs() < 1e-12);
        assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        assert!(
            run.stderr.contains("`low` ended the run at t = "),
            "{}",
            run.stderr
        );
    }
    // followed on the group, the element is that of the last row
    let (run, table) = call(&spec, "--group matrix --method lie-midpoint --step 0.1");
    let (_, rows) = run.ok().csv();
    let last = rows.last().unwrap();
    let time = of(&table, "low")[0][0];
    let mut plain = spec.clone();
    plain["events"]["low"]["stop"] = json!(false);
    let (run, _) = call(
        &plain,
        &format!("--group matrix --method lie-midpoint --step 0.1 --at {time:?}"),
    );
    let (_, there) = run.ok().csv();
    for (a, b) in last.iter().zip(&there[0]) {
        assert!((a - b).abs() < 1e-14);
    }
}

#[test]
fn json_has_them() {
    let mut spec = body();
    spec["events"]["low"]["stop"] = json!(true);
    let (run, table) = call(&spec, "--format json");
    let json: Value = serde_json::from_str(&run.ok().stdout).unwrap();
    let events = json["events"].as_array().unwrap();
    assert_eq!(events.len() + 1, table.lines().count());
    let last = events.last().unwrap();
    assert_eq!(
        (&last["event"], &json["status"]),
        (&json!("low"), &json!("done"))
    );
    assert_eq!(last["mu"].as_array().unwrap().len(), 3);
    assert_eq!(
        json["rows"].as_array().unwrap().last().unwrap()[0],
        last["t"]
    );
}

#[test]
fn several_runs_have_a_column_for_their_number() {
    let (run, table) = call(
        &body(),
        "--quiet --method gauss8 --method gauss12 --until 3",
    );
    run.ok();
    assert_eq!(table.lines().next(), Some("run,event,t,x,y,z"));
    assert!(table.contains("\n0,zero,") && table.contains("\n1,zero,"));
}

#[test]
fn a_run_that_goes_on_has_those_before() {
    let mut spec = body();
    spec["events"]["end"] = json!({ "when": "t - 299.5", "stop": true });
    let folder = folder();
    let at = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(at("spec.json"), spec.to_string()).unwrap();
    let call = |name: &str| {
        format!(
            "run {} --quiet --method gauss4 --step 0.005 --until 400 --every 100 --checkpoint {} --checkpoint-every 1000 --out {} --events {}",
            at("spec.json"),
            at(&format!("{name}.ck")),
            at(&format!("{name}.csv")),
            at(&format!("{name}.events.csv"))
        )
    };
    lie(&call("whole")).ok();
    let mut child = crate::common::command(call("part").split(' '))
        .spawn()
        .unwrap();
    while std::fs::metadata(at("part.csv")).map_or(true, |file| file.len() < 4000) {
        if child.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::yield_now();
    }
    let _ = child.kill();
    let _ = child.wait();
    lie(&format!("resume {}", at("part.ck"))).ok();
    let read = |name: &str| std::fs::read_to_string(at(name)).unwrap();
    assert_eq!(read("part.csv"), read("whole.csv"));
    assert_eq!(read("part.events.csv"), read("whole.events.csv"));
    let (_, rows) = csv(&read("whole.csv"));
    assert!((rows.last().unwrap()[0] - 299.5).abs() < 1e-12);
    assert!(of(&read("whole.events.csv"), "zero").len() > 150);
}

#[test]
fn what_does_not_fit_is_refused() {
    for (events, kind, text) in [
        (
            json!({ "a": { "when": "x", "direction": 2 } }),
            "schema",
            "-1, 0 or 1",
        ),
        (
            json!({ "a": { "when": "x", "stop": 1 } }),
            "schema",
            "`stop`",
        ),
        (json!({ "a": { "direction": 1 } }), "schema", "`when`"),
        (
            json!({ "a": { "when": "x", "direktion": 1 } }),
            "schema",
            "did you mean `direction`?",
        ),
        (json!({ "a": "x" }), "schema", "an object"),
        (json!(["x"]), "schema", "an object"),
        (json!({ "a": { "when": "q" } }), "unknown-symbol", "q"),
        (
            json!({ "a": { "when": "1/2" } }),
            "event",
            "does not depend on the state",
        ),
        (
            json!({ "a": { "when": "x = 1" } }),
            "syntax",
            "an event is a function, not an equation",
        ),
        (json!({ "a b": { "when": "x" } }), "syntax", "not a name"),
    ] {
        let mut spec = body();
        spec["events"] = events;
        let said = check(&spec).error(kind, "").stderr;
        assert!(said.contains(text), "{said}");
    }
    // labels are their own: one may have the name of a coordinate
    let mut spec = body();
    spec["events"] = json!({ "x": { "when": "x" } });
    check(&spec).ok();
    let mut none = body();
    none.as_object_mut().unwrap().remove("events");
    let (run, _) = call(&none, "");
    run.error("option", "command line: --events");
    let (run, _) = call(&body(), "--out events.txt");
    assert_ne!(run.code, Some(0), "a name without a form");
}

#[test]
fn verify_compares_their_functions() {
    let mut spec = body();
    spec["events"]["low"]["stop"] = json!(true);
    let folder = folder();
    let path: &Path = &folder.path().join("spec.json");
    std::fs::write(path, spec.to_string()).unwrap();
    let said = lie(&format!(
        "verify {} --method midpoint --json",
        path.display()
    ))
    .ok()
    .stdout;
    assert!(said.contains("\"events\""), "{said}");
}

/// What happens at the time at which a run stops is told, whatever was declared first; what is behind it is not.
#[test]
fn events_at_the_time_of_a_stop_are_kept() {
    let mut spec = body();
    let stop = json!({ "when": "t - 1", "stop": true });
    let [same, doubled] = ["t - 1", "exp(t) - exp(1)"].map(|when| json!({ "when": when }));
    let later = json!({ "when": "t - 1.0001" });
    for step in ["0.3", "0.5"] {
        for order in [["r", "s", "w"], ["s", "r", "w"], ["w", "s", "r"]] {
            // a map of JSON has the order in which it is written
            let mut events = String::new();
            for name in order {
                let rule = match name {
                    "r" => format!("\"r\": {same}, \"a\": {doubled}"),
                    "s" => format!("\"s\": {stop}, \"l\": {later}"),
                    _ => format!("\"w\": {stop}"),
                };
                events = [events, rule].join(if name == order[0] { "" } else { ", " });
            }
            spec["events"] = json!("EVENTS");
            let text = spec
                .to_string()
                .replace("\"EVENTS\"", &format!("{{{events}}}"));
            let folder = folder();
            let [path, table] = ["spec.json", "events.csv"].map(|name| folder.path().join(name));
            std::fs::write(&path, text).unwrap();
            let call = format!(
                "run {} --step {step} --events {}",
                path.display(),
                table.display()
            );
            let run = lie(&call).ok();
            assert_eq!(run.csv().1.last().unwrap()[0], 1.0);
            let table = std::fs::read_to_string(&table).unwrap();
            let mut found: Vec<(String, f64)> = Vec::new();
            for line in table.lines().skip(1) {
                let mut cells = line.split(',');
                let name = cells.next().unwrap().to_owned();
                let time: f64 = cells.next().unwrap().parse().unwrap();
                if time > 0.999 {
                    found.push((name, time));
                }
            }
            let off = found.iter().map(|(_, time)| (time - 1.0).abs());
            assert!(off.fold(0.0, f64::max) < 1e-15, "{found:?}");
            let mut names: Vec<String> = found.into_iter().map(|(name, _)| name).collect();
            names.sort();
            assert_eq!(names, ["a", "r", "s", "w"], "{order:?}: {table}");
        }
    }
}

/// Events are expressions of the state: names of columns are told from those that nobody knows.
#[test]
fn names_of_columns_are_no_functions() {
    let mut spec = body();
    spec["observables"] = json!({ "h": "z^2" });
    for (when, says, help) in [
        (
            "h - 1",
            "`h` is an observable",
            "write the expression of `h` out",
        ),
        (
            "energy - 1",
            "the column of the energy",
            "write the Hamiltonian out",
        ),
        (
            "nothing - 1",
            "unknown symbol `nothing`",
            "declare `nothing` as a parameter",
        ),
    ] {
        spec["events"] = json!({ "e": { "when": when } });
        let said = check(&spec).error("unknown-symbol", "").stderr;
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(says) && said.contains(help), "{said}");
    }
    // an entry of a group element that is not declared
    spec["events"] = json!({});
    spec["forces"] = json!({ "x": "-R11*x" });
    let said = check(&spec).error("unknown-symbol", "").stderr;
    assert!(said.contains("\"group\": \"R\""), "{said}");
    spec["group"] = json!("R");
    check(&spec).ok();
}
