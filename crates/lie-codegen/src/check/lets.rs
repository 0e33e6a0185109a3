//! Abbreviations: each may use the earlier ones, none a later one or itself.

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use lie_symbolic::symbolic::Graph;
use lie_syntax::ast::Declaration;
use lie_syntax::diagnostic::Diagnostic;

/// Lowers the abbreviations in their order and binds their names.
pub fn abbreviations<'a>(
    declaration: &'a Declaration,
    graph: &mut Graph,
    environment: &mut Environment<'a>,
    mistakes: &mut Vec<Diagnostic>,
) {
    for (name, value) in &declaration.lets {
        let value = Lowering::new(graph, environment, mistakes, Allowed::Everything).lower(value);
        environment.bind(&name.text, value);
    }
}
