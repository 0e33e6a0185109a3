//! What an algebra is: its class, its series, and its name in any basis.
//!
//! Everything is computed over the rationals. Where the structure constants contain parameters, class and series are
//! those of generic values, which are looked at in one point that obeys no relation by accident; name and signature belong to the
//! default values, because they may change with a sign.

mod class;
mod extensions;
mod name;
mod parts;
pub(super) mod roots;
mod series;
mod simple;
mod subspace;
mod table;

use crate::algebra::StructureConstants;
use crate::model::Model;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};

pub use class::{Class, Series, class};
pub use parts::eigenvalues;
pub use subspace::{Signature, Subspace, Vector};
pub use table::Table;

/// Work allowed for the report on an algebra in a declaration.
pub const WORK: u64 = 400_000;
/// Work allowed where somebody waits for it.
pub const DEEP: u64 = 400_000_000;

/// What is known of an algebra.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Its dimension.
    pub dimension: usize,
    /// Its class, for generic values of the parameters.
    pub class: Class,
    /// Its series, for generic values of the parameters.
    pub series: Series,
    /// Class and series at the default values of the parameters, where structure constants contain some.
    pub at_defaults: Option<(Class, Series)>,
    /// Its name at the default values, or what is said of an algebra without one.
    pub name: Result<String, String>,
}

impl Report {
    /// What else an algebra of its name is called.
    pub fn alias(&self) -> Option<&'static str> {
        simple::alias(self.name.as_ref().ok()?)
    }

    /// Whether the default values of the parameters are special.
    pub fn has_special_defaults(&self) -> bool {
        let at = self.at_defaults.as_ref();
        at.is_some_and(|(class, series)| {
            let dimensions = |s: &Series| {
                (
                    s.derived.clone(),
                    s.lower_central.clone(),
                    s.centre,
                    s.radical,
                    s.killing.zero,
                )
            };
            *class != self.class || dimensions(series) != dimensions(&self.series)
        })
    }
}

/// The structure constants of the algebra that was declared, without the coordinates that carry a group element or the time.
pub fn declared(model: &Model) -> Option<StructureConstants<Fraction>> {
    let constants = &model.bracket.algebra()?.exact;
    let Some(configuration) = &model.configuration else {
        return Some(constants.clone());
    };
    let own = configuration.own_momenta();
    let inside = constants
        .entries()
        .iter()
        .filter(|(i, j, k, _)| *i < own && *j < own && *k < own);
    Some(StructureConstants::new(own, inside.cloned().collect()))
}

/// The report on the algebra of a system; `None` where it has none, or where the budget is too small.
pub fn report(model: &Model, work: u64) -> Option<Report> {
    let constants = declared(model)?;
    let defaults = |p: usize| model.parameters.get(p).and_then(|p| p.exact.clone());
    of(&constants, &defaults, &Budget::new(work)).ok()?
}

/// The report on structure constants; `None` where a constant has a pole at the defaults.
fn of(
    constants: &StructureConstants<Fraction>,
    defaults: &dyn Fn(usize) -> Option<Rational>,
    budget: &Budget,
) -> Result<Option<Report>, Exhausted> {
    let default = |p: usize| defaults(p).unwrap_or(Rational::ZERO);
    let Some(table) = at(constants, &default) else {
        return Ok(None);
    };
    let (class, series) = class::class(&table, budget)?;
    let dimension = table.dimension();
    let mut report = Report {
        dimension,
        class,
        series,
        at_defaults: None,
        name: named(&table, budget),
    };
    let with_parameters = constants
        .entries()
        .iter()
        .any(|(.., c)| c.as_constant().is_none());
    if with_parameters {
        let Some(generic) = at(constants, &generic) else {
            return Ok(None);
        };
        let (class, series) = class::class(&generic, budget)?;
        report.at_defaults = Some((report.class, report.series));
        (report.class, report.series) = (class, series);
    }
    Ok(Some(report))
}

/// The name, which is worth less than the rest of the report: where the budget does not suffice for it, that is said.
fn named(table: &Table, budget: &Budget) -> Result<String, String> {
    let spent = |Exhausted| format!("dim {}, too large for the budget", table.dimension());
    match name::name(table, budget) {
        Ok(Some(name)) => Ok(name),
        Ok(None) => Err(name::description(table, budget).unwrap_or_else(spent)),
        Err(exhausted) => Err(spent(exhausted)),
    }
}

/// The table at values of the parameters; `None` at a pole.
fn at(
    constants: &StructureConstants<Fraction>,
    value: &dyn Fn(usize) -> Rational,
) -> Option<Table> {
    let mut entries = Vec::new();
    for (i, j, k, constant) in constants.entries() {
        let value = constant.evaluate(value)?;
        if !value.is_zero() {
            entries.push((*i, *j, *k, value));
        }
    }
    Some(Table::new(&StructureConstants::new(
        constants.dimension(),
        entries,
    )))
}

/// A value of a parameter that obeys no relation with small coefficients.
fn generic(parameter: usize) -> Rational {
    const PRIMES: [i64; 4] = [10_007, 50_021, 90_001, 30_011];
    let index = parameter as i64;
    let prime = PRIMES[parameter % PRIMES.len()];
    &Rational::from(prime) / &Rational::from(7_919 + 1_000 * index)
}

#[cfg(test)]
mod tests;
