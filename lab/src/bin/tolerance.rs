//! Measures the error over the tolerance on 1,000 systems drawn by chance, and `collective16` over each lift; writes
//! `lab/docs/tolerance.md`.
//!
//! ```text
//! cargo run --release -p lab --bin tolerance                     # all of it, some tens of minutes
//! cargo run --release -p lab --bin tolerance -- rows 0 100       # rows of some members alone, to a file …
//! cargo run --release -p lab --bin tolerance -- page ROWS LIBRARY 1e5   # … from which, and that of `plain`, the page is written
//! ```
//!
//! `plain` in the place of `rows` runs without `--assess`. Ids of methods may follow.

use lab::drawn::member::Member;
use lab::lifted::cases;
use lab::measured::{Row, Way};
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
        ["page", commanded, plain, span] => {
            let span = span.parse().expect("a time");
            write(&read(commanded), &read(plain), span);
        }
        _ => {
            let commanded: Vec<Row> = rows(0..MEMBERS, &[], true).collect();
            let plain: Vec<Row> = rows(0..MEMBERS, &[], false).collect();
            write(&commanded, &plain, SPAN);
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

fn write(commanded: &[Row], plain: &[Row], span: f64) {
    let mut page = String::from(include_str!("tolerance.md"));
    for (mark, text) in [
        ("{commanded}", table(commanded)),
        ("{plain}", table(plain)),
        ("{plain histogram}", histogram(plain, Way::Gauss16)),
        ("{span}", format!("{span:e}")),
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
