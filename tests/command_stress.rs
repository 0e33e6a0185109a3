//! `lie stress`: the limits of methods.

mod common;

use common::{folder, lie};

#[test]
fn table_map_and_points() {
    let folder = folder();
    let (out, plot) = (
        folder.path().join("cells.csv"),
        folder.path().join("map.svg"),
    );
    let run = lie(&format!(
        "stress specs/so3_free_rigid_body.json --methods midpoint,lie-midpoint,rk4,dopri5 --steps 2000 --quiet \
         --out {} --plot {}",
        out.display(),
        plot.display()
    ))
    .ok();
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let text = std::fs::read_to_string(out).expect("cells");
    let cells: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert!(
        cells.iter().all(|cell| cell.len() == cells[0].len()),
        "{text}"
    );
    let long = |method: &str| -> Vec<f64> {
        let cell = cells
            .iter()
            .find(|cell| cell[0] == method && cell[1] == "long");
        cell.expect("the long run")[8..10]
            .iter()
            .map(|f| f.parse().expect("a number"))
            .collect()
    };
    // the control drifts, the energy of the others stays where it is
    let (drift, bounded, kept) = (long("rk4"), long("lie-midpoint"), long("midpoint"));
    assert!(
        drift[1] > 5.0 && (0.8..1.3).contains(&bounded[1]),
        "{drift:?} {bounded:?}"
    );
    assert!(kept[0] < 1e-13 && bounded[0] > 1e-7, "{kept:?} {bounded:?}");
    // huge steps are refused with a reason
    assert!(
        run.stdout.contains("the iteration does not converge"),
        "{}",
        run.stdout
    );
    let svg = std::fs::read_to_string(plot).expect("picture");
    assert!(
        svg.starts_with("<svg") && svg.contains(">midpoint<") && svg.trim_end().ends_with("</svg>")
    );
}

#[test]
fn wrong_options() {
    let stress = |rest: &str| lie(&format!("stress specs/so3_free_rigid_body.json {rest}"));
    stress("--steps 0").error("option", "command line: --steps");
    stress("--steps 1.5").error("option", "command line: --steps");
    stress("--methods rk5").error("method", "command line: --methods");
    stress("--out specs/so3_free_rigid_body.json").error("option", "command line: --out");
}
