//! Functions that a declaration gives by a table: `drag(v)` stands for the spline through the points, of which every
//! coefficient is a choice by `v`. It is written out as soon as it is read, so that every stage sees a formula.

mod spline;
mod writer;

use super::names::Names;
use super::vectors;
use crate::ast::names::is_reserved;
use crate::ast::{Expr, ExprKind, Name, OwnFunction};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use lie_symbolic::exact::Rational;
use spline::Piece;
use writer::Writer;

/// The largest number of points.
const MOST_POINTS: usize = 200;
/// The largest degree.
const MOST_DEGREE: usize = 7;
/// What tables may write out, in nodes of the tree.
const MOST_NODES: usize = 200_000;

/// What a table is outside of its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// Not a number, so that a step that leaves the table fails.
    #[default]
    Refuse,
    /// The value at the end.
    Constant,
    /// The tangent at the end.
    Linear,
}

impl Outside {
    /// The words for them.
    pub const WORDS: [(&str, Outside); 3] = [
        ("refuse", Outside::Refuse),
        ("constant", Outside::Constant),
        ("linear", Outside::Linear),
    ];

    /// By its word, which is reported where it is none.
    pub fn read(word: &str, origin: Origin, report: &mut Report) -> Option<Self> {
        let found = Self::WORDS.iter().find(|(known, _)| *known == word);
        if found.is_none() {
            let message = format!("`{}` does not say what is outside", word.escape_debug());
            let help = "write `refuse`, `constant` or `linear`";
            report.push(Diagnostic::new(Kind::Number, origin, message).help(help));
        }
        found.map(|(_, outside)| *outside)
    }
}

/// A table by its name, `None` where a mistake in it was reported.
pub type Read = (Name, Option<Written>);

/// A point of a table, and its place.
pub type Point = (Expr, Expr, Origin);

/// A table as it was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// The points, each with its place.
    pub points: Vec<Point>,
    /// The degree of the spline, and its place.
    pub degree: (Expr, Origin),
    /// What it is outside.
    pub outside: Outside,
}

/// A function by a table.
#[derive(Clone, Debug)]
struct Table {
    name: String,
    pieces: Vec<Piece>,
    /// The first and the last place.
    ends: [Rational; 2],
    outside: Outside,
}

/// All of a declaration.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    tables: Vec<Table>,
    /// Names of tables with mistakes.
    broken: Vec<String>,
    /// Functions of Rust with their numbers of arguments.
    own: Vec<(String, usize)>,
}

impl Tables {
    /// Makes splines of tables; mistakes are reported.
    pub fn new(read: Vec<Read>, names: &Names, report: &mut Report) -> Self {
        let mut tables = Self::default();
        for (name, written) in read {
            let free = tables.takes(&name, names, report);
            let table = written.and_then(|written| written.function(&name, report));
            match table.filter(|_| free) {
                Some(table) => tables.tables.push(table),
                None => tables.broken.push(name.text),
            }
        }
        tables
    }

    /// Adds functions of Rust; mistakes are reported.
    #[must_use]
    pub fn with_own(mut self, own: &[OwnFunction], names: &Names, report: &mut Report) -> Self {
        for OwnFunction { name, function, .. } in own {
            if self.takes(name, names, report) {
                self.own
                    .push((name.text.clone(), function.declared().arity));
            }
        }
        self
    }

    /// The number of arguments of a declared function.
    pub fn arity(&self, function: &str) -> Option<usize> {
        let mut own = self.own.iter();
        let own = own.find(|(name, _)| name == function);
        own.map(|(_, arity)| *arity)
            .or(self.knows(function).then_some(1))
    }

    /// Reports a name that is another's.
    fn takes(&self, name: &Name, names: &Names, report: &mut Report) -> bool {
        let text = &name.text;
        let (kind, message) = if is_reserved(text) || vectors::arity(text).is_some() {
            (
                Kind::ReservedName,
                format!("`{text}` is a word of the language"),
            )
        } else if names.declares(text) || self.arity(text).is_some() {
            (Kind::DuplicateName, format!("`{text}` is declared twice"))
        } else {
            return true;
        };
        report.push(Diagnostic::new(kind, name.origin, message).help("choose another name"));
        false
    }

    /// Whether a function is a table.
    pub fn knows(&self, function: &str) -> bool {
        self.of(function).is_some() || self.broken.iter().any(|name| name == function)
    }

    fn of(&self, function: &str) -> Option<&Table> {
        self.tables.iter().find(|table| table.name == function)
    }

    /// The expression with the tables written out.
    pub fn expand(&self, mut expression: Expr, report: &mut Report) -> Option<Expr> {
        if self.tables.is_empty() && self.broken.is_empty() {
            return Some(expression);
        }
        let mut left = MOST_NODES;
        let origin = expression.origin;
        match self.write_out(&mut expression, &mut left) {
            true => Some(expression),
            // said where the table is
            false if !self.broken.is_empty() => None,
            false => {
                let message = format!("the tables expand to more than {MOST_NODES} operations");
                let help = "give their arguments names with `let`, or use fewer points";
                report.push(Diagnostic::new(Kind::Limit, origin, message).help(help));
                None
            }
        }
    }

