//! The book: its commands are run and print what it shows, its specs compile, the pages that the compiler writes are
//! current, its links lead somewhere, and the survey's table names methods and tests that exist.
//!
//! `LIE_UPDATE_GOLDEN=1 cargo test --test book` writes outputs, pictures and the generated pages anew. `LIE_BOOK_ALL=1`
//! runs what needs cargo and minutes too. Blocks of Rust are doctests of the root package; those of Python are run by
//! `lab/tools/book.py`.

#[path = "../common/mod.rs"]
mod common;

mod commands;
mod links;
mod reference;
mod survey;

use std::fs;
use std::path::{Path, PathBuf};

use common::markdown::read;

/// Where the pages are.
const FOLDER: &str = "docs/book/src";

/// Whether files are to be written instead of compared.
fn update() -> bool {
    std::env::var_os(lie_codegen::golden::UPDATE).is_some()
}

/// The path of a file of the book.
fn place(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join(FOLDER)
        .join(name)
}

/// The pages that the table of contents lists.
fn pages() -> Vec<String> {
    let contents = read(&format!("{FOLDER}/SUMMARY.md"));
    common::markdown::links(&contents)
}

/// The text of a page.
#[track_caller]
fn page(name: &str) -> String {
    read(&format!("{FOLDER}/{name}"))
}

/// Fails unless a file of the book has this content, or writes it.
#[track_caller]
fn compare(name: &str, content: &[u8]) {
    let path = place(name);
    if update() {
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, content).expect("the file is written");
    }
    let committed = fs::read(&path).unwrap_or_default();
    assert!(
        committed == content,
        "{FOLDER}/{name} is stale: write it anew with `LIE_UPDATE_GOLDEN=1 cargo test --test book`"
    );
}
