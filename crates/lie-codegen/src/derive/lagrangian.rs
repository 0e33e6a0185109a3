//! Lagrangian, momentum and inertia: the kernels of a system by its Lagrangian, and those of a discrete one.

use super::coadjoint::xi;
use super::{Argument, Block, Kernel, Source};
use lie_symbolic::symbolic::ExprId;

pub(super) fn kernels(source: &mut Source, value: ExprId) -> Vec<Kernel> {
    let argument = xi(source);
    let formulas = [
        ("lagrangian", "`l(xi)`"),
        ("momentum", "`out_i = dl/dxi^i`"),
        ("inertia", "`out_ij = d^2l/dxi^i dxi^j`"),
    ];
    with_derivatives(source, value, &argument, formulas)
}

pub(super) fn discrete_kernels(source: &mut Source, value: ExprId) -> Vec<Kernel> {
    let argument = Argument {
        name: "x",
        symbols: source.symbols(Block::Xi),
    };
    let formulas = [
        ("discrete_lagrangian", "`l_d(tau(x))`"),
        ("discrete_slope", "`out_i = dl_d/dx^i`"),
        ("discrete_curvature", "`out_ij = d^2l_d/dx^i dx^j`"),
    ];
    with_derivatives(source, value, &argument, formulas)
}

/// A function of an element of the algebra with its first two derivatives.
fn with_derivatives(
    source: &mut Source,
    value: ExprId,
    argument: &Argument,
    formulas: [(&'static str, &'static str); 3],
) -> Vec<Kernel> {
    let mut derivatives = |function: ExprId| -> Vec<ExprId> {
        let symbols = argument.symbols.iter();
        symbols
            .map(|&symbol| source.graph.derivative(function, symbol))
            .collect()
    };
    let first = derivatives(value);
    let second: Vec<Vec<ExprId>> = first.iter().map(|&slope| derivatives(slope)).collect();
    let arguments = || vec![argument.clone()];
    let graph = &source.graph;
    let [of_value, of_first, of_second] = formulas;
    vec![
        Kernel::scalar(of_value.0, of_value.1, arguments(), value),
        Kernel::vector(graph, of_first.0, of_first.1, arguments(), &first),
        Kernel::matrix(graph, of_second.0, of_second.1, arguments(), &second),
    ]
}
