//! Algebras by name: `so(3)`, `so(3)^2 + R^2`, `semidirect(so(3), R^3)`, `tangent(se(3))`, for both front ends.

mod changes;
mod mistakes;
mod products;

pub use changes::{Changes, standard, without_name};
use mistakes::{unexpected, unknown};

use super::item;
use super::token::{Cursor, Delimiter, Token, TokenKind, render, span, split_commas};
use crate::constructors::{Argument, Family, NamedAlgebra, Wrong, direct_sum, family};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::limits::MAX_DIMENSION;
use crate::linear::{WORK, rational};
use lie_symbolic::exact::{Budget, Rational};

/// How deep parentheses may be nested.
const DEEPEST: usize = 32;
const EXAMPLES: &str = "write the name of an algebra, such as `so(3)` or `so(3) + R^2`";

/// The algebra that tokens name; `whole` is the place of an empty text.
pub fn parse(tokens: &[Token], whole: Origin, report: &mut Report) -> Option<NamedAlgebra> {
    if tokens.is_empty() {
        let missing = Diagnostic::new(Kind::Syntax, whole, "the name of the algebra is missing");
        report.push(missing.help(EXAMPLES));
        return None;
    }
    Some(direct_sum(parts(tokens, 0, report)?))
}

/// The parts of a direct sum.
fn parts(tokens: &[Token], depth: usize, report: &mut Report) -> Option<Vec<NamedAlgebra>> {
    let cursor = Cursor::new(tokens);
    let mut parser = Parser {
        cursor,
        depth,
        report,
    };
    let sum = parser.sum()?;
    match parser.cursor.peek() {
        None => Some(sum),
        Some(token) => {
            let diagnostic = unexpected(token);
            report.push(diagnostic);
            None
        }
    }
}

struct Parser<'a, 'r> {
    cursor: Cursor<'a>,
    depth: usize,
    report: &'r mut Report,
}

/// An atom: the parts of a sum, and whether it is `R` alone.
type Atom = (Vec<NamedAlgebra>, bool);

