//! The Legendre transform of a reduced Lagrangian: `mu = dl/dxi`, `H(mu) = <mu, xi> - l(xi)`.
//!
//! For `l = <A xi, xi>/2 + <b, xi> + c` with a symmetric matrix A it is
//! `H = <A^-1 (mu - b), mu - b>/2 - c`, by elimination in the order `A = L D L^T`: a sum of squares over
//! pivots. Where the diagonal is zero, as in `l = xi1 xi2`, a pivot is a block of two rows.
//!
//! A Lagrangian that is not quadratic, or not shown to be, has no such expression: the velocity of a momentum is
//! found by Newton's iteration, here ([`super::velocity`]) and in generated code. The iteration begins at rest,
//! where l must be finite and regular.

mod quadratic;

use crate::model::Parameter;
use crate::model::configuration::Configuration;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Name;
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use quadratic::Quadratic;

/// A lowered Lagrangian; the components of the velocity are [`Symbol::Input`].
pub struct Lagrangian<'a> {
    /// The function.
    pub value: ExprId,
    /// Names of the components of the velocity.
    pub velocity: &'a [Name],
    /// Where the function stands.
    pub origin: Origin,
    /// The parameters with their defaults.
    pub parameters: &'a [Parameter],
    /// The group element and the time, where the Lagrangian depends on them.
    pub configuration: Option<&'a Configuration>,
    /// Whether the bracket is the Lie–Poisson one and nothing acts beside it, so that a Newton iteration for the velocity can be
    /// generated.
    pub iterates: bool,
}

impl Lagrangian<'_> {
    /// A coordinate at rest, where the coefficients are looked at: mu is 0, the group element 1.
    fn at_rest(&self, coordinate: usize) -> f64 {
        self.configuration
            .map_or(0.0, |configuration| configuration.at_rest(coordinate))
    }
}

/// The Hamiltonian of a Lagrangian.
pub enum Transform {
    /// In the coordinates of mu.
    Exact(ExprId),
    /// Of a Lagrangian that is not quadratic, in mu and its velocity: `<mu, xi> - l(xi)`.
    InVelocity(ExprId),
}

/// The Legendre transform.
///
/// # Errors
/// `legendre` for a Lagrangian that is singular or has no value at rest.
pub fn hamiltonian(
    graph: &mut Graph,
    lagrangian: &Lagrangian<'_>,
) -> Result<Transform, Diagnostic> {
    let (mut form, quadratic) = Quadratic::new(graph, lagrangian)?;
    if quadratic {
        let mut terms = Vec::new();
        while !form.rest.is_empty() {
            let pivot = form.pivot(graph);
            let pivot = pivot.ok_or_else(|| form.singular(lagrangian))?;
            terms.push(form.eliminate(graph, &pivot));
        }
        terms.push(graph.neg(form.constant));
        return Ok(Transform::Exact(graph.sum(&terms)));
    }
    if !lagrangian.iterates {
        return Err(not_quadratic(lagrangian));
    }
    if let Some(rank) = form.rank_at_rest(graph) {
        return Err(singular_at_rest(lagrangian, rank));
    }
    let mut terms = vec![graph.neg(lagrangian.value)];
    for i in 0..lagrangian.velocity.len() {
        let mu = graph.symbol(Symbol::Coordinate(i));
        let xi = graph.symbol(Symbol::Input(i));
        terms.push(graph.mul(mu, xi));
    }
    Ok(Transform::InVelocity(graph.sum(&terms)))
}

fn not_at_rest(lagrangian: &Lagrangian<'_>) -> Diagnostic {
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        "the Lagrangian or one of its first two derivatives is not finite at rest with the default parameters, \
         where its Legendre transform begins",
    )
    .help("write it so that it is smooth at rest, or give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}

fn singular_at_rest(lagrangian: &Lagrangian<'_>, rank: usize) -> Diagnostic {
    let all = lagrangian.velocity.len();
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        format!(
            "the Lagrangian is singular at rest with the default parameters: its Hessian has rank {rank} of {all} \
             there, where the iteration for the velocity of a momentum begins"
        ),
    )
    .help("every component of the velocity needs a quadratic kinetic term; else give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}

fn not_quadratic(lagrangian: &Lagrangian<'_>) -> Diagnostic {
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        "the Lagrangian is not quadratic in the velocity, or could not be shown to be: then nothing may act beside it, and the \
         bracket must be the bracket of an algebra",
    )
    .help("give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}
