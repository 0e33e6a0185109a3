//! Linear symplectic spaces over systems, which collective methods go over.

use super::{Entry, MatrixPoisson};
use crate::generic::{
    LinearLift, flow_over_columns, flow_over_factors, flow_over_quaternions, flow_over_spins,
};
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Columns of a representation over which a state is lifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<'a> {
    /// Which columns `x_j` of the unit matrix.
    pub indices: &'a [u16],
    /// The rows `y_j = sum_k mu_k y_j^k` beside them, with `mu_k = sum_j y_j rho(e_k) x_j`: for each k entries in row j.
    pub covectors: &'a [&'a [Entry]],
}

/// A system whose representation carries a reduction of `T*V^r` to g*: with as few columns as determine the momentum, and what
/// commutes with the representation.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no matrix representation over the scalar `{S}` that carries this method",
    note = "declare `matrices` whose closure under (abc + cba)/2 adds only matrices that commute with them, or use `LieMidpoint::exp()`"
)]
pub trait ColumnPoisson<S: Scalar>: MatrixPoisson<S> {
    /// The columns, then the rows.
    type Columns: State<S>;
    /// Columns and rows, all 0.
    fn zero_columns(&self) -> Self::Columns;
    /// The size of a column: that of the matrices, without the block of the time.
    fn column_size(&self) -> usize;
    /// The columns.
    fn columns(&self) -> Columns<'_>;
    /// The canonical flow of `H o J`; see [`flow_over_columns`].
    #[inline]
    fn column_flow(&self, point: &Self::Columns, out: &mut Self::Columns) {
        flow_over_columns(self, point, out);
    }
}

/// A system whose representation is a unitary one on `C^N`: its matrices and the dual ones are those of anti-Hermitian matrices, real
/// `[[Re, -Im], [Im, Re]]`. A state is `mu_k = (i/2) tr(M rho(e_k))` of the Hermitian matrix `M = -4 i sum mu_k D^k`, and
/// `M - lambda_min = X X^H` with N - 1 columns X, on which the unitary matrices act from the right.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no unitary representation over the scalar `{S}`",
    note = "the method needs `matrices` that are anti-Hermitian, `[[Re, -Im], [Im, Re]]`, such as those of su(n) and u(n)"
)]
pub trait UnitaryPoisson<S: Scalar>: MatrixPoisson<S> {
    /// The number N of rows of X.
    fn degree(&self) -> usize;
    /// The eigenvalue `lambda_min`, which distinguishes orbits.
    type Shift: State<S>;
    /// 0.
    fn zero_shift(&self) -> Self::Shift;
    /// The columns of X: the real parts of all of them, then the imaginary ones.
    type Factor: State<S>;
    /// Columns, all 0.
    fn zero_factor(&self) -> Self::Factor;
    /// Two complex N x N matrices.
    type Hermitian: State<S>;
    /// Two matrices, all entries 0.
    fn zero_hermitian(&self) -> Self::Hermitian;
    /// The canonical flow of `(H - C) o J` at points, C any function of Casimirs, `X' = -rho(grad (H - C)) X`; see
    /// [`flow_over_factors`], for which C is 0.
    #[inline]
    fn unitary_flow(&self, shift: &Self::Shift, point: &Self::Factor, out: &mut Self::Factor) {
        flow_over_factors(self, shift, point, out);
    }
}

/// A Lie–Poisson system on a direct sum of algebras so(3): each coordinate belongs to one spin, a triple
/// (i, j, k) with `[e_i, e_j] = c e_k` and its cyclic permutations.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a system of spins over the scalar `{S}`",
    note = "the method needs a direct sum of algebras so(3), each with [e1, e2] = c e3 and cyclic permutations"
)]
pub trait SpinPoisson<S: Scalar>: LiePoisson<S> {
    /// The coordinates of each spin.
    fn spins(&self) -> &[[usize; 3]];
    /// The constant c of one spin.
    fn scale(&self, spin: usize) -> S;
    /// Points of `T*R^2` over all spins, four coordinates `(q1, q2, p1, p2)` for each.
    type Spinors: State<S>;
    /// Points of the right size, all coordinates 0.
    fn zero_spinors(&self) -> Self::Spinors;
    /// The canonical flow of `(H - C) o J` at points, C any function of Casimirs; see
    /// [`flow_over_spins`], for which C is 0.
    #[inline]
    fn spinor_flow(&self, point: &Self::Spinors, out: &mut Self::Spinors) {
        flow_over_spins(self, point, out);
    }
}

/// A Lie–Poisson system on the semidirect product of so(3) with some vectors, which commute: se(3) with one of them. With
/// the rotations `J_i` and the vectors `V_j`, in coordinates that may be scaled, `[J_1, J_2] = c J_3`,
/// `[J_1, V_2] = c V_3` and its cyclic permutations.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a system of a rotation group with vectors over the scalar `{S}`",
    note = "the method needs so(3) with vectors that commute, such as se(3), with [J1, J2] = c J3, [J1, P2] = c P3 and cyclic permutations"
)]
pub trait VectorPoisson<S: Scalar>: LiePoisson<S> {
    /// The coordinates of the rotations.
    fn rotation(&self) -> [usize; 3];
    /// The components of each vector: in the row of an entry the coordinate, which is its value times the component.
    fn vectors(&self) -> &[[Entry; 3]];
    /// The constant c.
    fn scale(&self) -> S;
    /// What distinguishes orbits: the length of a single vector, or three coordinates for each of several.
    type Labels: State<S>;
    /// Labels, all 0.
    fn zero_labels(&self) -> Self::Labels;
    /// Points of `T*H`: a quaternion, then its momentum, the real parts first.
    type Quaternions: State<S>;
    /// A point, all coordinates 0.
    fn zero_quaternions(&self) -> Self::Quaternions;
    /// The canonical flow of `(H - C) o J` on `T*H`, C any function of Casimirs; see
    /// [`flow_over_quaternions`], for which C is 0.
    #[inline]
    fn quaternion_flow(
        &self,
        labels: &Self::Labels,
        point: &Self::Quaternions,
        out: &mut Self::Quaternions,
    ) {
        flow_over_quaternions(self, labels, point, out);
    }
}

/// A system over which there is a linear symplectic space that carries collective methods: the smallest of those that the
/// compiler knows.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no linear symplectic space over the scalar `{S}` that carries collective methods",
    note = "declare `matrices` whose closure under (abc + cba)/2 adds only matrices that commute with them, or use `LieMidpoint::exp()`"
)]
pub trait CollectivePoisson<S: Scalar>: LiePoisson<S> + Sized {
    /// The space.
    type Lift: LinearLift<S, Self>;
}
