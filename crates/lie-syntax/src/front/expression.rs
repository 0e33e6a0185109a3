//! The precedence parser of the mathematics, one for both front ends.
//!
//! ```text
//! sum      = product (("+" | "-") product)*
//! product  = unary (("*" | "/") unary)*
//! unary    = "-" unary | power
//! power    = primary ("^" exponent)?
//! exponent = "-" exponent | power
//! primary  = number | name | name "[" index "]" | function "(" sum ("," sum)* ")" | "(" sum ")"
//!          | "sum" "(" name "in" sum ".." sum ":" sum ")"
//!          | "piecewise" "(" (sum ("<" | "<=" | ">" | ">=") sum ":" sum ",")+ sum ")"
//! ```
//!
//! Rust's own expression parser gives `x^2/I1 + y` another meaning (`^` binds weaker than `+`
//! there), hence this one. A mistake that leaves the rest readable (a missing `*`, an unknown
//! function, a malformed number) is reported and parsing goes on.

mod words;

use super::names::Names;
use super::number;
use super::operand::{begins_factor, ends_in_function, last_operand};
use super::token::{Cursor, Delimiter, Token, TokenKind};
use super::{families, mistakes, vectors};
use crate::ast::{Expr, ExprKind};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use lie_symbolic::exact::Rational;

/// How deep parentheses, calls, powers and signs may nest.
const MAX_DEPTH: usize = 100;

const OPEN: TokenKind = TokenKind::Open(Delimiter::Parenthesis);
const CLOSE: TokenKind = TokenKind::Close(Delimiter::Parenthesis);

/// Parses tokens, all of them, as one expression; `None` if anything was reported.
///
/// `names` are those that may stand in the expression. `tokens` is not empty: only the caller
/// knows what is missing where nothing stands.
pub fn parse(tokens: &[Token], names: &Names, report: &mut Report) -> Option<Expr> {
    let taken = parse_as_written(tokens, names, report)?;
    let scalar = vectors::expand(taken, names.vectors(), report)?;
    names.tables().expand(scalar, report)
}

/// The same of what may be a vector or a matrix.
pub fn parse_value(tokens: &[Token], names: &Names, report: &mut Report) -> Option<vectors::Value> {
    let taken = parse_as_written(tokens, names, report)?;
    let value = vectors::expand_value(taken, names.vectors(), report)?;
    value.map(|entry| names.tables().expand(entry, report))
}

fn parse_as_written(tokens: &[Token], names: &Names, report: &mut Report) -> Option<Expr> {
    let mut parser = Parser {
        cursor: Cursor::new(tokens),
        names,
        report,
        depth: 0,
        bounds: false,
        failed: false,
    };
    let expression = parser.sum();
    if expression.is_some()
        && let Some(token) = parser.cursor.peek()
    {
        let before = parser.cursor.previous();
        let rest = &parser.cursor.rest()[1..];
        parser.fail(mistakes::unexpected(token, before, rest));
    }
    let expression = expression.filter(|_| !parser.failed)?;
    let taken = names.may_be_indexed() || families::refuse(&expression, report);
    taken.then_some(expression)
}

/// The parser's state. Methods return `None` after a mistake that they reported and behind which
/// the text cannot be read.
pub(super) struct Parser<'a> {
    pub(super) cursor: Cursor<'a>,
    pub(super) names: &'a Names,
    report: &'a mut Report,
    depth: usize,
    /// Whether `..` may follow a number, as in the bounds of an indexed sum.
    pub(super) bounds: bool,
    failed: bool,
}

impl<'a> Parser<'a> {
    /// Reports a mistake.
    pub(super) fn fail(&mut self, diagnostic: Diagnostic) {
        self.failed = true;
        self.report.push(diagnostic);
    }

    /// Runs a rule one level deeper.
    fn nested<T>(&mut self, rule: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.depth == MAX_DEPTH {
            let place = self.cursor.previous().or(self.cursor.peek())?.origin;
            self.fail(
                Diagnostic::new(
                    Kind::Limit,
                    place,
                    format!("the expression nests deeper than {MAX_DEPTH} levels"),
                )
                .help("give parts of it names with `let`"),
            );
            return None;
        }
        self.depth += 1;
        let result = rule(self);
        self.depth -= 1;
        result
    }

    pub(super) fn sum(&mut self) -> Option<Expr> {
        if let Some(plus) = self.cursor.peek().filter(|t| t.is('+')) {
            self.fail(mistakes::unary_plus(plus));
            self.cursor.advance();
        }
        let first = self.product()?;
        let mut terms = vec![(false, first)];
        while let Some(sign) = self.cursor.peek().filter(|t| t.is('+') || t.is('-')) {
            self.cursor.advance();
            terms.push((sign.is('-'), self.product()?));
        }
        Some(n_ary(terms, ExprKind::Sum))
    }

    fn product(&mut self) -> Option<Expr> {
        let mut factors = Vec::new();
        let mut divides = false;
        loop {
            let start = self.cursor.position();
            factors.push((divides, self.unary()?));
            match self.cursor.peek() {
                Some(token) if token.is('*') || token.is('/') => {
                    divides = token.is('/');
                    self.cursor.advance();
                }
                // `x in` and `x[` never begin a factor.
                Some(token) if begins_factor(token) => {
                    let words = [self.cursor.previous(), Some(token)].into_iter().flatten();
                    let known =
                        |t: &&Token| t.identifier().is_some_and(|n| self.is_foreign_word(n));
                    if let Some(word) = words.into_iter().find(known) {
                        self.fail(mistakes::programming_word(word));
                        return None;
                    }
                    let left = last_operand(self.cursor.tokens_since(start));
                    self.fail(mistakes::missing_times(left, self.cursor.rest()));
                    divides = false;
                }
                _ => return Some(n_ary(factors, ExprKind::Product)),
            }
        }
    }

