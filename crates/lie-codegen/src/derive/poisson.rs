//! A Poisson matrix that was given entry by entry.

use super::coadjoint::xi;
use super::field::mu;
use super::{Block, Bracket, Kernel, Source};
use lie_symbolic::symbolic::ExprId;

/// The derivative against a fixed vector, of which that of a Lie algebra is `ad*_xi`.
pub(super) fn slope(source: &mut Source) -> Kernel {
    let rows = source.poisson_slope();
    Kernel::matrix(
        &source.graph,
        "poisson_slope",
        "`out_ij = d(Pi(mu) xi)_i/dmu_j`",
        vec![mu(source), xi(source)],
        &rows,
    )
}

/// The rows of the matrix.
pub(super) fn matrix(source: &mut Source, entries: &[(usize, usize, ExprId)]) -> Vec<Vec<ExprId>> {
    let n = source.dimension;
    let zero = source.graph.integer(0);
    let mut rows = vec![vec![zero; n]; n];
    for (i, j, value) in entries {
        rows[*i][*j] = *value;
        rows[*j][*i] = source.graph.neg(*value);
    }
    rows
}

impl Source {
    /// Whether the Poisson matrix is that of a Lie algebra alone.
    pub fn is_lie(&self) -> bool {
        matches!(self.bracket, Bracket::Lie(_))
    }

    /// `d(Pi(mu) xi)_i/dmu_j` for the vector xi of that block.
    pub(crate) fn poisson_slope(&mut self) -> Vec<Vec<ExprId>> {
        let (vector, mu) = (self.block(Block::Xi), self.coordinates());
        let image = self.poisson_times(&vector, &mu);
        self.jacobian_of(&image)
    }

    /// `Pi(point) xi`, of a Lie algebra `ad*_xi point`.
    pub(crate) fn poisson_times(&mut self, xi: &[ExprId], point: &[ExprId]) -> Vec<ExprId> {
        let Bracket::Entries(entries) = self.bracket.clone() else {
            return self.ad_star_of(xi, point);
        };
        let values: Vec<ExprId> = entries.iter().map(|(.., value)| *value).collect();
        let values = self.at_point(&values, point);
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for ((i, j, _), value) in entries.iter().zip(values) {
            terms[*i].push(self.graph.mul(value, xi[*j]));
            let product = self.graph.mul(value, xi[*i]);
            terms[*j].push(self.graph.neg(product));
        }
        let terms = terms.into_iter();
        terms.map(|terms| self.graph.sum(&terms)).collect()
    }
}
