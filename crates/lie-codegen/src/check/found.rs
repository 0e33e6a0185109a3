//! Casimirs that nobody declared: the search, and what is made of its results.

use super::Effort;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use super::naming;
use super::poisson::Entry;
use crate::algebra::{StructureConstants, rank};
use crate::ast::{Declaration, Expr, ExprKind};
use crate::diagnostic::{Origin, Report};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::model::configuration::Configuration;
use crate::model::{Bracket, Casimir, CasimirKind, PoissonMatrix, Search};
use crate::prove::independence::{self, Standing};
use crate::structure::casimirs;
use crate::symbolic::{ExprId, Graph, Symbol};

/// Longer functions are not made part of a system, whose code would be as long.
const MOST_TERMS: usize = 1000;
/// Longer ones are not even told of.
const MOST_REPORTED: usize = 12_000;

/// What a search starts from.
pub struct Asked<'a> {
    /// The declaration, with all coordinates.
    pub declaration: &'a Declaration,
    /// What the coordinates beside mu are.
    pub configuration: Option<&'a Configuration>,
    /// The bracket.
    pub bracket: &'a Bracket,
    /// Its entries that are declared one by one.
    pub brackets: &'a [Entry],
    /// How many independent Casimirs there are.
    pub count: usize,
    /// The initial state.
    pub initial: Option<Vec<f64>>,
    /// How much work is done.
    pub effort: Effort,
}

impl Asked<'_> {
    /// The Casimirs that the declared ones lack, and how the search for them ended; the second arena may be littered.
    pub fn search(
        &self,
        declared: &[Casimir],
        (graph, scratch): (&mut Graph, &mut Graph),
    ) -> (Vec<Casimir>, Search) {
        let unit = self.configuration.is_some_and(|c| c.time);
        if declared.len() + usize::from(unit) >= self.count {
            return (Vec::new(), Search::Complete);
        }
        if self.configuration.is_some_and(|c| c.group.is_some()) {
            let reason = "the coordinates of a group element have relations of their own";
            return (Vec::new(), Search::None(reason));
        }
        let momenta = self.configuration.map(Configuration::own_momenta);
        let field = match field(self.bracket, momenta, self.brackets, scratch) {
            Ok(field) => field,
            Err(reason) => return (Vec::new(), Search::None(reason)),
        };
        let work = match self.effort {
            Effort::Declaration => casimirs::WORK,
            Effort::Report => casimirs::REPORT,
            Effort::Deep => casimirs::DEEP,
        };
        let initial = self.initial.iter().flatten();
        let initial: Option<Vec<Rational>> = initial.map(|v| Rational::from_f64(*v)).collect();
        let initial = initial.filter(|mu| !mu.is_empty());
        let bounds = (initial.as_deref(), work);
        complete(self.declaration, &field, declared, graph, bounds)
    }
}

/// An algebra in which Casimirs are looked for.
struct Field {
    /// Its structure constants; a unit is the last basis element.
    constants: StructureConstants<Fraction>,
    /// Whether there is one, of brackets with constant terms.
    with_unit: bool,
}

impl Field {
    /// How many independent Casimirs there are, without the unit.
    fn count(&self) -> usize {
        let n = self.constants.dimension();
        n - rank::generic(&self.constants, n) - usize::from(self.with_unit)
    }
}

/// The algebra in which the Casimirs of a bracket are invariants, or why there is none.
///
/// A bracket whose entries are affine is that of a central extension, with the unit set to one.
fn field(
    bracket: &Bracket,
    momenta: Option<usize>,
    brackets: &[Entry],
    graph: &mut Graph,
) -> Result<Field, &'static str> {
    match bracket {
        Bracket::Lie(algebra) => {
            let own = momenta.unwrap_or(algebra.exact.dimension());
            let entries = algebra.exact.entries().iter();
            let entries = entries
                .filter(|(i, j, k, _)| *i.max(j).max(k) < own)
                .cloned();
            Ok(Field {
                constants: StructureConstants::new(own, entries.collect()),
                with_unit: false,
            })
        }
        Bracket::Extended(algebra, _) => {
            let n = algebra.exact.dimension();
            let mut entries = algebra.exact.entries().to_vec();
            for entry in brackets {
                let value = graph.fraction(entry.value, None).ok_or(
                    "a constant term of the bracket is no rational function of parameters",
                )?;
                entries.push((entry.row, entry.column, n, value.neg()));
            }
            Ok(Field {
                constants: StructureConstants::new(n + 1, entries),
                with_unit: true,
            })
        }
        Bracket::General(matrix) => affine(matrix, graph),
    }
}

