//! The discrete rigid body of Moser and Veselov: on SO(3) by the unit quaternion,
//! `r(u) = q0 u - (h/2) f(u) - mu` with `q0 = sqrt(1 - v.v)`, `v = (c h/2) grad H(u)`; on SO(n) by the Cayley map,
//! `r(U) = U - (1 - X/2) M (1 + X/2)` with `X = h grad H(U)`.

use super::field::{jacobian, mu};
use super::tape::Tape;
use super::{Argument, Block, Kernel, Source};
use crate::exact::Rational;
use crate::structure::inertia::Body;
use crate::symbolic::{ExprId, Symbol};

pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let half = Rational::new(1, 2)?;
    match source.body.clone()? {
        Body::Three => {
            let scale = source.spins.as_ref()?.first()?.scale;
            Some(three(source, scale, &half))
        }
        Body::Many { planes, .. } => Some(many(source, &planes, &half)),
    }
}

fn arguments(source: &Source) -> Vec<Argument> {
    vec![
        mu(source),
        Argument {
            name: "unknown",
            symbols: source.symbols(Block::Unknown),
        },
    ]
}

fn three(source: &mut Source, scale: ExprId, half: &Rational) -> Vec<Kernel> {
    let mut tape = Tape::new(source, 4 * source.dimension);
    let (start, unknown) = (source.coordinates(), source.block(Block::Unknown));
    let h = source.graph.symbol(Symbol::Step);
    let half_step = source.graph.scale(h, half);
    let turn = source.graph.mul(half_step, scale);
    let gradient = source.gradient_of_h();
    let gradient = source.at(&gradient, &unknown);
    let hessian = source.hessian_of_h();
    let field = source.field_of_h();
    let slopes = jacobian(source, &field);
    let field = source.at(&field, &unknown);
    let mut direction = Vec::new();
    let mut terms = vec![(source.graph.integer(1), Rational::ONE)];
    for slope in gradient {
        let entry = source.graph.mul(turn, slope);
        let entry = tape.define(source, entry);
        let square = source.graph.mul(entry, entry);
        terms.push((square, Rational::MINUS_ONE));
        direction.push(entry);
    }
    let square = source.graph.linear(&terms);
    let real = source.graph.pow(square, half);
    let real = tape.define(source, real);
    let residual: Vec<ExprId> = (0..3)
        .map(|i| {
            let turned = source.graph.mul(real, unknown[i]);
            let moved = source.graph.mul(half_step, field[i]);
            source.graph.linear(&[
                (turned, Rational::ONE),
                (moved, Rational::MINUS_ONE),
                (start[i], Rational::MINUS_ONE),
            ])
        })
        .collect();
    let plain = tape.definitions().to_vec();
    // q0' = -(v . V)/q0
    let inverse = source.graph.power_product(&[(real, Rational::MINUS_ONE)]);
    let inverse = tape.define(source, inverse);
    let mut loss = Vec::new();
    for j in 0..3 {
        let entry = source
            .graph
            .product(&[direction[j], turn, hessian[j][j], inverse]);
        loss.push(tape.define(source, entry));
    }
    let rows: Vec<Vec<ExprId>> = (0..3)
        .map(|i| {
            let slopes = source.at(&slopes[i], &unknown);
            (0..3)
                .map(|j| {
                    let lost = source.graph.mul(unknown[i], loss[j]);
                    let moved = source.graph.mul(half_step, slopes[j]);
                    let identity = Rational::from(i64::from(i == j));
                    source.graph.linear(&[
                        (real, identity),
                        (lost, Rational::MINUS_ONE),
                        (moved, Rational::MINUS_ONE),
                    ])
                })
                .collect()
        })
        .collect();
    both(
        source,
        "`r = q0 u - (h/2) f(u) - mu`, `q0 = sqrt(1 - v.v)`, `v = (c h/2) grad H(u)`",
        "`r = q0 u - (h/2) f(u) - mu`, and `dr/du = q0 - u (v^T V)/q0 - (h/2) Df(u)`, `V = (c h/2) H''`",
        (residual, plain),
        (rows, tape.definitions().to_vec()),
    )
}

