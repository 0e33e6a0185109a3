//! Eliminations as Rust.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::names::{ident, index};
use crate::plan::elimination::{Elimination, Step};
use crate::plan::{Sparse, Unknown};

/// Reads an entry of the matrix.
pub type Read<'a> = dyn Fn(usize, usize) -> TokenStream + 'a;
/// Writes an entry of the matrix.
pub type Write<'a> = dyn Fn(usize, usize, TokenStream) -> TokenStream + 'a;

impl Printer<'_> {
    /// The elimination of a pattern as a type.
    pub(super) fn sparse(&self, sparse: &Sparse) -> TokenStream {
        let Sparse {
            unknown,
            elimination,
            ..
        } = sparse;
        let name = self.type_name(&sparse.suffix);
        let (factor, solve) = self.factor_and_solve(sparse);
        let table = (!elimination.is_unrolled()).then(|| {
            let list = elimination.table_tokens();
            quote! {
                impl #name {
                    const LIST: ::lie_runtime::__private::StaticElimination = #list;
                }
            }
        });
        let n = self.plan.dimension();
        let (size, rows) = (index(n), unknown.states() * n);
        let mut matrix = quote! { ::lie_runtime::__private::SMatrix<S, #size, #size> };
        let mut vector = quote! { ::lie_runtime::__private::SVector<S, #size> };
        if let Unknown::Stages(count) = unknown {
            let count = index(*count);
            matrix = quote! { ::lie_runtime::__private::StageMatrix<#matrix, #count> };
            vector = quote! { ::lie_runtime::__private::Stages<#vector, #count> };
        }
        let doc = format!(
            " Elimination of {} rows in a fixed order, {} entries of fill-in: {} multiplications with the solution.",
            rows,
            elimination.fill.len(),
            elimination.multiplications()
        );
        let visibility = &self.surface.visibility;
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

    /// The two bodies: written out, or by the list of the type.
    fn factor_and_solve(&self, sparse: &Sparse) -> (TokenStream, TokenStream) {
        let n = self.plan.dimension();
        let one_state = sparse.unknown == Unknown::State;
        let entry = |name: &str, i: usize, j: usize| {
            let matrix = ident(name);
            let (p, q, i, j) = (index(i / n), index(j / n), index(i % n), index(j % n));
            match one_state {
                true => quote! { #matrix[(#i, #j)] },
                false => quote! { #matrix.0[#p][#q][(#i, #j)] },
            }
        };
        let right = |i: usize| {
            let (p, i) = (index(i / n), index(i % n));
            match one_state {
                true => quote! { vector[#i] },
                false => quote! { vector.0[#p][#i] },
            }
        };
        let write = |i: usize, j: usize, value: TokenStream| {
            let place = entry("matrix", i, j);
            quote! { #place = #value; }
        };
        let elimination = &sparse.elimination;
        if elimination.is_unrolled() {
            (
                elimination.factor_tokens(&|i, j| entry("matrix", i, j), &write),
                elimination.solve_tokens(&|i, j| entry("factors", i, j), &right),
            )
        } else {
            (
                quote! { Self::LIST.factor(matrix) },
                quote! { Self::LIST.solve(factors, vector); },
            )
        }
    }
}

impl Elimination {
    /// The factorisation written out over a matrix; evaluates to the mask of safe lanes.
    pub fn factor_tokens(&self, read: &Read<'_>, write: &Write<'_>) -> TokenStream {
        let mut code = Factorisation {
            read,
            known: BTreeSet::new(),
            body: TokenStream::new(),
        };
        let mut changed: BTreeSet<(usize, usize)> = BTreeSet::new();
        let mut inverses = Vec::new();
        for step in &self.steps {
            match *step {
                Step::Pivot(k) => {
                    let pivot = code.entry(k, k);
                    code.body.extend(quote! { let #pivot = S::one() / #pivot; });
                    inverses.push(pivot);
                    changed.insert((k, k));
                }
                Step::Multiplier(i, k) => {
                    let (entry, pivot) = (code.entry(i, k), code.entry(k, k));
                    code.body.extend(quote! { let #entry = #entry * #pivot; });
                    changed.insert((i, k));
                }
                Step::Update(i, k, j) => {
                    let (factor, right) = (code.entry(i, k), code.entry(k, j));
                    let name = local(i, j);
                    if self.fill.contains(&(i, j)) && changed.insert((i, j)) {
                        code.known.insert((i, j));
                        code.body
                            .extend(quote! { let #name = -(#factor * #right); });
                    } else {
                        code.entry(i, j);
                        code.body
                            .extend(quote! { let #name = #name - #factor * #right; });
                        changed.insert((i, j));
                    }
                }
            }
        }
        let writes = changed.iter().map(|&(i, j)| {
            let name = local(i, j);
            write(i, j, quote! { #name })
        });
        let safe = match inverses.split_first() {
            None => quote! { <S::Mask as ::lie_runtime::Mask>::splat(true) },
            Some((first, rest)) => quote! {
                ::lie_runtime::__private::inverse_pivots_are_safe(#first.abs() #(+ #rest.abs())*)
            },
        };
        let body = code.body;
        quote! { #body #(#writes)* #safe }
    }

    /// The elimination as a table for the runtime.
    pub fn table_tokens(&self) -> TokenStream {
        let place = self.places();
        let list = |mut entries: Vec<usize>| {
            entries.sort_by_key(|k| place[k]);
            let entries = entries.into_iter().map(index);
            quote! { &[#(#entries),*] }
        };
        let order = self.acting().map(index);
        let below = self.acting().map(|k| {
            list(
                self.order
                    .iter()
                    .copied()
                    .filter(|i| place[i] > place[&k] && self.rows[i].contains(&k))
                    .collect(),
            )
        });
        let right = self.acting().map(|k| list(self.split(k).1));
        quote! {
            ::lie_runtime::__private::StaticElimination {
                order: &[#(#order),*],
                below: &[#(#below),*],
                right: &[#(#right),*],
            }
        }
    }

    /// The solution written out: the right-hand side is replaced by the solution.
    pub fn solve_tokens(
        &self,
        read: &Read<'_>,
        entry: &dyn Fn(usize) -> TokenStream,
    ) -> TokenStream {
        let mut body = TokenStream::new();
        let name = |i: usize| format_ident!("_b{i}");
        for &i in &self.order {
            let b = name(i);
            let value = entry(i);
            let (left, _) = self.split(i);
            let terms = left.iter().map(|&k| {
                let (factor, other) = (read(i, k), name(k));
                quote! { - #factor * #other }
            });
            body.extend(quote! { let #b = #value #(#terms)*; });
        }
        for &i in self.order.iter().rev() {
            let b = name(i);
            let (_, right) = self.split(i);
            let terms = right.iter().map(|&j| {
                let (factor, other) = (read(i, j), name(j));
                quote! { - #factor * #other }
            });
            let pivot = read(i, i);
            match (right.is_empty(), self.unit.contains(&i)) {
                (true, true) => {}
                (true, false) => body.extend(quote! { let #b = #b * #pivot; }),
                (false, true) => body.extend(quote! { let #b = #b #(#terms)*; }),
                (false, false) => body.extend(quote! { let #b = (#b #(#terms)*) * #pivot; }),
            }
        }
        let writes = (0..self.order.len()).map(|i| {
            let (target, b) = (entry(i), name(i));
            quote! { #target = #b; }
        });
        quote! { #body #(#writes)* }
    }
}

/// The factorisation under construction: entries are loaded at their first use.
struct Factorisation<'a> {
    read: &'a Read<'a>,
    known: BTreeSet<(usize, usize)>,
    body: TokenStream,
}

impl Factorisation<'_> {
    fn entry(&mut self, i: usize, j: usize) -> Ident {
        let name = local(i, j);
        if self.known.insert((i, j)) {
            let value = (self.read)(i, j);
            self.body.extend(quote! { let #name = #value; });
        }
        name
    }
}

fn local(i: usize, j: usize) -> Ident {
    format_ident!("_a{i}_{j}")
}

/// `factor` and `solve` of the Jacobian of an equation: written out, or from an index list where that would be long.
pub(super) fn methods(elimination: &Elimination) -> TokenStream {
    let (fill, multiplications) = (elimination.fill.len(), elimination.multiplications());
    let cost =
        format!("{fill} entries of fill-in: {multiplications} multiplications with the solution.");
    if !elimination.is_unrolled() {
        let doc = format!(" Sparse elimination from an index list, {cost}");
        return quote! {
            #[doc = #doc]
            fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
                Self::ELIMINATION.factor(matrix)
            }

            fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
                Self::ELIMINATION.solve(factors, residual);
            }
        };
    }
    let factor = elimination.factor_tokens(&|i, j| place("matrix", i, j), &|i, j, value| {
        let place = place("matrix", i, j);
        quote! { #place = #value; }
    });
    let solve = elimination.solve_tokens(&|i, j| place("factors", i, j), &|i| {
        let i = index(i);
        quote! { residual[#i] }
    });
    let doc = format!(
        " Sparse elimination in the order {:?}, {cost}",
        elimination.order
    );
    quote! {
        #[doc = #doc]
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

/// An entry of a matrix.
fn place(matrix: &str, i: usize, j: usize) -> TokenStream {
    let (matrix, i, j) = (ident(matrix), index(i), index(j));
    quote! { #matrix[(#i, #j)] }
}
