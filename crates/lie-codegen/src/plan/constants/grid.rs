//! Coefficients that belong together, on one grid.
//!
//! The field of a quadratic form has the entries of the form as coefficients, and their differences: `1/I1` and
//! `1/I3 - 1/I2`. The Casimirs are kept because linear combinations of these numbers vanish. Numbers that are rounded one by
//! one keep that to round-off only, and the same error in every step is a drift. So the entries are rounded to multiples of
//! one unit, that of the last place of the largest combination: every combination then is exact.
//!
//! Such relations are between terms with the same power of the step size. Where others stand in one sum, as `1 + h k/2` in an
//! elimination, the grid of the largest would take digits of the small ones, which are then lost in every step in the same way.

use std::collections::{BTreeMap, BTreeSet};

use lie_symbolic::exact::matrix::reduce;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::schedule::{KnownSymbols, Task};
use lie_symbolic::symbolic::{ExprId, Function, Graph, Node, Symbol};

/// Sums of more terms are left as they are.
const MOST_TERMS: usize = 8;
/// Combinations with larger integers are too.
const MOST_WEIGHT: i64 = 16;
/// What is smaller than the largest by more than this factor keeps its digits: the grid would take ten bits of it.
const SMALL: i64 = 1024;
/// The work to find the relations of one group of constants.
const WORK: u64 = 1_000_000;

/// A linear combination of expressions that are no sums.
type Combination = BTreeMap<ExprId, Rational>;

/// Constants that have terms in common.
struct Group {
    terms: Vec<ExprId>,
    /// The constants as combinations of terms, each with its position.
    members: Vec<(usize, Combination)>,
}

/// The factor of the terms of a group after which all combinations are of integers and powers of two, and a power of two that
/// no combination of terms up to 1 exceeds.
struct Scale {
    content: Rational,
    reach: i64,
}

/// What computes constants, those that belong together from terms on one grid.
pub(super) fn preparation(graph: &mut Graph, constants: &[ExprId]) -> Task {
    let mut task = Task {
        definitions: Vec::new(),
        outputs: constants.to_vec(),
        known: KnownSymbols::Nothing,
    };
    for group in groups(graph, constants) {
        let Some(scale) = group.scale() else { continue };
        let rounded = rounded(graph, &mut task.definitions, &group.terms, &scale);
        for (position, combination) in group.members {
            let terms: Vec<_> = combination
                .iter()
                .map(|(term, c)| (rounded[term], c / &scale.content))
                .collect();
            task.outputs[position] = graph.linear(&terms);
        }
    }
    task
}

/// The constants as combinations of terms, gathered by the terms that stand together in one of them.
fn groups(graph: &mut Graph, constants: &[ExprId]) -> Vec<Group> {
    let combinations: Vec<Option<Combination>> = constants
        .iter()
        .map(|constant| combination(graph, *constant))
        .collect();
    let mut groups: Vec<BTreeSet<ExprId>> = Vec::new();
    for combination in combinations.iter().flatten().filter(|c| c.len() > 1) {
        let mut all: BTreeSet<ExprId> = combination.keys().copied().collect();
        groups.retain(|group| {
            let apart = group.is_disjoint(&all);
            if !apart {
                all.extend(group);
            }
            apart
        });
        groups.push(all);
    }
    let group = |terms: BTreeSet<ExprId>| {
        let own = |c: &Combination| c.keys().next().is_some_and(|term| terms.contains(term));
        let members = combinations.iter().enumerate();
        let members = members.filter_map(|(position, c)| Some((position, c.clone().filter(own)?)));
        Group {
            members: members.collect(),
            terms: terms.into_iter().collect(),
        }
    };
    groups.into_iter().map(group).collect()
}

