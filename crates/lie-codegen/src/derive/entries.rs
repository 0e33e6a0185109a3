//! A discrete Lagrangian in the entries of the group element, with its derivatives in the Cayley coordinates x.
//!
//! With `L_ab = dl_d/dg_ab`, `A = (1 - X/2)^-1 = 1 + D/2` and the matrices rho of the basis the chain rule gives
//!
//! ```math
//! \frac{d l_d}{d x_i} = \frac{\partial l_d}{\partial x_i} + \langle W, \rho_i \rangle, \qquad W = A^T L A^T
//! ```
//!
//! and in the second derivative, beside those of l_d along `T_i = A rho_i A`, the term
//! `<W, rho_i A rho_j + rho_j A rho_i>/2`. So what takes many operations, the matrices D and W, is computed once for
//! all derivatives. In `W = L + (D^T L + L D^T)/2 + D^T L D^T/4` the first term pairs to zero with antisymmetric matrices where L is
//! diagonal: near the identity the slope keeps its digits.

use super::{Block, Source};
use crate::algebra::cayley::{CayleyMap, MOST_BY_MINORS, combination};
use crate::model::{ENTRIES, InEntries};
use lie_symbolic::exact::Rational;
use lie_symbolic::schedule::{KnownSymbols, Task, schedule};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use std::collections::BTreeMap;

/// Derivatives that add more to the arena are not compared.
const MOST_DIRECT: usize = 20_000;

/// A function of x with its first two derivatives.
pub(super) struct Derivatives {
    pub(super) value: ExprId,
    pub(super) first: Vec<ExprId>,
    pub(super) second: Vec<Vec<ExprId>>,
}

/// The discrete Lagrangian that is written in entries.
///
/// Of small matrices the derivatives of the function of x itself may take fewer operations, since everything has one
/// denominator. Of both forms of each derivative the leaner one is taken.
pub(super) fn derivatives(source: &mut Source, written: &InEntries) -> Derivatives {
    let x = source.symbols(Block::Xi);
    let variables = source.block(Block::Xi);
    let graph = &mut source.graph;
    let size = written.size;
    let combined = combination(graph, &written.basis, &variables, size);
    let CayleyMap { off, inverse } = CayleyMap::new(graph, &written.basis, &combined, size);
    let basis = written.basis.iter().map(|matrix| {
        let places = (0..size).flat_map(|row| (0..size).map(move |column| (row, column)));
        let places = places.map(|(row, column)| (row, column, matrix[row][column].clone()));
        places.filter(|(.., value)| !value.is_zero()).collect()
    });
    let mut chain = Chain {
        size,
        basis: basis.collect(),
        off,
        inverse,
        entries: BTreeMap::new(),
        graph,
    };
    let mut found = chain.derivatives(written.value, &x);
    let first = match size <= MOST_BY_MINORS {
        true => direct(graph, &[found.value], &x),
        false => None,
    };
    let Some(first) = first else {
        return found;
    };
    if let Some(second) = direct(graph, &first, &x)
        && weight(graph, &second) < weight(graph, &found.second.concat())
    {
        let rows = second.chunks(x.len());
        found.second = rows.map(<[ExprId]>::to_vec).collect();
    }
    if weight(graph, &first) < weight(graph, &found.first) {
        found.first = first;
    }
    found
}

/// The derivatives of functions of x, one after the other; none where they swell.
fn direct(graph: &mut Graph, functions: &[ExprId], x: &[Symbol]) -> Option<Vec<ExprId>> {
    let most = graph.size() + MOST_DIRECT;
    let pairs = functions
        .iter()
        .flat_map(|f| x.iter().map(move |x| (*f, *x)));
    let pairs: Vec<(ExprId, Symbol)> = pairs.collect();
    let slopes = pairs.into_iter();
    slopes
        .map(|(f, x)| graph.derivative_within(f, x, most))
        .collect()
}

/// What it takes to compute these.
fn weight(graph: &mut Graph, outputs: &[ExprId]) -> usize {
    let task = Task {
        definitions: Vec::new(),
        outputs: outputs.to_vec(),
        known: KnownSymbols::Parameters,
    };
    schedule(graph, &task).counts.weight()
}

/// `1/n`
fn part(n: i64) -> Rational {
    Rational::new(1, n).unwrap_or(Rational::ONE)
}

/// A sum of products with numbers.
type Terms = Vec<(ExprId, Rational)>;

