//! Polynomials of the coordinates whose coefficients are rational functions of the parameters.

use std::collections::{BTreeMap, HashMap};

use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};

/// A polynomial of the coordinates with coefficients that are rational functions of the parameters.
pub type Function = BTreeMap<Monomial, Fraction>;

/// Expressions as polynomials of the coordinates; `None` where one is none.
pub fn functions(
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

/// `sum_j f_j dm/dmu_j` of a monomial m.
pub fn changed(
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
