//! The momenta of the stages in a matrix representation.

use super::blocks::{factor, multiply, set_units, size, solve, solve_weights};
use super::chart::invertible_along;
use super::stage_momenta::StageMap;
use super::tableau::Tableau;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::scalar::{Mask as _, Scalar};
use crate::state::{Stages, State, copies};
use crate::structure::{Entry, MatrixPoisson, Representation, Spectrum};

/// The stages of a Gauss method on `T*V`, V the space of a representation `rho`, reduced to g*.
///
/// With `B_j = -rho(x_j)` and any W of the momentum `tr(W rho(e_k)) = mu_k`:
///
/// ```math
/// Q_i = 1 + \sum_j \mu_{ij} B_j Q_j, \qquad T_i = 1 - \sum_j \mu_{ij} T_j B_j, \qquad
/// M_i[k] = \mathrm{tr}(Q_i W T_i\, \rho(e_k))
/// ```
///
/// Both are linear systems of s d equations, solved in a fixed order. With `G = (1 - A B)^-1 A` and
/// `F = (1 + A B^T)^-1 A` (A the matrix of the ratios `mu_ij = a_ij/b_j`, B block diagonal) the derivatives are
///
/// ```math
/// \frac{\partial M_i[k]}{\partial x_j[c]} =
/// -\mathrm{tr}\bigl(\rho(e_c)\, Q_j W T_i\, \rho(e_k)\, G_{ij}\bigr)
/// + \mathrm{tr}\bigl(Q_i W T_j\, \rho(e_c)\, F_{ij}^T \rho(e_k)\bigr)
/// ```
///
/// Where all matrices are antisymmetric, `T_i = Q_i^T`, `F = G`, and both terms are equal. Where a pivot of
/// either system is small, the momenta are not a number: the step is too large.
#[derive(Clone, Debug)]
pub struct MatrixStages<S, M, const STAGES: usize> {
    tableau: Tableau<S, STAGES>,
    /// W
    momentum: M,
    /// `rho(x_j)`
    motion: [M; STAGES],
    /// Factors of `1 - A B`, then of `1 + A B^T`.
    factors: StageMatrix<M, STAGES>,
    /// `Q_i`
    position: [M; STAGES],
    /// `T_i^T`
    covector: [M; STAGES],
    /// G, columns first
    forward: StageMatrix<M, STAGES>,
    /// F, columns first
    backward: StageMatrix<M, STAGES>,
    /// `Q_j W T_i` in block (j, i)
    paired: StageMatrix<M, STAGES>,
    /// `Q_j W`
    product: M,
}

impl<S: Scalar, M: SquareMatrix<S>, const STAGES: usize> MatrixStages<S, M, STAGES> {
    fn with_zero(zero: &M, tableau: &Tableau<S, STAGES>) -> Self {
        let blocks = || copies(zero);
        let square = || StageMatrix(copies(&blocks()));
        Self {
            tableau: *tableau,
            momentum: zero.clone(),
            motion: blocks(),
            factors: square(),
            position: blocks(),
            covector: blocks(),
            forward: square(),
            backward: square(),
            paired: square(),
            product: zero.clone(),
        }
    }

    /// Factors `1 + A rho(x)` (`transposed` false) or `1 - A rho(x)^T`; true where no pivot is small.
    fn factor(&mut self, transposed: bool) -> S::Mask {
        let size = self.momentum.dimension();
        for (i, row) in self.factors.0.iter_mut().enumerate() {
            for (j, block) in row.iter_mut().enumerate() {
                let weight = self.tableau.ratios[i][j];
                let motion = &self.motion[j];
                for r in 0..size {
                    for c in 0..size {
                        let identity = if i == j && r == c {
                            S::one()
                        } else {
                            S::zero()
                        };
                        let entry = if transposed {
                            identity - weight * motion.get(c, r)
                        } else {
                            identity + weight * motion.get(r, c)
                        };
                        block.set(r, c, entry);
                    }
                }
            }
        }
        factor(&mut self.factors)
    }

    /// Q, T, and with `derivatives` G and F.
    fn solve(&mut self, skew: bool, derivatives: bool) {
        let ones = [S::one(); STAGES];
        let mut safe = self.factor(false);
        set_units(ones, &mut self.position);
        solve(&self.factors, &mut self.position);
        if derivatives {
            solve_weights(&self.tableau, &self.factors, &mut self.forward);
        }
        if skew {
            self.covector.clone_from_slice(&self.position);
        } else {
            safe = safe & self.factor(true);
            set_units(ones, &mut self.covector);
            solve(&self.factors, &mut self.covector);
            if derivatives {
                solve_weights(&self.tableau, &self.factors, &mut self.backward);
            }
        }
        let poison = S::select(safe, S::zero(), S::from_f64(f64::NAN));
        let size = self.momentum.dimension();
        for block in &mut self.position {
            for r in 0..size {
                block.set(r, r, block.get(r, r) + poison);
            }
        }
    }

    /// `Q_j W T_i` for all pairs, or where j = i.
    fn pair(&mut self, all: bool) {
        let size = self.momentum.dimension();
        for j in 0..STAGES {
            multiply(size, &self.position[j], &self.momentum, &mut self.product);
            for i in (0..STAGES).filter(|&i| all || i == j) {
                let (left, right) = (&self.product, &self.covector[i]);
                let out = &mut self.paired.0[j][i];
                for r in 0..size {
                    for c in 0..size {
                        let mut sum = S::zero();
                        for k in 0..size {
                            sum += left.get(r, k) * right.get(c, k);
                        }
                        out.set(r, c, sum);
                    }
                }
            }
        }
    }

