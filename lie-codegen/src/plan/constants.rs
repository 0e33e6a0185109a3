//! Constants that are computed before the kernels run.

use std::collections::HashMap;

use super::planner::Planner;
use crate::schedule::{Known, Program, Task, schedule};
use crate::symbolic::{ExprId, Node, Symbol};

/// What is known before a kernel runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Constant {
    /// The number pi.
    Pi,
    /// The step size.
    Step,
    /// A constant of the system, by its position.
    System(usize),
    /// A constant of the step of an equation, by its position.
    OfStep(usize),
}

/// A program over constants that are known by their positions.
pub type Code = Program<Constant>;

/// Constants that are computed once, from the parameters of a system and the step size of an equation.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Constants {
    /// What they are.
    pub entries: Vec<Prepared>,
    /// The program that computes all of them, in order; its symbols are parameters and the step size.
    pub program: Code,
}

/// A constant that is computed once.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Prepared {
    /// Its name.
    pub name: String,
    /// The expression, in the names of the declaration.
    pub text: String,
    /// The first parameter that it depends on.
    pub parameter: Option<usize>,
}

/// Constants in the order of their first use.
#[derive(Debug, Default)]
pub(super) struct Table {
    order: Vec<ExprId>,
    index: HashMap<ExprId, usize>,
}

impl Table {
    /// The position of a constant, which is entered if it is new.
    fn position(&mut self, id: ExprId) -> usize {
        *self.index.entry(id).or_insert_with(|| {
            self.order.push(id);
            self.order.len() - 1
        })
    }
}

impl Planner<'_> {
    /// A program over constants by position; those of the step size go to `step`.
    pub(super) fn code(&mut self, program: &Program, step: &mut Table) -> Code {
        program.with_prepared(&mut |id| self.constant(*id, step))
    }

    /// The same for what does not know the step size.
    pub(super) fn code_of_system(&mut self, program: &Program) -> Code {
        self.code(program, &mut Table::default())
    }

    fn constant(&mut self, id: ExprId, step: &mut Table) -> Constant {
        match self.source.graph.node(id) {
            Node::Pi => return Constant::Pi,
            Node::Symbol(Symbol::Step) => return Constant::Step,
            _ => {}
        }
        if self.source.graph.symbols(id).contains(&Symbol::Step) {
            return Constant::OfStep(step.position(id));
        }
        Constant::System(self.constants.position(id))
    }

    /// The program that computes expressions from the parameters and the step size.
    pub(super) fn preparation(&mut self, outputs: &[ExprId]) -> Code {
        let task = Task {
            definitions: Vec::new(),
            outputs: outputs.to_vec(),
            known: Known::Nothing,
        };
        let program = schedule(&mut self.source.graph, &task);
        self.code_of_system(&program)
    }

    /// The constants of a table; `prefix` begins the names of those that are no parameter.
    pub(super) fn prepared(&mut self, table: &Table, prefix: &str) -> Constants {
        let entries = table.order.iter().enumerate();
        let entries = entries
            .map(|(position, id)| self.entry(*id, format!("{prefix}{position}")))
            .collect();
        Constants {
            entries,
            program: self.preparation(&table.order),
        }
    }

    fn entry(&self, id: ExprId, name: String) -> Prepared {
        let graph = &self.source.graph;
        let parameter = graph
            .symbols(id)
            .into_iter()
            .find_map(|symbol| match symbol {
                Symbol::Parameter(index) => Some(index),
                _ => None,
            });
        Prepared {
            name: match graph.node(id) {
                Node::Symbol(symbol @ Symbol::Parameter(_)) => self.names.local(*symbol),
                _ => name,
            },
            text: self.text(id),
            parameter,
        }
    }

    /// An expression in the names of the declaration.
    pub(super) fn text(&self, id: ExprId) -> String {
        let graph = &self.source.graph;
        graph.display(id, &|symbol| self.names.shown(symbol))
    }
}
