//! Families `A^N`: many copies of one Lie algebra on a chain or a lattice, coupled by sums over their sites.
//!
//! ```math
//! H = F(T_1, \ldots, T_m), \qquad T_k = \sum_i s_k(\mu_{i + o_1}, \mu_{i + o_2}, \ldots), \qquad
//! \dot\mu_i = \mathrm{ad}^*_{\partial H/\partial\mu_i}\, \mu_i
//! ```
//!
//! Generated code knows one site and its neighbours ([`Sites`]): straight-line kernels, whatever N is. [`Family`] is the
//! system, with the loops over its sites. A sum over all sites is periodic: indices count modulo the size. A sum over some
//! of them has no neighbours beyond the ends.
//!
//! A state holds the first coordinates of all sites, then the second ones, and so on; the sites of a lattice row after row, layer after layer.
//! Memory is a few states: no method keeps a Jacobian, so that they are those that need none. Matrices of all coordinates are
//! there for measurements on small families.
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

mod beside;
mod bonds;
mod carried;
mod columns;
mod energy;
mod exchange;
mod given;
mod initial;
mod links;
mod matrix;
mod parts;
mod pieces;
mod rates;
mod shape;
mod sites;
mod splitting;
mod stencil;
mod system;

pub use given::{size, values};
pub use initial::{SplitMix, unit_spheres};
pub use links::bonds;
pub use matrix::LateMatrix;
pub use pieces::{Effects, Kind, Pieces, Strip, site_by_site};
pub use shape::{Fixed, Of, Shape};
pub use sites::{Around, Site, Sites, Span, Sums, Term};
pub use splitting::FamilyFlows;
pub use stencil::Stretch;
pub use system::{Family, STATISTICS};
