//! Identifiers of the generated code. A name of the user never begins with an underscore, hence
//! the names of ours that share a scope with them do.

use proc_macro2::{Ident, Literal, Span};
use quote::format_ident;

use super::Writer;
use crate::model::CANONICAL;
use crate::symbolic::Symbol;

/// An identifier of ours.
pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// An index or a size, without a suffix.
pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// The local of a coordinate: its name. One that begins with a capital could be read as a constant
/// of the user or as `None`, and takes an underscore; ours that begin with one go on in lower case.
fn coordinate_local(name: &Ident) -> Ident {
    let text = name.to_string();
    if text.starts_with(char::is_uppercase) {
        Ident::new(&format!("_{text}"), name.span())
    } else {
        name.clone()
    }
}

impl Writer<'_> {
    /// The local variable that holds a symbol.
    pub fn local(&self, symbol: Symbol) -> Ident {
        let n = self.source.dimension;
        match symbol {
            Symbol::Coordinate(i) => coordinate_local(&self.blueprint.coordinates[i]),
            Symbol::Parameter(i) => self.blueprint.parameters[i].name.clone(),
            Symbol::Step => ident("_h"),
            Symbol::Time => ident("_time"),
            Symbol::Input(index) if index >= CANONICAL => {
                format_ident!("_z{}", index - CANONICAL)
            }
            Symbol::Input(index) => {
                let coordinate = &self.blueprint.coordinates[index % n];
                match index / n {
                    0 => format_ident!("_xi_{}", self.blueprint.basis[index % n]),
                    1 => format_ident!("_eta_{}", self.blueprint.basis[index % n]),
                    2 => format_ident!("_u_{}", coordinate.to_string()),
                    3 => format_ident!("_s_{}", coordinate.to_string()),
                    4 => format_ident!("_d_{}", coordinate.to_string()),
                    5 => format_ident!("_e_{}", coordinate.to_string()),
                    6 => format_ident!("_inverse_{}", coordinate.to_string()),
                    7 => format_ident!("_along_{}", coordinate.to_string()),
                    _ => format_ident!("_tilt_{}", coordinate.to_string()),
                }
            }
        }
    }

    /// An argument of ours, set apart from a coordinate of that name.
    pub fn argument(&self, name: &str) -> Ident {
        let taken = self
            .blueprint
            .coordinates
            .iter()
            .any(|coordinate| coordinate == name);
        if taken {
            format_ident!("_{name}")
        } else {
            ident(name)
        }
    }

    /// The name of a symbol in messages and doc comments.
    pub fn shown(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Step => "h".into(),
            Symbol::Time => "t".into(),
            Symbol::Coordinate(i) => self.blueprint.coordinates[i].to_string(),
            other => self.local(other).to_string(),
        }
    }
}
