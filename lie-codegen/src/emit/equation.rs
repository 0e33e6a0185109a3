//! Fused equations of implicit steps.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::elimination::{Elimination, UNROLLED};
use super::names::{ident, index};
use super::prepared::{Owner, Prepared, step_name};
use crate::derive::{Kernel, Shape};
use crate::methods::{Choice, Lift, Retraction};
use crate::schedule::{Program, Value};
use crate::structure::spectrum::Spectrum;

/// What distinguishes one fused equation from another.
pub(super) struct Form {
    /// Suffix of its type.
    pub(super) suffix: &'static str,
    /// Label in the table of operation counts.
    pub(super) label: &'static str,
    /// Its doc lines.
    pub(super) docs: &'static [&'static str],
    /// The factor of `h f(mu)` in the initial guess.
    pub(super) guess: TokenStream,
    /// The generic equation, made from `self.system` and `self.h`: it says how a solved step moves the
    /// group element.
    pub(super) generic: TokenStream,
    /// Whether the method is of coadjoint form.
    pub(super) coadjoint: bool,
    /// Of a method along the Cayley map, which ends where an element has real eigenvalues: whether that of the step is
    /// joined to the identity.
    pub(super) chart: Option<TokenStream>,
    /// Statements that write the state at the end to `mu`, where no kernel does and it is not `unknown`.
    pub(super) result: Option<TokenStream>,
}

