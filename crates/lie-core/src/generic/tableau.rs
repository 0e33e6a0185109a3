//! Gauss collocation coefficients, computed by the compiler in pairs of f64.
//!
//! The nodes are the roots of the Legendre polynomial `P_s`, moved to [0, 1]: `c = (1 + x)/2`. With the weights b,
//!
//! ```math
//! a_{ij} = b_j \Bigl(c_i + \tfrac12 \sum_{k=1}^{s-1} P_k(x_j) \bigl(P_{k+1}(x_i) - P_{k-1}(x_i)\bigr)\Bigr)
//! ```
//!
//! which integrates the interpolation polynomial in its Legendre form (Hairer, Wanner, "Solving Ordinary Differential
//! Equations II", 2nd edition, Springer 1996, section IV.5,
//! [doi:10.1007/978-3-642-05221-7](https://doi.org/10.1007/978-3-642-05221-7)); nothing cancels.
//!
//! Steps take the ratios `$\mu_{ij} = a_{ij}/b_j$` in place of the entries:
//!
//! ```math
//! L_i = h b_i f(Y_i), \qquad Y_i = y + \sum_j \mu_{ij} L_j, \qquad y_1 = y + \sum_i L_i
//! ```
//!
//! A quadratic invariant is kept where `$b_i a_{ij} + b_j a_{ji} = b_i b_j$`, which is `$\mu_{ij} + \mu_{ji} = 1$`. The first holds of
//! rounded coefficients up to 2e-17, the same in every step, and the invariant drifts in proportion to time. The second holds
//! of rounded ratios exactly, for any rounding of the `$h b_i$`: those below the diagonal lie between 1/2 and 2, so that the
//! differences from 1 have no rounding error (M. Antoñana, J. Makazaga, A. Murua, "Reducing and monitoring round-off error
//! propagation for symplectic implicit Runge–Kutta schemes", Numerical Algorithms 76 (2017) 861–880,
//! [doi:10.1007/s11075-017-0287-z](https://doi.org/10.1007/s11075-017-0287-z)).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use core::cmp::Ordering;

use super::pair::Pair;
use crate::scalar::Scalar;

/// Coefficients of a Runge–Kutta method with a number of stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<S, const STAGES: usize> {
    /// The matrix `a_ij/b_j`: `ratios[i][j]` weighs the increment `h b_j f(Y_j)` in stage i.
    pub ratios: [[S; STAGES]; STAGES],
    /// The weights.
    pub b: [S; STAGES],
    /// The nodes in [0, 1].
    pub c: [S; STAGES],
}

/// The most stages that a Gauss method may have.
pub const MOST_STAGES: usize = 8;

/// What the steps of a Gauss method are made of, in as many rows and columns as it has stages.
#[derive(Clone, Copy)]
struct Table {
    /// `a_ij/b_j`
    ratios: [[Pair; MOST_STAGES]; MOST_STAGES],
    b: [Pair; MOST_STAGES],
    c: [Pair; MOST_STAGES],
    /// The polynomial through values at the nodes of one step, at the nodes of the next: `L_j(1 + c_i)`, for values times
    /// their weights: `b_i L_j(1 + c_i)/b_j`.
    ahead: [[Pair; MOST_STAGES]; MOST_STAGES],
    /// `(2k + 1) P_k(x_j)` in row k.
    legendre: [[Pair; MOST_STAGES]; MOST_STAGES],
}

/// The tables by the number of stages, from one.
static TABLES: [Table; MOST_STAGES] = {
    let mut tables = [Table::EMPTY; MOST_STAGES];
    let mut roots = [Pair::ZERO; MOST_STAGES];
    let mut stages = 1;
    while stages <= MOST_STAGES {
        roots = legendre_roots(stages, &roots);
        tables[stages - 1] = Table::gauss(stages, &roots);
        stages += 1;
    }
    tables
};

impl Table {
    const EMPTY: Self = Self {
        ratios: [[Pair::ZERO; MOST_STAGES]; MOST_STAGES],
        b: [Pair::ZERO; MOST_STAGES],
        c: [Pair::ZERO; MOST_STAGES],
        ahead: [[Pair::ZERO; MOST_STAGES]; MOST_STAGES],
        legendre: [[Pair::ZERO; MOST_STAGES]; MOST_STAGES],
    };

