use super::known::{self, Integers};
use super::sparse::SparseMatrix;
use super::*;
use lie_symbolic::exact::span::Span;
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_syntax::linear::WORK;

fn budget() -> Budget {
    Budget::new(WORK)
}

fn failure(constants: &StructureConstants<Fraction>) -> Option<jacobi::Failure> {
    jacobi::first_failure(constants, &budget()).unwrap()
}

fn triple(matrices: &[Vec<Vec<Rational>>]) -> Option<Vec<representation::TripleEntry>> {
    let flat: Vec<Vec<Rational>> = matrices.iter().map(|m| m.concat()).collect();
    let sparse: Vec<_> = matrices
        .iter()
        .map(|m| SparseMatrix::from_rows(m))
        .collect();
    super::triple::closure(&sparse, &Span::new(&flat, &budget()).unwrap(), &budget()).unwrap()
}

fn closed(matrices: &[Integers]) -> bool {
    triple(&known::rationals(matrices)).is_some()
}

/// Every entry of the table of an algebra, one at a time, made wrong by `delta`.
fn perturbations(
    base: &StructureConstants<Fraction>,
    delta: &Rational,
) -> Vec<StructureConstants<Fraction>> {
    let shifted = |position: usize| {
        let mut entries = base.entries().to_vec();
        entries[position].3 = entries[position]
            .3
            .add(&Fraction::from(delta.clone()), &budget())
            .unwrap();
        entries.retain(|e| !e.3.is_zero());
        StructureConstants::new(base.dimension(), entries)
    };
    (0..base.entries().len()).map(shifted).collect()
}

#[test]
fn known_algebras_satisfy_jacobi() {
    for algebra in [
        known::SO3,
        known::SE3,
        known::SL2,
        known::H3,
        known::AFF1,
        known::E2,
    ] {
        assert!(failure(&known::constants(algebra)).is_none());
    }
    for matrices in [
        known::so(4),
        known::so(5),
        known::gl(3),
        known::sp(2),
        known::su(3),
        known::so(7),
    ] {
        assert!(failure(&known::from_matrices(&matrices)).is_none());
    }
}

#[test]
fn one_wrong_coefficient_is_found() {
    let tiny = Rational::from(10).pow(-18).unwrap();
    for base in [
        known::constants(known::SE3),
        known::from_matrices(&known::so(4)),
        known::from_matrices(&known::sp(2)),
    ] {
        for delta in [Rational::ONE, tiny.clone()] {
            for wrong in perturbations(&base, &delta) {
                let failure = failure(&wrong).expect("the identity must fail");
                assert!(!failure.residual.is_empty());
                let (i, j, l) = failure.triple;
                assert!(i < j && j < l);
            }
        }
    }
    // so(3) accepts a change of a coefficient: it is only scaled along one axis.
    assert!(
        perturbations(&known::constants(known::SO3), &Rational::ONE)
            .iter()
            .all(|c| failure(c).is_none())
    );
}

#[test]
fn residual_is_the_jacobiator() {
    // [J2, P3] = 2 P1 in se(3) instead of P1.
    let wrong = perturbations(&known::constants(known::SE3), &Rational::ONE).remove(6);
    let failure = failure(&wrong).unwrap();
    // (J1, J2, P1): [[J1,J2],P1] + [[J2,P1],J1] + [[P1,J1],J2] = P2 + [-P3,J1] = P2 - P2 = 0, so the
    // first triple is (J1, J2, P2): [J3,P2] + [[P2,J1],J2] = -P1 + [-P3,J2] = -P1 + 2 P1.
    assert_eq!(failure.triple, (0, 1, 4));
    assert_eq!(failure.residual.len(), 1);
    assert_eq!(failure.residual[0].0, 3);
    assert_eq!(failure.residual[0].1.as_constant(), Some(Rational::ONE));
}

