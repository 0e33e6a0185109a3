//! The spherical midpoint method: `r(u) = u - mu - h f(w)`, `w = rho s` with `s = mu + u` and the ratio
//! `rho = |mu|/|s|` of each spin; ratios and `1/s.s` are arguments.

use super::field::{jacobian, mu};
use super::tape::Tape;
use super::{Argument, Block, Kernel, Source};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Symbol};

pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let spins = source.spins.clone()?;
    let n = source.dimension;
    let first = 4 * n;
    let ratios: Vec<Symbol> = (first..first + 2 * spins.len())
        .map(Symbol::Input)
        .collect();
    let arguments = vec![
        mu(source),
        Argument {
            name: "unknown",
            symbols: source.symbols(Block::Unknown),
        },
        Argument {
            name: "ratios",
            symbols: ratios.clone(),
        },
    ];
    let mut tape = Tape::new(source, first + 2 * spins.len());
    let (start, unknown) = (source.coordinates(), source.block(Block::Unknown));
    let h = source.graph.symbol(Symbol::Step);
    let mut sums = Vec::new();
    for (mu, u) in start.iter().zip(&unknown) {
        let sum = source.graph.add(*mu, *u);
        sums.push(tape.define(source, sum));
    }
    let mut point = vec![h; n];
    for (index, spin) in spins.iter().enumerate() {
        let ratio = source.graph.symbol(ratios[2 * index]);
        for k in spin.coordinates {
            let entry = source.graph.mul(ratio, sums[k]);
            point[k] = tape.define(source, entry);
        }
    }
    let field = source.field_of_h();
    let slopes = jacobian(source, &field);
    let field = source.at(&field, &point);
    let residual: Vec<ExprId> = (0..n)
        .map(|i| {
            let moved = source.graph.mul(h, field[i]);
            source.graph.linear(&[
                (unknown[i], Rational::ONE),
                (start[i], Rational::MINUS_ONE),
                (moved, Rational::MINUS_ONE),
            ])
        })
        .collect();
    let plain = tape.definitions().to_vec();
    let mut rows = vec![vec![source.graph.integer(0); n]; n];
    for (index, spin) in spins.iter().enumerate() {
        let [ratio, inverse] = [0, 1].map(|k| source.graph.symbol(ratios[2 * index + k]));
        let factor = source.graph.mul(h, ratio);
        let factor = tape.define(source, factor);
        // s / s.s
        let mut scaled = Vec::new();
        for k in spin.coordinates {
            let entry = source.graph.mul(sums[k], inverse);
            scaled.push(tape.define(source, entry));
        }
        for (i, row) in rows.iter_mut().enumerate() {
            let slopes = source.at(&slopes[i], &point);
            let mut tangents = Vec::new();
            for k in spin.coordinates {
                let entry = source.graph.mul(factor, slopes[k]);
                tangents.push(tape.define(source, entry));
            }
            let terms: Vec<ExprId> = spin
                .coordinates
                .iter()
                .zip(&tangents)
                .map(|(k, tangent)| source.graph.mul(*tangent, sums[*k]))
                .collect();
            let along = source.graph.sum(&terms);
            let along = tape.define(source, along);
            for (position, k) in spin.coordinates.into_iter().enumerate() {
                let back = source.graph.mul(along, scaled[position]);
                let unit = source.graph.integer(i64::from(i == k));
                row[k] = source.graph.linear(&[
                    (unit, Rational::ONE),
                    (tangents[position], Rational::MINUS_ONE),
                    (back, Rational::ONE),
                ]);
            }
        }
    }
    let graph = &source.graph;
    Some(vec![
        Kernel::vector(
            graph,
            "residual",
            "`r = u - mu - h f(w)`, `w = rho s`, `s = mu + u`",
            arguments.clone(),
            &residual,
        )
        .within_step(plain),
        Kernel::fused(
            graph,
            "linearize",
            "`r = u - mu - h f(w)`, `w = rho s`, and `dr/du = 1 - h rho Df(w) (1 - s s^T/s.s)`",
            arguments,
            &residual,
            &rows,
        )
        .within_step(tape.definitions().to_vec()),
    ])
}
