//! Prints messages the way rustc does: title, place, source line with caret, help.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{IsTerminal as _, Write as _};
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use lie_syntax::characters::visible;
use lie_syntax::diagnostic::{MOST_SHOWN, not_shown};

use crate::message::{Message, Place};

/// Bytes of a source line that are shown on either side of a mistake at most; the rest of a
/// minified file is cut away before anything measures it.
const WINDOW: usize = 2000;

/// Says something on stderr, in a line of its own.
pub fn say(text: &str) {
    say_all(&format!("{}\n", text.trim_end_matches('\n')));
}

/// Says whole lines on stderr, or nothing. Nobody is left to hear that stderr is closed.
pub fn say_all(lines: &str) {
    let _ = std::io::stderr().lock().write_all(lines.as_bytes());
}

/// Prints messages to stderr, in colour on a terminal.
pub fn print(messages: &[Message]) {
    let renderer = renderer();
    let mut text = String::new();
    for message in messages.iter().take(MOST_SHOWN) {
        text.push_str(&render(&renderer, message));
        text.push('\n');
    }
    if let Some(rest) = not_shown(messages.len()) {
        text.push_str(&format!("note: {rest}\n"));
    }
    say_all(&text);
}

fn renderer() -> Renderer {
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if colour {
        Renderer::styled()
    } else {
        Renderer::plain()
    }
}

/// Prints why an integration stopped, and the remedy.
pub fn stopped(text: &str, remedy: &str) {
    let renderer = renderer();
    let title = Group::with_title(Level::ERROR.primary_title(visible(text)));
    let mut text = renderer.render(&[title]);
    if !remedy.is_empty() {
        text.push('\n');
        let help = Level::HELP.secondary_title(visible(remedy));
        text.push_str(&renderer.render(&[Group::with_title(help)]));
    }
    text.push('\n');
    say_all(&text);
}

/// One message as text that ends with a newline.
pub fn render(renderer: &Renderer, message: &Message) -> String {
    let level = if message.warning {
        Level::WARNING
    } else {
        Level::ERROR
    };
    let title = level
        .primary_title(visible(&message.text))
        .id(message.kind.as_str());
    let mut text = match &message.place {
        Place::Text(source, range) => {
            let line = Line::of(&source.text, range.clone());
            let path = visible(&source.path);
            let snippet = Snippet::source(&*line.text)
                .path(&*path)
                .line_start(line.number)
                .annotation(AnnotationKind::Primary.span(line.range.clone()));
            let rendered = renderer.render(&[title.element(snippet)]);
            line.with_true_column(rendered, &path)
        }
        Place::None => renderer.render(&[Group::with_title(title)]),
        Place::File(path) => {
            format!(
                "{}\n --> {}",
                renderer.render(&[Group::with_title(title)]),
                visible(path)
            )
        }
        Place::Argument { name, value } => {
            let mut text = renderer.render(&[Group::with_title(title)]);
            let _ = write!(text, "\n --> command line: {}", visible(name));
            if let Some((value, range)) = value {
                let line = Line::of(value, range.clone());
                let snippet = Snippet::source(&*line.text)
                    .line_numbering(false)
                    .annotation(AnnotationKind::Primary.span(line.range.clone()));
                let group = Group::with_level(Level::ERROR).element(snippet);
                // Behind the place comes the value with its caret, without the origin line that
                // would number the lines of an option.
                for row in renderer
                    .render(&[group])
                    .lines()
                    .filter(|row| !row.contains("-->"))
                {
                    let _ = write!(text, "\n {row}");
                }
            }
            text
        }
    };
    text.push('\n');
    if let Some(help) = &message.help {
        let help = Level::HELP.secondary_title(visible(help));
        text.push_str(&renderer.render(&[Group::with_title(help)]));
        text.push('\n');
    }
    text
}

/// The line in which a byte range begins, and the part of the range that lies in it.
struct Line<'a> {
    text: Cow<'a, str>,
    /// Counted from 1.
    number: usize,
    range: Range<usize>,
    /// Characters cut away before `text`.
    cut: usize,
}

