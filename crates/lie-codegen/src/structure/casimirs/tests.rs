//! Known Casimirs, in known bases and in others.

use super::*;
use crate::algebra::known::{self, from_matrices, mixed, unit};
use crate::algebra::rank;

fn search(constants: &StructureConstants<Fraction>, work: u64) -> Found {
    let n = constants.dimension();
    let wanted = n - rank::generic_rank(constants, n);
    find(constants, wanted, Kind::LINEAR, work)
}

fn degrees(found: &Found) -> Vec<u32> {
    let degree = |casimir: &Casimir| match casimir {
        Casimir::Polynomial(function) => function.degree(),
        Casimir::Rational(_) => 0,
    };
    found.casimirs.iter().map(degree).collect()
}

fn shown(found: &Found) -> Vec<String> {
    let name = |v: usize| format!("x{v}");
    let show = |casimir: &Casimir| match casimir {
        Casimir::Polynomial(function) => function.display(&name),
        Casimir::Rational(factors) => {
            let factors = factors
                .iter()
                .map(|(f, e)| format!("({})^{e}", f.display(&name)));
            factors.collect::<Vec<_>>().join(" ")
        }
    };
    found.casimirs.iter().map(show).collect()
}

/// The Poincare algebra in 5 x 5 matrices: so(1, 3) and translations.
fn poincare() -> Vec<known::Integers> {
    let mut basis = Vec::new();
    for i in 0..4 {
        for j in i + 1..4 {
            let mut e = unit(5, j, i);
            e[i][j] = if i == 0 { 1 } else { -1 };
            basis.push(e);
        }
    }
    basis.extend((0..4).map(|i| unit(5, i, 4)));
    basis
}

#[test]
fn known_casimirs_in_full() {
    let se3 = search(&known::constants(known::SE3), WORK);
    assert_eq!(shown(&se3), ["x0*x3 + x1*x4 + x2*x5", "x3^2 + x4^2 + x5^2"]);
    let so3 = search(&known::constants(known::SO3), WORK);
    assert_eq!(shown(&so3), ["x0^2 + x1^2 + x2^2"]);
    let h3 = search(&known::constants(known::H3), WORK);
    assert_eq!(shown(&h3), ["x2"]);
    let abelian = search(&known::constants((2, &[])), WORK);
    assert_eq!(shown(&abelian), ["x0", "x1"]);
    let aff1 = search(&known::constants(known::AFF1), WORK);
    assert_eq!((shown(&aff1), aff1.complete), (Vec::new(), true));
    // so(3) + so(3): no product, and each in its own coordinates
    let two = [known::SO3.1, known::SO3.1].concat();
    let shift = |i: usize| if i < 3 { 0 } else { 3 };
    let two: Vec<known::Entry> = two
        .iter()
        .enumerate()
        .map(|(i, &(a, b, c, v))| (a + shift(i), b + shift(i), c + shift(i), v))
        .collect();
    let two = search(&known::constants((6, &two)), WORK);
    assert_eq!(shown(&two), ["x0^2 + x1^2 + x2^2", "x3^2 + x4^2 + x5^2"]);
}

#[test]
fn a_sum_of_many_is_searched_part_by_part() {
    // copies of so(3) whose basis elements are not side by side: i, i + 80, i + 160
    let copies = 80;
    let entries = (0..copies).flat_map(|i| {
        let at = move |e: usize| i + copies * e;
        known::SO3
            .1
            .iter()
            .map(move |&(a, b, c, v)| (at(a), at(b), at(c), v))
    });
    let entries: Vec<known::Entry> = entries.collect();
    let found = search(&known::constants((3 * copies, &entries)), WORK);
    assert_eq!((found.casimirs.len(), found.complete), (copies, true));
    assert_eq!(shown(&found)[7], "x7^2 + x87^2 + x167^2");
}

#[test]
fn parts_keep_their_parameters_and_a_unit_is_of_all() {
    // the third pair has a bracket k with a constant term: x4 is the unit
    let k = Fraction::variable(0);
    let one = Fraction::from(lie_symbolic::exact::Rational::ONE);
    let entries = vec![
        (0, 2, 5, one.clone()),
        (0, 5, 2, one.neg()),
        (2, 5, 0, k),
        (1, 3, 6, one),
    ];
    let constants = StructureConstants::new(7, entries);
    let found = find(
        &constants,
        2,
        Kind {
            with_unit: true,
            ..Kind::LINEAR
        },
        WORK,
    );
    assert_eq!(shown(&found), ["x4", "x0^2*x7 + x2^2 + x5^2"]);
}