impl<'a> Parser<'a, '_> {
    fn fail<T>(&mut self, kind: Kind, place: Origin, message: String, help: &str) -> Option<T> {
        self.report
            .push(Diagnostic::new(kind, place, message).help(help));
        None
    }

    fn fits(&mut self, dimension: usize, place: Origin) -> bool {
        fits(dimension, place, self.report)
    }

    fn place_since(&self, start: usize) -> Origin {
        let place = span(self.cursor.tokens_since(start));
        place.unwrap_or(Origin::Text { start: 0, end: 0 })
    }

    /// `A + B + C`
    fn sum(&mut self) -> Option<Vec<NamedAlgebra>> {
        let start = self.cursor.position();
        let mut parts = self.power()?;
        while let Some(plus) = self.cursor.eat('+') {
            if self.cursor.peek().is_none() {
                let message = "a summand is missing after `+`".to_owned();
                return self.fail(Kind::Syntax, plus.origin, message, EXAMPLES);
            }
            parts.extend(self.power()?);
            let place = self.place_since(start);
            if !self.fits(dimension(&parts), place) {
                return None;
            }
        }
        Some(parts)
    }

    /// `A` or `A^N`
    fn power(&mut self) -> Option<Vec<NamedAlgebra>> {
        let start = self.cursor.position();
        let (parts, line) = self.atom()?;
        let Some(caret) = self.cursor.eat('^') else {
            return Some(parts);
        };
        let Some(exponent) = self.cursor.advance() else {
            let message = "the exponent is missing".to_owned();
            return self.fail(
                Kind::Syntax,
                caret.origin,
                message,
                "write `so(3)^4` or `R^3`",
            );
        };
        let digits = match &exponent.kind {
            TokenKind::Number(text) if text.bytes().all(|b| b.is_ascii_digit()) => text,
            TokenKind::Identifier(_) => {
                let message =
                    "a power by a name belongs to a family, whose state has an index".to_owned();
                let help = "write the state as `x[i]`, or a number, as in `so(3)^4`";
                return self.fail(Kind::Syntax, exponent.origin, message, help);
            }
            _ => {
                let text = render(std::slice::from_ref(exponent));
                let message = format!("the exponent `{text}` is not a whole number");
                return self.fail(
                    Kind::Number,
                    exponent.origin,
                    message,
                    "write `so(3)^4` or `R^3`",
                );
            }
        };
        let count = digits.parse().unwrap_or(usize::MAX);
        if count == 0 {
            let message = "the power 0 has no elements".to_owned();
            return self.fail(
                Kind::Number,
                exponent.origin,
                message,
                "write an exponent of at least 1",
            );
        }
        let place = self.place_since(start);
        if !self.fits(dimension(&parts).saturating_mul(count), place) {
            return None;
        }
        if line {
            let n = Argument::Number(Rational::from(i64::try_from(count).unwrap_or(i64::MAX)));
            let abelian = family("R").and_then(|family| (family.read)(&[n]).ok());
            return abelian.map(|abelian| vec![abelian.build()]);
        }
        let copies = std::iter::repeat_n(parts, count);
        Some(copies.flatten().collect())
    }

    fn atom(&mut self) -> Option<Atom> {
        let token = self.cursor.advance()?;
        let word = match &token.kind {
            TokenKind::Open(Delimiter::Parenthesis | Delimiter::Invisible) => {
                let inside = self.inside(token)?;
                if inside.is_empty() {
                    let message = "the parentheses are empty".to_owned();
                    return self.fail(Kind::Syntax, token.origin, message, EXAMPLES);
                }
                return Some((self.deeper(inside, token.origin)?, false));
            }
            TokenKind::Identifier(word) => word,
            _ => {
                let diagnostic = unexpected(token);
                self.report.push(diagnostic);
                return None;
            }
        };
        let next = self.cursor.peek();
        let open = next.filter(|t| t.kind == TokenKind::Open(Delimiter::Parenthesis));
        let arguments = match open {
            Some(open) => {
                self.cursor.advance();
                split_commas(self.inside(open)?)
            }
            None => Vec::new(),
        };
        let place = self
            .cursor
            .previous()
            .map_or(token.origin, |t| token.origin.join(t.origin));
        match word.as_str() {
            "semidirect" => return Some((vec![self.semidirect(&arguments, place)?], false)),
            "tangent" => return Some((vec![self.tangent(&arguments, place)?], false)),
            _ => {}
        }
        let Some(family) = family(word) else {
            let diagnostic = unknown(word, token.origin);
            self.report.push(diagnostic);
            return None;
        };
        let named = self.family(word, family, &arguments, place)?;
        Some((vec![named], word == "R" && open.is_none()))
    }

    /// What stands up to the partner of a delimiter, which is taken too.
    fn inside(&mut self, open: &Token) -> Option<&'a [Token]> {
        let inside = self.cursor.take_until(|_| false);
        if self.cursor.advance().is_none() {
            let message = "the parenthesis is not closed".to_owned();
            return self.fail(
                Kind::Syntax,
                open.origin,
                message,
                "add its closing partner",
            );
        }
        Some(inside)
    }

    /// The parts of the sum in parentheses.
    fn deeper(&mut self, tokens: &[Token], place: Origin) -> Option<Vec<NamedAlgebra>> {
        if self.depth >= DEEPEST {
            let message = format!("parentheses are nested deeper than {DEEPEST}");
            return self.fail(
                Kind::Limit,
                place,
                message,
                "remove parentheses that change nothing",
            );
        }
        parts(tokens, self.depth + 1, self.report)
    }

    /// `so(3)`
    fn family(
        &mut self,
        word: &str,
        family: &Family,
        parts: &[&[Token]],
        place: Origin,
    ) -> Option<NamedAlgebra> {
        let (least, most) = family.arguments;
        if parts.len() < least || parts.len() > most {
            let count = if least == most {
                least.to_string()
            } else {
                format!("{least} or {most}")
            };
            let plural = if most == 1 { "" } else { "s" };
            let found = parts.len();
            let message = format!("`{word}` takes {count} argument{plural}, not {found}");
            return self.fail(
                Kind::Arity,
                place,
                message,
                &format!("write `{}`", family.form),
            );
        }
        let arguments = parts.iter().map(|part| self.argument(part, place));
        let arguments: Vec<Argument> = arguments.collect::<Option<_>>()?;
        let constructor = match (family.read)(&arguments) {
            Ok(constructor) => constructor,
            Err(Wrong {
                argument,
                message,
                help,
            }) => {
                let place = parts
                    .get(argument)
                    .and_then(|part| span(part))
                    .unwrap_or(place);
                return self.fail(Kind::Number, place, message, &help);
            }
        };
        let fits = self.fits(constructor.dimension(), place);
        fits.then(|| constructor.build())
    }

    fn argument(&mut self, tokens: &[Token], place: Origin) -> Option<Argument> {
        match tokens {
            [] => {
                let message = "an argument is missing".to_owned();
                self.fail(
                    Kind::Syntax,
                    place,
                    message,
                    "write the size, as in `so(3)`",
                )
            }
            [token] if token.identifier().is_some() => {
                Some(Argument::Word(token.identifier()?.to_owned()))
            }
            _ => {
                let value = item::constant(tokens, self.report)?;
                let value = rational(&value, &Budget::new(WORK));
                let value = self.report.accept(value)?;
                Some(Argument::Number(value))
            }
        }
    }
}

/// Whether a dimension is within the limit.
fn fits(dimension: usize, place: Origin, report: &mut Report) -> bool {
    if dimension > MAX_DIMENSION {
        let message = match dimension {
            usize::MAX => format!("the dimension is above the limit of {MAX_DIMENSION}"),
            _ => format!("the dimension {dimension} is above the limit of {MAX_DIMENSION}"),
        };
        let help = "kernels are straight-line code; declare a smaller system";
        report.push(Diagnostic::new(Kind::Limit, place, message).help(help));
    }
    dimension <= MAX_DIMENSION
}

fn dimension(parts: &[NamedAlgebra]) -> usize {
    parts.iter().map(NamedAlgebra::dimension).sum()
}