impl Writer<'_> {
    /// The equation of each implicit method: fused where asked for, generic elsewhere.
    pub fn equations(&mut self) -> TokenStream {
        let mut tokens = TokenStream::new();
        let mut generic = Vec::new();
        let methods = [
            (Choice::Midpoint, "midpoint"),
            (Choice::Gauss(2), "gauss4"),
            (Choice::Gauss(3), "gauss6"),
            (Choice::LieMidpoint(Retraction::Exp), "exp"),
            (Choice::LieMidpoint(Retraction::Cayley), "cayley"),
        ];
        for (choice, name) in methods {
            let of_algebra = matches!(choice, Choice::LieMidpoint(_)) && !self.source.is_lie();
            let cayley = choice == Choice::LieMidpoint(Retraction::Cayley);
            if of_algebra || (cayley && self.source.triple.is_none()) {
                continue;
            }
            // generating functions of order 2 run on these equations, collective methods on the second
            let asked = match choice {
                Choice::LieMidpoint(retraction) => {
                    self.asked(&Choice::Generating(2, retraction))
                        || retraction == Retraction::Cayley
                            && (self.asked(&Choice::Isospectral(2))
                                || self.asked(&Choice::Collective(2, Lift::Representation)))
                }
                _ => false,
            };
            if asked || self.asked(&choice) {
                tokens.extend(self.fused_method(&choice));
            } else {
                generic.push(ident(name));
            }
        }
        tokens.extend(self.energy(&mut generic));
        if self.source.is_lie() {
            tokens.extend(self.generating(&mut generic));
            tokens.extend(self.collective(&mut generic));
        }
        if self.source.lagrangian.is_some() {
            generic.push(ident("variational"));
            if self.source.triple.is_some() {
                generic.push(ident("variational_cayley"));
            }
        }
        if self.source.discrete.is_some() {
            generic.push(ident("discrete"));
            if self.source.triple.is_some() {
                generic.push(ident("discrete_cayley"));
            }
        }
        if !generic.is_empty() {
            let system = self.system_name();
            tokens.extend(quote! {
                ::lie_runtime::generic_equations!(
                    [S: ::lie_runtime::Scalar] #system<S>, S: #(#generic),*
                );
            });
        }
        tokens
    }

    fn fused_method(&mut self, choice: &Choice) -> TokenStream {
        match choice {
            Choice::Midpoint => self.fused_midpoint(),
            Choice::Gauss(stages) => self.fused_gauss(*stages),
            Choice::LieMidpoint(Retraction::Exp) => self.fused_exp(),
            Choice::LieMidpoint(Retraction::Cayley) => self.fused_cayley(),
            _ => TokenStream::new(),
        }
    }

    /// The hook by which the runtime finds the equation of a method, `equation` in terms of
    /// `self` and `h`.
    pub(super) fn implicit(
        &self,
        method: &TokenStream,
        equation: &Ident,
        value: &TokenStream,
    ) -> TokenStream {
        let system = self.system_name();
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Implicit<S, #method> for #system<S> {
                type Equation<'a> = #equation<'a, S> where Self: 'a;
                fn equation<'a>(&'a self, _method: &#method, h: S) -> #equation<'a, S> {
                    #value
                }
            }
        }
    }

    pub(super) fn system_name(&self) -> Ident {
        format_ident!("{}System", self.blueprint.name)
    }

    fn fused_midpoint(&mut self) -> TokenStream {
        let (equation, name) = self.midpoint_equation();
        let method = quote! { ::lie_runtime::methods::ImplicitMidpoint };
        let hook = self.implicit(&method, &name, &quote! { #name::new(self, h) });
        quote! { #equation #hook }
    }

    /// The fused equation of the midpoint rule, and its name.
    pub(super) fn midpoint_equation(&mut self) -> (TokenStream, Ident) {
        let kernels = self.source.midpoint_kernels();
        let form = Form {
            suffix: "Midpoint",
            label: "midpoint",
            docs: &[
                "The Poisson midpoint rule, unknown `u = mu1`: `u - mu - h f((mu + u)/2) = 0`.",
            ],
            guess: quote! { self.h },
            generic: quote! { ::lie_runtime::generic::Midpoint::new(self.system, self.h) },
            coadjoint: false,
            chart: None,
            result: None,
        };
        let equation = self.fused(&form, &kernels);
        (equation, format_ident!("{}Midpoint", self.blueprint.name))
    }

    fn fused_cayley(&mut self) -> TokenStream {
        let Some(kernels) = self.source.cayley_kernels() else {
            return TokenStream::new();
        };
        let form = Form {
            suffix: "CayleyMidpoint",
            label: "lie-midpoint cayley",
            docs: &[
                "The retraction method with the Cayley map, unknown the momentum `m` at the midpoint:",
                "`m - ad*_x m/2 - Q_x m/4 - mu = 0` with `x = h grad H(m)`, then `mu1 = mu + ad*_x m`.",
            ],
            guess: quote! { self.h * S::ratio(1.0, 2.0) },
            generic: quote! { ::lie_runtime::generic::CayleyMidpoint::new(self.system, self.h) },
            coadjoint: true,
            chart: Some(quote! {
                ::lie_runtime::generic::cayley_chart_of_step(self.system, self.h, unknown)
            }),
            result: None,
        };
        let equation = self.fused(&form, &kernels);
        let name = format_ident!("{}CayleyMidpoint", self.blueprint.name);
        let method = quote! {
            ::lie_runtime::methods::LieMidpoint<::lie_runtime::methods::Cayley>
        };
        let hook = self.implicit(&method, &name, &quote! { #name::new(self, h) });
        quote! { #equation #hook }
    }

    /// Whether the Cayley map of the representation has poles along real elements.
    pub(super) fn has_poles(&self) -> bool {
        self.known_spectrum() != Some(Spectrum::Imaginary)
    }

    /// The struct of a fused equation and its impl.
    pub(super) fn fused(&mut self, form: &Form, kernels: &[Kernel]) -> TokenStream {
        let mut step = Prepared::default();
        let n = self.source.dimension;
        let unknown = self.argument("unknown");
        let start = unknown.clone();
        let ratios = index(2 * self.source.spins.as_ref().map_or(0, Vec::len));
        let place = move |name: &str| match name {
            "mu" => quote! { self.base },
            "inverse" => {
                quote! { ::lie_runtime::generic::inverse_length(&self.base, #start) }
            }
            "ratios" => {
                quote! { ::lie_runtime::generic::sphere_ratios::<S, _, #ratios>(self.system, &self.base, #start) }
            }
            _ => quote! { #start },
        };
        let mut methods = TokenStream::new();
        let mut elimination = Elimination::default();
        let (mut has_result, mut has_guess) = (false, false);
        for kernel in kernels {
            let program = kernel.program(&mut self.source.graph);
            let docs =
                self.kernel_docs(&format!("{} {}", form.label, kernel.name), kernel, &program);
            let name = ident(kernel.name);
            let method = match &kernel.shape {
                Shape::VectorAndMatrix(_, places) => {
                    elimination = eliminate(n, places, &program);
                    let body =
                        self.linearize_body(kernel, &program, &mut step, &place, &elimination);
                    let (residual, matrix) = (self.argument("residual"), self.argument("matrix"));
                    quote! {
                        #docs
                        #[inline]
                        fn linearize(&mut self, #unknown: &Self::State, #residual: &mut Self::State, #matrix: &mut Self::Matrix) {
                            #body
                        }
                    }
                }
                _ if kernel.name == "initial_guess" => {
                    has_guess = true;
                    let (owner, targets) = (Owner::Equation, &["unknown"]);
                    let body =
                        self.kernel_body(kernel, &program, owner, &mut step, &place, targets);
                    quote! {
                        #docs
                        #[inline]
                        fn initial_guess(&mut self, #unknown: &mut Self::Unknown) {
                            #body
                        }
                    }
                }
                _ => {
                    let target = if kernel.name == "result" {
                        "mu"
                    } else {
                        "residual"
                    };
                    has_result |= kernel.name == "result";
                    let body = self.kernel_body(
                        kernel,
                        &program,
                        Owner::Equation,
                        &mut step,
                        &place,
                        &[target],
                    );
                    let target = self.argument(target);
                    quote! {
                        #docs
                        #[inline]
                        fn #name(&mut self, #unknown: &Self::State, #target: &mut Self::State) {
                            #body
                        }
                    }
                }
            };
            methods.extend(method);
        }
        if !has_result {
            let unchanged = quote! { *mu = *unknown; };
            let body = form.result.as_ref().unwrap_or(&unchanged);
            methods.extend(quote! {
                #[inline]
                fn result(&mut self, unknown: &Self::State, mu: &mut Self::State) {
                    #body
                }
            });
        }
        if !has_guess {
            let guess = &form.guess;
            methods.extend(quote! {
                #[inline]
                fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
                    let mut field = self.base;
                    ::lie_runtime::Poisson::vector_field(self.system, &self.base, &mut field);
                    *unknown = self.base;
                    ::lie_runtime::State::axpy(unknown, #guess, &field);
                }
            });
        }
        methods.extend(self.elimination_methods(&elimination));
        let generic = &form.generic;
        methods.extend(if form.coadjoint {
            quote! {
                fn group_factor(&mut self, unknown: &Self::State, xi: &mut Self::State) -> ::core::option::Option<::lie_runtime::methods::Retraction> {
                    let mut equation = #generic;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::group_factor(&mut equation, unknown, xi)
                }
            }
        } else {
            quote! {
                fn velocity(&mut self, unknown: &Self::State, stage: usize, xi: &mut Self::State) -> usize {
                    let mut equation = #generic;
                    ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                    ::lie_runtime::Equation::velocity(&mut equation, unknown, stage, xi)
                }
            }
        });
        if let Some(element) = form.chart.as_ref().filter(|_| self.has_poles()) {
            methods.extend(quote! {
                fn within_chart(&mut self, unknown: &Self::State) -> S::Mask {
                    #element
                }
            });
        }
        let table = super::fixed_order::table(
            &format_ident!("{}{}", self.blueprint.name, form.suffix),
            &elimination,
        );
        let equation = self.equation_struct(form, &step, methods);
        quote! { #equation #table }
    }

    /// Residual and Jacobian; entries that only fill in during elimination are cleared.
    fn linearize_body(
        &mut self,
        kernel: &Kernel,
        program: &Program,
        step: &mut Prepared,
        place: &dyn Fn(&str) -> TokenStream,
        elimination: &Elimination,
    ) -> TokenStream {
        let unpacked: TokenStream = kernel
            .arguments
            .iter()
            .map(|a| self.unpack(a, program, &place(a.name)))
            .collect();
        let (statements, outputs) = self.program(program, |writer, value| {
            writer.value(value, Owner::Equation, step)
        });
        let Shape::VectorAndMatrix(indices, places) = &kernel.shape else {
            return TokenStream::new();
        };
        let (residual, matrix) = (self.argument("residual"), self.argument("matrix"));
        let entries = indices.iter().zip(&outputs).map(|(i, value)| {
            let i = index(*i);
            quote! { #residual[#i] = #value; }
        });
        let slopes = places
            .iter()
            .zip(&outputs[indices.len()..])
            .map(|((i, j), value)| {
                let (i, j) = (index(*i), index(*j));
                quote! { #matrix[(#i, #j)] = #value; }
            });
        let fill = elimination.fill.iter().map(|(i, j)| {
            let (i, j) = (index(*i), index(*j));
            quote! { #matrix[(#i, #j)] = S::zero(); }
        });
        quote! { #unpacked #statements #(#entries)* #(#slopes)* #(#fill)* }
    }

    /// `factor` and `solve` of a sparse matrix of n rows.
    fn elimination_methods(&self, elimination: &Elimination) -> TokenStream {
        if elimination.multiplications() > UNROLLED {
            return self.table_methods(elimination);
        }
        let factor = elimination.factor_tokens(&|i, j| place("matrix", i, j), &|i, j, value| {
            let place = place("matrix", i, j);
            quote! { #place = #value; }
        });
        let solve = elimination.solve_tokens(&|i, j| place("factors", i, j), &|i| {
            let i = index(i);
            quote! { residual[#i] }
        });
        let count = format!(
            " Sparse elimination in the order {:?}, {} entries of fill-in: {} multiplications with the solution.",
            elimination.order,
            elimination.fill.len(),
            elimination.multiplications()
        );
        quote! {
            #[doc = #count]
            #[inline]
            fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
                #factor
            }

            #[inline]
            fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
                #solve
            }
        }
    }

    /// The same from an index list, where written out it would be long.
    fn table_methods(&self, elimination: &Elimination) -> TokenStream {
        let count = format!(
            " Sparse elimination from an index list, {} entries of fill-in: {} multiplications with the solution.",
            elimination.fill.len(),
            elimination.multiplications()
        );
        quote! {
            #[doc = #count]
            fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
                Self::ELIMINATION.factor(matrix)
            }

            fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
                Self::ELIMINATION.solve(factors, residual);
            }
        }
    }

    fn equation_struct(
        &mut self,
        form: &Form,
        step: &Prepared,
        methods: TokenStream,
    ) -> TokenStream {
        let n = index(self.source.dimension);
        let visibility = &self.blueprint.visibility;
        let (system, name) = (
            self.system_name(),
            format_ident!("{}{}", self.blueprint.name, form.suffix),
        );
        let constants = step.all().to_vec();
        let names: Vec<Ident> = (0..constants.len()).map(step_name).collect();
        let texts: Vec<String> = constants
            .iter()
            .map(|id| format!(" `{}`", self.constant_text(*id)))
            .collect();
        let (statements, values) =
            self.preparation(&constants, &|name| quote! { system._parameters.#name });
        let docs = form.docs.iter().map(|line| format!(" {line}"));
        quote! {
            #(#[doc = #docs])*
            #[derive(Clone, Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                base: ::lie_runtime::__private::SVector<S, #n>,
                h: S,
                #(#[doc = #texts] #names: S,)*
            }

            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The equation of a step of size h; what depends on h alone is computed here, once."]
                #[must_use]
                pub fn new(system: &'a #system<S>, h: S) -> Self {
                    #statements
                    Self { system, base: ::lie_runtime::Poisson::zero_state(system), h, #(#names: #values),* }
                }
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
        }
    }
}

/// An entry of a matrix.
pub fn place(matrix: &str, i: usize, j: usize) -> TokenStream {
    let (matrix, i, j) = (ident(matrix), index(i), index(j));
    quote! { #matrix[(#i, #j)] }
}

/// The elimination of a Jacobian; diagonal entries that are the number one are known to be it.
fn eliminate(n: usize, places: &[(usize, usize)], program: &Program) -> Elimination {
    let matrix = &program.outputs[program.outputs.len() - places.len()..];
    let unit: BTreeSet<usize> = places
        .iter()
        .zip(matrix)
        .filter(|((i, j), value)| {
            i == j && matches!(value, Value::Number(number) if number.is_one())
        })
        .map(|((i, _), _)| *i)
        .collect();
    Elimination::new(n, places, &unit)
}
