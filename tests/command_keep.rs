//! `--keep`: energy and Casimirs by a projection behind the steps of explicit methods. What it does to steps is tested with the driver,
//! in `lie-runtime/tests/projection.rs`.

mod common;

use common::lie;

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
            "H depends on the time",
        ),
    ] {
        let run = lie(&format!("run {call} --method rk4 --step 0.1 --until 1"));
        let run = run.error("option", "command line: --keep");
        assert!(run.stderr.contains(why), "{call}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{call}: {}", run.stderr);
    }
}