impl<'a> Line<'a> {
    /// Any range is answered: beyond the end, inside a character, reversed.
    fn of(source: &'a str, range: Range<usize>) -> Self {
        let start = floor(source, range.start.min(source.len()));
        let end = ceil(source, range.end.min(source.len())).max(start);
        let first = source[..start].rfind('\n').map_or(0, |at| at + 1);
        let last = source[start..]
            .find('\n')
            .map_or(source.len(), |at| start + at);
        let last = if source[first..last].ends_with('\r') {
            (last - 1).max(start)
        } else {
            last
        };
        let number = source.as_bytes()[..first]
            .iter()
            .filter(|&&byte| byte == b'\n')
            .count()
            + 1;
        let from = floor(source, first.max(start.saturating_sub(WINDOW)));
        let to = ceil(source, last.min(start + WINDOW));
        let cut = source[first..from].chars().count();
        // The renderer shows the other controls; of these every byte keeps its place.
        let text = match source[from..to].contains(is_c1) {
            true => Cow::Owned(source[from..to].replace(is_c1, "¿")),
            false => Cow::Borrowed(&source[from..to]),
        };
        Self {
            text,
            number,
            range: start - from..end.clamp(start, to) - from,
            cut,
        }
    }

    /// The column in the whole line, where the renderer saw only a part of it.
    fn with_true_column(&self, rendered: String, path: &str) -> String {
        if self.cut == 0 {
            return rendered;
        }
        let column = self.text[..self.range.start].chars().count() + 1;
        let seen = format!("{path}:{}:{column}", self.number);
        let meant = format!("{path}:{}:{}", self.number, column + self.cut);
        rendered.replacen(&seen, &meant, 1)
    }
}

/// The controls beyond ASCII, of two bytes each, which some terminals obey.
fn is_c1(c: char) -> bool {
    matches!(c, '\u{80}'..='\u{9f}')
}

fn floor(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn ceil(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at += 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use lie_syntax::diagnostic::Kind;

    use super::*;
    use crate::message::Source;

    fn at(text: &str, range: Range<usize>) -> String {
        let source = Arc::new(Source {
            path: "a.json".to_owned(),
            text: text.to_owned(),
        });
        let message = Message::new(Kind::Syntax, "wrong")
            .at_place(Place::Text(source, range))
            .help("mend it");
        render(&Renderer::plain(), &message)
    }

    #[test]
    fn title_place_caret_help() {
        assert_eq!(
            at("first\n\tx = Π + foo\nlast", 16..19),
            "error[syntax]: wrong\n --> a.json:2:10\n  |\n2 |     x = Π + foo\n  |             ^^^\nhelp: mend it\n"
        );
    }

    #[test]
    fn columns_count_characters_of_the_whole_line() {
        let minified = format!(
            "{{\"π\":1}}\n{}foo{}",
            "é,".repeat(30_000),
            ",1".repeat(30_000)
        );
        let start = minified.find("foo").unwrap_or_default();
        let text = at(&minified, start..start + 3);
        assert!(text.contains("--> a.json:2:60001\n"), "{text}");
        assert!(text.len() < 1000, "the line is cut: {}", text.len());
        let caret = text
            .lines()
            .find(|line| line.contains('^'))
            .unwrap_or_default();
        let code = text
            .lines()
            .find(|line| line.contains("foo"))
            .unwrap_or_default();
        let column = |line: &str, what| line.split(what).next().map(|s| s.chars().count());
        assert_eq!(column(caret, "^^^"), column(code, "foo"));
    }

    #[test]
    fn any_range_is_answered() {
        for text in [
            "",
            "\n",
            "a",
            "Πα\n",
            "\r\n",
            "{\r\n}",
            "x\u{301}y",
            "\t\t",
            "\u{0}\u{1b}[31m",
        ] {
            for start in 0..8 {
                for end in [0, 1, 2, 3, 7, usize::MAX] {
                    let rendered = at(text, start..end);
                    assert!(rendered.contains("--> a.json:"), "{text:?} {start}..{end}");
                    assert!(!rendered.contains('\u{1b}'), "{rendered:?}");
                }
            }
        }
    }

    #[test]
    fn command_line_places() {
        let place = |value| Place::Argument {
            name: "--step".to_owned(),
            value,
        };
        let message = Message::new(Kind::Option, "zero")
            .at_place(place(None))
            .help("try 0.01");
        assert_eq!(
            render(&Renderer::plain(), &message),
            "error[option]: zero\n --> command line: --step\nhelp: try 0.01\n"
        );
        let message = message.at_place(place(Some(("1/one".to_owned(), 2..5))));
        let text = render(&Renderer::plain(), &message);
        assert!(
            text.starts_with("error[option]: zero\n --> command line: --step\n"),
            "{text}"
        );
        assert!(
            text.contains("1/one\n") && text.contains("  ^^^\n"),
            "{text}"
        );
    }
}
