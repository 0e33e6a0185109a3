//! Splitting the macro's tokens into statements, with recovery at `;`.

use super::entry::{Entry, docs, inside, split};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::Line;
use crate::front::habits;
use crate::front::token::{Cursor, Delimiter, Token, TokenKind, render};
use crate::suggest::meant;

/// The words that begin a statement, and what follows each: enough to notice a missing `;`.
const KEYWORDS: &[(&str, Follows)] = &[
    ("system", Follows::Name),
    ("algebra", Follows::Block),
    ("poisson", Follows::Block),
    ("cocycle", Follows::Block),
    ("group", Follows::Name),
    ("state", Follows::Name),
    ("parameters", Follows::Block),
    ("vectors", Follows::Block),
    ("functions", Follows::Block),
    ("let", Follows::Name),
    ("hamiltonian", Follows::Equals),
    ("lagrangian", Follows::Equals),
    ("discrete_lagrangian", Follows::Equals),
    ("velocity", Follows::Name),
    ("forces", Follows::Block),
    ("dissipation", Follows::Block),
    ("noise", Follows::Block),
    ("inputs", Follows::Block),
    ("constraint", Follows::Block),
    ("realization", Follows::Block),
    ("retraction", Follows::Block),
    ("casimir", Follows::Name),
    ("integrals", Follows::Block),
    ("observables", Follows::Block),
    ("events", Follows::Block),
    ("bonds", Follows::Equals),
    ("methods", Follows::Equals),
    ("invariance", Follows::Equals),
    ("initial", Follows::Equals),
    ("attitude", Follows::Block),
    ("crate", Follows::Equals),
    ("spec", Follows::Equals),
];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Follows {
    Name,
    Equals,
    Block,
}

/// One statement: `docs visibility keyword rest;` or `keyword { … }`.
#[derive(Debug)]
pub struct Statement<'a> {
    /// Doc comment before it, line by line.
    pub docs: Vec<String>,
    /// `pub`, `pub(crate)` or nothing.
    pub visibility: &'a [Token],
    /// The word that begins it.
    pub keyword: &'a str,
    /// Place of the keyword.
    pub origin: Origin,
    /// What stands between keyword and `;`, or the block with its braces.
    pub rest: &'a [Token],
}

impl<'a> Statement<'a> {
    /// What stands behind `=`.
    pub fn value(&self, report: &mut Report) -> Option<&'a [Token]> {
        if let [first, value @ ..] = self.rest
            && first.is('=')
        {
            return Some(value);
        }
        let keyword = self.keyword;
        report.push(
            Diagnostic::new(
                Kind::Syntax,
                self.origin,
                format!("`{keyword}` needs a value"),
            )
            .help(format!("write `{keyword} = …;`")),
        );
        None
    }

    /// The entries of the block.
    pub fn block(&self, report: &mut Report) -> Option<Vec<Entry<'a>>> {
        let Some(inside) = inside(self.rest, Delimiter::Brace) else {
            let keyword = self.keyword;
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    self.origin,
                    format!("`{keyword}` needs a block"),
                )
                .help(format!("write `{keyword} {{ … }}`")),
            );
            return None;
        };
        Some(split(inside, report))
    }

    /// What it gives: behind `=` where one belongs there.
    pub fn line(&self, report: &mut Report) -> Option<Line<'a>> {
        let keyword = self.keyword;
        let tokens = if KEYWORDS.contains(&(keyword, Follows::Equals)) {
            self.value(report)?
        } else {
            self.rest
        };
        Some(Line {
            tokens: tokens.into(),
            place: self.origin,
        })
    }
}

/// Splits into statements. What is none is reported and skipped up to the next `;` or block.
pub fn statements<'a>(tokens: &'a [Token], report: &mut Report) -> Vec<Statement<'a>> {
    let mut cursor = Cursor::new(tokens);
    let mut statements = Vec::new();
    while cursor.peek().is_some() {
        let docs = docs(&mut cursor, report);
        let visibility = visibility(&mut cursor);
        let Some(token) = cursor.advance() else {
            let place = cursor.previous().map(|t| t.origin);
            report.push(Diagnostic {
                kind: Kind::Syntax,
                message: "a statement is missing".into(),
                origin: place,
                help: Some("write `pub system NAME;`".into()),
                warning: false,
            });
            break;
        };
        match token.identifier() {
            Some(keyword) if KEYWORDS.iter().any(|(word, _)| *word == keyword) => {
                let rest = rest(&mut cursor, keyword, report);
                statements.push(Statement {
                    docs,
                    visibility,
                    keyword,
                    origin: token.origin,
                    rest,
                });
            }
            word => {
                report.push(unknown(token, cursor.peek()));
                // A misspelt keyword stands for the one that was meant, so that nothing else
                // seems missing and its own mistakes are found too.
                let keyword = word
                    .and_then(|word| meant(word, KEYWORDS.iter().map(|(keyword, _)| *keyword)))
                    .filter(|keyword| fits(&cursor, keyword));
                if let Some(keyword) = keyword {
                    let rest = rest(&mut cursor, keyword, report);
                    statements.push(Statement {
                        docs,
                        visibility,
                        keyword,
                        origin: token.origin,
                        rest,
                    });
                } else {
                    skip(&mut cursor);
                }
            }
        }
    }
    statements
}

