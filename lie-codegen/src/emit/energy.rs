//! Methods that keep the energy: discrete gradients, with orbits, and collocation.
//!
//! For a quadratic H the discrete gradients are the gradient at the middle: the methods along them
//! run on the equations of the midpoint rule and of Gauss collocation. For other polynomials they have
//! closed forms, which are fused; for all else the generic equation is assembled from the kernels and
//! its elimination specialised to the pattern.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::elimination::{Elimination, UNROLLED};
use super::equation::Form;
use super::names::{ident, index};
use super::prepared::{Owner, Prepared};
use crate::derive::{Kernel, Shape};
use crate::methods::{Choice, Gradient, Tensor};
use crate::symbolic::Symbol;

/// Polynomials up to this degree have fused closed forms.
const CLOSED: u32 = 6;
/// Beyond this number of nodes of H times coordinates to the power of the derivatives that are taken,
/// closed forms swell.
const LARGEST: usize = 10_000;

/// What a discrete gradient is called.
struct Names {
    /// The method in the runtime.
    method: &'static str,
    /// The generic equation for [`::lie_runtime::generic_equations`], without and with orbits.
    generic: [&'static str; 2],
    /// The generic gradient and suffix of the closed one, and the key of its orbits.
    suffixes: [&'static str; 2],
    /// Doc lines of its fused equation.
    docs: &'static [&'static str],
}

const fn names(gradient: Gradient) -> Names {
    match gradient {
        Gradient::Gonzalez => Names {
            method: "Gonzalez",
            generic: ["gonzalez", "orbit_gonzalez"],
            suffixes: ["GonzalezGradient", "OrbitGonzalez"],
            docs: &[
                "The midpoint discrete gradient method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
        Gradient::MeanValue => Names {
            method: "MeanValue",
            generic: ["mean_value", "orbit_mean_value"],
            suffixes: ["MeanValueGradient", "OrbitMeanValue"],
            docs: &[
                "The mean-value discrete gradient method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
        Gradient::ItohAbe => Names {
            method: "ItohAbe",
            generic: ["itoh_abe", "orbit_itoh_abe"],
            suffixes: ["ItohAbeGradient", "OrbitItohAbe"],
            docs: &[
                "The symmetrised coordinate-increment method, unknown `u = mu1`: `u - mu - h Pi((mu + u)/2) g(mu, u) = 0`.",
            ],
        },
    }
}

/// An equation: its type, with a lifetime `'a` and a scalar S, and its value in terms of `self` and `h`.
#[derive(Clone)]
struct Known {
    equation: TokenStream,
    value: TokenStream,
}

impl Known {
    /// A fused equation of that name.
    fn fused(name: &Ident) -> Self {
        Self {
            equation: quote! { #name<'a, S> },
            value: quote! { #name::new(self, h) },
        }
    }
}

/// Equations that several methods may share.
#[derive(Default)]
struct Shared {
    tokens: TokenStream,
    known: Vec<(String, Known)>,
    eliminations: Vec<(usize, Vec<(usize, usize)>)>,
}

impl Writer<'_> {
    /// The equations of these methods: fused where asked for, the others named in `generic`.
    pub fn energy(&mut self, generic: &mut Vec<Ident>) -> TokenStream {
        let mut shared = Shared::default();
        let mut hooks = TokenStream::new();
        let mut left: [Vec<Ident>; 3] = Default::default();
        let [steps, orbits, collocation] = &mut left;
        for gradient in Gradient::ALL.iter().copied() {
            let [plain, orbit] = names(gradient).generic;
            let method = ident(names(gradient).method);
            if self.asked(&Choice::DiscreteGradient(gradient, Tensor::Midpoint)) {
                let known = self.discrete_gradient(gradient, &mut shared);
                let method = quote! { ::lie_runtime::methods::#method };
                hooks.extend(self.hook(&method, &known));
            } else {
                steps.push(ident(plain));
            }
            if !self.source.is_lie() {
                continue;
            }
            if self.asked(&Choice::OrbitEnergy(gradient)) {
                let known = self.orbit_energy(gradient, &mut shared);
                let method = quote! {
                    ::lie_runtime::methods::OrbitEnergy<::lie_runtime::methods::#method>
                };
                hooks.extend(self.hook(&method, &known));
            } else {
                orbits.push(ident(orbit));
            }
        }
        for stages in 1..=3_usize {
            let order = 2 * stages as u32;
            if self.asked(&Choice::CohenHairer(order)) {
                let known = self.cohen_hairer(stages, &mut shared);
                let stages = index(stages);
                let method = quote! { ::lie_runtime::methods::CohenHairer<#stages> };
                hooks.extend(self.hook(&method, &known));
            } else {
                collocation.push(format_ident!("cohen_hairer{order}"));
            }
        }
        for (family, left) in ["discrete_gradients", "orbit_energy", "cohen_hairer"]
            .into_iter()
            .zip(left)
        {
            if left.len() == 3 {
                generic.push(ident(family));
            } else {
                generic.extend(left);
            }
        }
        let tokens = shared.tokens;
        quote! { #tokens #hooks }
    }

    fn hook(&self, method: &TokenStream, known: &Known) -> TokenStream {
        let system = self.system_name();
        let Known { equation, value } = known;
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Implicit<S, #method> for #system<S> {
                type Equation<'a> = #equation where Self: 'a;
                fn equation<'a>(&'a self, _method: &#method, h: S) -> Self::Equation<'a> {
                    #value
                }
            }
        }
    }

    /// A generic equation, with its type's parameters, under an elimination of its own.
    fn eliminated_by(&self, elimination: &Ident, of: &str, parameters: &TokenStream) -> Known {
        let of = ident(of);
        Known {
            equation: quote! {
                ::lie_runtime::__private::Eliminated<
                    ::lie_runtime::generic::#of<'a, S, Self, #parameters>, #elimination
                >
            },
            value: quote! {
                ::lie_runtime::__private::Eliminated::new(::lie_runtime::generic::#of::new(self, h))
            },
        }
    }

    /// The elimination of a pattern, emitted once; several stages repeat it in every block.
    fn elimination(
        &mut self,
        shared: &mut Shared,
        stages: usize,
        block: Vec<(usize, usize)>,
    ) -> Ident {
        let name =
            |position: usize| format_ident!("{}Elimination{}", self.blueprint.name, position + 1);
        let key = (stages, block);
        if let Some(position) = shared.eliminations.iter().position(|known| *known == key) {
            return name(position);
        }
        let name = name(shared.eliminations.len());
        let (_, block) = &key;
        let n = self.source.dimension;
        let mut pattern = Vec::new();
        for row in 0..stages {
            for column in 0..stages {
                pattern.extend(block.iter().map(|(i, j)| (row * n + i, column * n + j)));
            }
        }
        let unit = (0..stages * n)
            .filter(|i| !pattern.iter().any(|(row, _)| row == i))
            .collect();
        let elimination = Elimination::new(stages * n, &pattern, &unit);
        shared.eliminations.push(key);
        self.counts.push((
            format!("elimination {}", shared.eliminations.len()),
            elimination.counts(),
        ));
        shared
            .tokens
            .extend(self.elimination_type(&name, stages, &elimination));
        name
    }

    fn elimination_type(
        &self,
        name: &Ident,
        stages: usize,
        elimination: &Elimination,
    ) -> TokenStream {
        let n = self.source.dimension;
        let entry = |name: &str, i: usize, j: usize| {
            let matrix = ident(name);
            let (p, q, i, j) = (index(i / n), index(j / n), index(i % n), index(j % n));
            if stages == 1 {
                quote! { #matrix[(#i, #j)] }
            } else {
                quote! { #matrix.0[#p][#q][(#i, #j)] }
            }
        };
        let right = |i: usize| {
            let (p, i) = (index(i / n), index(i % n));
            if stages == 1 {
                quote! { vector[#i] }
            } else {
                quote! { vector.0[#p][#i] }
            }
        };
        let mut table = TokenStream::new();
        let (factor, solve) = if elimination.multiplications() > UNROLLED {
            let list = elimination.table_tokens();
            table = quote! {
                impl #name {
                    const LIST: ::lie_runtime::__private::StaticElimination = #list;
                }
            };
            (
                quote! { Self::LIST.factor(matrix) },
                quote! { Self::LIST.solve(factors, vector); },
            )
        } else {
            let write = |i: usize, j: usize, value: TokenStream| {
                let place = entry("matrix", i, j);
                quote! { #place = #value; }
            };
            (
                elimination.factor_tokens(&|i, j| entry("matrix", i, j), &write),
                elimination.solve_tokens(&|i, j| entry("factors", i, j), &right),
            )
        };
        let (size, count) = (index(n), index(stages));
        let mut matrix = quote! { ::lie_runtime::__private::SMatrix<S, #size, #size> };
        let mut vector = quote! { ::lie_runtime::__private::SVector<S, #size> };
        if stages > 1 {
            matrix = quote! { ::lie_runtime::__private::StageMatrix<#matrix, #count> };
            vector = quote! { ::lie_runtime::__private::Stages<#vector, #count> };
        }
        let doc = format!(
            " Elimination of {} rows in a fixed order, {} entries of fill-in: {} multiplications with the solution.",
            stages * n,
            elimination.fill.len(),
            elimination.multiplications()
        );
        let visibility = &self.blueprint.visibility;
        quote! {
            #[doc = #doc]
            #[derive(Clone, Copy, Debug)]
            #visibility struct #name;

            #table

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::__private::FixedElimination<S, #matrix, #vector> for #name {
                #[inline]
                fn factor(matrix: &mut #matrix) -> S::Mask {
                    #factor
                }

                #[inline]
                fn solve(factors: &#matrix, vector: &mut #vector) {
                    #solve
                }
            }
        }
    }

    fn quadratic(&self) -> bool {
        self.blueprint.hamiltonian_degree.is_some_and(|d| d <= 2)
    }

    /// The degree of H if discrete gradients have closed forms of reasonable size.
    fn closed(&self) -> Option<u32> {
        let degree = self.blueprint.hamiltonian_degree?;
        let nodes = self.source.graph.dependencies(&[self.source.hamiltonian?]);
        let size = (2..degree).fold(nodes.len(), |size, _| {
            size.saturating_mul(self.source.dimension)
        });
        (degree <= CLOSED && size <= LARGEST).then_some(degree)
    }

    /// An equation that is emitted once.
    fn once(
        &mut self,
        shared: &mut Shared,
        key: &str,
        make: impl FnOnce(&mut Self, &mut Shared) -> Known,
    ) -> Known {
        if let Some((_, known)) = shared.known.iter().find(|(name, _)| name == key) {
            return known.clone();
        }
        let known = make(self, shared);
        shared.known.push((key.to_string(), known.clone()));
        known
    }

    /// The equation of a discrete gradient method.
    fn discrete_gradient(&mut self, gradient: Gradient, shared: &mut Shared) -> Known {
        if self.quadratic() {
            return self.once(shared, "midpoint", |writer, shared| {
                if !writer.asked(&Choice::Midpoint) {
                    shared.tokens.extend(writer.midpoint_equation().0);
                }
                Known::fused(&format_ident!("{}Midpoint", writer.blueprint.name))
            });
        }
        let names = names(gradient);
        self.once(shared, names.method, |writer, shared| {
            if let Some(degree) = writer.closed() {
                let kernels = writer.source.discrete_gradient_kernels(gradient, degree);
                let form = Form {
                    suffix: names.method,
                    label: gradient.name(),
                    docs: names.docs,
                    guess: quote! { self.h },
                    generic: {
                        let of = ident(names.suffixes[0]);
                        quote! {
                            ::lie_runtime::generic::DiscreteGradientStep::<
                                S, _, ::lie_runtime::generic::#of<S, _>,
                            >::new(self.system, self.h)
                        }
                    },
                    coadjoint: false,
                    chart: None,
                    result: None,
                };
                shared.tokens.extend(writer.fused(&form, &kernels));
                return Known::fused(&format_ident!("{}{}", writer.blueprint.name, names.method));
            }
            let pattern = writer.step_pattern(gradient);
            let elimination = writer.elimination(shared, 1, pattern);
            let of = ident(names.suffixes[0]);
            let of = quote! { ::lie_runtime::generic::#of<S, Self> };
            writer.eliminated_by(&elimination, "DiscreteGradientStep", &of)
        })
    }

    /// The equation of coadjoint motion along a discrete gradient.
    fn orbit_energy(&mut self, gradient: Gradient, shared: &mut Shared) -> Known {
        // for a quadratic H all three are the mean value, by one node
        let gradient = if self.quadratic() {
            Gradient::MeanValue
        } else {
            gradient
        };
        let names = names(gradient);
        self.once(shared, names.suffixes[1], |writer, shared| {
            let of = ident(names.suffixes[0]);
            let mut of = quote! { ::lie_runtime::generic::#of<S, Self> };
            if let Some(degree) = writer.closed().filter(|degree| *degree > 2) {
                let (closed, name) = writer.closed_gradient(gradient, degree);
                shared.tokens.extend(closed);
                of = quote! { #name<S> };
            }
            let derivative = writer.derivative_pattern(gradient);
            let pattern = writer.exp_pattern(&derivative);
            let elimination = writer.elimination(shared, 1, pattern);
            writer.eliminated_by(&elimination, "OrbitEnergyStep", &of)
        })
    }

    /// The equation of energy-preserving collocation.
    fn cohen_hairer(&mut self, stages: usize, shared: &mut Shared) -> Known {
        if stages == 1 {
            return self.discrete_gradient(Gradient::MeanValue, shared);
        }
        let order = 2 * stages;
        self.once(shared, &format!("cohen-hairer{order}"), |writer, shared| {
            if writer.quadratic() {
                if !writer.asked(&Choice::Gauss(stages)) {
                    shared.tokens.extend(writer.gauss_equation(stages).0);
                }
                let name = format_ident!("{}Gauss{order}", writer.blueprint.name);
                return Known {
                    equation: quote! { #name<'a, S> },
                    value: quote! { #name(::lie_runtime::generic::Gauss::new(self, h)) },
                };
            }
            let pattern = writer.step_pattern(Gradient::MeanValue);
            let elimination = writer.elimination(shared, stages, pattern);
            let count = index(stages);
            writer.eliminated_by(&elimination, "CohenHairerStep", &quote! { #count })
        })
    }

    /// The entries of the derivative of a discrete gradient that can be nonzero.
    fn derivative_pattern(&mut self, gradient: Gradient) -> Vec<Vec<bool>> {
        let n = self.source.dimension;
        if gradient == Gradient::Gonzalez && !self.quadratic() {
            return vec![vec![true; n]; n];
        }
        let hessian = self.source.hessian_of_h();
        let varies = |entry: &crate::symbolic::ExprId| !self.source.graph.is_zero(*entry);
        hessian
            .iter()
            .map(|row| row.iter().map(varies).collect())
            .collect()
    }

    /// The pattern of `1 - (h/2) d/dm[Pi(m) g] - h Pi(m) dg/du`, of an algebra with `ad*_g` in the middle.
    fn step_pattern(&mut self, gradient: Gradient) -> Vec<(usize, usize)> {
        let n = self.source.dimension;
        let derivative = self.derivative_pattern(gradient);
        let of_h = self.source.gradient_of_h();
        let mut places = BTreeSet::new();
        for (a, b, value) in self.source.poisson.clone().unwrap_or_default() {
            let varies: Vec<usize> = (0..n)
                .filter(|k| {
                    let symbols = self.source.graph.symbols(value);
                    symbols.contains(&Symbol::Coordinate(*k))
                })
                .collect();
            for (row, column) in [(a, b), (b, a)] {
                if gradient == Gradient::Gonzalez || !self.source.graph.is_zero(of_h[column]) {
                    places.extend(varies.iter().map(|k| (row, *k)));
                }
                places.extend((0..n).filter(|j| derivative[column][*j]).map(|j| (row, j)));
            }
        }
        for (a, b, k, _) in self.source.all_constants() {
            if gradient == Gradient::Gonzalez || !self.source.graph.is_zero(of_h[a]) {
                places.insert((b, k));
            }
            places.extend((0..n).filter(|j| derivative[a][*j]).map(|j| (b, j)));
        }
        places.into_iter().collect()
    }

    /// A closed discrete gradient as a type, and its name.
    fn closed_gradient(&mut self, gradient: Gradient, degree: u32) -> (TokenStream, Ident) {
        let kernels = self.source.gradient_kernels(gradient, degree);
        let names = names(gradient);
        let name = format_ident!("{}{}", self.blueprint.name, names.suffixes[0]);
        let methods: TokenStream = kernels
            .iter()
            .map(|kernel| self.gradient_method(gradient, kernel))
            .collect();
        let (system, n) = (self.system_name(), index(self.source.dimension));
        let visibility = &self.blueprint.visibility;
        let doc = format!(
            " The discrete gradient `{}` in closed form.",
            gradient.name()
        );
        let tokens = quote! {
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
        };
        (tokens, name)
    }

    fn gradient_method(&mut self, gradient: Gradient, kernel: &Kernel) -> TokenStream {
        let program = kernel.program(&mut self.source.graph);
        let label = format!("{} gradient {}", gradient.name(), kernel.name);
        let docs = self.kernel_docs(&label, kernel, &program);
        let place = |name: &str| match name {
            "mu" => quote! { self.start },
            "inverse" => quote! { ::lie_runtime::generic::inverse_length(&self.start, _end) },
            _ => quote! { _end },
        };
        let body = self.kernel_body(
            kernel,
            &program,
            Owner::Argument,
            &mut Prepared::default(),
            &place,
            &["_out", "_slopes"],
        );
        let (system, n) = (self.system_name(), index(self.source.dimension));
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let matrix = matches!(kernel.shape, Shape::VectorAndMatrix(..))
            .then(|| quote! { , _slopes: &mut ::lie_runtime::__private::SMatrix<S, #n, #n> });
        let name = ident(kernel.name);
        quote! {
            #docs
            #[inline]
            fn #name(&mut self, _system: &#system<S>, _end: &#state, _out: &mut #state #matrix) {
                #body
            }
        }
    }
}
