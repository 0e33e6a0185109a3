//! A generated family takes about as many instructions as the same ring written by hand, and a site as many whatever the number
//! of sites is: counted by callgrind. Without valgrind this prints `skipped`.

mod common;

use common::callgrind;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

fn program() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    let build = || callgrind::build("families", &["std", "macros"], "");
    PROGRAM.get_or_init(build).as_deref()
}

/// Instructions of a step, by site, and the energy at the end.
fn per_site(program: &Path, system: &str, method: &str, sites: u32) -> (f64, f64) {
    let square = system == "square";
    let numbers = if square { [1, 2] } else { [3, 13] };
    let [few, many] = numbers.map(|steps| {
        let (sites, steps) = (sites.to_string(), steps.to_string());
        callgrind::run(program, &[system, method, &sites, "0.25", &steps])
    });
    let all = if square { sites * sites } else { sites };
    let count = many.0.abs_diff(few.0) as f64 / f64::from((numbers[1] - numbers[0]) * all);
    let energy = many
        .1
        .split_whitespace()
        .nth(1)
        .and_then(|text| text.parse().ok());
    println!("{system} {method} {sites}: {count:.0} instructions a site");
    (count, energy.expect("an energy"))
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn a_family_takes_as_many_instructions_as_the_ring_by_hand() {
    let Some(program) = program() else { return };
    for (method, most) in [("rk4", 1.1), ("gauss16", 1.15), ("splitting6", 1.25)] {
        let (generated, energy) = per_site(program, "ring", method, 1000);
        let (by_hand, expected) = per_site(program, "by_hand", method, 1000);
        assert!(
            (energy - expected).abs() < 1e-11,
            "{method}: {energy} {expected}"
        );
        assert!(
            generated < most * by_hand,
            "{method}: {generated} {by_hand}"
        );
    }
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn a_site_takes_as_many_instructions_whatever_their_number_is() {
    let Some(program) = program() else { return };
    for (system, method, [few, many]) in [
        ("ring", "rk4", [1000, 10_000]),
        ("ring", "splitting6", [1000, 10_000]),
        ("square", "splitting6", [200, 400]),
    ] {
        let (small, _) = per_site(program, system, method, few);
        let (large, _) = per_site(program, system, method, many);
        let change = large / small - 1.0;
        assert!(change.abs() < 0.2, "{system} {method}: {small} {large}");
    }
    // the control: at a few sites the ends of the ring show
    let (few, _) = per_site(program, "ring", "splitting6", 10);
    let (many, _) = per_site(program, "ring", "splitting6", 1000);
    assert!(few > 1.2 * many, "{few} {many}");
}
