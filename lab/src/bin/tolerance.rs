//! Measures the error over the tolerance on 1,000 systems drawn by chance, and `collective16` over each lift; writes
//! `lab/docs/tolerance.md`.
//!
//! ```text
//! cargo run --release -p lab --bin tolerance                     # all of it, some tens of minutes
//! cargo run --release -p lab --bin tolerance -- rows 0 100       # rows of some members alone, to a file …
//! cargo run --release -p lab --bin tolerance -- page ROWS PLAIN STEPS 1e5   # … from which, and those of `plain` and `steps`, the page is written
//! ```
//!
//! `steps` writes how many steps gauss16 takes to each of twelve tolerances, and the page says how often a looser one takes more.
//! `plain` in the place of `rows` runs without `--assess`. Ids of methods may follow.

use lab::drawn::member::Member;
use lab::lifted::cases;
use lab::measured::{Outcome, Row, Way};
use lab::page::{histogram, table};
use std::fmt::Write as _;

const MEMBERS: u64 = 1000;
/// The time over which drift is measured.
const SPAN: f64 = 1e5;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["rows" | "plain", from, to, ..] => {
            let number = |text: &str| text.parse().expect("the number of a member");
            let assessed = words[0] == "rows";
            for row in rows(number(from)..number(to), &words[3..], assessed) {
                println!("{}", row.to_line());
            }
        }
        ["steps", from, to] => {
            let number = |text: &str| text.parse().expect("the number of a member");
            for line in steps(number(from)..number(to)) {
                println!("{line}");
            }
        }
        ["page", commanded, plain, steps, span] => {
            let span = span.parse().expect("a time");
            let steps = std::fs::read_to_string(steps).expect("the steps can be read");
            write(&read(commanded), &read(plain), &steps, span);
        }
        _ => {
            let commanded: Vec<Row> = rows(0..MEMBERS, &[], true).collect();
            let plain: Vec<Row> = rows(0..MEMBERS, &[], false).collect();
            let steps: Vec<String> = steps(0..MEMBERS).collect();
            write(&commanded, &plain, &steps.join("\n"), SPAN);
        }
    }
}

fn rows(numbers: std::ops::Range<u64>, ids: &[&str], assessed: bool) -> impl Iterator<Item = Row> {
    let chosen = |way: &Way| ids.is_empty() || ids.contains(&way.id());
    let ways: Vec<Way> = Way::ALL.into_iter().filter(chosen).collect();
    numbers.flat_map(move |number| {
        let member = Member::draw(number);
        let ways = ways.iter().filter(|way| way.applies(&member));
        let runs = ways.flat_map(|way| way.tolerances().iter().map(|&tolerance| (*way, tolerance)));
        runs.map(|(way, tolerance)| Row::measure(&member, way, tolerance, assessed))
            .collect::<Vec<_>>()
    })
}

fn read(path: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(path).expect("the rows can be read");
    text.lines().filter_map(Row::from_line).collect()
}

/// For each member the steps to 1e-2, 1e-3, …; 0 where a run was refused.
fn steps(numbers: std::ops::Range<u64>) -> impl Iterator<Item = String> {
    numbers.map(|number| {
        let member = Member::draw(number);
        let counts =
            (2..=13).map(
                |digits| match Way::Gauss16.run(&member, 0.1_f64.powi(digits), false) {
                    Outcome::Done { steps, .. } => steps.to_string(),
                    Outcome::Refused(why) => {
                        eprintln!("{number}, 1e-{digits}: {why}");
                        "0".to_owned()
                    }
                },
            );
        counts.collect::<Vec<_>>().join(" ")
    })
}

/// How often a tolerance takes fewer steps than the one before, ten times as large, and how many fewer.
fn monotone(text: &str) -> String {
    let mut falls = Vec::new();
    let mut pairs = 0;
    for line in text.lines() {
        let counts: Vec<f64> = line.split(' ').filter_map(|n| n.parse().ok()).collect();
        for pair in counts
            .windows(2)
            .filter(|pair| pair[0] > 0.0 && pair[1] > 0.0)
        {
            pairs += 1;
            falls.push(pair[0] / pair[1]);
        }
    }
    falls.sort_by(f64::total_cmp);
    let above = |ratio: f64| falls.iter().filter(|fall| **fall > ratio).count();
    format!(
        "gauss16 to 1e-2, 1e-3, … 1e-13: of {pairs} pairs of neighbours the looser one takes more steps in {}, more than 1.1 times as \
         many in {}, more than 1.5 times in {}; the most is {:.2} times.",
        above(1.0),
        above(1.1),
        above(1.5),
        falls.last().copied().unwrap_or(f64::NAN)
    )
}

fn write(commanded: &[Row], plain: &[Row], steps: &str, span: f64) {
    let mut page = String::from(include_str!("tolerance.md"));
    for (mark, text) in [
        ("{commanded}", table(commanded)),
        ("{plain}", table(plain)),
        ("{plain histogram}", histogram(plain, Way::Gauss16)),
        ("{span}", format!("{span:e}")),
        ("{steps}", monotone(steps)),
        ("{lifts}", lifts(span)),
    ] {
        page = page.replace(mark, text.trim_end());
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/tolerance.md");
    std::fs::write(path, &page).expect("the page can be written");
    println!("{page}");
}

fn lifts(span: f64) -> String {
    let mut text = String::from(
        "| system, H | method | order by slope | Poisson defect | at 1.75 units | units of a step of the long run | energy error, first tenth | last tenth | Casimir |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for case in cases() {
        for (id, found) in [
            ("collective16", case.collective(span)),
            ("gauss16", case.gauss(span)),
        ] {
            let drift = found.drift.map_or("– | – | – | –".into(), |drift| {
                let (first, last) = drift.energy;
                let (part, casimir) = (drift.part, drift.casimir);
                format!("{part} | {first:.0e} | {last:.0e} | {casimir:.0e}")
            });
            let [defect, larger] = found.defects;
            let _ = writeln!(
                text,
                "| {} | {id} | {:.1} | {defect:.0e} | {larger:.0e} | {drift} |",
                case.name, found.order
            );
            eprintln!("{}: {id} {found:?}", case.name);
        }
    }
    text
}
