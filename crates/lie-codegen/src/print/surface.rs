//! Where the names of a declaration stand, so that the compiler and an editor find them.

use proc_macro2::{Span, TokenStream};

use crate::ast::Runtime;
use crate::diagnostic::Origin;
use crate::model::Model;

/// What generated items take from the place of their declaration.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Visibility of the generated types.
    pub visibility: TokenStream,
    /// Where the runtime is found.
    pub runtime: Runtime,
    /// Where the name of the system stands.
    pub name: Span,
    /// Where the coordinates are declared.
    pub coordinates: Vec<Span>,
    /// Where the parameters are declared.
    pub parameters: Vec<Span>,
    /// The paths of functions of the user.
    pub functions: Vec<(String, TokenStream)>,
}

impl Surface {
    /// That of a declaration, with the runtime in its usual place.
    pub fn of(model: &Model) -> Self {
        let span = |origin: Origin| match origin {
            Origin::Span(span) => span,
            Origin::Text { .. } => Span::call_site(),
        };
        Self {
            visibility: model.visibility.clone(),
            runtime: Runtime::default(),
            name: span(model.name_origin),
            coordinates: match &model.family {
                Some(family) => vec![Span::call_site(); family.names.len() + family.sums.len()],
                None => model.coordinates.iter().map(|c| span(c.origin)).collect(),
            },
            functions: model
                .functions
                .iter()
                .flat_map(|f| f.paths.clone())
                .collect(),
            parameters: model.parameters.iter().map(|p| span(p.origin)).collect(),
        }
    }
}
