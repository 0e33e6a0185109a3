//! Macro tokens to ours.

use proc_macro2::token_stream::IntoIter;
use proc_macro2::{Group, Ident, Literal, Span, TokenStream, TokenTree};

use super::names::normalised;
use super::token::{Delimiter, Token, TokenKind};
use crate::diagnostic::Origin;

/// The tokens of a macro's input, groups laid flat between their delimiters.
pub fn tokens(input: TokenStream) -> Vec<Token> {
    let mut tokens = Vec::new();
    // An explicit stack: how deep groups nest is up to the user.
    let mut open: Vec<(IntoIter, Option<(Delimiter, Span)>)> = vec![(input.into_iter(), None)];
    while let Some((trees, close)) = open.last_mut() {
        let (kind, span) = match trees.next() {
            Some(TokenTree::Ident(ident)) => {
                let name = normalised(&ident.to_string());
                (TokenKind::Identifier(name), ident.span())
            }
            Some(TokenTree::Punct(punct)) => {
                (TokenKind::Punctuation(punct.as_char()), punct.span())
            }
            Some(TokenTree::Literal(literal)) => {
                let span = literal.span();
                let kind = self::literal(&literal);
                match kind {
                    // Only other macros can make a negative literal.
                    TokenKind::Number(text) if text.starts_with('-') => {
                        push(&mut tokens, TokenKind::Punctuation('-'), span);
                        (TokenKind::Number(text[1..].to_owned()), span)
                    }
                    kind => (kind, span),
                }
            }
            Some(TokenTree::Group(group)) => {
                let delimiter = delimiter(&group);
                if let Some(delimiter) = delimiter {
                    push(&mut tokens, TokenKind::Open(delimiter), group.span_open());
                }
                open.push((
                    group.stream().into_iter(),
                    delimiter.map(|d| (d, group.span_close())),
                ));
                continue;
            }
            None => {
                let close = close.take();
                open.pop();
                let Some((delimiter, span)) = close else {
                    continue;
                };
                (TokenKind::Close(delimiter), span)
            }
        };
        push(&mut tokens, kind, span);
    }
    tokens
}

fn push(tokens: &mut Vec<Token>, kind: TokenKind, span: Span) {
    tokens.push(Token {
        kind,
        origin: Origin::from_span(span),
    });
}

/// `None` for an invisible group that groups nothing: one token, or a visibility.
fn delimiter(group: &Group) -> Option<Delimiter> {
    Some(match group.delimiter() {
        proc_macro2::Delimiter::Parenthesis => Delimiter::Parenthesis,
        proc_macro2::Delimiter::Bracket => Delimiter::Bracket,
        proc_macro2::Delimiter::Brace => Delimiter::Brace,
        proc_macro2::Delimiter::None => {
            let mut trees = group.stream().into_iter();
            match (trees.next(), trees.next()) {
                (Some(TokenTree::Ident(ident)), _) if ident == "pub" => return None,
                (None | Some(_), None) => return None,
                _ => Delimiter::Invisible,
            }
        }
    })
}

fn literal(literal: &Literal) -> TokenKind {
    let text = literal.to_string();
    if text.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
        return TokenKind::Number(normalised(&text));
    }
    match syn::Lit::new(literal.clone()) {
        syn::Lit::Str(value) => TokenKind::Text(value.value()),
        _ => TokenKind::Literal(text),
    }
}

/// Words, `:` and parentheses back as macro tokens: the forms of a visibility.
pub fn stream(tokens: &[Token]) -> TokenStream {
    let mut levels = vec![TokenStream::new()];
    for token in tokens {
        let span = match token.origin {
            Origin::Span(id) => id.span(),
            Origin::Text { .. } => Span::call_site(),
        };
        let tree = match &token.kind {
            TokenKind::Identifier(text) => match text.strip_prefix("r#") {
                Some(raw) => TokenTree::from(Ident::new_raw(raw, span)),
                None => TokenTree::from(Ident::new(text, span)),
            },
            TokenKind::Punctuation(c) => {
                let mut punct = proc_macro2::Punct::new(*c, proc_macro2::Spacing::Joint);
                punct.set_span(span);
                punct.into()
            }
            TokenKind::Open(_) => {
                levels.push(TokenStream::new());
                continue;
            }
            TokenKind::Close(_) if levels.len() > 1 => {
                let inner = levels.pop().unwrap_or_default();
                let mut group = Group::new(proc_macro2::Delimiter::Parenthesis, inner);
                group.set_span(span);
                group.into()
            }
            _ => continue,
        };
        if let Some(level) = levels.last_mut() {
            level.extend([tree]);
        }
    }
    levels.swap_remove(0)
}
