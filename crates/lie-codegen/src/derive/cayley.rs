//! The triple product `(abc + cba)/2 = T_abc^d` of a closed representation, paired with momenta.

use super::coadjoint::xi;
use super::field::mu;
use super::{Argument, Block, Kernel, Source};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::ExprId;

/// `out_b = T_abc^d x^a z^c mu_d`
pub(super) fn triple(source: &mut Source) -> Kernel {
    let (x, z, m) = (
        source.block(Block::Xi),
        source.block(Block::Eta),
        source.coordinates(),
    );
    let product = triple_of(source, &x, &z, &m);
    let eta = Argument {
        name: "eta",
        symbols: source.symbols(Block::Eta),
    };
    let arguments = vec![xi(source), eta, mu(source)];
    Kernel::vector(
        &source.graph,
        "triple",
        "`out_b = T_abc^d xi^a eta^c mu_d`, with `(abc + cba)/2 = T_abc^d` in the representation",
        arguments,
        &product,
    )
}

pub(super) fn triple_of(
    source: &mut Source,
    x: &[ExprId],
    z: &[ExprId],
    m: &[ExprId],
) -> Vec<ExprId> {
    let mut terms: Vec<Vec<(ExprId, Rational)>> = vec![Vec::new(); source.dimension];
    for (a, b, c, d, value) in source.triple().unwrap_or_default().to_vec() {
        let mut factors = vec![x[a], z[c], m[d]];
        let constant = value.as_constant().unwrap_or_else(|| {
            factors.push(source.graph.rational_function(&value));
            Rational::ONE
        });
        terms[b].push((source.graph.product(&factors), constant));
    }
    terms
        .into_iter()
        .map(|terms| source.graph.linear(&terms))
        .collect()
}
