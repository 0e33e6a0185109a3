//! Unitary representations on `C^N`, by anti-Hermitian matrices that are written as real ones, `[[Re, -Im], [Im, Re]]`.

use super::Structure;
use crate::algebra::Representation;
use crate::model::Model;
use lie_symbolic::exact::Rational;

type Matrix = Vec<Vec<Rational>>;

/// A unitary representation that carries collective methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Unitary {
    /// The number N.
    pub degree: usize,
}

impl Unitary {
    /// The number of real coordinates of a point, N - 1 columns of `C^N`.
    pub fn point(self) -> usize {
        2 * self.degree * (self.degree - 1)
    }
}

/// The unitary representation that the declared matrices are; `None` where they are none, or carry no collective methods.
///
/// That they represent the algebra, and the dual matrices, is known. The matrices and the dual ones are antisymmetric and commute
/// with the imaginary unit, exactly: then `J_k = (i/2) tr(X^H rho_k X)` has the brackets of the coordinates, and each state is
/// one of a Hermitian matrix.
pub fn unitary(model: &Model) -> Option<Unitary> {
    let representation = model.bracket.representation()?;
    let dual = representation.dual.as_ref()?;
    let size = representation.dimension;
    if model.family.is_some() || size < 4 || !size.is_multiple_of(2) {
        return None;
    }
    let degree = size / 2;
    let mut all = representation.matrices.iter().chain(dual);
    let anti_hermitian = all.all(|matrix| is_skew(matrix) && is_complex(matrix, degree));
    anti_hermitian.then_some(Unitary { degree })
}

/// Whether a matrix is antisymmetric.
pub fn is_skew(matrix: &Matrix) -> bool {
    let entries = |i: usize| matrix[i].iter().enumerate();
    (0..matrix.len()).all(|i| entries(i).all(|(j, entry)| (entry + &matrix[j][i]).is_zero()))
}

/// Whether a real matrix is `[[Re, -Im], [Im, Re]]` with so many rows in a block.
fn is_complex(matrix: &Matrix, degree: usize) -> bool {
    let places = (0..degree).flat_map(|a| (0..degree).map(move |b| (a, b)));
    places.into_iter().all(|(a, b)| {
        matrix[a][b] == matrix[degree + a][degree + b]
            && (&matrix[degree + a][b] + &matrix[a][degree + b]).is_zero()
    })
}

/// The quadratic Casimirs `sum g_kl mu_k mu_l` that are known: the sum of the squares of the eigenvalues of the Hermitian matrix of
/// a state, up to a factor, and the square of its trace, where that is not 0.
pub fn forms(representation: &Representation) -> Vec<Matrix> {
    let Some(dual) = &representation.dual else {
        return Vec::new();
    };
    let degree = representation.dimension / 2;
    let by_pairs = |value: &dyn Fn(&Matrix, &Matrix) -> Rational| -> Matrix {
        let row = |a: &Matrix| dual.iter().map(|b| value(a, b)).collect();
        dual.iter().map(row).collect()
    };
    // -tr(A B) of antisymmetric matrices
    let product = |a: &Matrix, b: &Matrix| {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.fold(Rational::ZERO, |sum, (x, y)| &sum + &(x * y))
    };
    let trace = |a: &Matrix| (0..degree).fold(Rational::ZERO, |sum, k| &sum + &a[degree + k][k]);
    let mut forms = vec![by_pairs(&product)];
    if dual.iter().any(|matrix| !trace(matrix).is_zero()) {
        forms.push(by_pairs(&|a, b| &trace(a) * &trace(b)));
    }
    forms
}

/// Why the lift over a unitary representation does not apply, with the nearest method that does.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    if structure.unitary.is_some() {
        return None;
    }
    if let Some(reason) = structure.why_not_declared_algebra() {
        return Some((reason, super::lifts::nearest(structure, order)));
    }
    if let Some((reason, remedy)) = super::matrices::refusal_of_functions(structure) {
        let nearest = super::lifts::nearest(structure, order);
        return Some((reason, format!("{nearest}, or {remedy}")));
    }
    let reason = "the lift `unitary` needs matrices that are anti-Hermitian, written as real ones [[Re, -Im], [Im, Re]], and \
                  closed under (abc + cba)/2 up to matrices that commute with them, such as those of su(n) and u(n)";
    Some((reason.into(), super::lifts::nearest(structure, order)))
}

#[cfg(test)]
mod tests {
    use super::Unitary;
    use crate::algebra::known::{self, Integers};
    use crate::compile::compile_spec;
    use crate::structure::lifts::Smallest;

    /// The degree that is found, and the smallest space.
    fn found(matrices: &[Integers]) -> (Option<usize>, Option<Smallest>) {
        let names: Vec<String> = (0..matrices.len()).map(|i| format!("E{i}")).collect();
        let state: Vec<String> = (0..matrices.len()).map(|i| format!("x{i}")).collect();
        let entries = names.iter().zip(matrices);
        let entries: Vec<String> = entries.map(|(e, m)| format!("\"{e}\": {m:?}")).collect();
        let spec = format!(
            r#"{{"format": 1, "name": "Any", "state": {state:?}, "hamiltonian": "x0^2", "algebra":
                {{"basis": {names:?}, "matrices": {{{}}}}}}}"#,
            entries.join(", ")
        );
        let structure = compile_spec(&spec).expect("a sound spec");
        (
            structure.unitary.map(|Unitary { degree }| degree),
            structure.smallest,
        )
    }

    /// Rows and columns in another order.
    fn reordered(matrices: &[Integers], order: &[usize]) -> Vec<Integers> {
        let entry = |m: &Integers, a: usize, b: usize| m[order[a]][order[b]];
        let places = 0..order.len();
        let matrix = |m: &Integers| {
            let row = |a| places.clone().map(|b| entry(m, a, b)).collect();
            places.clone().map(row).collect()
        };
        matrices.iter().map(matrix).collect()
    }

    #[test]
    fn unitary_representations_are_found_in_any_basis() {
        let su3 = known::su(3);
        let imaginary_unit: Integers = (0..6)
            .map(|a| {
                (0..6)
                    .map(|b| i64::from(a == b + 3) - i64::from(b == a + 3))
                    .collect()
            })
            .collect();
        let u3: Vec<Integers> = su3.iter().cloned().chain([imaginary_unit]).collect();
        let smallest = Some(Smallest::Unitary);
        assert_eq!(found(&su3), (Some(3), smallest));
        assert_eq!(found(&known::mixed(&su3, 5)), (Some(3), smallest));
        assert_eq!(found(&known::mixed(&u3, 7)), (Some(3), smallest));
        assert_eq!(found(&known::mixed(&known::su(2), 5)), (Some(2), smallest));
        assert_eq!(found(&known::su(2)), (Some(2), Some(Smallest::Hopf)));
        // the parts beside each other, which it does not see
        let beside = reordered(&su3, &[0, 3, 1, 4, 2, 5]);
        let columns = Some(Smallest::Representation);
        assert_eq!(found(&beside), (None, columns));
        assert_eq!(found(&known::sp(2)), (None, columns));
        assert_eq!(found(&known::so(4)), (None, columns));
    }
}
