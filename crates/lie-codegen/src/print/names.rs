//! Identifiers of the generated code.

use proc_macro2::{Ident, Literal, Span};
use quote::format_ident;

use super::Printer;
use lie_symbolic::symbolic::Symbol;

/// An identifier of ours.
pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// An index or a size, without a suffix.
pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

impl Printer<'_> {
    /// The parameter struct.
    pub(super) fn name(&self) -> Ident {
        Ident::new(&self.plan.names.system, self.surface.name)
    }

    /// The system.
    pub(super) fn system_name(&self) -> Ident {
        let suffix = if self.plan.family.is_some() {
            "Sites"
        } else {
            "System"
        };
        format_ident!("{}{suffix}", self.name())
    }

    /// A type of the system by the end of its name.
    pub(super) fn type_name(&self, suffix: &str) -> Ident {
        format_ident!("{}{suffix}", self.name())
    }

    /// The parameters.
    pub(super) fn parameters_by_name(&self) -> Vec<Ident> {
        let names = self.plan.names.parameters.iter();
        let spans = names.zip(&self.surface.parameters);
        spans.map(|(name, span)| Ident::new(name, *span)).collect()
    }

    /// The local variable that holds a symbol.
    pub(super) fn local(&self, symbol: Symbol) -> Ident {
        let span = match symbol {
            Symbol::Coordinate(i) => self.surface.coordinates[i],
            Symbol::Parameter(i) => self.surface.parameters[i],
            _ => Span::call_site(),
        };
        Ident::new(&self.plan.names.local(symbol), span)
    }

    /// An argument of ours, set apart from a coordinate of that name.
    pub(super) fn argument(&self, name: &str) -> Ident {
        ident(&self.plan.names.argument(name))
    }

    /// The same, with an underscore where it is not read.
    pub(super) fn argument_if(&self, name: &str, read: bool) -> Ident {
        if read {
            self.argument(name)
        } else {
            format_ident!("_{name}")
        }
    }
}
