//! The statements of a declaration, by their keywords.

use super::super::token::{span, split_commas};
use super::statement::Statement;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// The statements of which a declaration may have many.
pub(super) const REPEATABLE: [&str; 2] = ["let", "casimir"];

/// The statements of a macro.
pub(super) struct Parts<'a> {
    pub(super) statements: Vec<Statement<'a>>,
    /// The first token, the place of what is missing.
    pub(super) start: Origin,
}

impl<'a> Parts<'a> {
    pub(super) fn all(&self, keyword: &str) -> impl Iterator<Item = &Statement<'a>> {
        self.statements.iter().filter(move |s| s.keyword == keyword)
    }

    pub(super) fn first(&self, keyword: &str) -> Option<&Statement<'a>> {
        self.all(keyword).next()
    }

    /// Reports statements that stand twice and visibilities where none belongs.
    pub(super) fn check_heads(&self, report: &mut Report) {
        let mut seen: Vec<&str> = Vec::new();
        for statement in &self.statements {
            let keyword = statement.keyword;
            if !REPEATABLE.contains(&keyword) && seen.contains(&keyword) {
                report.push(
                    Diagnostic::new(
                        Kind::Syntax,
                        statement.origin,
                        format!("`{keyword}` stands twice"),
                    )
                    .help("remove one of the two"),
                );
            }
            seen.push(keyword);
            if !matches!(keyword, "system" | "spec")
                && let Some(place) = span(statement.visibility)
            {
                report.push(
                    Diagnostic::new(
                        Kind::Syntax,
                        place,
                        format!("`{keyword}` has no visibility"),
                    )
                    .help("`pub` stands before `system` only"),
                );
            }
        }
    }

    /// Number of basis elements, however broken the algebra is.
    pub(super) fn size_of_basis(&self) -> usize {
        let tokens = self.first("algebra").map_or(&[][..], |s| s.rest);
        let Some(basis) = tokens.iter().position(|t| t.is_word("basis")) else {
            return 0;
        };
        let names = &tokens[basis + 1..];
        let end = names.iter().position(|t| t.is(';')).unwrap_or(names.len());
        split_commas(&names[..end]).len()
    }

    pub(super) fn missing(&self, keyword: &str, example: &str, place: Origin, report: &mut Report) {
        if self.first(keyword).is_none() {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    place,
                    format!("the declaration has no `{keyword}`"),
                )
                .help(format!("add `{example}`")),
            );
        }
    }
}
