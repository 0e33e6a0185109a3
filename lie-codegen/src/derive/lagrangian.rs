//! Lagrangian, momentum and inertia: the kernels of a system by its Lagrangian.

use super::coadjoint::xi;
use super::{Block, Kernel, Source};
use crate::symbolic::ExprId;

pub(super) fn kernels(source: &mut Source, value: ExprId) -> Vec<Kernel> {
    let velocity = source.symbols(Block::Xi);
    let mut derivatives = |function: ExprId| -> Vec<ExprId> {
        let symbols = velocity.iter();
        symbols
            .map(|&symbol| source.graph.derivative(function, symbol))
            .collect()
    };
    let momentum = derivatives(value);
    let inertia: Vec<Vec<ExprId>> = momentum.iter().map(|&slope| derivatives(slope)).collect();
    let argument = || vec![xi(source)];
    let graph = &source.graph;
    vec![
        Kernel::scalar("lagrangian", "`l(xi)`", argument(), value),
        Kernel::vector(
            graph,
            "momentum",
            "`out_i = dl/dxi^i`",
            argument(),
            &momentum,
        ),
        Kernel::matrix(
            graph,
            "inertia",
            "`out_ij = d^2l/dxi^i dxi^j`",
            argument(),
            &inertia,
        ),
    ]
}
