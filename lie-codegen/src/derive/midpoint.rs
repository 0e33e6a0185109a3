//! The Poisson midpoint rule: `r(u) = u - mu - h f((mu + u)/2)`, unknown `u = mu1`.
//!
//! The sums `s = mu + u` stay one quantity each, and the factor 1/2 goes into the coefficients: of
//! a quadratic field, `h f(s/2) = (h/4) f(s)`, and its products are those of the Jacobian.

use super::field::{jacobian, mu};
use super::{Argument, Block, Kernel, Source};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Symbol};

pub(super) fn kernels(source: &mut Source) -> Vec<Kernel> {
    let arguments = vec![
        mu(source),
        Argument {
            name: "unknown",
            symbols: source.symbols(Block::Unknown),
        },
    ];
    let start = source.coordinates();
    let unknown = source.block(Block::Unknown);
    let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
    let middle: Vec<ExprId> = source
        .block(Block::Middle)
        .into_iter()
        .map(|s| source.graph.scale(s, &half))
        .collect();
    let field = source.field_of_h();
    let slopes = jacobian(source, &field);
    let definitions: Vec<(Symbol, ExprId)> = source
        .symbols(Block::Middle)
        .into_iter()
        .enumerate()
        .map(|(i, symbol)| (symbol, source.graph.add(start[i], unknown[i])))
        .collect();
    let h = source.graph.symbol(Symbol::Step);
    let field = source.at(&field, &middle);
    let residual: Vec<ExprId> = field
        .iter()
        .enumerate()
        .map(|(i, f)| {
            let moved = source.graph.mul(h, *f);
            source.graph.linear(&[
                (unknown[i], Rational::ONE),
                (start[i], Rational::MINUS_ONE),
                (moved, Rational::MINUS_ONE),
            ])
        })
        .collect();
    let rows: Vec<Vec<ExprId>> = slopes
        .iter()
        .enumerate()
        .map(|(i, row)| {
            let row = source.at(row, &middle);
            row.into_iter()
                .enumerate()
                .map(|(j, slope)| {
                    let moved = source.graph.mul(h, slope);
                    let unit = source.graph.integer(i64::from(i == j));
                    source
                        .graph
                        .linear(&[(unit, Rational::ONE), (moved, -&half)])
                })
                .collect()
        })
        .collect();
    let graph = &source.graph;
    vec![
        Kernel::vector(
            graph,
            "residual",
            "`r = u - mu - h f(m)`, `m = (mu + u)/2`",
            arguments.clone(),
            &residual,
        )
        .within_step(definitions.clone()),
        Kernel::fused(
            graph,
            "linearize",
            "`r = u - mu - h f(m)`, `m = (mu + u)/2`, and `dr/du = 1 - (h/2) Df(m)`",
            arguments,
            &residual,
            &rows,
        )
        .within_step(definitions),
    ]
}
