//! Poisson systems, Lie–Poisson systems, and those with a Cayley map.
//!
//! Left-invariant convention throughout:
//!
//! ```math
//! [e_i, e_j] = \sum_k C_{ij}^k\, e_k, \qquad
//! \langle \mathrm{ad}^*_\xi \mu, \eta \rangle = \langle \mu, [\xi, \eta] \rangle, \qquad
//! \Pi(\mu)\, \xi = \mathrm{ad}^*_\xi \mu, \qquad \dot\mu = \Pi(\mu)\, \nabla H(\mu)
//! ```
//!
//! For so(3), `$\dot\mu = \mu \times \nabla H(\mu)$`.
#![cfg_attr(doc, doc = include_str!("../docs/katex.html"))]

mod lie;
mod scalars;

pub use lie::{CayleyPoisson, LiePoisson};
pub use scalars::{Lift, Widen};

use crate::clock::{self, Clock};
use crate::event::EventRule;
use crate::generic;
use crate::lattice::AXES;
use crate::matrix::SquareMatrix;
use crate::scalar::Scalar;
use crate::state::State;
use core::ops::Range;

/// A system `mu' = f(mu) = Pi(mu) grad H(mu)` on a Poisson manifold with n coordinates; where forces F or damping act beside the
/// Hamiltonian ([`Poisson::is_forced`], [`Poisson::is_damped`]), `mu' = f(mu) = Pi(mu) xi(mu) + F(mu)` with the generator
/// `xi = grad H + c G ad*_{grad H} mu`.
///
/// All functions write their result into `out` (every entry) and allocate nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a Poisson system over the scalar `{S}`",
    note = "declare it with `lie_poisson!` and pass the result of `.system()?`, or implement `Poisson<{S}>`"
)]
pub trait Poisson<S: Scalar>: Sized {
    /// The state mu: n coordinates.
    type State: State<S>;
    /// An n x n matrix.
    type Jacobian: SquareMatrix<S>;

    /// The number of coordinates n.
    fn dimension(&self) -> usize;
    /// The name of the system.
    fn name(&self) -> &str;
    /// The name of a coordinate.
    fn coordinate(&self, index: usize) -> &str;
    /// How many layers, rows and columns of sites there are, of a family: its coordinates are those of its sites, and their names are too
    /// many to be told unless somebody asks.
    fn sites(&self) -> Option<[usize; AXES]> {
        None
    }
    /// The number of Casimirs that [`Poisson::casimirs`] writes.
    fn casimir_count(&self) -> usize {
        0
    }
    /// The name of a Casimir.
    fn casimir_name(&self, _index: usize) -> &str {
        ""
    }
    /// The total degree of H in the coordinates where H is a polynomial in them. Quadrature along
    /// segments then has the nodes that make it exact.
    fn hamiltonian_degree(&self) -> Option<u32> {
        None
    }
    /// The total degree of a Casimir in the coordinates where it is a polynomial and that is known.
    fn casimir_degree(&self, _index: usize) -> Option<u32> {
        None
    }
    /// Whether a Casimir has several branches: its value jumps where an angle in it passes from pi to -pi, so
    /// that its drift says nothing. Its gradient does not jump.
    fn casimir_is_multivalued(&self, _index: usize) -> bool {
        false
    }
    /// Whether the motion keeps a Casimir: forces change those C with `<F, grad C>` not zero.
    fn casimir_is_kept(&self, _index: usize) -> bool {
        true
    }
    /// The largest total degree of an entry of the Poisson matrix in the coordinates, where all are
    /// polynomials in them and that is known: 0 for a constant matrix, for which symplectic methods are
    /// Poisson maps.
    fn poisson_degree(&self) -> Option<u32> {
        None
    }

    /// Whether the Poisson matrix is one of an almost-Poisson bracket, of which the Jacobi identity is not asked: that of a system
    /// with a constraint. H is kept and so are kernel functions of the matrix, but there are no symplectic leaves, and the flow is no
    /// Poisson map.
    fn is_almost_poisson(&self) -> bool {
        false
    }

    /// Whether Hessian, Poisson matrix and Jacobian can be had. A large system keeps no matrix: methods that need one do not
    /// apply to it, and those that iterate have no other way.
    fn has_jacobian(&self) -> bool {
        true
    }

    /// A state of the right size, all coordinates 0.
    fn zero_state(&self) -> Self::State;
    /// A matrix of the right size, all entries 0.
    fn zero_jacobian(&self) -> Self::Jacobian;

