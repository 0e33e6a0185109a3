//! The map of a realization and its derivatives.

use super::coadjoint::xi;
use super::{Argument, Block, Kernel, Source};
use crate::model::CANONICAL;
use crate::symbolic::{ExprId, Symbol};

/// A map from canonical coordinates to the state.
#[derive(Clone, Debug)]
pub struct Realization {
    /// Names of the canonical coordinates.
    pub names: Vec<String>,
    /// The components, functions of the inputs from [`CANONICAL`] on.
    pub map: Vec<ExprId>,
    /// A point near which points over a state are sought.
    pub start: Vec<ExprId>,
    /// Whether the declaration gives it.
    pub given: bool,
    /// Whether Gauss methods over it are methods for the state.
    pub descends: bool,
}

fn points(count: usize, first: usize) -> Vec<Symbol> {
    (first..first + count)
        .map(|i| Symbol::Input(CANONICAL + i))
        .collect()
}

/// `momentum_map`, `pullback`, `pushforward` and `curvature`.
pub(super) fn kernels(source: &mut Source, realization: &Realization) -> Vec<Kernel> {
    let count = realization.names.len();
    let (z, v) = (points(count, 0), points(count, count));
    let slopes: Vec<Vec<ExprId>> = realization
        .map
        .iter()
        .map(|&component| {
            let derivative = |symbol: &Symbol| source.graph.derivative(component, *symbol);
            z.iter().map(derivative).collect()
        })
        .collect();
    let covector = source.block(Block::Xi);
    let along: Vec<ExprId> = v
        .iter()
        .map(|symbol| source.graph.symbol(*symbol))
        .collect();
    let combination = |source: &mut Source, pairs: &mut dyn Iterator<Item = (ExprId, ExprId)>| {
        let terms: Vec<ExprId> = pairs.map(|(a, b)| source.graph.mul(a, b)).collect();
        source.graph.sum(&terms)
    };
    let pullback: Vec<ExprId> = (0..count)
        .map(|i| {
            let mut pairs = covector.iter().zip(&slopes).map(|(xi, row)| (*xi, row[i]));
            combination(source, &mut pairs)
        })
        .collect();
    let pushforward: Vec<ExprId> = slopes
        .iter()
        .map(|row| {
            let mut pairs = row.iter().zip(&along).map(|(slope, v)| (*slope, *v));
            combination(source, &mut pairs)
        })
        .collect();
    let curvature: Vec<Vec<ExprId>> = pullback
        .iter()
        .map(|entry| {
            let derivative = |symbol: &Symbol| source.graph.derivative(*entry, *symbol);
            z.iter().map(derivative).collect()
        })
        .collect();
    let point = || Argument {
        name: "z",
        symbols: z.clone(),
    };
    let vector = Argument {
        name: "v",
        symbols: v.clone(),
    };
    let covector = || xi(source);
    let graph = &source.graph;
    vec![
        Kernel::vector(
            graph,
            "momentum_map",
            "`out = J(z)`",
            vec![point()],
            &realization.map,
        ),
        Kernel::vector(
            graph,
            "pullback",
            "`out_i = sum_k xi_k dJ_k/dz_i`",
            vec![point(), covector()],
            &pullback,
        ),
        Kernel::vector(
            graph,
            "pushforward",
            "`out_k = sum_i dJ_k/dz_i v_i`",
            vec![point(), vector],
            &pushforward,
        ),
        Kernel::matrix(
            graph,
            "curvature",
            "`out_ij = sum_k xi_k d^2J_k/dz_i dz_j`",
            vec![point(), covector()],
            &curvature,
        ),
    ]
}
