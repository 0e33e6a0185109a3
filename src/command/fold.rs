//! Sentences in lines that fit a terminal.

use textwrap::core::Word;
use textwrap::{Options, WordSeparator, WordSplitter};

/// The longest line, in characters.
const WIDTH: usize = 100;
/// A clause up to this length stays in one line.
const CLAUSE: usize = 56;

/// The same text with no line over 100 characters, as far as spaces allow: a line breaks between clauses where these are
/// short. What goes on below is moved in.
pub fn folded(text: &str) -> String {
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

fn line(line: &str) -> String {
    let own = line.len() - line.trim_start_matches(' ').len();
    let indent = " ".repeat(own + 2);
    let options = Options::new(WIDTH)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_separator(WordSeparator::Custom(pieces))
        .word_splitter(WordSplitter::NoHyphenation);
    textwrap::fill(line, options)
}

/// What stays together: short clauses, and of long ones the words.
fn pieces(line: &str) -> Box<dyn Iterator<Item = Word<'_>> + '_> {
    let (mut clauses, mut from) = (Vec::new(), 0);
    for (at, _) in line.match_indices(' ') {
        if line[..at].ends_with([',', ';', ':']) {
            clauses.push(&line[from..=at]);
            from = at + 1;
        }
    }
    clauses.push(&line[from..]);
    let of_clause = |clause| match str::chars(clause).count() <= CLAUSE {
        true => vec![Word::from(clause)],
        false => WordSeparator::AsciiSpace.find_words(clause).collect(),
    };
    Box::new(clauses.into_iter().flat_map(of_clause))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_spaces_alone() {
        let short = "a line\n  another one\n";
        assert_eq!(folded(short), short);
        let long = format!("{} lie-midpoint, {}", "word ".repeat(18), "x".repeat(120));
        let lines: Vec<String> = folded(&long).lines().map(str::to_owned).collect();
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert_eq!(lines[1], "  lie-midpoint,");
        assert_eq!(
            lines[2],
            format!("  {}", "x".repeat(120)),
            "a path stays whole"
        );
    }

    #[test]
    fn short_clauses_stay_whole() {
        let long = format!(
            "{}: one thing, 1.02 iterations per step",
            "word ".repeat(15).trim()
        );
        let (first, second) = (" one thing,", "  1.02 iterations per step");
        let found = folded(&long);
        assert!(found.ends_with(&format!("{first}\n{second}")), "{found}");
    }
}
