//! The bracket and the coadjoint action in coordinates.

use super::field::mu;
use super::{Argument, Block, Kernel, Source};

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
    let bracket = source.ad_of(&x, &y);
    let action = source.ad_star_of(&x, &m);
    let matrix = source.ad_star_matrix_of(&x);
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
