//! The recurrence of Taylor coefficients.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::{Owner, entries};
use super::names::index;
use crate::derive::Quantity;
use crate::plan::{Constants, Recurrence};
use lie_symbolic::schedule::{Program, Value};
use lie_symbolic::symbolic::Symbol;

/// Pairs of series that are summed together.
const LANES: usize = 8;

impl Printer<'_> {
    /// The struct of a recurrence and its impls.
    pub(super) fn recurrence(&self, recurrence: &Recurrence) -> TokenStream {
        let visibility = &self.surface.visibility;
        let (system, name) = (self.system_name(), self.type_name(recurrence.suffix));
        let n = index(self.plan.dimension());
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let kept = index(recurrence.kept);
        let pairs = index(recurrence.pairs);
        let groups = index(recurrence.pairs.div_ceil(LANES));
        let doc = format!(
            " Taylor coefficients for `{}`, order by order: {} sums of products.",
            recurrence.label(),
            recurrence.pairs
        );
        let gradient = recurrence.gradient.is_some();
        let gradient_field = gradient.then(|| quote! { gradient: #state, });
        let gradient_value =
            gradient.then(|| quote! { gradient: ::lie_runtime::Poisson::zero_state(system), });
        let methods = self.methods_of_recurrence(recurrence);
        let branches = recurrence.conditions > 0;
        let conditions = index(recurrence.conditions);
        let orders = quote! { ::lie_runtime::recurrence::MOST_ORDERS };
        let conditions_field =
            branches.then(|| quote! { conditions: [[S; #conditions]; #orders], });
        let conditions_value =
            branches.then(|| quote! { conditions: [[S::zero(); #conditions]; #orders], });
        let conditions = branches.then(|| {
            quote! {
                fn conditions(&self, k: usize) -> &[S] {
                    &self.conditions[k]
                }
            }
        });
        let hook = self.hook_of_recurrence(&name, gradient);
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug)]
            #[allow(dead_code)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                kept: [S; #kept],
                sums: ::lie_runtime::recurrence::Sums<S, #pairs, #groups>,
                #conditions_field
                #gradient_field
            }

            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The recurrence of a system."]
                #[must_use]
                pub fn new(system: &'a #system<S>) -> Self {
                    Self {
                        system,
                        kept: [S::zero(); #kept],
                        sums: ::core::default::Default::default(),
                        #conditions_value
                        #gradient_value
                    }
                }
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Recurrence<S> for #name<'_, S> {
                type State = #state;
                type Carry = [S; #pairs];

                #methods

                #conditions
            }

            #hook
        }
    }

    /// How the runtime finds it.
    fn hook_of_recurrence(&self, name: &Ident, gradient: bool) -> TokenStream {
        let system = self.system_name();
        if !gradient {
            return quote! {
                impl<S: ::lie_runtime::Scalar> ::lie_runtime::Series<S> for #system<S> {
                    type Recurrence<'a> = #name<'a, S> where Self: 'a;
                    fn series(&self) -> Self::Recurrence<'_> {
                        #name::new(self)
                    }
                }
            };
        }
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::GradientRecurrence<S> for #name<'_, S> {
                fn gradient(&self) -> &Self::State {
                    &self.gradient
                }
            }

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::GradientSeries<S> for #system<S> {
                type Recurrence<'a> = #name<'a, S> where Self: 'a;
                fn gradient_series(&self) -> Self::Recurrence<'_> {
                    #name::new(self)
                }
            }
        }
    }

    fn methods_of_recurrence(&self, recurrence: &Recurrence) -> TokenStream {
        let none = Constants::default();
        let owner = Owner::Equation(&none);
        let (begin, at_zero) = self.program(&recurrence.begin, &|value| self.value(value, owner));
        let (advance, at_order) = self.program(&recurrence.advance, &|value| self.quantity(value));
        let entries_written = recurrence.entries();
        let (zeros, kept) = at_zero.split_at(entries_written);
        let (rows, pairs) = at_order.split_at(entries_written);
        let (conditions_at_zero, kept) = kept.split_at(recurrence.conditions);
        let (conditions_at_order, pairs) = pairs.split_at(recurrence.conditions);
        let branches = recurrence.conditions > 0;
        let begin_conditions =
            branches.then(|| quote! { self.conditions[0] = [#(#conditions_at_zero),*]; });
        let advance_conditions =
            branches.then(|| quote! { self.conditions[_k] = [#(#conditions_at_order),*]; });
        let (left, right) = pairs.split_at(recurrence.pairs);
        let writes = |values: &[TokenStream]| self.writes_of_recurrence(recurrence, values);
        let (of_begin, of_advance) = (writes(zeros), writes(rows));
        let unpack_mu = self.unpack_coordinates(&recurrence.begin, "mu");
        let unpack_row = self.unpack_coordinates(&recurrence.advance, "coefficient");
        let [counts_of_begin, counts_of_advance] =
            [recurrence.begin.counts, recurrence.advance.counts].map(|c| format!(" {c}."));
        let reads = |quantity: Quantity<_>| {
            let mut values = recurrence.advance.values();
            values.any(|value| *value == Value::Prepared(quantity))
        };
        let order = reads(Quantity::Order).then(|| quote! { let _order = S::from_f64(_k as f64); });
        let inverse = reads(Quantity::InverseOrder)
            .then(|| quote! { let _inverse_order = S::ratio(1.0, _k as f64); });
        let keep = (recurrence.kept > 0).then(|| quote! { self.kept = [#(#kept),*]; });
        let reads_mu = recurrence.begin.values().any(is_coordinate);
        let reads_row = recurrence.advance.values().any(is_coordinate);
        let (mu, coefficient, field) = (
            self.argument_if("mu", reads_mu),
            self.argument_if("coefficient", reads_row),
            self.argument("field"),
        );
        quote! {
            #[doc = #counts_of_begin]
            #[allow(clippy::possible_missing_comma)]
            #[inline(always)]
            fn begin(&mut self, #mu: &Self::State, #field: &mut Self::State) -> Self::Carry {
                #unpack_mu
                #begin
                #keep
                #begin_conditions
                #of_begin
                self.sums.begin()
            }

            #[doc = #counts_of_advance]
            #[allow(clippy::possible_missing_comma)]
            #[inline(always)]
            fn advance(
                &mut self,
                _k: usize,
                _rest: Self::Carry,
                #coefficient: &Self::State,
                #field: &mut Self::State,
            ) -> Self::Carry {
                #unpack_row
                #order
                #inverse
                #advance
                #advance_conditions
                #of_advance
                self.sums.push(_k, [#(#left),*], [#(#right),*])
            }
        }
    }

    /// The coordinates that a program reads, from a state.
    fn unpack_coordinates<P>(&self, program: &Program<P>, from: &str) -> Option<TokenStream> {
        if !program.values().any(is_coordinate) {
            return None;
        }
        let entries = (0..self.plan.dimension()).map(|i| {
            let symbol = Symbol::Coordinate(i);
            if program.reads(symbol) {
                let name = self.local(symbol);
                quote! { #name }
            } else {
                quote! { _ }
            }
        });
        let from = self.argument(from);
        Some(quote! { let [[#(#entries),*]] = #from.data.0; })
    }

    fn writes_of_recurrence(&self, recurrence: &Recurrence, values: &[TokenStream]) -> TokenStream {
        let (field, gradient) = values.split_at(recurrence.field.len());
        let target = self.argument("field");
        let n = self.plan.dimension();
        let fill = (recurrence.field.len() < n)
            .then(|| quote! { #target.as_mut_slice().fill(S::zero()); });
        let field = entries(&target, &recurrence.field, field);
        let places = recurrence.gradient.iter().flatten();
        let gradient = places.zip(gradient).map(|(i, value)| {
            let i = index(*i);
            quote! { self.gradient[#i] = #value; }
        });
        quote! { #fill #field #(#gradient)* }
    }

    /// What a program for order k reads.
    fn quantity(&self, value: &Value<Quantity<crate::plan::Constant>>) -> TokenStream {
        let none = Constants::default();
        match value {
            Value::Prepared(Quantity::Constant(constant)) => {
                self.constant(*constant, Owner::Equation(&none))
            }
            Value::Prepared(Quantity::Rest(pair)) => {
                let pair = index(*pair);
                quote! { _rest[#pair] }
            }
            Value::Prepared(Quantity::Kept(place)) => {
                let place = index(*place);
                quote! { self.kept[#place] }
            }
            Value::Prepared(Quantity::Order) => quote! { _order },
            Value::Prepared(Quantity::InverseOrder) => quote! { _inverse_order },
            Value::Symbol(symbol) => {
                let name = self.local(*symbol);
                quote! { #name }
            }
            Value::Number(number) => super::expression::number(number),
            Value::Temporary(i) => {
                let name = format_ident!("_t{i}");
                quote! { #name }
            }
        }
    }
}

fn is_coordinate<P>(value: &Value<P>) -> bool {
    matches!(value, Value::Symbol(Symbol::Coordinate(_)))
}
