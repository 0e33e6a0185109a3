//! Constraints on the velocity: the Euler–Poincaré–Suslov equations in the coordinates that are left.
//!
//! Of `<a_j, xi> = 0` with `xi = grad H(mu)` and the reaction `mu' = ad*_xi mu + sum_j lambda_j a_j`, the coordinates
//! `m_alpha = <mu, e_alpha>` along a basis e_alpha of the subspace `D = {xi: <a_j, xi> = 0}` see no reaction. A momentum is
//! `mu = mu_0(m) + sum_j nu_j a_j`, and the multipliers nu follow from the constraints, linearly where H is quadratic along the
//! a_j: `mu = I E (E^T I E)^-1 m` for `H = <mu, I^-1 mu>/2`, with the e_alpha as columns of E. Then
//!
//! ```text
//! m' = Pi_D grad H_D,    Pi_D,ab = -<mu(m), [e_a, e_b]>,    H_D(m) = H(mu(m))
//! ```
//!
//! since `dH_D/dm_a` is the component of xi along e_a: H is stationary along the a_j. Other coordinates of a semidirect product,
//! which no constraint names, are of the same kind: `Pi_D = E^T Pi E` with a unit vector for each of them. Pi_D is antisymmetric and
//! satisfies no Jacobi identity in general. H_D, the constraints and kernel functions of Pi_D are kept.
//!
//! A. J. van der Schaft, B. M. Maschke, On the Hamiltonian formulation of nonholonomic mechanical systems, Rep. Math. Phys. 34
//! (1994) 225, doi:10.1016/0034-4877(94)90038-8; Yu. N. Fedorov, D. V. Zenkov, Discrete nonholonomic LL systems on Lie groups,
//! Nonlinearity 18 (2005) 2211, doi:10.1088/0951-7715/18/5/017.

pub mod forms;
mod initial;
mod multipliers;
mod names;
mod reduction;
mod tidy;

use lie_syntax::ast::{Declaration, Energy};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};

pub use initial::violation as initial_violation;
pub use reduction::reduced;

/// What a constraint cannot stand beside.
pub fn refused(declaration: &Declaration) -> Vec<Diagnostic> {
    let Some(first) = declaration.constraint.first() else {
        return Vec::new();
    };
    let beside = |origin: Origin, what: &str, help: &str| {
        let message = format!("a constraint cannot stand beside {what}");
        Diagnostic::new(Kind::Constraint, origin, message).help(help)
    };
    let mut found = Vec::new();
    if declaration.family.is_some() {
        let help = "constrain a single system; sums over sites have no reduced form";
        found.push(beside(first.origin, "a family", help));
    }
    if let Some(part) = declaration.driving().next() {
        let help = "remove one of the two: forces on the subspace of a constraint are not built";
        let what = "forces, dissipation and noise";
        found.push(beside(part.origin, what, help));
    }
    if let Some(input) = declaration.inputs.first() {
        let help = "declare a parameter for what is set from outside";
        found.push(beside(input.name.origin, "inputs", help));
    }
    if let Some(realization) = &declaration.realization {
        let help =
            "remove the realization: collective methods need a Poisson bracket, and none is left";
        found.push(beside(realization.origin, "a realization", help));
    }
    if let Energy::DiscreteLagrangian { value, .. } = &declaration.energy {
        let help = "declare a `lagrangian` or a `hamiltonian`: the discrete principle with a constraint does not keep the energy";
        found.push(beside(value.origin, "a discrete Lagrangian", help));
    }
    if let Some(attitude) = &declaration.attitude {
        let help = "declare `group`, and give the entries of the group element behind the momenta in `initial`";
        found.push(beside(attitude.origin, "`attitude`", help));
    }
    found
}
