//! Structure that some algebras and Hamiltonians have and some methods need: a matrix representation,
//! factors so(3), the inertia of a rigid body in n dimensions.

pub mod euler;
mod lifts;
pub mod rotation;

use crate::matrix::SquareMatrix;
use crate::poisson::{LiePoisson, Poisson};
use crate::scalar::Scalar;
use crate::state::State;
pub use euler::EulerSequence;
pub use lifts::{
    CollectivePoisson, ColumnPoisson, Columns, SpinPoisson, UnitaryPoisson, VectorPoisson,
};

/// A nonzero entry of a constant matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The row.
    pub row: u16,
    /// The column.
    pub column: u16,
    /// The f64 nearest to the value.
    pub high: f64,
    /// The rest of the value, rounded.
    pub low: f64,
}

impl Entry {
    /// An entry that f64 holds exactly.
    pub const fn new(row: u16, column: u16, value: f64) -> Self {
        Self {
            row,
            column,
            high: value,
            low: 0.0,
        }
    }

    /// An entry of two parts: the f64 nearest to the value, and the rest.
    pub const fn parts(row: u16, column: u16, high: f64, low: f64) -> Self {
        Self {
            row,
            column,
            high,
            low,
        }
    }

    /// Row and column.
    #[inline(always)]
    pub fn place(&self) -> (usize, usize) {
        (usize::from(self.row), usize::from(self.column))
    }

    /// The value.
    #[inline(always)]
    pub fn value<S: Scalar>(&self) -> S {
        S::constant(self.high, self.low)
    }
}

/// The nonzero entries of a matrix: row, column, value, and the rest of a value that f64 does not hold.
#[doc(hidden)]
#[macro_export]
macro_rules! __entries {
    (@low) => {
        0.0
    };
    (@low $low:literal) => {
        $low
    };
    ($(($row:literal, $column:literal, $high:literal $(, $low:literal)?)),*) => {
        // values of fields, which live as long as the program
        &[$($crate::structure::Entry {
            row: $row,
            column: $column,
            high: $high,
            low: $crate::__entries!(@low $($low)?),
        }),*]
    };
}

/// How the group element is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Chart {
    /// As a matrix of the declared representation, by rows.
    #[default]
    Matrix,
    /// As a unit quaternion `(q0, q1, q2, q3)`, the real part first, where the matrices are rotations in three
    /// dimensions. It is normalised after every step; its sign changes continuously.
    Quaternion,
    /// As Euler angles `(phi, theta, psi)` in radians, where the matrices are rotations in three dimensions. They are followed
    /// from step to step, so that they are continuous; see [`euler`].
    Euler(EulerSequence),
}

/// A Hamiltonian system on `T*G`: the Hamiltonian `H(g, mu)` is not invariant under the group, and the state
/// is mu with the coordinates of the configuration, the entries of g.
///
/// It is the Lie–Poisson system of a semidirect product: the first [`CotangentPoisson::momenta`] basis
/// elements span the algebra of the group, which acts on the span of the others; these commute. The time and
/// its momentum take part where H depends on it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a system on T*G over the scalar `{S}`",
    note = "declare the group element (`group R;`), whose entries may stand in the Hamiltonian"
)]
pub trait CotangentPoisson<S: Scalar>: LiePoisson<S> {
    /// The momenta alone.
    type Momentum: State<S>;
    /// A square matrix of their number.
    type MomentumMatrix: SquareMatrix<S>;
    /// How many coordinates, the first ones, are momenta.
    fn momenta(&self) -> usize;
    /// Momenta, all 0.
    fn zero_momentum(&self) -> Self::Momentum;
    /// A matrix, all entries 0.
    fn zero_momentum_matrix(&self) -> Self::MomentumMatrix;
}

/// What is known of the eigenvalues of `rho(xi)`, for a representation `rho`: where one is real and above 2 in
/// absolute value, the Cayley map is not joined to the identity along xi.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spectrum<'a> {
    /// None is real but 0, for any xi: no Cayley map of an element has a pole on its way.
    Imaginary,
    /// `|lambda| <= sum_k w_k |xi^k|` with these weights.
    Bounded(&'a [f64]),
    /// Nothing.
    Unknown,
}

/// The matrices of a representation `rho` and of its dual, by their nonzero entries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Representation<'a> {
    /// `rho(e_k)`, one list per basis element.
    pub matrices: &'a [&'a [Entry]],
    /// Matrices `D^k` with `tr(D^k rho(e_l)) = delta_kl`: `W = sum_k mu_k D^k` has the momentum mu.
    pub dual: &'a [&'a [Entry]],
    /// Whether all these matrices are antisymmetric.
    pub skew: bool,
}

