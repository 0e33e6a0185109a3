//! Equations of methods that need a structure: a representation, spins, inertia.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::elimination::{Elimination, UNROLLED};
use super::equation::Form;
use super::names::{ident, index};
use crate::methods::{Choice, Lift};
use crate::structure::inertia::Body;

impl Writer<'_> {
    /// The fused equations that are asked for; the others go to the list of generic ones.
    pub(super) fn collective(&mut self, generic: &mut Vec<Ident>) -> TokenStream {
        let mut tokens = TokenStream::new();
        if self.source.matrices.is_some() {
            // with one stage over a closed representation it is the retraction method
            let closed = self.source.triple.is_some();
            let stages = if closed { 2..=3 } else { 1..=3 };
            if closed {
                generic.push(ident("isospectral2_cayley"));
            }
            for stages in stages {
                let order = 2 * stages as u32;
                let asked = self.asked(&Choice::Isospectral(order))
                    || self.asked(&Choice::Collective(order, Lift::Representation));
                let fused = asked.then(|| self.fused_stages(stages, Lift::Representation));
                match fused.flatten() {
                    Some(equation) => tokens.extend(equation),
                    None => generic.push(format_ident!("isospectral{order}")),
                }
            }
        }
        if self.source.spins.is_some() {
            for stages in 1..=3 {
                let order = 2 * stages as u32;
                let asked = self.asked(&Choice::Collective(order, Lift::Hopf));
                let fused = asked.then(|| self.fused_stages(stages, Lift::Hopf));
                match fused.flatten() {
                    Some(equation) => tokens.extend(equation),
                    None => generic.push(format_ident!("hopf{order}")),
                }
            }
            if self.asked(&Choice::SphericalMidpoint) {
                tokens.extend(self.fused_spherical());
            } else {
                generic.push(ident("spherical"));
            }
        }
        let body = match &self.source.body {
            Some(Body::Three) => Some(("moser_veselov", "DiscreteTop")),
            Some(Body::Many { .. }) => Some(("moser_veselov_n", "DiscreteBody")),
            None => None,
        };
        if let Some((name, equation)) = body {
            if self.asked(&Choice::MoserVeselov) {
                tokens.extend(self.fused_body(equation));
            } else {
                generic.push(ident(name));
            }
        }
        tokens
    }

    fn fused_spherical(&mut self) -> Option<TokenStream> {
        let kernels = self.source.spherical_kernels()?;
        let form = Form {
            suffix: "SphericalMidpoint",
            label: "spherical-midpoint",
            docs: &[
                "The spherical midpoint method, unknown `u = mu1`: `u - mu - h f(w) = 0`,",
                "`w = |mu| s/|s|` with `s = mu + u` for each spin.",
            ],
            guess: quote! { self.h },
            generic: quote! { ::lie_runtime::generic::Spherical::new(self.system, self.h) },
            coadjoint: true,
            chart: None,
            result: None,
        };
        let equation = self.fused(&form, &kernels);
        let name = format_ident!("{}SphericalMidpoint", self.blueprint.name);
        let method = quote! { ::lie_runtime::methods::SphericalMidpoint };
        let hook = self.implicit(&method, &name, &quote! { #name::new(self, h) });
        Some(quote! { #equation #hook })
    }

    fn fused_body(&mut self, generic: &str) -> Option<TokenStream> {
        let kernels = self.source.discrete_body_kernels()?;
        let generic = ident(generic);
        let form = Form {
            suffix: "MoserVeselov",
            label: "moser-veselov",
            docs: &[
                "The discrete rigid body of Moser and Veselov; state and branch of the solution by the generic",
                "equation.",
            ],
            guess: quote! { self.h * S::ratio(1.0, 2.0) },
            generic: quote! { ::lie_runtime::generic::#generic::new(self.system, self.h) },
            coadjoint: true,
            chart: None,
            result: Some(quote! {
                let mut equation = ::lie_runtime::generic::#generic::new(self.system, self.h);
                ::lie_runtime::Equation::set_base(&mut equation, &self.base);
                ::lie_runtime::Equation::result(&mut equation, unknown, mu);
            }),
        };
        let equation = self.fused(&form, &kernels);
        let name = format_ident!("{}MoserVeselov", self.blueprint.name);
        let method = quote! { ::lie_runtime::methods::MoserVeselov };
        let hook = self.implicit(&method, &name, &quote! { #name::new(self, h) });
        Some(quote! { #equation #hook })
    }

    /// A collective method: the generic equation with elimination specialised to the pattern, where that
    /// pays: a long one of a full pattern is cheaper without index lists.
    fn fused_stages(&mut self, stages: usize, lift: Lift) -> Option<TokenStream> {
        let n = self.source.dimension;
        let (pattern, unit) = self.stage_pattern(stages, lift);
        let elimination = Elimination::new(stages * n, &pattern, &unit);
        let size = stages * n;
        let full = size * size * size / 3 + size * size;
        let multiplications = elimination.multiplications();
        if multiplications > UNROLLED && 2 * multiplications > full {
            return None;
        }
        let (system, count, order) = (self.system_name(), index(stages), 2 * stages);
        let (suffix, label, map, method) = match lift {
            Lift::Representation => (
                "Isospectral",
                "isospectral",
                quote! {
                    ::lie_runtime::generic::MatrixStages<S, <#system<S> as ::lie_runtime::MatrixPoisson<S>>::Matrix, #count>
                },
                quote! { ::lie_runtime::methods::Isospectral<#count> },
            ),
            // its equation is that of the canonical system, without a fused form
            Lift::Spec => return None,
            Lift::Hopf => (
                "Hopf",
                "collective --lift hopf",
                quote! { ::lie_runtime::generic::QuaternionStages<S, #count> },
                quote! { ::lie_runtime::methods::Collective<::lie_runtime::methods::Hopf, #count> },
            ),
        };
        let name = format_ident!("{}{suffix}{order}", self.blueprint.name);
        let inner = quote! {
            ::lie_runtime::generic::StageMomenta<'a, S, #system<S>, #map, #count>
        };
        let matrix = |name: &str, i: usize, j: usize| {
            let (name, p, q, i, j) = (
                ident(name),
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
            &format!("{label}{order} elimination"),
            &elimination,
            &matrix,
            &entry,
        );
        let table = super::fixed_order::table(&name, &elimination);
        let visibility = &self.blueprint.visibility;
        let value = quote! { #name(::lie_runtime::generic::StageMomenta::new(self, h)) };
        let hook = self.implicit(&method, &name, &value);
        let doc = format!(
            " The collective Gauss method of order {order}, elimination specialised to the pattern of the system."
        );
        let chart = (lift == Lift::Representation && self.has_poles()).then(|| {
            quote! {
                fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
                    self.0.within_chart(unknown)
                }
            }
        });
        let collective = (lift == Lift::Representation).then(|| {
            quote! {
                ::lie_runtime::generic_equations!(
                    @collective [S: ::lie_runtime::Scalar] #system<S>, S, #count
                );
            }
        });
        Some(quote! {
            #[doc = #doc]
            #[derive(Debug)]
            #[allow(clippy::type_complexity)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar>(#inner);

            #table

            impl<'a, S: ::lie_runtime::Scalar> ::lie_runtime::Equation<S> for #name<'a, S> {
                type State = <#inner as ::lie_runtime::Equation<S>>::State;
                type Unknown = <#inner as ::lie_runtime::Equation<S>>::Unknown;
                type Matrix = <#inner as ::lie_runtime::Equation<S>>::Matrix;
                #methods
                #chart
            }

            #hook
            #collective
        })
    }

    /// Where `delta_ij - (dM_i/dx_j) h H''(m_j)` can differ from the identity: the columns on which a
    /// derivative of H depends; over the Hopf map a spin moves with its own derivatives alone.
    fn stage_pattern(
        &mut self,
        stages: usize,
        lift: Lift,
    ) -> (Vec<(usize, usize)>, BTreeSet<usize>) {
        let n = self.source.dimension;
        let hessian = self.source.hessian_of_h();
        let spins = self.source.spins.clone().unwrap_or_default();
        let moves = |row: usize, through: usize| {
            lift == Lift::Representation
                || spins
                    .iter()
                    .any(|s| s.coordinates.contains(&row) && s.coordinates.contains(&through))
        };
        let mut places = BTreeSet::new();
        for row in 0..n {
            for column in 0..n {
                let graph = &self.source.graph;
                let mut slopes = hessian.iter().map(|slopes| slopes[column]).enumerate();
                let depends =
                    slopes.any(|(through, slope)| moves(row, through) && !graph.is_zero(slope));
                if depends {
                    places.insert((row, column));
                }
            }
        }
        let mut pattern = Vec::new();
        let mut unit = BTreeSet::new();
        for row in 0..stages * n {
            let columns: Vec<usize> = places
                .iter()
                .filter(|(i, _)| *i == row % n)
                .map(|(_, j)| *j)
                .collect();
            if columns.is_empty() {
                unit.insert(row);
            }
            pattern.extend(
                (0..stages).flat_map(|block| columns.iter().map(move |j| (row, block * n + j))),
            );
        }
        (pattern, unit)
    }
}
