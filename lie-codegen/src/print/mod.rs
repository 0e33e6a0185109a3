//! A plan as Rust. Everything was decided before; nothing can fail here.
//!
//! The output is deterministic: the same plan gives the same tokens, from a macro or from a spec.

mod elimination;
mod equation;
mod expression;
mod function;
mod gradient;
mod method;
mod names;
mod parameters;
mod partner;
mod realization;
mod splitting;
mod structure;
mod surface;
mod system;
mod text;

use proc_macro2::TokenStream;
use quote::quote;

pub use surface::Surface;
pub(crate) use text::format;

use crate::plan::{Item, Plan};

/// The items of a system.
pub fn print(plan: &Plan, surface: &Surface) -> TokenStream {
    let printer = Printer { plan, surface };
    let parameters = printer.parameters();
    let system = printer.system_struct();
    let traits = printer.traits();
    let lagrangian = printer.lagrangian();
    let lift = printer.lift();
    let structure = printer.structure();
    let realization = printer.realization();
    let items: TokenStream = plan.items.iter().map(|item| printer.item(item)).collect();
    let generic = printer.generic();
    let splitting = printer.splitting();
    quote! {
        #parameters #system #traits #lagrangian #lift #structure #realization #items #generic #splitting
    }
}

/// A plan and what of it a declaration places in the source of its user.
struct Printer<'a> {
    plan: &'a Plan,
    surface: &'a Surface,
}

impl Printer<'_> {
    fn item(&self, item: &Item) -> TokenStream {
        match item {
            Item::Fused(fused) => self.fused(fused),
            Item::Sparse(sparse) => self.sparse(sparse),
            Item::Gradient(gradient) => self.gradient(gradient),
            Item::Generating(function) => self.generating(function),
            Item::Method(method, solver) => self.method(method, solver),
            Item::Collective(stages) => self.collective(*stages),
        }
    }

    /// The methods that run on generic equations.
    fn generic(&self) -> Option<TokenStream> {
        let system = self.system_name();
        let keys = self.plan.generic.iter().map(|key| names::ident(key));
        (!self.plan.generic.is_empty()).then(|| {
            quote! {
                ::lie_runtime::generic_equations!(
                    [S: ::lie_runtime::Scalar] #system<S>, S: #(#keys),*
                );
            }
        })
    }
}
