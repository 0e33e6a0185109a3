//! Splitting the macro's tokens into statements, with recovery at `;`.

use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::mistakes;
use crate::front::object::NOT_BUILT;
use crate::front::token::{Cursor, Delimiter, Token, TokenKind, render, render_whole, span};
use crate::suggest::did_you_mean;

/// The words that begin a statement, and what follows each: enough to notice a missing `;`.
const KEYWORDS: &[(&str, Follows)] = &[
    ("system", Follows::Name),
    ("algebra", Follows::Block),
    ("state", Follows::Name),
    ("parameters", Follows::Block),
    ("let", Follows::Name),
    ("hamiltonian", Follows::Equals),
    ("casimir", Follows::Name),
    ("methods", Follows::Equals),
    ("invariance", Follows::Equals),
    ("initial", Follows::Equals),
    ("spec", Follows::Equals),
];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Follows {
    Name,
    Equals,
    Block,
}

/// A line of a doc comment.
#[derive(Clone, Debug)]
pub struct Doc {
    text: String,
    origin: Origin,
}

/// One statement: `docs visibility keyword rest;` or `keyword { … }`.
#[derive(Debug)]
pub struct Statement<'a> {
    /// Doc comment before it.
    pub docs: Vec<Doc>,
    /// `pub`, `pub(crate)` or nothing.
    pub visibility: &'a [Token],
    /// The word that begins it.
    pub keyword: &'a str,
    /// Place of the keyword.
    pub origin: Origin,
    /// What stands between keyword and `;`, or the block with its braces.
    pub rest: &'a [Token],
}

/// One `…;` in a block.
#[derive(Debug)]
pub struct Entry<'a> {
    docs: Vec<Doc>,
    /// Its tokens, at least one.
    pub tokens: &'a [Token],
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
        let Some(inside) = entries::inside(self.rest, Delimiter::Brace) else {
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
        Some(entries::split(inside, report))
    }

    /// The doc comment, line by line.
    pub fn description(&self) -> Vec<String> {
        self.docs.iter().map(|doc| doc.text.clone()).collect()
    }
}

impl Entry<'_> {
    /// Whether the entry begins with this word.
    pub fn is_word(&self, word: &str) -> bool {
        self.tokens.first().is_some_and(|t| t.is_word(word))
    }

    /// Place of its first token.
    pub fn origin(&self) -> Origin {
        self.tokens
            .first()
            .map_or(Origin::Span(proc_macro2::Span::call_site()), |t| t.origin)
    }

    /// The doc comment as one text.
    pub fn description(&self) -> Option<String> {
        let lines: Vec<&str> = self.docs.iter().map(|doc| doc.text.as_str()).collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
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
            let place = docs.first().map(|d| d.origin).or(span(visibility));
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
            Some(keyword) if NOT_BUILT.iter().any(|(word, _)| *word == keyword) => {
                report.push(
                    Diagnostic::new(
                        Kind::Syntax,
                        token.origin,
                        format!("`{keyword}` is reserved: what it declares is not built yet"),
                    )
                    .help("remove it; systems are declared by `algebra` and `hamiltonian`"),
                );
                let rest = rest(&mut cursor, keyword, report);
                statements.push(Statement {
                    docs: Vec::new(),
                    visibility: &[],
                    keyword,
                    origin: token.origin,
                    rest,
                });
            }
            word => {
                report.push(unknown(token, cursor.peek()));
                // A misspelt keyword stands for the one that was meant, so that nothing else
                // seems missing and its own mistakes are found too.
                let meant = word
                    .and_then(|word| {
                        did_you_mean(word, KEYWORDS.iter().map(|(keyword, _)| *keyword))
                    })
                    .filter(|keyword| fits(&cursor, keyword));
                if let Some(keyword) = meant {
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
        let block = cursor.since(start);
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
    let help = match did_you_mean(&text, words()) {
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
    };
    Diagnostic::new(
        Kind::Syntax,
        token.origin,
        format!("`{text}` begins no statement"),
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
    cursor.since(start)
}

/// `#[doc = "…"]`, which is what `/// …` becomes.
fn docs(cursor: &mut Cursor<'_>, report: &mut Report) -> Vec<Doc> {
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
        match entries::inside(cursor.since(start), Delimiter::Bracket) {
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
                let lines = text
                    .lines()
                    .map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned());
                docs.extend(lines.map(|text| Doc {
                    text,
                    origin: hash.origin,
                }));
            }
            _ => report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    hash.origin,
                    "the declaration takes no attributes but doc comments",
                )
                .help("remove the attribute"),
            ),
        }
    }
    docs
}

/// Blocks and their entries.
pub mod entries {
    use super::*;

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
                        Some(stray) => mistakes::unexpected(stray, tokens.last()),
                        None => Diagnostic::new(Kind::Syntax, last.origin, "`;` is missing")
                            .help("add it"),
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
}
