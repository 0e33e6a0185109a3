//! Which points are looked at: some in the domain, on both sides of each branch where there are such.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use super::branches;
use crate::prove::sample::{Sample, Samples};
use crate::symbolic::{ExprId, Graph, Symbol};

/// Points at which expressions are evaluated in double precision.
const CANDIDATES: usize = 64;
/// Further ones where none of these is in the domain.
const MORE: usize = 512;
/// Points that are looked at, at most; of expressions of more than `LARGE` nodes fewer.
const POINTS: usize = 10;
const LARGE: usize = 4_000;
/// Points that are looked at even if they show nothing new.
const ENOUGH: usize = 3;

/// The candidates, with the values of expressions that were asked for.
pub(super) struct Points<'a> {
    graph: &'a Graph,
    samples: Vec<Sample>,
    values: Vec<HashMap<ExprId, f64>>,
}

impl<'a> Points<'a> {
    pub fn new(graph: &'a Graph) -> Self {
        Self {
            graph,
            samples: Vec::new(),
            values: Vec::new(),
        }
    }

    /// A point by its number.
    pub fn sample(&self, point: usize) -> Sample {
        self.samples[point]
    }

    /// The points for expressions that consist of these parts: those in the domain that reach a side of a branch
    /// that no earlier one reaches, and a few others.
    pub fn select(&mut self, roots: &[ExprId], parts: &[ExprId]) -> Vec<usize> {
        let graph = self.graph;
        let branches = branches(graph, parts);
        let most = if parts.len() > LARGE { ENOUGH } else { POINTS };
        let mut reached: HashSet<(ExprId, bool)> = HashSet::new();
        let mut chosen = Vec::new();
        // 2^20 nodes are evaluated at most
        let bound = (1 << 20) / parts.len().max(1);
        for point in 0..(CANDIDATES + MORE).min(bound.max(CANDIDATES)) {
            let complete = reached.len() == 2 * branches.len() && chosen.len() >= ENOUGH;
            if complete || chosen.len() == most || point >= CANDIDATES && !chosen.is_empty() {
                break;
            }
            self.evaluate(parts, point);
            let values = &self.values[point];
            let negative = |id: ExprId| Some(values[&id] < 0.0);
            let taken = match graph.has_choices() {
                true => Cow::from(graph.taken_dependencies(roots, &negative)),
                false => Cow::from(parts),
            };
            if !taken.iter().all(|id| values[id].is_finite()) {
                continue;
            }
            let sides = branches.iter().map(|id| (*id, values[id] > 0.0));
            let before = reached.len();
            reached.extend(sides);
            if reached.len() > before || chosen.len() < ENOUGH {
                chosen.push(point);
            }
        }
        chosen
    }

    fn evaluate(&mut self, parts: &[ExprId], point: usize) {
        while self.samples.len() <= point {
            let seeds = Samples::new().skip(self.samples.len());
            self.samples.extend(seeds.take(1));
            self.values.push(HashMap::new());
        }
        let (graph, sample) = (self.graph, self.samples[point]);
        let symbol = |symbol: Symbol| sample.value(graph, symbol);
        let known = &mut self.values[point];
        for &id in parts {
            if !known.contains_key(&id) {
                let value = graph.evaluate_node(id, &|part| known[&part], &symbol);
                known.insert(id, value);
            }
        }
    }
}
