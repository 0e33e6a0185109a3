//! Operands as runs of tokens, for the messages about a missing `*`.

use super::names::FUNCTIONS;
use super::token::{Cursor, Delimiter, Token, TokenKind, render};

const OPEN: TokenKind = TokenKind::Open(Delimiter::Parenthesis);

/// Whether a token begins a factor.
pub fn begins_factor(token: &Token) -> bool {
    match &token.kind {
        TokenKind::Number(_) | TokenKind::Open(Delimiter::Parenthesis | Delimiter::Invisible) => {
            true
        }
        TokenKind::Identifier(name) => name != "in",
        _ => false,
    }
}

/// The tokens of the last operand: `2` of `x^2`, `(a)` of `-(a)`, `sin(x)` of `sin(x)`.
pub fn last_operand(tokens: &[Token]) -> &[Token] {
    let mut depth = 0usize;
    let mut start = tokens.len();
    for (at, token) in tokens.iter().enumerate().rev() {
        start = at;
        match token.kind {
            TokenKind::Close(_) => depth += 1,
            TokenKind::Open(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    let grouped = matches!(tokens.get(start).map(|t| &t.kind), Some(TokenKind::Open(_)));
    let named = start > 0 && tokens[start - 1].identifier().is_some();
    &tokens[start - usize::from(grouped && named)..]
}

/// Whether a literal such as `2sin` ends in the name of a function.
pub fn ends_in_function(literal: &str) -> bool {
    let letters = literal.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    FUNCTIONS
        .iter()
        .any(|function| letters.ends_with(function.name))
}

/// The operands of a missing `*` as text, for messages.
pub fn operand_text(tokens: &[Token]) -> String {
    let mut cursor = Cursor::new(tokens);
    let Some(first) = cursor.advance() else {
        return String::new();
    };
    let next_opens = cursor.peek().is_some_and(|t| t.kind == OPEN);
    if matches!(first.kind, TokenKind::Open(_)) || (first.identifier().is_some() && next_opens) {
        if first.identifier().is_some() {
            cursor.advance();
        }
        cursor.take_until(|_| false);
        cursor.advance();
    }
    render(cursor.tokens_since(0))
}
