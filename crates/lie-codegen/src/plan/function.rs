//! Kernels with the programs that compute them.

use super::constants::{Code, Table};
use super::planner::Planner;
use crate::derive::{Argument, Kernel, Shape};
use lie_symbolic::schedule::Program;

/// A kernel that is ready to be written.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Function {
    /// Its name in the trait.
    pub name: &'static str,
    /// Its name in the table of operation counts.
    pub label: String,
    /// What it computes, as a formula.
    pub formula: &'static str,
    /// The same in the names of the declaration, line by line, where that is short.
    pub explicit: Vec<String>,
    /// Its vector arguments.
    pub arguments: Vec<Argument>,
    /// What it writes.
    pub shape: Shape,
    /// How.
    pub program: Code,
}

impl Function {
    /// Whether it reads an argument.
    pub fn reads(&self, argument: &Argument) -> bool {
        let mut symbols = argument.symbols.iter();
        symbols.any(|symbol| self.program.reads(*symbol))
    }
}

/// Longer formulas are left out of the doc comments.
const LONGEST_FORMULA: usize = 160;

impl Planner<'_> {
    /// A kernel of the system.
    pub(super) fn function(&mut self, kernel: &Kernel) -> Function {
        self.labelled(kernel.name.to_owned(), kernel, &mut Table::default())
    }

    /// A kernel under a label, in which the constants of `step` are known too.
    pub(super) fn labelled(
        &mut self,
        label: String,
        kernel: &Kernel,
        step: &mut Table,
    ) -> Function {
        let program = kernel.program(&mut self.source.graph);
        self.program_function(label, kernel, &program, step)
    }

    /// The same from a program that was found before.
    pub(super) fn program_function(
        &mut self,
        label: String,
        kernel: &Kernel,
        program: &Program,
        step: &mut Table,
    ) -> Function {
        Function {
            name: kernel.name,
            label,
            formula: kernel.formula,
            explicit: self.explicit(kernel),
            arguments: kernel.arguments.clone(),
            shape: kernel.shape.clone(),
            program: self.code(program, step),
        }
    }

    /// The energy and the equations of motion in the names of the user, where they are short.
    fn explicit(&self, kernel: &Kernel) -> Vec<String> {
        let left: Vec<String> = match (kernel.name, &kernel.shape) {
            ("hamiltonian", _) => vec!["H".into()],
            ("vector_field", Shape::Vector(indices)) => indices
                .iter()
                .map(|i| format!("{}'", self.names.coordinates[*i]))
                .collect(),
            _ => return Vec::new(),
        };
        let outputs = kernel.task.outputs.iter();
        let lines: Vec<String> = left
            .into_iter()
            .zip(outputs.map(|output| self.text(*output)))
            .map(|(left, right)| format!("{left} = {right}"))
            .collect();
        if lines.iter().any(|line| line.len() >= LONGEST_FORMULA) {
            return Vec::new();
        }
        lines
    }
}
