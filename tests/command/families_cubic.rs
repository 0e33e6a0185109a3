//! Lattices of three dimensions at the command.

use std::fs;
use std::path::Path;

use crate::common::{folder, lie};
use serde_json::{Value, json};

const CUBE: &str = "tests/data/families/cubic_lattice.json";

/// The spec in a folder, with what is given instead.
fn cube(folder: &Path, keys: &[(&str, Value)]) -> String {
    let text = fs::read_to_string(CUBE).unwrap();
    let mut spec: Value = serde_json::from_str(&text).unwrap();
    for (key, value) in keys {
        match key.split_once('.') {
            Some((key, part)) => spec[key][part] = value.clone(),
            None => spec[*key] = value.clone(),
        }
    }
    let path = folder.join("cube.json");
    fs::write(&path, serde_json::to_string_pretty(&spec).unwrap()).unwrap();
    path.display().to_string()
}

/// The NPY file of an array.
fn npy(shape: &str, numbers: &[f64]) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// Some numbers.
fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|k| (1.0 + k as f64).sin()).collect()
}

#[test]
fn check_and_expand_show_three_axes() {
    let run = lie(&format!("check {CUBE}")).ok();
    let stdout = run.stdout.replace("\n        ", " ");
    for text in [
        "a lattice of 3 x 2 x 4 sites: dimension 72, generic rank 48, 24 independent Casimirs",
        "exchange with [+1]\n",
        "exchange with [+1,+0,+0]",
        "z*z[+1,+0]",
        "J: 24 values",
    ] {
        assert!(stdout.contains(text), "{text}: {stdout}");
    }
    let run = lie(&format!("expand {CUBE}")).ok();
    for text in ["[-1, 0, 0]", "[0, 0, 1]", "offset: [1, 0, 0]"] {
        assert!(run.stdout.contains(text), "{text}");
    }
}

#[test]
fn rows_have_a_column_for_each_site() {
    let run = lie(&format!("run {CUBE} --at 0,1")).ok();
    let (names, rows) = run.csv();
    let wanted = [
        "t",
        "x[0][0][0]",
        "x[0][0][1]",
        "x[0][0][2]",
        "x[0][0][3]",
        "x[0][1][0]",
    ];
    assert_eq!(names[..6], wanted);
    assert_eq!(names[24..26], ["x[2][1][3]", "y[0][0][0]"]);
    let m = names.iter().position(|name| name == "m").unwrap();
    for row in &rows {
        let mean = row[49..73].iter().sum::<f64>() / 24.0;
        assert!((row[m] - mean).abs() < 1e-15, "{} {mean}", row[m]);
    }
    assert!((rows[0][3] - rows[1][3]).abs() > 1e-3);
    let folder = folder();
    let picture = folder.path().join("phase.svg");
    let call = format!(
        "run {CUBE} --picture phase:x[2][1][3],y[0][0][0] --plot {}",
        picture.display()
    );
    lie(&call).ok();
    assert!(fs::read_to_string(picture).unwrap().contains("x[2][1][3]"));
    let wrong = call.replace("x[2][1][3]", "x[2][1]");
    let wrong = lie(&wrong).error("option", "command line: --picture");
    assert!(
        wrong.stderr.contains("unknown column `x[2][1]`"),
        "{}",
        wrong.stderr
    );
}

#[test]
fn values_of_sites_are_read_from_files() {
    let folder = folder();
    let values = numbers(24);
    let nested: Vec<Vec<&[f64]>> = values
        .chunks(8)
        .map(|layer| layer.chunks(4).collect())
        .collect();
    let run = |given: Value| {
        lie(&format!(
            "run {} --at 1",
            cube(folder.path(), &[("parameters.B", given)])
        ))
    };
    let expected = run(json!({ "values": nested })).ok().stdout;
    let other = run(json!({ "values": vec![vec![vec![1; 4]; 2]; 3] }))
        .ok()
        .stdout;
    assert_ne!(other, expected, "the values do something");
    let place = format!("{}:", folder.path().join("cube.json").display());
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let lines: Vec<String> = values
        .chunks(4)
        .map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(","))
        .collect();
    for (name, bytes) in [
        ("B.npy", npy("(3, 2, 4)", &values)),
        ("rows.npy", npy("(6, 4)", &values)),
        (
            "B.csv",
            format!("# a layer\n{}\n", lines.join("\n")).into_bytes(),
        ),
    ] {
        write(name, &bytes);
        let found = run(json!({ "file": name })).ok().stdout;
        assert_eq!(found, expected, "{name}");
    }
    for (name, bytes, text) in [
        (
            "B.npy",
            npy("(2, 3, 4)", &values),
            "`B` has 2 x 3 x 4 values, and there are 3 x 2 x 4 sites",
        ),
        (
            "B.npy",
            npy("(3, 2, 2, 2)", &values),
            "`B` has 3 x 2 x 2 x 2 values",
        ),
        (
            "B.csv",
            format!("{}\n", lines[1..].join("\n")).into_bytes(),
            "`B` has 5 x 4 values",
        ),
    ] {
        write(name, &bytes);
        let refused = run(json!({ "file": name })).error("state-length", &place);
        assert!(refused.stderr.contains(text), "{text}: {}", refused.stderr);
    }
    let refused =
        lie(&format!("run {CUBE} --param L=2")).error("state-length", "command line: --param");
    let text = "and there are 2 x 2 x 4 sites";
    assert!(refused.stderr.contains(text), "{}", refused.stderr);
}

