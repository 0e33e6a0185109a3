//! A method with its options, as asked for.

use proc_macro2::TokenStream;
use quote::quote;

use super::table::RESERVED;
use super::{Availability, CATALOGUE, find};
use crate::emit::Fused;
use crate::suggest::did_you_mean;

/// A retraction `tau: g -> G`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Retraction {
    /// The exponential map.
    #[default]
    Exp,
    /// The Cayley map of the declared representation.
    Cayley,
}

/// A built method with its options.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Choice {
    /// `midpoint`
    Midpoint,
    /// `gauss4`, `gauss6`: Gauss collocation with that many stages.
    Gauss(usize),
    /// `lie-midpoint`
    LieMidpoint(Retraction),
    /// `rk4`
    Rk4,
    /// `dopri5`; its tolerances are arguments of the program.
    Dopri5,
}

/// Why an id is no method that can be used: message and remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unusable {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl Choice {
    /// The method of an id, its options at their defaults.
    ///
    /// # Errors
    /// An id that is unknown, or whose method is not built yet.
    pub fn from_id(id: &str) -> Result<Self, Unusable> {
        match id {
            "midpoint" => return Ok(Self::Midpoint),
            "gauss4" => return Ok(Self::Gauss(2)),
            "gauss6" => return Ok(Self::Gauss(3)),
            "lie-midpoint" => return Ok(Self::LieMidpoint(Retraction::Exp)),
            "rk4" => return Ok(Self::Rk4),
            "dopri5" => return Ok(Self::Dopri5),
            _ => {}
        }
        let built: Vec<&str> = CATALOGUE
            .iter()
            .filter(|m| m.availability == Availability::Built)
            .map(|m| m.id)
            .collect();
        let base = id.split('(').next().unwrap_or(id).trim();
        if find(base).is_some() || RESERVED.contains(&base) {
            return Err(Unusable {
                message: format!("the method `{id}` is not built yet"),
                help: format!("the methods that are built: {}", built.join(", ")),
            });
        }
        let known = CATALOGUE.iter().map(|m| m.id);
        Err(Unusable {
            message: format!("there is no method `{id}`"),
            help: match did_you_mean(base, known) {
                Some(near) => format!("did you mean `{near}`? `lie methods` lists all of them"),
                None => format!("the methods that are built: {}", built.join(", ")),
            },
        })
    }

    /// The id.
    pub fn id(self) -> &'static str {
        match self {
            Self::Midpoint => "midpoint",
            Self::Gauss(2) => "gauss4",
            Self::Gauss(_) => "gauss6",
            Self::LieMidpoint(_) => "lie-midpoint",
            Self::Rk4 => "rk4",
            Self::Dopri5 => "dopri5",
        }
    }

    /// The id with the options that are not at their defaults.
    pub fn label(self) -> String {
        match self {
            Self::LieMidpoint(Retraction::Cayley) => "lie-midpoint --retraction cayley".into(),
            other => other.id().into(),
        }
    }

    /// The value of the method in the runtime, as Rust; `tolerances` is in scope.
    pub fn constructor(self) -> TokenStream {
        match self {
            Self::Midpoint => quote! { ::lie_runtime::methods::ImplicitMidpoint },
            Self::Gauss(2) => quote! { ::lie_runtime::methods::Gauss4 },
            Self::Gauss(_) => quote! { ::lie_runtime::methods::Gauss6 },
            Self::LieMidpoint(Retraction::Exp) => {
                quote! { ::lie_runtime::methods::LieMidpoint::exp() }
            }
            Self::LieMidpoint(Retraction::Cayley) => {
                quote! { ::lie_runtime::methods::LieMidpoint::cayley() }
            }
            Self::Rk4 => quote! { ::lie_runtime::methods::Rk4 },
            Self::Dopri5 => quote! {
                ::lie_runtime::methods::Dopri5 { rtol: tolerances.rtol, atol: tolerances.atol }
            },
        }
    }
}

impl Fused {
    /// The equations of these methods.
    pub fn of(choices: &[Choice]) -> Self {
        let mut fused = Self::default();
        for choice in choices {
            match *choice {
                Choice::Midpoint => fused.midpoint = true,
                Choice::Gauss(stages) if !fused.gauss.contains(&stages) => fused.gauss.push(stages),
                Choice::LieMidpoint(Retraction::Exp) => fused.exp = true,
                Choice::LieMidpoint(Retraction::Cayley) => fused.cayley = true,
                _ => {}
            }
        }
        fused.gauss.sort_unstable();
        fused
    }
}
