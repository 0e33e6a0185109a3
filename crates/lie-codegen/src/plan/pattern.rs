//! Which entries of a Jacobian can differ from those of the identity.

use std::collections::BTreeSet;

use super::planner::Planner;
use crate::derive::Bracket;
use crate::methods::{Gradient, Lift};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Rows and columns.
pub(super) type Pattern = Vec<(usize, usize)>;

impl Planner<'_> {
    fn nonzero(&self, rows: &[Vec<ExprId>]) -> Vec<Vec<bool>> {
        let varies = |entry: &ExprId| !self.source.graph.is_zero(*entry);
        rows.iter()
            .map(|row| row.iter().map(varies).collect())
            .collect()
    }

    /// Of the Hessian of H.
    pub(super) fn hessian_pattern(&mut self) -> Vec<Vec<bool>> {
        let hessian = self.source.hessian_of_h();
        self.nonzero(&hessian)
    }

    /// Of the Jacobian of the field.
    pub(super) fn field_pattern(&mut self) -> Pattern {
        let field = self.source.field();
        let slopes = self.source.jacobian_of(&field);
        places(&self.nonzero(&slopes))
    }

    /// Of `1 - d/dx[phi1(ad*_x) mu] S''` with the Hessian of S: what `ad*` reaches from `Pi S''`.
    pub(super) fn exp_pattern(&mut self, hessian: &[Vec<bool>]) -> Pattern {
        let n = self.source.dimension;
        let constants = self.source.all_constants();
        let mut reach: Vec<BTreeSet<usize>> = (0..n).map(|i| BTreeSet::from([i])).collect();
        loop {
            let before: usize = reach.iter().map(BTreeSet::len).sum();
            for &(_, j, k, _) in &constants {
                let further = reach[k].clone();
                reach[j].extend(further);
            }
            if reach.iter().map(BTreeSet::len).sum::<usize>() == before {
                break;
            }
        }
        let mut places = BTreeSet::new();
        for &(a, b, _, _) in &constants {
            for (i, reached) in reach.iter().enumerate() {
                if reached.contains(&b) {
                    let columns = (0..n).filter(|&j| hessian[a][j]);
                    places.extend(columns.map(|j| (i, j)));
                }
            }
        }
        places.into_iter().collect()
    }

    /// Of the derivative of a discrete gradient.
    pub(super) fn derivative_pattern(&mut self, gradient: Gradient) -> Vec<Vec<bool>> {
        let n = self.source.dimension;
        if gradient == Gradient::Gonzalez && !self.quadratic() {
            return vec![vec![true; n]; n];
        }
        self.hessian_pattern()
    }

    /// Of `1 - (h/2) d/dm[Pi(m) g] - h Pi(m) dg/du`, of an algebra with `ad*_g` in the middle.
    pub(super) fn step_pattern(&mut self, gradient: Gradient) -> Pattern {
        let n = self.source.dimension;
        let derivative = self.derivative_pattern(gradient);
        let of_h = self.source.gradient_of_h();
        let graph = &self.source.graph;
        let enters = |a: usize| gradient == Gradient::Gonzalez || !graph.is_zero(of_h[a]);
        let mut places = BTreeSet::new();
        match &self.source.bracket {
            Bracket::Lie(constants) => {
                for (i, j, k, _) in constants {
                    for (a, b) in [(*i, *j), (*j, *i)] {
                        if enters(a) {
                            places.insert((b, *k));
                        }
                        places.extend((0..n).filter(|j| derivative[a][*j]).map(|j| (b, j)));
                    }
                }
            }
            Bracket::Entries(entries) => {
                for (a, b, value) in entries {
                    let symbols = graph.symbols(*value);
                    let varies = |k: &usize| symbols.contains(&Symbol::Coordinate(*k));
                    for (row, column) in [(*a, *b), (*b, *a)] {
                        if enters(column) {
                            places.extend((0..n).filter(varies).map(|k| (row, k)));
                        }
                        places.extend((0..n).filter(|j| derivative[column][*j]).map(|j| (row, j)));
                    }
                }
            }
        }
        places.into_iter().collect()
    }

    /// Of `1 - R S''`: `R_il` with l < i is what the actions l+1 to i-1 move from `ad*_(e_l) m` to component i.
    pub(super) fn second_kind_pattern(&mut self, hessian: &[Vec<bool>]) -> Pattern {
        let n = self.source.dimension;
        let constants = self.source.all_constants();
        let moved = |action: usize, reached: &mut BTreeSet<usize>| loop {
            let before = reached.len();
            let further = constants
                .iter()
                .filter(|(i, _, k, _)| *i == action && reached.contains(k))
                .map(|(_, j, _, _)| *j)
                .collect::<Vec<_>>();
            reached.extend(further);
            if reached.len() == before {
                break;
            }
        };
        let mut places = BTreeSet::new();
        for (l, row) in hessian.iter().enumerate() {
            let mut reached: BTreeSet<usize> = constants
                .iter()
                .filter(|(i, ..)| *i == l)
                .map(|(_, j, _, _)| *j)
                .collect();
            for i in l + 1..n {
                if reached.contains(&i) {
                    let columns = (0..n).filter(|&j| row[j]);
                    places.extend(columns.map(|j| (i, j)));
                }
                moved(i, &mut reached);
            }
        }
        places.into_iter().collect()
    }

    /// Where `delta_ij - (dM_i/dx_j) h H''(m_j)` can differ from the identity: the columns on which a
    /// derivative of H depends; over the Hopf map a spin moves with its own derivatives alone.
    pub(super) fn momenta_pattern(&mut self, lift: Lift) -> Pattern {
        let n = self.source.dimension;
        let hessian = self.hessian_pattern();
        let spins = self.source.spins().unwrap_or_default();
        let moves = |row: usize, through: usize| {
            let both = |s: &crate::structure::spins::Spin| {
                s.coordinates.contains(&row) && s.coordinates.contains(&through)
            };
            lift == Lift::Representation || spins.iter().any(both)
        };
        let depends = |row: usize, column: usize| {
            let mut slopes = hessian.iter().enumerate();
            slopes.any(|(through, slopes)| moves(row, through) && slopes[column])
        };
        let all = (0..n).flat_map(|row| (0..n).map(move |column| (row, column)));
        all.filter(|(row, column)| depends(*row, *column)).collect()
    }
}

fn places(rows: &[Vec<bool>]) -> Pattern {
    let rows = rows.iter().enumerate();
    rows.flat_map(|(i, row)| {
        let columns = row.iter().enumerate().filter(|(_, varies)| **varies);
        columns.map(move |(j, _)| (i, j))
    })
    .collect()
}
