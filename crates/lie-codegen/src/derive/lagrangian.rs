//! Lagrangian, momentum and inertia: the kernels of a system by its Lagrangian, and those of a discrete one.

use super::coadjoint::xi;
use super::entries::{self, Derivatives};
use super::{Argument, Block, Kernel, Source};
use crate::model::{Discrete, Lagrangian};
use lie_symbolic::symbolic::{ExprId, Symbol};

pub(super) fn kernels(source: &mut Source, lagrangian: &Lagrangian) -> Vec<Kernel> {
    let argument = xi(source);
    let (value, formulas) = match lagrangian.reduced {
        true => (
            lagrangian.value,
            [
                ("lagrangian", "`l(xi)`"),
                ("momentum", "`out_i = dl/dxi^i`"),
                ("inertia", "`out_ij = d^2l/dxi^i dxi^j`"),
            ],
        ),
        false => (
            of_one_argument(source, lagrangian.value),
            [
                ("lagrangian", "`L(xi, q)`"),
                (
                    "momentum",
                    "`out_i = dL/dxi^i`, and behind the momenta `dL/dq`",
                ),
                ("inertia", "`out_ij`, the second derivatives of `L(xi, q)`"),
            ],
        ),
    };
    let derivatives = derivatives(source, value, &argument);
    kernels_of(source, &derivatives, &argument, formulas)
}

/// A Lagrangian as a function of a state with the velocity in place of the momenta, less the momentum of the time, where that is part of
/// the state: `H(t, mu) + p` is its Legendre transform then.
fn of_one_argument(source: &mut Source, value: ExprId) -> ExprId {
    let clock = source.clock();
    let graph = &mut source.graph;
    let symbols = graph.symbols(value);
    let inputs: Vec<_> = symbols
        .into_iter()
        .filter_map(|symbol| match symbol {
            Symbol::Coordinate(i) => Some((symbol, graph.symbol(Symbol::Input(i)))),
            _ => None,
        })
        .collect();
    let input = |symbol| {
        let mut inputs = inputs.iter();
        inputs.find(|(s, _)| *s == symbol).map(|(_, input)| *input)
    };
    let value = graph.substitute(&[value], &input)[0];
    match clock {
        Some(clock) => {
            let momentum = graph.symbol(Symbol::Input(clock.momentum));
            graph.sub(value, momentum)
        }
        None => value,
    }
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
