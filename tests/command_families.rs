//! `lie check`, `lie expand` and `lie run` on families.

mod common;

use common::{folder, lie};

const CHAIN: &str = "tests/data/families/heisenberg_chain.json";

#[test]
fn check_says_how_large_a_family_is_and_what_applies() {
    let run = lie(&format!("check {CHAIN}")).ok();
    for text in [
        "a chain of 1000 sites: dimension 3000, generic rank 2000, 1000 independent Casimirs",
        "H = -J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1])",
        "splitting: H is 1 piece with an exact flow at each site",
        "exchange with [+1]",
        "C1 = x^2 + y^2 + z^2",
        "field of a site",
        "a family keeps no matrix",
    ] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
    let run = lie(&format!("check {CHAIN} --json")).ok();
    let json: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(
        (&json["dimension"], &json["generic_rank"]),
        (&3000.into(), &2000.into())
    );
    assert!(json["methods"]["gauss16"].is_null() && json["methods"]["splitting4"].is_null());
    assert!(json["methods"]["midpoint"].is_string());
    let run = lie("check tests/data/families/open_chain.json").ok();
    let why = "splitting: none: `z[i]` and `y[i+1]` are coupled by more than a product";
    assert!(run.stdout.contains(why), "{}", run.stdout);
}

#[test]
fn one_program_runs_any_number_of_sites() {
    let folder = folder();
    for (n, width) in [(4, 13), (70, 211)] {
        let out = folder.path().join(format!("{n}.csv"));
        let call = format!(
            "run {CHAIN} --param N={n} --until 2 --out {}",
            out.display()
        );
        let run = lie(&call).ok();
        assert!(run.stderr.contains("C1_max"), "{}", run.stderr);
        let text = std::fs::read_to_string(&out).expect("rows");
        let mut lines = text.lines();
        let header = lines.next().expect("a header");
        assert!(header.starts_with("t,x[0],x[1],x[2],x[3],"), "{header}");
        assert!(
            header.ends_with(",energy,C1_mean,C1_min,C1_max"),
            "{header}"
        );
        assert_eq!(header.split(',').count(), width + 4);
        let energies: Vec<f64> = lines
            .map(|line| {
                line.split(',')
                    .nth(width)
                    .and_then(|x| x.parse().ok())
                    .expect("a number")
            })
            .collect();
        let (first, last) = (energies[0], energies[energies.len() - 1]);
        assert!(
            (first - last).abs() < 1e-13 * f64::from(n),
            "{first} {last}"
        );
    }
}

#[test]
fn what_a_family_is_not_run_with_is_said() {
    let refused = |arguments: &str, text: &str| {
        let run = lie(arguments);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
    };
    refused(
        &format!("run {CHAIN} --param N=2.5"),
        "the number of sites is a whole number",
    );
    refused(
        &format!("run {CHAIN} --param N=2 --initial 1,0,0"),
        "3 values for 2 sites of 3 coordinates",
    );
    refused(
        &format!("run {CHAIN} --method midpoint"),
        "a family keeps no matrix",
    );
    refused(
        &format!("verify {CHAIN}"),
        "a family, which is not measured yet",
    );
}
