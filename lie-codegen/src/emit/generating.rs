//! Generating-function methods: fused functions for the generic equations of the exponential and of
//! coordinates of the second kind, and the fused equation with the Cayley map.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::equation::Form;
use super::names::{ident, index};
use super::prepared::{Owner, Prepared, step_name};
use crate::derive::{Generating, Kernel, Shape};
use crate::methods::{Choice, Retraction};
use crate::schedule::Program;

/// A function with more operations than this is not written out: its Hessian then comes from its
/// gradient over dual numbers, or all of it from the generic form.
const MOST_OPERATIONS: usize = 12_000;

/// How a method with a fused function is named.
struct Named {
    /// Suffix of the function's type.
    function: &'static str,
    /// Suffix of the equation's type.
    equation: &'static str,
    /// Label in the table of operation counts, and id.
    label: &'static str,
    /// The mathematics of the function.
    doc: &'static str,
    /// Its method in the runtime.
    method: TokenStream,
}

impl Writer<'_> {
    /// The equations of generating-function methods that are asked for; the names of the others go
    /// to the generic ones.
    pub(super) fn generating(&mut self, generic: &mut Vec<Ident>) -> TokenStream {
        let mut tokens = TokenStream::new();
        generic.push(ident("generating2"));
        let exponential = [
            (4, "generating4", "Generating4", "Generating4Equation"),
            (6, "generating6", "Generating6", "Generating6Equation"),
        ];
        for (order, label, function, equation) in exponential {
            let order_literal = index(order as usize);
            let named = Named {
                function,
                equation,
                label,
                doc: if order == 4 {
                    "`S = h H + h^3 S3` in exponential coordinates"
                } else {
                    "`S = h H + h^3 S3 + h^5 S5` in exponential coordinates"
                },
                method: quote! {
                    ::lie_runtime::methods::Generating<::lie_runtime::methods::Exp, #order_literal>
                },
            };
            let asked = self.asked(&Choice::Generating(order, Retraction::Exp));
            let kind = Generating::First(Retraction::Exp, order);
            match asked.then(|| self.fused_generating(&named, kind)).flatten() {
                Some(equation) => tokens.extend(equation),
                None => generic.push(ident(label)),
            }
        }
        let named = Named {
            function: "SecondKind2",
            equation: "SecondKind2Equation",
            label: "generating-second-kind2",
            doc: "`S = h H + h^2 S2` in coordinates of the second kind",
            method: quote! { ::lie_runtime::methods::GeneratingSecondKind2 },
        };
        let asked = self.asked(&Choice::GeneratingSecondKind2);
        let kind = Generating::Second;
        let fused = asked.then(|| {
            self.fused_second_kind(&named)
                .or_else(|| self.fused_generating(&named, kind))
        });
        match fused.flatten() {
            Some(equation) => tokens.extend(equation),
            None => generic.push(ident("second_kind")),
        }
        if self.source.triple.is_some() {
            generic.push(ident("generating2_cayley"));
            let asked = self.asked(&Choice::Generating(4, Retraction::Cayley));
            match asked.then(|| self.fused_cayley_generating()).flatten() {
                Some(equation) => tokens.extend(equation),
                None => generic.push(ident("generating4_cayley")),
            }
        }
        tokens
    }

    /// The function, its equation and the hook; `None` if the function would be too long.
    fn fused_generating(&mut self, named: &Named, kind: Generating) -> Option<TokenStream> {
        let function = self.source.generating_function(kind)?;
        let short = function.gradient.program(&mut self.source.graph);
        if size(&short) > MOST_OPERATIONS {
            return None;
        }
        let long = function.linearize.and_then(|linearize| {
            let program = linearize.program(&mut self.source.graph);
            (size(&program) <= MOST_OPERATIONS).then_some((linearize, program))
        });
        let items = self.function_items(named, (&function.gradient, &short), long.as_ref());
        let pattern = match kind {
            Generating::Second => self.second_kind_pattern(&function.pattern),
            Generating::First(..) => self.exp_pattern(&function.pattern),
        };
        let (system, name) = (self.system_name(), self.blueprint.name.clone());
        let function = format_ident!("{name}{}", named.function);
        let equation = format_ident!("{name}{}", named.equation);
        let (generic, last) = match kind {
            Generating::Second => (ident("SecondKind"), None),
            Generating::First(..) => (ident("ExpRetraction"), Some(quote! { , h })),
        };
        let inner = quote! {
            ::lie_runtime::generic::#generic<'a, S, #system<S>, #function<'a, S>>
        };
        let wrapper = self.eliminated(
            &equation,
            &format!("The method of {}", named.doc),
            &format!("{} elimination", named.label),
            &inner,
            &pattern,
        );
        let value = quote! {
            #equation(::lie_runtime::generic::#generic::with_function(self, #function::new(self, h) #last))
        };
        let hook = self.implicit(&named.method, &equation, &value);
        Some(quote! { #items #wrapper #hook })
    }

    /// The struct of a function and its impl.
    fn function_items(
        &mut self,
        named: &Named,
        (gradient, short): (&Kernel, &Program),
        long: Option<&(Kernel, Program)>,
    ) -> TokenStream {
        let n = index(self.source.dimension);
        let mut step = Prepared::default();
        let (p, xi, hessian) = (
            self.argument("p"),
            self.argument("xi"),
            self.argument("hessian"),
        );
        let argument = p.clone();
        let place = move |_: &str| quote! { #argument };
        let label = named.label;
        let docs = self.kernel_docs(&format!("{label} gradient"), gradient, short);
        let owner = Owner::Equation;
        let body = self.kernel_body(gradient, short, owner, &mut step, &place, &["xi"]);
        let slope = quote! {
            #docs
            #[inline]
            fn gradient(&mut self, #p: &Self::State, #xi: &mut Self::State) {
                #body
            }
        };
        let (system, name) = (
            self.system_name(),
            format_ident!("{}{}", self.blueprint.name, named.function),
        );
        let (docs, body) = match long {
            Some((linearize, long)) => {
                let docs = self.kernel_docs(&format!("{label} linearize"), linearize, long);
                let targets = &["xi", "hessian"];
                let body = self.kernel_body(linearize, long, owner, &mut step, &place, targets);
                (docs, body)
            }
            None => (
                quote! { #[doc = " The Hessian from the gradient over dual numbers: written out it would be too long."] },
                quote! {
                    let _lifted = ::lie_runtime::Lift::lift(self.system);
                    let mut _function = #name::new(&_lifted, ::lie_runtime::Dual::constant_of(self.h));
                    let _zero = ::lie_runtime::Poisson::zero_state(&_lifted);
                    ::lie_runtime::generic::linearize_by_duals(&mut _function, &_zero, #p, #xi, #hessian);
                },
            ),
        };
        let constants = step.all().to_vec();
        let names: Vec<Ident> = (0..constants.len()).map(step_name).collect();
        let texts: Vec<String> = constants
            .iter()
            .map(|id| format!(" `{}`", self.constant_text(*id)))
            .collect();
        let (statements, values) =
            self.preparation(&constants, &|name| quote! { system._parameters.#name });
        let visibility = &self.blueprint.visibility;
        let doc = format!(" The generating function {}.", named.doc);
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                h: S,
                #(#[doc = #texts] #names: S,)*
            }

            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The function of a step of size h; what depends on h alone is computed here, once."]
                #[must_use]
                pub fn new(system: &'a #system<S>, h: S) -> Self {
                    #statements
                    Self { system, h, #(#names: #values),* }
                }
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::GeneratingFunction<S> for #name<'_, S> {
                type State = ::lie_runtime::__private::SVector<S, #n>;
                type Jacobian = ::lie_runtime::__private::SMatrix<S, #n, #n>;

                #slope

                #docs
                #[inline]
                fn linearize(&mut self, #p: &Self::State, #xi: &mut Self::State, #hessian: &mut Self::Jacobian) {
                    #body
                }
            }
        }
    }

    /// The equation in coordinates of the second kind, where every action has a closed form.
    fn fused_second_kind(&mut self, named: &Named) -> Option<TokenStream> {
        let kernels = self.source.second_kind_kernels()?;
        if !self.short(&kernels) {
            return None;
        }
        let form = Form {
            suffix: named.equation,
            label: named.label,
            docs: &[
                "The generating-function method in coordinates of the second kind, unknown p, with",
                "`S = h H + h^2 S2`: the actions `exp(xi_i ad*_(e_i))`, `xi = grad S(p)`, in closed form.",
            ],
            guess: TokenStream::new(),
            generic: quote! { ::lie_runtime::generic::SecondKind::new(self.system, self.h) },
            coadjoint: true,
            chart: None,
            result: None,
        };
        let equation = self.fused(&form, &kernels);
        let name = format_ident!("{}{}", self.blueprint.name, named.equation);
        let hook = self.implicit(&named.method, &name, &quote! { #name::new(self, h) });
        Some(quote! { #equation #hook })
    }

    /// Whether the longest of the kernels of an equation may be written out.
    fn short(&mut self, kernels: &[Kernel]) -> bool {
        let longest = kernels
            .iter()
            .find(|kernel| matches!(kernel.shape, Shape::VectorAndMatrix(..)));
        longest
            .is_none_or(|kernel| size(&kernel.program(&mut self.source.graph)) <= MOST_OPERATIONS)
    }

    fn fused_cayley_generating(&mut self) -> Option<TokenStream> {
        let kernels = self.source.cayley_generating_kernels(4)?;
        if !self.short(&kernels) {
            return None;
        }
        let form = Form {
            suffix: "CayleyGenerating4",
            label: "generating4 cayley",
            docs: &[
                "The generating-function method of order 4 with the Cayley map, unknown p:",
                "`p - ad*_xi p/2 - Q_xi p/4 - mu = 0` with `xi = grad S(p)`, `S = h H + h^3 S3`, then",
                "`mu1 = mu + ad*_xi p`.",
            ],
            guess: quote! { self.h * S::ratio(1.0, 2.0) },
            generic: quote! {
                ::lie_runtime::generic::CayleyRetraction::with_function(
                    self.system,
                    ::lie_runtime::generic::CayleyGenerating4::new(self.system, self.h),
                    self.h,
                )
            },
            coadjoint: true,
            chart: Some(quote! {
                let mut xi = ::lie_runtime::Poisson::zero_state(self.system);
                let _ = self.group_factor(unknown, &mut xi);
                ::lie_runtime::generic::cayley_chart(self.system, &xi)
            }),
            result: None,
        };
        let equation = self.fused(&form, &kernels);
        let name = format_ident!("{}CayleyGenerating4", self.blueprint.name);
        let method = quote! {
            ::lie_runtime::methods::Generating<::lie_runtime::methods::Cayley, 4>
        };
        let hook = self.implicit(&method, &name, &quote! { #name::new(self, h) });
        Some(quote! { #equation #hook })
    }

    /// The pattern of `1 - R S''`: `R_il` with l < i is what the actions l+1 to i-1 move from
    /// `ad*_(e_l) m` to component i.
    fn second_kind_pattern(&mut self, hessian: &[Vec<bool>]) -> Vec<(usize, usize)> {
        let n = self.source.dimension;
        let constants = self.source.all_constants();
        let moved = |action: usize, reached: &mut BTreeSet<usize>| loop {
            let before = reached.len();
            let further = constants
                .iter()
                .filter(|(i, _, k, _)| *i == action && reached.contains(k))
                .map(|(_, j, _, _)| *j)
                .collect::<Vec<_>>();
            reached.extend(further);
            if reached.len() == before {
                break;
            }
        };
        let mut places = BTreeSet::new();
        for (l, row) in hessian.iter().enumerate() {
            let mut reached: BTreeSet<usize> = constants
                .iter()
                .filter(|(i, ..)| *i == l)
                .map(|(_, j, _, _)| *j)
                .collect();
            for i in l + 1..n {
                if reached.contains(&i) {
                    let columns = (0..n).filter(|&j| row[j]);
                    places.extend(columns.map(|j| (i, j)));
                }
                moved(i, &mut reached);
            }
        }
        places.into_iter().collect()
    }
}

/// All operations of a program.
fn size(program: &Program) -> usize {
    let counts = program.counts;
    counts.add + counts.mul + counts.div + counts.call
}