/// An expression with its products multiplied out; `None` if there are too many terms.
fn combination(graph: &mut Graph, id: ExprId) -> Option<Combination> {
    let mut found = Combination::new();
    let mut rest = vec![(graph.normal(id), Rational::ONE)];
    while let Some((id, factor)) = rest.pop() {
        let (parts, cofactor) = match graph.node(id).clone() {
            Node::Number(value) => {
                let one = graph.integer(1);
                add(&mut found, one, &(&factor * &value));
                continue;
            }
            Node::Sum { constant, terms } => (sum(graph, constant, &terms), None),
            Node::Product(factors) => {
                let inner = factors
                    .iter()
                    .enumerate()
                    .find_map(|(place, (base, power))| {
                        let node = power.is_one().then(|| graph.node(*base).clone());
                        match node {
                            Some(Node::Sum { constant, terms }) => Some((place, constant, terms)),
                            _ => None,
                        }
                    });
                let Some((place, constant, terms)) = inner else {
                    add(&mut found, id, &factor);
                    continue;
                };
                let mut factors = factors.to_vec();
                factors.remove(place);
                let cofactor = graph.power_product(&factors);
                (sum(graph, constant, &terms), Some(cofactor))
            }
            _ => {
                add(&mut found, id, &factor);
                continue;
            }
        };
        for (part, c) in parts {
            let part = cofactor.map_or(part, |cofactor| graph.mul(part, cofactor));
            rest.push((part, &factor * &c));
        }
        if rest.len() + found.len() > 2 * MOST_TERMS {
            return None;
        }
    }
    found.retain(|_, c| !c.is_zero());
    let mut powers = found.keys().map(|term| power_of_step(graph, *term));
    let power = powers.next().flatten()?;
    let alike = powers.all(|other| other.as_ref() == Some(&power));
    (alike && found.len() <= MOST_TERMS).then_some(found)
}

/// The power of the step size in a term, where it is a factor alone.
fn power_of_step(graph: &Graph, term: ExprId) -> Option<Rational> {
    let h = Symbol::Step;
    let mut power = Rational::ZERO;
    let alone = (term, Rational::ONE);
    let factors = match graph.node(term) {
        Node::Product(factors) => &factors[..],
        _ => std::slice::from_ref(&alone),
    };
    for (base, exponent) in factors {
        match graph.node(*base) {
            Node::Symbol(symbol) if *symbol == h => power = exponent.clone(),
            _ if graph.symbols(*base).contains(&h) => return None,
            _ => {}
        }
    }
    Some(power)
}

fn add(found: &mut Combination, term: ExprId, c: &Rational) {
    let entry = found.entry(term).or_insert(Rational::ZERO);
    *entry = &*entry + c;
}

fn sum(
    graph: &mut Graph,
    constant: Rational,
    terms: &[(ExprId, Rational)],
) -> Vec<(ExprId, Rational)> {
    let mut parts = terms.to_vec();
    if !constant.is_zero() {
        parts.push((graph.integer(1), constant));
    }
    parts
}

impl Group {
    /// `None` where no relation between the constants would be lost, and where integers are large.
    fn scale(&self) -> Option<Scale> {
        let all = self.members.iter().flat_map(|(_, c)| c.values());
        let (mut above, mut below) = (0_i64, 1_i64);
        for c in all {
            let (n, d) = c.to_words()?;
            let (n, d) = (odd(n.checked_abs()?), odd(d));
            above = num_integer::gcd(above, n);
            below = (below / num_integer::gcd(below, d)).checked_mul(d)?;
        }
        let content = Rational::new(above, below)?;
        let mut rows: BTreeSet<Vec<i64>> = BTreeSet::new();
        for (_, combination) in &self.members {
            rows.insert(self.integers(combination, &content)?);
        }
        let weight = |row: &Vec<i64>| {
            let positive: i64 = row.iter().filter(|n| **n > 0).sum();
            let negative: i64 = row.iter().filter(|n| **n < 0).sum();
            positive.max(-negative)
        };
        let reach = rows.iter().map(weight).max()?;
        let mut matrix: Vec<Vec<Rational>> = rows
            .iter()
            .map(|row| row.iter().map(|n| Rational::from(*n)).collect())
            .collect();
        let rank = reduce(&mut matrix, &Budget::new(WORK)).ok()?.len();
        (reach <= MOST_WEIGHT && rank < rows.len()).then(|| Scale {
            content,
            reach: reach.unsigned_abs().next_power_of_two().cast_signed(),
        })
    }