#[test]
fn a_run_starts_at_an_array_with_an_axis_for_each_index() {
    let folder = folder();
    let path = cube(folder.path(), &[("initial", json!({ "npy": "start.npy" }))]);
    let values = numbers(72);
    let start = |shape: &str| {
        fs::write(folder.path().join("start.npy"), npy(shape, &values)).unwrap();
        lie(&format!("run {path} --at 0"))
    };
    let (_, rows) = start("(3, 2, 4, 3)").ok().csv();
    for (site, coordinates) in values.chunks(3).enumerate() {
        let found = [0, 1, 2].map(|k| rows[0][1 + 24 * k + site]);
        assert_eq!(found, coordinates, "{site}");
    }
    assert_eq!(start("(24, 3)").ok().csv().1, rows);
    for shape in ["(2, 3, 4, 3)", "(3, 8, 3)", "(3, 2, 3, 4)"] {
        let refused = start(shape).error("state-length", &format!("{path}:"));
        for text in ["for 24 sites of 3 coordinates", "(24, 3) or (3, 2, 4, 3)"] {
            assert!(refused.stderr.contains(text), "{text}: {}", refused.stderr);
        }
    }
}

/// Couplings of another kind along each axis, of any size.
fn plain(folder: &Path) -> String {
    let h = "-sum(i in 0..L, j in 0..N, k in 0..M-1: x[i,j,k]*x[i+1,j,k] + y[i,j,k]*y[i+1,j,k] + z[i,j,k]*z[i+1,j,k] + 2*x[i,j,k]*x[i,j,k+1]) - sum(i in 0..L, j in 0..N-1, k in 0..M: y[i,j,k]*y[i,j+1,k]) - sum(i in 0..L, j in 0..N, k in 0..M: z[i,j,k]*(i0 + z[i,j,k]))";
    cube(
        folder,
        &[
            ("parameters", json!({ "L": 3, "N": 2, "M": 2, "i0": 1 })),
            ("hamiltonian", json!(h)),
        ],
    )
}

#[test]
fn small_ones_are_measured() {
    let folder = folder();
    let path = plain(folder.path());
    let run = lie(&format!(
        "verify {path} --methods gauss8,splitting4,rk4 --json"
    ))
    .ok();
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    for (method, order) in [("gauss8", 8.0), ("splitting4", 4.0), ("rk4", 4.0)] {
        let fact = &found["methods"][method]["order"];
        assert_eq!(
            (&fact["claim"], &fact["verdict"]),
            (&json!(order), &json!("holds")),
            "{fact}"
        );
    }
    let section = "--methods rk4 --budget 0.002 --until 9 --measure section --section";
    let run = lie(&format!("bench {path} {section} z[2][1][0]=0")).ok();
    assert!(
        run.stdout.contains("section: z[2][1][0] rises through 0"),
        "{}",
        run.stdout
    );
    let refused = lie(&format!("run {path} --param L=1 --method splitting2"));
    let refused = refused.error("method", "command line: --method");
    for text in [
        "on a ring of 2 x 2 sites the bond `exchange with [+1,+0,+0]`",
        "gauss8",
    ] {
        assert!(refused.stderr.contains(text), "{text}: {}", refused.stderr);
    }
    lie(&format!("run {path} --param L=1 --method gauss8 --until 1")).ok();
}

#[test]
fn rows_go_on_from_a_file_of_a_run() {
    let folder = folder();
    let path = plain(folder.path());
    let out = folder.path().join("rows.npy");
    let out = out.display();
    lie(&format!(
        "run {path} --param M=4 --method rk4 --step 0.1 --at 0,1 --format npy --out {out}"
    ))
    .ok();
    let histogram = folder.path().join("h.npy");
    let call = format!(
        "ensemble {path} --members 4 --method rk4 --step 0.1 --until 1 --reduce mean,histogram --out {}",
        histogram.display()
    );
    lie(&call).ok();
    assert!(folder.path().join("h.histogram.npy").exists());
}