/// The extension for a Poisson matrix with affine entries.
fn affine(matrix: &PoissonMatrix, graph: &mut Graph) -> Result<Field, &'static str> {
    const REASON: &str = "the brackets are not affine functions of the coordinates with coefficients that are rational functions of parameters";
    let n = matrix.dimension;
    let mut entries = Vec::new();
    let mut with_unit = false;
    for (i, j, value) in &matrix.entries {
        let mut terms = Vec::new();
        for k in 0..n {
            let slope = graph.derivative(*value, Symbol::Coordinate(k));
            if graph.is_zero(slope) {
                continue;
            }
            terms.push((*i, *j, k, graph.fraction(slope, None).ok_or(REASON)?.neg()));
        }
        let rest = graph.fraction(*value, Some(Rational::ZERO)).ok_or(REASON)?;
        if !rest.is_zero() {
            with_unit = true;
            terms.push((*i, *j, n, rest.neg()));
        }
        entries.extend(terms);
    }
    let constants = StructureConstants::new(n + usize::from(with_unit), entries);
    Ok(Field {
        constants,
        with_unit,
    })
}

/// The Casimirs that the declared ones lack, and how the search ended.
fn complete(
    declaration: &Declaration,
    field: &Field,
    declared: &[Casimir],
    graph: &mut Graph,
    (initial, work): (Option<&[Rational]>, u64),
) -> (Vec<Casimir>, Search) {
    let count = field.count();
    if declared.len() >= count {
        return (Vec::new(), Search::Complete);
    }
    let found = casimirs::find(&field.constants, count, field.with_unit, work);
    let exact = field.constants.try_map(Fraction::as_constant).is_some();
    let mut end = match found.complete {
        true if found.casimirs.len() == count || (exact && !field.with_unit) => Search::Complete,
        true => Search::Polynomials,
        false => Search::Spent,
    };
    let written = found.casimirs.into_iter().filter_map(|casimir| {
        let Some(casimir) = defined(casimir, initial) else {
            end = Search::Singular;
            return None;
        };
        let most = match work {
            casimirs::WORK => MOST_TERMS,
            _ => MOST_REPORTED,
        };
        let expr = written(&casimir, declaration, field, most);
        if expr.is_none() {
            end = Search::Long;
        }
        expr
    });
    let written: Vec<(Expr, CasimirKind, Option<u32>)> = written.collect();
    let environment = Environment::new(declaration);
    let mut report = Report::new();
    let mut lower =
        |expr: &Expr| Lowering::new(graph, &environment, &mut report, Allowed::State).lower(expr);
    let lowered: Vec<Option<ExprId>> = written.iter().map(|(expr, ..)| lower(expr)).collect();
    report.ignore("the functions are made of names that are declared");
    let all: Vec<ExprId> = declared
        .iter()
        .map(|c| c.expr)
        .chain(lowered.iter().flatten().copied())
        .collect();
    // what is found is independent among itself
    let standings = match declared {
        [] => vec![Standing::Independent; all.len()],
        _ => independence::check(graph, &all, declaration.dimension()),
    };
    let mut standings = standings.into_iter().skip(declared.len());
    let mut names = naming::free_names(declaration, declared);
    let mut added = Vec::new();
    for ((written, kind, degree), expr) in written.into_iter().zip(lowered) {
        let Some(expr) = expr else { continue };
        let new = standings.next() == Some(Standing::Independent);
        if new && declared.len() + added.len() < count {
            added.push(Casimir {
                multivalued: false,
                name: names.next().unwrap_or_default(),
                origin: declaration.place(),
                expr,
                degree,
                kind,
                written: Some(written),
            });
        }
    }
    (added, end)
}

