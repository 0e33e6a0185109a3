//! What a parser must know about names: which are declared, which are functions.

use std::collections::BTreeSet;
use std::rc::Rc;

use super::tables::Tables;
use super::vectors::Vectors;
use unicode_normalization::{IsNormalized, UnicodeNormalization as _, is_nfc_quick};

/// A function of the grammar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// Its number of arguments, in the syntax tree.
    pub arity: usize,
    /// A call of it, as it is written.
    pub call: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

/// A table of functions, one a line.
macro_rules! functions {
    ($($name:expr, $arity:literal, $call:expr, $meaning:literal;)+) => {
        &[$($crate::front::names::Function { name: $name, arity: $arity, call: $call, meaning: $meaning }),+]
    };
}
pub(super) use functions;

macro_rules! all {
    ($($variant:ident $name:ident $single:ident $from:ident $what:literal $facts:tt)+) => {
        functions! {
            "sqrt", 1, "sqrt(x)", "the root that is not negative";
            $(stringify!($name), 1, concat!(stringify!($name), "(x)"), $what;)+
            "hypot", 2, "hypot(x, y)", "sqrt(x^2 + y^2)";
            "atan2", 2, "atan2(y, x)", "the angle of the point (x, y), from -pi to pi";
            "abs", 1, "abs(x)", "x or -x, whichever is not negative";
            "min", 2, "min(x, y)", "the smaller of two";
            "max", 2, "max(x, y)", "the larger of two";
            // of the tree: `x < y: a, b`
            PIECEWISE, 4, "piecewise(x < y: a, b)", "the value of the first case whose condition holds, else the last value; any number of cases";
        }
    };
}

/// The functions of the grammar.
pub const FUNCTIONS: &[Function] = lie_core::elementary_functions!(all);

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
pub(super) const BUILT_IN: &[&str] = &["pi", "t"];

/// Number of arguments of a function of the grammar.
pub fn arity(function: &str) -> Option<usize> {
    FUNCTIONS
        .iter()
        .find(|known| known.name == function)
        .map(|known| known.arity)
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
    pub fn with_indices(mut self, indexed: bool) -> Self {
        self.indexed = indexed;
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