    /// Where H has several branches: the same system on the branch that continues its own to the state mu. A run
    /// carries it along. `None` if there is only one branch, or if the system's own branch still serves.
    fn following(&self, _mu: &Self::State) -> Option<Self> {
        None
    }
    /// Where H has several branches: the same system on the branch with a gradient of H. A run that is taken up again begins
    /// with the one that it had. `None` if there is only one branch.
    fn on_branch(&self, _gradient: &Self::State) -> Option<Self> {
        None
    }

    /// The coordinates that carry the time, where H depends on it.
    fn clock(&self) -> Option<Clock> {
        None
    }
    /// Whether H does not depend on the time, which a state may carry for what acts beside H.
    fn is_autonomous(&self) -> bool {
        self.clock().is_none()
    }
    /// How many functions of the time [`Poisson::joints`] writes.
    fn joint_count(&self) -> usize {
        0
    }
    /// Functions of the time that are 0 where branches of H meet at times that are known beforehand; `out` has
    /// [`Poisson::joint_count`] entries. A driver ends a step there and begins another one.
    fn joints(&self, _mu: &Self::State, _out: &mut [S]) {}
    /// The size of a state: the largest magnitude of its coordinates but for those that carry the time.
    fn norm(&self, mu: &Self::State) -> S {
        clock::norm(self.clock(), mu)
    }

