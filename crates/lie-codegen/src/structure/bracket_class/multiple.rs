//! Brackets in three dimensions that are a function times a Jacobian one: `{f, g} = r <grad C, grad f x grad g>`.
//!
//! With `w = (Pi_23, Pi_31, Pi_12)` the Jacobi identity is `<w, curl w> = 0`, and C is a Casimir where `grad C` is parallel to w. Where
//! `g = prod_k p_k^e_k` makes `curl (g w) = 0`,
//!
//! ```math
//! \sum_k e_k\, \frac{\operatorname{grad} p_k \times w}{p_k} = -\operatorname{curl} w,
//! ```
//!
//! which is linear in the exponents. The `p_k` are coordinates and what the entries have as factors; the exponents follow from values at
//! points, C from g w term by term, and what was found is proven. A common factor of the entries is taken out first, whatever function it is.

use super::gradient_of;
use crate::model::{Model, PoissonMatrix};
use crate::structure::elementwise::{at_start, factors, vanish};
use crate::structure::found::additive;
use lie_symbolic::exact::matrix::solve;
use lie_symbolic::exact::{Budget, Fraction, Polynomial, Rational};
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Node, Symbol};

/// Work allowed for one bracket.
const WORK: u64 = 1_000_000;
/// The largest exponent.
const MOST: i64 = 20;
/// Points that are looked at, at the most.
const POINTS: i64 = 60;

/// The Casimir; none where it is not of this form, or has no value at the initial state.
pub(in crate::structure) fn casimir(
    model: &Model,
    matrix: &PoissonMatrix,
    graph: &mut Graph,
) -> Option<ExprId> {
    if matrix.dimension != 3 {
        return None;
    }
    let rows = matrix.rows(graph);
    let w = [rows[1][2], rows[2][0], rows[0][1]];
    let along = without_factors(&w, graph);
    let casimir = of_polynomials(model, &along, graph).or_else(|| {
        let without = without_functions(&along, graph)?;
        gradient_of(model, &without, graph)
    })?;
    let slopes: Vec<ExprId> = (0..3)
        .map(|i| graph.derivative(casimir, Symbol::Coordinate(i)))
        .collect();
    let differences = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let products = [graph.mul(slopes[i], w[j]), graph.mul(slopes[j], w[i])];
        graph.sub(products[0], products[1])
    });
    let has_value = at_start(model, graph, casimir).is_none_or(f64::is_finite);
    let moves = slopes.iter().any(|slope| !graph.is_zero(*slope));
    let budget = Budget::new(WORK);
    (has_value && moves && vanish(model, graph, &w, &differences, &budget)).then_some(casimir)
}

/// That of entries whose ratios are rational functions.
fn of_polynomials(model: &Model, w: &[ExprId; 3], graph: &mut Graph) -> Option<ExprId> {
    let budget = Budget::new(WORK);
    let space = Space {
        first: model.parameters.len(),
    };
    let entries = space.ratios(graph, w)?;
    let along = space.direction(&entries, &budget)?;
    let curl = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let one = along[j].derivative(space.first + i);
        &one - &along[i].derivative(space.first + j)
    });
    let factors = space.factors(entries.iter().chain(&along.clone().map(Fraction::from)));
    let exponents = space.exponents(&along, &curl, &factors, &budget)?;
    let mut integrable = along.map(Fraction::from);
    for (factor, exponent) in factors.iter().zip(exponents) {
        let power = Fraction::from(factor.clone());
        let power = power.pow(exponent, &budget).ok()??;
        for entry in &mut integrable {
            *entry = entry.mul(&power, &budget).ok()?;
        }
    }
    space.potential(&integrable, graph)
}

/// The entries without the sums that all of them have as a factor as they stand.
fn without_factors(w: &[ExprId; 3], graph: &mut Graph) -> [ExprId; 3] {
    let entries = w.iter().copied().filter(|entry| !graph.is_zero(*entry));
    let entries: Vec<ExprId> = entries.collect();
    let is_sum = |node: &Node| matches!(node, Node::Sum { .. });
    let inverse = inverse_of_common(&entries, is_sum, graph);
    w.map(|entry| graph.mul(entry, inverse))
}

