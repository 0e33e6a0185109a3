//! Formulas of declarations for people to read: one walk over the grammar's expressions, in one notation or another.

mod latex;

use lie_codegen::structure::Structure;
use lie_syntax::ast::{BONDS, Expr, ExprKind, Index};
use lie_syntax::diagnostic::Report;
use lie_syntax::front::{Names, PIECEWISE, parse_expression_text};

pub use latex::Latex;

/// How a formula is written down. What it is given is written down already, but names and numbers.
pub trait Notation {
    /// A number without a sign.
    fn number(&self, digits: &str) -> String;
    /// A short name, Greek or not, with what stands below it, which may be empty.
    fn letter(&self, name: &str, index: &str) -> String;
    /// A longer name.
    fn word(&self, name: &str) -> String;
    /// A name with indices of sites.
    fn indexed(&self, name: &str, indices: &str) -> String;
    /// A sign between parts: `+`, `-` or `,`.
    fn sign(&self, sign: char) -> String;
    /// A minus before the first part.
    fn negative(&self, text: &str) -> String;
    /// What belongs together.
    fn group(&self, text: &str) -> String;
    /// The same in parentheses.
    fn parentheses(&self, text: &str) -> String;
    /// A fraction.
    fn fraction(&self, over: &str, under: &str) -> String;
    /// A power.
    fn power(&self, base: &str, exponent: &str) -> String;
    /// Factors side by side.
    fn product(&self, factors: &[String]) -> String;
    /// A sum over sites, `from <= index < to`.
    fn sum(&self, index: &str, range: [&str; 2], body: &str) -> String;
    /// A sum over the bonds of a family.
    fn sum_of_bonds(&self, body: &str) -> String;
    /// The first value where the left side is smaller, else the second.
    fn cases(&self, sides: [&str; 2], values: [&str; 2]) -> String;
    /// A function of its arguments.
    fn call(&self, function: &str, arguments: &[String]) -> String;
    /// The derivative of a name by the time.
    fn rate(&self, name: &str) -> String;
    /// The sides of an equation, or an expression alone.
    fn equation(&self, sides: &[String]) -> String;
    /// Text that is no formula.
    fn verbatim(&self, text: &str) -> String;
}

/// Letters that have names.
pub const GREEK: [(&str, &str); 33] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Pi", "Π"),
    ("Sigma", "Σ"),
    ("Upsilon", "Υ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
];

/// How tightly a form binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Power,
}

/// The names that formulas of a system contain.
pub fn names(model: &Structure) -> Names {
    let coordinates = model.coordinates.iter().map(|name| name.text.clone());
    let parameters = model
        .parameters
        .iter()
        .map(|parameter| parameter.name.clone());
    let basis = model
        .bracket
        .algebra()
        .into_iter()
        .flat_map(|algebra| algebra.basis.iter());
    let basis = basis.map(|name| name.text.clone());
    let all: Names = coordinates.chain(parameters).chain(basis).collect();
    all.with_indices(model.family.is_some())
}

/// A formula `left = right`, or an expression alone; as it is written where it is none of the grammar's.
pub fn formula(text: &str, names: &Names, notation: &dyn Notation) -> String {
    let parts: Vec<&str> = text.splitn(2, '=').map(str::trim).collect();
    let walk = Walk(notation);
    let sides: Option<Vec<String>> = parts.iter().map(|part| walk.side(part, names)).collect();
    match sides {
        Some(sides) => notation.equation(&sides),
        None => notation.verbatim(text),
    }
}

/// A name: what follows a letter or a bar below is an index.
pub fn identifier(name: &str, notation: &dyn Notation) -> String {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    let base = letters.split('_').next().unwrap_or(letters);
    if base.chars().count() > 3 && GREEK.iter().all(|(word, _)| *word != base) {
        return notation.word(name);
    }
    let digits = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let (base, index) = match name.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => (base, index),
        _ if !digits.is_empty() => (digits, &name[digits.len()..]),
        _ => (name, ""),
    };
    notation.letter(base, index)
}

struct Walk<'a>(&'a dyn Notation);