    const fn gauss(stages: usize, roots: &[Pair; MOST_STAGES]) -> Self {
        let mut table = Self::EMPTY;
        let mut j = 0;
        while j < stages {
            // b = 1/((1 - x^2) P_s'(x)^2), c = (1 + x)/2
            let slope = legendre_slope(stages, roots[j]);
            let square = Pair::ONE.sub(roots[j].times(roots[j]));
            table.b[j] = Pair::ONE.divided_by(square.times(slope).times(slope));
            table.c[j] = Pair::ONE.plus(roots[j]).scaled(0.5);
            j += 1;
        }
        let mut i = 0;
        while i < stages {
            let here = legendre(roots[i]);
            let next = legendre(roots[i].plus(Pair::new(2.0)));
            let mut j = 0;
            while j < stages {
                let there = legendre(roots[j]);
                let (mut integral, mut value) = (table.c[i], Pair::ONE);
                table.legendre[0][j] = Pair::ONE;
                let mut k = 1;
                while k < stages {
                    let slope = here[k + 1].sub(here[k - 1]).scaled(0.5);
                    integral = integral.plus(there[k].times(slope));
                    table.legendre[k][j] = there[k].times(Pair::new((2 * k + 1) as f64));
                    value = value.plus(table.legendre[k][j].times(next[k]));
                    k += 1;
                }
                table.ratios[i][j] = integral;
                table.ahead[i][j] = table.b[i].times(value);
                j += 1;
            }
            i += 1;
        }
        table
    }
}

/// `P_0(x)` to `P_8(x)`, by `k P_k = (2k - 1) x P_(k-1) - (k - 1) P_(k-2)`.
const fn legendre(x: Pair) -> [Pair; MOST_STAGES + 1] {
    let mut values = [Pair::ONE; MOST_STAGES + 1];
    values[1] = x;
    let mut k = 2;
    while k <= MOST_STAGES {
        let first = x.times(values[k - 1]).times(Pair::new((2 * k - 1) as f64));
        let second = values[k - 2].times(Pair::new((k - 1) as f64));
        values[k] = first.sub(second).divided_by(Pair::new(k as f64));
        k += 1;
    }
    values
}

/// `P_s'(x) = s (x P_s - P_(s-1))/(x^2 - 1)`
const fn legendre_slope(stages: usize, x: Pair) -> Pair {
    let values = legendre(x);
    let top = x.times(values[stages]).sub(values[stages - 1]);
    let top = top.times(Pair::new(stages as f64));
    top.divided_by(x.times(x).sub(Pair::ONE))
}

/// The roots of `P_s`, ascending, from those of `P_(s-1)`, between which and the ends of the interval they lie.
const fn legendre_roots(stages: usize, between: &[Pair; MOST_STAGES]) -> [Pair; MOST_STAGES] {
    let mut roots = [Pair::ZERO; MOST_STAGES];
    let mut index = 0;
    while index < stages {
        let first = index == 0;
        let last = index + 1 == stages;
        let low = if first { -1.0 } else { between[index - 1].high };
        let high = if last { 1.0 } else { between[index].high };
        let mut root = Pair::new(0.5 * (low + high));
        let mut newton = 0;
        while newton < 8 {
            let update = legendre(root)[stages].divided_by(legendre_slope(stages, root));
            root = root.sub(update);
            newton += 1;
        }
        roots[index] = root;
        index += 1;
    }
    roots
}

fn table(stages: usize) -> &'static Table {
    assert!(
        (1..=MOST_STAGES).contains(&stages),
        "there is no Gauss tableau of so many stages"
    );
    &TABLES[stages - 1]
}

/// The Gauss–Legendre tableau of a number of stages, of twice that order, with [`gauss_ratio`] for its ratios and the rest
/// correctly rounded.
///
/// Numbers of stages above [`MOST_STAGES`] do not compile.
pub fn gauss_tableau<S: Scalar, const STAGES: usize>() -> Tableau<S, STAGES> {
    const { assert!(STAGES >= 1 && STAGES <= MOST_STAGES) };
    Tableau {
        ratios: core::array::from_fn(|i| core::array::from_fn(|j| gauss_ratio(STAGES, i, j))),
        b: core::array::from_fn(|i| gauss_weight(STAGES, i)),
        c: core::array::from_fn(|i| table(STAGES).c[i].number()),
    }
}

