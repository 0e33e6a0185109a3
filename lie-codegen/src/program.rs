//! The programs that the command builds: the system and one entry per method.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use crate::compile::{format_tokens, generate};
use crate::methods::Choice;
use crate::model::Model;

/// What a program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// `lie run`: one trajectory.
    Run,
    /// `lie run --group`: one trajectory with the group element.
    OnGroup(Chart),
    /// `lie verify`: everything that the methods claim, also over dual numbers.
    Verify,
    /// `lie bench`: errors and times.
    Bench,
    /// `lie stress`: the limits of each method.
    Stress,
}

/// How the group element is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chart {
    /// As a matrix of the declared representation.
    Matrix,
    /// As a unit quaternion.
    Quaternion,
}

impl Chart {
    /// The names of the columns.
    pub fn columns(self, size: usize) -> Vec<String> {
        match self {
            Self::Matrix => crate::check::configuration::entries_of("g", size),
            Self::Quaternion => (0..4).map(|k| format!("q{k}")).collect(),
        }
    }
}

/// The text of a program for these methods. The entries bear the labels of the choices.
///
/// Programs for [`Purpose::Bench`] contain the modules `clock` and `controls`, which the build adds.
pub fn program(model: &Model, choices: &[Choice], purpose: Purpose) -> String {
    let system = generate(model, choices).tokens;
    let name = Ident::new(&model.name, Span::call_site());
    let entries = choices.iter().map(|choice| entry(choice, purpose));
    let dimension = model.dimension();
    let count = model.parameters.len();
    let defaults = model.parameters.iter().map(|p| p.default_value);
    let (kind, modules, end) = match purpose {
        Purpose::Run | Purpose::OnGroup(_) => (quote! { Program }, None, None),
        Purpose::Verify => {
            let orbits = model.is_lie_poisson().then(|| quote! { .with_orbits() });
            (quote! { measure::Verify }, None, orbits)
        }
        Purpose::Bench => (
            quote! { measure::Bench },
            Some(quote! { mod clock; mod controls; }),
            Some(quote! { .controls(controls::all::<_, #dimension>()).clock(clock::processor) }),
        ),
        Purpose::Stress => (quote! { measure::Stress }, None, None),
    };
    let main = quote! {
        #[allow(dead_code)]
        mod system { #system }
        #modules

        fn main() -> ::std::process::ExitCode {
            ::lie_runtime::program::#kind::new(&[#(#defaults),*], |values: &[f64]| {
                let values: &[f64; #count] = values.try_into().unwrap_or(&[f64::NAN; #count]);
                system::#name::from_values(values).system()
            })
            #(#entries)*
            #end
            .main()
        }
    };
    format_tokens(main)
}

fn entry(choice: &Choice, purpose: Purpose) -> TokenStream {
    let label = choice.label();
    let constructor = choice.constructor();
    let adaptive = choice.is_adaptive();
    let argument = if adaptive {
        quote! { tolerances }
    } else {
        quote! { _ }
    };
    let composed = choice.solved() != choice;
    if let Purpose::OnGroup(chart) = purpose {
        let chart = format_ident!("{chart:?}");
        return quote! {
            .on_group(#label, ::lie_runtime::driver::Chart::#chart, |#argument| #constructor)
        };
    }
    let function = match purpose {
        Purpose::Verify if composed => format_ident!("composed"),
        Purpose::Run => format_ident!("method"),
        _ if adaptive => format_ident!("adaptive"),
        _ => format_ident!("method"),
    };
    quote! { .#function(#label, |#argument| #constructor) }
}