    /// The energy H(mu).
    fn hamiltonian(&self, mu: &Self::State) -> S;
    /// The energy as it is shown and followed: H, except where H depends on the time. There
    /// [`Poisson::hamiltonian`] is that of the extended phase space, with the momentum of the time added, and
    /// the energy varies.
    fn energy(&self, mu: &Self::State) -> S {
        self.hamiltonian(mu)
    }
    /// The gradient of H: `out_i = dH/dmu_i`.
    fn gradient(&self, mu: &Self::State, out: &mut Self::State);
    /// The Hessian of H: `out_ij = d^2H/dmu_i dmu_j`.
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian);
    /// The Poisson matrix: `out_ij = {mu_i, mu_j}`, of a Lie algebra `-C_ij^k mu_k`.
    fn poisson_matrix(&self, mu: &Self::State, out: &mut Self::Jacobian);

    /// The derivative of the Poisson matrix against a fixed vector: `out_ij = d(Pi(mu) xi)_i/dmu_j`.
    ///
    /// The provided body is for a Poisson matrix that is affine in mu, as that of a Lie algebra is, where
    /// it is `ad*_xi`; any other one must have its own.
    fn poisson_slope(&self, _mu: &Self::State, xi: &Self::State, out: &mut Self::Jacobian) {
        generic::poisson_slope(self, xi, out);
    }

    /// Whether forces act: the field is not `Pi(mu) xi` alone, and no orbit is kept.
    fn is_forced(&self) -> bool {
        false
    }
    /// The force F(mu), a covector as mu is: `out_i = F_i`. Of a system with a [`Poisson::clock`] the component along the momentum of the
    /// time is `-<F, grad H>`, so that H with that momentum stays constant: what the forces do is taken from there.
    fn force(&self, _mu: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
    }
    /// Whether the force is linear in the coordinates and that on one of them depends on others: `F = a - K mu` with a matrix K that is not
    /// diagonal. The flow of such a force takes longer than that of one that acts on each coordinate by itself.
    fn force_mixes(&self) -> bool {
        false
    }
    /// The derivative of the force: `out_ij = dF_i/dmu_j`.
    fn force_slope(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
    }
    /// Whether damping along coadjoint orbits acts: the generator is not the gradient of H.
    fn is_damped(&self) -> bool {
        false
    }
    /// What a double bracket of strength c and metric G makes of a covector: `out = c G v`, in the algebra. It has no component along the
    /// momentum of the time. Methods along discrete gradients damp by it, so that H falls by `c <v, G v>` to round-off.
    fn damping(&self, _mu: &Self::State, _v: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
    }
    /// The generator of the motion along the coadjoint orbit: `xi = grad H`, and `xi = grad H + c G ad*_{grad H} mu` where a double bracket of
    /// strength c and metric G damps.
    fn generator(&self, mu: &Self::State, out: &mut Self::State) {
        self.gradient(mu, out);
        if self.is_damped() {
            generic::add_damping(self, mu, out);
        }
    }
    /// The derivative of the generator: `out_ij = dxi_i/dmu_j`, the Hessian of H where nothing damps.
    ///
    /// The provided body is for a [`Poisson::damping`] that does not depend on mu.
    fn generator_slope(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        self.hessian(mu, out);
        if self.is_damped() {
            generic::add_damping_slope(self, mu, out);
        }
    }

    /// Whether a part of the force is metriplectic: `K grad S` with an entropy S and a metric K >= 0 such that `K grad H = 0` and
    /// `{S, H} = 0`. Methods along discrete gradients of the field then keep H and have S grow, both to round-off.
    fn is_metriplectic(&self) -> bool {
        false
    }
    /// The entropy S(mu), a function of the declared coordinates, which come before the momentum of the time.
    fn entropy(&self, _mu: &Self::State) -> S {
        S::zero()
    }
    /// The total degree of the entropy, where it is a polynomial and that is known.
    fn entropy_degree(&self) -> Option<u32> {
        None
    }
    /// Its gradient: `out_i = dS/dmu_i`.
    fn entropy_gradient(&self, _mu: &Self::State, out: &mut Self::State) {
        out.fill(S::zero());
    }
    /// Its Hessian: `out_ij = d^2S/dmu_i dmu_j`.
    fn entropy_hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
    }
    /// The metric K(mu), with no entries beside those of the declared coordinates.
    fn metric(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
    }
    /// The derivative of the metric against a fixed vector: `out_ij = d(K(mu) v)_i/dmu_j`.
    fn metric_slope(&self, _mu: &Self::State, _v: &Self::State, out: &mut Self::Jacobian) {
        *out = self.zero_jacobian();
    }

    /// How many inputs are among the coordinates: they are set from outside, constant along the motion, and follow the unit beside the time
    /// ([`Poisson::clock`]).
    fn input_count(&self) -> usize {
        0
    }
    /// The time from one sampling of an input to the next; every step where it is `None`.
    fn input_sampling(&self, _index: usize) -> Option<f64> {
        None
    }
    /// How many rates of Wiener processes follow the inputs: `dW/dt`, constant along a step.
    fn noise_count(&self) -> usize {
        0
    }
    /// Whether the last of them belongs to no noise, and its sign is a coin: steps that take several processes one after the other
    /// take them in their order or against it, as it says.
    fn tosses_coin(&self) -> bool {
        false
    }

    /// The number of declared functions of the state that [`Poisson::quantities`] writes: the work of the forces, first integrals,
    /// observables, inputs.
    fn quantity_count(&self) -> usize {
        0
    }
    /// The name of such a function.
    fn quantity_name(&self, _index: usize) -> &str {
        ""
    }
    /// Whether it is an angle, whose jumps by 2 pi a driver takes out along a run.
    fn quantity_unwraps(&self, _index: usize) -> bool {
        false
    }
    /// Whether it is a first integral, whose drift is an error of the method.
    fn quantity_is_conserved(&self, _index: usize) -> bool {
        false
    }
    /// Their values at mu; `out` has [`Poisson::quantity_count`] entries.
    fn quantities(&self, _mu: &Self::State, _out: &mut [S]) {}

    /// The number of events: functions of the state whose zeros along a run are found.
    fn event_count(&self) -> usize {
        0
    }
    /// The name of an event.
    fn event_name(&self, _index: usize) -> &str {
        ""
    }
    /// Which zeros of an event count, and what they do.
    fn event_rule(&self, _index: usize) -> EventRule {
        EventRule::default()
    }
    /// The functions of the events at mu; `out` has [`Poisson::event_count`] entries.
    fn events(&self, _mu: &Self::State, _out: &mut [S]) {}

    /// The vector field `f(mu) = Pi(mu) xi(mu) + F(mu)`, without forces and damping `Pi(mu) grad H(mu)`.
    fn vector_field(&self, mu: &Self::State, out: &mut Self::State) {
        generic::vector_field(self, mu, out);
    }
    /// The vector field at a state whose entries `before` sets, and of whose slopes `after` makes something: of all at once, or of a
    /// system whose parts depend on a few others part by part, while these are in the cache.
    #[inline(always)]
    fn vector_field_by_parts(
        &self,
        mu: &mut Self::State,
        out: &mut Self::State,
        mut before: impl FnMut(&mut [S], Range<usize>),
        mut after: impl FnMut(&mut [S], Range<usize>),
    ) {
        let all = 0..mu.as_slice().len();
        before(mu.as_mut_slice(), all.clone());
        self.vector_field(mu, out);
        after(out.as_mut_slice(), all);
    }
    /// The Jacobian of the vector field: `out_ij = df_i/dmu_j`.
    fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian);
    /// The vector field and its Jacobian together.
    fn linearize(&self, mu: &Self::State, field: &mut Self::State, jacobian: &mut Self::Jacobian) {
        self.vector_field(mu, field);
        self.jacobian(mu, jacobian);
    }

    /// The Casimirs at mu; `out` has [`Poisson::casimir_count`] entries.
    fn casimirs(&self, mu: &Self::State, out: &mut [S]);
    /// The gradient of one Casimir; `index` must be below [`Poisson::casimir_count`].
    fn casimir_gradient(&self, index: usize, mu: &Self::State, out: &mut Self::State);
}
