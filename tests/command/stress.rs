//! `lie stress`: the limits of methods.

use crate::common::{folder, lie};

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

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
            .map(|field| number(field))
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
    let growths = |method: &str| -> Vec<&Vec<&str>> {
        let of_method = cells.iter().filter(|cell| cell[0] == method);
        of_method.filter(|cell| cell[1] == "growth").collect()
    };
    assert!(growths("rk4").is_empty() && growths("dopri5").is_empty());
    for method in ["midpoint", "lie-midpoint"] {
        let found = growths(method);
        let steps: Vec<f64> = found.iter().map(|cell| number(cell[4])).collect();
        assert!(
            steps.len() == 2 && (steps[1] - 8.0 * steps[0]).abs() < 1e-12,
            "{method}: {steps:?}"
        );
        for cell in found {
            let (invariant, exponent, what) = (cell[2], number(cell[3]), cell[13]);
            assert!(["energy", "norm2"].contains(&invariant), "{invariant}");
            assert!((-0.5..1.6).contains(&exponent), "{method}: {exponent}");
            assert!(what.starts_with("standard error "), "{what}");
            let bias = what.split("; bias ").nth(1).expect("a bias");
            let bias: Vec<f64> = bias.split(" with standard error ").map(number).collect();
            // a table that is wider than a line goes on below, with the methods again
            let name = format!("{method} ");
            let rows = run.stdout.lines().filter(|line| line.starts_with(&name));
            let rows: Vec<&str> = rows.collect();
            let shown = [
                format!("{invariant} N^{exponent:.2} ± "),
                format!("{:+.1e} ± {:.1e}", bias[0], bias[1]),
            ];
            for shown in shown {
                let found = rows.iter().any(|row| row.contains(&shown));
                assert!(found, "{shown}: {}", run.stdout);
            }
        }
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
