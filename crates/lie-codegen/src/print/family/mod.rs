//! The kernels of a family as an impl of `Sites`, and the type of the system.

mod acting;
mod pieces;
mod shared;

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::Printer;
use super::function::Owner;
use super::names::{ident, index};
use crate::derive::Shape;
use crate::model::Size;
use crate::plan::{Constant, Family, Function};
use lie_core::lattice::AXES;
use lie_symbolic::schedule::Value;
use lie_symbolic::symbolic::Symbol;
use pieces::span;

impl Printer<'_> {
    /// All items of a family.
    pub(super) fn family(&self, family: &Family) -> TokenStream {
        let parameters = self.parameters();
        let sites = self.system_struct();
        let over = self.scalar_conversion();
        let system = self.system_of_family(family);
        let kernels = self.sites(family);
        let pieces = family.pieces.as_ref();
        let pieces = pieces.map(|pieces| self.pieces_of_family(family, pieces));
        quote! { #parameters #sites #over #system #kernels #pieces }
    }

    /// The numbers of coordinates of a site and of all slots, and of sums.
    fn counts(&self, family: &Family) -> [Literal; 3] {
        [family.coordinates.len(), family.places(), family.totals()].map(index)
    }

    /// The type of the system, and how it is made.
    fn system_of_family(&self, family: &Family) -> TokenStream {
        let (visibility, name, sites) = (&self.surface.visibility, self.name(), self.system_name());
        let system = self.type_name("System");
        let [c, ..] = self.counts(family);
        let names = self.parameters_by_name();
        let size = |size: &Size| match size {
            Size::Number(count) => {
                let count = index(*count);
                quote! { #count }
            }
            Size::Parameter(p) => {
                let (field, text) = (&names[*p], names[*p].to_string());
                quote! { ::lie_runtime::family::size(self.#field, #text)? }
            }
        };
        let sizes = family.sizes.iter().map(size);
        let before = std::iter::repeat_n(quote! { 1, }, AXES - family.sizes.len());
        let axes = index(AXES);
        let initial = family.seed.map(|seed| {
            let seed = Literal::u64_unsuffixed(seed);
            let sites = quote! { ::lie_runtime::family::unit_spheres(sites, #c, #seed) };
            let state = match family.timed {
                true => quote! { self.system()?.state(#sites) },
                false => sites,
            };
            quote! {
                #[doc = " The initial state of the declaration: a point on the unit sphere for each site, at random."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = " If a number of sites is none."]
                pub fn initial_state(&self) -> ::core::result::Result<::std::vec::Vec<S>, ::lie_runtime::ParameterError> {
                    let sites = ::lie_runtime::lattice::count(self.sizes()?);
                    ::core::result::Result::Ok(#state)
                }
            }
        });
        let doc = format!(" The family of sites [`{sites}`] as a system.");
        quote! {
            #[doc = #doc]
            #visibility type #system<S = f64> = ::lie_runtime::family::Family<#sites<S>>;

            #[allow(non_snake_case)]
            impl<S: ::lie_runtime::Scalar> #name<S> {
                #[doc = " The number of layers, rows and columns of sites; a chain is one row, a square lattice one layer."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = " If a parameter that gives one is no whole number, at least 1."]
                pub fn sizes(&self) -> ::core::result::Result<[usize; #axes], ::lie_runtime::ParameterError> {
                    ::core::result::Result::Ok([#(#before)* #(#sizes),*])
                }

                #[doc = " The system for these parameters."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = " If a number of sites is none, or a constant that the system needs is not finite."]
                pub fn system(&self) -> ::core::result::Result<#system<S>, ::lie_runtime::ParameterError> {
                    ::core::result::Result::Ok(::lie_runtime::family::Family::new(self.sites()?, self.sizes()?))
                }

                #initial
            }
        }
    }

    /// The impl of `Sites`.
    fn sites(&self, family: &Family) -> TokenStream {
        let sites = self.system_name();
        let [c, p, t] = self.counts(family);
        let facts = self.facts_of_sites(family);
        let vector = quote! { [S; #c] };
        let field = self.field_of_site(family);
        let slopes = self.slopes_of_sums(family);
        let summands = self.summands_of_site(family);
        let energy = self.kernel(&family.energy, 1);
        let time_slope = self.time_slope(family);
        let of_sums = self.kernel(&family.weights, family.totals());
        let observables = self.observables_of_sums(family);
        let bonds = self.bonds_of_family(family);
        let ad = self.kernel(&family.ad, family.coordinates.len());
        let ad_star = self.kernel(&family.ad_star, family.coordinates.len());
        let casimirs = self.casimirs_of_site(family);
        let [of_summands, of_energy] =
            [&family.summands, &family.energy].map(|function| self.docs(function));
        quote! {
            #[allow(non_snake_case, clippy::many_single_char_names, clippy::possible_missing_comma)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::family::Sites<S> for #sites<S> {
                type Site = ::lie_runtime::family::Fixed<#c>;
                type Around = ::lie_runtime::family::Fixed<#p>;
                type Sums = ::lie_runtime::family::Fixed<#t>;
                type Widened = #sites<S::Wide>;
                type Lifted = #sites<::lie_runtime::Dual<S>>;

                #facts

                #field

                #slopes

                #of_summands
                #[inline(always)]
                #summands

                #of_energy
                fn energy(&self, _weights: &[S; #t]) -> S { #energy }

                #time_slope

                fn weights(&self, _weights: &[S; #t]) -> [S; #t] { #of_sums }

                #bonds

                #observables

                #[inline]
                fn ad(&self, _xi: &#vector, _eta: &#vector) -> #vector { #ad }

                #[inline]
                fn ad_star(&self, _xi: &#vector, _mu: &#vector) -> #vector { #ad_star }

                #casimirs

                fn widen(&self) -> Self::Widened {
                    self._over(S::widen)
                }

                fn lift(&self) -> Self::Lifted {
                    self._over(::lie_runtime::Dual::constant_of)
                }
            }
        }
    }

    /// What the family says of itself.
    fn facts_of_sites(&self, family: &Family) -> TokenStream {
        let [c, ..] = self.counts(family);
        let (t, axes) = (index(family.sums.len()), index(AXES));
        let name = &self.plan.names.system;
        let offsets = family.offsets.iter().map(|distance| {
            let distance = distance.map(Literal::i64_unsuffixed);
            quote! { [#(#distance),*] }
        });
        let terms = family.sums.iter().map(|sum| {
            let slots = sum.slots.iter().map(|slot| index(*slot));
            let spans = sum.spans.iter().map(span);
            quote! { ::lie_runtime::family::Term { slots: &[#(#slots),*], spans: [#(#spans),*] } }
        });
        let option = |degree: Option<u32>| match degree {
            Some(degree) => {
                let degree = index(degree as usize);
                quote! { ::core::option::Option::Some(#degree) }
            }
            None => quote! { ::core::option::Option::None },
        };
        let degree = option(family.degree);
        let data = (!family.data.is_empty()).then(|| {
            let places = family.data_places.iter();
            let places = places.map(|place| {
                let [slot, which] = place.map(index);
                quote! { [#slot, #which] }
            });
            let arms = by_place(
                self.data_fields()
                    .iter()
                    .map(|field| quote! { &self.#field }),
            );
            quote! {
                fn data_places(&self) -> &[[usize; 2]] {
                    &[#(#places),*]
                }

                fn data(&self, _index: usize) -> &[S] {
                    match _index {
                        #arms
                        _ => &[],
                    }
                }
            }
        });
        let (mean, count) = (family.mean_field, index(family.casimirs.len()));
        let coordinates = by_place(family.coordinates.iter().map(|name| quote! { #name }));
        let names = family.casimirs.iter().map(|casimir| &casimir.name);
        let casimirs = by_place(names.map(|name| quote! { #name }));
        let degrees = family.casimirs.iter().map(|casimir| casimir.degree);
        let degrees = by_place(degrees.map(option));
        let acting = self.facts_of_acting(family);
        let shared = self.facts_of_shared(family);
        quote! {
            fn name(&self) -> &str {
                #name
            }

            fn dimension(&self) -> usize {
                #c
            }

            fn coordinate(&self, _index: usize) -> &str {
                match _index {
                    #coordinates
                    _ => "",
                }
            }

            fn offsets(&self) -> &[[isize; #axes]] {
                &[#(#offsets),*]
            }

            fn count(&self) -> usize {
                #t
            }

            fn term(&self, _index: usize) -> ::lie_runtime::family::Term<'_> {
                const TERMS: [::lie_runtime::family::Term<'static>; #t] = [#(#terms),*];
                TERMS[_index]
            }

            #data

            #acting

            #shared

            fn has_mean_field(&self) -> bool {
                #mean
            }

            fn degree(&self) -> ::core::option::Option<u32> {
                #degree
            }

            fn casimir_count(&self) -> usize {
                #count
            }

            fn casimir_name(&self, _index: usize) -> &str {
                match _index {
                    #casimirs
                    _ => "",
                }
            }

            fn casimir_degree(&self, _index: usize) -> ::core::option::Option<u32> {
                match _index {
                    #degrees
                    _ => ::core::option::Option::None,
                }
            }
        }
    }

    fn slopes_of_sums(&self, family: &Family) -> TokenStream {
        let [c, p, t] = self.counts(family);
        let arms = family.slopes.iter().map(|(k, slot, function)| {
            let (k, slot) = (index(*k), index(*slot));
            let body = self.kernel(function, family.coordinates.len());
            quote! { (#k, #slot) => { #body } }
        });
        let counts = family
            .slopes
            .iter()
            .map(|(_, _, function)| format!(" {}: {}.", function.label, function.program.counts));
        quote! {
            #[doc = " `dF/dT_k ds_k/dmu` by the coordinates in a slot, at the site of the summand."]
            #[doc = ""]
            #(#[doc = #counts])*
            fn slope(&self, _term: usize, _slot: usize, _at: &[S; #p], _weights: &[S; #t]) -> [S; #c] {
                match (_term, _slot) {
                    #(#arms)*
                    _ => [S::zero(); #c],
                }
            }
        }
    }

    fn casimirs_of_site(&self, family: &Family) -> TokenStream {
        let [c, ..] = self.counts(family);
        let places: Vec<_> = (0..family.casimirs.len()).map(index).collect();
        let size = family.coordinates.len();
        let casimirs = family.casimirs.iter();
        let values = casimirs
            .clone()
            .map(|casimir| self.kernel(&casimir.value, 1));
        let gradients = casimirs.map(|casimir| self.kernel(&casimir.gradient, size));
        quote! {
            fn casimir(&self, _index: usize, _mu: &[S; #c]) -> S {
                match _index {
                    #(#places => { #values })*
                    _ => S::zero(),
                }
            }

            fn casimir_gradient(&self, _index: usize, _mu: &[S; #c]) -> [S; #c] {
                match _index {
                    #(#places => { #gradients })*
                    _ => [S::zero(); #c],
                }
            }
        }
    }

    /// A leaf of a kernel; the time of a flow is an argument.
    fn leaf(&self, value: &Value<Constant>) -> TokenStream {
        match value {
            Value::Symbol(Symbol::Time) => quote! { _t },
            value => self.value(value, Owner::System),
        }
    }

    /// The body of a kernel: arguments taken apart, locals, and an array of this size, or a scalar.
    fn kernel(&self, function: &Function, size: usize) -> TokenStream {
        let unpacked: TokenStream = function
            .arguments
            .iter()
            .map(|argument| {
                let from = ident(&format!("_{}", argument.name));
                self.taken(function, &argument.symbols, &quote! { *#from })
            })
            .collect();
        let (statements, outputs) = self.program(&function.program, &|value| self.leaf(value));
        let result = match &function.shape {
            Shape::Vector(indices) => {
                let entries = (0..size).map(|k| match indices.iter().position(|i| *i == k) {
                    Some(at) => outputs[at].clone(),
                    None => quote! { S::zero() },
                });
                quote! { [#(#entries),*] }
            }
            _ => quote! { #(#outputs)* },
        };
        quote! { #unpacked #statements #result }
    }

    /// The entries of an array that a kernel reads.
    fn taken(&self, function: &Function, symbols: &[Symbol], from: &TokenStream) -> TokenStream {
        if !symbols.iter().any(|s| function.program.reads(*s)) {
            return TokenStream::new();
        }
        let entries = symbols.iter().map(|symbol| {
            if function.program.reads(*symbol) {
                let name = self.local(*symbol);
                quote! { #name }
            } else {
                quote! { _ }
            }
        });
        quote! { let [#(#entries),*] = #from; }
    }
}

/// The arms of a match over the places of these.
fn by_place(values: impl Iterator<Item = TokenStream>) -> TokenStream {
    let arms = values.enumerate().map(|(place, value)| {
        let place = index(place);
        quote! { #place => #value, }
    });
    arms.collect()
}