    fn unary(&mut self) -> Option<Expr> {
        let Some(minus) = self.cursor.eat('-') else {
            return self.power();
        };
        let operand = self.nested(Self::unary)?;
        Some(negative(minus.origin, operand))
    }

    fn power(&mut self) -> Option<Expr> {
        let base = self.primary()?;
        if self.cursor.eat('^').is_none() {
            return Some(base);
        }
        let exponent = self.nested(Self::exponent)?;
        let origin = base.origin.join(exponent.origin);
        Some(Expr {
            kind: ExprKind::Power(Box::new(base), Box::new(exponent)),
            origin,
        })
    }

    fn exponent(&mut self) -> Option<Expr> {
        let Some(minus) = self.cursor.eat('-') else {
            return self.power();
        };
        let operand = self.nested(Self::exponent)?;
        Some(negative(minus.origin, operand))
    }

    fn primary(&mut self) -> Option<Expr> {
        let before = self.cursor.previous();
        let Some(token) = self.cursor.advance() else {
            // Only an empty slice has no token before its end; its place is the caller's.
            let before = before?;
            self.fail(mistakes::missing_operand(before));
            return None;
        };
        match &token.kind {
            TokenKind::Number(literal) => Some(self.number(literal, token)),
            TokenKind::Identifier(name) if name.contains(mistakes::MIDDLE_DOTS) => {
                self.fail(mistakes::middle_dot(name, token.origin));
                Some(zero(token.origin))
            }
            TokenKind::Identifier(name) if name.starts_with("r#") => {
                self.fail(mistakes::raw_identifier(token));
                Some(zero(token.origin))
            }
            TokenKind::Identifier(name) => self.name(name, token),
            TokenKind::Open(delimiter @ (Delimiter::Parenthesis | Delimiter::Invisible)) => {
                let mut inner = self.nested(Self::sum)?;
                inner.origin = token.origin.join(self.close(token, *delimiter)?);
                Some(inner)
            }
            TokenKind::Punctuation('+') => {
                self.fail(mistakes::unary_plus(token));
                self.nested(Self::unary)
            }
            _ => {
                self.fail(mistakes::unexpected(token, before, self.cursor.rest()));
                None
            }
        }
    }

    /// Takes the closing delimiter of `open` and returns its place.
    pub(super) fn close(&mut self, open: &Token, delimiter: Delimiter) -> Option<Origin> {
        if let Some(close) = self.cursor.eat_kind(&TokenKind::Close(delimiter)) {
            return Some(close.origin);
        }
        let diagnostic = match self.cursor.peek() {
            Some(token) => {
                let rest = &self.cursor.rest()[1..];
                mistakes::unexpected(token, self.cursor.previous(), rest)
            }
            None => mistakes::unclosed(open),
        };
        self.fail(diagnostic);
        None
    }

    fn number(&mut self, literal: &str, token: &'a Token) -> Expr {
        let start = self.cursor.position() - 1;
        let point = |c: &Cursor<'_>| c.peek().is_some_and(|t| t.is('.'));
        let range =
            self.bounds && point(&self.cursor) && self.cursor.ahead(1).is_some_and(|t| t.is('.'));
        let value = if point(&self.cursor) && !range {
            // `1..5`, `1.2.3`, `1.x`: Rust's lexer ends the number before the point.
            while self.cursor.eat('.').is_some() {
                let goes_on =
                    |t: &Token| matches!(t.kind, TokenKind::Number(_) | TokenKind::Identifier(_));
                if self.cursor.peek().is_some_and(goes_on) {
                    self.cursor.advance();
                }
            }
            self.fail(mistakes::malformed_number(self.cursor.tokens_since(start)));
            None
        } else {
            match number::read(literal, self.names) {
                Ok(value) => Some(value),
                Err(mistake) => {
                    let diagnostic = Diagnostic::new(mistake.kind, token.origin, mistake.message);
                    self.fail(diagnostic.help(mistake.help));
                    // `2sin(x)`: the parentheses belong to the function, not to a product.
                    if ends_in_function(literal)
                        && self.cursor.peek().is_some_and(|t| t.kind == OPEN)
                    {
                        self.cursor.advance();
                        self.cursor.take_until(|_| false);
                        self.cursor.advance();
                    }
                    None
                }
            }
        };
        Expr {
            kind: ExprKind::Number(value.unwrap_or(Rational::ZERO)),
            origin: token.origin,
        }
    }
}

/// A single operand stands for itself.
fn n_ary(mut operands: Vec<(bool, Expr)>, kind: fn(Vec<(bool, Expr)>) -> ExprKind) -> Expr {
    if operands.len() == 1
        && let Some((_, operand)) = operands.pop()
    {
        return operand;
    }
    // of a million products, what was reserved for more factors is most of the tree
    operands.shrink_to_fit();
    let origin = operands[0]
        .1
        .origin
        .join(operands[operands.len() - 1].1.origin);
    Expr {
        kind: kind(operands),
        origin,
    }
}

fn negative(minus: Origin, operand: Expr) -> Expr {
    let origin = minus.join(operand.origin);
    Expr {
        kind: ExprKind::Negative(Box::new(operand)),
        origin,
    }
}

/// What stands in the tree for something that was reported; the tree is not returned then.
fn zero(origin: Origin) -> Expr {
    Expr {
        kind: ExprKind::Number(Rational::ZERO),
        origin,
    }
}
