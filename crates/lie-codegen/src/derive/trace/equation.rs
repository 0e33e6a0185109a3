//! The equation of a method, written down and differentiated.

use lie_core::{Equation, SquareMatrix};

use super::explicit_unknowns::ExplicitUnknowns;
use super::sym::{Session, Sym, run_session, with_session};
use super::system::{Square, SymbolicSystem};
use crate::derive::{Argument, Block, Derived, Kernel, Source, Tangents, Tape, leaner_jacobian};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// A list with more definitions for each entry of the unknown is long.
const LONG: usize = 4;

/// The kernel that completes the unknowns.
pub const COMPLETED: &str = "completed";

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
    /// What the residual is made of.
    of_residual: Tape,
    /// The Jacobian, where it is that which the equation states.
    rows: Option<Vec<Vec<ExprId>>>,
    /// The state at the end, where the trace has it.
    result: Option<Vec<ExprId>>,
    /// Where the iteration begins, where the trace has it, with its formula.
    guess: Option<(Vec<ExprId>, &'static str)>,
    /// The argument that holds what is given from outside.
    given: &'static str,
    /// What becomes of the derivatives of definitions, if it is known which takes fewer operations.
    tangents: Option<Tangents>,
}

/// The state before the step.
fn start() -> Vec<Sym> {
    symbols(with_session(|s| s.source.coordinates()))
}

fn unknown() -> Vec<Sym> {
    symbols(with_session(|s| s.source.block(Block::Unknown)))
}

fn symbols(ids: Vec<ExprId>) -> Vec<Sym> {
    ids.into_iter().map(Sym).collect()
}

fn expressions(values: Vec<Sym>) -> Vec<ExprId> {
    values.into_iter().map(|x| x.0).collect()
}

impl Step {
    /// The residual.
    fn of<E>(equation: &mut E) -> Self
    where
        E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>>,
    {
        equation.set_base(&start());
        let mut residual = equation.zero_unknown();
        equation.residual(&unknown(), &mut residual);
        Self {
            residual: expressions(residual),
            of_residual: with_session(|s| s.tape.clone()),
            rows: None,
            result: None,
            guess: None,
            given: "",
            tangents: None,
        }
    }

    /// With the state at the end.
    fn ending<E>(self, equation: &mut E) -> Self
    where
        E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>>,
    {
        let mut end = start();
        equation.result(&unknown(), &mut end);
        Self {
            result: Some(expressions(end)),
            ..self
        }
    }

    /// With the Jacobian that the equation states.
    fn stating<E>(self, equation: &mut E) -> Self
    where
        E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>, Matrix = Square>,
    {
        let (mut residual, mut matrix) = (equation.zero_unknown(), equation.zero_matrix());
        equation.linearize(&unknown(), &mut residual, &mut matrix);
        let columns = 0..residual.len();
        let row = |i| columns.clone().map(|j| matrix.get(i, j).0).collect();
        Self {
            rows: Some(columns.clone().map(row).collect()),
            ..self
        }
    }

    /// The same step with derivatives of its definitions of one kind, which need not be compared.
    #[must_use]
    pub(crate) fn deriving(self, tangents: Tangents) -> Self {
        Self {
            tangents: Some(tangents),
            ..self
        }
    }

    /// The same step with the name of the argument that holds what the equation takes as given.
    #[must_use]
    pub(crate) fn with_given(self, given: &'static str) -> Self {
        Self { given, ..self }
    }
}

/// Runs an equation: the coordinates are the state before the step, the unknown has the symbols of its block.
/// Call it within [`kernels`].
pub fn step<E>(mut equation: E) -> Step
where
    E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>>,
{
    Step::of(&mut equation).ending(&mut equation)
}

/// Runs an equation whose Jacobian is that which it states; the state at the end is the unknown, or found by comparisons.
pub(crate) fn linearized<E>(mut equation: E) -> Step
where
    E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>, Matrix = Square>,
{
    Step::of(&mut equation).stating(&mut equation)
}

