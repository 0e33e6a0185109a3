//! The names of symbols, for messages.

use crate::model::CANONICAL;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::Declaration;

/// The name of a coordinate or of a parameter.
pub fn symbol_name(declaration: &Declaration, symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => declaration.state[i].text.clone(),
        Symbol::Parameter(p) => declaration.parameters[p].name.text.clone(),
        Symbol::Input(i) => {
            let mut names = declaration.realization.iter().flat_map(|r| r.names());
            let name = i.checked_sub(CANONICAL).and_then(|k| names.nth(k));
            name.map_or_else(String::new, |name| name.text.clone())
        }
        _ => String::new(),
    }
}
