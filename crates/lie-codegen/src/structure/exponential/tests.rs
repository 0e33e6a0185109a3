use super::*;

/// i, j and the coefficients of `[e_i, e_j]`.
type Bracket<'a> = (usize, usize, &'a [(usize, i64)]);

/// The algebra with these brackets.
fn algebra(n: usize, brackets: &[Bracket<'_>]) -> StructureConstants<Fraction> {
    let mut entries = Vec::new();
    for (i, j, value) in brackets {
        let (low, high, sign) = if i < j { (*i, *j, 1) } else { (*j, *i, -1) };
        for (k, c) in *value {
            entries.push((low, high, *k, Fraction::from(Rational::from(sign * c))));
        }
    }
    StructureConstants::new(n, entries)
}

/// so(3) acting on so many vectors.
fn rotations_and_vectors(vectors: usize) -> StructureConstants<Fraction> {
    let mut entries = Vec::new();
    let mut add = |i: usize, j: usize, k: usize, c: i64| {
        let (i, j, c) = if i < j { (i, j, c) } else { (j, i, -c) };
        entries.push((i, j, k, Fraction::from(Rational::from(c))));
    };
    for a in 0..3 {
        let (b, c) = ((a + 1) % 3, (a + 2) % 3);
        add(a, b, c, 1);
        for v in (1..=vectors).map(|v| 3 * v) {
            add(a, v + b, v + c, 1);
            add(a, v + c, v + b, -1);
        }
    }
    StructureConstants::new(3 * (vectors + 1), entries)
}

fn so4() -> StructureConstants<Fraction> {
    // E12, E13, E14, E23, E24, E34
    algebra(
        6,
        &[
            (0, 1, &[(3, 1)]),
            (0, 2, &[(4, 1)]),
            (1, 2, &[(5, 1)]),
            (0, 3, &[(1, -1)]),
            (0, 4, &[(2, -1)]),
            (1, 5, &[(2, -1)]),
            (1, 3, &[(0, 1)]),
            (2, 4, &[(0, 1)]),
            (2, 5, &[(1, 1)]),
            (3, 4, &[(5, 1)]),
            (3, 5, &[(4, -1)]),
            (4, 5, &[(3, 1)]),
        ],
    )
}

/// What a closed form is: for each summand the exponent of z, a letter for the other factor, and its exponent.
fn shape(constants: &StructureConstants<Fraction>) -> Option<Vec<(usize, char, usize)>> {
    let form = closed_form(constants)?;
    let shape = form.summands.iter().map(|summand| match &summand.factor {
        Factor::None => (summand.nilpotent, 'n', 0),
        Factor::Linear(_, b) => (summand.nilpotent, 'l', *b),
        Factor::Quadratic(_, b) => (summand.nilpotent, 'q', *b),
    });
    Some(shape.collect())
}

#[test]
fn minimal_polynomials() {
    let heisenberg = algebra(3, &[(0, 1, &[(2, 1)])]);
    assert_eq!(shape(&heisenberg), Some(vec![(2, 'n', 0)]));
    let affine = algebra(2, &[(0, 1, &[(1, 1)])]);
    assert_eq!(shape(&affine), Some(vec![(1, 'l', 1)]));
    assert_eq!(shape(&rotations_and_vectors(0)), Some(vec![(1, 'q', 1)]));
    for vectors in 1..4 {
        let form = shape(&rotations_and_vectors(vectors));
        assert_eq!(form, Some(vec![(1, 'q', 2)]), "{vectors}");
    }
    let plane = algebra(3, &[(0, 1, &[(2, 1)]), (0, 2, &[(1, -1)])]);
    assert_eq!(shape(&plane), Some(vec![(1, 'q', 1)]));
    let sl2 = algebra(
        3,
        &[(0, 1, &[(1, 2)]), (0, 2, &[(2, -2)]), (1, 2, &[(0, 1)])],
    );
    assert_eq!(shape(&sl2), Some(vec![(1, 'q', 1)]));
    assert_eq!(shape(&so4()), Some(vec![(1, 'q', 1), (1, 'q', 1)]));
    // aff(1) twice and a centre, mixed
    let toda = algebra(
        5,
        &[
            (0, 3, &[(3, 1)]),
            (1, 3, &[(3, -1)]),
            (1, 4, &[(4, 1)]),
            (2, 4, &[(4, -1)]),
        ],
    );
    let form = shape(&toda).expect("a closed form");
    let linear = form.iter().filter(|part| **part == (1, 'l', 1));
    assert_eq!(linear.count(), 2, "{form:?}");
}

/// Two roots that are different linear forms, on a plane that does not split.
#[test]
fn other_polynomials_are_left_alone() {
    let scaled = algebra(3, &[(0, 1, &[(1, 1)]), (0, 2, &[(2, 2)])]);
    assert_eq!(shape(&scaled), None);
    let spiral = algebra(3, &[(0, 1, &[(1, 1), (2, 1)]), (0, 2, &[(1, -1), (2, 1)])]);
    assert_eq!(shape(&spiral), None);
}

/// The forms are those of the same algebra in another basis.
#[test]
fn a_change_of_basis_changes_nothing() {
    for (constants, expected) in [
        (rotations_and_vectors(0), (1, 'q', 1)),
        (rotations_and_vectors(1), (1, 'q', 2)),
        (
            algebra(
                3,
                &[(0, 1, &[(1, 2)]), (0, 2, &[(2, -2)]), (1, 2, &[(0, 1)])],
            ),
            (1, 'q', 1),
        ),
        (algebra(2, &[(0, 1, &[(1, 1)])]), (1, 'l', 1)),
    ] {
        for seed in 1..4 {
            let changed = in_another_basis(&constants, seed);
            assert_eq!(shape(&changed), Some(vec![expected]), "{seed}");
        }
    }
}

/// `C'_ab^c = P_a^i P_b^j C_ij^k (P^-1)_k^c` with a random rational P.
fn in_another_basis(
    constants: &StructureConstants<Fraction>,
    seed: i64,
) -> StructureConstants<Fraction> {
    let n = constants.dimension();
    let number = |i: usize, j: usize| {
        let mixed = (seed * 7919 + 31 * i as i64 + 17 * j as i64 * j as i64) % 7 - 3;
        let extra = if i == j { 5 } else { 0 };
        Rational::new(mixed + extra, 1 + (i as i64 + seed) % 3).expect("a number")
    };
    let p: Vec<Vec<Rational>> = (0..n)
        .map(|i| (0..n).map(|j| number(i, j)).collect())
        .collect();
    let mut table = vec![vec![vec![Rational::ZERO; n]; n]; n];
    for (i, j, k, value) in constants.entries() {
        let value = value.as_constant().expect("a number");
        table[*j][*i][*k] = -&value;
        table[*i][*j][*k] = value;
    }
    let budget = Budget::new(10_000_000);
    // rows of the transposed basis solve for the coefficients
    let transposed: Vec<Vec<Rational>> = (0..n)
        .map(|k| (0..n).map(|c| p[c][k].clone()).collect())
        .collect();
    let mut entries = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            let mut bracket = vec![Rational::ZERO; n];
            for i in 0..n {
                for j in 0..n {
                    for (k, entry) in bracket.iter_mut().enumerate() {
                        *entry = &*entry + &(&(&p[a][i] * &p[b][j]) * &table[i][j][k]);
                    }
                }
            }
            let solution = lie_symbolic::exact::matrix::solve(&transposed, &bracket, &budget);
            let solution = solution.expect("within the budget").expect("a basis");
            for (c, value) in solution.into_iter().enumerate() {
                if !value.is_zero() {
                    entries.push((a, b, c, Fraction::from(value)));
                }
            }
        }
    }
    StructureConstants::new(n, entries)
}