/// A group of matrices, by those of its algebra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Group<'a> {
    /// The size of the matrices.
    pub size: usize,
    /// `rho(e_k)`, one list of nonzero entries per basis element.
    pub matrices: &'a [&'a [Entry]],
    /// Whether Gauss methods applied to `g' = g rho(xi)` stay in the group, up to matrices that commute with it: the
    /// span is closed under `(abc + cba)/2`.
    pub closed: bool,
    /// Whether all matrices are antisymmetric: the group element is orthogonal.
    pub orthogonal: bool,
    /// Whether the system is right-invariant, `g' = xi g`: its structure constants and matrices then are those
    /// of the opposite algebra, the negative ones.
    pub right: bool,
}

/// A Lie–Poisson system whose algebra has declared matrices, and with them a group of matrices.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no matrices over the scalar `{S}`, and so no group element",
    note = "declare `matrices` in addition to the brackets"
)]
pub trait MatrixGroup<S: Scalar>: LiePoisson<S> {
    /// The group, by the matrices of its algebra.
    fn group(&self) -> Group<'_>;
    /// The entries of `$\tau(x)$` by rows, of a system that is a [`RetractedPoisson`].
    ///
    /// # Panics
    /// The system has no such.
    fn retract(&self, _x: &Self::State, _out: &mut [S]) {
        panic!("`MatrixGroup::retract` belongs to a system with a retraction of its own")
    }
}

/// A Poisson system with coordinates w in which its Poisson matrix is constant.
///
/// The matrix `dw/dmu` is triangular in some order of the coordinates. For [`Canonical4`](crate::methods::Canonical4) and its kin.
#[diagnostic::on_unimplemented(
    message = "no coordinates are known in which the bracket of `{Self}` is constant over the scalar `{S}`",
    note = "`lie check` says which methods apply; `HamiltonJacobi4` is a Poisson map for every bracket"
)]
pub trait CanonicalPoisson<S: Scalar>: Poisson<S> {
    /// The coordinates: `out = w(mu)`.
    fn canonical(&self, mu: &Self::State, out: &mut Self::State);
    /// The side of mu: `out_i > 0` where, as far as is known, no zero or pole of what w depends on lies between mu and xi, a second state. It is
    /// exact where each coordinate of w is a function of one of mu.
    fn canonical_sides(&self, mu: &Self::State, xi: &Self::State, out: &mut Self::State);
    /// What moves w by xi: `out = (dw/dmu)^-1 xi`.
    fn canonical_pull(&self, mu: &Self::State, xi: &Self::State, out: &mut Self::State);
    /// The field in them: `out = (dw/dmu) f(mu)`.
    fn canonical_field(&self, mu: &Self::State, out: &mut Self::State);
    /// Its derivative: `out_ij = d((dw/dmu) f)_i/dmu_j`.
    fn canonical_jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian);
}

/// A Lie–Poisson system with a retraction of its own: a map `tau` from the algebra to the group with `tau(0) = e`, the identity as its
/// derivative there, and `tau(x) tau(-x) = e`. For [`LieMidpoint::declared`](crate::methods::LieMidpoint::declared).
///
/// `$\mathrm{d}\tau_x$` is the right-trivialised tangent, `$\frac{\mathrm{d}}{\mathrm{d}s} \tau(x + s y) = (\mathrm{d}\tau_x y)\, \tau(x)$`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no retraction of its own over the scalar `{S}`",
    note = "declare `retraction`, and have `lie-midpoint` among `methods` where these are listed; or use `LieMidpoint::exp()`"
)]
pub trait RetractedPoisson<S: Scalar>: LiePoisson<S> {
    /// `$(\mathrm{d}\tau_x)^* \mu$`
    fn retraction_pullback(&self, x: &Self::State, mu: &Self::State, out: &mut Self::State);
    /// Its derivative in x.
    fn retraction_slope(&self, x: &Self::State, mu: &Self::State, out: &mut Self::Jacobian);
    /// `$\mathrm{Ad}^*_{\tau(x)} \mu$`
    fn retraction_action(&self, x: &Self::State, mu: &Self::State, out: &mut Self::State);
}

/// A Lie–Poisson system with a matrix representation that carries a reduction of `T*V` to g*.
///
/// The words `T rho(e_k) Q` that the method of the module [`crate::methods::isospectral`] forms must lie in
/// the span of `rho` and of matrices that commute with all of `rho(g)`, and the dual matrices pair to
/// zero with the latter. It holds where the closure of the span under `(abc + cba)/2` has this form.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no matrix representation over the scalar `{S}` that carries this method",
    note = "declare `matrices` whose closure under (abc + cba)/2 adds only matrices that commute with them, or use `LieMidpoint::exp()`"
)]
pub trait MatrixPoisson<S: Scalar>: LiePoisson<S> {
    /// A matrix of the size of the representation.
    type Matrix: SquareMatrix<S>;
    /// The matrices.
    fn representation(&self) -> Representation<'_>;
    /// The eigenvalues of the matrices.
    fn spectrum(&self) -> Spectrum<'_> {
        Spectrum::Unknown
    }
    /// A matrix of the size of the representation, all entries 0.
    fn zero_matrix(&self) -> Self::Matrix;
}

