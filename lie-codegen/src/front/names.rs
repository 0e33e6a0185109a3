//! What a parser must know about names: which are declared, which are functions.

use std::collections::BTreeSet;
use std::rc::Rc;

use super::tables::Tables;
use super::vectors::Vectors;
use unicode_normalization::{IsNormalized, UnicodeNormalization as _, is_nfc_quick};

/// The functions of the grammar with their numbers of arguments.
pub const FUNCTIONS: &[(&str, usize)] = &[
    ("sqrt", 1),
    ("exp", 1),
    ("log", 1),
    ("sin", 1),
    ("cos", 1),
    ("tan", 1),
    ("asin", 1),
    ("acos", 1),
    ("atan", 1),
    ("sinh", 1),
    ("cosh", 1),
    ("tanh", 1),
    ("cbrt", 1),
    ("log1p", 1),
    ("expm1", 1),
    ("asinh", 1),
    ("acosh", 1),
    ("atanh", 1),
    ("hypot", 2),
    ("atan2", 2),
    ("abs", 1),
    ("min", 2),
    ("max", 2),
    // of the tree: `x < y: a, b`
    (PIECEWISE, 4),
];

/// The function whose arguments are cases.
pub const PIECEWISE: &str = "piecewise";

/// A name in normalisation form C, in which rustc compares identifiers: `é` is one name, whether it
/// is written as one character or as two.
pub fn normalised(name: &str) -> String {
    match is_nfc_quick(name.chars()) {
        IsNormalized::Yes => name.to_owned(),
        _ => name.nfc().collect(),
    }
}

/// Names of the language itself that stand for a value.
const BUILT_IN: &[&str] = &["pi", "t"];

/// Number of arguments of a function of the grammar.
pub fn arity(function: &str) -> Option<usize> {
    FUNCTIONS
        .iter()
        .find(|(name, _)| *name == function)
        .map(|(_, arity)| *arity)
}

/// The names that an expression may use; the parser needs them to tell a product without its
/// `*` (`2x`, `2e3`, `x(y)`) from a number or a call.
#[derive(Clone, Debug, Default)]
pub struct Names {
    here: BTreeSet<String>,
    elsewhere: BTreeSet<String>,
    indexed: bool,
    vectors: Rc<Vectors>,
    tables: Rc<Tables>,
}

impl Names {
    /// The same for a family, in whose functions names may have indices.
    #[must_use]
    pub fn of_family(mut self, family: bool) -> Self {
        self.indexed = family;
        self
    }

    /// Whether names may have indices.
    pub fn may_be_indexed(&self) -> bool {
        self.indexed
    }

    /// Adds names that are declared but cannot stand in the expression. A literal such as `2e3`
    /// must not be read as a number where `e3` is one of them.
    #[must_use]
    pub fn with_elsewhere<S: Into<String>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.elsewhere.extend(names.into_iter().map(Into::into));
        self
    }

    /// Adds vectors and matrices.
    #[must_use]
    pub(super) fn with_vectors(mut self, vectors: Vectors) -> Self {
        self.here.extend(vectors.names().cloned());
        self.vectors = Rc::new(vectors);
        self
    }

    /// Adds functions by tables.
    #[must_use]
    pub(super) fn with_tables(mut self, tables: Tables) -> Self {
        self.tables = Rc::new(tables);
        self
    }

    /// The functions by tables.
    pub(super) fn tables(&self) -> &Tables {
        &self.tables
    }

    /// The vectors and matrices that may stand in the expression.
    pub(super) fn vectors(&self) -> &Vectors {
        &self.vectors
    }

    /// Whether the name is declared or built in.
    pub fn knows(&self, name: &str) -> bool {
        self.declares(name) || BUILT_IN.contains(&name)
    }

    /// Whether the user declared the name and it may stand in the expression.
    pub fn declares(&self, name: &str) -> bool {
        self.here.contains(name)
    }

    /// Whether the name is declared, but not for this expression.
    pub fn declares_elsewhere(&self, name: &str) -> bool {
        !self.declares(name) && self.elsewhere.contains(name)
    }

    /// The names that the user declared and that may stand in the expression.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.here.iter().map(String::as_str)
    }
}

impl<S: Into<String>> FromIterator<S> for Names {
    fn from_iter<I: IntoIterator<Item = S>>(names: I) -> Self {
        Self {
            here: names.into_iter().map(Into::into).collect(),
            elsewhere: BTreeSet::new(),
            indexed: false,
            vectors: Rc::default(),
            tables: Rc::default(),
        }
    }
}
