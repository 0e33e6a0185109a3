//! Constants of the motion beside H and the Casimirs: polynomials F with `{F, H} = 0`.
//!
//! The condition is linear in the coefficients of F, for all monomials up to a degree at once, because H need not be homogeneous. It
//! holds for all values of the parameters, over whose rational functions it is solved. Elimination modulo a prime, at one point, says which
//! solutions are new and of which monomials they consist (`solutions`), and every solution is put into all equations.

mod functions;
mod solutions;

use super::integrals::integrals;
use crate::model::{Casimir, Model};
use functions::functions;
use lie_symbolic::exact::{Budget, Exhausted, Monomial, Polynomial, Rational};
use lie_symbolic::prove::independence::{self, Standing};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use solutions::Search;

/// The highest degree that is looked at.
pub const MAX_DEGREE: u32 = 4;
/// Work allowed in a report: spent to the end, two seconds.
pub const WORK: u64 = 40_000_000;
/// The part of it that what is known may take before anything is looked for.
const KNOWN: u64 = 8;
/// Work allowed where somebody waits for it.
pub const DEEP: u64 = 20_000_000_000;

/// More unknowns are not solved for.
const MOST: usize = 4000;

/// A constant of the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Its terms: variable i below the dimension n is a coordinate, n + p the parameter p.
    pub function: Polynomial,
    /// Its degree in the coordinates.
    pub degree: u32,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// H, the Casimirs and what was found determine the orbits: there can be no others.
    All,
    /// At the highest degree.
    Degree,
    /// There are too many monomials of the next degree.
    Large,
    /// Its budget was spent.
    Spent,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Motions {
    /// Functions that are independent of each other, of H and of the Casimirs, by ascending degree.
    pub found: Vec<Motion>,
    /// The degree up to which all of them were looked for.
    pub searched: u32,
    /// How the search ended.
    pub end: End,
}

/// Looks for constants of the motion.
///
/// # Errors
/// Why none are looked for.
pub fn find(model: &Model, casimirs: &[Casimir], work: u64) -> Result<Motions, &'static str> {
    if model.family.is_some() {
        return Err("H is that of a family");
    }
    let configuration = model.configuration.as_ref();
    if configuration.is_some_and(|c| c.group.is_some() || !c.idle) {
        return Err(
            "the coordinates of a group element or of the time have relations of their own",
        );
    }
    let Some(hamiltonian) = model.energy.expression() else {
        return Err("H is no expression in the coordinates");
    };
    let mut graph = model.graph.clone();
    let field = field(model, hamiltonian.energy, &mut graph);
    if field.iter().all(|f| graph.is_zero(*f)) {
        return Err("nothing moves");
    }
    let budget = Budget::new(work);
    let mut motions = Motions {
        found: Vec::new(),
        searched: 0,
        end: End::Spent,
    };
    let field = match functions(&graph, &field, &budget) {
        Ok(Some(field)) => field,
        Ok(None) => return Err("H is no polynomial of the coordinates"),
        Err(Exhausted) => return Ok(motions),
    };
    // what was found before the budget was spent is told
    let known = casimirs.iter().map(|casimir| casimir.expr);
    let known = known.chain([hamiltonian.energy]).collect();
    let _ = search(&mut graph, model, known, &field, &budget, &mut motions);
    Ok(motions)
}

/// Looks for them degree by degree, beside the Casimirs and H.
fn search(
    graph: &mut Graph,
    model: &Model,
    mut known: Vec<ExprId>,
    field: &[functions::Function],
    budget: &Budget,
    motions: &mut Motions,
) -> Result<(), Exhausted> {
    // declared ones that say nothing new are none of those that determine an orbit
    for integral in integrals(model) {
        known.push(integral.expr);
        let standings = independence::standings(graph, &known, field.len());
        if standings.last() != Some(&Standing::Independent) {
            known.pop();
        }
    }
    let mut search = Search::new(field, budget)?;
    for expr in &known {
        // what cannot be written out is compared at the end
        let allowed = budget.left() / KNOWN;
        let own = Budget::new(allowed);
        let written = functions(graph, &[*expr], &own);
        budget.spend(allowed - own.left())?;
        if let Ok(Some(written)) = written {
            search.know(&written[0])?;
        }
    }
    for degree in 1..=MAX_DEGREE {
        let Some(columns) = monomials(field.len(), degree) else {
            motions.end = End::Large;
            return Ok(());
        };
        for candidate in search.candidates(&columns)? {
            if !search.is_new(&candidate, &columns)? {
                continue;
            }
            let Some(function) = search.lifted(&candidate, &columns)? else {
                continue;
            };
            let expr = expression(graph, &function, field.len());
            known.push(expr);
            let standings = independence::standings(graph, &known, field.len());
            if standings.last() == Some(&Standing::Independent) {
                motions.found.push(Motion { function, degree });
                if let Some(written) = functions(graph, &[expr], budget)? {
                    search.know(&written[0])?;
                }
            } else {
                known.pop();
            }
        }
        motions.searched = degree;
        if known.len() + 1 >= field.len() {
            motions.end = End::All;
            return Ok(());
        }
    }
    motions.end = End::Degree;
    Ok(())
}

/// `Pi grad H`, without the coordinates that are there for a cocycle.
fn field(model: &Model, hamiltonian: ExprId, graph: &mut Graph) -> Vec<ExprId> {
    let (n, ..) = model.counts();
    let slopes: Vec<ExprId> = (0..n)
        .map(|i| graph.derivative(hamiltonian, Symbol::Coordinate(i)))
        .collect();
    let entries = model.bracket.entries(graph).into_iter();
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); n];
    for (i, j, value) in entries.filter(|(_, j, _)| *j < n) {
        terms[i].push(graph.mul(value, slopes[j]));
        let term = graph.mul(value, slopes[i]);
        terms[j].push(graph.neg(term));
    }
    terms.iter().map(|terms| graph.sum(terms)).collect()
}

/// The monomials in n variables of degrees 1 to d, by ascending degree.
fn monomials(n: usize, degree: u32) -> Option<Vec<Monomial>> {
    let mut all: Vec<Monomial> = Vec::new();
    let mut last = vec![(Monomial::default(), 0)];
    for _ in 0..degree {
        let mut next = Vec::new();
        for (monomial, first) in &last {
            for i in *first..n {
                next.push((monomial.mul(&Monomial::power(i, 1)).ok()?, i));
            }
        }
        all.extend(next.iter().map(|(monomial, _)| monomial.clone()));
        if all.len() > MOST {
            return None;
        }
        last = next;
    }
    Some(all)
}

/// A polynomial of coordinates and parameters as an expression.
fn expression(graph: &mut Graph, function: &Polynomial, dimension: usize) -> ExprId {
    let mut sum = Vec::new();
    for (monomial, coefficient) in function.terms() {
        let mut factors = Vec::new();
        for (v, e) in monomial.powers() {
            let symbol = match v.checked_sub(dimension) {
                Some(parameter) => Symbol::Parameter(parameter),
                None => Symbol::Coordinate(v),
            };
            factors.push((graph.symbol(symbol), Rational::from(i64::from(e))));
        }
        sum.push((graph.power_product(&factors), coefficient.clone()));
    }
    graph.linear(&sum)
}

#[cfg(test)]
mod tests;
