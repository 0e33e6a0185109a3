//! Blocks, their entries and doc comments.

use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::Line;
use crate::front::mistakes;
use crate::front::token::{Cursor, Delimiter, Token, TokenKind, render_whole};

/// One `…;` in a block.
#[derive(Debug)]
pub struct Entry<'a> {
    docs: Vec<String>,
    /// Its tokens, at least one.
    pub tokens: &'a [Token],
}

impl<'a> Entry<'a> {
    /// Its tokens with their place.
    pub fn line(&self) -> Line<'a> {
        Line {
            tokens: self.tokens.into(),
            place: self.origin(),
        }
    }

    /// Whether the entry begins with this word.
    pub fn is_word(&self, word: &str) -> bool {
        self.tokens.first().is_some_and(|t| t.is_word(word))
    }

    /// Place of its first token.
    pub fn origin(&self) -> Origin {
        self.tokens
            .first()
            .map_or(Origin::from_span(proc_macro2::Span::call_site()), |t| {
                t.origin
            })
    }

    /// The doc comment as one text.
    pub fn description(&self) -> Option<String> {
        (!self.docs.is_empty()).then(|| self.docs.join("\n"))
    }
}

/// `#[doc = "…"]`, which is what `/// …` becomes.
pub fn docs(cursor: &mut Cursor<'_>, report: &mut Report) -> Vec<String> {
    let mut docs = Vec::new();
    while cursor.peek().is_some_and(|t| t.is('#')) {
        let Some(hash) = cursor.advance() else { break };
        cursor.eat('!');
        let start = cursor.position();
        if cursor
            .eat_kind(&TokenKind::Open(Delimiter::Bracket))
            .is_some()
        {
            cursor.take_until(|_| false);
            cursor.advance();
        }
        match inside(cursor.tokens_since(start), Delimiter::Bracket) {
            Some(
                [
                    word,
                    equals,
                    Token {
                        kind: TokenKind::Text(text),
                        ..
                    },
                ],
            ) if word.is_word("doc") && equals.is('=') => {
                // `lines` would drop an empty line, which separates paragraphs.
                let lines = text.split('\n');
                docs.extend(lines.map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned()));
            }
            _ => report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    hash.origin,
                    "a declaration takes doc comments, but no other attributes",
                )
                .help("remove the attribute"),
            ),
        }
    }
    docs
}

/// What stands between two delimiters that enclose all of the tokens.
pub fn inside(tokens: &[Token], delimiter: Delimiter) -> Option<&[Token]> {
    let [open, inside @ .., close] = tokens else {
        return None;
    };
    let encloses =
        open.kind == TokenKind::Open(delimiter) && close.kind == TokenKind::Close(delimiter);
    let mut cursor = Cursor::new(inside);
    cursor.take_until(|_| false);
    (encloses && cursor.peek().is_none()).then_some(inside)
}

/// Splits at `;`. Empty entries are dropped; the last one needs its `;` too.
pub fn split<'a>(tokens: &'a [Token], report: &mut Report) -> Vec<Entry<'a>> {
    let mut cursor = Cursor::new(tokens);
    let mut entries = Vec::new();
    while cursor.peek().is_some() {
        let docs = docs(&mut cursor, report);
        let tokens = cursor.take_until(|c| c.peek().is_some_and(|t| t.is(';')));
        if cursor.eat(';').is_none() {
            // A stray closing delimiter would stop the cursor for good.
            let stray = cursor.advance();
            if let Some(last) = stray.or(cursor.previous()) {
                let diagnostic = match stray {
                    Some(stray) => mistakes::unexpected(stray, tokens.last(), &[]),
                    None => {
                        Diagnostic::new(Kind::Syntax, last.origin, "`;` is missing").help("add it")
                    }
                };
                report.push(diagnostic);
            }
        }
        if !tokens.is_empty() {
            entries.push(Entry { docs, tokens });
        }
    }
    entries
}

/// The tokens as text without spaces.
pub fn compact(tokens: &[Token]) -> String {
    tokens
        .iter()
        .map(|t| render_whole(std::slice::from_ref(t)))
        .collect()
}
