//! Gauss collocation and the exponential retraction: the generic equation assembles the Jacobian
//! from the kernels, its elimination is specialised to the pattern.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::elimination::{Elimination, UNROLLED};
use super::names::index;

impl Writer<'_> {
    /// Gauss collocation with a number of stages.
    pub fn fused_gauss(&mut self, stages: usize) -> TokenStream {
        let (equation, name) = self.gauss_equation(stages);
        let method = format_ident!("Gauss{}", 2 * stages);
        let method = quote! { ::lie_runtime::methods::#method };
        let value = quote! { #name(::lie_runtime::generic::Gauss::new(self, h)) };
        let hook = self.implicit(&method, &name, &value);
        quote! { #equation #hook }
    }

    /// The equation of Gauss collocation, and its name.
    pub(super) fn gauss_equation(&mut self, stages: usize) -> (TokenStream, Ident) {
        let n = self.source.dimension;
        let field = self.source.field_of_h();
        let slopes = self.source.jacobian_of(&field);
        let mut pattern = Vec::new();
        let mut unit = BTreeSet::new();
        for row in 0..stages * n {
            let depends: Vec<usize> = (0..n)
                .filter(|&j| !self.source.graph.is_zero(slopes[row % n][j]))
                .collect();
            if depends.is_empty() {
                unit.insert(row);
            }
            pattern.extend(
                (0..stages).flat_map(|block| depends.iter().map(move |j| (row, block * n + j))),
            );
        }
        let elimination = Elimination::new(stages * n, &pattern, &unit);
        let system = self.system_name();
        let name = format_ident!("{}Gauss{}", self.blueprint.name, 2 * stages);
        let count = index(stages);
        let doc = format!(
            " Gauss collocation of order {} with elimination specialised to the pattern of the system.",
            2 * stages
        );
        let inner = quote! { ::lie_runtime::generic::Gauss<'a, S, #system<S>, #count> };
        let matrix = |name: &str, i: usize, j: usize| {
            let (name, p, q, i, j) = (
                super::names::ident(name),
                index(i / n),
                index(j / n),
                index(i % n),
                index(j % n),
            );
            quote! { #name.0[#p][#q][(#i, #j)] }
        };
        let entry = |i: usize| {
            let (p, i) = (index(i / n), index(i % n));
            quote! { residual.0[#p][#i] }
        };
        let methods = self.specialised(
            &format!("gauss{} elimination", 2 * stages),
            &elimination,
            &matrix,
            &entry,
        );
        let visibility = &self.blueprint.visibility;
        let table = table(&name, &elimination);
        let equation = quote! {
            #[doc = #doc]
            #[derive(Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar>(#inner);

            #table

            impl<'a, S: ::lie_runtime::Scalar> ::lie_runtime::Equation<S> for #name<'a, S> {
                type State = <#inner as ::lie_runtime::Equation<S>>::State;
                type Unknown = <#inner as ::lie_runtime::Equation<S>>::Unknown;
                type Matrix = <#inner as ::lie_runtime::Equation<S>>::Matrix;
                #methods
            }
        };
        (equation, name)
    }

    /// The retraction method with the exponential.
    pub fn fused_exp(&mut self) -> TokenStream {
        let system = self.system_name();
        let hessian = self.source.hessian_of_h();
        let hessian: Vec<Vec<bool>> = hessian
            .iter()
            .map(|row| row.iter().map(|e| !self.source.graph.is_zero(*e)).collect())
            .collect();
        let pattern = self.exp_pattern(&hessian);
        let name = format_ident!("{}ExpMidpoint", self.blueprint.name);
        let equation = self.eliminated(
            &name,
            "The retraction method with the exponential",
            "lie-midpoint exp elimination",
            &quote! { ::lie_runtime::generic::ExpMidpoint<'a, S, #system<S>> },
            &pattern,
        );
        let method = quote! {
            ::lie_runtime::methods::LieMidpoint<::lie_runtime::methods::Exp>
        };
        let value = quote! { #name(::lie_runtime::generic::ExpMidpoint::new(self, h)) };
        let hook = self.implicit(&method, &name, &value);
        quote! { #equation #hook }
    }

    /// A generic equation whose unknown is a state, with an elimination of its own.
    pub(super) fn eliminated(
        &mut self,
        name: &Ident,
        doc: &str,
        label: &str,
        inner: &TokenStream,
        pattern: &[(usize, usize)],
    ) -> TokenStream {
        let n = self.source.dimension;
        let unit = (0..n)
            .filter(|i| !pattern.iter().any(|(row, _)| row == i))
            .collect();
        let elimination = Elimination::new(n, pattern, &unit);
        let matrix = |name: &str, i: usize, j: usize| super::equation::place(name, i, j);
        let entry = |i: usize| {
            let i = index(i);
            quote! { residual[#i] }
        };
        let methods = self.specialised(label, &elimination, &matrix, &entry);
        let visibility = &self.blueprint.visibility;
        let table = table(name, &elimination);
        let doc = format!(" {doc}, elimination specialised to the pattern of the system.");
        quote! {
            #[doc = #doc]
            #[derive(Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar>(#inner);

            #table

            impl<'a, S: ::lie_runtime::Scalar> ::lie_runtime::Equation<S> for #name<'a, S> {
                type State = <#inner as ::lie_runtime::Equation<S>>::State;
                type Unknown = <#inner as ::lie_runtime::Equation<S>>::Unknown;
                type Matrix = <#inner as ::lie_runtime::Equation<S>>::Matrix;
                #methods
            }
        }
    }

    /// The pattern of `1 - d/dx[phi1(ad*_x) mu] S''` with the Hessian of S: what `ad*` reaches from
    /// `Pi S''`.
    pub(super) fn exp_pattern(&mut self, hessian: &[Vec<bool>]) -> Vec<(usize, usize)> {
        let n = self.source.dimension;
        let constants = self.source.all_constants();
        let mut reach: Vec<BTreeSet<usize>> = (0..n).map(|i| BTreeSet::from([i])).collect();
        loop {
            let before: usize = reach.iter().map(BTreeSet::len).sum();
            for &(_, j, k, _) in &constants {
                let further = reach[k].clone();
                reach[j].extend(further);
            }
            if reach.iter().map(BTreeSet::len).sum::<usize>() == before {
                break;
            }
        }
        let mut places = BTreeSet::new();
        for &(a, b, _, _) in &constants {
            for (i, reached) in reach.iter().enumerate() {
                if reached.contains(&b) {
                    let columns = (0..n).filter(|&j| hessian[a][j]);
                    places.extend(columns.map(|j| (i, j)));
                }
            }
        }
        places.into_iter().collect()
    }

    /// The methods of a wrapper around a generic equation with its own elimination.
    pub(super) fn specialised(
        &mut self,
        label: &str,
        elimination: &Elimination,
        matrix: &dyn Fn(&str, usize, usize) -> TokenStream,
        entry: &dyn Fn(usize) -> TokenStream,
    ) -> TokenStream {
        self.counts.push((label.to_string(), elimination.counts()));
        let unrolled = elimination.multiplications() <= UNROLLED;
        let (factor, solve) = if unrolled {
            let read = |i: usize, j: usize| matrix("matrix", i, j);
            let write = |i: usize, j: usize, value: TokenStream| {
                let place = matrix("matrix", i, j);
                quote! { #place = #value; }
            };
            let factors = |i: usize, j: usize| matrix("factors", i, j);
            (
                elimination.factor_tokens(&read, &write),
                elimination.solve_tokens(&factors, entry),
            )
        } else {
            (
                quote! { Self::ELIMINATION.factor(matrix) },
                quote! { Self::ELIMINATION.solve(factors, residual); },
            )
        };
        let doc = format!(
            " Elimination in a fixed order, {} entries of fill-in: {} multiplications with the solution.",
            elimination.fill.len(),
            elimination.multiplications()
        );
        quote! {
            fn zero_unknown(&self) -> Self::Unknown {
                self.0.zero_unknown()
            }

            fn zero_matrix(&self) -> Self::Matrix {
                self.0.zero_matrix()
            }

            fn set_base(&mut self, mu: &Self::State) {
                self.0.set_base(mu);
            }

            fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
                self.0.initial_guess(unknown);
            }

            fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
                self.0.residual(unknown, residual);
            }

            #[inline]
            fn linearize(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown, matrix: &mut Self::Matrix) {
                self.0.linearize(unknown, residual, matrix);
            }

            #[doc = #doc]
            #[inline]
            fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
                #factor
            }

            #[inline]
            fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
                #solve
            }

            fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State) {
                self.0.result(unknown, mu);
            }

            fn group_factor(&mut self, unknown: &Self::Unknown, xi: &mut Self::State) -> ::core::option::Option<::lie_runtime::methods::Retraction> {
                self.0.group_factor(unknown, xi)
            }

            fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut Self::State) -> usize {
                self.0.velocity(unknown, stage, xi)
            }
        }
    }
}

/// The index list of an elimination that is not written out.
pub fn table(name: &Ident, elimination: &Elimination) -> TokenStream {
    if elimination.multiplications() <= UNROLLED {
        return TokenStream::new();
    }
    let list = elimination.table_tokens();
    quote! {
        impl<S: ::lie_runtime::Scalar> #name<'_, S> {
            const ELIMINATION: ::lie_runtime::__private::StaticElimination = #list;
        }
    }
}
