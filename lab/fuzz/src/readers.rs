//! What reads text and bytes, without the compiler behind it.

use lie_program::listen::listen;
use lie_program::protocol::{Found, Run};
use lie_syntax::diagnostic::{Report, forget_spans};
use lie_syntax::front::{Parsed, declaration, spec};
use proc_macro2::TokenStream;
use proc_macro2::extra::invalidate_current_thread_spans;

use crate::{file, folder, told};

/// A spec file, from bytes to the syntax tree.
pub fn read_spec(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let mut report = Report::new();
    let parsed = spec::read(text, &mut report);
    read(&parsed, report, text);
    spec::files(text);
}

/// The body of the macro, from tokens to the syntax tree. Whether the text could be the body of a macro at all.
///
/// A process that expands one macro keeps its text for the places of its tokens, and this one would keep millions.
pub fn read_declaration(text: &str) -> bool {
    invalidate_current_thread_spans();
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return false;
    };
    forget_spans();
    let mut report = Report::new();
    let parsed = declaration::parse(tokens, &mut report);
    read(&parsed, report, text);
    true
}

/// Either a syntax tree or mistakes.
fn read(parsed: &Parsed, mut report: Report, text: &str) {
    match report.gate() {
        Ok(()) => {
            assert!(parsed.body.is_some(), "neither a tree nor a mistake");
            report.ignore("warnings are no mistakes");
        }
        Err(diagnostics) => told(&diagnostics, text),
    }
}

/// A spec with a function by a table in a file.
const TABLE: &str = r#"{
    "format": 1, "name": "T", "algebra": "so(3)", "state": ["x", "y", "z"],
    "functions": { "f": { "table": "table.csv" } },
    "hamiltonian": "x^2/2 + f(y)"
}"#;

/// The file of a table.
pub fn table(bytes: &[u8]) {
    file("table.csv", bytes);
    let mut report = Report::new();
    let parsed = spec::read_in(TABLE, Some(folder()), &mut report);
    read(&parsed, report, TABLE);
}

/// What a built program and the command say to each other: the line of a run, and messages with rows between them.
pub fn messages(bytes: &[u8]) {
    if let Ok(run) = serde_json::from_slice::<Run>(bytes) {
        run.span();
        run.options();
    }
    // what is wrong with it is an error; rows that were cut off are whole up to there
    let heard = listen::<Found>(&mut &*bytes, &mut |message| {
        if let lie_program::protocol::Message::Found(Found::Rows(rows)) = message {
            assert_eq!(rows.numbers.len() % rows.width.max(1), 0);
        }
        Ok(())
    });
    drop(heard);
}
