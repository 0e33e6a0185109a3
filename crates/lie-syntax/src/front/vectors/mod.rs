//! Vectors and matrices: names for groups of scalars. What is written with them is expanded right behind the parser, so
//! that every later stage sees scalars.

mod expand;
mod scalars;
mod shapes;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use super::names::{self, Function, Names, functions};
use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

pub use expand::{expand, expand_value};

/// How many nodes all expansions of a declaration may have.
const MOST_NODES: usize = 200_000;

/// The functions of vectors.
pub(super) const FUNCTIONS: &[Function] = functions! {
    "dot", 2, "dot(v, w)", "the sum of v_i w_i";
    "cross", 2, "cross(v, w)", "the vector product, of two vectors with three entries";
    "norm", 1, "norm(v)", "the root of the sum of v_i^2";
    "norm2", 1, "norm2(v)", "the sum of v_i^2";
    "quad", 2, "quad(A, v)", "the sum of A_ij v_i v_j";
};

/// Number of arguments of a function of vectors.
pub fn arity(function: &str) -> Option<usize> {
    let found = FUNCTIONS.iter().find(|known| known.name == function);
    found.map(|known| known.arity)
}

/// A scalar, a vector or a matrix of scalars.
#[derive(Clone, Debug)]
pub enum Value {
    /// One expression.
    Scalar(Expr),
    /// Its entries.
    Vector(Vec<Expr>),
    /// Its rows, all of the same length.
    Matrix(Vec<Vec<Expr>>),
}

impl Value {
    /// The same with another expression for each entry; `None` where there is one without.
    pub fn map(self, mut of: impl FnMut(Expr) -> Option<Expr>) -> Option<Self> {
        Some(match self {
            Self::Scalar(scalar) => Self::Scalar(of(scalar)?),
            Self::Vector(entries) => {
                Self::Vector(entries.into_iter().map(of).collect::<Option<_>>()?)
            }
            Self::Matrix(rows) => {
                let rows = rows.into_iter();
                let mut row = |row: Vec<Expr>| row.into_iter().map(&mut of).collect::<Option<_>>();
                Self::Matrix(rows.map(&mut row).collect::<Option<_>>()?)
            }
        })
    }
}

/// One declared vector or matrix.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Its name.
    pub name: Name,
    /// What it stands for.
    pub value: Value,
}

/// The vectors and matrices of a declaration.
#[derive(Debug, Default)]
pub struct Vectors {
    named: BTreeMap<String, Value>,
    spent: Cell<usize>,
    /// The coordinates of a site, in the declaration of a family: these take the index of a vector.
    sites: BTreeSet<String>,
    /// Whether one of them has a mistake, which is reported: no shape is known then.
    broken: bool,
}

impl Vectors {
    /// The value of a name.
    fn get(&self, name: &str) -> Option<&Value> {
        self.named.get(name)
    }

    /// The coordinates whose names are the entries of a vector; `None` of what is no vector, or has other entries.
    pub fn coordinates(&self, name: &str) -> Option<Vec<&str>> {
        let Value::Vector(entries) = self.get(name)? else {
            return None;
        };
        let entries = entries.iter().map(|entry| match &entry.kind {
            ExprKind::Name { name, index: None } => Some(name.as_str()),
            _ => None,
        });
        entries.collect()
    }

    /// The names.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.named.keys()
    }

    /// The same where one of the declared has a mistake.
    pub fn with_mistake(self, broken: bool) -> Self {
        Self { broken, ..self }
    }

    /// The same for a family whose sites have these coordinates.
    pub fn with_sites(self, coordinates: impl IntoIterator<Item = String>) -> Self {
        let sites = coordinates.into_iter().collect();
        Self { sites, ..self }
    }

    /// Counts nodes that an expansion copies; whether they are not too many.
    fn spend(&self, nodes: usize) -> bool {
        self.spent.set(self.spent.get().saturating_add(nodes));
        self.spent.get() <= MOST_NODES
    }
}

