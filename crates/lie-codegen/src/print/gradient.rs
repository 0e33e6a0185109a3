//! Discrete gradients in closed form, and generating functions.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::equation::StepConstants;
use super::function::{Body, Owner};
use super::names::{ident, index};
use super::partner::gradient_name;
use crate::derive::Shape;
use crate::plan::{Function, Generating, Gradient};

impl Printer<'_> {
    /// A closed discrete gradient as a type.
    pub(super) fn gradient(&self, gradient: &Gradient) -> TokenStream {
        let name = self.type_name(gradient_name(gradient.gradient));
        let functions = gradient.functions.iter();
        let methods: TokenStream = functions.map(|f| self.gradient_method(f)).collect();
        let (system, n) = (self.system_name(), index(self.plan.dimension()));
        let visibility = &self.surface.visibility;
        let doc = format!(
            " The discrete gradient `{}` in closed form.",
            gradient.gradient.name()
        );
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug)]
            #visibility struct #name<S: ::lie_runtime::Scalar> {
                start: ::lie_runtime::__private::SVector<S, #n>,
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::generic::DiscreteGradient<S, #system<S>> for #name<S> {
                fn new(system: &#system<S>) -> Self {
                    Self { start: ::lie_runtime::Poisson::zero_state(system) }
                }

                fn set_start(&mut self, _system: &#system<S>, start: &::lie_runtime::__private::SVector<S, #n>) {
                    self.start = *start;
                }

                #methods
            }
        }
    }

    fn gradient_method(&self, function: &Function) -> TokenStream {
        let docs = self.docs(function);
        let place = |name: &str| match name {
            "mu" => quote! { self.start },
            "inverse" => {
                quote! { ::lie_runtime::generic::inverse_length(_system, &self.start, _end) }
            }
            _ => quote! { _end },
        };
        let body = self.body(
            function,
            &Body::new(Owner::Argument, &place, &["_out", "_slopes"]),
        );
        let (system, n) = (self.system_name(), index(self.plan.dimension()));
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let matrix = matches!(function.shape, Shape::VectorAndMatrix(..))
            .then(|| quote! { , _slopes: &mut ::lie_runtime::__private::SMatrix<S, #n, #n> });
        let name = ident(function.name);
        quote! {
            #docs
            #[inline]
            fn #name(&mut self, _system: &#system<S>, _end: &#state, _out: &mut #state #matrix) {
                #body
            }
        }
    }

    /// The struct of a generating function and its impl.
    pub(super) fn generating(&self, function: &Generating) -> TokenStream {
        let n = index(self.plan.dimension());
        let methods = self.generating_methods(function);
        let name = self.type_name(function.suffix);
        let (visibility, system) = (&self.surface.visibility, self.system_name());
        let doc = format!(" The generating function {}.", function.formula);
        let StepConstants {
            fields,
            statements,
            values,
        } = self.step_constants(&function.step);
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug)]
            #[allow(dead_code, non_snake_case)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                h: S,
                #fields
            }

            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The function of a step of size h; what depends on h alone is computed here, once."]
                #[must_use]
                pub fn new(system: &'a #system<S>, h: S) -> Self {
                    #statements
                    Self { system, h, #values }
                }
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::GeneratingFunction<S> for #name<'_, S> {
                type State = ::lie_runtime::__private::SVector<S, #n>;
                type Jacobian = ::lie_runtime::__private::SMatrix<S, #n, #n>;

                #methods
            }
        }
    }

    fn generating_methods(&self, function: &Generating) -> TokenStream {
        let [p, xi, hessian] = ["p", "xi", "hessian"].map(|name| self.argument(name));
        let argument = p.clone();
        let place = move |_: &str| quote! { #argument };
        let body = |function_of: &Function, targets: &[&str]| {
            let owner = Owner::Equation(&function.step);
            self.body(function_of, &Body::new(owner, &place, targets))
        };
        let docs = self.docs(&function.gradient);
        let gradient = body(&function.gradient, &["xi"]);
        let (linearize_docs, linearize) = match &function.linearize {
            Some(linearize) => (self.docs(linearize), body(linearize, &["xi", "hessian"])),
            None => {
                let name = self.type_name(function.suffix);
                (
                    quote! { #[doc = " The Hessian from the gradient over dual numbers: written out it would be too long."] },
                    quote! {
                        let _lifted = ::lie_runtime::Lift::lift(self.system);
                        let mut _function = #name::new(&_lifted, ::lie_runtime::Dual::constant_of(self.h));
                        let _zero = ::lie_runtime::Poisson::zero_state(&_lifted);
                        ::lie_runtime::generic::linearize_by_duals(&mut _function, &_zero, #p, #xi, #hessian);
                    },
                )
            }
        };
        quote! {
            #docs
            #[inline]
            fn gradient(&mut self, #p: &Self::State, #xi: &mut Self::State) {
                #gradient
            }

            #linearize_docs
            #[inline]
            fn linearize(&mut self, #p: &Self::State, #xi: &mut Self::State, #hessian: &mut Self::Jacobian) {
                #linearize
            }
        }
    }
}
