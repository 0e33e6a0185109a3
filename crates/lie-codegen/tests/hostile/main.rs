//! Whatever a spec asks for is refused or done, with messages that a person can read. How long it takes and how much memory is
//! measured by `cargo bench -p lie-codegen --bench hostile`; what bounds it are limits of work, so that the verdicts
//! here are the same on every machine.

mod cases;

use std::collections::{BTreeMap, BTreeSet};
use std::panic::catch_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

use cases::Case;
use lie_codegen::compile::{compile_spec, declared_choices};
use lie_codegen::plan::plan;
use lie_codegen::print::{Surface, print};
use lie_syntax::diagnostic::{Diagnostic, Origin};
use lie_syntax::front::file::oversized;

/// The stack that `lie` gives the compiler.
const STACK: usize = 256 << 20;
/// Messages that are kept, and the longest of them with its help in bytes: 50 of them are shown, 128 kB at most.
const MOST_MESSAGES: usize = 2000;
const LONGEST_MESSAGE: usize = 10_000;
const MOST_SHOWN: usize = 128_000;

/// Names of cases and their verdicts: `done`, or the kind of the first mistake. Of the others any verdict is right
/// whose messages a person can read.
const VERDICTS: &str = include_str!("verdicts.txt");

/// Cases of more than 0.3 s each: the bench runs them.
const DEAR: &str = include_str!("dear.txt");

fn verdict(case: &Case) -> Result<String, String> {
    let mistakes = match oversized(case.text.len()) {
        Some(mistake) => vec![mistake],
        None => match compile_spec(&case.text) {
            Ok(model) => {
                let plan = plan(&model, &declared_choices(&model));
                if plan.counts().is_empty() || print(&plan, &Surface::new(&model)).is_empty() {
                    return Err("no kernel".into());
                }
                readable(&model.warnings, &case.text)?;
                return Ok("done".into());
            }
            Err(mistakes) => mistakes,
        },
    };
    readable(&mistakes, &case.text)?;
    let first = mistakes.iter().find(|mistake| !mistake.warning);
    Ok(first.ok_or("refused without a reason")?.kind.to_string())
}

/// Whether a person can read the messages: few, short, each with a remedy and a place in the text.
fn readable(messages: &[Diagnostic], text: &str) -> Result<(), String> {
    let length =
        |message: &Diagnostic| message.message.len() + message.help.as_ref().map_or(0, String::len);
    if messages.len() > MOST_MESSAGES {
        return Err(format!("{} messages", messages.len()));
    }
    let shown: usize = messages.iter().take(50).map(length).sum();
    if shown > MOST_SHOWN {
        return Err(format!("{shown} bytes of messages"));
    }
    for message in messages {
        let place = match message.origin {
            Some(Origin::Text { start, end }) => text.get(start..end).is_some(),
            Some(Origin::Span(_)) => false,
            None => true,
        };
        let helped = message.help.as_ref().is_some_and(|help| !help.is_empty());
        if !place || !helped || message.message.is_empty() || length(message) > LONGEST_MESSAGE {
            return Err(format!("{message:?}").chars().take(2000).collect());
        }
    }
    Ok(())
}

/// What is wrong with the verdicts on the cases that nobody has taken yet.
fn wrong(cases: &[&Case], taken: &AtomicUsize) -> Vec<String> {
    let expected = expected();
    let mut wrong = Vec::new();
    while let Some(case) = cases.get(taken.fetch_add(1, Ordering::Relaxed)) {
        let found = catch_unwind(|| verdict(case));
        match found.unwrap_or_else(|_| Err("a panic".into())) {
            Ok(found) => {
                let known = expected.get(case.name.as_str());
                if known.is_some_and(|known| *known != found) {
                    wrong.push(format!("{}\t{found}", case.name));
                }
            }
            Err(why) => wrong.push(format!("{}\tunreadable: {why}", case.name)),
        }
    }
    wrong
}

fn expected() -> BTreeMap<&'static str, &'static str> {
    VERDICTS
        .lines()
        .map(|line| line.rsplit_once('\t').expect("a name and a verdict"))
        .collect()
}

#[test]
fn hostile_specs_are_refused_or_done() {
    let cases = cases::all();
    for name in expected().into_keys().chain(DEAR.lines()) {
        assert!(cases.iter().any(|case| case.name == *name), "{name}");
    }
    let dear: BTreeSet<&str> = DEAR.lines().collect();
    let cheap = |case: &&Case| !dear.contains(case.name.as_str());
    let cases: Vec<&Case> = cases.iter().filter(cheap).collect();
    let taken = AtomicUsize::new(0);
    let wrong: Vec<String> = std::thread::scope(|scope| {
        // two processors are there
        let shares = [0, 1].map(|_| {
            let thread = std::thread::Builder::new().stack_size(STACK);
            thread
                .spawn_scoped(scope, || wrong(&cases, &taken))
                .expect("a thread")
        });
        shares
            .into_iter()
            .flat_map(|share| share.join().expect("no panic"))
            .collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
