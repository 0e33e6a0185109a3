//! Casimirs that nobody declared: the search, and what is made of its results.

mod of_class;
mod writer;

use super::{Effort, casimirs};
use crate::algebra::{StructureConstants, rank};
use crate::model::{Bracket, Casimir, Configuration, Model, PoissonMatrix};
use lie_symbolic::exact::{Fraction, Polynomial, Rational};
use lie_symbolic::prove::independence::{self, Standing};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use writer::Writer;

/// Longer functions are not made part of a system, whose code would be as long.
const MOST_TERMS: usize = 1000;
/// Longer ones are not even told of.
const MOST_REPORTED: usize = 12_000;

/// How the search for the Casimirs that a declaration lacks ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// There was nothing to look for, or everything was looked for that is.
    Complete,
    /// Polynomials were looked for, and rational functions not: structure constants contain parameters, or brackets constant
    /// terms.
    Polynomials,
    /// Its budget was spent.
    Spent,
    /// What it found is too long to be part of a system.
    Long,
    /// A rational function that was found is not defined at the initial state, and neither is its reciprocal.
    Singular,
    /// It was not made, for a reason.
    None(&'static str),
}

/// The Casimirs with those that nobody declared, and how the search for them ended; the arena is that of the model.
pub fn completed(model: &Model, effort: Effort, graph: &mut Graph) -> (Vec<Casimir>, Search) {
    let declared = &model.declared_casimirs;
    let only = |search| (declared.clone(), search);
    let configuration = model.configuration.as_ref();
    if declared.len() >= model.casimirs_to_find() {
        return only(Search::Complete);
    }
    if configuration.is_some_and(|c| c.group.is_some()) {
        return only(Search::None(
            "the coordinates of a group element have relations of their own",
        ));
    }
    let momenta = configuration.map(Configuration::own_momenta);
    let (work, most) = match effort {
        Effort::Declaration => (casimirs::WORK, MOST_TERMS),
        Effort::Report => (casimirs::REPORT, MOST_REPORTED),
        Effort::Deep => (casimirs::DEEP, MOST_REPORTED),
    };
    let sought = match field(&model.bracket, momenta, &mut graph.clone()) {
        Ok(field) => invariants(model, &field, work),
        Err(reason) => {
            let mut littered = graph.clone();
            match of_class::sought(model, reason, &mut littered) {
                Some(mut sought) => {
                    sought.functions = graph.import(&littered, &sought.functions);
                    Some(sought)
                }
                None => return only(Search::None(reason)),
            }
        }
    };
    match sought {
        Some(sought) => complete(model, sought, most, graph),
        None => only(Search::Complete),
    }
}

/// Casimirs that were found, of so many coordinates.
struct Sought {
    found: Vec<casimirs::Casimir>,
    /// Those that are neither polynomials nor products of powers, as expressions.
    functions: Vec<ExprId>,
    /// How many there are.
    count: usize,
    dimension: usize,
    end: Search,
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
        n - rank::generic_rank(&self.constants, n) - usize::from(self.with_unit)
    }
}

/// The algebra in which the Casimirs of a bracket are invariants, or why there is none.
///
/// A bracket whose entries are affine is that of a central extension, with the unit set to one.
fn field(
    bracket: &Bracket,
    momenta: Option<usize>,
    graph: &mut Graph,
) -> Result<Field, &'static str> {
    match bracket {
        Bracket::Lie(algebra) => {
            let own = momenta.unwrap_or(algebra.exact.dimension());
            let with_unit = algebra.extension.is_some();
            let entries = algebra.exact.entries().iter();
            let entries = entries.filter(|(i, j, ..)| *i.max(j) < own);
            // beside a cocycle the unit is the next element, and else no bracket of declared elements has it
            let entries = entries.map(|(i, j, k, value)| (*i, *j, *k.min(&own), value.clone()));
            Ok(Field {
                constants: StructureConstants::new(own + usize::from(with_unit), entries.collect()),
                with_unit,
            })
        }
        Bracket::General(matrix) => affine(matrix, graph),
    }
}

/// The extension for a Poisson matrix with affine entries.
fn affine(matrix: &PoissonMatrix, graph: &mut Graph) -> Result<Field, &'static str> {
    const REASON: &str = "the brackets are no affine functions of the coordinates with coefficients that are rational functions of parameters, and of no class whose Casimirs are known";
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