/// What the chain rule takes.
struct Chain<'a> {
    graph: &'a mut Graph,
    size: usize,
    /// The entries of the matrices that are not zero.
    basis: Vec<Vec<(usize, usize, Rational)>>,
    /// D.
    off: Vec<ExprId>,
    /// A.
    inverse: Vec<ExprId>,
    /// L, what is not zero of it, by the places of the entries.
    entries: BTreeMap<usize, ExprId>,
}

impl Chain<'_> {
    fn derivatives(&mut self, value: ExprId, x: &[Symbol]) -> Derivatives {
        let used = self.graph.symbols(value);
        let used = used.into_iter().filter_map(|symbol| match symbol {
            Symbol::Input(i) => i.checked_sub(ENTRIES).filter(|k| *k < self.off.len()),
            _ => None,
        });
        let used: Vec<usize> = used.collect();
        let entry = |k: &usize| Symbol::Input(ENTRIES + k);
        let slopes = used.iter().map(|k| self.graph.derivative(value, entry(k)));
        let slopes: Vec<ExprId> = slopes.collect();
        // along x alone, and the second derivatives, of which some are by x
        let alone: Vec<ExprId> = self.by(value, x);
        let alone_twice: Vec<Vec<ExprId>> = alone.iter().map(|f| self.by(*f, x)).collect();
        let mixed: Vec<Vec<ExprId>> = slopes.iter().map(|f| self.by(*f, x)).collect();
        let symbols: Vec<Symbol> = used.iter().map(entry).collect();
        let twice: Vec<Vec<ExprId>> = slopes.iter().map(|f| self.by(*f, &symbols)).collect();
        let here = |chain: &mut Self, all: &[ExprId]| {
            let off = &chain.off;
            chain.graph.substitute(all, &|symbol| match symbol {
                Symbol::Input(i) => i.checked_sub(ENTRIES).and_then(|k| off.get(k).copied()),
                _ => None,
            })
        };
        let value = here(self, &[value])[0];
        let slopes = here(self, &slopes);
        let alone = here(self, &alone);
        let rows = |chain: &mut Self, rows: Vec<Vec<ExprId>>| -> Vec<Vec<ExprId>> {
            rows.iter().map(|row| here(chain, row)).collect()
        };
        let (alone_twice, mixed, twice) = (
            rows(self, alone_twice),
            rows(self, mixed),
            rows(self, twice),
        );
        let nonzero = used.iter().copied().zip(slopes);
        self.entries = nonzero.filter(|(_, l)| !self.graph.is_zero(*l)).collect();
        let weights = self.weights();
        let first = self.first(&alone, &weights);
        let tangents = self.tangents(&used, &mixed, &twice);
        let second = self.second(&weights, &tangents, [&alone_twice, &mixed, &twice]);
        Derivatives {
            value,
            first,
            second,
        }
    }

    fn by(&mut self, function: ExprId, symbols: &[Symbol]) -> Vec<ExprId> {
        let symbols = symbols.iter();
        symbols
            .map(|symbol| self.graph.derivative(function, *symbol))
            .collect()
    }

    fn at(&self, row: usize, column: usize) -> Option<ExprId> {
        self.entries.get(&(row * self.size + column)).copied()
    }

    /// The terms of W, place by place.
    fn weights(&mut self) -> Vec<Terms> {
        let n = self.size;
        let mut left = Vec::with_capacity(n * n);
        for (c, b) in (0..n).flat_map(|c| (0..n).map(move |b| (c, b))) {
            let factors = (0..n).filter_map(|a| Some((self.off[a * n + c], self.at(a, b)?)));
            let factors: Vec<(ExprId, ExprId)> = factors.collect();
            left.push(self.sum_of_products(&factors));
        }
        let mut weights = Vec::with_capacity(n * n);
        for (c, d) in (0..n).flat_map(|c| (0..n).map(move |d| (c, d))) {
            let factors = (0..n).filter_map(|b| Some((self.at(c, b)?, self.off[d * n + b])));
            let factors: Vec<(ExprId, ExprId)> = factors.collect();
            let right = self.sum_of_products(&factors);
            let factors: Vec<(ExprId, ExprId)> = (0..n)
                .map(|b| (left[c * n + b], self.off[d * n + b]))
                .collect();
            let both = self.sum_of_products(&factors);
            let mut terms: Terms = self
                .at(c, d)
                .map(|l| (l, Rational::ONE))
                .into_iter()
                .collect();
            terms.extend([
                (left[c * n + d], part(2)),
                (right, part(2)),
                (both, part(4)),
            ]);
            terms.retain(|(term, _)| !self.graph.is_zero(*term));
            weights.push(terms);
        }
        weights
    }

    /// A sum of products, kept as a quantity.
    fn sum_of_products(&mut self, factors: &[(ExprId, ExprId)]) -> ExprId {
        let terms = factors
            .iter()
            .map(|(a, b)| (self.graph.mul(*a, *b), Rational::ONE));
        let terms: Terms = terms.collect();
        match terms.as_slice() {
            [(only, _)] => self.graph.written_product(*only),
            _ => self.graph.written_sum(&terms),
        }
    }

    fn first(&mut self, alone: &[ExprId], weights: &[Terms]) -> Vec<ExprId> {
        let mut slopes = Vec::with_capacity(alone.len());
        for (slope, matrix) in alone.iter().zip(&self.basis) {
            let mut terms = vec![(*slope, Rational::ONE)];
            for (row, column, value) in matrix {
                let weight = weights[row * self.size + column].iter();
                terms.extend(weight.map(|(term, c)| (*term, c * value)));
            }
            slopes.push(self.graph.linear(&terms));
        }
        slopes
    }

    /// The entries of `T_i = A rho_i A` along which l_d is not linear: by i, then by the place among those that are used.
    fn tangents(
        &mut self,
        used: &[usize],
        mixed: &[Vec<ExprId>],
        twice: &[Vec<ExprId>],
    ) -> Vec<Vec<ExprId>> {
        let n = self.size;
        let zero = self.graph.integer(0);
        let varies: Vec<bool> = mixed
            .iter()
            .zip(twice)
            .map(|(mixed, twice)| mixed.iter().chain(twice).any(|f| !self.graph.is_zero(*f)))
            .collect();
        let mut tangents = Vec::with_capacity(self.basis.len());
        for matrix in &self.basis {
            let mut along = Vec::with_capacity(used.len());
            for (k, varies) in used.iter().zip(&varies) {
                let (a, b) = (k / n, k % n);
                let terms = matrix.iter().filter(|_| *varies).map(|(c, d, value)| {
                    let product = self
                        .graph
                        .mul(self.inverse[a * n + c], self.inverse[d * n + b]);
                    (product, value.clone())
                });
                let terms: Terms = terms.collect();
                along.push(match terms.as_slice() {
                    [] => zero,
                    [(only, c)] => {
                        let scaled = self.graph.scale(*only, c);
                        self.graph.written_product(scaled)
                    }
                    _ => self.graph.written_sum(&terms),
                });
            }
            tangents.push(along);
        }
        tangents
    }

    fn second(
        &mut self,
        weights: &[Terms],
        tangents: &[Vec<ExprId>],
        [alone, mixed, twice]: [&[Vec<ExprId>]; 3],
    ) -> Vec<Vec<ExprId>> {
        let (n, count) = (self.size, tangents.len());
        let weights: Vec<ExprId> = weights
            .iter()
            .map(|terms| self.graph.written_sum(terms))
            .collect();
        // of l_d along T_j: sum_l l_kl T_j,l
        let mut bent = Vec::with_capacity(count);
        for along in tangents {
            let rows = twice.iter().map(|row| {
                let products = row.iter().zip(along).map(|(l, t)| self.graph.mul(*l, *t));
                let products: Vec<ExprId> = products.collect();
                self.graph.sum(&products)
            });
            bent.push(rows.collect::<Vec<ExprId>>());
        }
        let mut second = vec![vec![self.graph.integer(0); count]; count];
        for (i, j) in (0..count).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let mut terms: Terms = vec![(alone[i][j], Rational::ONE)];
            for (k, mixed) in mixed.iter().enumerate() {
                for (t, l) in [
                    (tangents[i][k], mixed[j]),
                    (tangents[j][k], mixed[i]),
                    (tangents[i][k], bent[j][k]),
                ] {
                    terms.push((self.graph.mul(t, l), Rational::ONE));
                }
            }
            for (left, right) in [(i, j), (j, i)] {
                for (c, p, v) in &self.basis[left] {
                    for (q, d, w) in &self.basis[right] {
                        let product = self.graph.mul(self.inverse[p * n + q], weights[c * n + d]);
                        terms.push((product, &(v * w) * &part(2)));
                    }
                }
            }
            let entry = self.graph.linear(&terms);
            (second[i][j], second[j][i]) = (entry, entry);
        }
        second
    }
}
