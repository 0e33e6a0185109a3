//! Casimirs that were found, written as they would have been declared.

use crate::model::{CasimirKind, Model};
use crate::structure::casimirs;
use lie_symbolic::exact::{Polynomial, Rational};
use lie_symbolic::prove::degree;
use lie_symbolic::symbolic::{ExprId, Function, Graph, Node, Symbol};
use lie_syntax::ast::{Expr, ExprKind, Name};

/// The largest arena that they may fill.
const LARGEST_ARENA: usize = 200_000;

/// A function as it would have been declared: as text, in normal form, and as it is evaluated.
#[derive(Clone)]
pub(super) struct Written {
    /// The text.
    pub text: Expr,
    /// Its normal form.
    pub normal: ExprId,
    /// As it is evaluated.
    pub form: ExprId,
}

/// Writes polynomials with the names of a declaration, and into its arena.
pub(super) struct Writer<'a> {
    pub model: &'a Model,
    /// Variables from this one on are parameters.
    pub dimension: usize,
    pub graph: &'a mut Graph,
}

impl Writer<'_> {
    /// A function that was found, with its kind and its degree; `None` where it has more terms than `most`.
    pub fn casimir(
        &mut self,
        casimir: &casimirs::Casimir,
        most: usize,
    ) -> Option<(Written, CasimirKind, Option<u32>)> {
        let (written, kind, degree) = match casimir {
            casimirs::Casimir::Polynomial(function) => {
                if function.terms().len() > most {
                    return None;
                }
                let degree = self.degree(function);
                let written = self.polynomial(function);
                (written, CasimirKind::Polynomial, Some(degree))
            }
            casimirs::Casimir::Rational(factors) => {
                let terms: usize = factors.iter().map(|(f, _)| f.terms().len()).sum();
                if terms > most {
                    return None;
                }
                let mut powers: Vec<(bool, Written)> = Vec::new();
                for (function, exponent) in factors {
                    let base = self.polynomial(function);
                    let power = self.power(base, &Rational::from(exponent.abs()));
                    powers.push((*exponent < 0, power));
                }
                powers.sort_by_key(|(below, _)| *below);
                (self.product(powers), CasimirKind::Rational, None)
            }
        };
        self.graph.remember_written(written.normal, written.form);
        (self.graph.size() <= LARGEST_ARENA).then_some((written, kind, degree))
    }

    /// A function as an expression, if it can be declared.
    pub fn function(
        &mut self,
        id: ExprId,
        most: usize,
    ) -> Option<(Written, CasimirKind, Option<u32>)> {
        if self.graph.dependencies(&[id]).len() > most {
            return None;
        }
        let degree = degree::degree(self.graph, id);
        let kind = match degree {
            Some(_) => CasimirKind::Polynomial,
            None => CasimirKind::Function,
        };
        let written = self.expression(id)?;
        self.graph.remember_written(written.normal, written.form);
        (self.graph.size() <= LARGEST_ARENA).then_some((written, kind, degree))
    }

    fn expression(&mut self, id: ExprId) -> Option<Written> {
        match self.graph.node(id).clone() {
            Node::Number(value) => Some(self.signed(&value)),
            Node::Pi => {
                let pi = ExprKind::Name {
                    name: "pi".to_owned(),
                    index: None,
                };
                Some(self.plain(pi, id))
            }
            Node::Symbol(Symbol::Coordinate(i)) => Some(self.variable(i)),
            Node::Symbol(Symbol::Parameter(p)) => Some(self.variable(self.dimension + p)),
            Node::Sum { constant, terms } => {
                let mut written = Vec::new();
                for (term, coefficient) in terms {
                    let mut factors = Vec::new();
                    if !coefficient.abs().is_one() {
                        factors.push((false, self.number(coefficient.abs())));
                    }
                    factors.push((false, self.expression(term)?));
                    let term = match factors.len() {
                        1 => factors.remove(0).1,
                        _ => self.product(factors),
                    };
                    written.push((coefficient.is_negative(), term));
                }
                if !constant.is_zero() {
                    written.push((constant.is_negative(), self.number(constant.abs())));
                }
                Some(self.sum(written))
            }
            Node::Product(factors) => {
                let mut written = Vec::new();
                for (base, exponent) in factors {
                    let base = self.expression(base)?;
                    let power = self.power(base, &exponent.abs());
                    written.push((exponent.is_negative(), power));
                }
                written.sort_by_key(|(below, _)| *below);
                if written.first().is_some_and(|(below, _)| *below) {
                    written.insert(0, (false, self.number(Rational::ONE)));
                }
                Some(self.product(written))
            }
            Node::Call(Function::Elementary(function), arguments) => {
                let [argument] = *arguments else { return None };
                let argument = self.expression(argument)?;
                let name = Name {
                    text: function.name().to_owned(),
                    origin: self.model.name_origin,
                };
                let id = self.graph.call(function, &[argument.normal]);
                let text = ExprKind::Call {
                    function: Box::new(name),
                    arguments: vec![argument.text],
                };
                Some(self.plain(text, id))
            }
            _ => None,
        }
    }

    /// A number with its sign.
    fn signed(&mut self, value: &Rational) -> Written {
        let size = self.number(value.abs());
        match value.is_negative() {
            true => self.sum(vec![(true, size)]),
            false => size,
        }
    }

    fn expr(&self, kind: ExprKind) -> Expr {
        Expr {
            kind,
            origin: self.model.name_origin,
        }
    }

    fn plain(&self, kind: ExprKind, id: ExprId) -> Written {
        Written {
            text: self.expr(kind),
            normal: id,
            form: id,
        }
    }

    fn number(&mut self, value: Rational) -> Written {
        let id = self.graph.number(value.clone());
        self.plain(ExprKind::Number(value), id)
    }

    fn variable(&mut self, variable: usize) -> Written {
        let parameter = variable.checked_sub(self.dimension);
        let (name, symbol) = match parameter {
            Some(p) => (&self.model.parameters[p].name, Symbol::Parameter(p)),
            None => {
                let name = &self.model.coordinates[variable].text;
                (name, Symbol::Coordinate(variable))
            }
        };
        let name = ExprKind::Name {
            name: name.clone(),
            index: None,
        };
        let id = self.graph.symbol(symbol);
        self.plain(name, id)
    }

    fn power(&mut self, base: Written, value: &Rational) -> Written {
        if value.is_one() {
            return base;
        }
        let exponent = self.number(value.clone());
        let text = ExprKind::Power(Box::new(base.text), Box::new(exponent.text));
        Written {
            text: self.expr(text),
            normal: self.graph.pow(base.normal, value),
            form: self.graph.pow(base.form, value),
        }
    }

    /// A product, whose factors are divided by where that is said.
    fn product(&mut self, factors: Vec<(bool, Written)>) -> Written {
        let powers = |of: fn(&Written) -> ExprId| -> Vec<(ExprId, Rational)> {
            let powers = factors
                .iter()
                .map(|(below, factor)| (of(factor), sign(*below)));
            powers.collect()
        };
        let (normal, form) = (powers(|f| f.normal), powers(|f| f.form));
        let (normal, form) = (
            self.graph.power_product(&normal),
            self.graph.power_product(&form),
        );
        let texts = factors.into_iter().map(|(below, f)| (below, f.text));
        Written {
            text: self.expr(ExprKind::Product(texts.collect())),
            normal,
            form,
        }
    }

    /// A sum, whose terms are subtracted where that is said.
    fn sum(&mut self, terms: Vec<(bool, Written)>) -> Written {
        let signed = |of: fn(&Written) -> ExprId| -> Vec<(ExprId, Rational)> {
            let signed = terms.iter().map(|(minus, term)| (of(term), sign(*minus)));
            signed.collect()
        };
        let (normal, form) = (signed(|t| t.normal), signed(|t| t.form));
        let (normal, form) = (self.graph.linear(&normal), self.graph.written_sum(&form));
        let texts = terms.into_iter().map(|(minus, t)| (minus, t.text));
        Written {
            text: self.expr(ExprKind::Sum(texts.collect())),
            normal,
            form,
        }
    }

    /// The degree in the coordinates.
    fn degree(&self, function: &Polynomial) -> u32 {
        let of = |m: &lie_symbolic::exact::Monomial| {
            let own = m.powers().filter(|(v, _)| *v < self.dimension);
            own.map(|(_, e)| e).sum()
        };
        function.terms().map(|(m, _)| of(m)).max().unwrap_or(0)
    }

    fn polynomial(&mut self, function: &Polynomial) -> Written {
        let mut terms = Vec::new();
        for (monomial, coefficient) in function.terms().rev() {
            let size = coefficient.abs();
            let mut factors = Vec::new();
            if !size.is_one() || monomial.is_one() {
                factors.push((false, self.number(size)));
            }
            for (variable, exponent) in monomial.powers() {
                let base = self.variable(variable);
                let exponent = Rational::from(i64::from(exponent));
                factors.push((false, self.power(base, &exponent)));
            }
            let term = match factors.len() {
                1 => factors.remove(0).1,
                _ => self.product(factors),
            };
            terms.push((coefficient.is_negative(), term));
        }
        match terms.as_slice() {
            [(false, _)] => terms.remove(0).1,
            _ => self.sum(terms),
        }
    }
}

fn sign(turned: bool) -> Rational {
    match turned {
        true => Rational::MINUS_ONE,
        false => Rational::ONE,
    }
}