#[test]
fn parameters_must_satisfy_jacobi_identically() {
    let k = Fraction::variable(0);
    // [J, J] = J, [J, P] = P, [P, P] = k J: so(4) for k > 0, se(3) for k = 0.
    let mut entries = known::constants(known::SE3).entries().to_vec();
    for (i, j, l, sign) in [(3, 4, 2, 1), (3, 5, 1, -1), (4, 5, 0, 1)] {
        entries.push((i, j, l, k.scale(&Rational::from(sign))));
    }
    assert!(failure(&StructureConstants::new(6, entries.clone())).is_none());
    // With one of the three equal to k^2/k it still holds, with k^2 only where k is 0 or 1.
    let square = k.mul(&k, &budget()).unwrap();
    let last = entries.len() - 1;
    entries[last].3 = square.div(&k, &budget()).unwrap().unwrap();
    assert!(failure(&StructureConstants::new(6, entries.clone())).is_none());
    entries[last].3 = square.clone();
    let found = failure(&StructureConstants::new(6, entries)).unwrap();
    let at = |value: i64| {
        found.residual[0]
            .1
            .evaluate(&|_| Rational::from(value))
            .unwrap()
    };
    assert!(at(0).is_zero() && at(1).is_zero() && !at(2).is_zero());
}

#[test]
fn work_is_bounded() {
    let dense = known::from_matrices(&known::gl(4));
    assert!(jacobi::first_failure(&dense, &Budget::new(100)).is_err());
}

#[test]
fn generic_ranks() {
    for (algebra, rank) in [
        (known::SO3, 2),
        (known::SE3, 4),
        (known::SL2, 2),
        (known::H3, 2),
        (known::AFF1, 2),
        (known::E2, 2),
    ] {
        assert_eq!(
            rank::generic_rank(&known::constants(algebra), algebra.0),
            rank
        );
    }
    for (matrices, rank) in [
        (known::so(4), 4),
        (known::gl(2), 2),
        (known::su(3), 6),
        (known::sp(2), 8),
    ] {
        assert_eq!(
            rank::generic_rank(&known::from_matrices(&matrices), matrices.len()),
            rank
        );
    }
    let abelian = StructureConstants::new(4, Vec::new());
    assert_eq!(rank::generic_rank(&abelian, 4), 0);
    let so3 = known::constants(known::SO3);
    assert_eq!(
        rank::rank_at(
            &so3,
            &[Rational::ZERO, Rational::ZERO, Rational::ZERO],
            &[],
            3
        ),
        Some(0)
    );
}

#[test]
fn triple_products_close_where_they_should() {
    for matrices in [
        known::so(3),
        known::so(4),
        known::so(5),
        known::sl2(),
        known::gl(2),
        known::gl(3),
        known::se3(),
        known::e2(),
        known::sp(2),
    ] {
        assert!(closed(&matrices));
    }
    assert!(!closed(&known::su(3)));
    for (matrices, expected) in [
        (known::sl2(), true),
        (known::so(4), true),
        (known::se3(), true),
        (known::e2(), true),
        (known::su(3), false),
    ] {
        let constants = known::from_matrices(&matrices);
        assert_eq!(
            triple(&known::adjoint(matrices.len(), &constants)).is_some(),
            expected
        );
    }
}

#[test]
fn triple_product_of_so3_is_known() {
    // x y x = -(x . y) x, so T_abc = -(delta_ab e_c + delta_bc e_a)/2.
    let matrices = known::se3()
        .into_iter()
        .take(3)
        .map(|m| m.iter().take(3).map(|r| r[..3].to_vec()).collect())
        .collect::<Vec<Integers>>();
    let entries = triple(&known::rationals(&matrices)).unwrap();
    let mut expected = Vec::new();
    for a in 0..3 {
        for b in 0..3 {
            for c in 0..3 {
                for d in 0..3 {
                    let twice = i64::from(a == b && c == d) + i64::from(b == c && a == d);
                    if twice != 0 {
                        let value = Rational::new(-twice, 2).unwrap();
                        expected.push((a, b, c, d, Fraction::from(value)));
                    }
                }
            }
        }
    }
    assert_eq!(entries, expected);
}

