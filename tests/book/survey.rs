//! The page on the survey names methods and tests.

use lie_codegen::methods::{CATALOGUE, Choice, find};

use crate::common::markdown::{read, rows};
use crate::page;

/// What stands in code marks in a cell.
fn marked(cell: &str) -> Vec<String> {
    cell.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// Whether there is such a method, `ID` standing for a base, with options that it has.
fn is_method(text: &str) -> bool {
    let mut words = text.split(" --");
    let id = words.next().unwrap_or_default();
    let known = Choice::from_id(&id.replace("(ID)", "(midpoint)")).is_ok();
    let Some(method) = find(id.split('(').next().unwrap_or_default()) else {
        return false;
    };
    known
        && words.all(|option| {
            let (name, value) = option.split_once(' ').unwrap_or((option, ""));
            method.values(name).contains(&value)
        })
}

/// Whether there is a test `PATH::NAME`.
fn is_test(test: &str) -> bool {
    let Some((path, name)) = test.split_once("::") else {
        return false;
    };
    let text = read(path);
    let Some((before, _)) = text.split_once(&format!("fn {name}()")) else {
        return false;
    };
    before
        .lines()
        .rev()
        .take(5)
        .any(|line| line.trim().starts_with("#[test]"))
}

#[test]
fn the_survey_names_methods_and_tests_that_exist() {
    let text = page("survey.md");
    let mut named = Vec::new();
    for row in rows(&text, "Place").iter().chain(&rows(&text, "Beyond it")) {
        for id in marked(&row[1]) {
            assert!(is_method(&id), "no method `{id}`");
            named.push(id);
        }
        let tests = marked(&row[3]);
        assert!(!tests.is_empty(), "no test in the row {}", row[0]);
        for test in tests {
            assert!(is_test(&test), "no test `{test}`");
        }
    }
    let missing = CATALOGUE.iter().find(|method| {
        let is_it = |id: &String| id.split(['(', ' ']).next() == Some(method.id);
        !named.iter().any(is_it)
    });
    assert!(
        missing.is_none(),
        "{} is not on the page",
        missing.expect("a method").id
    );
    let corrections = rows(&text, "Printed at");
    assert!(corrections.len() > 10, "{} misprints", corrections.len());
    for row in corrections {
        for test in marked(&row[3]) {
            assert!(is_test(&test), "no test `{test}`");
        }
    }
}

#[test]
fn what_does_not_exist_is_seen() {
    assert!(is_method("lie-midpoint --retraction cayley"));
    assert!(!is_method("lie-midpoint --lift hopf"));
    assert!(!is_method("lie-endpoint"));
    assert!(is_test("tests/steps/published.rs::almost_poisson_midpoint"));
    assert!(!is_test("tests/steps/published.rs::surely_not"));
}