/// The entries without the functions that are factors of every term of all of them.
fn without_functions(w: &[ExprId; 3], graph: &mut Graph) -> Option<[ExprId; 3]> {
    let mut all = Vec::new();
    for entry in w {
        let (constant, terms) = additive::collected(graph, *entry)?;
        if !constant.is_zero() {
            return None;
        }
        all.extend(terms);
    }
    let is_call = |node: &Node| matches!(node, Node::Call(..));
    let inverse = inverse_of_common(&all, is_call, graph);
    Some(w.map(|entry| {
        let product = graph.mul(entry, inverse);
        graph.normal(product)
    }))
}

/// 1 over the factors of such a kind that all of these have, with the same exponents.
fn inverse_of_common(all: &[ExprId], kind: fn(&Node) -> bool, graph: &mut Graph) -> ExprId {
    let mut common: Option<Vec<(ExprId, Rational)>> = None;
    for one in all {
        let (_, product) = graph.coefficient(*one);
        let mut own = factors(graph, product);
        own.retain(|(base, _)| kind(graph.node(*base)));
        if let Some(common) = &common {
            own.retain(|factor| common.contains(factor));
        }
        common = Some(own);
    }
    let mut common = common.unwrap_or_default();
    for (_, exponent) in &mut common {
        *exponent = -&*exponent;
    }
    graph.power_product(&common)
}

/// Rational functions of the parameters, and behind them of three coordinates.
struct Space {
    /// The variable that the first coordinate is.
    first: usize,
}

impl Space {
    /// The entries, or else their ratios to one of them.
    fn ratios(&self, graph: &mut Graph, w: &[ExprId; 3]) -> Option<[Fraction; 3]> {
        if let Some(entries) = self.fractions(graph, w) {
            return Some(entries);
        }
        let divisor = *w.iter().find(|entry| !graph.is_zero(**entry))?;
        let ratios = w.map(|entry| {
            let ratio = graph.div(entry, divisor);
            graph.normal(ratio)
        });
        self.fractions(graph, &ratios)
    }

    fn fractions(&self, graph: &mut Graph, w: &[ExprId; 3]) -> Option<[Fraction; 3]> {
        let variables: Vec<ExprId> = (0..3)
            .map(|i| graph.symbol(Symbol::Parameter(self.first + i)))
            .collect();
        let there = graph.substitute(w, &|symbol| match symbol {
            Symbol::Coordinate(i) => variables.get(i).copied(),
            _ => None,
        });
        let fractions = there.iter().map(|entry| graph.fraction(*entry, None));
        fractions.collect::<Option<Vec<_>>>()?.try_into().ok()
    }

    /// Polynomials without a common factor that have the ratios of these fractions.
    fn direction(&self, entries: &[Fraction; 3], budget: &Budget) -> Option<[Polynomial; 3]> {
        let mut whole = entries.clone();
        for entry in entries {
            for (factor, exponent) in entry.denominator() {
                let power = factor.pow(exponent, budget).ok()?;
                for other in &mut whole {
                    *other = other.mul(&Fraction::from(power.clone()), budget).ok()?;
                }
            }
        }
        let mut common = Polynomial::default();
        for entry in &whole {
            if entry.denominator().next().is_some() {
                return None;
            }
            common = common.gcd(entry.numerator(), budget).ok()?;
        }
        // nothing is divided by a parameter, which may be 0
        let parameters = (0..self.first).any(|p| common.contains(p));
        if parameters || common.is_zero() {
            common = Polynomial::constant(Rational::ONE);
        }
        let quotients = whole.each_ref().map(|entry| {
            let quotient = entry.numerator().divide_exactly(&common, budget);
            quotient.ok().flatten()
        });
        let [x, y, z] = quotients;
        Some([x?, y?, z?])
    }