/// How the flow of a system is known in closed form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Free rigid bodies: a direct sum of algebras so(3), and H a quadratic form that does not couple them.
    Bodies,
    /// The gradient of H is constant along each solution.
    Uniform,
}

/// A Lie–Poisson system whose flow is known in closed form. The compiler decides it.
#[diagnostic::on_unimplemented(
    message = "no closed form of the flow of `{Self}` is known",
    note = "`lie check` says for which systems there is one; `Gauss16` with `Options::tolerance` applies to every system"
)]
pub trait IntegrablePoisson<S: Scalar>: LiePoisson<S> {
    /// The form.
    fn motion(&self) -> Motion;
    /// The coordinates (i, j, k) of each body, with `[e_i, e_j] = c e_k` and its cyclic permutations.
    fn bodies(&self) -> &[[usize; 3]] {
        &[]
    }
    /// The constant c of one body.
    fn body_scale(&self, _body: usize) -> S {
        S::one()
    }
}

/// A system with a realization of its bracket: a map `mu = J(z)` from points z = (q, p) with canonical brackets and
/// `{J_a, J_b} = Pi_ab(J)`. Flows of functions of J lie over those of functions of mu.
///
/// Positions come first, then momenta.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no realization over the scalar `{S}`",
    note = "declare `realization`: a map from canonical coordinates whose brackets are those of the system"
)]
pub trait RealizedPoisson<S: Scalar>: Poisson<S> {
    /// A point (q, p).
    type Point: State<S>;
    /// A square matrix of its size.
    type PointMatrix: SquareMatrix<S>;
    /// The number of positions and momenta together.
    fn point_dimension(&self) -> usize;
    /// The name of one of them.
    fn canonical_name(&self, index: usize) -> &str;
    /// Whether the start is the user's; any other one is scaled to the size of the state.
    fn start_is_given(&self) -> bool;
    /// A point, all coordinates 0.
    fn zero_point(&self) -> Self::Point;
    /// A matrix, all entries 0.
    fn zero_point_matrix(&self) -> Self::PointMatrix;
    /// The map `out = J(z)`.
    fn momentum_map(&self, z: &Self::Point, out: &mut Self::State);
    /// The pullback of a covector: `out_i = sum_k xi_k dJ_k/dz_i`.
    fn pullback(&self, z: &Self::Point, xi: &Self::State, out: &mut Self::Point);
    /// The derivative along a vector: `out_k = sum_i dJ_k/dz_i v_i`.
    fn pushforward(&self, z: &Self::Point, v: &Self::Point, out: &mut Self::State);
    /// The second derivatives against a covector: `out_ij = sum_k xi_k d^2J_k/dz_i dz_j`.
    fn curvature(&self, z: &Self::Point, xi: &Self::State, out: &mut Self::PointMatrix);
    /// A point near which points over a state are sought.
    fn start(&self, out: &mut Self::Point);
}

/// A realization over which Gauss methods are methods for the state.
///
/// All components are of degree at most two in z, so that each has a flow by affine maps; and the span of the
/// matrices of these flows, constants beside them, is closed under `(abc + cba)/2`. The momenta of the
/// stages are then functions of mu alone. The compiler decides it.
#[diagnostic::on_unimplemented(
    message = "Gauss methods over the realization of `{Self}` do not descend to the state",
    note = "the components must be of degree at most two, and the matrices of their flows closed under (abc + cba)/2: `lie check` says what is missing; `LieMidpoint::exp()` works for every Lie algebra"
)]
pub trait ClosedRealization<S: Scalar>: RealizedPoisson<S> {}

/// A plane of rotation: the basis element is `E_(to, from) - E_(from, to)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    /// The axis that is turned.
    pub from: u16,
    /// The axis that it is turned to.
    pub to: u16,
}

impl Plane {
    /// The plane of two axes.
    pub const fn new(from: u16, to: u16) -> Self {
        Self { from, to }
    }
}

/// The rigid body in n >= 4 dimensions: so(n) in the basis of planes of rotation, and `H = <M, W>/2` with the angular velocity W that the
/// symmetric matrix J of second moments gives, `M = J W + W J`. In the axes of its moments `H = sum_(i<j) M_ij^2 / (2 (J_i + J_j))`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a rigid body in n dimensions over the scalar `{S}`",
    note = "the method needs so(n) in the basis E_ij - E_ji and H = <M, W>/2 with M = J W + W J"
)]
pub trait InertiaPoisson<S: Scalar>: LiePoisson<S> {
    /// An n x n matrix.
    type Matrix: SquareMatrix<S>;
    /// The plane of each basis element.
    fn planes(&self) -> &[Plane];
    /// An n x n matrix, all entries 0.
    fn zero_matrix(&self) -> Self::Matrix;
    /// The second moment `J_ii` along one axis.
    fn moment(&self, axis: usize) -> S;
    /// Whether J has other entries.
    fn is_tilted(&self) -> bool {
        false
    }
    /// The product of inertia `J_ij` of two axes.
    fn product(&self, _row: usize, _column: usize) -> S {
        S::zero()
    }
}
