//! Systems on the dual of a Lie algebra, and those among them with a Cayley map.

use super::Poisson;
use crate::generic;
use crate::scalar::Scalar;
use crate::structure::Spectrum;

/// A Lie–Poisson system: the state lives in the dual g* of a Lie algebra g.
///
/// Elements of g are passed as states too: their coordinates in the basis `e_i`. The provided bodies of bracket and coadjoint
/// action rest on [`Poisson::poisson_matrix`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a Lie–Poisson system over the scalar `{S}`",
    note = "methods of coadjoint form need the bracket of a Lie algebra: implement `LiePoisson<{S}>`, or choose `ImplicitMidpoint` or a Gauss method, which ask only for `Poisson`"
)]
pub trait LiePoisson<S: Scalar>: Poisson<S> {
    /// The bracket `out = [xi, eta]`: `out^k = C_ij^k xi^i eta^j`.
    fn ad(&self, xi: &Self::State, eta: &Self::State, out: &mut Self::State) {
        generic::ad(self, xi, eta, out);
    }
    /// The coadjoint action `out = ad*_xi mu = Pi(mu) xi`: `out_j = C_ij^k xi^i mu_k`.
    fn ad_star(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
        generic::ad_star(self, xi, mu, out);
    }
    /// The matrix of `mu -> ad*_xi mu`: `out_jk = C_ij^k xi^i`.
    fn ad_star_matrix(&self, xi: &Self::State, out: &mut Self::Jacobian) {
        generic::ad_star_matrix(self, xi, out);
    }

    /// Whether [`LiePoisson::coadjoint_action`] and [`LiePoisson::dexp_dual`] are closed forms; else they are series.
    fn has_closed_exponential(&self) -> bool {
        false
    }
    /// Whether [`LiePoisson::dexp_dual_slope`] is a closed form.
    fn has_closed_slope(&self) -> bool {
        false
    }
    /// The coadjoint action of an exponential: `out = Ad*_(exp xi) mu = exp(ad*_xi) mu`.
    fn coadjoint_action(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
        generic::coadjoint_action(self, xi, mu, out);
    }
    /// The dual of the right-trivialised tangent of exp: `out = phi1(ad*_xi) mu`, `phi1(z) = (e^z - 1)/z`.
    fn dexp_dual(&self, xi: &Self::State, mu: &Self::State, out: &mut Self::State) {
        generic::dexp_dual(self, xi, mu, out);
    }
    /// The same with its derivative in xi: `slope_ij = d(phi1(ad*_xi) mu)_i/dxi^j`.
    fn dexp_dual_slope(
        &self,
        xi: &Self::State,
        mu: &Self::State,
        out: &mut Self::State,
        slope: &mut Self::Jacobian,
    ) {
        generic::dexp_dual_slope(self, xi, mu, out, slope);
    }
}

/// A Lie–Poisson system whose algebra has a representation closed under the Jordan triple product
/// `(abc + cba)/2 = T_abc^d`, and with it a Cayley map in coordinates.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Cayley map over the scalar `{S}`",
    note = "the Cayley map needs a matrix representation that is closed under (abc + cba)/2: declare `matrices`, or use `LieMidpoint::exp()`"
)]
pub trait CayleyPoisson<S: Scalar>: LiePoisson<S> {
    /// What is known of the eigenvalues of the representation, at which the Cayley map has poles.
    fn spectrum(&self) -> Spectrum<'_> {
        Spectrum::Unknown
    }
    /// The triple product paired with mu: `out_b = T_abc^d x^a z^c mu_d`, symmetric in x and z.
    fn triple(&self, x: &Self::State, z: &Self::State, mu: &Self::State, out: &mut Self::State);
}
