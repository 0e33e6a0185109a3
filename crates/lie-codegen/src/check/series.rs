//! Laurent series of expressions in the step size, exactly: `x_i` stands for `h xi_i`.

use crate::model::{ENTRIES, InEntries};
use std::collections::HashMap;

use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Function, Graph, Node, Symbol};

/// Work allowed for one decision of the normal form.
const WORK: u64 = 500_000;
/// Coefficients of a series.
const TERMS: usize = 6;
/// Series begin at smaller powers than this.
const FARTHEST: u64 = 1 << 32;
/// The largest arena that the coefficients may fill.
const MOST: usize = 300_000;
/// A symbol that no expression contains.
const PLACE: Symbol = Symbol::Input(usize::MAX);

/// `sum_k coefficients[k] h^(start + k)`, and terms of higher order that are not known.
#[derive(Clone, Debug)]
pub struct Series {
    /// The lowest power.
    start: i64,
    coefficients: Vec<ExprId>,
}

impl Series {
    /// The coefficient of a power of h; `None` beyond the ones that are known.
    pub fn coefficient(&self, graph: &mut Graph, power: i64) -> Option<ExprId> {
        let place = power - self.start;
        if place < 0 {
            return Some(graph.integer(0));
        }
        self.coefficients.get(usize::try_from(place).ok()?).copied()
    }

    /// The lowest power.
    pub fn start(&self) -> i64 {
        self.start
    }

    /// The power of which the coefficient is not known any more.
    fn end(&self) -> i64 {
        self.start + self.coefficients.len() as i64
    }

    fn monomial(graph: &mut Graph, start: i64, value: ExprId) -> Self {
        let mut coefficients = vec![graph.integer(0); TERMS];
        coefficients[0] = value;
        Self {
            start,
            coefficients,
        }
    }

    fn sum(graph: &mut Graph, parts: &[(Self, Rational)]) -> Option<Self> {
        let start = parts.iter().map(|(s, _)| s.start).min()?;
        let end = parts.iter().map(|(s, _)| s.end()).min()?;
        let coefficients = (start..end).map(|power| {
            let terms = parts.iter().filter_map(|(series, factor)| {
                let value = series.coefficient(graph, power)?;
                Some((value, factor.clone()))
            });
            let terms: Vec<(ExprId, Rational)> = terms.collect();
            graph.linear(&terms)
        });
        Some(Self {
            start,
            coefficients: coefficients.collect(),
        })
    }

    fn mul(graph: &mut Graph, a: &Self, b: &Self) -> Self {
        let count = a.coefficients.len().min(b.coefficients.len());
        let coefficients = (0..count).map(|n| {
            let products: Vec<ExprId> = (0..=n)
                .map(|k| graph.mul(a.coefficients[k], b.coefficients[n - k]))
                .collect();
            graph.sum(&products)
        });
        Self {
            start: a.start + b.start,
            coefficients: coefficients.collect(),
        }
    }

    /// Without leading coefficients that are zero.
    fn stripped(mut self, graph: &Graph) -> Option<Self> {
        let budget = Budget::new(WORK);
        let mut normal = NormalForm::new(graph, &budget);
        let mut vanishes =
            |id: &ExprId| graph.is_zero(*id) || matches!(normal.verdict(*id), Verdict::Zero);
        let zeros = self
            .coefficients
            .iter()
            .take_while(|id| vanishes(id))
            .count();
        self.coefficients.drain(..zeros);
        self.start += zeros as i64;
        (!self.coefficients.is_empty()).then_some(self)
    }

    /// A power: with the leading coefficient a and `(1 + u)^e = sum_n p_n h^n`,
    /// `p_n = sum_k (k e - (n - k)) u_k p_(n-k)/n`.
    fn pow(self, graph: &mut Graph, exponent: &Rational) -> Option<Self> {
        let base = self.stripped(graph)?;
        let start = &Rational::from(base.start) * exponent;
        let start = start
            .to_integer()
            .filter(|start| start.unsigned_abs() < FARTHEST)?;
        let leading = base.coefficients[0];
        let inverse = graph.pow(leading, &Rational::MINUS_ONE);
        let rest: Vec<ExprId> = base
            .coefficients
            .iter()
            .map(|&c| graph.mul(c, inverse))
            .collect();
        let mut powers = vec![graph.integer(1)];
        for n in 1..rest.len() {
            let terms: Vec<(ExprId, Rational)> = (1..=n)
                .map(|k| {
                    let (n, k) = (Rational::from(n as i64), k as i64);
                    let weight = &(&Rational::from(k) * exponent) - &(&n - &Rational::from(k));
                    let product = graph.mul(rest[k as usize], powers[powers.len() - k as usize]);
                    (product, &weight / &n)
                })
                .collect();
            powers.push(graph.linear(&terms));
        }
        let factor = graph.pow(leading, exponent);
        let coefficients = powers.iter().map(|&p| graph.mul(factor, p)).collect();
        Some(Self {
            start,
            coefficients,
        })
    }