/// Of each algebra, in its basis and in another.
fn have_degrees<const N: usize>(cases: [(&str, Vec<known::Integers>, &[u32]); N]) {
    for (name, matrices, expected) in cases {
        let found = search(&from_matrices(&matrices), WORK);
        assert_eq!(
            (degrees(&found), found.complete),
            (expected.to_vec(), true),
            "{name}"
        );
        let other = from_matrices(&mixed(&matrices, 2018));
        let found = search(&other, REPORT);
        assert_eq!(degrees(&found), expected, "{name} in another basis");
    }
}

#[test]
fn degrees_in_their_bases_and_in_others() {
    have_degrees([
        ("se(3)", known::se3(), &[2, 2]),
        ("so(4)", known::so(4), &[2, 2]),
        ("su(3)", known::su(3), &[2, 3]),
        ("gl(3)", known::gl(3), &[1, 2, 3]),
        ("so(5)", known::so(5), &[2, 4]),
        ("sp(4)", known::sp(2), &[2, 4]),
    ]);
}

/// Beside the others, which take as long.
#[test]
fn degrees_of_the_poincare_algebra_and_of_su4() {
    have_degrees([
        ("poincare", poincare(), &[2, 4]),
        ("su(4)", known::su(4), &[2, 3, 4]),
    ]);
}

/// Reflections in pairs are inner automorphisms, and leave a 64th of the monomials; the Pfaffian changes its sign under a single one.
#[test]
fn large_rotations_have_the_monomials_of_one_sign() {
    for (n, expected) in [(6, [2, 3, 4]), (7, [2, 4, 6])] {
        let found = search(&from_matrices(&known::so(n)), 10 * WORK);
        assert_eq!(degrees(&found), expected, "so({n})");
        assert!(found.complete);
    }
}

#[test]
fn parameters_stay_in_the_coefficients() {
    let k = Fraction::variable(0);
    let one = Fraction::from(lie_symbolic::exact::Rational::ONE);
    let entries = vec![(0, 1, 2, one.clone()), (0, 2, 1, one.neg()), (1, 2, 0, k)];
    let found = search(&StructureConstants::new(3, entries), WORK);
    assert_eq!(shown(&found), ["x0^2*x3 + x1^2 + x2^2"]);
}

#[test]
fn a_small_budget_says_so() {
    let su3 = from_matrices(&known::su(3));
    let found = search(&su3, 1_000);
    assert!(!found.complete && found.casimirs.len() < 2);
}

/// A third element that acts on a plane by a matrix.
fn plane(a: i64, b: i64, c: i64, d: i64) -> StructureConstants<Fraction> {
    let entries = [(0, 1, 1, a), (0, 1, 2, c), (0, 2, 1, b), (0, 2, 2, d)];
    let entries: Vec<known::Entry> = entries.into_iter().filter(|e| e.3 != 0).collect();
    known::constants((3, &entries))
}

#[test]
fn rational_ones_where_no_polynomial_is_one() {
    for (matrix, expected) in [
        // Bianchi V, VI_-9, III
        ([1, 0, 0, 1], "(x1)^1 (x2)^-1"),
        ([2, 0, 0, 1], "(x1)^1 (x2)^-2"),
        ([1, 0, 0, 0], "x2"),
        // VI_h with weights 3 and -2: a polynomial
        ([3, 0, 0, -2], "x1^2*x2^3"),
        // eigenvalues 1 and 3 of a matrix that is not diagonal
        ([2, 1, 1, 2], "(x1 - x2)^3 (x1 + x2)^-1"),
    ] {
        let [a, b, c, d] = matrix;
        let found = search(&plane(a, b, c, d), WORK);
        assert_eq!(
            (shown(&found), found.complete),
            (vec![expected.to_owned()], true)
        );
    }
    // Bianchi IV has a logarithm in it, VII_h an angle, and irrational weights are exponents
    for [a, b, c, d] in [[1, 1, 0, 1], [1, -1, 1, 1], [1, 1, 1, 2]] {
        let found = search(&plane(a, b, c, d), WORK);
        assert_eq!((shown(&found), found.complete), (Vec::new(), true));
    }
}
