//! Where the names of a declaration stand, so that the compiler and an editor find them.

use proc_macro2::{Span, TokenStream};
use quote::quote;

use crate::model::Model;
use lie_syntax::ast::Runtime;
use lie_syntax::diagnostic::Origin;
use lie_syntax::front::{Body, Parsed};

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
    /// That of a system that is public, with the runtime in its usual place.
    pub fn new(model: &Model) -> Self {
        let places =
            |origins: &mut dyn Iterator<Item = Origin>| origins.map(Origin::span).collect();
        Self {
            visibility: quote! { pub },
            runtime: Runtime::default(),
            name: model.name_origin.span(),
            coordinates: match &model.family {
                Some(family) => vec![Span::call_site(); family.names.len() + family.sums.len()],
                None => places(&mut model.coordinates.iter().map(|c| c.origin)),
            },
            functions: Vec::new(),
            parameters: places(&mut model.parameters.iter().map(|p| p.origin)),
        }
    }

    /// The same with what only tokens have: visibility, the path of the runtime, those of functions.
    #[must_use]
    pub fn as_declared(self, parsed: &Parsed) -> Self {
        let functions = match &parsed.body {
            Some(Body::Declaration(declaration)) => declaration.functions.as_slice(),
            _ => &[],
        };
        Self {
            visibility: parsed.visibility.clone(),
            runtime: parsed.runtime.clone(),
            functions: functions.iter().flat_map(|f| f.paths.clone()).collect(),
            ..self
        }
    }
}
