//! The bracket and the coadjoint action in coordinates.

use super::field::mu;
use super::{Argument, Block, Kernel, Source};
use crate::symbolic::ExprId;

pub(super) fn xi(source: &Source) -> Argument {
    Argument {
        name: "xi",
        symbols: source.symbols(Block::Xi),
    }
}

pub(super) fn kernels(source: &mut Source) -> Vec<Kernel> {
    let eta = Argument {
        name: "eta",
        symbols: source.symbols(Block::Eta),
    };
    let (x, y, m) = (
        source.block(Block::Xi),
        source.block(Block::Eta),
        source.coordinates(),
    );
    let bracket = bracket(source, &x, &y);
    let action = source.ad_star_of(&x, &m);
    let matrix = matrix(source, &x);
    let graph = &source.graph;
    vec![
        Kernel::vector(
            graph,
            "ad",
            "`[xi, eta]`: `out^k = C_ij^k xi^i eta^j`",
            vec![xi(source), eta],
            &bracket,
        ),
        Kernel::vector(
            graph,
            "ad_star",
            "`ad*_xi mu = Pi(mu) xi`: `out_j = C_ij^k xi^i mu_k`",
            vec![xi(source), mu(source)],
            &action,
        ),
        Kernel::matrix(
            graph,
            "ad_star_matrix",
            "the matrix of `ad*_xi`: `out_jk = C_ij^k xi^i`",
            vec![xi(source)],
            &matrix,
        ),
    ]
}

fn bracket(source: &mut Source, x: &[ExprId], y: &[ExprId]) -> Vec<ExprId> {
    let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); source.dimension];
    for (i, j, k, value) in source.all_constants() {
        let term = source.graph.product(&[value, x[i], y[j]]);
        terms[k].push(term);
    }
    terms
        .into_iter()
        .map(|terms| source.graph.sum(&terms))
        .collect()
}

fn matrix(source: &mut Source, x: &[ExprId]) -> Vec<Vec<ExprId>> {
    let n = source.dimension;
    let zero = source.graph.integer(0);
    let mut rows = vec![vec![zero; n]; n];
    for (i, j, k, value) in source.all_constants() {
        let term = source.graph.mul(value, x[i]);
        rows[j][k] = source.graph.add(rows[j][k], term);
    }
    rows
}
