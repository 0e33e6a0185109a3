//! From kernels to Rust. Everything was checked before; nothing can fail here.
//!
//! The output is deterministic: the same system gives the same tokens, from a macro or from a spec.

mod collective;
mod elimination;
mod energy;
mod equation;
mod expression;
mod fixed_order;
mod function;
mod generating;
mod lagrangian;
mod names;
mod parameters;
mod prepared;
mod realization;
mod splitting;
mod structure;
mod system;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::derive::Source;
use crate::methods::Choice;
use crate::schedule::Counts;
use crate::symbolic::ExprId;

/// What a system is called and which methods get fused code.
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
    /// The methods whose equations get fused code; all others run on the generic forms.
    pub methods: Vec<Choice>,
    /// The total degree of H, if it is a polynomial.
    pub hamiltonian_degree: Option<u32>,
    /// The largest total degree of an entry of the Poisson matrix, if all are polynomials.
    pub poisson_degree: Option<u32>,
    /// The total degree of each Casimir, if it is a polynomial.
    pub casimir_degrees: Vec<Option<u32>>,
    /// Whether each Casimir has several branches.
    pub multivalued: Vec<bool>,
}

/// A parameter of the generated struct.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: Ident,
    /// Its default.
    pub default: ExprId,
    /// Whether it must be positive.
    pub positive: bool,
    /// Its doc line.
    pub doc: String,
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
    let lagrangian = writer.lagrangian();
    let structure = writer.structure();
    let realization = writer.realization();
    let equations = writer.equations();
    let splitting = writer.splitting();
    let parameters = writer.parameters();
    let system = writer.system_struct();
    let lift = writer.lift();
    Emitted {
        tokens: quote! {
            #parameters #system #basic #lagrangian #lift #structure #realization #equations #splitting
        },
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

    /// Whether fused code is wanted for a method.
    fn asked(&self, choice: &Choice) -> bool {
        self.blueprint.methods.contains(choice)
    }
}
