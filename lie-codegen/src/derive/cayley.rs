//! The retraction method with the Cayley map, unknown the momentum m at the midpoint:
//! `r(m) = m - ad*_x m/2 - Q_x m/4 - mu`, `x = h grad H(m)`, `(Q_x m)_b = T_abc^d x^a x^c m_d`.
//!
//! With `y = x/2` the factors vanish: `r = m - ad*_y m - Q_y m - mu`.

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

/// `factor * h grad H(m)`: entries that vary stay one quantity each and are defined, the others
/// are prepared constants.
fn direction(source: &mut Source, m: &[ExprId], factor: &Rational) -> (Vec<ExprId>, Vec<(Symbol, ExprId)>) {
    let h = source.graph.symbol(Symbol::Step);
    let gradient = source.gradient_of_h();
    let gradient = source.at(&gradient, m);
    let mut x = source.block(Block::Xi);
    let mut definitions = Vec::new();
    for (i, symbol) in source.symbols(Block::Xi).into_iter().enumerate() {
        let value = source.graph.mul(h, gradient[i]);
        let value = source.graph.scale(value, factor);
        if source.graph.symbols(value).iter().any(|s| matches!(s, Symbol::Input(_))) {
            definitions.push((symbol, value));
        } else {
            x[i] = value;
        }
    }
    (x, definitions)
}

pub(super) fn kernels(source: &mut Source) -> Vec<Kernel> {
    let n = source.dimension;
    let start = source.coordinates();
    let m = source.block(Block::Unknown);
    let h = source.graph.symbol(Symbol::Step);
    let hessian = source.hessian_of_h();
    let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
    let (y, definitions) = direction(source, &m, &half);
    let action = source.ad_star_of(&y, &m);
    let square = triple_of(source, &y, &y, &m);
    let residual: Vec<ExprId> = (0..n)
        .map(|i| {
            source.graph.linear(&[
                (m[i], Rational::ONE),
                (action[i], Rational::MINUS_ONE),
                (square[i], Rational::MINUS_ONE),
                (start[i], Rational::MINUS_ONE),
            ])
        })
        .collect();
    let (m_symbols, y_symbols) = (source.symbols(Block::Unknown), source.symbols(Block::Xi));
    let mut rows = Vec::with_capacity(n);
    for r in &residual {
        // dr/dm_j = (partial in m_j) + sum_a (dr/dy_a) (h/2) H''_aj
        let through: Vec<ExprId> = y_symbols.iter().map(|s| source.graph.derivative(*r, *s)).collect();
        let mut row = Vec::with_capacity(n);
        for (j, symbol) in m_symbols.iter().enumerate() {
            let mut terms = vec![(source.graph.derivative(*r, *symbol), Rational::ONE)];
            for (a, slope) in through.iter().enumerate() {
                if source.graph.is_zero(*slope) || source.graph.is_zero(hessian[a][j]) {
                    continue;
                }
                let curvature = source.at(&[hessian[a][j]], &m)[0];
                terms.push((source.graph.product(&[*slope, h, curvature]), half.clone()));
            }
            row.push(source.graph.linear(&terms));
        }
        rows.push(row);
    }
    let (x, whole) = direction(source, &m, &Rational::ONE);
    let moved = source.ad_star_of(&x, &m);
    let result: Vec<ExprId> = (0..n).map(|i| source.graph.add(start[i], moved[i])).collect();
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
        .within_step(definitions),
        Kernel::vector(graph, "result", "`mu1 = mu + ad*_x m`, `x = h grad H(m)`", arguments, &result)
            .within_step(whole),
    ]
}