/// The ratio `a_ij/b_j` of the Gauss–Legendre tableau of a number of stages: correctly rounded below the diagonal, 1/2 on it, and
/// above it what is missing to 1 from the ratio opposite.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_ratio<S: Scalar>(stages: usize, i: usize, j: usize) -> S {
    assert!(i < stages && j < stages, "there is no such entry");
    match i.cmp(&j) {
        Ordering::Less => S::one() - gauss_ratio(stages, j, i),
        Ordering::Equal => S::ratio(1.0, 2.0),
        Ordering::Greater => table(stages).ratios[i][j].number(),
    }
}

/// The weight `b_i` of the Gauss–Legendre tableau of a number of stages.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_weight<S: Scalar>(stages: usize, i: usize) -> S {
    assert!(i < stages, "there is no such weight");
    table(stages).b[i].number()
}

/// The entry `a_ij`, correctly rounded, for controls.
#[cfg(test)]
pub(super) fn gauss_entry<S: Scalar>(stages: usize, i: usize, j: usize) -> S {
    let Table { ratios, b, .. } = table(stages);
    ratios[i][j].times(b[j]).number()
}

/// What value j at a node counts in the polynomial through all of them, at node i of the step that follows, each value times
/// the weight of its node.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_ahead<S: Scalar>(stages: usize, i: usize, j: usize) -> S {
    assert!(i < stages && j < stages, "there is no such entry");
    table(stages).ahead[i][j].number()
}