/// A rational function or its reciprocal, whichever is defined at the initial state.
fn defined(casimir: casimirs::Casimir, initial: Option<&[Rational]>) -> Option<casimirs::Casimir> {
    let (casimirs::Casimir::Rational(factors), Some(initial)) = (&casimir, initial) else {
        return Some(casimir);
    };
    let value = |v: usize| initial.get(v).cloned().unwrap_or(Rational::ZERO);
    let zero = |(function, _): &&(Polynomial, i64)| function.evaluate(&value).is_zero();
    let zeros: Vec<i64> = factors
        .iter()
        .filter(zero)
        .map(|(_, exponent)| *exponent)
        .collect();
    if zeros.iter().all(|exponent| *exponent > 0) {
        Some(casimir)
    } else if zeros.iter().all(|exponent| *exponent < 0) {
        let turned = factors
            .iter()
            .map(|(function, exponent)| (function.clone(), -exponent));
        Some(casimirs::Casimir::Rational(turned.collect()))
    } else {
        None
    }
}

/// A found function as if it had been declared; `None` where it has more terms than `most`.
fn written(
    casimir: &casimirs::Casimir,
    declaration: &Declaration,
    field: &Field,
    most: usize,
) -> Option<(Expr, CasimirKind, Option<u32>)> {
    let writer = Writer {
        declaration,
        dimension: field.constants.dimension(),
        origin: declaration.place(),
    };
    match casimir {
        casimirs::Casimir::Polynomial(function) => {
            let degree = writer.degree(function);
            (function.terms().len() <= most).then(|| {
                (
                    writer.polynomial(function),
                    CasimirKind::Polynomial,
                    Some(degree),
                )
            })
        }
        casimirs::Casimir::Rational(factors) => {
            let terms: usize = factors.iter().map(|(f, _)| f.terms().len()).sum();
            let powers = factors.iter().map(|(function, exponent)| {
                let power = writer.power(writer.polynomial(function), exponent.unsigned_abs());
                (*exponent < 0, power)
            });
            let mut powers: Vec<(bool, Expr)> = powers.collect();
            powers.sort_by_key(|(below, _)| *below);
            (terms <= most).then(|| {
                (
                    writer.expr(ExprKind::Product(powers)),
                    CasimirKind::Rational,
                    None,
                )
            })
        }
    }
}

/// Polynomials as expressions of the declaration.
struct Writer<'a> {
    declaration: &'a Declaration,
    dimension: usize,
    origin: Origin,
}

impl Writer<'_> {
    fn expr(&self, kind: ExprKind) -> Expr {
        Expr {
            kind,
            origin: self.origin,
        }
    }

    fn name(&self, variable: usize) -> Expr {
        let parameter = variable.checked_sub(self.dimension);
        let name = match parameter {
            Some(p) => &self.declaration.parameters[p].name,
            None => &self.declaration.state[variable],
        };
        self.expr(ExprKind::Name {
            name: name.text.clone(),
            index: None,
        })
    }

    fn power(&self, base: Expr, exponent: u64) -> Expr {
        match exponent {
            1 => base,
            _ => {
                let exponent = self.expr(ExprKind::Number(Rational::from(exponent as i64)));
                self.expr(ExprKind::Power(Box::new(base), Box::new(exponent)))
            }
        }
    }

    /// The degree in the coordinates.
    fn degree(&self, function: &Polynomial) -> u32 {
        let of = |m: &crate::exact::Monomial| {
            let own = m.powers().filter(|(v, _)| *v < self.dimension);
            own.map(|(_, e)| e).sum()
        };
        function.terms().map(|(m, _)| of(m)).max().unwrap_or(0)
    }

    fn polynomial(&self, function: &Polynomial) -> Expr {
        let terms = function.terms().rev().map(|(monomial, coefficient)| {
            let size = coefficient.abs();
            let mut factors = Vec::new();
            if !size.is_one() || monomial.is_one() {
                factors.push((false, self.expr(ExprKind::Number(size))));
            }
            let powers = monomial.powers();
            factors.extend(powers.map(|(v, e)| (false, self.power(self.name(v), u64::from(e)))));
            let term = match factors.len() {
                1 => factors.remove(0).1,
                _ => self.expr(ExprKind::Product(factors)),
            };
            (coefficient.is_negative(), term)
        });
        let mut terms: Vec<(bool, Expr)> = terms.collect();
        match terms.as_slice() {
            [(false, _)] => terms.remove(0).1,
            _ => self.expr(ExprKind::Sum(terms)),
        }
    }
}