/// Takes what was declared; `names` are those that the functions may use. Names that are taken, ragged matrices and, if
/// `closed`, entries with unknown names are reported.
pub fn collect(
    declared: Vec<Declared>,
    names: &Names,
    closed: bool,
    report: &mut Report,
) -> Vectors {
    let mut vectors = Vectors::default();
    for Declared { name, value } in declared {
        if let Some(mistake) = taken(&name, &vectors, names) {
            report.push(mistake);
            continue;
        }
        if let Some(mistake) = malformed(&name, &value) {
            report.push(mistake);
        } else if closed {
            entries(&value).for_each(|entry| unknown(entry, &name, names, report));
        }
        vectors.named.insert(name.text, value);
    }
    vectors
}

fn entries(value: &Value) -> Box<dyn Iterator<Item = &Expr> + '_> {
    match value {
        Value::Scalar(entry) => Box::new(std::iter::once(entry)),
        Value::Vector(entries) => Box::new(entries.iter()),
        Value::Matrix(rows) => Box::new(rows.iter().flatten()),
    }
}

/// A name that something else has.
fn taken(name: &Name, vectors: &Vectors, names: &Names) -> Option<Diagnostic> {
    let text = name.text.as_str();
    let help = "choose another name for the vector";
    if names::arity(text).is_some() || arity(text).is_some() || ["pi", "t", "sum"].contains(&text) {
        let message = format!("`{text}` is a name of the language, not of a vector");
        return Some(Diagnostic::new(Kind::ReservedName, name.origin, message).help(help));
    }
    let twice = vectors.get(text).is_some();
    if !twice && !names.declares(text) && !names.declares_elsewhere(text) {
        return None;
    }
    let message = if twice {
        format!("the vector `{text}` is declared twice")
    } else {
        format!("the vector `{text}` has the name of something else in the declaration")
    };
    Some(Diagnostic::new(Kind::DuplicateName, name.origin, message).help(help))
}

/// No entries, or rows of different lengths.
fn malformed(name: &Name, value: &Value) -> Option<Diagnostic> {
    let text = &name.text;
    let (message, help) = match value {
        Value::Scalar(_) => return None,
        Value::Vector(entries) if !entries.is_empty() => return None,
        Value::Vector(_) => (
            format!("the vector `{text}` has no entries"),
            "write its entries, such as m1, m2, m3",
        ),
        Value::Matrix(rows) => {
            let first = rows.first().map_or(0, Vec::len);
            let other = rows.iter().map(Vec::len).find(|length| *length != first);
            match other {
                Some(other) => (
                    format!("the matrix `{text}` has rows of {first} and of {other} entries"),
                    "give all rows the same length",
                ),
                None if first == 0 => (
                    format!("the matrix `{text}` has no entries"),
                    "write its rows, such as [a, b], [b, c]",
                ),
                None => return None,
            }
        }
    };
    Some(Diagnostic::new(Kind::Syntax, name.origin, message).help(help))
}

/// Reports the names of an entry that nothing declares.
fn unknown(entry: &Expr, vector: &Name, names: &Names, report: &mut Report) {
    let mut pending = vec![entry];
    while let Some(part) = pending.pop() {
        match &part.kind {
            ExprKind::Name { name, .. } if !names.knows(name) => {
                let message = format!("`{name}`, an entry of `{}`, is not declared", vector.text);
                report.push(
                    Diagnostic::new(Kind::UnknownSymbol, part.origin, message)
                        .help("entries are coordinates, parameters, abbreviations and numbers"),
                );
            }
            _ => pending.extend(part.operands()),
        }
    }
}

/// The answer to an expansion without end.
fn too_large(origin: Origin) -> Diagnostic {
    let message =
        format!("the vectors of the declaration expand to more than {MOST_NODES} operations");
    Diagnostic::new(Kind::Limit, origin, message)
        .help("give scalar parts names with `let`, and nest the products less")
}
