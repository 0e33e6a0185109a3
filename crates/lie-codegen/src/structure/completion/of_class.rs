//! Casimirs of brackets that are declared by their entries, where the class of the bracket says what they are.

use super::Sought;
use crate::model::Model;
use crate::structure::bracket_class::jacobian;
use crate::structure::bracket_class::multiple::casimir;
use crate::structure::casimirs::solve::{Functions, Sparse, cleared, kernel};
use crate::structure::casimirs::{Casimir, WORK};
use crate::structure::completion::Search;
use crate::structure::elementwise::{Elementwise, Speed, at_start, elementwise, half};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Polynomial, Rational};
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Symbol};

/// The largest exponent in a product of powers.
const MOST: i64 = 60;

/// The Casimirs of a bracket of a class, or else the coordinates that are in no bracket, and then why no others are looked for. The graph may be
/// littered.
pub(super) fn sought(model: &Model, reason: &'static str, graph: &mut Graph) -> Option<Sought> {
    let matrix = model.own_matrix();
    let matrix = &matrix.filter(|_| !model.is_almost_poisson())?;
    let moves = |i: &usize| matrix.entries.iter().any(|(a, b, _)| i == a || i == b);
    let alone = (0..matrix.dimension).filter(|i| !moves(i));
    let alone: Vec<Casimir> = alone
        .map(|i| Casimir::Polynomial(Polynomial::variable(i)))
        .collect();
    let beside = |end| Sought {
        found: alone.clone(),
        functions: Vec::new(),
        count: model.casimirs_to_find(),
        dimension: matrix.dimension,
        end,
    };
    if let Some(form) = elementwise(model, matrix, graph) {
        let found = of_changed_coordinates(model, &form, beside(Search::Complete), graph);
        return Some(found.unwrap_or_else(|_| beside(Search::Spent)));
    }
    // those of an affine bracket are looked for as of an algebra
    let affine = matrix.degree.is_some_and(|degree| degree <= 1);
    let of_three = jacobian(model, matrix, graph)
        .or_else(|| (!affine).then(|| casimir(model, matrix, graph)).flatten());
    if let Some(casimir) = of_three {
        return Some(Sought {
            functions: vec![casimir],
            ..beside(Search::Complete)
        });
    }
    (!alone.is_empty()).then(|| beside(Search::None(reason)))
}

/// Those of `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`: `sum_i k_i y_i` with `y_i = int dx_i/a_i` and `c k = 0`. Where all `y_i` are logarithms and the
/// `k_i` are integers, these are products of powers of the `a_i`, which have a value whatever the signs.
fn of_changed_coordinates(
    model: &Model,
    form: &Elementwise,
    mut sought: Sought,
    graph: &mut Graph,
) -> Result<Sought, Exhausted> {
    let n = form.speeds.len();
    let budget = Budget::new(WORK);
    let field = Functions { budget: &budget };
    let rows = form.constants.iter().map(|row| -> Sparse<Fraction> {
        let entries = row.iter().cloned().enumerate();
        entries.filter(|(_, c)| !c.is_zero()).collect()
    });
    let (vectors, _) = kernel(&field, n, rows)?;
    // those of one entry are coordinates in no bracket, which are there
    for vector in vectors.into_iter().filter(|vector| vector.len() > 1) {
        if let Some(casimir) = powers(form, &vector) {
            sought.found.push(casimir);
        } else if let Some(casimir) = logarithms(model, form, &vector, graph)? {
            sought.functions.push(casimir);
        } else {
            sought.end = Search::Singular;
        }
    }
    Ok(sought)
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

/// `sum_i k_i y_i` without denominators in the k, with `log(a_i^2)/2` for a linear `a_i`, which has a value on both of its sides. None where one has
/// no value at the initial state.
fn logarithms(
    model: &Model,
    form: &Elementwise,
    vector: &Sparse<Fraction>,
    graph: &mut Graph,
) -> Result<Option<ExprId>, Exhausted> {
    let n = form.speeds.len();
    let budget = Budget::new(WORK);
    let marked = vector
        .iter()
        .map(|(i, k)| (Monomial::power(*i, 1), k.clone()));
    let whole = cleared(&marked.collect::<Vec<_>>(), n, &budget)?;
    let mut terms = Vec::new();
    for (i, _) in vector {
        let (y, factor) = match &form.speeds[*i] {
            Speed::Other(closed) => (closed.integral, Rational::ONE),
            speed if speed.is_constant() => (graph.symbol(Symbol::Coordinate(*i)), Rational::ONE),
            speed => {
                let base = speed.at(*i, graph);
                let square = graph.pow(base, &Rational::from(2));
                (graph.call(Elementary::Log, &[square]), half())
            }
        };
        if at_start(model, graph, y).is_some_and(|value| !value.is_finite()) {
            return Ok(None);
        }
        for (monomial, coefficient) in whole.terms() {
            if monomial.powers().any(|(v, _)| v == *i) {
                let parameters = monomial.powers().filter(|(v, _)| *v >= n);
                let factors = parameters.map(|(v, e)| {
                    let parameter = graph.symbol(Symbol::Parameter(v - n));
                    (parameter, Rational::from(i64::from(e)))
                });
                let mut factors: Vec<(ExprId, Rational)> = factors.collect();
                factors.push((y, Rational::ONE));
                terms.push((graph.power_product(&factors), coefficient * &factor));
            }
        }
    }
    Ok(Some(graph.linear(&terms)))
}
