//! A kernel: named outputs as expressions in its arguments.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::field::mu;
use super::{Block, Source};
use lie_symbolic::schedule::{KnownSymbols, Program, Task, schedule, schedule_beside};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// A vector argument and the symbols of its entries.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Argument {
    /// Its name in the signature.
    pub name: &'static str,
    /// The symbols of its entries.
    pub symbols: Vec<Symbol>,
}

impl Argument {
    /// Whether the runtime computes it from the others, as an array: it is no state.
    pub(crate) fn is_array(&self) -> bool {
        matches!(self.name, "inverse" | "ratios")
    }
}

/// What a kernel writes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Returns one scalar.
    Scalar,
    /// Writes the nonzero entries of a vector: the index of each output.
    Vector(Vec<usize>),
    /// Writes the nonzero entries of a matrix: row and column of each output.
    Matrix(Vec<(usize, usize)>),
    /// Writes a vector, then a matrix: the index, then row and column of each output.
    VectorAndMatrix(Vec<usize>, Vec<(usize, usize)>),
}

/// One function of the generated code.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Its name.
    pub name: &'static str,
    /// What it computes, as a formula.
    pub formula: &'static str,
    /// Its vector arguments.
    pub arguments: Vec<Argument>,
    /// What it writes.
    pub shape: Shape,
    /// What is to be computed.
    pub task: Task,
    /// The larger computation that it is a part of, and which of its results are this kernel's.
    pub whole: Option<(Arc<JointComputation>, Range<usize>)>,
}

/// A computation whose parts are kernels too: each of them takes the operations that stand there, so that
/// kernels which compute the same quantity agree bit for bit.
#[derive(Debug)]
pub struct JointComputation {
    first: Task,
    second: Task,
    program: OnceLock<Program>,
}

impl JointComputation {
    fn program(&self, graph: &mut Graph) -> &Program {
        self.program
            .get_or_init(|| schedule_beside(graph, &self.first, &self.second))
    }
}

impl Kernel {
    /// A kernel that returns a scalar.
    pub fn scalar(
        name: &'static str,
        formula: &'static str,
        arguments: Vec<Argument>,
        value: ExprId,
    ) -> Self {
        let task = Task {
            definitions: Vec::new(),
            outputs: vec![value],
            known: KnownSymbols::Parameters,
        };
        Self {
            name,
            formula,
            arguments,
            shape: Shape::Scalar,
            task,
            whole: None,
        }
    }

    /// How many numbers it computes.
    pub fn outputs(&self) -> usize {
        self.task.outputs.len()
    }

    /// A kernel that writes a vector.
    pub fn vector(
        graph: &Graph,
        name: &'static str,
        formula: &'static str,
        arguments: Vec<Argument>,
        entries: &[ExprId],
    ) -> Self {
        let (indices, outputs) = sparse_vector(graph, entries);
        let task = Task {
            definitions: Vec::new(),
            outputs,
            known: KnownSymbols::Parameters,
        };
        Self {
            name,
            formula,
            arguments,
            shape: Shape::Vector(indices),
            task,
            whole: None,
        }
    }

    /// A kernel that writes so many values, those that vanish too.
    pub fn values(
        name: &'static str,
        formula: &'static str,
        arguments: Vec<Argument>,
        values: Vec<ExprId>,
    ) -> Self {
        let shape = Shape::Vector((0..values.len()).collect());
        let task = Task {
            definitions: Vec::new(),
            outputs: values,
            known: KnownSymbols::Parameters,
        };
        Self {
            name,
            formula,
            arguments,
            shape,
            task,
            whole: None,
        }
    }

    /// A kernel that writes a matrix, given by rows.
    pub fn matrix(
        graph: &Graph,
        name: &'static str,
        formula: &'static str,
        arguments: Vec<Argument>,
        rows: &[Vec<ExprId>],
    ) -> Self {
        let (places, outputs) = sparse_matrix(graph, rows);
        let task = Task {
            definitions: Vec::new(),
            outputs,
            known: KnownSymbols::Parameters,
        };
        Self {
            name,
            formula,
            arguments,
            shape: Shape::Matrix(places),
            task,
            whole: None,
        }
    }