/// Those that are invariants of an algebra; none where enough are declared.
fn invariants(model: &Model, field: &Field, work: u64) -> Option<Sought> {
    let count = field.count();
    if model.declared_casimirs.len() >= count {
        return None;
    }
    let bracket = casimirs::Kind {
        with_unit: field.with_unit,
        jacobi: !model.is_almost_poisson(),
    };
    let found = casimirs::find(&field.constants, count, bracket, work);
    let exact = field.constants.try_map(Fraction::as_constant).is_some();
    Some(Sought {
        end: match found.complete {
            true if found.casimirs.len() == count || (exact && !field.with_unit) => {
                Search::Complete
            }
            true => Search::Polynomials,
            false => Search::Spent,
        },
        found: found.casimirs,
        functions: Vec::new(),
        count,
        dimension: field.constants.dimension(),
    })
}

/// The Casimirs with those that the declared ones lack, and how the search ended.
fn complete(
    model: &Model,
    sought: Sought,
    most: usize,
    graph: &mut Graph,
) -> (Vec<Casimir>, Search) {
    let declared = &model.declared_casimirs;
    let Sought {
        found,
        functions,
        count,
        dimension,
        mut end,
    } = sought;
    let parameters = model.defaults();
    let initial = model.initial_values(&parameters);
    let parameters: Vec<Rational> = parameters
        .into_iter()
        .map(Rational::from_f64)
        .collect::<Option<_>>()
        .unwrap_or_default();
    let initial = initial.into_iter().flatten().map(Rational::from_f64);
    let initial: Option<Vec<Rational>> = initial.collect();
    let initial = initial.filter(|mu| !mu.is_empty());
    let mut writer = Writer {
        model,
        dimension,
        graph,
    };
    let mut written = Vec::new();
    for casimir in found {
        let Some(casimir) = defined(casimir, dimension, initial.as_deref(), &parameters) else {
            end = Search::Singular;
            continue;
        };
        match writer.casimir(&casimir, most) {
            Some(casimir) => written.push(casimir),
            None => end = Search::Long,
        }
    }
    for function in functions {
        match writer.function(function, most) {
            Some(function) => written.push(function),
            None => end = Search::Long,
        }
    }
    let declared_ones = declared.iter().map(|c| c.expr);
    let all: Vec<ExprId> = declared_ones
        .chain(written.iter().map(|(written, ..)| written.normal))
        .collect();
    // what is found is independent among itself
    let standings = match declared.as_slice() {
        [] => vec![Standing::Independent; all.len()],
        _ => independence::standings(writer.graph, &all, model.dimension()),
    };
    let standings = standings.into_iter().skip(declared.len());
    let mut names = (1..).map(|i| format!("C{i}")).filter(|name| {
        let taken = declared.iter().any(|casimir| casimir.name == *name);
        !taken && !model.taken.contains(name)
    });
    let mut casimirs = declared.clone();
    for ((written, kind, degree), standing) in written.into_iter().zip(standings) {
        // of what carries the time nobody has to be told
        let shown = model.shown_coordinates();
        let symbols = writer.graph.symbols(written.normal).into_iter();
        let mut own =
            symbols.filter(|symbol| matches!(symbol, Symbol::Coordinate(i) if shown.contains(i)));
        let told = own.next().is_some();
        if standing == Standing::Independent && told && casimirs.len() < count {
            casimirs.push(Casimir {
                multivalued: false,
                kept: true,
                name: names.next().unwrap_or_default(),
                origin: model.name_origin,
                expr: written.normal,
                degree,
                kind,
                written: Some(written.text),
            });
        }
    }
    (casimirs, end)
}

/// A rational function of so many coordinates or its reciprocal, whichever is defined at the initial state for these parameters.
fn defined(
    casimir: casimirs::Casimir,
    dimension: usize,
    initial: Option<&[Rational]>,
    parameters: &[Rational],
) -> Option<casimirs::Casimir> {
    let (casimirs::Casimir::Rational(factors), Some(initial)) = (&casimir, initial) else {
        return Some(casimir);
    };
    let value = |v: usize| {
        let value = match v.checked_sub(dimension) {
            Some(p) => parameters.get(p),
            None => initial.get(v),
        };
        value.cloned().unwrap_or(Rational::ZERO)
    };
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
