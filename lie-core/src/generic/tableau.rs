//! Gauss collocation coefficients.

use crate::scalar::Scalar;

/// Coefficients of a Runge–Kutta method with a number of stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<S, const STAGES: usize> {
    /// The matrix: `a[i][j]` weighs stage j in stage i.
    pub a: [[S; STAGES]; STAGES],
    /// The weights.
    pub b: [S; STAGES],
    /// The nodes in [0, 1], the row sums of the matrix.
    pub c: [S; STAGES],
}

/// High and low part of a coefficient; the sum is good to 100 bits.
type Parts = (f64, f64);

const A1: [Parts; 1] = [(0.5, 0.0)];
const B1: [Parts; 1] = [(1.0, 0.0)];
const C1: [Parts; 1] = [(0.5, 0.0)];
const A2: [Parts; 4] = [
    (0.25, 0.0),
    (-0.03867513459481288, -2.8473525618637145e-18),
    (0.5386751345948129, 1.6725140369678172e-17),
    (0.25, 0.0),
];
const B2: [Parts; 2] = [(0.5, 0.0), (0.5, 0.0)];
const C2: [Parts; 2] = [
    (0.2113248654051871, 1.1030435245950743e-17),
    (0.7886751345948129, 1.6725140369678172e-17),
];
const A3: [Parts; 9] = [
    (0.1388888888888889, -6.1679056923619804e-18),
    (-0.0359766675249389, -1.7131477166576787e-18),
    (0.009789444015308325, 6.854025647616559e-19),
    (0.30026319498086457, 2.5164098933700036e-17),
    (0.2222222222222222, 1.2335811384723961e-17),
    (-0.022485417203086815, 6.64006153065758e-19),
    (0.26798833376246944, 7.795467762236068e-18),
    (0.48042111196938336, -1.5248592937337767e-17),
    (0.1388888888888889, -6.1679056923619804e-18),
];
const B3: [Parts; 3] = [
    (0.2777777777777778, -1.2335811384723961e-17),
    (0.4444444444444444, 2.4671622769447922e-17),
    (0.2777777777777778, -1.2335811384723961e-17),
];
const C3: [Parts; 3] = [
    (0.11270166537925831, -2.5675694035077516e-19),
    (0.5, 0.0),
    (0.8872983346207417, -1.3621030867463682e-17),
];

/// The matrices by rows, the weights and the nodes, by the number of stages.
const TABLEAUS: [[&[Parts]; 3]; 3] = [[&A1, &B1, &C1], [&A2, &B2, &C2], [&A3, &B3, &C3]];

/// The Gauss–Legendre tableau of a number of stages, of twice that order, correctly rounded.
///
/// Numbers of stages without a tableau here do not compile.
pub fn gauss_tableau<S: Scalar, const STAGES: usize>() -> Tableau<S, STAGES> {
    const {
        assert!(
            STAGES >= 1 && STAGES <= TABLEAUS.len(),
            "there is no Gauss tableau of so many stages"
        )
    };
    let [_, b, c] = TABLEAUS[STAGES - 1];
    Tableau {
        a: core::array::from_fn(|i| core::array::from_fn(|j| gauss_entry(STAGES, i, j))),
        b: core::array::from_fn(|i| number(b[i])),
        c: core::array::from_fn(|i| number(c[i])),
    }
}

/// The entry `a_ij` of the Gauss–Legendre tableau of a number of stages.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_entry<S: Scalar>(stages: usize, i: usize, j: usize) -> S {
    number(TABLEAUS[stages - 1][0][i * stages + j])
}

/// The weight `b_i` of the Gauss–Legendre tableau of a number of stages.
///
/// # Panics
/// If there is no such tableau, or entry.
pub fn gauss_weight<S: Scalar>(stages: usize, i: usize) -> S {
    number(TABLEAUS[stages - 1][1][i])
}

fn number<S: Scalar>((high, low): Parts) -> S {
    S::constant(high, low)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Collocation: `sum_j a_ij c_j^(q-1) = c_i^q/q` for q up to the number of stages, and the
    /// quadrature is exact to degree 2 STAGES - 1.
    fn check<const STAGES: usize>() {
        let tableau = gauss_tableau::<f64, STAGES>();
        for q in 1..=STAGES as i32 {
            for i in 0..STAGES {
                let sum: f64 = (0..STAGES)
                    .map(|j| tableau.a[i][j] * tableau.c[j].powi(q - 1))
                    .sum();
                assert!((sum - tableau.c[i].powi(q) / f64::from(q)).abs() < 2e-16);
            }
        }
        for q in 1..=2 * STAGES as i32 {
            let sum: f64 = (0..STAGES)
                .map(|j| tableau.b[j] * tableau.c[j].powi(q - 1))
                .sum();
            assert!((sum - 1.0 / f64::from(q)).abs() < 2e-16, "degree {}", q - 1);
        }
        let q = 2 * STAGES as i32 + 1;
        let sum: f64 = (0..STAGES)
            .map(|j| tableau.b[j] * tableau.c[j].powi(q - 1))
            .sum();
        assert!(
            (sum - 1.0 / f64::from(q)).abs() > 1e-4,
            "no rule is exact beyond that"
        );
    }

    #[test]
    fn order_conditions() {
        check::<1>();
        check::<2>();
        check::<3>();
    }
}