fn many(source: &mut Source, planes: &[(usize, usize)], half: &Rational) -> Vec<Kernel> {
    let n = source.dimension;
    let size = planes.iter().map(|(i, j)| 1 + i.max(j)).max().unwrap_or(0);
    let mut tape = Tape::new(source, 4 * n);
    let (start, unknown) = (source.coordinates(), source.block(Block::Unknown));
    let h = source.graph.symbol(Symbol::Step);
    let half_step = source.graph.scale(h, half);
    let gradient = source.gradient_of_h();
    let gradient = source.at(&gradient, &unknown);
    let hessian = source.hessian_of_h();
    let zero = source.graph.integer(0);
    // M, and X/2
    let mut momentum = vec![vec![zero; size]; size];
    let mut rotation = vec![vec![zero; size]; size];
    for (k, &(from, to)) in planes.iter().enumerate() {
        let entry = source.graph.mul(half_step, gradient[k]);
        let entry = tape.define(source, entry);
        rotation[to][from] = entry;
        rotation[from][to] = source.graph.neg(entry);
        momentum[to][from] = start[k];
        momentum[from][to] = source.graph.neg(start[k]);
    }
    // Y = M + M X/2
    let mut product = vec![vec![zero; size]; size];
    for r in 0..size {
        for c in 0..size {
            let mut terms = vec![momentum[r][c]];
            for k in 0..size {
                terms.push(source.graph.mul(momentum[r][k], rotation[k][c]));
            }
            let sum = source.graph.sum(&terms);
            product[r][c] = tape.define(source, sum);
        }
    }
    let residual: Vec<ExprId> = planes
        .iter()
        .zip(&unknown)
        .map(|(&(from, to), &u)| {
            let mut terms = vec![(u, Rational::ONE), (product[to][from], Rational::MINUS_ONE)];
            for (k, row) in product.iter().enumerate() {
                let term = source.graph.mul(rotation[to][k], row[from]);
                terms.push((term, Rational::ONE));
            }
            source.graph.linear(&terms)
        })
        .collect();
    let definitions = tape.definitions().to_vec();
    let mut rows = Vec::new();
    for (row, &(q, p)) in planes.iter().enumerate() {
        let mut entries = Vec::new();
        for (column, &(b, a)) in planes.iter().enumerate() {
            // entry (p, q) of Y^T R + R Y, R = E_ab - E_ba
            let mut terms = Vec::new();
            if q == b {
                terms.push((product[a][p], Rational::ONE));
            }
            if q == a {
                terms.push((product[b][p], Rational::MINUS_ONE));
            }
            if p == a {
                terms.push((product[b][q], Rational::ONE));
            }
            if p == b {
                terms.push((product[a][q], Rational::MINUS_ONE));
            }
            let sum = source.graph.linear(&terms);
            let curvature = hessian[column][column];
            let slope = source.graph.product(&[half_step, curvature, sum]);
            let unit = source.graph.integer(i64::from(row == column));
            entries.push(source.graph.add(unit, slope));
        }
        rows.push(entries);
    }
    both(
        source,
        "`r = U - (1 - X/2) M (1 + X/2)`, `X = h grad H(U)`",
        "`r = U - (1 - X/2) M (1 + X/2)`, and the entries of `1 + (Y^T R + R Y)/2 h H''`, `Y = M (1 + X/2)`",
        (residual, definitions.clone()),
        (rows, definitions),
    )
}

type Definitions = Vec<(Symbol, ExprId)>;

fn both(
    source: &Source,
    formula: &'static str,
    derivative: &'static str,
    (residual, plain): (Vec<ExprId>, Definitions),
    (rows, all): (Vec<Vec<ExprId>>, Definitions),
) -> Vec<Kernel> {
    let arguments = arguments(source);
    let graph = &source.graph;
    vec![
        Kernel::vector(graph, "residual", formula, arguments.clone(), &residual).within_step(plain),
        Kernel::fused(graph, "linearize", derivative, arguments, &residual, &rows).within_step(all),
    ]
}
