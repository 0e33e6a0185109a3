//! Known algebras in their own bases and in others.

use super::*;
use crate::algebra::known::{self, from_matrices, mixed};

fn no_defaults(_: usize) -> Option<Rational> {
    None
}

fn found(constants: &StructureConstants<Fraction>) -> Report {
    of(constants, &no_defaults, &Budget::new(DEEP))
        .unwrap()
        .unwrap()
}

fn name_of(constants: &StructureConstants<Fraction>) -> Result<String, String> {
    found(constants).name
}

/// The same algebra in a basis that a unimodular matrix mixes, numbers from a seed.
fn remixed(constants: &StructureConstants<Fraction>, seed: u64) -> StructureConstants<Fraction> {
    let n = constants.dimension();
    let mut state = seed;
    let mut draw = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        Rational::new((state >> 33) as i64 % 5 - 2, 1 + (state >> 50) as i64 % 3).unwrap()
    };
    let table = at(constants, &|_| Rational::ZERO).unwrap();
    let budget = Budget::new(1 << 40);
    // triangular matrices with ones on their diagonals
    let mut basis: Vec<Vec<Rational>> = (0..n).map(|i| table.unit(i)).collect();
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            let factor = draw();
            let other = basis[j].clone();
            for (entry, value) in basis[i].iter_mut().zip(&other) {
                *entry = &*entry + &(&factor * value);
            }
        }
    }
    let span = lie_symbolic::exact::span::Span::new(&basis, &budget).unwrap();
    let mixed = Table::from_brackets(n, |i, j| {
        let value = table.bracket(&basis[i], &basis[j], &budget)?;
        Ok(span.coordinates(&value, &budget)?.unwrap())
    });
    mixed
        .unwrap()
        .constants()
        .map(|c| Fraction::from(c.clone()))
}

/// The sum of two algebras.
fn plus(
    a: &StructureConstants<Fraction>,
    b: &StructureConstants<Fraction>,
) -> StructureConstants<Fraction> {
    let n = a.dimension();
    let mut entries = a.entries().to_vec();
    entries.extend(
        b.entries()
            .iter()
            .map(|(i, j, k, c)| (i + n, j + n, k + n, c.clone())),
    );
    StructureConstants::new(n + b.dimension(), entries)
}

/// A third element that acts on a plane by a matrix.
fn plane(a: i64, b: i64, c: i64, d: i64) -> StructureConstants<Fraction> {
    let entries = [(0, 1, 1, a), (0, 1, 2, c), (0, 2, 1, b), (0, 2, 2, d)];
    let entries: Vec<known::Entry> = entries.into_iter().filter(|e| e.3 != 0).collect();
    known::constants((3, &entries))
}

/// Matrices of so(p, q) with translations.
fn isometries(signs: &[i64]) -> Vec<known::Integers> {
    let n = signs.len();
    let mut basis = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            let mut e = known::unit(n + 1, j, i);
            e[i][j] = -signs[i] * signs[j];
            basis.push(e);
        }
    }
    basis.extend((0..n).map(|i| known::unit(n + 1, i, n)));
    basis
}

