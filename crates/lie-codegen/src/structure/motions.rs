//! Constants of the motion beside H and the Casimirs: polynomials F with `{F, H} = 0`.
//!
//! The condition is linear in the coefficients of F, for all monomials up to a degree at once, because H need not be homogeneous. It
//! holds for all values of the parameters, over whose rational functions it is solved. Elimination modulo a prime, at one point, says which
//! equations are needed, and every solution is put into all of them.

use std::collections::{BTreeMap, HashMap};

use super::casimirs::solve::{
    Field as _, Functions, PRIMES, Prime, Sparse, cleared, drawn, kernel,
};
use crate::model::{Casimir, Model};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Polynomial, Rational};
use lie_symbolic::prove::independence::{self, Standing};
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};

/// The highest degree that is looked at.
pub const MAX_DEGREE: u32 = 4;
/// Work allowed in a report.
pub const WORK: u64 = 40_000_000;
/// Work allowed where somebody waits for it.
pub const DEEP: u64 = 20_000_000_000;

/// More unknowns are not solved for.
const MOST: usize = 4000;

/// A polynomial of the coordinates with coefficients that are rational functions of the parameters.
type Function = BTreeMap<Monomial, Fraction>;

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
    if model.configuration.is_some() {
        return Err(
            "the coordinates of a group element or of the time have relations of their own",
        );
    }
    if model.energy.expression().is_none() {
        return Err("H is no expression in the coordinates");
    }
    let mut graph = model.graph.clone();
    let field = field(model, &mut graph);
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
    let mut known: Vec<ExprId> = casimirs.iter().map(|casimir| casimir.expr).collect();
    known.push(model.hamiltonian());
    for degree in 1..=MAX_DEGREE {
        let Some(columns) = monomials(field.len(), degree) else {
            motions.end = End::Large;
            return Ok(motions);
        };
        let Ok(candidates) = solutions(&field, &columns, &budget) else {
            return Ok(motions);
        };
        for function in candidates {
            let expr = expression(&mut graph, &function, field.len());
            known.push(expr);
            let standings = independence::standings(&graph, &known, field.len());
            if standings.last() == Some(&Standing::Independent) {
                motions.found.push(Motion { function, degree });
            } else {
                known.pop();
            }
        }
        motions.searched = degree;
        if known.len() + 1 >= field.len() {
            motions.end = End::All;
            return Ok(motions);
        }
    }
    motions.end = End::Degree;
    Ok(motions)
}

/// `Pi grad H`
fn field(model: &Model, graph: &mut Graph) -> Vec<ExprId> {
    let n = model.dimension();
    let slopes: Vec<ExprId> = (0..n)
        .map(|i| graph.derivative(model.hamiltonian(), Symbol::Coordinate(i)))
        .collect();
    let entries = model.bracket.entries(graph);
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); n];
    for (i, j, value) in entries {
        terms[i].push(graph.mul(value, slopes[j]));
        let term = graph.mul(value, slopes[i]);
        terms[j].push(graph.neg(term));
    }
    terms.iter().map(|terms| graph.sum(terms)).collect()
}

/// Expressions as polynomials of the coordinates; `None` where one is none.
fn functions(
    graph: &Graph,
    roots: &[ExprId],
    budget: &Budget,
) -> Result<Option<Vec<Function>>, Exhausted> {
    let mut values: HashMap<ExprId, Function> = HashMap::new();
    let constant = |value: Fraction| Function::from([(Monomial::default(), value)]);
    for id in graph.dependencies(roots) {
        let value = match graph.node(id) {
            Node::Number(value) => constant(value.clone().into()),
            Node::Symbol(Symbol::Parameter(p)) => constant(Fraction::variable(*p)),
            Node::Symbol(Symbol::Coordinate(i)) => {
                Function::from([(Monomial::power(*i, 1), Rational::ONE.into())])
            }
            Node::Sum { terms, .. } | Node::Written(terms) => {
                let mut sum = match graph.node(id) {
                    Node::Sum { constant: c, .. } => constant(c.clone().into()),
                    _ => Function::new(),
                };
                for (term, coefficient) in terms {
                    for (monomial, value) in &values[term] {
                        add(&mut sum, monomial, &value.scale(coefficient), budget)?;
                    }
                }
                sum
            }
            Node::Product(factors) => {
                let mut product = constant(Rational::ONE.into());
                for (base, exponent) in factors {
                    let Some(power) = power(&values[base], exponent, budget)? else {
                        return Ok(None);
                    };
                    product = times(&product, &power, budget)?;
                }
                product
            }
            _ => return Ok(None),
        };
        values.insert(id, value);
    }
    let of_root = |root: &ExprId| {
        let mut function = values[root].clone();
        function.retain(|_, value| !value.is_zero());
        function
    };
    Ok(Some(roots.iter().map(of_root).collect()))
}

