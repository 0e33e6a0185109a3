//! Where the forms of a kernel are compared: points of ordinary size, of other units, of mixed sizes, and
//! points where a sum that somebody wrote nearly cancels, each of them and all together (a system near
//! equilibrium). The same task has the same points.

use rustc_hash::FxHashMap as HashMap;

use super::collect::Answers;
use super::formula::Formula;
use super::program::{Program, Value};
use super::{KnownSymbols, linearise};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Sums whose zeros are looked for.
const MOST_SUMS: usize = 16;
/// Symbols that are moved for one of them.
const MOST_TRIED: usize = 4;
/// Steps of the secant method.
const STEPS: usize = 12;
/// How near to the zero a point is, relative to the size of the terms.
const NEARNESS: f64 = 1.0 / (1 << 20) as f64;
/// The exponent of two by which parameters differ.
const MIXED: i32 = 16;
/// The exponent of two of a factor before which the other terms are small.
const LARGE: i32 = 40;
/// Exponents of two by which all quantities are scaled together.
const UNITS: [i32; 2] = [-10, 10];

/// The values of the symbols.
pub type Point = HashMap<Symbol, f64>;

/// The points for expressions in which the first roots define `symbols`.
pub fn points(graph: &mut Graph, symbols: &[Symbol], roots: &[ExprId]) -> Vec<Point> {
    let order = graph.dependencies(roots);
    let sums: Vec<Sum> = sums(graph, &order)
        .into_iter()
        .map(|(whole, terms)| {
            let factors = factors_of(graph, &order, whole);
            Sum::new(graph, symbols, roots, &terms, factors)
        })
        .collect();
    let mut scene = Scene {
        graph,
        definitions: symbols.iter().copied().zip(roots.iter().copied()).collect(),
        random: Random(2018),
    };
    let free: Vec<Symbol> = order
        .iter()
        .filter_map(|id| match graph.node(*id) {
            Node::Symbol(symbol) if !symbols.contains(symbol) => Some(*symbol),
            _ => None,
        })
        .collect();
    let mut points = Vec::new();
    for positive in [true, true, false, false] {
        points.push(scene.point(&free, positive, |_| 0));
    }
    for exponent in UNITS {
        points.push(scene.point(&free, true, |_| exponent));
    }
    for positive in [true, false, false] {
        points.push(scene.point(&free, positive, |random| random.within(-12, 12)));
    }
    for sum in &sums {
        points.extend(scene.cancelled(&free, sum));
    }
    if sums.len() > 1 {
        for mixed in [0, 0, MIXED, MIXED] {
            points.push(scene.at_rest(&free, &sums, mixed));
        }
    }
    for point in &mut points {
        scene.complete(point);
    }
    points
}

/// The terms of a sum with their coefficients.
type Terms = Vec<(ExprId, Rational)>;

/// The written sums among these expressions, short ones also up to each of their terms.
fn sums(graph: &Graph, order: &[ExprId]) -> Vec<(ExprId, Terms)> {
    let mut found = Vec::new();
    for id in order {
        if let Node::Written(terms) = graph.node(*id) {
            let lengths = if terms.len() > 4 {
                terms.len()..=terms.len()
            } else {
                2..=terms.len()
            };
            let lengths = lengths.filter(|n| *n > 1);
            found.extend(lengths.map(|n| (*id, terms[..n].to_vec())));
        }
        if found.len() >= MOST_SUMS {
            break;
        }
    }
    found
}

/// The parameters that are multiplied with a quantity.
fn factors_of(graph: &Graph, order: &[ExprId], quantity: ExprId) -> Vec<Symbol> {
    let mut found = Vec::new();
    for id in order {
        let Node::Product(factors) = graph.node(*id) else {
            continue;
        };
        if factors.iter().any(|(base, _)| *base == quantity) {
            found.extend(
                factors
                    .iter()
                    .filter_map(|(base, _)| match graph.node(*base) {
                        Node::Symbol(symbol @ Symbol::Parameter(_)) => Some(*symbol),
                        _ => None,
                    }),
            );
        }
    }
    found
}

struct Scene<'a> {
    graph: &'a Graph,
    definitions: Vec<(Symbol, ExprId)>,
    random: Random,
}

impl Scene<'_> {
    fn point(
        &mut self,
        free: &[Symbol],
        positive: bool,
        exponent: impl Fn(&mut Random) -> i32,
    ) -> Point {
        let mut point = Point::default();
        for symbol in free {
            let parameter = matches!(symbol, Symbol::Parameter(_) | Symbol::Step);
            let size = 0.5 + 1.5 * self.random.unit();
            let sign = if !positive && !parameter && self.random.unit() < 0.5 {
                -1.0
            } else {
                1.0
            };
            let exponent = exponent(&mut self.random);
            point.insert(*symbol, sign * size * libm::scalbn(1.0, exponent));
        }
        point
    }

    /// Points where a sum nearly cancels: with factors of ordinary size, and with large ones, before which
    /// the other terms are small.
    fn cancelled(&mut self, free: &[Symbol], sum: &Sum) -> Vec<Point> {
        let mut points = Vec::new();
        for (exponent, spread) in [(0, 0), (0, 3), (LARGE, 0), (LARGE, 3)] {
            for positive in [true, false] {
                let mut point = self.point(free, positive, |random| random.within(-spread, spread));
                for factor in &sum.factors {
                    if let Some(value) = point.get_mut(factor) {
                        *value *= libm::scalbn(1.0, exponent);
                    }
                }
                if sum.cancel(&mut point, &sum.factors).is_some() {
                    points.push(point);
                    break;
                }
            }
        }
        points
    }

    /// A point where as many sums as possible nearly cancel, one after the other by different symbols.
    fn at_rest(&mut self, free: &[Symbol], sums: &[Sum], mixed: i32) -> Point {
        let mut point = self.point(free, true, |_| 0);
        for symbol in free {
            if let Symbol::Parameter(_) = symbol {
                let exponent = self.random.within(-mixed, mixed);
                point
                    .entry(*symbol)
                    .and_modify(|v| *v *= libm::scalbn(1.0, exponent));
            }
        }
        let mut taken: Vec<Symbol> = sums.iter().flat_map(|sum| sum.factors.clone()).collect();
        for sum in sums {
            taken.extend(sum.cancel(&mut point, &taken));
        }
        point
    }

    /// Adds the values of the defined symbols.
    fn complete(&self, point: &mut Point) {
        for (symbol, definition) in &self.definitions {
            let value = self.graph.evaluate(*definition, &|s| at(point, s));
            point.insert(*symbol, value);
        }
    }
}

