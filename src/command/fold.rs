//! Sentences in lines that fit a terminal.

use textwrap::{Options, WordSeparator, WordSplitter};

/// The longest line, in characters.
const WIDTH: usize = 100;

/// The same text with no line over 100 characters, as far as spaces allow; what goes on below is moved in.
pub fn folded(text: &str) -> String {
    let options = Options::new(WIDTH)
        .subsequent_indent("  ")
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation);
    let lines = text.split('\n').map(|line| textwrap::fill(line, &options));
    lines.collect::<Vec<_>>().join("\n")
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
        assert_eq!(lines[2], format!("  {}", "x".repeat(120)), "a path stays whole");
    }
}
