//! The retraction method with the Cayley map, unknown the momentum m at the midpoint:
//! `r(m) = m - ad*_x m/2 - Q_x m/4 - mu`, `x = h grad H(m)`, `(Q_x m)_b = T_abc^d x^a x^c m_d`.
//!
//! `ad*_x m` is `h f(m)`, whose terms collect better than those of x, and with `y = x/2` the other
//! factor vanishes: `r = m - (h/2) f(m) - Q_y m - mu`, `mu1 = mu + h f(m)`.

use super::coadjoint::xi;
use super::field::mu;
use super::{Argument, Block, Kernel, Source};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Symbol};

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
    for (a, b, c, d, value) in source.triple.clone().unwrap_or_default() {
        let term = source.graph.product(&[x[a], z[c], m[d]]);
        terms[b].push((term, value));
    }
    terms
        .into_iter()
        .map(|terms| source.graph.linear(&terms))
        .collect()
}

/// `y = (h/2) grad H(m)`: entries that vary stay one quantity each and are defined, the others
/// are prepared constants.
fn direction(
    source: &mut Source,
    m: &[ExprId],
    half_step: ExprId,
) -> (Vec<ExprId>, Vec<(Symbol, ExprId)>) {
    let gradient = source.gradient_of_h();
    let gradient = source.at(&gradient, m);
    let mut y = source.block(Block::Xi);
    let mut definitions = Vec::new();
    for (i, symbol) in source.symbols(Block::Xi).into_iter().enumerate() {
        let value = source.graph.mul(half_step, gradient[i]);
        if source
            .graph
            .symbols(value)
            .iter()
            .any(|s| matches!(s, Symbol::Input(_)))
        {
            definitions.push((symbol, value));
        } else {
            y[i] = value;
        }
    }
    (y, definitions)
}

pub(super) fn kernels(source: &mut Source) -> Vec<Kernel> {
    let n = source.dimension;
    let start = source.coordinates();
    let m = source.block(Block::Unknown);
    let h = source.graph.symbol(Symbol::Step);
    let half_step = source
        .graph
        .scale(h, &Rational::new(1, 2).unwrap_or(Rational::ONE));
    let hessian = source.hessian_of_h();
    let field = source.field_of_h();
    let field = source.at(&field, &m);
    let (y, definitions) = direction(source, &m, half_step);
    let square = triple_of(source, &y, &y, &m);
    let residual: Vec<ExprId> = (0..n)
        .map(|i| {
            let moved = source.graph.mul(half_step, field[i]);
            source.graph.linear(&[
                (m[i], Rational::ONE),
                (moved, Rational::MINUS_ONE),
                (square[i], Rational::MINUS_ONE),
                (start[i], Rational::MINUS_ONE),
            ])
        })
        .collect();
    let rows = (0..n)
        .map(|i| jacobian_row(source, residual[i], &hessian, half_step))
        .collect::<Vec<_>>();
    let result: Vec<ExprId> = (0..n)
        .map(|i| {
            let moved = source.graph.mul(h, field[i]);
            source.graph.add(start[i], moved)
        })
        .collect();
    let m_symbols = source.symbols(Block::Unknown);
    let arguments = vec![
        mu(source),
        Argument {
            name: "unknown",
            symbols: m_symbols,
        },
    ];
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
        Kernel::vector(
            graph,
            "result",
            "`mu1 = mu + ad*_x m = mu + h f(m)`",
            arguments,
            &result,
        )
        .within_step(Vec::new()),
    ]
}

/// `dr/dm_j = (partial in m_j) + sum_a (dr/dy_a) (h/2) H''_aj`
fn jacobian_row(
    source: &mut Source,
    r: ExprId,
    hessian: &[Vec<ExprId>],
    half_step: ExprId,
) -> Vec<ExprId> {
    let m = source.block(Block::Unknown);
    let (m_symbols, y_symbols) = (source.symbols(Block::Unknown), source.symbols(Block::Xi));
    let through: Vec<ExprId> = y_symbols
        .iter()
        .map(|s| source.graph.derivative(r, *s))
        .collect();
    let mut row = Vec::with_capacity(m.len());
    for (j, symbol) in m_symbols.iter().enumerate() {
        let mut terms = vec![source.graph.derivative(r, *symbol)];
        for (a, slope) in through.iter().enumerate() {
            if source.graph.is_zero(*slope) || source.graph.is_zero(hessian[a][j]) {
                continue;
            }
            let curvature = source.at(&[hessian[a][j]], &m)[0];
            terms.push(source.graph.product(&[*slope, half_step, curvature]));
        }
        row.push(source.graph.sum(&terms));
    }
    row
}