/// A sum whose zeros are looked for: its terms as a program.
struct Sum {
    program: Program,
    coefficients: Vec<f64>,
    /// The parameters that it is multiplied with.
    factors: Vec<Symbol>,
}

impl Sum {
    fn new(
        graph: &mut Graph,
        symbols: &[Symbol],
        roots: &[ExprId],
        terms: &[(ExprId, Rational)],
        factors: Vec<Symbol>,
    ) -> Self {
        let terms_only: Vec<ExprId> = terms.iter().map(|(term, _)| *term).collect();
        let (symbols, mut outputs) = needed(graph, symbols, roots, &terms_only);
        outputs.extend(terms_only);
        let formula = Formula::new(
            graph,
            &symbols,
            &outputs,
            KnownSymbols::Nothing,
            false,
            &mut Answers::default(),
        );
        Self {
            program: linearise::linearise(&formula),
            coefficients: terms.iter().map(|(_, c)| c.to_f64()).collect(),
            factors,
        }
    }

    /// The symbols that it depends on, coordinates before parameters.
    fn symbols(&self) -> Vec<Symbol> {
        let values = self.program.values();
        let mut symbols: Vec<Symbol> = values
            .filter_map(|value| match value {
                Value::Symbol(symbol) => Some(*symbol),
                _ => None,
            })
            .collect();
        symbols.sort_by_key(|s| (matches!(s, Symbol::Parameter(_) | Symbol::Step), *s));
        symbols.dedup();
        symbols
    }

    /// The value of the sum, and the size of its terms.
    fn value(&self, point: &Point) -> (f64, f64) {
        // pi is the only expression that is not taken apart
        let values = self
            .program
            .evaluate(&|s| at(point, s), &|_| std::f64::consts::PI);
        let terms = values.iter().zip(&self.coefficients).map(|(v, c)| v * c);
        terms.fold((0.0, 0.0), |(sum, size), term| {
            (sum + term, size + f64::abs(term))
        })
    }

    /// Moves one symbol so that the sum nearly cancels; returns it.
    fn cancel(&self, point: &mut Point, taken: &[Symbol]) -> Option<Symbol> {
        let symbols = self.symbols().into_iter();
        let mut symbols = symbols.filter(|s| !taken.contains(s)).take(MOST_TRIED);
        symbols.find(|symbol| {
            let start = at(point, *symbol);
            let found = self.solve(point, *symbol);
            if !found {
                point.insert(*symbol, start);
            }
            found
        })
    }

    fn solve(&self, point: &mut Point, symbol: Symbol) -> bool {
        let mut last = at(point, symbol);
        let (mut f_last, _) = self.value(point);
        let mut next = last * 1.0625;
        for _ in 0..STEPS {
            point.insert(symbol, next);
            let (f, size) = self.value(point);
            if f == f_last || !f.is_finite() {
                return false;
            }
            if f.abs() <= 1e-13 * size {
                point.insert(symbol, next * (1.0 + NEARNESS));
                let (f, size) = self.value(point);
                return f != 0.0 && f.abs() < 64.0 * NEARNESS * size;
            }
            let step = f * (next - last) / (f - f_last);
            (last, f_last) = (next, f);
            next -= step;
        }
        false
    }
}

/// The definitions that some expressions need, in their order.
fn needed(
    graph: &Graph,
    symbols: &[Symbol],
    roots: &[ExprId],
    expressions: &[ExprId],
) -> (Vec<Symbol>, Vec<ExprId>) {
    let mut reached = expressions.to_vec();
    let mut kept = Vec::new();
    // A definition may use the earlier ones.
    for (symbol, root) in symbols.iter().zip(roots).rev() {
        let uses = |id: &ExprId| graph.symbols(*id).contains(symbol);
        if reached.iter().any(uses) {
            reached.push(*root);
            kept.push((*symbol, *root));
        }
    }
    kept.into_iter().rev().unzip()
}

fn at(point: &Point, symbol: Symbol) -> f64 {
    point.get(&symbol).copied().unwrap_or(f64::NAN)
}

/// Steele, Lea, Flood (2014): SplitMix.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between 0 and 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, from: i32, to: i32) -> i32 {
        from + (self.unit() * f64::from(to - from + 1)) as i32
    }
}