/// The rest of a statement, without its `;`.
fn rest<'a>(cursor: &mut Cursor<'a>, keyword: &str, report: &mut Report) -> &'a [Token] {
    let start = cursor.position();
    if cursor
        .eat_kind(&TokenKind::Open(Delimiter::Brace))
        .is_some()
    {
        cursor.take_until(|_| false);
        cursor.advance();
        let block = cursor.tokens_since(start);
        cursor.eat(';');
        return block;
    }
    let tokens = cursor
        .take_until(|c| c.peek().is_some_and(|t| t.is(';')) || (c.position() > start && begins(c)));
    if cursor.eat(';').is_none() {
        let next = cursor
            .peek()
            .map(|t| format!(" before `{}`", render(std::slice::from_ref(t))));
        if let Some(last) = cursor.previous() {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    last.origin,
                    format!(
                        "the statement `{keyword}` has no `;`{}",
                        next.unwrap_or_default()
                    ),
                )
                .help("add it"),
            );
        }
    }
    tokens
}

/// Whether a statement begins here, seen from inside another one: no expression contains two
/// words in a row or a keyword before `=`.
fn begins(cursor: &Cursor<'_>) -> bool {
    let Some(word) = cursor.peek().and_then(Token::identifier) else {
        return false;
    };
    let Some(next) = cursor.ahead(1) else {
        return false;
    };
    if word == "pub" {
        return next.is_word("system") || next.is_word("spec");
    }
    let mut behind = cursor.clone();
    behind.advance();
    fits(&behind, word)
}

/// Whether what stands here may follow the keyword.
fn fits(cursor: &Cursor<'_>, keyword: &str) -> bool {
    let Some(next) = cursor.peek() else {
        return false;
    };
    KEYWORDS.iter().any(|(word, follows)| {
        *word == keyword
            && match follows {
                Follows::Name => next.identifier().is_some(),
                Follows::Equals => next.is('='),
                Follows::Block => next.is('=') || next.kind == TokenKind::Open(Delimiter::Brace),
            }
    })
}

/// A token that begins no statement.
fn unknown(token: &Token, next: Option<&Token>) -> Diagnostic {
    let text = render(std::slice::from_ref(token));
    let words = || KEYWORDS.iter().map(|(word, _)| *word);
    let foreign = habits::key(&text).map(str::to_owned);
    let help = foreign.unwrap_or_else(|| match meant(&text, words()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if token.kind == TokenKind::Open(Delimiter::Bracket) || text == "basis" => {
            "brackets and `basis` stand inside `algebra { … }`".into()
        }
        None if next.is_some_and(|t| t.is('=')) => {
            format!("an abbreviation begins with `let`, as in `let {text} = …;`")
        }
        None => format!(
            "statements begin with {}",
            words().collect::<Vec<_>>().join(", ")
        ),
    });
    Diagnostic::new(
        Kind::Syntax,
        token.origin,
        format!("unknown statement `{text}`"),
    )
    .help(help)
}

/// Goes on behind the next `;`, or behind a block that comes first.
fn skip(cursor: &mut Cursor<'_>) {
    let block = |t: &Token| t.kind == TokenKind::Open(Delimiter::Brace);
    if let Some(before) = cursor.previous()
        && matches!(before.kind, TokenKind::Open(_))
    {
        cursor.take_until(|_| false);
        cursor.advance();
        if block(before) {
            return;
        }
    }
    loop {
        match cursor.peek() {
            None => return,
            Some(token) if token.is(';') => {
                cursor.advance();
                return;
            }
            Some(token) if matches!(token.kind, TokenKind::Open(_)) => {
                cursor.advance();
                cursor.take_until(|_| false);
                cursor.advance();
                if block(token) {
                    cursor.eat(';');
                    return;
                }
            }
            Some(_) if begins(cursor) => return,
            Some(_) => drop(cursor.advance()),
        }
    }
}

fn visibility<'a>(cursor: &mut Cursor<'a>) -> &'a [Token] {
    let start = cursor.position();
    if cursor.peek().is_some_and(|t| t.is_word("pub")) {
        cursor.advance();
        if cursor
            .eat_kind(&TokenKind::Open(Delimiter::Parenthesis))
            .is_some()
        {
            cursor.take_until(|_| false);
            cursor.advance();
        }
    }
    cursor.tokens_since(start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::front::declaration::keyword;
    use crate::front::schema::Spec;

    #[test]
    fn statements_are_keys_of_the_spec() {
        let words = || KEYWORDS.iter().map(|(word, _)| *word);
        let keys = || Spec::KEYS.iter().map(|key| keyword(key));
        let no_keys: Vec<&str> = words().filter(|w| keys().all(|key| key != *w)).collect();
        assert_eq!(no_keys, ["crate", "spec"]);
        let no_statements: Vec<&str> = keys().filter(|k| words().all(|word| word != *k)).collect();
        assert_eq!(
            no_statements,
            ["$schema", "format", "description", "references", "run"]
        );
    }
}
