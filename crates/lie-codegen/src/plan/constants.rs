//! Constants that are computed before the kernels run.

mod grid;

use std::collections::{BTreeSet, HashMap};

use super::planner::Planner;
use lie_symbolic::schedule::{KnownSymbols, Program, Task, schedule};
use lie_symbolic::symbolic::{ExprId, Node, Symbol};

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
    /// Whether it is a parameter as it stands.
    pub is_parameter: bool,
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

    /// A constant of the system.
    pub(super) fn constant_of_system(&mut self, id: ExprId) -> Constant {
        self.constant(id, &mut Table::default())
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
        self.scheduled(&Task {
            definitions: Vec::new(),
            outputs: outputs.to_vec(),
            known: KnownSymbols::Nothing,
        })
    }

    fn scheduled(&mut self, task: &Task) -> Code {
        let program = schedule(&mut self.source.graph, task);
        self.code_of_system(&program)
    }

    /// The constants of a table; `prefix` begins the names of those that are too long to be named after what they are.
    pub(super) fn prepared(&mut self, table: &Table, prefix: &str) -> Constants {
        let mut taken: BTreeSet<String> = self.names.parameters.iter().cloned().collect();
        let mut entries = Vec::new();
        for (position, id) in table.order.iter().enumerate() {
            let mut entry = self.entry(*id);
            if entry.name.is_empty() || !(entry.is_parameter || taken.insert(entry.name.clone())) {
                entry.name = format!("{prefix}{position}");
            }
            entries.push(entry);
        }
        let task = grid::preparation(&mut self.source.graph, &table.order);
        Constants {
            entries,
            program: self.scheduled(&task),
        }
    }

    /// A constant under the name of its parameter, or after what it is; under none where that is long.
    fn entry(&self, id: ExprId) -> Prepared {
        let graph = &self.source.graph;
        let parameter = graph
            .symbols(id)
            .into_iter()
            .find_map(|symbol| match symbol {
                Symbol::Parameter(index) => Some(index),
                _ => None,
            });
        let text = self.text(id);
        let is_parameter = matches!(graph.node(id), Node::Symbol(Symbol::Parameter(_)));
        Prepared {
            name: if is_parameter {
                text.clone()
            } else {
                named_after(&text).unwrap_or_default()
            },
            text,
            is_parameter,
            parameter,
        }
    }

    /// An expression in the names of the declaration.
    pub(super) fn text(&self, id: ExprId) -> String {
        let graph = &self.source.graph;
        graph.display(id, &|symbol| self.names.display_name(symbol))
    }
}

/// Longer names are not given.
const LONGEST_NAME: usize = 28;

/// The name of a short product or quotient: `inverse_I1` for `1/I1`, `h_over_2_I1` for `h/(2*I1)`.
fn named_after(text: &str) -> Option<String> {
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => ("minus_", rest),
        None => ("", text),
    };
    let (above, below) = text.split_once('/').unwrap_or((text, ""));
    let below = match below.strip_prefix('(') {
        Some(inner) => inner.strip_suffix(')')?,
        None => below,
    };
    let part = |factors: &str| {
        let mut names = factors.split('*');
        let plain = |name: &str| name.chars().all(|c| c.is_alphanumeric() || c == '_');
        names
            .all(|name| !name.is_empty() && plain(name))
            .then(|| factors.replace('*', "_"))
    };
    let above = part(above)?;
    let name = match (above.as_str(), below) {
        (_, "") => above,
        ("1", _) => format!("inverse_{}", part(below)?),
        _ => format!("{above}_over_{}", part(below)?),
    };
    let name = format!("{sign}{name}");
    let begins = name.starts_with(char::is_alphabetic);
    (begins && name.len() <= LONGEST_NAME).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::named_after;

    #[test]
    fn short_products_and_quotients_have_names() {
        for (text, name) in [
            ("1/I1", Some("inverse_I1")),
            ("-1/I1", Some("minus_inverse_I1")),
            ("mgl*c1", Some("mgl_c1")),
            ("-mgl*c1", Some("minus_mgl_c1")),
            ("1/(2*I1)", Some("inverse_2_I1")),
            ("h/(2*I1)", Some("h_over_2_I1")),
            ("mgl*c2*h/2", Some("mgl_c2_h_over_2")),
            ("µ*λ", Some("µ_λ")),
            ("2*a", None),
            ("-1/I2 + 1/I3", None),
            ("(1/I2 - 1/I3)*h/4", None),
            ("sqrt(a)", None),
            ("a^2", None),
            ("a*b/c/d", None),
            ("a_very_long_name*another_long_name", None),
        ] {
            assert_eq!(named_after(text).as_deref(), name, "{text}");
        }
    }
}
