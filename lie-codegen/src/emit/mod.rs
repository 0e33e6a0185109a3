//! From kernels to Rust. Everything was checked before; nothing can fail here.
//!
//! The output is deterministic: the same system gives the same tokens, from a macro or from a spec.

mod elimination;
mod equation;
mod expression;
mod fixed_order;
mod function;
mod names;
mod parameters;
mod prepared;
mod system;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::derive::Source;
use crate::schedule::Counts;
use crate::symbolic::ExprId;

/// What a system is called and which equations are fused for it.
#[derive(Clone, Debug)]
pub struct Blueprint {
    /// Visibility of the generated types.
    pub visibility: TokenStream,
    /// Name of the parameter struct; the system is named after it.
    pub name: Ident,
    /// Doc lines of the parameter struct.
    pub docs: Vec<String>,
    /// Names of the coordinates.
    pub coordinates: Vec<Ident>,
    /// Names of the basis.
    pub basis: Vec<String>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// Names of the Casimirs.
    pub casimir_names: Vec<String>,
    /// The initial state, if one is declared.
    pub initial: Option<Vec<ExprId>>,
    /// The expressions.
    pub source: Source,
    /// The equations that get fused code.
    pub fused: Fused,
}

/// A parameter of the generated struct.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: Ident,
    /// Its default.
    pub default: ExprId,
    /// Its doc line.
    pub doc: String,
}

/// The equations that get fused code; all others run on the generic forms.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fused {
    /// The Poisson midpoint rule.
    pub midpoint: bool,
    /// Gauss collocation by number of stages.
    pub gauss: Vec<usize>,
    /// The retraction method with the exponential.
    pub exp: bool,
    /// The retraction method with the Cayley map.
    pub cayley: bool,
}

/// Generated code and the operation counts of its kernels.
#[derive(Debug)]
pub struct Emitted {
    /// The items.
    pub tokens: TokenStream,
    /// Counts by kernel; kernels of an equation are named `midpoint residual` and so on.
    pub counts: Vec<(String, Counts)>,
}

/// The generated code of a system.
pub fn emit(blueprint: &Blueprint) -> Emitted {
    let mut writer = Writer::new(blueprint);
    let basic = writer.system_impls();
    let equations = writer.equations();
    let parameters = writer.parameters();
    let system = writer.system_struct();
    Emitted {
        tokens: quote! { #parameters #system #basic #equations },
        counts: writer.counts,
    }
}

/// The state of an emission.
struct Writer<'a> {
    blueprint: &'a Blueprint,
    source: Source,
    prepared: prepared::Prepared,
    counts: Vec<(String, Counts)>,
}

impl<'a> Writer<'a> {
    fn new(blueprint: &'a Blueprint) -> Self {
        Self {
            blueprint,
            source: blueprint.source.clone(),
            prepared: prepared::Prepared::default(),
            counts: Vec::new(),
        }
    }
}
