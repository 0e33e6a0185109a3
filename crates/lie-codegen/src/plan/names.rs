//! What is called how. A name of the user never begins with an underscore, hence the names of ours that share a scope
//! with them do.

use crate::model::{CANONICAL, Model, data_number, shared_number};
use lie_symbolic::symbolic::Symbol;

/// The names of a system.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Names {
    /// The parameter struct; the system is named after it.
    pub system: String,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The components of a velocity: the basis, or the coordinates where there is none.
    pub basis: Vec<String>,
    /// The parameters.
    pub parameters: Vec<String>,
    /// Of a family the coefficients that differ from site to site, by their places.
    pub data: Vec<String>,
    /// Of a family what all sites share.
    pub shared: Vec<String>,
}

impl Names {
    /// The names that a declaration gives.
    pub(super) fn new(model: &Model) -> Self {
        let algebra = model.bracket.algebra();
        let basis = algebra.map_or(&model.coordinates, |algebra| &algebra.basis);
        let texts =
            |names: &[lie_syntax::ast::Name]| names.iter().map(|n| n.text.clone()).collect();
        Self {
            system: model.name.clone(),
            coordinates: texts(&model.coordinates),
            basis: texts(basis),
            parameters: model.parameters.iter().map(|p| p.name.clone()).collect(),
            data: Vec::new(),
            shared: Vec::new(),
        }
    }

    /// The local variable that holds a symbol.
    pub fn local(&self, symbol: Symbol) -> String {
        let n = self.coordinates.len();
        if let Some(number) = data_number(symbol) {
            return self.data[number].clone();
        }
        if let Some(number) = shared_number(symbol) {
            return self.shared[number].clone();
        }
        match symbol {
            Symbol::Coordinate(i) => coordinate_local(&self.coordinates[i]),
            Symbol::Parameter(i) => self.parameters[i].clone(),
            Symbol::Step => "_h".into(),
            Symbol::Time => "_time".into(),
            Symbol::Input(index) if index >= CANONICAL => format!("_z{}", index - CANONICAL),
            Symbol::Input(index) => {
                let component = match index / n {
                    0 | 1 => &self.basis[index % n],
                    _ => &self.coordinates[index % n],
                };
                format!(
                    "{}{component}",
                    PREFIXES[(index / n).min(PREFIXES.len() - 1)]
                )
            }
        }
    }

    /// The name of a symbol in messages and doc comments.
    pub fn display_name(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Step => "h".into(),
            Symbol::Time => "t".into(),
            Symbol::Coordinate(i) => self.coordinates[i].clone(),
            other => self.local(other),
        }
    }

    /// An argument of ours, set apart from a coordinate of that name.
    pub fn argument(&self, name: &str) -> String {
        if self.coordinates.iter().any(|coordinate| coordinate == name) {
            format!("_{name}")
        } else {
            name.to_owned()
        }
    }
}

/// How the locals of each block of inputs begin, in the order of `derive::Block`.
const PREFIXES: [&str; 9] = [
    "_xi_", "_eta_", "_u_", "_s_", "_d_", "_e_", "_given_", "_along_", "_tilt_",
];

/// The local of a coordinate: its name. One that begins with a capital could be read as a constant
/// of the user or as `None`, and takes an underscore; ours that begin with one go on in lower case.
fn coordinate_local(name: &str) -> String {
    if name.starts_with(char::is_uppercase) {
        format!("_{name}")
    } else {
        name.to_owned()
    }
}
