//! The names that a bracket or a matrix may use.

use std::collections::HashMap;

use crate::ast::{Declaration, Name};
use crate::diagnostic::{Diagnostic, Kind};
use crate::suggest::{listed, misspelt};
use lie_symbolic::exact::Fraction;

/// What a name stands for on the right side of a bracket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// A basis element.
    Basis(usize),
    /// An exact parameter, by its position among all parameters.
    Exact(usize),
    /// A parameter that is not exact.
    Inexact,
    /// An abbreviation.
    Let,
    /// A coordinate.
    Coordinate,
}

/// The names of a declaration as its brackets see them.
#[derive(Debug)]
pub struct Scope<'a> {
    meanings: HashMap<&'a str, Meaning>,
    basis: Vec<&'a str>,
    parameters: Vec<&'a str>,
}

impl<'a> Scope<'a> {
    /// The names of a declaration. Of a repeated name the first one counts; the repetition is
    /// reported elsewhere.
    pub fn new(declaration: &'a Declaration) -> Self {
        let mut meanings = HashMap::new();
        let basis: Vec<&str> = declaration
            .basis()
            .iter()
            .map(|n| n.text.as_str())
            .collect();
        let parameters: Vec<&str> = declaration
            .parameters
            .iter()
            .map(|p| p.name.text.as_str())
            .collect();
        for (i, name) in basis.iter().enumerate() {
            meanings.entry(*name).or_insert(Meaning::Basis(i));
        }
        for (i, parameter) in declaration.parameters.iter().enumerate() {
            let meaning = if parameter.exact {
                Meaning::Exact(i)
            } else {
                Meaning::Inexact
            };
            meanings.entry(parameters[i]).or_insert(meaning);
        }
        for (name, _) in &declaration.lets {
            meanings.entry(name.text.as_str()).or_insert(Meaning::Let);
        }
        for name in &declaration.state {
            meanings
                .entry(name.text.as_str())
                .or_insert(Meaning::Coordinate);
        }
        Self {
            meanings,
            basis,
            parameters,
        }
    }

    /// A basis alone.
    pub fn from_basis(basis: &'a [Name]) -> Self {
        let basis: Vec<&str> = basis.iter().map(|name| name.text.as_str()).collect();
        let meanings = basis.iter().enumerate();
        Self {
            meanings: meanings
                .map(|(i, name)| (*name, Meaning::Basis(i)))
                .collect(),
            basis,
            parameters: Vec::new(),
        }
    }

    /// The position of a basis element.
    pub fn basis_index(&self, name: &str) -> Option<usize> {
        match self.meanings.get(name) {
            Some(Meaning::Basis(i)) => Some(*i),
            _ => None,
        }
    }

    /// What a name stands for.
    pub fn meaning(&self, name: &str) -> Option<Meaning> {
        self.meanings.get(name).copied()
    }

    /// The names of the basis.
    pub fn basis(&self) -> &[&'a str] {
        &self.basis
    }

    /// The names of the exact parameters.
    pub fn exact(&self) -> impl Iterator<Item = &'a str> {
        let names = self.parameters.iter().copied();
        names.filter(|name| matches!(self.meaning(name), Some(Meaning::Exact(_))))
    }

    /// The name of a parameter.
    pub fn parameter(&self, index: usize) -> String {
        self.parameters[index].to_string()
    }

    /// The basis name most like a misspelt one.
    pub fn nearest_basis(&self, name: &str) -> Option<&'a str> {
        misspelt(name, self.basis.iter().copied())
    }

    /// The error for a name that is no basis name, at a place where one is expected.
    pub fn unknown_basis(&self, kind: Kind, name: &crate::ast::Name) -> Diagnostic {
        let diagnostic = Diagnostic::new(
            kind,
            name.origin,
            format!("`{}` is not in the basis", name.text),
        );
        let help = match self.nearest_basis(&name.text) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the basis is {}", listed(&self.basis)),
        };
        diagnostic.help(help)
    }

    /// The linear combination of basis names as text.
    pub fn display(&self, form: &[(usize, Fraction)]) -> String {
        let mut text = String::new();
        for (k, value) in form {
            let shown = value.display(&|p| self.parameter(p));
            let sum = value.numerator().terms().len() > 1 && value.denominator().next().is_none();
            let (negative, size) = match shown.strip_prefix('-') {
                Some(size) if value.numerator().terms().len() == 1 => (true, size.to_string()),
                _ => (false, if sum { format!("({shown})") } else { shown }),
            };
            text.push_str(match (text.is_empty(), negative) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            });
            if size != "1" {
                text.push_str(&size);
                text.push('*');
            }
            text.push_str(self.basis[*k]);
        }
        if text.is_empty() { "0".into() } else { text }
    }
}