    /// The coefficients of all terms as integers that are not all even, the first positive; of a multiple of one term 1, since
    /// that is rounded by itself.
    fn integers(&self, combination: &Combination, content: &Rational) -> Option<Vec<i64>> {
        let parts = self.terms.iter().map(|term| match combination.get(term) {
            Some(c) => (c / content).to_words(),
            None => Some((0, 1)),
        });
        let parts: Vec<(i64, i64)> = parts.collect::<Option<_>>()?;
        let common = parts.iter().map(|(_, d)| *d).max()?;
        let whole = parts.iter().map(|(n, d)| n.checked_mul(common / d));
        let whole: Vec<i64> = whole.collect::<Option<_>>()?;
        let first = whole.iter().find(|n| **n != 0)?;
        let even = whole
            .iter()
            .filter(|n| **n != 0)
            .map(|n| n.trailing_zeros());
        let alone = whole.iter().filter(|n| **n != 0).count() == 1;
        let divisor = match alone {
            true => *first,
            false => (1_i64 << even.min()?) * first.signum(),
        };
        Some(whole.iter().map(|n| n / divisor).collect())
    }
}

/// The odd part of an integer that is not zero.
fn odd(n: i64) -> i64 {
    n >> n.trailing_zeros().min(63)
}

/// Definitions of the terms times the inverse of their content, rounded to a multiple of one unit.
fn rounded(
    graph: &mut Graph,
    definitions: &mut Vec<(Symbol, ExprId)>,
    terms: &[ExprId],
    scale: &Scale,
) -> BTreeMap<ExprId, ExprId> {
    let mut define = |graph: &mut Graph, value: ExprId| {
        let symbol = Symbol::Input(definitions.len());
        definitions.push((symbol, value));
        graph.symbol(symbol)
    };
    let zero = graph.integer(0);
    let below = |graph: &mut Graph, what, yes, no| graph.call(Function::Below, &[what, yes, no]);
    let mut values = Vec::new();
    for term in terms {
        let value = graph.scale(*term, &scale.content);
        values.push(define(graph, value));
    }
    // no combination is larger than the distance from the least to the largest, with 0 among them
    let (mut least, mut largest) = (zero, zero);
    for value in &values {
        let over = graph.sub(*value, largest);
        let larger = below(graph, over, largest, *value);
        largest = define(graph, larger);
        let under = graph.sub(*value, least);
        let smaller = below(graph, under, *value, least);
        least = define(graph, smaller);
    }
    let distance = graph.sub(largest, least);
    let twice = graph.scale(distance, &Rational::from(2 * scale.reach));
    let twice = define(graph, twice);
    let mut rounded = BTreeMap::new();
    for (term, value) in terms.iter().zip(values) {
        let minus = graph.neg(value);
        let size = below(graph, value, minus, value);
        let size = define(graph, size);
        // sizes up to half of `twice` are moved to where the distance of two numbers is the unit
        let moved = graph.sub(size, twice);
        let moved = define(graph, moved);
        let multiple = graph.add(moved, twice);
        let multiple = define(graph, multiple);
        let large = graph.scale(size, &Rational::from(2 * SMALL * scale.reach));
        let large = graph.sub(large, twice);
        let chosen = below(graph, large, size, multiple);
        let chosen = define(graph, chosen);
        let minus = graph.neg(chosen);
        let signed = below(graph, value, minus, chosen);
        rounded.insert(*term, define(graph, signed));
    }
    rounded
}

#[cfg(test)]
mod tests;
