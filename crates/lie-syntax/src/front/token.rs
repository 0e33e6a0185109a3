//! The one token type behind both front ends.

use crate::diagnostic::Origin;

/// A pair of delimiters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// `( )`
    Parenthesis,
    /// `[ ]`
    Bracket,
    /// `{ }`
    Brace,
    /// What `macro_rules!` puts around an expression that it passes on; groups like parentheses.
    Invisible,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A name or keyword; an identifier may contain `·`, which the parsers refuse.
    Identifier(String),
    /// A numeric literal as written, with any suffix; a sign is a token of its own.
    Number(String),
    /// The value of a string literal (macro only).
    Text(String),
    /// Any other literal of Rust, which no rule of ours accepts.
    Literal(String),
    /// One character of punctuation, or one that no rule accepts.
    Punctuation(char),
    /// An opening delimiter.
    Open(Delimiter),
    /// A closing delimiter.
    Close(Delimiter),
}

/// A token and its place.
#[derive(Clone, Debug)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Where it stands.
    pub origin: Origin,
}

impl Token {
    /// Whether the token is this character of punctuation.
    pub fn is(&self, punctuation: char) -> bool {
        self.kind == TokenKind::Punctuation(punctuation)
    }

    /// The identifier, if the token is one.
    pub fn identifier(&self) -> Option<&str> {
        match &self.kind {
            TokenKind::Identifier(text) => Some(text),
            _ => None,
        }
    }

    /// Whether the token is this identifier.
    pub fn is_word(&self, word: &str) -> bool {
        self.identifier() == Some(word)
    }

    fn write(&self, out: &mut String) {
        match &self.kind {
            TokenKind::Identifier(text) | TokenKind::Number(text) | TokenKind::Literal(text) => {
                if out.ends_with(|c: char| c == '_' || c.is_alphanumeric()) {
                    out.push(' ');
                }
                out.push_str(text);
            }
            TokenKind::Text(text) => out.push_str(&format!("{text:?}")),
            TokenKind::Punctuation(',') => out.push_str(", "),
            TokenKind::Punctuation(c) => out.push(*c),
            TokenKind::Open(delimiter) => out.push_str(delimiter.symbols().0),
            TokenKind::Close(delimiter) => out.push_str(delimiter.symbols().1),
        }
    }
}

impl Delimiter {
    fn symbols(self) -> (&'static str, &'static str) {
        match self {
            Delimiter::Parenthesis => ("(", ")"),
            Delimiter::Bracket => ("[", "]"),
            Delimiter::Brace => ("{", "}"),
            Delimiter::Invisible => ("", ""),
        }
    }
}

/// The tokens as text for a message, shortened in the middle when they are long.
pub fn render(tokens: &[Token]) -> String {
    /// Longer texts hide the point of a message.
    const LIMIT: usize = 40;
    let mut out = String::new();
    for token in tokens {
        token.write(&mut out);
        if out.len() > 4 * LIMIT {
            break;
        }
    }
    out.truncate(out.trim_end().len());
    if out.chars().count() <= LIMIT {
        return out;
    }
    out.chars().take(LIMIT - 1).chain(['…']).collect()
}

/// The tokens as text, all of it.
pub fn render_whole(tokens: &[Token]) -> String {
    let mut out = String::new();
    tokens.iter().for_each(|token| token.write(&mut out));
    out
}

/// The place that the tokens cover, `None` where there are none.
pub fn span(tokens: &[Token]) -> Option<Origin> {
    Some(tokens.first()?.origin.join(tokens.last()?.origin))
}

/// A position in a slice of tokens.
#[derive(Clone, Debug)]
pub struct Cursor<'a> {
    tokens: &'a [Token],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// At the first token.
    pub fn new(tokens: &'a [Token]) -> Self {
        Self { tokens, at: 0 }
    }

    /// Index of the next token.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The token `ahead` of the next one.
    pub fn ahead(&self, ahead: usize) -> Option<&'a Token> {
        self.tokens.get(self.at + ahead)
    }

    /// The next token.
    pub fn peek(&self) -> Option<&'a Token> {
        self.ahead(0)
    }

    /// The token before the next one.
    pub fn previous(&self) -> Option<&'a Token> {
        self.tokens.get(self.at.checked_sub(1)?)
    }

    /// Takes the next token.
    pub fn advance(&mut self) -> Option<&'a Token> {
        let token = self.tokens.get(self.at)?;
        self.at += 1;
        Some(token)
    }

    /// Takes the next token if it is this punctuation.
    pub fn eat(&mut self, punctuation: char) -> Option<&'a Token> {
        if self.peek()?.is(punctuation) {
            self.advance()
        } else {
            None
        }
    }

    /// Takes the next token if it is of this kind.
    pub fn eat_kind(&mut self, kind: &TokenKind) -> Option<&'a Token> {
        if self.peek()?.kind == *kind {
            self.advance()
        } else {
            None
        }
    }

    /// The tokens that are left.
    pub fn rest(&self) -> &'a [Token] {
        &self.tokens[self.at..]
    }

    /// The tokens from an earlier position up to the next token.
    pub fn tokens_since(&self, position: usize) -> &'a [Token] {
        &self.tokens[position.min(self.at)..self.at]
    }

    /// Takes tokens up to (not including) the first one outside delimiters that `stop` accepts.
    ///
    /// A closing delimiter without its opening one also stops.
    pub fn take_until(&mut self, stop: impl Fn(&Cursor<'a>) -> bool) -> &'a [Token] {
        let start = self.at;
        let mut depth = 0usize;
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Open(_) => depth += 1,
                TokenKind::Close(_) if depth == 0 => break,
                TokenKind::Close(_) => depth -= 1,
                _ if depth == 0 && stop(self) => break,
                _ => {}
            }
            self.at += 1;
        }
        self.tokens_since(start)
    }
}

/// Splits at the commas outside delimiters. A comma at the end opens no further part.
pub fn split_commas(tokens: &[Token]) -> Vec<&[Token]> {
    let mut cursor = Cursor::new(tokens);
    let mut parts = Vec::new();
    while cursor.peek().is_some() {
        let start = cursor.position();
        loop {
            cursor.take_until(|c| c.peek().is_some_and(|t| t.is(',')));
            // A stray closing delimiter belongs to the part; its parser names it.
            match cursor.peek() {
                Some(token) if !token.is(',') => cursor.advance(),
                _ => break,
            };
        }
        parts.push(cursor.tokens_since(start));
        cursor.advance();
    }
    parts
}
