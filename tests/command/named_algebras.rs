//! A spec with the name of an algebra at the command: it is checked and run as if the brackets were written out.

use crate::common::{folder, lie};
use serde_json::{Value, json};

/// The heavy top by the name of its algebra.
fn heavy_top() -> Value {
    let text = std::fs::read_to_string("specs/se3_heavy_top.json").expect("the spec");
    let mut spec: Value = serde_json::from_str(&text).expect("JSON");
    spec["algebra"] = json!("se(3)");
    spec
}

#[test]
fn a_named_algebra_is_checked_and_run() {
    let folder = folder();
    let path = folder.path().join("named.json");
    std::fs::write(&path, heavy_top().to_string()).expect("the spec is written");
    let named = path.display();
    let check = |path: &str| lie(&format!("check {path} --json")).ok().stdout;
    assert_eq!(check(&named.to_string()), check("specs/se3_heavy_top.json"));
    let run = |path: &str, method: &str| {
        let options = "--step 0.05 --until 1 --quiet";
        lie(&format!("run {path} --method {method} {options}"))
            .ok()
            .stdout
    };
    for method in ["lie-midpoint", "isospectral4"] {
        let rows = run(&named.to_string(), method);
        assert!(rows.lines().count() == 22, "{rows}");
        assert_eq!(rows, run("specs/se3_heavy_top.json", method));
    }
}

#[test]
fn the_standard_names_are_the_columns() {
    let folder = folder();
    let path = folder.path().join("standard.json");
    let spec = json!({
        "name": "Pair",
        "algebra": "so(3)^2",
        "hamiltonian": "x1^2/2 + y1^2/3 + z2^2/4 + x1*x2 + y1*y2 + z1*z2",
        "casimirs": ["x1^2 + y1^2 + z1^2", "x2^2 + y2^2 + z2^2"],
        "initial": [1, 0, "1/2", 0, 1, "1/3"],
    });
    std::fs::write(&path, spec.to_string()).expect("the spec is written");
    let run = lie(&format!(
        "run {} --method lie-midpoint --step 0.1 --until 1 --quiet",
        path.display()
    ))
    .ok();
    let (header, rows) = run.csv();
    let columns = [
        "t", "x1", "y1", "z1", "x2", "y2", "z2", "energy", "C1", "C2",
    ];
    assert_eq!(header, columns);
    for row in &rows {
        let (first, last) = (&rows[0][8..], &row[8..]);
        assert!(
            first.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-14),
            "{row:?}"
        );
    }
}

#[test]
fn a_wrong_name_is_refused_at_its_place() {
    let folder = folder();
    let path = folder.path().join("wrong.json");
    let text = "{\n  \"name\": \"A\",\n  \"algebra\": \"R + sso(3)\",\n  \"hamiltonian\": \"1\"\n}";
    std::fs::write(&path, text).expect("the spec is written");
    let run = lie(&format!("check {}", path.display()));
    assert!(run.stderr.contains("did you mean `so`?"), "{}", run.stderr);
    run.error("unknown-symbol", &format!("{}:3:19", path.display()));
}