fn add(
    sum: &mut Function,
    monomial: &Monomial,
    value: &Fraction,
    budget: &Budget,
) -> Result<(), Exhausted> {
    budget.spend(4)?;
    let entry = sum.entry(monomial.clone()).or_default();
    *entry = entry.add(value, budget)?;
    Ok(())
}

fn times(a: &Function, b: &Function, budget: &Budget) -> Result<Function, Exhausted> {
    let mut product = Function::new();
    for (m, x) in a {
        for (n, y) in b {
            add(&mut product, &m.mul(n)?, &x.mul(y, budget)?, budget)?;
        }
    }
    Ok(product)
}

/// A power; `None` where it is no polynomial of the coordinates.
fn power(
    base: &Function,
    exponent: &Rational,
    budget: &Budget,
) -> Result<Option<Function>, Exhausted> {
    let Some(exponent) = exponent.to_integer().and_then(|e| i32::try_from(e).ok()) else {
        return Ok(None);
    };
    let constant = match base.iter().next() {
        Some((monomial, value)) if base.len() == 1 && monomial.is_one() => Some(value),
        _ => None,
    };
    if let Some(value) = constant {
        let power = value.pow(exponent, budget)?;
        return Ok(power.map(|power| Function::from([(Monomial::default(), power)])));
    }
    let Ok(exponent) = u32::try_from(exponent) else {
        return Ok(None);
    };
    let mut product = Function::from([(Monomial::default(), Rational::ONE.into())]);
    for _ in 0..exponent {
        product = times(&product, base, budget)?;
    }
    Ok(Some(product))
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

/// The polynomials of these monomials that the field does not change, as a vector space.
fn solutions(
    field: &[Function],
    columns: &[Monomial],
    budget: &Budget,
) -> Result<Vec<Polynomial>, Exhausted> {
    let n = field.len();
    let mut equations: BTreeMap<Monomial, Sparse<Fraction>> = BTreeMap::new();
    for (column, monomial) in columns.iter().enumerate() {
        for (monomial, value) in changed(monomial, field, budget)? {
            if !value.is_zero() {
                equations.entry(monomial).or_default().push((column, value));
            }
        }
    }
    let equations: Vec<Sparse<Fraction>> = equations.into_values().collect();
    let prime = Prime {
        prime: PRIMES[0],
        budget,
    };
    let residue = |(column, value): &(usize, Fraction)| {
        Some((*column, prime.fraction(value, &|p| drawn(n + p))?))
    };
    let rows = equations
        .iter()
        .map(|row| row.iter().map(residue).collect());
    let rows: Option<Vec<Sparse<u64>>> = rows.collect();
    let rows = rows.ok_or(Exhausted)?.into_iter().map(|mut row| {
        row.retain(|(_, value)| !prime.is_zero(value));
        row
    });
    let (vectors, needed) = kernel(&prime, columns.len(), rows)?;
    if vectors.is_empty() {
        return Ok(Vec::new());
    }
    let rows = needed.iter().map(|&i| equations[i].clone());
    let (vectors, _) = kernel(&Functions { budget }, columns.len(), rows)?;
    let mut found = Vec::new();
    for vector in vectors {
        if solves(&vector, &equations, columns.len(), budget)? {
            let terms = vector
                .into_iter()
                .map(|(c, value)| (columns[c].clone(), value));
            found.push(cleared(&terms.collect::<Vec<_>>(), n, budget)?);
        }
    }
    found.sort_by_key(|function| function.terms().len());
    Ok(found)
}

/// `sum_j f_j dm/dmu_j` of a monomial m.
fn changed(
    monomial: &Monomial,
    field: &[Function],
    budget: &Budget,
) -> Result<Function, Exhausted> {
    let mut sum = Function::new();
    for (j, exponent) in monomial.powers() {
        let lower = monomial.divide(&Monomial::power(j, 1)).unwrap_or_default();
        for (other, value) in &field[j] {
            let value = value.scale(&Rational::from(i64::from(exponent)));
            add(&mut sum, &lower.mul(other)?, &value, budget)?;
        }
    }
    Ok(sum)
}

/// Whether a vector solves all equations.
fn solves(
    vector: &Sparse<Fraction>,
    equations: &[Sparse<Fraction>],
    columns: usize,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let mut values: Vec<Option<&Fraction>> = vec![None; columns];
    for (column, value) in vector {
        values[*column] = Some(value);
    }
    for row in equations {
        let mut sum = Fraction::default();
        for (column, factor) in row {
            if let Some(value) = values[*column] {
                sum = sum.add(&factor.mul(value, budget)?, budget)?;
            }
        }
        if !sum.is_zero() {
            return Ok(false);
        }
    }
    Ok(true)
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