#[test]
fn names_in_any_basis() {
    let so3 = known::constants(known::SO3);
    let sl2 = known::constants(known::SL2);
    let h3 = known::constants(known::H3);
    let aff1 = known::constants(known::AFF1);
    let r = |n| known::constants((n, &[]));
    // a wrong sign in one bracket of so(3)
    let slip = known::constants((3, &[(0, 1, 2, 1), (0, 2, 1, -1), (1, 2, 0, -1)]));
    let so31: Vec<known::Integers> = isometries(&[1, 1, 1, -1])[..6].to_vec();
    let so22: Vec<known::Integers> = isometries(&[1, 1, -1, -1])[..6].to_vec();
    // Q(sqrt 2) in place of Q: so(3) over it is a pair of conjugate ideals over the reals
    let over = |square: i64| {
        let mut entries: Vec<known::Entry> = Vec::new();
        for &(i, j, k, v) in known::SO3.1 {
            entries.extend([
                (i, j, k, v),
                (i, j + 3, k + 3, v),
                (i + 3, j + 3, k, square * v),
            ]);
            entries.push((j, i + 3, k + 3, -v));
        }
        known::constants((6, &entries))
    };
    let cases: Vec<(StructureConstants<Fraction>, &str)> = vec![
        (so3.clone(), "so(3)"),
        (slip, "sl(2,R)"),
        (sl2.clone(), "sl(2,R)"),
        (r(3), "R^3"),
        (h3.clone(), "heisenberg(1)"),
        (aff1.clone(), "aff(1)"),
        (plus(&aff1, &r(1)), "aff(1) + R"),
        (plane(1, 0, 0, 1), "bianchi(V)"),
        (plane(1, 1, 0, 1), "bianchi(IV)"),
        (plane(1, 0, 0, -1), "bianchi(VI, 0)"),
        (plane(0, -1, 1, 0), "se(2)"),
        (plane(2, 0, 0, 1), "bianchi(VI, -9)"),
        (plane(1, -1, 1, 1), "bianchi(VII, 1)"),
        (known::constants(known::SE3), "se(3)"),
        (plus(&so3, &so3), "so(4)"),
        (plus(&so3, &sl2), "sl(2,R) + so(3)"),
        (plus(&sl2, &sl2), "so(2,2)"),
        (plus(&so3, &r(2)), "so(3) + R^2"),
        (plus(&h3, &so3), "heisenberg(1) + so(3)"),
        (plus(&aff1, &aff1), "aff(1)^2"),
        (plus(&plus(&so3, &so3), &so3), "so(3)^3"),
        (over(2), "so(4)"),
        (over(-1), "so(3,1)"),
        (from_matrices(&so31), "so(3,1)"),
        (from_matrices(&so22), "so(2,2)"),
        (from_matrices(&known::so(4)), "so(4)"),
        (from_matrices(&known::su(3)), "su(3)"),
        (from_matrices(&known::gl(2)), "sl(2,R) + R"),
    ];
    for (constants, expected) in cases {
        assert_eq!(name_of(&constants).as_deref(), Ok(expected));
        assert_eq!(
            name_of(&remixed(&constants, 2018)).as_deref(),
            Ok(expected),
            "in another basis"
        );
    }
}

#[test]
fn names_of_larger_algebras() {
    for (matrices, expected) in [
        (known::so(5), "so(5)"),
        (known::sp(2), "sp(4,R)"),
        (isometries(&[-1, 1, 1, 1]), "poincare(3)"),
        (isometries(&[1, 1, 1, 1]), "se(4)"),
    ] {
        assert_eq!(name_of(&from_matrices(&matrices)).as_deref(), Ok(expected));
        assert_eq!(
            name_of(&from_matrices(&mixed(&matrices, 2018))).as_deref(),
            Ok(expected)
        );
    }
}

/// Matrices of rotations, boosts, translations and time: those of isometries, whose last axis the others do not see.
fn galilei(n: usize) -> Vec<known::Integers> {
    let mut basis = isometries(&vec![1; n + 1]);
    basis.iter_mut().for_each(|m| m[n][..n].fill(0));
    basis
}

/// `[N, Q_i] = P_i`, `[N, P_i] = -w_i Q_i`, `[Q_i, P_i] = s_i Z` in the order N, Q, P, Z.
fn oscillator(weights: &[(i64, i64)]) -> StructureConstants<Fraction> {
    let k = weights.len();
    let mut entries = Vec::new();
    for (i, &(weight, sign)) in weights.iter().enumerate() {
        let (q, p) = (1 + i, 1 + k + i);
        entries.extend([(0, q, p, 1), (0, p, q, -weight), (q, p, 2 * k + 1, sign)]);
    }
    known::constants((2 * k + 2, &entries))
}

