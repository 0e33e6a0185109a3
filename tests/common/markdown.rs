//! Documents in Markdown: their code blocks, links and places.

use std::fs;
use std::path::Path;

/// A code block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// What stands behind the first fence.
    pub language: String,
    /// Its lines.
    pub text: String,
    /// The number of the line behind the first fence, from 0 on.
    pub line: usize,
    /// The line before the first fence.
    pub before: String,
}

/// The text of a file of the repository.
#[track_caller]
pub fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The code blocks of a document.
#[track_caller]
pub fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut inside = false;
    let mut before = "";
    for (number, line) in text.lines().enumerate() {
        if let Some(language) = line.strip_prefix("```") {
            inside = !inside;
            if inside {
                blocks.push(Block {
                    language: language.to_owned(),
                    text: String::new(),
                    line: number + 1,
                    before: before.to_owned(),
                });
            }
        } else if inside && let Some(block) = blocks.last_mut() {
            block.text.push_str(line);
            block.text.push('\n');
        }
        before = line;
    }
    assert!(!inside, "a code block is not closed");
    blocks
}

/// The texts of the blocks in a language.
#[track_caller]
pub fn blocks_in(text: &str, language: &str) -> Vec<String> {
    let blocks = blocks(text).into_iter();
    blocks
        .filter(|block| block.language == language)
        .map(|block| block.text)
        .collect()
}

/// A document without its code blocks.
pub fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// Where the links of a document lead.
pub fn links(text: &str) -> Vec<String> {
    let links = text.split("](").skip(1);
    links
        .filter_map(|rest| rest.split(')').next())
        .map(str::to_owned)
        .collect()
}

/// What stands in code marks, outside of blocks.
pub fn marked(text: &str) -> Vec<String> {
    let prose = prose(text);
    prose
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// The rows of the tables whose head has this first cell, each with its cells; heads and rules are left out.
pub fn rows(text: &str, first: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        let cells = || {
            line.trim_matches('|')
                .split('|')
                .map(|cell| cell.trim().to_owned())
        };
        match line.starts_with('|') {
            false => inside = false,
            true if !inside => inside = cells().next().as_deref() == Some(first),
            true if line.starts_with("|-") => {}
            true => found.push(cells().collect()),
        }
    }
    found
}