    /// A function of one argument by its Taylor series at the constant term.
    fn apply(&self, graph: &mut Graph, function: Function) -> Option<Self> {
        if self.start < 0 {
            return None;
        }
        let center = self.coefficient(graph, 0)?;
        let minus = graph.neg(center);
        let center_series = Self::monomial(graph, 0, minus);
        let one = Rational::ONE;
        let rest = Self::sum(
            graph,
            &[(self.clone(), one.clone()), (center_series, one.clone())],
        )?;
        let place = graph.symbol(PLACE);
        let mut derivative = graph.call(function, &[place]);
        let unit = graph.integer(1);
        let mut power = Self::monomial(graph, 0, unit);
        let mut parts = Vec::new();
        let mut weight = one;
        for k in 0..rest.end().max(1) {
            if k > 0 {
                derivative = graph.derivative(derivative, PLACE);
                weight = &weight / &Rational::from(k);
                power = Self::mul(graph, &power, &rest);
            }
            let at = |symbol| (symbol == PLACE).then_some(center);
            let value = graph.substitute(&[derivative], &at)[0];
            let value = Self::monomial(graph, 0, value);
            parts.push((Self::mul(graph, &value, &power), weight.clone()));
        }
        Self::sum(graph, &parts)
    }
}

/// The series of an expression in h, x and entries of the group element; `None` where it has none, or none that is found.
pub fn in_step(
    graph: &mut Graph,
    expression: ExprId,
    in_entries: Option<&InEntries>,
) -> Option<Series> {
    let entries = in_entries.map(|written| written.series(graph, TERMS));
    let entries = entries.unwrap_or_default();
    let mut known: HashMap<ExprId, Series> = HashMap::new();
    for id in graph.dependencies(&[expression]) {
        let series = match graph.node(id).clone() {
            Node::Number(_) | Node::Pi => Series::monomial(graph, 0, id),
            Node::Symbol(Symbol::Step) => {
                let one = graph.integer(1);
                Series::monomial(graph, 1, one)
            }
            Node::Symbol(Symbol::Input(i)) if i >= ENTRIES => Series {
                start: 1,
                coefficients: entries.get(i - ENTRIES)?.clone(),
            },
            Node::Symbol(Symbol::Input(_)) => Series::monomial(graph, 1, id),
            Node::Symbol(_) => Series::monomial(graph, 0, id),
            Node::Written(terms) => {
                let parts: Option<Vec<_>> = terms
                    .iter()
                    .map(|(term, factor)| Some((known.get(term)?.clone(), factor.clone())))
                    .collect();
                Series::sum(graph, &parts?)?
            }
            Node::Sum { constant, terms } => {
                let constant = graph.number(constant);
                let mut parts = vec![(Series::monomial(graph, 0, constant), Rational::ONE)];
                if graph.is_zero(constant) {
                    parts.clear();
                }
                for (term, factor) in &terms {
                    parts.push((known.get(term)?.clone(), factor.clone()));
                }
                Series::sum(graph, &parts)?
            }
            Node::Product(factors) => {
                let mut product: Option<Series> = None;
                for (base, exponent) in &factors {
                    let factor = Series::pow(known.get(base)?.clone(), graph, exponent)?;
                    product = Some(match product {
                        Some(product) => Series::mul(graph, &product, &factor),
                        None => factor,
                    });
                }
                product?
            }
            Node::Call(function, arguments) => match &*arguments {
                [argument] => Series::apply(known.get(argument)?, graph, function)?,
                _ => return None,
            },
        };
        if graph.size() > MOST {
            return None;
        }
        known.insert(id, series);
    }
    known.remove(&expression)
}
