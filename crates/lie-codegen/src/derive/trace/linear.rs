//! Unknowns that are solved for outside the iteration: few that depend on each other linearly, on which nothing in it depends.

use std::collections::BTreeSet;

use super::explicit_unknowns::{Formulas, List, symbols};
use crate::derive::Source;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// The most unknowns that are solved for together, by the determinant of their matrix.
const MOST: usize = 3;

/// Unknowns v whose residuals are `A v + b`.
#[derive(Debug)]
pub(super) struct Group {
    members: Vec<usize>,
    matrix: Vec<Vec<ExprId>>,
    constant: Vec<ExprId>,
}

impl Group {
    /// The indices of the unknowns.
    pub fn members(&self) -> impl Iterator<Item = usize> + '_ {
        self.members.iter().copied()
    }

    /// Whether it has an unknown.
    pub fn holds(&self, unknown: usize) -> bool {
        self.members.contains(&unknown)
    }

    /// `v = -A^-1 b` by Cramer's rule, with `value` put into A and b.
    pub fn solved(
        &self,
        source: &mut Source,
        value: &dyn Fn(&mut Source, ExprId) -> ExprId,
    ) -> Formulas {
        let mut put = |entry: &ExprId| value(source, *entry);
        let a: Vec<Vec<ExprId>> = self
            .matrix
            .iter()
            .map(|row| row.iter().map(&mut put).collect())
            .collect();
        let b: Vec<ExprId> = self.constant.iter().map(put).collect();
        let all: Vec<usize> = (0..b.len()).collect();
        let determinant = minor(source, &a, &all, &all);
        let one = source.graph.integer(1);
        let inverse = source.graph.div(one, determinant);
        let solve = |(column, member): (usize, &usize)| {
            let mut sum = source.graph.integer(0);
            for (row, entry) in b.iter().enumerate() {
                let without = |left: usize| all.iter().copied().filter(move |k| *k != left);
                let rows: Vec<usize> = without(row).collect();
                let columns: Vec<usize> = without(column).collect();
                let cofactor = minor(source, &a, &rows, &columns);
                let term = source.graph.mul(cofactor, *entry);
                sum = match (row + column) % 2 {
                    0 => source.graph.sub(sum, term),
                    _ => source.graph.add(sum, term),
                };
            }
            (*member, source.graph.mul(inverse, sum))
        };
        self.members.iter().enumerate().map(solve).collect()
    }
}

/// The determinant of some rows and columns, by the first row; one of none.
fn minor(source: &mut Source, a: &[Vec<ExprId>], rows: &[usize], columns: &[usize]) -> ExprId {
    let Some((row, others)) = rows.split_first() else {
        return source.graph.integer(1);
    };
    let mut sum = source.graph.integer(0);
    for (place, column) in columns.iter().enumerate() {
        let left: Vec<usize> = columns.iter().copied().filter(|k| k != column).collect();
        let minor = minor(source, a, others, &left);
        let term = source.graph.mul(a[*row][*column], minor);
        sum = match place % 2 {
            0 => source.graph.add(sum, term),
            _ => source.graph.sub(sum, term),
        };
    }
    sum
}

/// The groups among some unknowns on which no residual of the others depends, each before those that it depends on.
pub(super) fn groups(
    source: &mut Source,
    list: &[(Symbol, ExprId)],
    residual: &[ExprId],
    rows: &[Vec<ExprId>],
    among: &[usize],
    unknown: &[Symbol],
) -> Vec<Group> {
    let zero = source.graph.integer(0);
    let depends = |i: usize, j: usize| rows[i][j] != zero;
    let mut left = connected(among, &depends);
    let mut found: Vec<Group> = Vec::new();
    loop {
        let apart = |i: usize| found.iter().any(|group| group.holds(i));
        let needed = |members: &[usize]| {
            let others = among.iter().filter(|i| !members.contains(i) && !apart(**i));
            let mut others = others.copied();
            others.any(|i| members.iter().any(|j| depends(i, *j)))
        };
        let next = left
            .iter()
            .position(|members| members.len() <= MOST && !needed(members));
        let Some(next) = next else { return found };
        let members = left.swap_remove(next);
        found.extend(linear(source, list, residual, unknown, members));
    }
}

/// The unknowns that depend on each other, directly or not, in ascending order.
fn connected(among: &[usize], depends: &dyn Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let count = among.len();
    let mut reach: Vec<Vec<bool>> = among
        .iter()
        .map(|i| among.iter().map(|j| i == j || depends(*i, *j)).collect())
        .collect();
    for middle in 0..count {
        let through = reach[middle].clone();
        for row in reach.iter_mut().filter(|row| row[middle]) {
            row.iter_mut().zip(&through).for_each(|(to, by)| *to |= by);
        }
    }
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut taken = vec![false; count];
    for i in 0..count {
        if !taken[i] {
            let part: Vec<usize> = (i..count)
                .filter(|j| reach[i][*j] && reach[*j][i])
                .collect();
            part.iter().for_each(|j| taken[*j] = true);
            parts.push(part.into_iter().map(|j| among[j]).collect());
        }
    }
    parts
}

/// The residuals of some unknowns as `A v + b`, where they are that.
fn linear(
    source: &mut Source,
    list: &[(Symbol, ExprId)],
    residual: &[ExprId],
    unknown: &[Symbol],
    members: Vec<usize>,
) -> Option<Group> {
    let own: BTreeSet<Symbol> = members.iter().map(|j| unknown[*j]).collect();
    let values: Vec<ExprId> = members.iter().map(|j| residual[*j]).collect();
    let values = inlined(source, list, &own, &values);
    let zero = source.graph.integer(0);
    let mut matrix = Vec::new();
    for value in &values {
        let row = members
            .iter()
            .map(|j| source.graph.derivative(*value, unknown[*j]));
        matrix.push(row.collect::<Vec<_>>());
    }
    let entries: Vec<ExprId> = matrix.iter().flatten().copied().collect();
    let used = symbols(source, list, &entries);
    if own.iter().any(|symbol| used.contains(symbol)) {
        return None;
    }
    let constant = source
        .graph
        .substitute(&values, &|symbol| own.contains(&symbol).then_some(zero));
    Some(Group {
        members,
        matrix,
        constant,
    })
}

/// Values with the definitions put in that depend on some symbols.
fn inlined(
    source: &mut Source,
    list: &[(Symbol, ExprId)],
    symbols: &BTreeSet<Symbol>,
    values: &[ExprId],
) -> Vec<ExprId> {
    let mut inside = List::new();
    let put = |source: &mut Source, inside: &List, values: &[ExprId]| {
        let place = |symbol: Symbol| {
            let known = inside.iter().find(|(defined, _)| *defined == symbol);
            known.map(|(_, value)| *value)
        };
        source.graph.substitute(values, &place)
    };
    for (symbol, value) in list {
        let value = put(source, &inside, &[*value])[0];
        if !source.graph.symbols(value).is_disjoint(symbols) {
            inside.push((*symbol, value));
        }
    }
    put(source, &inside, values)
}