#[test]
fn names_of_extensions() {
    let affine = |k: usize| {
        let mut basis: Vec<known::Integers> = Vec::new();
        for i in 0..k {
            basis.extend((0..=k).map(|j| known::unit(k + 1, i, j)));
        }
        from_matrices(&basis)
    };
    for (constants, expected) in [
        (affine(2), "aff(2)"),
        (affine(3), "aff(3)"),
        (from_matrices(&galilei(3)), "galilei(3)"),
        (from_matrices(&galilei(4)), "galilei(4)"),
        (oscillator(&[(1, 1)]), "oscillator(1)"),
        (oscillator(&[(4, 1), (4, 9)]), "oscillator(2)"),
    ] {
        assert_eq!(name_of(&constants).as_deref(), Ok(expected));
        let other = remixed(&constants, 2018);
        assert_eq!(name_of(&other).as_deref(), Ok(expected), "in another basis");
    }
    // a hyperbola in place of the circle, two frequencies, a form that is not definite
    for others in [
        oscillator(&[(-1, 1)]),
        oscillator(&[(1, 1), (4, 1)]),
        oscillator(&[(1, 1), (1, -1)]),
    ] {
        assert!(name_of(&others).is_err());
    }
    // boosts that do not commute, in the order of the matrices: 2, 4, 5, with translations 6, 7, 8 and the time 9
    let mut entries = from_matrices(&galilei(3)).entries().to_vec();
    let one = || Fraction::from(Rational::ONE);
    let more = [(2, 4, 8, one()), (4, 5, 6, one()), (2, 5, 7, one().neg())];
    let curved = StructureConstants::new(10, entries.iter().cloned().chain(more).collect());
    assert!(name_of(&curved).is_err());
    // without the brackets of the time
    let time = 9;
    entries.retain(|(i, j, _, _)| *i != time && *j != time);
    let without = StructureConstants::new(10, entries);
    assert_eq!(
        name_of(&without).as_deref(),
        Ok("semidirect(so(3), R^3, R^3) + R")
    );
}

#[test]
fn vectors_and_spinors_are_told_apart() {
    // so(3) with two vectors, and su(2) with a spinor and two invariants
    let mut two = known::SE3.1.to_vec();
    let more = known::SE3.1.iter().filter(|e| e.1 >= 3);
    two.extend(more.map(|&(i, j, k, v)| (i, j + 3, k + 3, v)));
    let two = known::constants((9, &two));
    assert_eq!(name_of(&two).as_deref(), Ok("semidirect(so(3), R^3, R^3)"));
    // quaternions i, j, k acting on quaternions from the left, by halves
    let half = |v: i64| Fraction::from(Rational::new(v, 2).unwrap());
    let units = [
        [(0, 1, 1), (1, 0, -1), (2, 3, 1), (3, 2, -1)],
        [(0, 2, 1), (2, 0, -1), (3, 1, 1), (1, 3, -1)],
        [(0, 3, 1), (3, 0, -1), (1, 2, 1), (2, 1, -1)],
    ];
    let mut entries = known::constants(known::SO3).entries().to_vec();
    for (i, unit) in units.iter().enumerate() {
        entries.extend(
            unit.iter()
                .map(|&(from, to, sign)| (i, from + 3, to + 3, half(sign))),
        );
    }
    let spinor = StructureConstants::new(7, entries);
    let expected = "dim 7, Levi factor so(3), radical abelian of dimension 4";
    assert_eq!(name_of(&spinor), Err(expected.to_owned()));
}

/// Derived series, lower central series, centre, radical, signature, flags.
type Facts = (
    &'static [usize],
    &'static [usize],
    usize,
    usize,
    [usize; 3],
    &'static str,
);

fn facts(report: &Report) -> (Vec<usize>, Vec<usize>, usize, usize, [usize; 3], String) {
    let Report { class, series, .. } = report;
    let flags = [
        (class.abelian, 'a'),
        (class.nilpotent, 'n'),
        (class.solvable, 's'),
        (class.semisimple, 'S'),
        (class.reductive, 'r'),
        (class.unimodular, 'u'),
    ];
    let flags = flags
        .iter()
        .filter(|(holds, _)| *holds)
        .map(|(_, letter)| *letter);
    let killing = series.killing;
    (
        series.derived.clone(),
        series.lower_central.clone(),
        series.centre,
        series.radical,
        [killing.positive, killing.negative, killing.zero],
        flags.collect(),
    )
}

