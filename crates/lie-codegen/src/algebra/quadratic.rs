//! Whether Gauss methods for functions of quadratic functions `J_k` of z = (q, p) descend to mu = J(z).
//!
//! With one more canonical pair `(q_0, p_0)`, `q_0 = 1` for ever, a function of degree two in z is a quadratic form
//! `J_k = z^T S_k z / 2` in all of them, whose flow is linear: `z' = A_k z`, `A_k = J S_k` in sp. The brackets of the
//! functions are the commutators of the matrices.
//!
//! For `H o J` the stages of a Gauss method are `Z_i = Q_i z`, with `Q_i = 1 + sum_j a_ij B_j Q_j` and `B_j` in the
//! span of the `A_k`. Let `*` be the adjoint of the symplectic form, `A_k* = -A_k`. Then `T_i = Q_i*` obeys
//! `T_i = 1 - sum_j a_ij T_j B_j`, and `J_k(Z_i)` is the quadratic form of `T_i A_k Q_i`, a series of words in the
//! `A_k` that is skew under `*`. The skew words are those that `ab - ba` and `abc + cba` make of the letters, so
//! that `T_i A_k Q_i` lies in the closure E of the span under both.
//!
//! So the momenta of the stages, and with them the end of the step, are functions of mu where E adds nothing to
//! the span but constants. Where it does, some `B A_k B` is outside the span, and its quadratic form stands in
//! the momenta: of one stage the term in h^2 is that of `([B, [B, A_k]] + B A_k B)/4`. If E adds nothing but elements
//! that commute with all `A_k`, their forms are kept by the step, and it is a map of mu for fixed values of
//! them; else the end lies off the coadjoint orbit of mu.
//!
//! The skew words: let L be what the two operations make of the letters, `k(w) = w - w*`, and n the length of w. For
//! n < 4 `k(w)` is in L by definition. For larger n split `w = xyz v` into three letters and `v = (k(v) + s(v))/2`,
//! where `k(v)` is in L, and `s(v) = v + v*`. Modulo L, `k(xw) = k(wx)` by the commutator with x. A word of four
//! elements of L is symmetric in the middle two by a triple with their commutator, so symmetric in all, and its
//! reverse has the other sign: zero. With s in the place of the fourth, let `P(x, z, y) = k(x z s y)`; going round,
//! `P(y, z, x) = P(y, x, z)`, and by the triple of x, `zs + sz`, y `P(x, z, y) = -P(y, z, x)`. One exchange of two arguments
//! keeps P and another one changes its sign; they are conjugate, and P is zero.

use super::envelope;
use super::sparse::SparseMatrix;
use lie_symbolic::exact::span::{NoSpan, Span};
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// A function of degree two in z: the matrix of its quadratic form in `(1, z)`, twice the function itself.
pub type Form = Vec<Vec<Rational>>;

/// What the closure of some functions of degree two adds to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closure {
    /// Nothing but constants: Gauss methods descend.
    Nothing,
    /// Functions that commute with all of them.
    Commuting,
    /// Others: no Gauss method descends.
    Others,
}

/// The closure of functions of as many positions as momenta, positions first, under their brackets and
/// `(abc + cba)/2` of the matrices of their flows.
///
/// # Errors
/// [`Exhausted`] if that is too much work.
pub fn closure(forms: &[Form], budget: &Budget) -> Result<Closure, Exhausted> {
    let mut matrices: Vec<SparseMatrix> = Vec::new();
    let mut flat: Vec<Vec<Rational>> = Vec::new();
    let points = forms.first().map_or(0, |form| form.len() - 1);
    let mut constant = vec![vec![Rational::ZERO; points + 1]; points + 1];
    constant[0][0] = Rational::ONE;
    // the functions need not be independent
    for form in std::iter::once(&constant).chain(forms) {
        let matrix = flow(form, points / 2);
        flat.push(matrix.flat());
        budget.spend((flat.len() * flat.len() * flat[0].len()) as u64)?;
        match Span::new(&flat, budget) {
            Ok(_) => matrices.push(matrix),
            Err(NoSpan::Dependent(_)) => drop(flat.pop()),
            Err(NoSpan::Exhausted) => return Err(Exhausted),
        }
    }
    Ok(match envelope::closure(&matrices, budget)? {
        None => Closure::Others,
        Some(basis) if basis.len() == matrices.len() => Closure::Nothing,
        Some(_) => Closure::Commuting,
    })
}

/// The matrix of the flow on `(q_0, q, p_0, p)`: `q' = dF/dp`, `p' = -dF/dq`.
fn flow(form: &Form, half: usize) -> SparseMatrix {
    let size = half + 1;
    // 1, q, p stand at q_0, q, p; nothing depends on p_0
    let place = |index: usize| if index <= half { index } else { index + 1 };
    let mut rows = vec![vec![Rational::ZERO; 2 * size]; 2 * size];
    for (i, row) in form.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            let (i, j) = (place(i), place(j));
            if i < size {
                rows[i + size][j] = -value;
            } else {
                rows[i - size][j] = value.clone();
            }
        }
    }
    SparseMatrix::from_rows(&rows)
}

#[cfg(test)]
mod tests;