/// Runs an equation whose Jacobian is that which it states, with the state at the end and, under this formula, where the
/// iteration begins.
pub(crate) fn complete<E>(mut equation: E, formula: &'static str) -> Step
where
    E: Equation<Sym, State = Vec<Sym>, Unknown = Vec<Sym>, Matrix = Square>,
{
    let step = Step::of(&mut equation).stating(&mut equation);
    let mut guess = equation.zero_unknown();
    equation.initial_guess(&mut guess);
    Step {
        guess: Some((expressions(guess), formula)),
        ..step.ending(&mut equation)
    }
}

/// The trace of a step, its definitions, and the argument that holds what is given from outside. `None` where it depends
/// on comparisons.
fn traced(
    source: &mut Source,
    run: impl FnOnce(&SymbolicSystem, Sym) -> Step,
) -> Option<(Step, Tape, Argument)> {
    // Sums and products are ordered by the age of their parts: the state first, then quantities, the unknown, the step.
    let first = Block::COUNT * source.dimension;
    source.coordinates();
    for quantity in first..first + source.dimension {
        source.graph.symbol(Symbol::Input(quantity));
    }
    source.block(Block::Unknown);
    let taken = source.lent();
    let system = SymbolicSystem::new(&taken);
    let tape = Tape::new(&taken, first);
    let session = Session {
        source: taken,
        tape,
        given: 0,
        branched: false,
    };
    let (step, session) = run_session(session, || run(&system, Sym::from_symbol(Symbol::Step)));
    *source = session.source;
    if session.branched || (session.given > 0 && step.given.is_empty()) {
        return None;
    }
    let given = Argument {
        name: step.given,
        symbols: source.symbols(Block::Given)[..session.given].to_vec(),
    };
    Some((step, session.tape, given))
}

/// What a computation gives, without definitions of its own. `None` where it depends on comparisons.
pub(crate) fn values(
    source: &mut Source,
    run: impl FnOnce(&SymbolicSystem) -> Vec<Sym>,
) -> Option<Vec<ExprId>> {
    let first = Block::COUNT * source.dimension;
    let taken = source.lent();
    let system = SymbolicSystem::new(&taken);
    let session = Session {
        tape: Tape::new(&taken, first),
        source: taken,
        given: 0,
        branched: false,
    };
    let (values, session) = run_session(session, || run(&system));
    *source = session.source;
    let plain = !session.branched && session.given == 0 && session.tape.definitions().is_empty();
    plain.then(|| expressions(values))
}

/// The kernels of a method: residual, residual with its Jacobian, and where the trace has them the start of the
/// iteration and the state at the end, unless that is the unknown. Unknowns that the iteration need not find are left out
/// of residual and Jacobian; a kernel of its own completes them. `None` where the equation depends on comparisons.
pub fn kernels(
    source: &mut Source,
    formulas: &Formulas,
    run: impl FnOnce(&SymbolicSystem, Sym) -> Step,
) -> Option<Vec<Kernel>> {
    let (step, tape, given) = traced(source, run)?;
    let mut end = step.result;
    let (mut rows, slopes) = match step.rows {
        Some(rows) => (rows, tape.clone()),
        None => differentiated(source, step.of_residual, &step.residual, step.tangents),
    };
    let mut residual = step.residual;
    let mut lists = [&tape, &slopes].map(|tape| tape.definitions().to_vec());
    // what is given from outside depends on all unknowns, and a state at the end that is not traced as well
    let alone = end.is_some() && given.symbols.is_empty();
    let apart = alone.then(|| ExplicitUnknowns::find(source, &lists[0], &residual, &rows));
    let completed = apart.flatten().map(|apart| {
        let zero = source.graph.integer(0);
        let iterated = |i: usize| !apart.holds(i);
        for (i, entry) in residual.iter_mut().enumerate() {
            *entry = if iterated(i) {
                apart.value(source, *entry)
            } else {
                zero
            };
        }
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let stays = iterated(i) && iterated(j);
                *entry = if stays {
                    apart.value(source, *entry)
                } else {
                    zero
                };
            }
        }
        for entry in end.iter_mut().flatten() {
            *entry = apart.value(source, *entry);
        }
        lists = [0, 1].map(|k| apart.list(source, &lists[k]));
        apart.completed(source)
    });
    end = end.filter(|end| *end != source.block(Block::Unknown));
    let graph = &source.graph;
    let vector = |name, formula, entries: &[ExprId]| {
        Kernel::vector(graph, name, formula, Vec::new(), entries)
    };
    let both = Kernel::fused(
        graph,
        "linearize",
        formulas.linearize,
        Vec::new(),
        &residual,
        &rows,
    );
    let [plain, derived] = &lists;
    let guess = step
        .guess
        .map(|(guess, formula)| vector("initial_guess", formula, &guess));
    let kernels = guess.map(|guess| (guess, plain)).into_iter();
    let kernels = kernels.chain([
        (vector("residual", formulas.residual, &residual), plain),
        (both, derived),
    ]);
    let end = end.map(|end| vector("result", formulas.result, &end));
    let completed = completed.map(|all| {
        vector(
            COMPLETED,
            "All unknowns: those that the iteration leaves out by their formulas.",
            &all,
        )
    });
    let kernels = kernels.chain(
        end.into_iter()
            .chain(completed)
            .map(|kernel| (kernel, plain)),
    );
    let complete = |(kernel, list): (Kernel, &Vec<_>)| source.complete(kernel, list, &given);
    Some(kernels.map(complete).collect())
}

/// The Jacobian of a residual by differentiation, and the list with its definitions.
fn differentiated(
    source: &mut Source,
    mut tape: Tape,
    residual: &[ExprId],
    tangents: Option<Tangents>,
) -> (Vec<Vec<ExprId>>, Tape) {
    let unknown = source.symbols(Block::Unknown);
    if let Some(tangents) = tangents {
        let rows = tape.jacobian_in(source, residual, &unknown, tangents);
        return (rows, tape);
    }
    let is_long = tape.definitions().len() > LONG * unknown.len();
    let preferred = if is_long {
        Tangents::Named
    } else {
        Tangents::Inline
    };
    let rows = leaner_jacobian(
        source,
        &mut tape,
        residual,
        &unknown,
        preferred,
        &|source, derived| {
            let rows = derived.rows.iter().flatten();
            let entries: Vec<ExprId> = derived.values.iter().chain(rows).copied().collect();
            Derived {
                definitions: source.needed(&derived.definitions, &entries),
                ..derived
            }
        },
    );
    (rows, tape)
}
