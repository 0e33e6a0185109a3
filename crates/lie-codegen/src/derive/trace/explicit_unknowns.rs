//! What an iteration need not find: unknowns with a formula in the state before the step, and unknowns that nothing
//! in the iteration depends on, which have a formula in the others. Both are computed once, outside the iteration.
//!
//! Of the residual r of the unknowns u, `r_i = u_i - g_i(mu)` is of the first kind: central coordinates, or the time
//! where H depends on it. Of the second kind is `r_j = u_j - g_j(mu, u)` if no other residual depends on `u_j`: the
//! momentum conjugate to time, or for the exponential any coordinate in which H is linear and of constant coefficient, as
//! the direction of gravity is in the heavy top. So are up to three unknowns that depend on each other, `A v + b = 0` with A and b
//! functions of the others alone: a vector that H does not see ([`linear`](super::linear)).

use std::collections::{BTreeMap, BTreeSet};

use super::linear::{Group, groups};
use crate::derive::{Block, Source};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Definitions in order.
pub(super) type List = Vec<(Symbol, ExprId)>;

/// Formulas of unknowns, by their indices.
pub(super) type Formulas = BTreeMap<usize, ExprId>;

/// The formulas of the unknowns that are found outside the iteration.
#[derive(Debug)]
pub(super) struct ExplicitUnknowns {
    unknown: Vec<Symbol>,
    /// In the state.
    first: Formulas,
    /// In the state and the other unknowns.
    last: Formulas,
    /// What the formulas are made of, in order.
    head: List,
}

impl ExplicitUnknowns {
    /// Finds them, from a residual with its definitions and the Jacobian; `None` where there are none, or nothing else.
    pub fn find(
        source: &mut Source,
        list: &[(Symbol, ExprId)],
        residual: &[ExprId],
        rows: &[Vec<ExprId>],
    ) -> Option<Self> {
        let unknown = source.symbols(Block::Unknown);
        let mut apart = Self {
            unknown,
            first: Formulas::new(),
            last: Formulas::new(),
            head: Vec::new(),
        };
        let all = 0..residual.len();
        let (one, zero) = (source.graph.integer(1), source.graph.integer(0));
        let is = |i: usize, j: usize, value| rows[i][j] == value;
        loop {
            let before = apart.first.len();
            for i in all.clone().filter(|i| is(*i, *i, one)) {
                let known = |j: usize| j == i || is(i, j, zero) || apart.first.contains_key(&j);
                if !apart.first.contains_key(&i) && all.clone().all(known) {
                    apart.find_first(source, list, i, residual[i]);
                }
            }
            if apart.first.len() == before {
                break;
            }
        }
        let rest: Vec<usize> = all.filter(|j| !apart.first.contains_key(j)).collect();
        let groups = groups(source, list, residual, rows, &rest, &apart.unknown);
        apart.find_last(source, list, residual, groups);
        let found = apart.first.len() + apart.last.len();
        (found > 0 && found < residual.len()).then_some(apart)
    }

    /// Takes an unknown whose residual depends on none but it and those known before, unless its formula does where that
    /// cancels.
    fn find_first(
        &mut self,
        source: &mut Source,
        list: &[(Symbol, ExprId)],
        i: usize,
        residual: ExprId,
    ) {
        let list = self.list(source, list);
        let residual = self.value(source, residual);
        let formula = self.formula(source, i, residual);
        let symbols = symbols(source, &list, &[formula]);
        if self
            .unknown
            .iter()
            .all(|unknown| !symbols.contains(unknown))
        {
            self.take(source, &list, &[formula]);
            self.first.insert(i, formula);
        }
    }

    /// Takes what formulas are made of.
    fn take(&mut self, source: &Source, list: &[(Symbol, ExprId)], formulas: &[ExprId]) {
        for definition in source.needed(list, formulas) {
            if !self.head.contains(&definition) {
                self.head.push(definition);
            }
        }
    }

    /// Those of the groups on which the rest does not depend, even where it cancels. Each depends on those behind it at most.
    fn find_last(
        &mut self,
        source: &mut Source,
        list: &[(Symbol, ExprId)],
        residual: &[ExprId],
        mut groups: Vec<Group>,
    ) {
        loop {
            let apart = |i: &usize| groups.iter().any(|group| group.holds(*i));
            let iterated = |i: &usize| !self.first.contains_key(i) && !apart(i);
            let rest = (0..residual.len()).filter(iterated).map(|i| residual[i]);
            let used = symbols(source, list, &rest.collect::<Vec<_>>());
            let before = groups.len();
            groups.retain(|group| group.members().all(|j| !used.contains(&self.unknown[j])));
            if groups.len() == before {
                break;
            }
        }
        for group in groups.iter().rev() {
            let definitions = self.list(source, list);
            let formulas = group.solved(source, &|source, value| self.value(source, value));
            let values: Vec<ExprId> = formulas.values().copied().collect();
            self.take(source, &definitions, &values);
            self.last.extend(formulas);
        }
    }

    /// `u_i - r_i`
    fn formula(&self, source: &mut Source, i: usize, residual: ExprId) -> ExprId {
        let unknown = source.graph.symbol(self.unknown[i]);
        source.graph.sub(unknown, residual)
    }

    /// Whether the iteration leaves an unknown out.
    pub fn holds(&self, i: usize) -> bool {
        self.first.contains_key(&i) || self.last.contains_key(&i)
    }

    /// A value with the formulas in place of the unknowns.
    pub fn value(&self, source: &mut Source, value: ExprId) -> ExprId {
        let place = |symbol: Symbol| {
            let i = self.unknown.iter().position(|known| *known == symbol)?;
            self.first.get(&i).or_else(|| self.last.get(&i)).copied()
        };
        source.graph.substitute(&[value], &place)[0]
    }

    /// Definitions with the formulas in place of the unknowns: what those are made of comes first.
    pub fn list(&self, source: &mut Source, list: &[(Symbol, ExprId)]) -> List {
        let known: BTreeSet<Symbol> = self.head.iter().map(|(symbol, _)| *symbol).collect();
        let mut out = self.head.clone();
        for (symbol, value) in list.iter().filter(|(symbol, _)| !known.contains(symbol)) {
            out.push((*symbol, self.value(source, *value)));
        }
        out
    }

    /// All unknowns: those of the iteration as they are, the others by their formulas.
    pub fn completed(&self, source: &mut Source) -> Vec<ExprId> {
        let all = source.block(Block::Unknown).into_iter();
        all.map(|entry| self.value(source, entry)).collect()
    }
}

/// The symbols that values depend on, by definitions too.
pub(super) fn symbols(
    source: &Source,
    list: &[(Symbol, ExprId)],
    values: &[ExprId],
) -> BTreeSet<Symbol> {
    let needed = source.needed(list, values);
    let values = values.iter().chain(needed.iter().map(|(_, value)| value));
    values
        .flat_map(|value| source.graph.symbols(*value))
        .collect()
}