    /// Whether nothing stood against it.
    fn write_out(&self, expression: &mut Expr, left: &mut usize) -> bool {
        let mut all = |parts: &mut dyn Iterator<Item = &mut Expr>| {
            let mut sound = parts.map(|part| self.write_out(part, left));
            sound.all(|sound| sound)
        };
        let sound = match &mut expression.kind {
            ExprKind::Number(_) | ExprKind::Name { .. } => return true,
            ExprKind::Negative(a) => all(&mut [&mut **a].into_iter()),
            ExprKind::Power(a, b) => all(&mut [&mut **a, &mut **b].into_iter()),
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                all(&mut operands.iter_mut().map(|(_, operand)| operand))
            }
            ExprKind::Call { arguments, .. } => all(&mut arguments.iter_mut()),
            ExprKind::IndexedSum { body, .. } => all(&mut [&mut **body].into_iter()),
        };
        let ExprKind::Call {
            function,
            arguments,
        } = &expression.kind
        else {
            return sound;
        };
        if !self.knows(&function.text) {
            return sound;
        }
        let (Some(table), [argument]) = (self.of(&function.text), arguments.as_slice()) else {
            return false;
        };
        let nodes = (argument.parts().count() + 6) * table.size();
        if nodes > *left {
            return false;
        }
        *left -= nodes;
        *expression = Writer {
            argument: argument.clone(),
            origin: expression.origin,
        }
        .table(table);
        sound
    }
}

impl Written {
    /// The function, if nothing is wrong with the table.
    fn function(&self, name: &Name, report: &mut Report) -> Option<Table> {
        let mut refuse = |kind, origin, message: String, help: &str| {
            report.push(Diagnostic::new(kind, origin, message).help(help));
        };
        let degree = rational(&self.degree.0).and_then(|degree| degree.to_integer());
        let degree = degree.and_then(|d| usize::try_from(d).ok());
        let Some(degree) = degree.filter(|d| d % 2 == 1 && *d <= MOST_DEGREE) else {
            let message = "the degree of a spline is an odd number up to 7".to_owned();
            refuse(Kind::Number, self.degree.1, message, "write 1, 3, 5 or 7");
            return None;
        };
        let count = self.points.len();
        if count <= degree {
            let message = format!(
                "`{}` has {count} points, too few for degree {degree}",
                name.text
            );
            let help = format!("give at least {} points, or a lower degree", degree + 1);
            refuse(Kind::Number, name.origin, message, &help);
            return None;
        }
        if count > MOST_POINTS {
            let message = format!("`{}` has more than {MOST_POINTS} points", name.text);
            refuse(Kind::Limit, name.origin, message, "leave some of them out");
            return None;
        }
        let mut points: Vec<(Rational, Rational)> = Vec::new();
        for (x, y, origin) in &self.points {
            let (Some(x), Some(y)) = (rational(x), rational(y)) else {
                let message = "the numbers of a table are rational".to_owned();
                refuse(
                    Kind::Number,
                    *origin,
                    message,
                    "write decimal numbers, or quotients",
                );
                return None;
            };
            if points.last().is_some_and(|(last, _)| *last >= x) {
                let message = format!("the places of `{}` do not ascend here", name.text);
                refuse(
                    Kind::Number,
                    *origin,
                    message,
                    "sort the points by their first number, each of which stands once",
                );
                return None;
            }
            points.push((x, y));
        }
        let ends = [points[0].0.clone(), points[count - 1].0.clone()];
        Some(Table {
            name: name.text.clone(),
            pieces: spline::spline(&points, degree)?,
            ends,
            outside: self.outside,
        })
    }
}

impl Table {
    /// How often the argument is written, about.
    fn size(&self) -> usize {
        self.pieces.len() * (self.pieces[0].coefficients.len() + 1) + 8
    }
}

/// The value of an expression in rational numbers.
fn rational(expression: &Expr) -> Option<Rational> {
    match &expression.kind {
        ExprKind::Number(value) => Some(value.clone()),
        ExprKind::Negative(a) => Some(-&rational(a)?),
        ExprKind::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (minus, term)| {
            let term = rational(term)?;
            Some(if *minus { &sum - &term } else { &sum + &term })
        }),
        ExprKind::Product(factors) => {
            factors
                .iter()
                .try_fold(Rational::ONE, |product, (divides, factor)| {
                    let factor = rational(factor)?;
                    match divides {
                        true if factor.is_zero() => None,
                        true => Some(&product / &factor),
                        false => Some(&product * &factor),
                    }
                })
        }
        ExprKind::Power(base, exponent) => {
            let exponent = i32::try_from(rational(exponent)?.to_integer()?).ok()?;
            rational(base)?.pow(exponent)
        }
        _ => None,
    }
}
