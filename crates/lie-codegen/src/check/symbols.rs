//! The names of symbols, for messages.

use crate::model::CANONICAL;
use crate::model::configuration::WIENER;
use lie_symbolic::symbolic::Symbol;
use lie_syntax::ast::Declaration;

/// The name of a coordinate or of a parameter.
pub fn symbol_name(declaration: &Declaration, symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => {
            let name = &declaration.state[i].text;
            process(name).map_or_else(|| name.clone(), |number| format!("dW{number}/dt"))
        }
        Symbol::Parameter(p) => declaration.parameters[p].name.text.clone(),
        Symbol::Input(i) => {
            let mut names = declaration.realization.iter().flat_map(|r| r.names());
            let name = i.checked_sub(CANONICAL).and_then(|k| names.nth(k));
            name.map_or_else(String::new, |name| name.text.clone())
        }
        _ => String::new(),
    }
}

/// The number of the Wiener process whose rate has this name.
pub fn process(name: &str) -> Option<&str> {
    let number = name.strip_prefix(WIENER)?;
    number.bytes().all(|c| c.is_ascii_digit()).then_some(number)
}
