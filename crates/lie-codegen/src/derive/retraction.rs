//! The kernels of a declared retraction.

use super::coadjoint::xi;
use super::field::mu;
use super::{Argument, Block, Kernel, Source};
use crate::algebra::moving::{Coordinates, conjugated, constant};
use lie_symbolic::symbolic::ExprId;

/// `retraction_pullback`, `retraction_slope`, `retraction_action` and `retract`.
pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let retraction = source.structure.retraction.clone()?;
    let (size, matrices) = source.structure.group_matrices()?;
    let coordinates = Coordinates::new(&matrices)?;
    let right = source.group().is_some_and(|group| group.right);
    let moving = retraction.moving(&matrices, right);
    let graph = &mut source.graph;
    let tangents = moving.tangents(graph);
    let [element, inverse] = moving.elements(graph, &tangents);
    let (before, after) = (&tangents.inverses[1], moving.ends[1]);
    let basis = matrices.iter().map(|matrix| constant(graph, matrix));
    let basis: Vec<Vec<ExprId>> = basis.collect();
    let tangent = |graph: &mut _, direction: &Vec<ExprId>| {
        conjugated(graph, before.as_deref(), direction, after, size)
    };
    let turned =
        |graph: &mut _, e: &Vec<ExprId>| conjugated(graph, Some(&element), e, Some(&inverse), size);
    let tangents: Vec<Vec<ExprId>> = tangents
        .directions
        .iter()
        .map(|direction| tangent(graph, direction))
        .collect();
    let turned: Vec<Vec<ExprId>> = basis.iter().map(|e| turned(graph, e)).collect();
    let mut paired = |vectors: &[Vec<ExprId>]| -> Vec<ExprId> {
        let covector = source.coordinates();
        let vectors = vectors.iter().map(|matrix| {
            let vector = coordinates.of(&mut source.graph, matrix);
            let terms = vector.iter().zip(&covector);
            let terms: Vec<ExprId> = terms.map(|(v, m)| source.graph.mul(*v, *m)).collect();
            source.graph.sum(&terms)
        });
        vectors.collect()
    };
    let (pullback, action) = (paired(&tangents), paired(&turned));
    let slopes = source.symbols(Block::Xi);
    let slope = pullback.iter().map(|entry| {
        let slopes = slopes.iter();
        let slopes = slopes.map(|symbol| source.graph.derivative(*entry, *symbol));
        slopes.collect()
    });
    let slope: Vec<Vec<ExprId>> = slope.collect();
    let arguments = || vec![xi(source), mu(source)];
    let alone: Vec<Argument> = vec![xi(source)];
    let graph = &source.graph;
    Some(vec![
        Kernel::vector(
            graph,
            "retraction_pullback",
            "`out_a = <mu, (dtau/dxi_a) tau(xi)^-1>`",
            arguments(),
            &pullback,
        ),
        Kernel::matrix(
            graph,
            "retraction_slope",
            "`out_ab = d/dxi_b <mu, (dtau/dxi_a) tau(xi)^-1>`",
            arguments(),
            &slope,
        ),
        Kernel::vector(
            graph,
            "retraction_action",
            "`out = Ad*_tau(xi) mu`",
            arguments(),
            &action,
        ),
        Kernel::vector(
            graph,
            "retract",
            "the matrix of `tau(xi)` by rows",
            alone,
            &element,
        ),
    ])
}
