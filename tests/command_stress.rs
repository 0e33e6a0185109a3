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
    // a bias or a walk: the growth is fitted for methods that claim something
    let growth = |method: &str| {
        let found = cells
            .iter()
            .find(|cell| cell[0] == method && cell[1] == "growth");
        found.map(|cell| {
            (
                cell[2],
                cell[3].parse::<f64>().expect("an exponent"),
                cell[13],
            )
        })
    };
    assert!(growth("rk4").is_none() && growth("dopri5").is_none());
    for method in ["midpoint", "lie-midpoint"] {
        let (invariant, exponent, what) = growth(method).expect("a fit");
        assert!(["energy", "norm2"].contains(&invariant), "{invariant}");
        assert!((-0.5..1.6).contains(&exponent), "{method}: {exponent}");
        assert!(what.starts_with("standard error "), "{what}");
        // a table that is wider than a line goes on below, with the methods again
        let name = format!("{method} ");
        let mut rows = run.stdout.lines().filter(|line| line.starts_with(&name));
        let shown = format!("{invariant} N^{exponent:.2} ± ");
        assert!(
            rows.any(|row| row.contains(&shown)),
            "{shown}: {}",
            run.stdout
        );
    }
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

/// Next to a singularity of H its terms grow and shrink within a few steps; round-off is measured by them.
#[test]
fn round_off_next_to_a_singularity_is_no_loss() {
    let run = lie("stress specs/lotka_volterra.json --methods gonzalez --steps 1000 --quiet").ok();
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let scaled = run
        .stdout
        .lines()
        .find(|line| line.contains("gonzalez, scale state 1.0e-10"));
    assert!(
        scaled.is_some_and(|line| line.contains("a number is not finite")),
        "{}",
        run.stdout
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
