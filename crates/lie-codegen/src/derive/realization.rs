//! The map of a realization and its derivatives.

use super::coadjoint::xi;
use super::{Argument, Block, Kernel, Source};
use crate::model::CANONICAL;
use lie_symbolic::symbolic::{ExprId, Symbol};

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
    let slopes = derivatives(source, &realization.map, &z);
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
    let curvature = derivatives(source, &pullback, &z);
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
    let (of_map, of_pullback) = ("`out = J(z)`", "`out_i = sum_k xi_k dJ_k/dz_i`");
    let of_pushforward = "`out_k = sum_i dJ_k/dz_i v_i`";
    let of_curvature = "`out_ij = sum_k xi_k d^2J_k/dz_i dz_j`";
    let along = vec![point(), covector()];
    let (map, alone) = (&realization.map, vec![point()]);
    vec![
        Kernel::vector(graph, "momentum_map", of_map, alone, map),
        Kernel::vector(graph, "pullback", of_pullback, along.clone(), &pullback),
        Kernel::vector(
            graph,
            "pushforward",
            of_pushforward,
            vec![point(), vector],
            &pushforward,
        ),
        Kernel::matrix(graph, "curvature", of_curvature, along, &curvature),
    ]
}

/// The derivatives of functions by symbols, row by row.
fn derivatives(source: &mut Source, functions: &[ExprId], symbols: &[Symbol]) -> Vec<Vec<ExprId>> {
    let row = |function: &ExprId| {
        let slopes = symbols.iter();
        let slopes = slopes.map(|symbol| source.graph.derivative(*function, *symbol));
        slopes.collect()
    };
    functions.iter().map(row).collect()
}