    /// A kernel that writes a vector and a matrix.
    pub fn fused(
        graph: &Graph,
        name: &'static str,
        formula: &'static str,
        arguments: Vec<Argument>,
        entries: &[ExprId],
        rows: &[Vec<ExprId>],
    ) -> Self {
        let (indices, mut outputs) = sparse_vector(graph, entries);
        let (places, matrix) = sparse_matrix(graph, rows);
        outputs.extend(matrix);
        let task = Task {
            definitions: Vec::new(),
            outputs,
            known: KnownSymbols::Parameters,
        };
        Self {
            name,
            formula,
            arguments,
            shape: Shape::VectorAndMatrix(indices, places),
            task,
            whole: None,
        }
    }

    /// The same kernel with definitions, in which the step size is known too.
    #[must_use]
    pub fn within_step(mut self, definitions: Vec<(Symbol, ExprId)>) -> Self {
        self.task.definitions = definitions;
        self.task.known = KnownSymbols::Step;
        self
    }

    /// The cheapest program found.
    pub fn program(&self, graph: &mut Graph) -> Program {
        match &self.whole {
            Some((whole, outputs)) => whole.program(graph).part(outputs.clone()),
            None => schedule(graph, &self.task),
        }
    }

    /// Makes two kernels and the one that computes both agree: all three take the same operations.
    pub fn agree(first: &mut Self, second: &mut Self, both: &mut Self) {
        let whole = Arc::new(JointComputation {
            first: first.task.clone(),
            second: second.task.clone(),
            program: OnceLock::new(),
        });
        let (split, end) = (first.task.outputs.len(), both.task.outputs.len());
        first.whole = Some((whole.clone(), 0..split));
        second.whole = Some((whole.clone(), split..end));
        both.whole = Some((whole, 0..end));
    }
}

impl Source {
    /// The definitions that outputs depend on, in order.
    pub(crate) fn needed(
        &self,
        definitions: &[(Symbol, ExprId)],
        outputs: &[ExprId],
    ) -> Vec<(Symbol, ExprId)> {
        let mut used: BTreeSet<Symbol> = BTreeSet::new();
        for output in outputs {
            used.extend(self.graph.symbols(*output));
        }
        let mut kept = Vec::new();
        for (symbol, value) in definitions.iter().rev() {
            if used.contains(symbol) {
                used.extend(self.graph.symbols(*value));
                kept.push((*symbol, *value));
            }
        }
        kept.reverse();
        kept
    }

    /// A kernel of a step with the definitions that it needs, and its arguments; `given` where it depends on that.
    pub(crate) fn complete(
        &self,
        kernel: Kernel,
        definitions: &[(Symbol, ExprId)],
        given: &Argument,
    ) -> Kernel {
        let definitions = self.needed(definitions, &kernel.task.outputs);
        let mut kernel = kernel.within_step(definitions);
        let unknown = Argument {
            name: "unknown",
            symbols: self.symbols(Block::Unknown),
        };
        kernel.arguments = match kernel.name {
            "initial_guess" => vec![mu(self)],
            _ => vec![mu(self), unknown],
        };
        let values = kernel.task.definitions.iter().map(|(_, value)| value);
        let mut symbols = values
            .chain(&kernel.task.outputs)
            .flat_map(|value| self.graph.symbols(*value));
        if symbols.any(|symbol| given.symbols.contains(&symbol)) {
            kernel.arguments.push(given.clone());
        }
        kernel
    }
}

fn sparse_vector(graph: &Graph, entries: &[ExprId]) -> (Vec<usize>, Vec<ExprId>) {
    entries
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, e)| !graph.is_zero(*e))
        .unzip()
}

fn sparse_matrix(graph: &Graph, rows: &[Vec<ExprId>]) -> (Vec<(usize, usize)>, Vec<ExprId>) {
    let entries = rows.iter().enumerate().flat_map(|(i, row)| {
        row.iter()
            .copied()
            .enumerate()
            .map(move |(j, entry)| ((i, j), entry))
    });
    entries.filter(|(_, e)| !graph.is_zero(*e)).unzip()
}