/// What an increment `h b_j f(Y_j)` counts in coefficient k of the slopes in Legendre polynomials: `(2k + 1) P_k(x_j)`.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_legendre<S: Scalar>(stages: usize, k: usize, j: usize) -> S {
    assert!(k < stages && j < stages, "there is no such entry");
    table(stages).legendre[k][j].number()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sum of products of pairs that should be a number, in pairs.
    fn error(terms: impl Iterator<Item = Pair>, expected: Pair) -> f64 {
        let sum = terms.fold(Pair::ZERO, |sum, term| sum.plus(term));
        sum.sub(expected).high.abs()
    }

    fn power(x: Pair, exponent: usize) -> Pair {
        (0..exponent).fold(Pair::ONE, |value, _| value.times(x))
    }

    fn reciprocal(q: usize) -> Pair {
        Pair::ONE.divided_by(Pair::new(q as f64))
    }

    /// The simplifying assumptions B(2s), C(s) and D(s) of Butcher, to 100 bits, and the control B(2s + 1).
    #[test]
    fn order_conditions() {
        for stages in 1..=MOST_STAGES {
            let Table { ratios, b, c, .. } = &TABLES[stages - 1];
            let a = |i: usize, j: usize| ratios[i][j].times(b[j]);
            let all = || 0..stages;
            let weights = |q| all().map(move |j| b[j].times(power(c[j], q - 1)));
            for q in 1..=2 * stages {
                let off = error(weights(q), reciprocal(q));
                assert!(off < 1e-30, "B({q}) of {stages} stages is off by {off:e}");
            }
            let q = 2 * stages + 1;
            assert!(
                error(weights(q), reciprocal(q)) > 1e-12,
                "no rule is exact beyond"
            );
            for (q, i) in (1..=stages).flat_map(|q| all().map(move |i| (q, i))) {
                let terms = all().map(|j| a(i, j).times(power(c[j], q - 1)));
                let off = error(terms, power(c[i], q).times(reciprocal(q)));
                assert!(off < 1e-30, "C({q}) of {stages} stages is off by {off:e}");
                let terms = all().map(|j| b[j].times(power(c[j], q - 1)).times(a(j, i)));
                let rest = Pair::ONE.sub(power(c[i], q));
                let off = error(terms, b[i].times(rest).times(reciprocal(q)));
                assert!(off < 1e-30, "D({q}) of {stages} stages is off by {off:e}");
            }
        }
    }

    /// The polynomial of a step is continued exactly: `sum_j b_i L_j(1 + c_i)/b_j b_j c_j^q = b_i (1 + c_i)^q` for q < s.
    #[test]
    fn the_polynomial_of_a_step_goes_on() {
        for stages in 1..=MOST_STAGES {
            let Table { b, c, ahead, .. } = &TABLES[stages - 1];
            for q in 0..stages {
                for i in 0..stages {
                    let there = b[i].times(power(Pair::ONE.plus(c[i]), q));
                    let value = |j: usize| b[j].times(power(c[j], q));
                    let terms = (0..stages).map(|j| ahead[i][j].times(value(j)));
                    // the entries reach 1e5 with eight stages
                    assert!(error(terms, there) < 1e-24, "{stages} stages, degree {q}");
                }
            }
        }
    }

    /// `sum_j b_j (2k + 1) P_k(x_j) P_l(x_j)` is 1 for k = l and 0 for other degrees that the rule integrates.
    #[test]
    fn coefficients_in_legendre_polynomials_are_those_of_the_interpolation() {
        for stages in 1..=MOST_STAGES {
            let Table { b, legendre, .. } = &TABLES[stages - 1];
            for (k, l) in (0..stages).flat_map(|k| (0..stages).map(move |l| (k, l))) {
                let norm = reciprocal(2 * l + 1);
                let terms = (0..stages)
                    .map(|j| b[j].times(legendre[k][j]).times(legendre[l][j]).times(norm));
                let expected = if k == l { Pair::ONE } else { Pair::ZERO };
                assert!(error(terms, expected) < 1e-29, "{stages} stages: {k}, {l}");
            }
        }
    }

    /// The classical coefficients of three stages.
    #[test]
    fn three_stages_are_kuntzmanns() {
        let tableau = gauss_tableau::<f64, 3>();
        let root = 15.0_f64.sqrt();
        let a = |i: usize, j: usize| tableau.ratios[i][j] * tableau.b[j];
        assert!((a(0, 1) - (2.0 / 9.0 - root / 15.0)).abs() < 1e-16);
        assert!((a(2, 0) - (5.0 / 36.0 + root / 30.0)).abs() < 2e-16);
        assert_eq!(tableau.b, [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0]);
        assert!((tableau.c[2] - (0.5 + root / 10.0)).abs() < 2e-16);
    }

    /// `mu_ij + mu_ji = 1` and `mu_ii = 1/2`, bit for bit, in every precision; no ratio is further from its value than rounding
    /// takes it. The control: rounded entries and weights leave the same condition, times `b_i b_j`, at more than 3e-18.
    #[test]
    fn quadratic_invariants_are_in_the_table() {
        fn holds<S: Scalar>(stages: usize) {
            for (i, j) in (0..stages).flat_map(|i| (0..stages).map(move |j| (i, j))) {
                let (one, other) = (
                    gauss_ratio::<S>(stages, i, j),
                    gauss_ratio::<S>(stages, j, i),
                );
                assert!((one + other).to_f64() == 1.0, "{stages} stages: {i}, {j}");
                assert!(i != j || one.to_f64() == 0.5);
            }
        }
        for stages in 1..=MOST_STAGES {
            holds::<f64>(stages);
            holds::<f32>(stages);
            let Table { ratios, b, .. } = &TABLES[stages - 1];
            let entry = |i: usize, j: usize| ratios[i][j].times(b[j]).high;
            let mut defect = 0.0_f64;
            for (i, j) in (0..stages).flat_map(|i| (0..stages).map(move |j| (i, j))) {
                let rounded = Pair::new(gauss_ratio::<f64>(stages, i, j));
                let off = rounded.sub(ratios[i][j]).high.abs();
                assert!(off < 1.2e-16, "{stages} stages: {i}, {j}: {off:e}");
                let product = |x: f64, y: f64| Pair::new(x).times(Pair::new(y));
                let sum = product(b[i].high, entry(i, j)).plus(product(b[j].high, entry(j, i)));
                defect = defect.max(sum.sub(product(b[i].high, b[j].high)).high.abs());
            }
            println!("{stages} stages: entries leave {defect:e}");
            assert!(stages == 1 || defect > 3e-18, "{stages} stages: {defect:e}");
        }
    }
}
