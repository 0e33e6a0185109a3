//! Expression text from JSON strings and the command line: decoding, lexing, places.

use std::borrow::Cow;
use std::ops::Range;

use super::names::normalised;
use super::token::{Delimiter, Token, TokenKind};
use crate::diagnostic::{Diagnostic, Kind, Origin};

/// Text with a map from its bytes to the bytes of the file in which it stands.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    /// The text without JSON escapes.
    pub text: Cow<'a, str>,
    /// Pairs (byte of the text, byte of the file); between two pairs the bytes run in parallel.
    segments: Vec<(usize, usize)>,
}

impl<'a> Source<'a> {
    /// Text that stands as it is, from byte `offset` of its file on.
    pub fn plain(text: &'a str, offset: usize) -> Self {
        Self {
            text: Cow::Borrowed(text),
            segments: vec![(0, offset)],
        }
    }

    /// Text that stands nowhere.
    pub fn owned(text: String) -> Self {
        Self {
            text: Cow::Owned(text),
            segments: vec![(0, 0)],
        }
    }

    /// The value of a JSON string; `raw` includes the quotes and begins at byte `offset`.
    ///
    /// # Errors
    /// `schema` at an escape that is malformed or half of a surrogate pair.
    pub fn json(raw: &'a str, offset: usize) -> Result<Self, Diagnostic> {
        let body = raw
            .strip_prefix('"')
            .and_then(|r| r.strip_suffix('"'))
            .unwrap_or(raw);
        let offset = offset + usize::from(body.len() < raw.len());
        if !body.contains('\\') {
            return Ok(Self::plain(body, offset));
        }
        let mut text = String::with_capacity(body.len());
        let mut segments = vec![(0, offset)];
        let mut at = 0;
        while let Some(length) = body[at..].find('\\') {
            text.push_str(&body[at..at + length]);
            at += length;
            let (character, length) = escape(&body[at..]).ok_or_else(|| {
                let end = body.len().min(at + 6);
                let end = (at..=end).rev().find(|&i| body.is_char_boundary(i)).unwrap_or(at);
                let place = Origin::Text { start: offset + at, end: offset + end };
                Diagnostic::new(Kind::Schema, place, "malformed escape in a JSON string")
                    .help("`\\u` takes four hexadecimal digits; characters beyond U+FFFF take a surrogate pair")
            })?;
            segments.push((text.len(), offset + at));
            text.push(character);
            at += length;
            segments.push((text.len(), offset + at));
        }
        text.push_str(&body[at..]);
        Ok(Self {
            text: Cow::Owned(text),
            segments,
        })
    }

    /// The place of a byte range of the text.
    pub fn origin(&self, range: Range<usize>) -> Origin {
        Origin::Text {
            start: self.locate(range.start),
            end: self.locate(range.end),
        }
    }

    /// The place of the whole text.
    pub fn extent(&self) -> Origin {
        self.origin(0..self.text.len())
    }

    fn locate(&self, byte: usize) -> usize {
        let after = self
            .segments
            .partition_point(|&(decoded, _)| decoded <= byte);
        let (decoded, source) = self.segments[after.saturating_sub(1)];
        source + (byte - decoded)
    }

    /// The tokens of the text. Characters that no rule accepts become punctuation.
    pub fn tokens(&self) -> Vec<Token> {
        let mut tokens = Vec::new();
        let mut at = 0;
        while let Some(first) = self.text[at..].chars().next() {
            let rest = &self.text[at..];
            let length = if first.is_whitespace() {
                at += first.len_utf8();
                continue;
            } else if first.is_ascii_digit() {
                number_length(rest)
            } else if is_start(first) {
                name_length(rest)
            } else {
                first.len_utf8()
            };
            let kind = match first {
                _ if first.is_ascii_digit() => TokenKind::Number(normalised(&rest[..length])),
                _ if is_start(first) => TokenKind::Identifier(normalised(&rest[..length])),
                '(' => TokenKind::Open(Delimiter::Parenthesis),
                '[' => TokenKind::Open(Delimiter::Bracket),
                '{' => TokenKind::Open(Delimiter::Brace),
                ')' => TokenKind::Close(Delimiter::Parenthesis),
                ']' => TokenKind::Close(Delimiter::Bracket),
                '}' => TokenKind::Close(Delimiter::Brace),
                other => TokenKind::Punctuation(other),
            };
            tokens.push(Token {
                kind,
                origin: self.origin(at..at + length),
            });
            at += length;
        }
        tokens
    }
}

/// The character that a JSON escape stands for, and the length of the escape.
fn escape(text: &str) -> Option<(char, usize)> {
    let hex = |at: usize| -> Option<u32> {
        let digits = text.get(at..at + 4)?;
        // `from_str_radix` alone would take a sign.
        digits
            .bytes()
            .all(|b| b.is_ascii_hexdigit())
            .then(|| u32::from_str_radix(digits, 16).ok())?
    };
    Some(match text.as_bytes().get(1)? {
        b'"' => ('"', 2),
        b'\\' => ('\\', 2),
        b'/' => ('/', 2),
        b'b' => ('\u{8}', 2),
        b'f' => ('\u{c}', 2),
        b'n' => ('\n', 2),
        b'r' => ('\r', 2),
        b't' => ('\t', 2),
        b'u' => match hex(2)? {
            high @ 0xD800..=0xDBFF if text.get(6..8) == Some("\\u") => {
                let low = hex(8).filter(|low| (0xDC00..=0xDFFF).contains(low))?;
                (
                    char::from_u32(0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00))?,
                    12,
                )
            }
            code => (char::from_u32(code)?, 6),
        },
        _ => return None,
    })
}

fn is_start(c: char) -> bool {
    c == '_' || unicode_ident::is_xid_start(c)
}

fn name_length(text: &str) -> usize {
    text.find(|c| !unicode_ident::is_xid_continue(c))
        .unwrap_or(text.len())
}

/// Length of a numeric literal by the rules of Rust's lexer, suffix included, so that both front
/// ends see the same tokens: in `1..5` and `1.x` the point is not part of the number.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes
            .get(at)
            .is_some_and(|b| b.is_ascii_digit() || *b == b'_')
        {
            at += 1;
        }
        at
    };
    let mut at = digits(0);
    if bytes.get(at) == Some(&b'.') {
        match text[at + 1..].chars().next() {
            Some(c) if c.is_ascii_digit() => at = digits(at + 1),
            Some(c) if c == '.' || is_start(c) => return at,
            _ => return at + 1,
        }
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(at + 1 + sign).is_some_and(u8::is_ascii_digit) {
            at = digits(at + 1 + sign);
        }
    }
    match text[at..].chars().next() {
        Some(c) if is_start(c) => at + name_length(&text[at..]),
        _ => at,
    }
}
