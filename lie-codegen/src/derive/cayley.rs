//! The retraction method with the Cayley map, unknown the momentum m at the midpoint:
//! `r(m) = m - ad*_x m/2 - Q_x m/4 - mu`, `x = h grad H(m)`, `(Q_x m)_b = T_abc^d x^a x^c m_d`.

use super::coadjoint::xi;
use super::field::mu;
use super::{Argument, Block, Kernel, Source};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Symbol};

/// `out_b = T_abc^d x^a z^c mu_d`
pub(super) fn triple(source: &mut Source) -> Kernel {
    let (x, z, m) = (source.block(Block::Xi), source.block(Block::Eta), source.coordinates());
    let product = triple_of(source, &x, &z, &m);
    let eta = Argument { name: "eta", symbols: source.symbols(Block::Eta) };
    let arguments = vec![xi(source), eta, mu(source)];
    Kernel::vector(
        &source.graph,
        "triple",
        "`out_b = T_abc^d xi^a eta^c mu_d`, with `(abc + cba)/2 = T_abc^d` in the representation",
        arguments,
        &product,
    )
}

fn triple_of(source: &mut Source, x: &[ExprId], z: &[ExprId], m: &[ExprId]) -> Vec<ExprId> {
    let mut terms: Vec<Vec<(ExprId, Rational)>> = vec![Vec::new(); source.dimension];
    for (a, b, c, d, value) in source.triple.clone().unwrap_or_default() {
        let term = source.graph.product(&[x[a], z[c], m[d]]);
        terms[b].push((term, value));
    }
    terms.into_iter().map(|terms| source.graph.linear(&terms)).collect()
}

pub(super) fn kernels(source: &mut Source) -> Vec<Kernel> {
    let n = source.dimension;
    let start = source.coordinates();
    let m = source.block(Block::Unknown);
    let h = source.graph.symbol(Symbol::Step);
    let gradient = source.gradient_of_h();
    let gradient = source.at(&gradient, &m);
    let hessian = source.hessian_of_h();
    // Where h dH/dm_i does not vary it is a prepared constant, elsewhere it stays one quantity.
    let mut x = source.block(Block::Xi);
    let mut definitions = Vec::new();
    for (i, symbol) in source.symbols(Block::Xi).into_iter().enumerate() {
        let value = source.graph.mul(h, gradient[i]);
        if source.graph.symbols(value).iter().any(|s| matches!(s, Symbol::Input(_))) {
            definitions.push((symbol, value));
        } else {
            x[i] = value;
        }
    }
    let action = source.ad_star_of(&x, &m);
    let square = triple_of(source, &x, &x, &m);
    let (half, quarter) = (-&rational(1, 2), -&rational(1, 4));
    let residual: Vec<ExprId> = (0..n)
        .map(|i| {
            source.graph.linear(&[
                (m[i], Rational::ONE),
                (action[i], half.clone()),
                (square[i], quarter.clone()),
                (start[i], Rational::MINUS_ONE),
            ])
        })
        .collect();
    let result: Vec<ExprId> = (0..n).map(|i| source.graph.add(start[i], action[i])).collect();
    let (m_symbols, x_symbols) = (source.symbols(Block::Unknown), source.symbols(Block::Xi));
    let mut rows = Vec::with_capacity(n);
    for r in &residual {
        // dr/dm_j = (partial in m_j) + sum_a (dr/dx_a) h H''_aj
        let through: Vec<ExprId> = x_symbols.iter().map(|s| source.graph.derivative(*r, *s)).collect();
        let mut row = Vec::with_capacity(n);
        for (j, symbol) in m_symbols.iter().enumerate() {
            let mut terms = vec![source.graph.derivative(*r, *symbol)];
            for (a, slope) in through.iter().enumerate() {
                if source.graph.is_zero(*slope) || source.graph.is_zero(hessian[a][j]) {
                    continue;
                }
                let curvature = source.at(&[hessian[a][j]], &m)[0];
                terms.push(source.graph.product(&[*slope, h, curvature]));
            }
            row.push(source.graph.sum(&terms));
        }
        rows.push(row);
    }
    let arguments = vec![mu(source), Argument { name: "unknown", symbols: m_symbols }];
    let graph = &source.graph;
    vec![
        Kernel::vector(
            graph,
            "residual",
            "`r = m - ad*_x m/2 - Q_x m/4 - mu`, `x = h grad H(m)`",
            arguments.clone(),
            &residual,
        )
        .within_step(definitions.clone()),
        Kernel::fused(
            graph,
            "linearize",
            "`r = m - ad*_x m/2 - Q_x m/4 - mu`, `x = h grad H(m)`, and `dr/dm`",
            arguments.clone(),
            &residual,
            &rows,
        )
        .within_step(definitions.clone()),
        Kernel::vector(graph, "result", "`mu1 = mu + ad*_x m`, `x = h grad H(m)`", arguments, &result)
            .within_step(definitions),
    ]
}

fn rational(n: i64, d: i64) -> Rational {
    Rational::new(n, d).unwrap_or(Rational::ONE)
}