#[track_caller]
fn holds(constants: &StructureConstants<Fraction>, expected: &Facts) {
    let (derived, lower, centre, radical, killing, flags) = *expected;
    let expected = (
        derived.to_vec(),
        lower.to_vec(),
        centre,
        radical,
        killing,
        flags.to_owned(),
    );
    assert_eq!(facts(&found(constants)), expected);
}

#[test]
fn classes_of_small_algebras() {
    holds(
        &known::constants(known::SO3),
        &(&[3], &[3], 0, 0, [0, 3, 0], "Sru"),
    );
    holds(
        &known::constants(known::SL2),
        &(&[3], &[3], 0, 0, [2, 1, 0], "Sru"),
    );
    holds(
        &known::constants(known::SE3),
        &(&[6], &[6], 0, 3, [0, 3, 3], "u"),
    );
    holds(
        &known::constants(known::H3),
        &(&[3, 1, 0], &[3, 1, 0], 1, 3, [0, 0, 3], "nsu"),
    );
    holds(
        &known::constants(known::AFF1),
        &(&[2, 1, 0], &[2, 1], 0, 2, [1, 0, 1], "s"),
    );
    holds(
        &known::constants(known::E2),
        &(&[3, 2, 0], &[3, 2], 0, 3, [0, 1, 2], "su"),
    );
    holds(
        &known::constants((2, &[])),
        &(&[2, 0], &[2, 0], 2, 2, [0, 0, 2], "ansru"),
    );
}

#[test]
fn classes_of_matrix_algebras_in_their_bases_and_in_others() {
    let cases: [(Vec<known::Integers>, Facts); 5] = [
        (known::su(3), (&[8], &[8], 0, 0, [0, 8, 0], "Sru")),
        (known::so(5), (&[10], &[10], 0, 0, [0, 10, 0], "Sru")),
        (known::sp(2), (&[10], &[10], 0, 0, [6, 4, 0], "Sru")),
        (known::gl(3), (&[9, 8], &[9, 8], 1, 1, [5, 3, 1], "ru")),
        (known::se3(), (&[6], &[6], 0, 3, [0, 3, 3], "u")),
    ];
    for (matrices, expected) in cases {
        holds(&from_matrices(&matrices), &expected);
        holds(&from_matrices(&mixed(&matrices, 2018)), &expected);
    }
}

#[test]
fn a_sum_of_many_is_named_part_by_part() {
    let so3 = known::constants(known::SO3);
    let aff1 = known::constants(known::AFF1);
    let mut all = plus(&aff1, &aff1);
    for _ in 0..70 {
        all = plus(&all, &so3);
    }
    let report = of(&all, &no_defaults, &Budget::new(WORK)).unwrap().unwrap();
    assert_eq!(report.name.as_deref(), Ok("aff(1)^2 + so(3)^70"));
    let killing = report.series.killing;
    assert_eq!(
        (killing.positive, killing.negative, killing.zero),
        (2, 210, 2)
    );
    assert_eq!(report.series.derived, [214, 212, 210]);
    assert!(!report.class.reductive && !report.class.unimodular && !report.class.solvable);
}

/// B_n and C_n have the same dimension, and their split forms the same signature.
#[test]
fn orthogonal_and_symplectic_algebras_of_one_dimension() {
    let split: Vec<known::Integers> = isometries(&[1, 1, 1, 1, -1, -1, -1])[..21].to_vec();
    for (matrices, expected) in [
        (known::so(7), "so(7)"),
        (split, "so(4,3)"),
        (known::sp(3), "sp(6,R)"),
        (known::so(9), "so(9)"),
        (known::sp(4), "sp(8,R)"),
    ] {
        let constants = from_matrices(&matrices);
        assert_eq!(name_of(&constants).as_deref(), Ok(expected));
    }
    let constants = remixed(&from_matrices(&known::so(7)), 2018);
    assert_eq!(name_of(&constants).as_deref(), Ok("so(7)"));
}
