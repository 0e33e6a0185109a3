//! Fused equations of implicit steps.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::function::{Body, Owner, matrix_entries, vector_writes};
use super::names::{ident, index};
use super::{Printer, elimination};
use crate::derive::Shape;
use crate::derive::trace::COMPLETED;
use crate::plan::{Chart, Constants, Ending, Function, Fused, Guess, Motion};
use lie_symbolic::schedule::Value;
use lie_symbolic::symbolic::Symbol;

/// The constants of a step size: fields of a struct, how they are computed, the fields of its value.
pub(super) struct StepConstants {
    pub fields: TokenStream,
    pub statements: TokenStream,
    pub values: TokenStream,
}

impl Printer<'_> {
    /// The struct of a fused equation and its impl.
    pub(super) fn fused(&self, fused: &Fused) -> TokenStream {
        let n = index(self.plan.dimension());
        let visibility = &self.surface.visibility;
        let (system, name) = (self.system_name(), self.type_name(fused.suffix));
        let docs = fused.docs.iter().map(|line| format!(" {line}"));
        let StepConstants {
            fields,
            statements,
            values,
        } = self.step_constants(&fused.step);
        let methods = self.equation_methods(fused);
        let completed = self.completed(fused);
        let table = self.table(fused);
        quote! {
            #(#[doc = #docs])*
            #[derive(Clone, Debug)]
            #[allow(non_snake_case)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                base: ::lie_runtime::__private::SVector<S, #n>,
                h: S,
                #fields
            }

            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The equation of a step of size h; what depends on h alone is computed here, once."]
                #[must_use]
                pub fn new(system: &'a #system<S>, h: S) -> Self {
                    #statements
                    Self { system, base: ::lie_runtime::Poisson::zero_state(system), h, #values }
                }

                #completed
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Equation<S> for #name<'_, S> {
                type State = ::lie_runtime::__private::SVector<S, #n>;
                type Unknown = Self::State;
                type Matrix = ::lie_runtime::__private::SMatrix<S, #n, #n>;

                fn zero_unknown(&self) -> Self::Unknown {
                    Self::State::repeat(S::zero())
                }

                fn zero_matrix(&self) -> Self::Matrix {
                    Self::Matrix::repeat(S::zero())
                }

                #[inline]
                fn set_base(&mut self, mu: &Self::State) {
                    self.base = *mu;
                }

                #methods
            }

            #table
        }
    }

    /// The unknowns that the iteration leaves out, computed from the others.
    fn completed(&self, fused: &Fused) -> Option<TokenStream> {
        let function = fused.completed()?;
        let (n, docs) = (index(self.plan.dimension()), self.docs(function));
        let (unknown, all) = (self.argument("unknown"), self.argument("mu"));
        let place = self.places_of_arguments();
        let body = self.body(
            function,
            &Body::new(Owner::Equation(&fused.step), &place, &["mu"]),
        );
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        Some(quote! {
            #docs
            #[allow(non_snake_case)]
            fn completed(&self, #unknown: &#state) -> #state {
                let mut #all = *#unknown;
                #body
                #all
            }
        })
    }

    /// The list of an elimination that is not written out.
    fn table(&self, fused: &Fused) -> Option<TokenStream> {
        let name = self.type_name(fused.suffix);
        (!fused.elimination.is_unrolled()).then(|| {
            let list = fused.elimination.table_tokens();
            quote! {
                impl<S: ::lie_runtime::Scalar> #name<'_, S> {
                    const ELIMINATION: ::lie_runtime::__private::StaticElimination = #list;
                }
            }
        })
    }

    /// The constants of a step size.
    pub(super) fn step_constants(&self, constants: &Constants) -> StepConstants {
        let names: Vec<_> = constants.entries.iter().map(|c| ident(&c.name)).collect();
        let texts = constants.entries.iter().map(|c| format!(" `{}`", c.text));
        let (statements, values) = self.program(&constants.program, &|value| match value {
            Value::Symbol(Symbol::Step) => quote! { h },
            Value::Symbol(symbol) => {
                let name = self.local(*symbol);
                quote! { system._parameters.#name }
            }
            other => self.value(other, Owner::System),
        });
        StepConstants {
            fields: quote! { #(#[doc = #texts] #names: S,)* },
            statements,
            values: quote! { #(#names: #values),* },
        }
    }

    fn equation_methods(&self, fused: &Fused) -> TokenStream {
        let functions = fused.functions.iter().filter(|f| f.name != COMPLETED);
        let kernels: TokenStream = functions.map(|f| self.equation_kernel(fused, f)).collect();
        let ending = self.ending(fused);
        let guess = initial_guess(fused.guess);
        let left_out = left_out(fused);
        let elimination = elimination::methods(&fused.elimination);
        let motion = self.motion(fused);
        let chart = fused.chart.map(|chart| self.within_chart(fused, chart));
        let cost = fused.costs().map(jacobian_cost);
        let clock = self.plan.system.clock.map(|_| {
            quote! {
                #[inline]
                fn clock(&self) -> ::core::option::Option<::lie_runtime::Clock> {
                    ::lie_runtime::Poisson::clock(self.system)
                }
            }
        });
        quote! { #clock #kernels #ending #guess #left_out #elimination #cost #motion #chart }
    }

    /// A kernel as a method of the equation.
    fn equation_kernel(&self, fused: &Fused, function: &Function) -> TokenStream {
        let docs = self.docs(function);
        let name = ident(function.name);
        let unknown = self.argument("unknown");
        let place = self.places_of_arguments();
        let body = |targets: &[&str]| {
            let body = Body::new(Owner::Equation(&fused.step), &place, targets);
            match &function.shape {
                Shape::VectorAndMatrix(..) => self.linearize_body(fused, function, &body),
                _ => self.body(function, &body),
            }
        };
        let (residual, matrix, mu) = (
            self.argument("residual"),
            self.argument("matrix"),
            self.argument("mu"),
        );
        let (signature, body) = match (&function.shape, function.name) {
            (Shape::VectorAndMatrix(..), _) => (
                quote! { #unknown: &Self::State, #residual: &mut Self::State, #matrix: &mut Self::Matrix },
                body(&["residual", "matrix"]),
            ),
            (_, "initial_guess") => (quote! { #unknown: &mut Self::Unknown }, body(&["unknown"])),
            (_, "result") => (
                quote! { #unknown: &Self::State, #mu: &mut Self::State },
                body(&["mu"]),
            ),
            _ => (
                quote! { #unknown: &Self::State, #residual: &mut Self::State },
                body(&["residual"]),
            ),
        };
        quote! {
            #docs
            #[inline]
            fn #name(&mut self, #signature) {
                #body
            }
        }
    }

    /// Where the arguments of a kernel of an equation are found.
    fn places_of_arguments(&self) -> impl Fn(&str) -> TokenStream + use<> {
        let unknown = self.argument("unknown");
        let spins = self.plan.structure.spins.as_ref();
        let ratios = index(2 * spins.map_or(0, |spins| spins.coordinates.len()));
        move |name: &str| match name {
            "mu" => quote! { self.base },
            "inverse" => {
                quote! { ::lie_runtime::generic::inverse_length(self.system, &self.base, #unknown) }
            }
            "ratios" => {
                quote! { ::lie_runtime::generic::sphere_ratios::<S, _, #ratios>(self.system, &self.base, #unknown) }
            }
            _ => quote! { #unknown },
        }
    }

    /// Residual and Jacobian; entries that only fill in during elimination are cleared.
    fn linearize_body(&self, fused: &Fused, function: &Function, body: &Body<'_>) -> TokenStream {
        let (statements, outputs) = self.statements(function, body);
        let Shape::VectorAndMatrix(indices, places) = &function.shape else {
            return TokenStream::new();
        };
        let (residual, matrix) = (self.argument("residual"), self.argument("matrix"));
        let (vector, slopes) = outputs.split_at(indices.len());
        let vector = vector_writes(&residual, indices, vector, self.plan.dimension());
        let slopes = matrix_entries(&matrix, places, slopes);
        let fill = &fused.elimination.fill;
        let zeros = vec![quote! { S::zero() }; fill.len()];
        let fill = matrix_entries(&matrix, fill, &zeros);
        quote! { #statements #vector #slopes #fill }
    }

    /// The state at the end, where no kernel writes it.
    fn ending(&self, fused: &Fused) -> Option<TokenStream> {
        let body = match fused.ending {
            Ending::Kernel => return None,
            Ending::Unknown => quote! { *mu = *unknown; },
            Ending::Partner => {
                let (partner, completion) = (self.partner_here(fused), Self::completion(fused));
                quote! {
                    #completion
                    let mut equation = #partner;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::result(&mut equation, unknown, mu);
                }
            }
        };
        Some(quote! {
            #[inline]
            fn result(&mut self, unknown: &Self::State, mu: &mut Self::State) {
                #body
            }
        })
    }

    /// Completes the unknown for an equation that reads all of it.
    fn completion(fused: &Fused) -> Option<TokenStream> {
        let completed = quote! { let unknown = &self.completed(unknown); };
        fused.completed().map(|_| completed)
    }

    fn partner_here(&self, fused: &Fused) -> TokenStream {
        self.partner_value(&fused.partner, &quote! { self.system }, &quote! { self.h })
    }

    /// How a solved step moves the group element: the generic equation says it.
    fn motion(&self, fused: &Fused) -> TokenStream {
        let (partner, completion) = (self.partner_here(fused), Self::completion(fused));
        let factor = (fused.motion != Motion::Velocity).then(|| {
            quote! {
                fn group_factor(&mut self, unknown: &Self::State, xi: &mut Self::State) -> ::core::option::Option<::lie_runtime::methods::Retraction> {
                    #completion
                    let mut equation = #partner;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::group_factor(&mut equation, unknown, xi)
                }
            }
        });
        let velocity = (fused.motion != Motion::Factor).then(|| {
            quote! {
                fn velocity(&mut self, unknown: &Self::State, stage: usize, xi: &mut Self::State) -> usize {
                    #completion
                    let mut equation = #partner;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::velocity(&mut equation, unknown, stage, xi)
                }
            }
        });
        quote! { #factor #velocity }
    }

    /// Whether the element of a step is joined to the identity.
    fn within_chart(&self, fused: &Fused, chart: Chart) -> TokenStream {
        let completion = Self::completion(fused);
        let joined = match chart {
            Chart::OfField => quote! {
                #completion
                ::lie_runtime::generic::cayley_chart_of_step(self.system, self.h, unknown)
            },
            Chart::OfFactor => quote! {
                let mut xi = ::lie_runtime::Poisson::zero_state(self.system);
                let _ = self.group_factor(unknown, &mut xi);
                ::lie_runtime::generic::cayley_chart(self.system, &xi)
            },
            Chart::OfPartner => {
                let partner = self.partner_here(fused);
                quote! {
                    #completion
                    let mut equation = #partner;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::within_chart(&mut equation, unknown)
                }
            }
        };
        quote! {
            fn within_chart(&mut self, unknown: &Self::State) -> S::Mask {
                #joined
            }
        }
    }
}

/// What decides whether iterations without a Jacobian are tried.
fn jacobian_cost([with, without]: [usize; 2]) -> TokenStream {
    let [with, without] = [with, without].map(|count| Literal::f64_unsuffixed(count as f64));
    quote! {
        fn jacobian_cost(&self) -> f64 {
            #with / #without
        }
    }
}

/// The unknowns that the iteration leaves out have the values of the state.
fn left_out(fused: &Fused) -> Option<TokenStream> {
    let all = fused.left_out();
    let all: Vec<_> = all.iter().map(|i| index(*i)).collect();
    (!all.is_empty()).then(|| {
        quote! {
            #[inline]
            fn leave_out(&self, unknown: &mut Self::Unknown) {
                #(unknown[#all] = self.base[#all];)*
            }
        }
    })
}

/// The initial guess along the field.
fn initial_guess(guess: Guess) -> Option<TokenStream> {
    let factor = match guess {
        Guess::WholeStep => quote! { self.h },
        Guess::HalfStep => quote! { self.h * S::from_f64(0.5) },
        Guess::Kernel => return None,
    };
    Some(quote! {
        #[inline]
        fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
            let mut field = self.base;
            ::lie_runtime::Poisson::vector_field(self.system, &self.base, &mut field);
            *unknown = self.base;
            ::lie_runtime::State::axpy(unknown, #factor, &field);
        }
    })
}
