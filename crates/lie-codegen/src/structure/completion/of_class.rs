//! Casimirs of brackets that are declared by their entries, where the class of the bracket says what they are.

use super::Sought;
use crate::model::{Model, PoissonMatrix};
use crate::structure::bracket_class::jacobian;
use crate::structure::casimirs::solve::{Functions, Sparse, cleared, kernel};
use crate::structure::casimirs::{Casimir, WORK};
use crate::structure::completion::Search;
use crate::structure::elementwise::{Elementwise, elementwise};
use lie_symbolic::exact::{Budget, Fraction, Monomial, Polynomial, Rational};
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Symbol};

/// The largest exponent in a product of powers.
const MOST: i64 = 60;

/// The Casimirs of a bracket of a class, or else the coordinates that are in no bracket, and then why no others are looked for. The graph may be
/// littered.
pub(super) fn sought(model: &Model, reason: &'static str, graph: &mut Graph) -> Option<Sought> {
    let matrix = model.own_matrix();
    let matrix = &matrix.filter(|_| !model.is_almost_poisson())?;
    if let Some(form) = elementwise(model, matrix, graph) {
        let found = nothing(matrix, 0, Search::Complete);
        return of_changed_coordinates(model, &form, found, graph);
    }
    if let Some(casimir) = jacobian(model, matrix, graph) {
        return Some(Sought {
            functions: vec![casimir],
            ..nothing(matrix, 1, Search::Complete)
        });
    }
    let moves = |i: &usize| matrix.entries.iter().any(|(a, b, _)| i == a || i == b);
    let alone = (0..matrix.dimension).filter(|i| !moves(i));
    let found: Vec<Casimir> = alone
        .map(|i| Casimir::Polynomial(Polynomial::variable(i)))
        .collect();
    let sought = nothing(matrix, found.len(), Search::None(reason));
    (!found.is_empty()).then_some(Sought { found, ..sought })
}

fn nothing(matrix: &PoissonMatrix, count: usize, end: Search) -> Sought {
    Sought {
        found: Vec::new(),
        functions: Vec::new(),
        count,
        dimension: matrix.dimension,
        end,
    }
}

/// Those of `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`: `sum_i k_i y_i` with `y_i = int dx_i/a_i` and `c k = 0`. Where all `y_i` are logarithms and the
/// `k_i` are integers, these are products of powers of the `a_i`, which have a value whatever the signs.
fn of_changed_coordinates(
    model: &Model,
    form: &Elementwise,
    mut sought: Sought,
    graph: &mut Graph,
) -> Option<Sought> {
    let n = form.speeds.len();
    let budget = Budget::new(WORK);
    let field = Functions { budget: &budget };
    let rows = form.constants.iter().map(|row| -> Sparse<Fraction> {
        let entries = row.iter().cloned().enumerate();
        entries.filter(|(_, c)| !c.is_zero()).collect()
    });
    let (vectors, _) = kernel(&field, n, rows).ok()?;
    sought.count = vectors.len();
    for vector in vectors {
        // a coordinate in no bracket
        if let [(place, _)] = *vector {
            let coordinate = Polynomial::variable(place);
            sought.found.push(Casimir::Polynomial(coordinate));
        } else if let Some(casimir) = powers(form, &vector) {
            sought.found.push(casimir);
        } else if let Some(casimir) = logarithms(model, form, &vector, graph) {
            sought.functions.push(casimir);
        } else {
            sought.end = Search::Singular;
        }
    }
    Some(sought)
}

/// `prod_i a_i^k_i`, the k made integers; none where they are none, or large.
fn powers(form: &Elementwise, vector: &Sparse<Fraction>) -> Option<Casimir> {
    let numbers = vector.iter().map(|(i, k)| Some((*i, k.as_constant()?)));
    let numbers: Vec<(usize, Rational)> = numbers.collect::<Option<_>>()?;
    let whole = |factor: i64| {
        let scaled = numbers.iter().map(|(i, k)| {
            let scaled = (k * &Rational::from(factor)).to_integer();
            Some((*i, scaled.filter(|k| k.abs() <= MOST)?))
        });
        scaled.collect::<Option<Vec<(usize, i64)>>>()
    };
    let mut exponents = (1..=MOST).find_map(whole)?;
    if exponents.first().is_some_and(|(_, k)| *k < 0) {
        exponents.iter_mut().for_each(|(_, k)| *k = -*k);
    }
    let bases = exponents
        .into_iter()
        .map(|(i, k)| Some((form.speeds[i].polynomial(i, form.speeds.len())?, k)));
    let powers: Vec<(Polynomial, i64)> = bases.collect::<Option<_>>()?;
    let plain = |(base, _): &(Polynomial, i64)| base.terms().len() == 1;
    if powers.iter().any(|(_, k)| *k < 0) || !powers.iter().all(plain) {
        return Some(Casimir::Rational(powers));
    }
    let budget = Budget::new(WORK);
    let mut product = Polynomial::constant(Rational::ONE);
    for (base, k) in powers {
        let power = base.pow(u32::try_from(k).ok()?, &budget).ok()?;
        product = product.mul(&power, &budget).ok()?;
    }
    Some(Casimir::Polynomial(product))
}

/// `sum_i k_i y_i` without denominators in the k, with `log a_i` or `log(-a_i)` for a linear `a_i`, whichever has a value at the initial state: no
/// `a_i` changes its sign. None where one is zero there.
fn logarithms(
    model: &Model,
    form: &Elementwise,
    vector: &Sparse<Fraction>,
    graph: &mut Graph,
) -> Option<ExprId> {
    let n = form.speeds.len();
    let budget = Budget::new(WORK);
    let marked = vector
        .iter()
        .map(|(i, k)| (Monomial::power(*i, 1), k.clone()));
    let whole = cleared(&marked.collect::<Vec<_>>(), n, &budget).ok()?;
    let parameters = model.defaults();
    let initial = model.initial_values(&parameters);
    let mut terms = Vec::new();
    for (i, _) in vector {
        let x = graph.symbol(Symbol::Coordinate(*i));
        let speed = &form.speeds[*i];
        let y = if speed.degree() == 0 {
            x
        } else {
            let base = speed.at(x, graph);
            let there = |initial: &Vec<f64>| {
                graph.evaluate(base, &|symbol| match symbol {
                    Symbol::Coordinate(i) => initial[i],
                    Symbol::Parameter(p) => parameters[p],
                    _ => f64::NAN,
                })
            };
            let sign = match initial.as_ref().map(there) {
                Some(value) if value < 0.0 => Rational::MINUS_ONE,
                Some(value) if value.is_nan() || value == 0.0 => return None,
                _ => Rational::ONE,
            };
            let base = graph.scale(base, &sign);
            graph.call(Elementary::Log, &[base])
        };
        for (monomial, coefficient) in whole.terms() {
            if monomial.powers().any(|(v, _)| v == *i) {
                let parameters = monomial.powers().filter(|(v, _)| *v >= n);
                let factors = parameters.map(|(v, e)| {
                    let parameter = graph.symbol(Symbol::Parameter(v - n));
                    (parameter, Rational::from(i64::from(e)))
                });
                let mut factors: Vec<(ExprId, Rational)> = factors.collect();
                factors.push((y, Rational::ONE));
                terms.push((graph.power_product(&factors), coefficient.clone()));
            }
        }
    }
    Some(graph.linear(&terms))
}
