//! Lagrangian, momentum and inertia: the kernels of a system by its Lagrangian, and those of a discrete one.

use super::coadjoint::xi;
use super::entries::{self, Derivatives};
use super::{Argument, Block, Kernel, Source};
use crate::model::Discrete;
use lie_symbolic::symbolic::ExprId;

pub(super) fn kernels(source: &mut Source, value: ExprId) -> Vec<Kernel> {
    let argument = xi(source);
    let formulas = [
        ("lagrangian", "`l(xi)`"),
        ("momentum", "`out_i = dl/dxi^i`"),
        ("inertia", "`out_ij = d^2l/dxi^i dxi^j`"),
    ];
    let derivatives = derivatives(source, value, &argument);
    kernels_of(source, &derivatives, &argument, formulas)
}

pub(super) fn discrete_kernels(source: &mut Source, discrete: &Discrete) -> Vec<Kernel> {
    let argument = Argument {
        name: "x",
        symbols: source.symbols(Block::Xi),
    };
    let formulas = [
        ("discrete_lagrangian", "`l_d(tau(x))`"),
        ("discrete_slope", "`out_i = dl_d/dx^i`"),
        ("discrete_curvature", "`out_ij = d^2l_d/dx^i dx^j`"),
    ];
    let derivatives = match &discrete.in_entries {
        Some(written) => entries::derivatives(source, written),
        None => derivatives(source, discrete.value, &argument),
    };
    kernels_of(source, &derivatives, &argument, formulas)
}

/// A function of an element of the algebra with its first two derivatives.
fn derivatives(source: &mut Source, value: ExprId, argument: &Argument) -> Derivatives {
    let mut derivatives = |function: ExprId| -> Vec<ExprId> {
        let symbols = argument.symbols.iter();
        symbols
            .map(|&symbol| source.graph.derivative(function, symbol))
            .collect()
    };
    let first = derivatives(value);
    let second = first.iter().map(|&slope| derivatives(slope)).collect();
    Derivatives {
        value,
        first,
        second,
    }
}

/// Their kernels.
fn kernels_of(
    source: &Source,
    derivatives: &Derivatives,
    argument: &Argument,
    formulas: [(&'static str, &'static str); 3],
) -> Vec<Kernel> {
    let Derivatives {
        value,
        first,
        second,
    } = derivatives;
    let arguments = || vec![argument.clone()];
    let graph = &source.graph;
    let [of_value, of_first, of_second] = formulas;
    vec![
        Kernel::scalar(of_value.0, of_value.1, arguments(), *value),
        Kernel::vector(graph, of_first.0, of_first.1, arguments(), first),
        Kernel::matrix(graph, of_second.0, of_second.1, arguments(), second),
    ]
}
