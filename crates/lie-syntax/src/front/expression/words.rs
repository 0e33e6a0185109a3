//! Names and calls in expressions, and what looks like one.

use super::super::names::{PIECEWISE, arity};
use super::super::operand::{begins_factor, operand_text};
use super::super::token::{Delimiter, Token, TokenKind, render};
use super::super::{families, habits, mistakes, piecewise, vectors};
use super::{CLOSE, OPEN, Parser, zero};
use crate::ast::{Expr, ExprKind, Name};

impl<'a> Parser<'a> {
    pub(super) fn name(&mut self, name: &str, token: &'a Token) -> Option<Expr> {
        let called = self.cursor.peek().is_some_and(|t| t.kind == OPEN);
        if name == "sum" && called {
            return self.nested(|parser| families::indexed_sum(parser, token));
        }
        if name == PIECEWISE && called {
            return self.nested(|parser| piecewise::cases(parser, token));
        }
        if called
            && self.names.knows(name)
            && arity(name).is_none()
            && self.cursor.ahead(1).is_some_and(|t| t.kind == CLOSE)
        {
            self.fail(mistakes::called_name(name, token.origin));
            self.cursor.advance();
            self.cursor.advance();
            return Some(zero(token.origin));
        }
        if let Some(function) = self.bracketed(name) {
            return self.bracketed_call(&function, token);
        }
        if called && (arity(name).is_some() || !self.names.knows(name)) {
            return self.nested(|parser| parser.call(name, token));
        }
        if (arity(name).is_some() || name == "sum") && !self.names.declares(name) {
            return self.uncalled(name, token);
        }
        let (index, origin) = families::index(self, token)?;
        Some(Expr {
            kind: ExprKind::Name {
                name: name.to_owned(),
                index: index.map(Box::new),
            },
            origin,
        })
    }

    /// Whether a name is a word of programming languages that nobody declared.
    pub(super) fn is_foreign_word(&self, name: &str) -> bool {
        habits::word(name).is_some() && !self.names.knows(name)
    }

    /// The function that `Sin[` or `sin[` means.
    fn bracketed(&self, name: &str) -> Option<String> {
        let open = TokenKind::Open(Delimiter::Bracket);
        let lower = name.to_lowercase();
        let function = arity(&lower).is_some() && !self.names.knows(name);
        (function && self.cursor.peek()?.kind == open).then_some(lower)
    }

    fn bracketed_call(&mut self, function: &str, token: &'a Token) -> Option<Expr> {
        self.cursor.advance();
        let argument = self.cursor.take_until(|_| false);
        self.cursor.advance();
        self.fail(mistakes::bracketed_call(function, argument, token.origin));
        Some(zero(token.origin))
    }

    /// `sin x`, `sin^2(x)`, `sin` alone: what follows is the argument, not a factor without `*`.
    fn uncalled(&mut self, name: &str, token: &'a Token) -> Option<Expr> {
        let start = self.cursor.position();
        let number = |t: &Token| matches!(t.kind, TokenKind::Number(_));
        if self.cursor.peek().is_some_and(|t| t.is('^'))
            && self.cursor.ahead(1).is_some_and(number)
            && self.cursor.ahead(2).is_some_and(begins_factor)
        {
            self.cursor.advance();
            self.cursor.advance();
        }
        let power = render(self.cursor.tokens_since(start));
        let follows = self.cursor.peek().is_some_and(begins_factor);
        let argument = if follows {
            operand_text(self.cursor.rest())
        } else {
            String::new()
        };
        let mistake = mistakes::function_without_call(name, &argument, &power, token.origin);
        self.fail(mistake);
        if follows {
            self.nested(Self::power)?;
        }
        Some(zero(token.origin))
    }

    fn call(&mut self, function: &str, token: &'a Token) -> Option<Expr> {
        let open = self.cursor.advance()?;
        let mut arguments = Vec::new();
        let mut texts = Vec::new();
        if self.cursor.peek().is_none_or(|t| t.kind != CLOSE) {
            loop {
                let start = self.cursor.position();
                arguments.push(self.sum()?);
                texts.push(render(self.cursor.tokens_since(start)));
                if self.cursor.eat(',').is_none() {
                    break;
                }
            }
        }
        let origin = token.origin.join(self.close(open, Delimiter::Parenthesis)?);
        let of_table = || self.names.tables().arity(function);
        let expected = arity(function).or_else(|| vectors::arity(function));
        match expected.or_else(of_table) {
            None => self.fail(mistakes::unknown_function(
                function,
                &texts,
                token.origin,
                self.names,
            )),
            Some(expected) if expected != arguments.len() => {
                self.fail(mistakes::wrong_arity(
                    function,
                    expected,
                    arguments.len(),
                    origin,
                ));
            }
            Some(_) => {}
        }
        let function = Name {
            text: function.to_owned(),
            origin: token.origin,
        };
        Some(Expr {
            kind: ExprKind::Call {
                function: Box::new(function),
                arguments,
            },
            origin,
        })
    }
}
