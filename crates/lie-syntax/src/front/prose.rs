//! Text for people in a spec: data, whatever it looks like.
//!
//! It ends in doc comments of generated code, where rustdoc would run a block of code as a test, take
//! `<script>` into the page and resolve `[name]`. Hence it is escaped to Markdown that shows it as it
//! was written. Characters that rustc refuses in comments, or that a terminal obeys, are refused.

use super::text::Source;
use crate::characters::{is_control, is_direction_control};
use crate::diagnostic::{Diagnostic, Kind, Report};

/// The lines of a text as Markdown that shows them; blanks around a line go.
pub fn lines(source: &Source<'_>, what: &str, report: &mut Report) -> Vec<String> {
    permitted(source, what, report);
    let pairs = Pairs::of(&source.text);
    let lines = source.text.lines();
    lines.map(|line| pairs.block(line.trim())).collect()
}

/// The text as one line of Markdown that may begin a doc comment.
pub fn paragraph(source: &Source<'_>, what: &str, report: &mut Report) -> String {
    permitted(source, what, report);
    let line = one_line(&source.text);
    Pairs::of(&line).block(&line)
}

/// The text as Markdown within a line.
pub fn inline(source: &Source<'_>, what: &str, report: &mut Report) -> String {
    permitted(source, what, report);
    let line = one_line(&source.text);
    Pairs::of(&line).inline(&line)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Reports the first character that has no place in a text for people.
fn permitted(source: &Source<'_>, what: &str, report: &mut Report) {
    let text = &*source.text;
    let found = text.char_indices().find(|(at, c)| {
        let ends_line = *c == '\r' && text[at + 1..].starts_with('\n');
        is_direction_control(*c) || is_control(*c) && !ends_line
    });
    let Some((at, c)) = found else { return };
    let (message, help) = if is_direction_control(c) {
        (
            format!(
                "{what} contains U+{:04X}, which changes the direction of what is shown",
                u32::from(c)
            ),
            "remove it: text in scripts from right to left needs no such mark",
        )
    } else {
        (
            format!(
                "{what} contains the control character U+{:04X}",
                u32::from(c)
            ),
            "remove it; a line break is written `\\n`",
        )
    };
    let place = source.origin(at..at + c.len_utf8());
    report.push(Diagnostic::new(Kind::Schema, place, message).help(help));
}

/// Which marks occur more than once: a single one opens nothing and stays as it is.
struct Pairs {
    star: bool,
    underscore: bool,
    tilde: bool,
}

impl Pairs {
    fn of(text: &str) -> Self {
        let paired = |mark: char| text.matches(mark).count() > 1;
        Self {
            star: paired('*'),
            underscore: paired('_'),
            tilde: paired('~'),
        }
    }

    /// A line at the beginning of which no block may begin: list, heading, quotation, rule, table.
    fn block(&self, line: &str) -> String {
        let escaped = self.inline(line);
        let digits = line.bytes().take_while(u8::is_ascii_digit).count();
        let numbered = digits > 0 && line[digits..].starts_with(['.', ')']);
        if numbered {
            return format!("{}\\{}", &escaped[..digits], &escaped[digits..]);
        }
        if line.starts_with(['#', '>', '-', '+', '*', '=', ':']) && !escaped.starts_with('\\') {
            return format!("\\{escaped}");
        }
        escaped
    }

    fn inline(&self, line: &str) -> String {
        let mut escaped = String::with_capacity(line.len());
        let mut rest = line;
        let mut before = ' ';
        while let Some(c) = rest.chars().next() {
            let after = &rest[c.len_utf8()..];
            if before != '`'
                && let Some(length) = code_span(rest)
            {
                escaped.push_str(&rest[..length]);
                rest = &rest[length..];
                before = '`';
                continue;
            }
            if self.is_active(c, before, after) {
                escaped.push('\\');
            }
            escaped.push(c);
            before = c;
            rest = after;
        }
        escaped
    }

    /// Whether Markdown could read a character as more than itself.
    fn is_active(&self, c: char, before: char, after: &str) -> bool {
        let next = after.chars().next().unwrap_or(' ');
        match c {
            '\\' | '`' | '[' | '<' | '|' => true,
            '&' => after.split_once(';').is_some_and(|(name, _)| {
                name.trim_start_matches('#')
                    .bytes()
                    .all(|b| b.is_ascii_alphanumeric())
            }),
            // rustdoc warns of addresses that are no links.
            ':' => after.starts_with("//"),
            '*' => self.star,
            '_' => self.underscore && !(before.is_alphanumeric() && next.is_alphanumeric()),
            '~' => self.tilde,
            _ => false,
        }
    }
}

/// The length of a code span at the beginning: single backticks on one line. What stands in it is
/// shown as it is, and no longer run of backticks can begin a block of code.
fn code_span(text: &str) -> Option<usize> {
    let inside = text.strip_prefix('`')?;
    let length = inside.find('`')?;
    let closed = length > 0 && !inside[length + 1..].starts_with('`');
    // A bar would end the cell of a table even here.
    (closed && !inside[..length].contains('|')).then_some(length + 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> String {
        let mut report = Report::new();
        let lines = lines(&Source::plain(text, 0), "the text", &mut report);
        assert!(report.gate().is_ok(), "{text:?}");
        lines.join("\n")
    }

    #[test]
    fn ordinary_text_stays_as_it_is() {
        for text in [
            "Heavy top on se(3)*: angular momentum m, centre of mass (c1, c2, c3).",
            "Kirchhoff's equations: E_ij - E_ji, i (E_11 - E_22); y1 > 0; Ann. 12, 319-361.",
            "The coefficient `c` is `-1/(a*b)`.\n\nSecond paragraph, 2.5 times; doi:10.1007/s_1",
            "AT&T, x & y, 100% (50 €)",
        ] {
            assert_eq!(shown(text), text);
        }
    }

    #[test]
    fn markup_is_escaped() {
        for (text, expected) in [
            ("```\npanic!()\n```", "\\`\\`\\`\npanic!()\n\\`\\`\\`"),
            ("~~~rust", "\\~\\~\\~rust"),
            ("    panic!()", "panic!()"),
            ("- \n      panic!()", "\\-\npanic!()"),
            ("1. a\n2) b\n3.5", "1\\. a\n2\\) b\n3\\.5"),
            ("<script>alert(1)</script>", "\\<script>alert(1)\\</script>"),
            ("&lt;b&gt; &#60;", "\\&lt;b\\&gt; \\&#60;"),
            (
                "[a](javascript:x) ![i](u) [r]: u",
                "\\[a](javascript:x) !\\[i](u) \\[r]: u",
            ),
            (
                "a*b*c _x_ a_b_c ~~y~~",
                "a\\*b\\*c \\_x\\_ a_b_c \\~\\~y\\~\\~",
            ),
            (
                "# h\n> q\n+ l\na\n===\n---",
                "\\# h\n\\> q\n\\+ l\na\n\\===\n\\---",
            ),
            ("a | b\n:-:", "a \\| b\n\\:-:"),
            ("see https://a.org", "see https\\://a.org"),
            ("a\\", "a\\\\"),
            ("`a`` `b|c` ` `d <e>`", "\\`a\\`\\` \\`b\\|c` ` `d <e>`"),
        ] {
            assert_eq!(shown(text), expected, "{text:?}");
        }
    }

    #[test]
    fn controls_are_refused_at_their_place() {
        for (text, at, says) in [
            ("a\rb", 1, "U+000D"),
            ("ω\u{202e}", 2, "U+202E, which changes the direction"),
            ("\u{1b}[31m", 0, "control character U+001B"),
            ("x\u{85}", 1, "U+0085"),
        ] {
            let mut report = Report::new();
            paragraph(&Source::plain(text, 0), "the text", &mut report);
            let found = report.into_diagnostics();
            let [diagnostic] = found.as_slice() else {
                panic!("{found:?}")
            };
            assert!(diagnostic.message.contains(says), "{diagnostic:?}");
            let place = format!("{:?}", diagnostic.origin);
            assert!(place.contains(&format!("start: {at},")), "{place}");
        }
        assert_eq!(shown("a\r\nb"), "a\nb");
    }
}