    /// Whether `1 + s A rho(x)` and `1 - s A rho(x)^T` have inverses for every s from 0 to 1.
    #[cold]
    fn far_chart(&mut self) -> S::Mask {
        let size = self.momentum.dimension();
        let mut all = S::Mask::splat(true);
        for transposed in [false, true] {
            for i in 0..STAGES {
                for j in 0..STAGES {
                    let (weight, motion) = (self.tableau.ratios[i][j], &self.motion[j]);
                    for r in 0..size {
                        for c in 0..size {
                            let entry = if transposed {
                                -motion.get(c, r)
                            } else {
                                motion.get(r, c)
                            };
                            self.factors.0[i][j].set(r, c, weight * entry);
                        }
                    }
                }
            }
            all = all & invertible_along(&self.factors, None);
        }
        all
    }

    /// Sets W and `rho(x_j)`.
    fn set<V: State<S>>(&mut self, table: &Representation<'_>, mu: &V, x: &Stages<V, STAGES>) {
        assemble(table.dual, mu.as_slice(), &mut self.momentum);
        for (motion, x) in self.motion.iter_mut().zip(&x.0) {
            assemble(table.matrices, x.as_slice(), motion);
        }
    }

    fn read<V: State<S>>(&self, table: &Representation<'_>, out: &mut Stages<V, STAGES>) {
        for (i, out) in out.0.iter_mut().enumerate() {
            let pairs = out.as_mut_slice().iter_mut();
            for (out, matrix) in pairs.zip(table.matrices) {
                let mut sum = S::zero();
                for entry in *matrix {
                    let (row, column) = entry.place();
                    sum += entry.value::<S>() * self.paired.0[i][i].get(column, row);
                }
                *out = sum;
            }
        }
    }

    /// `dM_i[k]/dx_j[c]`
    fn slope(&self, [i, j]: [usize; 2], c: &[Entry], k: &[Entry], skew: bool) -> S {
        let (forward, paired) = (&self.forward.0[j][i], &self.paired.0[j][i]);
        let mut first = S::zero();
        for left in c {
            let (p, q) = left.place();
            let mut inner = S::zero();
            for right in k {
                let (r, t) = right.place();
                inner += right.value::<S>() * paired.get(q, r) * forward.get(t, p);
            }
            first += left.value::<S>() * inner;
        }
        if skew {
            return -(first + first);
        }
        let (backward, paired) = (&self.backward.0[j][i], &self.paired.0[i][j]);
        let mut second = S::zero();
        for left in c {
            let (p, q) = left.place();
            let mut inner = S::zero();
            for right in k {
                let (r, t) = right.place();
                inner += right.value::<S>() * paired.get(t, p) * backward.get(r, q);
            }
            second += left.value::<S>() * inner;
        }
        second - first
    }
}

impl<S, P, const STAGES: usize> StageMap<S, P, STAGES> for MatrixStages<S, P::Matrix, STAGES>
where
    S: Scalar,
    P: MatrixPoisson<S>,
{
    // for antisymmetric matrices and triangular arrangements of them `1 + A rho(x)` has an inverse: Gauss
    // methods are algebraically stable
    fn everywhere(system: &P) -> bool {
        matches!(system.spectrum(), Spectrum::Imaginary)
    }

    fn new(system: &P, tableau: &Tableau<S, STAGES>) -> Self {
        Self::with_zero(&system.zero_matrix(), tableau)
    }

    fn within_chart(&mut self, system: &P, x: &Stages<P::State, STAGES>) -> S::Mask {
        for (motion, x) in self.motion.iter_mut().zip(&x.0) {
            assemble(system.representation().matrices, x.as_slice(), motion);
        }
        let sizes = self.motion.each_ref().map(|motion| size(motion));
        let mut bound = S::zero();
        for row in &self.tableau.ratios {
            let mut sum = S::zero();
            for (&weight, &size) in row.iter().zip(&sizes) {
                sum += weight.abs() * size;
            }
            bound = bound.max(sum);
        }
        let near = bound.less(S::one());
        if near.all() {
            return near;
        }
        near | self.far_chart()
    }

    fn momenta(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
    ) {
        let table = &system.representation();
        self.set(table, mu, x);
        self.solve(table.skew, false);
        self.pair(false);
        self.read(table, out);
    }

    fn linearize(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
        slopes: &mut StageMatrix<P::Jacobian, STAGES>,
    ) {
        let table = &system.representation();
        self.set(table, mu, x);
        self.solve(table.skew, true);
        self.pair(true);
        self.read(table, out);
        for (i, row) in slopes.0.iter_mut().enumerate() {
            for (j, block) in row.iter_mut().enumerate() {
                for (c, left) in table.matrices.iter().enumerate() {
                    for (k, right) in table.matrices.iter().enumerate() {
                        block.set(k, c, self.slope([i, j], left, right, table.skew));
                    }
                }
            }
        }
    }
}

/// `out = sum_k coordinates_k matrices_k`
fn assemble<S: Scalar, M: SquareMatrix<S>>(matrices: &[&[Entry]], coordinates: &[S], out: &mut M) {
    let size = out.dimension();
    for row in 0..size {
        for column in 0..size {
            out.set(row, column, S::zero());
        }
    }
    for (&coordinate, matrix) in coordinates.iter().zip(matrices) {
        for entry in *matrix {
            let (row, column) = entry.place();
            let sum = out.get(row, column) + entry.value::<S>() * coordinate;
            out.set(row, column, sum);
        }
    }
}
