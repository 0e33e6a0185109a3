//! `--keep`: energy and Casimirs by a projection behind the steps of explicit methods. What it does to steps is tested with the driver,
//! in `lie-runtime/tests/projection.rs`.

use crate::common::{folder, lie, spec};
use serde_json::Value;

const TOP: &str = "run specs/se3_heavy_top.json --until 20 --step 0.1";

#[test]
fn the_command_keeps_and_says_so() {
    let run = lie(&format!(
        "{TOP} --method dopri5 --rtol 1e-5 --keep energy,casimirs"
    ))
    .ok();
    assert!(
        run.stderr
            .contains("kept by a projection behind each step, which is no Poisson map"),
        "{}",
        run.stderr
    );
    let (header, rows) = run.csv();
    for column in header
        .iter()
        .position(|name| name == "energy")
        .expect("energy")..header.len()
    {
        let moved = rows.iter().map(|row| (row[column] - rows[0][column]).abs());
        let moved = moved.fold(0.0, f64::max);
        assert!(moved < 1e-14, "{}: {moved:e}", header[column]);
    }
    let plain = lie(&format!("{TOP} --method dopri5 --rtol 1e-5")).ok();
    assert!(!plain.stderr.contains("projection"));
    let moved = |rows: &[Vec<f64>]| (rows[rows.len() - 1][7] - rows[0][7]).abs();
    assert!(moved(&plain.csv().1) > 1e-9, "the control");
    let several = lie(&format!("{TOP} --method rk4 --method taylor --keep energy")).ok();
    assert!(
        several.stderr.contains("rk4: energy kept by a projection"),
        "{}",
        several.stderr
    );
}

#[test]
fn files_say_what_was_kept() {
    let kept = ["energy", "length2", "vertical_momentum"];
    let run = |flags: &str| {
        let run = lie(&format!("{TOP} --quiet --format json --method rk4 {flags}"));
        serde_json::from_str::<Value>(&run.ok().stdout).expect("JSON")
    };
    let json = run("--keep energy,casimirs");
    assert_eq!(json["kept"], serde_json::json!(kept));
    let columns = json["columns"].as_array().expect("columns");
    assert!(kept.iter().all(|name| columns.contains(&(*name).into())));
    assert_eq!(run("--keep energy")["kept"], serde_json::json!(["energy"]));
    assert_eq!(run("").get("kept"), None, "nothing was");
    let several = run("--method dopri5 --keep casimirs");
    for run in several["runs"].as_array().expect("runs") {
        assert_eq!(run["kept"], serde_json::json!(kept[1..]));
    }
}

#[test]
fn ensembles_keep_and_say_so() {
    let folder = folder();
    let out = folder.path().join("all.npy");
    let ensemble = |flags: &str| {
        let call = format!(
            "ensemble specs/se3_heavy_top.json --members 4 --method rk4 --step 0.1 --until 20 {flags} --out {}",
            out.display()
        );
        let run = lie(&call).ok();
        let text = std::fs::read_to_string(format!("{}.json", out.display()));
        let record: Value = serde_json::from_str(&text.expect("a record")).expect("JSON");
        (run.stderr, record)
    };
    let (said, record) = ensemble("--keep energy,casimirs");
    assert!(
        said.contains("kept by a projection behind each step"),
        "{said}"
    );
    let kept = serde_json::json!(["energy", "length2", "vertical_momentum"]);
    assert_eq!(record["kept"], kept);
    let (said, record) = ensemble("");
    assert!(!said.contains("projection"), "{said}");
    assert_eq!(record.get("kept"), None);
    // what the spec asks for too
    let path = spec(folder.path(), |spec| {
        spec["run"] =
            serde_json::json!({"method": "rk4", "step": 0.1, "until": 1, "keep": "energy"});
    });
    let call = format!(
        "ensemble {} --members 2 --out {}",
        path.display(),
        out.display()
    );
    let said = lie(&call).ok().stderr;
    assert!(said.contains("energy kept by a projection"), "{said}");
}

#[test]
fn a_tolerance_picks_a_method_that_keeps_where_that_is_asked_for() {
    let top = lie("run specs/se3_heavy_top.json --until 20 --tol 1e-6 --keep energy,casimirs").ok();
    for text in ["taylor was picked", "something is to be kept", "kept by a"] {
        assert!(top.stderr.contains(text), "{text}: {}", top.stderr);
    }
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["run"] =
            serde_json::json!({"method": "dopri5", "step": 0.1, "until": 5, "keep": "casimirs"});
    });
    let path = path.display();
    let of_spec = lie(&format!("run {path} --tol 1e-6")).ok();
    for text in [
        "taylor was picked in place of dopri5, which the spec names",
        "kept by a projection",
    ] {
        assert!(of_spec.stderr.contains(text), "{text}: {}", of_spec.stderr);
    }
    // one that was named has options of its own
    let named = lie(&format!("run {path} --tol 1e-6 --method gauss8")).ok();
    assert!(!named.stderr.contains("projection"), "{}", named.stderr);
    let chain = "run tests/data/families/heisenberg_chain.json --param N=16 --until 1 --tol 1e-4";
    let chain = lie(&format!("{chain} --keep energy")).ok();
    assert!(chain.stderr.contains("rk4 was picked"), "{}", chain.stderr);
}

#[test]
fn the_command_refuses_what_cannot_be_kept() {
    for (call, word, why) in [
        (
            "specs/so3_gravity_gradient.json --keep casimirs,speed",
            "speed",
            "nothing that can be kept",
        ),
        (
            "specs/canonical_pendulum.json --keep casimirs",
            "casimirs",
            "no Casimirs of",
        ),
        (
            "tests/data/families/heisenberg_chain.json --keep casimirs",
            "casimirs",
            "each of its sites",
        ),
        (
            "tests/data/driven/top.json --keep energy",
            "energy",
            "H of ShakenTop changes with the time",
        ),
        // a quotient, where its denominator vanishes
        (
            "tests/data/quotient.json --keep casimirs --initial 1,0,0",
            "begin elsewhere",
            "a value at the start is not finite",
        ),
    ] {
        let run = lie(&format!("run {call} --method rk4 --step 0.1 --until 1"));
        let run = run.error("option", "command line: --keep");
        assert!(run.stderr.contains(why), "{call}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{call}: {}", run.stderr);
    }
}