    /// What g may be made of: the coordinates, denominators, and numerators without the monomials that divide them.
    fn factors<'a>(&self, entries: impl Iterator<Item = &'a Fraction>) -> Vec<Polynomial> {
        let mut found: Vec<Polynomial> = (0..3)
            .map(|i| Polynomial::variable(self.first + i))
            .collect();
        let mut others: Vec<Polynomial> = Vec::new();
        for entry in entries {
            others.extend(entry.denominator().map(|(factor, _)| factor.clone()));
            let numerator = entry.numerator();
            let stripped = numerator.strip(&numerator.monomial_content());
            others.extend(stripped.content().recip().map(|one| stripped.scale(&one)));
        }
        for factor in others {
            let moves = (0..3).any(|i| factor.contains(self.first + i));
            if moves && !found.contains(&factor) {
                found.push(factor);
            }
        }
        found
    }

    /// The exponents of factors, from values at points.
    fn exponents(
        &self,
        entries: &[Polynomial; 3],
        curl: &[Polynomial; 3],
        factors: &[Polynomial],
        budget: &Budget,
    ) -> Option<Vec<i32>> {
        let slopes = |value: &Polynomial| [0, 1, 2].map(|i| value.derivative(self.first + i));
        let slopes: Vec<[Polynomial; 3]> = factors.iter().map(slopes).collect();
        let (mut rows, mut right): (Vec<Vec<Rational>>, _) = (Vec::new(), Vec::new());
        for place in 0..POINTS {
            let point = |variable: usize| {
                let variable = variable as i64;
                let denominator = 3 + (place * 5 + variable) % 11;
                Rational::new(7 + 13 * variable + place * (variable + 2), denominator)
                    .unwrap_or(Rational::ONE)
            };
            let at_point = |values: &[Polynomial; 3]| {
                let values = values.each_ref();
                values.map(|value| value.evaluate(&point))
            };
            let columns = factors.iter().zip(&slopes).map(|(factor, slope)| {
                let inverse = factor.evaluate(&point).recip()?;
                let slope = slope.each_ref();
                Some(slope.map(|slope| &slope.evaluate(&point) * &inverse))
            });
            let columns: Option<Vec<[Rational; 3]>> = columns.collect();
            // not where a factor vanishes
            let Some(columns) = columns else {
                continue;
            };
            let (w, curl) = (at_point(entries), at_point(curl));
            for (axis, curl) in curl.into_iter().enumerate() {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let of = |slope: &[Rational; 3]| &(&slope[i] * &w[j]) - &(&slope[j] * &w[i]);
                rows.push(columns.iter().map(of).collect());
                right.push(-curl);
            }
            if rows.len() > 3 * factors.len() + 6 {
                break;
            }
        }
        // where several g make it vanish, what is free is 0, or else -1
        [0, -1].into_iter().find_map(|free| {
            let free = Rational::from(free);
            let rest = rows.iter().zip(&right).map(|(row, right)| {
                let given = row.iter().fold(Rational::ZERO, |sum, entry| &sum + entry);
                right - &(&given * &free)
            });
            let rest: Vec<Rational> = rest.collect();
            let found = solve(&rows, &rest, budget).ok()??;
            let whole = found.iter().map(|exponent| {
                let exponent = (exponent + &free)
                    .to_integer()
                    .filter(|e| e.abs() <= MOST)?;
                i32::try_from(exponent).ok()
            });
            whole.collect()
        })
    }

    /// The function whose gradient these are, if it is a sum of monomials, whose exponents may be negative, and of logarithms: of each
    /// component the terms without the coordinates before, integrated.
    fn potential(&self, gradient: &[Fraction], graph: &mut Graph) -> Option<ExprId> {
        let mut terms = Vec::new();
        for (i, slope) in gradient.iter().enumerate() {
            let mut below = [0; 3];
            for (factor, exponent) in slope.denominator() {
                let variable = (0..3).find(|k| *factor == Polynomial::variable(self.first + k));
                below[variable?] = i64::from(exponent);
            }
            for (monomial, coefficient) in slope.numerator().terms() {
                let exponent = |k: usize| i64::from(monomial.exponent(self.first + k)) - below[k];
                if (0..i).any(|k| exponent(k) != 0) {
                    continue;
                }
                let parameters = monomial.powers().filter(|(v, _)| *v < self.first);
                let mut factors: Vec<(ExprId, Rational)> = parameters
                    .map(|(v, e)| {
                        let parameter = graph.symbol(Symbol::Parameter(v));
                        (parameter, Rational::from(i64::from(e)))
                    })
                    .collect();
                for k in i + 1..3 {
                    let x = graph.symbol(Symbol::Coordinate(k));
                    factors.push((x, Rational::from(exponent(k))));
                }
                let x = graph.symbol(Symbol::Coordinate(i));
                let raised = Rational::from(exponent(i) + 1);
                let divisor = if raised.is_zero() {
                    let square = graph.pow(x, &Rational::from(2));
                    factors.push((graph.call(Elementary::Log, &[square]), Rational::ONE));
                    Rational::from(2)
                } else {
                    factors.push((x, raised.clone()));
                    raised
                };
                terms.push((graph.power_product(&factors), coefficient / &divisor));
            }
        }
        Some(graph.linear(&terms))
    }
}
