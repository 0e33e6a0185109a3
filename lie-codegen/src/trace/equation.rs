//! The equation of a method, written down and differentiated.

use std::collections::BTreeSet;

use lie_core::Equation;

use super::sym::{Session, Sym, with, within};
use super::system::SymbolicSystem;
use crate::derive::{Argument, Block, Derived, Kernel, Source, Tangents, Tape, leaner_jacobian};
use crate::symbolic::{ExprId, Symbol};

/// Definitions in order, each may use the earlier ones.
type Definitions = Vec<(Symbol, ExprId)>;

/// What a step says of itself in formulas.
#[derive(Clone, Copy, Debug)]
pub struct Formulas {
    /// Of the residual.
    pub residual: &'static str,
    /// Of the residual and its Jacobian.
    pub linearize: &'static str,
    /// Of the state at the end.
    pub result: &'static str,
}

/// The trace of a step.
#[derive(Debug)]
pub struct Step {
    residual: Vec<ExprId>,
    /// What the residual is made of; the state at the end adds to it.
    of_residual: Tape,
    result: Vec<ExprId>,
}

/// Runs an equation: the coordinates are the state before the step, the unknown has the symbols of its block.
/// Call it within [`kernels`].
pub fn step<E>(mut equation: E) -> Step
where
    E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>>,
{
    let (start, unknown) = with(|s| (s.source.coordinates(), s.source.block(Block::Unknown)));
    let symbols = |ids: &[ExprId]| ids.iter().map(|id| Sym(*id)).collect::<Vec<_>>();
    let expressions = |values: Vec<Sym>| values.iter().map(|x| x.0).collect();
    let (start, unknown) = (symbols(&start), symbols(&unknown));
    equation.set_base(&start);
    let mut residual = equation.zero_unknown();
    equation.residual(&unknown, &mut residual);
    let of_residual = with(|s| s.tape.clone());
    let mut end = start;
    equation.result(&unknown, &mut end);
    Step {
        residual: expressions(residual),
        of_residual,
        result: expressions(end),
    }
}

/// The kernels of a method: residual, residual with its Jacobian, and the state at the end where it is not the unknown.
/// `None` where the equation depends on comparisons.
pub fn kernels(
    source: &mut Source,
    formulas: &Formulas,
    run: impl FnOnce(&SymbolicSystem, Sym) -> Step,
) -> Option<Vec<Kernel>> {
    // Sums and products are ordered by the age of their parts: the state first, then quantities, the unknown, the step.
    let first = Block::COUNT * source.dimension;
    source.coordinates();
    for quantity in first..first + source.dimension {
        source.graph.symbol(Symbol::Input(quantity));
    }
    source.block(Block::Unknown);
    let taken = std::mem::replace(source, Source::empty(crate::symbolic::Graph::new()));
    let system = SymbolicSystem::of(&taken);
    let tape = Tape::new(&taken, first);
    let session = Session {
        source: taken,
        tape,
        branched: false,
    };
    let (traced, session) = within(session, || run(&system, Sym::of(Symbol::Step)));
    *source = session.source;
    if session.branched {
        return None;
    }
    let Step {
        residual,
        of_residual: mut tape,
        result,
    } = traced;
    let arguments = vec![
        Argument {
            name: "mu",
            symbols: (0..source.dimension).map(Symbol::Coordinate).collect(),
        },
        Argument {
            name: "unknown",
            symbols: source.symbols(Block::Unknown),
        },
    ];
    let unknown = source.symbols(Block::Unknown);
    let values = tape.definitions().to_vec();
    let rows = leaner_jacobian(
        source,
        &mut tape,
        &residual,
        &unknown,
        Tangents::Inline,
        &|source, derived| {
            let rows = derived.rows.iter().flatten();
            let entries: Vec<ExprId> = derived.values.iter().chain(rows).copied().collect();
            Derived {
                definitions: needed(source, &derived.definitions, &entries),
                ..derived
            }
        },
    );
    let slopes = tape.definitions().to_vec();
    let graph = &source.graph;
    let entries: Vec<ExprId> = residual
        .iter()
        .chain(rows.iter().flatten())
        .copied()
        .collect();
    let mut kernels = vec![
        Kernel::vector(
            graph,
            "residual",
            formulas.residual,
            arguments.clone(),
            &residual,
        )
        .within_step(needed(source, &values, &residual)),
        Kernel::fused(
            graph,
            "linearize",
            formulas.linearize,
            arguments.clone(),
            &residual,
            &rows,
        )
        .within_step(needed(source, &slopes, &entries)),
    ];
    if result != source.block(Block::Unknown) {
        let definitions = needed(source, session.tape.definitions(), &result);
        kernels.push(
            Kernel::vector(&source.graph, "result", formulas.result, arguments, &result)
                .within_step(definitions),
        );
    }
    Some(kernels)
}

/// The definitions that outputs depend on.
fn needed(source: &Source, definitions: &[(Symbol, ExprId)], outputs: &[ExprId]) -> Definitions {
    let mut used: BTreeSet<Symbol> = BTreeSet::new();
    for output in outputs {
        used.extend(source.graph.symbols(*output));
    }
    let mut kept: Definitions = Vec::new();
    for (symbol, value) in definitions.iter().rev() {
        if used.contains(symbol) {
            used.extend(source.graph.symbols(*value));
            kept.push((*symbol, *value));
        }
    }
    kept.reverse();
    kept
}