#[test]
fn a_change_of_basis_changes_nothing() {
    let algebras = [
        (known::so(4), 4),
        (known::se3(), 4),
        (known::gl(3), 6),
        (known::sp(2), 8),
        (known::su(3), 6),
    ];
    for (seed, (matrices, rank)) in algebras.into_iter().enumerate() {
        let was_closed = closed(&matrices);
        let mixed = known::mixed(&matrices, seed as u64 + 2018);
        let constants = known::from_matrices(&mixed);
        assert!(constants.entries().len() > 2 * known::from_matrices(&matrices).entries().len());
        assert!(failure(&constants).is_none());
        assert_eq!(rank::generic_rank(&constants, mixed.len()), rank);
        assert_eq!(closed(&mixed), was_closed);
        // One wrong coefficient, however slightly wrong, violates the identity.
        let tiny = Rational::from(10).pow(-18).unwrap();
        for wrong in perturbations(&constants, &tiny).into_iter().step_by(7) {
            let found = failure(&wrong).expect("the identity must fail");
            assert!(found.count > 0 && !found.residual.is_empty());
        }
    }
}

/// The closure of the span may add matrices that commute with the representation, and no others.
#[test]
fn dual_matrices_exist_where_the_method_stays_on_the_orbit() {
    let dual = |matrices: &[Vec<Vec<Rational>>]| {
        let sparse: Vec<_> = matrices
            .iter()
            .map(|m| SparseMatrix::from_rows(m))
            .collect();
        let closed = triple(matrices).is_some();
        // what is closed has the closure of any other
        let found = envelope::dual(&sparse, closed, &budget()).unwrap();
        assert_eq!(found, envelope::dual(&sparse, false, &budget()).unwrap());
        found
    };
    let trace = |a: &[Vec<Rational>], b: &[Vec<Rational>]| {
        let mut sum = Rational::ZERO;
        for (i, row) in a.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                sum = &sum + &(entry * &b[j][i]);
            }
        }
        sum
    };
    // the rows beside the columns, all others 0
    let in_full = |columns: &Columns, k: usize| {
        let covector = &columns.covectors[k];
        let size = covector[0].len();
        let row = |j: usize| match columns.indices.iter().position(|&index| index == j) {
            Some(place) => covector[place].clone(),
            None => vec![Rational::ZERO; size],
        };
        (0..size).map(row).collect::<Vec<_>>()
    };
    for matrices in [
        known::so(4),
        known::sl2(),
        known::gl(2),
        known::se3(),
        known::sp(2),
        known::su(3),
        known::mixed(&known::su(3), 5),
    ] {
        let matrices = known::rationals(&matrices);
        let dual = dual(&matrices).expect("it carries the method");
        for (k, left) in dual.matrices.iter().enumerate() {
            for (l, right) in matrices.iter().enumerate() {
                let unit = Rational::from(i64::from(k == l));
                assert_eq!(trace(left, right), unit);
                assert_eq!(trace(&in_full(&dual.columns, k), right), unit);
            }
        }
    }
    // su(3) closes to u(3): the dual matrices do not see the imaginary unit
    let su3 = known::rationals(&known::su(3));
    let size = su3[0].len();
    let mut unit = vec![vec![Rational::ZERO; size]; size];
    for k in 0..size / 2 {
        unit[k][k + size / 2] = Rational::MINUS_ONE;
        unit[k + size / 2][k] = Rational::ONE;
    }
    let found = dual(&su3).expect("su(3)");
    for (k, matrix) in found.matrices.iter().enumerate() {
        assert!(trace(matrix, &unit).is_zero());
        assert!(trace(&in_full(&found.columns, k), &unit).is_zero());
    }
    assert_eq!(found.columns.indices.len(), 3, "one complex column each");
    let of = |matrices: &[Vec<Vec<i64>>]| {
        let found = dual(&known::rationals(matrices)).expect("it carries the method");
        found.columns.indices
    };
    assert_eq!(of(&known::so(4)), [0, 1, 2]);
    assert_eq!(of(&known::se3()), [0, 1, 3]);
    // the adjoint representation of su(3) closes to more
    let constants = known::from_matrices(&known::su(3));
    assert_eq!(dual(&known::adjoint(8, &constants)), None);
}