impl Walk<'_> {
    /// One side of an equation; `x'` is the derivative by the time.
    fn side(&self, text: &str, names: &Names) -> Option<String> {
        if let Some(name) = text.strip_suffix('\'') {
            return Some(self.0.rate(&self.identifier(name)));
        }
        if text.chars().all(|c| c.is_alphanumeric() || c == '_')
            && !text.starts_with(|c: char| c.is_ascii_digit())
        {
            return Some(self.identifier(text));
        }
        let mut report = Report::new();
        let parsed = parse_expression_text(text, 0, names, &mut report);
        let sound = report.gate().is_ok();
        parsed
            .filter(|_| sound)
            .map(|parsed| self.of(&parsed, Binding::Sum))
    }

    fn identifier(&self, name: &str) -> String {
        identifier(name, self.0)
    }

    fn of(&self, expression: &Expr, around: Binding) -> String {
        let (text, own) = match &expression.kind {
            ExprKind::Number(value) => {
                let text = value.to_string();
                match text.split_once('/') {
                    Some((over, under)) => {
                        let [over, under] = [over, under].map(|part| self.0.number(part));
                        (self.0.fraction(&over, &under), Binding::Product)
                    }
                    None => (self.0.number(&text), Binding::Power),
                }
            }
            ExprKind::Name { name, index: None } => (self.identifier(name), Binding::Power),
            ExprKind::Name {
                name,
                index: Some(index),
            } => (
                self.0.indexed(&self.identifier(name), &self.indices(index)),
                Binding::Power,
            ),
            ExprKind::Negative(_) => {
                let (negative, text) = self.signed(expression);
                let text = if negative {
                    self.0.negative(&text)
                } else {
                    text
                };
                (text, Binding::Sum)
            }
            ExprKind::Sum(terms) => (self.sum(terms), Binding::Sum),
            ExprKind::Product(_) => match self.signed(expression) {
                (true, text) => (self.0.negative(&text), Binding::Sum),
                (false, text) => (text, Binding::Product),
            },
            ExprKind::Power(base, exponent) => {
                let base = match base.kind {
                    ExprKind::Name { .. } => self.of(base, Binding::Power),
                    _ => self.enclosed(&self.of(base, Binding::Sum), is_atom(base)),
                };
                let exponent = self.of(exponent, Binding::Sum);
                (self.0.power(&base, &exponent), Binding::Power)
            }
            ExprKind::Call {
                function,
                arguments,
            } => (self.call(&function.text, arguments), Binding::Power),
            ExprKind::IndexedSum { index, body, .. } if index.text == BONDS => (
                self.0.sum_of_bonds(&self.of(body, Binding::Product)),
                Binding::Sum,
            ),
            ExprKind::IndexedSum {
                index,
                from,
                to,
                body,
            } => {
                let range = [from, to].map(|end| self.of(end, Binding::Sum));
                let body = self.of(body, Binding::Product);
                let index = self.identifier(&index.text);
                let [from, to] = &range;
                (self.0.sum(&index, [from, to], &body), Binding::Sum)
            }
        };
        self.enclosed(&text, own >= around)
    }

    fn enclosed(&self, text: &str, bare: bool) -> String {
        match bare {
            true => self.0.group(text),
            false => self.0.parentheses(text),
        }
    }

    fn sum(&self, terms: &[(bool, Expr)]) -> String {
        let mut text = String::new();
        for (number, (minus, term)) in terms.iter().enumerate() {
            // a minus of its own joins the sign
            let (negative, term) = self.signed(term);
            text += &match (number, *minus != negative) {
                (0, true) => self.0.negative(&term),
                (0, false) => term,
                (_, true) => self.0.sign('-') + &term,
                (_, false) => self.0.sign('+') + &term,
            };
        }
        text
    }

    /// Whether a minus stands before a term, and the rest of it.
    fn signed(&self, term: &Expr) -> (bool, String) {
        match &term.kind {
            ExprKind::Negative(inner) => {
                let (negative, text) = self.signed(inner);
                (!negative, text)
            }
            ExprKind::Product(factors) => match factors.as_slice() {
                [
                    (
                        false,
                        Expr {
                            kind: ExprKind::Negative(first),
                            ..
                        },
                    ),
                    rest @ ..,
                ] => {
                    let bare =
                        std::iter::once((false, (**first).clone())).chain(rest.iter().cloned());
                    (true, self.product(&bare.collect::<Vec<_>>()))
                }
                factors => (false, self.product(factors)),
            },
            _ => (false, self.of(term, Binding::Product)),
        }
    }

    fn product(&self, factors: &[(bool, Expr)]) -> String {
        let side = |divides: bool| -> Vec<&Expr> {
            factors
                .iter()
                .filter(|(own, _)| *own == divides)
                .map(|(_, factor)| factor)
                .collect()
        };
        let joined = |factors: &[&Expr], alone: bool| -> String {
            let around = if alone && factors.len() == 1 {
                Binding::Sum
            } else {
                Binding::Product
            };
            let parts: Vec<String> = factors
                .iter()
                .map(|factor| self.of(factor, around))
                .collect();
            self.0.product(&parts)
        };
        let (over, under) = (side(false), side(true));
        if under.is_empty() {
            return joined(&over, false);
        }
        let over = if over.is_empty() {
            self.0.number("1")
        } else {
            joined(&over, true)
        };
        self.0.fraction(&over, &joined(&under, true))
    }

    fn indices(&self, index: &Index) -> String {
        let all = index.along_axes().map(|index| self.index(index));
        all.collect::<Vec<_>>().join(&self.0.sign(','))
    }

    fn index(&self, index: &Index) -> String {
        let variable = index
            .variable
            .as_ref()
            .map_or(String::new(), |name| self.identifier(&name.text));
        let number = || self.0.number(&index.offset.unsigned_abs().to_string());
        let offset = match (index.offset, variable.is_empty()) {
            (0, false) => String::new(),
            (offset, true) if offset >= 0 => number(),
            (_, true) => self.0.negative(&number()),
            (offset, false) if offset < 0 => self.0.sign('-') + &number(),
            _ => self.0.sign('+') + &number(),
        };
        variable + &offset
    }

    fn call(&self, function: &str, arguments: &[Expr]) -> String {
        let list = arguments.iter();
        let list: Vec<String> = list
            .map(|argument| self.of(argument, Binding::Sum))
            .collect();
        match (function, list.as_slice()) {
            (PIECEWISE, [left, right, yes, no]) => self.0.cases([left, right], [yes, no]),
            _ => self.0.call(function, &list),
        }
    }
}

fn is_atom(expression: &Expr) -> bool {
    match &expression.kind {
        ExprKind::Number(value) => !value.to_string().contains(['/', '-']),
        ExprKind::Call { function, .. } => matches!(&*function.text, "abs" | "norm"),
        kind => matches!(kind, ExprKind::Name { .. }),
    }
}
