//! What other languages and tools write, and what is meant: the tables of `hints.txt`.

use std::collections::HashMap;
use std::sync::LazyLock;

const TEXT: &str = include_str!("hints.txt");

/// The rows of each table, which are taken apart once.
static TABLES: LazyLock<HashMap<&str, Vec<(&str, &str)>>> = LazyLock::new(|| {
    let mut tables = HashMap::new();
    let mut rows = &mut Vec::new();
    for line in TEXT.lines() {
        if line.starts_with('[') {
            rows = tables.entry(line.trim_matches(['[', ']'])).or_default();
        } else if let Some(row) = line.split_once(" = ") {
            rows.push(row);
        }
    }
    tables
});

/// The rows of a table: what others write, and what belongs to it here.
pub fn table(name: &str) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
    TABLES.get(name).into_iter().flatten().copied()
}

/// What belongs to a word in a table with several words in a row.
pub fn lookup_word(name: &'static str, word: &str) -> Option<&'static str> {
    let mut rows = table(name);
    let found = rows.find(|(theirs, _)| theirs.split(' ').any(|other| other == word));
    found.map(|(_, ours)| ours)
}

/// What belongs to a character in a table with several characters in a row.
pub fn lookup_character(name: &'static str, c: char) -> Option<&'static str> {
    let found = table(name).find(|(theirs, _)| theirs.contains(c));
    found.map(|(_, ours)| ours)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line that is no row would be lost in silence.
    #[test]
    fn every_line_is_a_row_of_a_table() {
        let heads = TEXT.lines().filter(|line| line.starts_with('['));
        let names = heads.map(|line| line.trim_matches(['[', ']']));
        let rows: usize = names.map(|name| table(name).count()).sum();
        let empty = TEXT.lines().filter(|line| line.is_empty()).count();
        let heads = TEXT.lines().filter(|line| line.starts_with('[')).count();
        // two lines of explanation before the first table
        assert_eq!(rows + empty + heads + 2, TEXT.lines().count());
        for name in [
            "words of other tools",
            "functions",
            "no such keys",
            "signs",
            "letters",
        ] {
            assert!(table(name).next().is_some(), "{name}");
        }
    }
}
