//! What can be proven of the linearisation, in rational numbers or in balls of many digits.
//!
//! The tangent space of the leaf is the kernel of the gradients of the Casimirs. On a basis T of it the Hessian of
//! `H - sum_k lambda_k C_k` becomes `A = T^T W T`, and the linearisation `L = Pi W` a matrix M with `L T = T M`. The inertia of A
//! comes from elimination by congruences (Sylvester). The characteristic polynomial of M is even, `det(s - M) = q(s^2)`, and a chain of
//! Sturm counts the negative roots of q: all eigenvalues are imaginary exactly if all roots are real and not positive.

use lie_symbolic::exact::Rational;

use crate::arithmetic::Signed;
use crate::system::{Shape, Sizes};

/// Positive, negative and zero directions of a quadratic form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inertia {
    /// Positive ones.
    pub positive: usize,
    /// Negative ones.
    pub negative: usize,
    /// Those in its kernel.
    pub zero: usize,
}

impl Inertia {
    /// Whether it has one sign but on a kernel of this dimension.
    pub fn is_definite(self, kernel: usize) -> bool {
        self.zero == kernel && (self.positive == 0 || self.negative == 0)
    }
}

/// What the eigenvalues of the linearisation on the leaf are known to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// One has a positive real part.
    Right,
    /// All are imaginary; different from each other and from zero, or not.
    Imaginary {
        /// Whether they are.
        simple: bool,
    },
}

/// What is certain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Facts {
    /// The inertia of A.
    pub inertia: Option<Inertia>,
    /// The spectrum.
    pub axis: Option<Axis>,
}

/// What is certain of a shape.
pub fn facts<A: Signed>(a: &A, sizes: Sizes, shape: &Shape<A::Number>) -> Facts {
    let Some(tangent) = Tangent::new(a, sizes.n, &shape.gradients) else {
        return Facts::default();
    };
    let inertia = inertia(a, tangent.form(a, &shape.hessian));
    let axis = tangent
        .motion(a, &shape.bracket, &shape.hessian)
        .and_then(|m| axis(a, &m));
    // an odd number of negative directions makes the determinant of L negative
    let odd = inertia.is_some_and(|found| found.zero == 0 && found.negative % 2 == 1);
    Facts {
        inertia,
        axis: if odd { Some(Axis::Right) } else { axis },
    }
}

/// A basis of the kernel of some rows: vectors that are 1 at one free place each, and 0 at the others.
pub struct Tangent<N> {
    free: Vec<usize>,
    basis: Vec<Vec<N>>,
}

impl<N: Clone> Tangent<N> {
    /// The kernel of rows of length n; `None` where a pivot is not certain, or rows depend on each other.
    pub fn new<A: Signed<Number = N>>(a: &A, n: usize, rows: &[N]) -> Option<Self> {
        let mut rows: Vec<Vec<N>> = rows.chunks(n).map(<[N]>::to_vec).collect();
        let mut pivots: Vec<usize> = Vec::new();
        for r in 0..rows.len() {
            let certain = |j: &usize| {
                !pivots.contains(j) && a.sign(&rows[r][*j]).is_some_and(|sign| sign != 0)
            };
            let size = |j: &usize| a.size(&rows[r][*j]);
            let best = (0..n)
                .filter(certain)
                .max_by(|i, j| size(i).total_cmp(&size(j)))?;
            let pivot = rows[r][best].clone();
            let row: Option<Vec<N>> = rows[r].iter().map(|x| a.div(x, &pivot)).collect();
            let mut row = row?;
            row[best] = a.rational(&Rational::ONE);
            for (other, of) in rows.iter_mut().enumerate() {
                if other != r {
                    let factor = of[best].clone();
                    for (x, y) in of.iter_mut().zip(&row) {
                        *x = a.sub(x, &a.mul(&factor, y));
                    }
                    of[best] = a.rational(&Rational::ZERO);
                }
            }
            rows[r] = row;
            pivots.push(best);
        }
        let free: Vec<usize> = (0..n).filter(|j| !pivots.contains(j)).collect();
        let zero = a.rational(&Rational::ZERO);
        let vector = |f: &usize| {
            let mut vector = vec![zero.clone(); n];
            vector[*f] = a.rational(&Rational::ONE);
            for (row, pivot) in rows.iter().zip(&pivots) {
                vector[*pivot] = a.sub(&zero, &row[*f]);
            }
            vector
        };
        Some(Self {
            basis: free.iter().map(vector).collect(),
            free,
        })
    }

    /// `T^T W T` by rows.
    pub fn form<A: Signed<Number = N>>(&self, a: &A, w: &[N]) -> Vec<Vec<N>> {
        let images: Vec<Vec<N>> = self.basis.iter().map(|v| times(a, w, v)).collect();
        let row = |u: &Vec<N>| images.iter().map(|image| dot(a, u, image)).collect();
        self.basis.iter().map(row).collect()
    }

    /// The matrix M with `Pi W T = T M`.
    fn motion<A: Signed<Number = N>>(&self, a: &A, bracket: &[N], w: &[N]) -> Option<Vec<Vec<N>>> {
        let image = |v: &Vec<N>| times(a, bracket, &times(a, w, v));
        let images: Vec<Vec<N>> = self.basis.iter().map(image).collect();
        let row = |f: &usize| images.iter().map(|image| image[*f].clone()).collect();
        Some(self.free.iter().map(row).collect())
    }
}

fn dot<A: Signed>(a: &A, u: &[A::Number], v: &[A::Number]) -> A::Number {
    let terms = u.iter().zip(v);
    terms.fold(a.rational(&Rational::ZERO), |sum, (x, y)| {
        a.add(&sum, &a.mul(x, y))
    })
}

fn times<A: Signed>(a: &A, matrix: &[A::Number], v: &[A::Number]) -> Vec<A::Number> {
    matrix.chunks(v.len()).map(|row| dot(a, row, v)).collect()
}

/// The inertia of a symmetric matrix; `None` where a sign is open.
pub fn inertia<A: Signed>(a: &A, mut m: Vec<Vec<A::Number>>) -> Option<Inertia> {
    let mut found = Inertia {
        positive: 0,
        negative: 0,
        zero: 0,
    };
    while !m.is_empty() {
        let size = m.len();
        let certain = |x: &A::Number| a.sign(x).is_some_and(|sign| sign != 0);
        let diagonal = (0..size)
            .filter(|i| certain(&m[*i][*i]))
            .max_by(|i, j| a.size(&m[*i][*i]).total_cmp(&a.size(&m[*j][*j])));
        if let Some(k) = diagonal {
            match a.sign(&m[k][k])? {
                1 => found.positive += 1,
                _ => found.negative += 1,
            }
            m = without(a, &m, k)?;
            continue;
        }
        // no diagonal entry is certain to differ from zero: all must be zero, and two of them may make a hyperbolic plane
        let all_zero = (0..size).all(|i| a.sign(&m[i][i]) == Some(0));
        if !all_zero {
            return None;
        }
        let pairs = (0..size).flat_map(|i| (i + 1..size).map(move |j| (i, j)));
        let mut pairs = pairs.filter(|(i, j)| a.sign(&m[*i][*j]) != Some(0));
        let Some((i, j)) = pairs.next() else {
            found.zero += size;
            return Some(found);
        };
        // with u, v for the pair: u + v and u - v instead, whose squares are 2 m_ij and -2 m_ij
        let rows = m[i].iter().zip(&m[j]);
        let turned = rows.map(|(x, y)| (a.add(x, y), a.sub(x, y)));
        (m[i], m[j]) = turned.unzip();
        for row in &mut m {
            let (x, y) = (row[i].clone(), row[j].clone());
            (row[i], row[j]) = (a.add(&x, &y), a.sub(&x, &y));
        }
    }
    Some(found)
}

/// The Schur complement of a diagonal entry.
fn without<A: Signed>(a: &A, m: &[Vec<A::Number>], k: usize) -> Option<Vec<Vec<A::Number>>> {
    let others = (0..m.len()).filter(|i| *i != k);
    let row = |i: usize| {
        let factor = a.div(&m[i][k], &m[k][k])?;
        let entries = (0..m.len()).filter(|j| *j != k);
        let entry = |j: usize| a.sub(&m[i][j], &a.mul(&factor, &m[k][j]));
        Some(entries.map(entry).collect())
    };
    others.map(row).collect()
}

/// Where the eigenvalues of M are, whose characteristic polynomial is even.
fn axis<A: Signed>(a: &A, m: &[Vec<A::Number>]) -> Option<Axis> {
    let all = characteristic(a, m)?;
    // det(s - M) = q(s^2): from the constant term up
    let even = all.into_iter().step_by(2).collect::<Vec<_>>();
    let zeros = even.iter().take_while(|c| a.sign(c) == Some(0)).count();
    let q: Vec<A::Number> = even[zeros..].to_vec();
    if q.len() <= 1 {
        return Some(Axis::Imaginary { simple: zeros == 0 });
    }
    let (negative, distinct) = negative_roots(a, &q)?;
    Some(match negative == distinct {
        true => Axis::Imaginary {
            simple: zeros == 0 && distinct + 1 == q.len(),
        },
        false => Axis::Right,
    })
}

/// The coefficients of the characteristic polynomial, the constant one first (Faddeev and Le Verrier).
pub fn characteristic<A: Signed>(a: &A, m: &[Vec<A::Number>]) -> Option<Vec<A::Number>> {
    let n = m.len();
    let zero = a.rational(&Rational::ZERO);
    let mut coefficients = vec![a.rational(&Rational::ONE)];
    let mut power: Vec<Vec<A::Number>> = vec![vec![zero.clone(); n]; n];
    for k in 1..=n {
        let last = coefficients.last()?.clone();
        for (i, row) in power.iter_mut().enumerate() {
            row[i] = a.add(&row[i], &last);
        }
        let column = |j: usize| power.iter().map(|row| row[j].clone()).collect::<Vec<_>>();
        let columns: Vec<Vec<A::Number>> = (0..n).map(column).collect();
        let row = |of: &Vec<A::Number>| columns.iter().map(|c| dot(a, of, c)).collect();
        power = m.iter().map(row).collect();
        let trace = (0..n).fold(zero.clone(), |sum, i| a.add(&sum, &power[i][i]));
        let part = a.rational(&Rational::new(-1, i64::try_from(k).ok()?)?);
        coefficients.push(a.mul(&trace, &part));
    }
    coefficients.reverse();
    Some(coefficients)
}

/// The numbers of different negative roots and of different roots of a polynomial, whose constant term is not zero.
fn negative_roots<A: Signed>(a: &A, q: &[A::Number]) -> Option<(usize, usize)> {
    let derivative = q.iter().enumerate().skip(1);
    let derivative = derivative.map(|(k, c)| a.mul(c, &a.rational(&Rational::from(k as i64))));
    let mut chain = vec![q.to_vec(), derivative.collect::<Vec<_>>()];
    loop {
        let [.., p, d] = chain.as_slice() else {
            return None;
        };
        let mut rest = p.clone();
        while rest.len() >= d.len() {
            let factor = a.div(rest.last()?, d.last()?)?;
            let shift = rest.len() - d.len();
            rest.pop();
            for (k, c) in d[..d.len() - 1].iter().enumerate() {
                rest[shift + k] = a.sub(&rest[shift + k], &a.mul(&factor, c));
            }
        }
        while rest.last().is_some_and(|c| a.sign(c) == Some(0)) {
            rest.pop();
        }
        if rest.is_empty() {
            break;
        }
        a.sign(rest.last()?)?;
        let zero = a.rational(&Rational::ZERO);
        chain.push(rest.iter().map(|c| a.sub(&zero, c)).collect());
        if rest.len() == 1 {
            break;
        }
    }
    let distinct = q.len() - chain.last()?.len();
    let changes = |signs: Option<Vec<i32>>| {
        let signs: Vec<i32> = signs?.into_iter().filter(|sign| *sign != 0).collect();
        Some(signs.windows(2).filter(|pair| pair[0] != pair[1]).count())
    };
    let at_zero = chain.iter().map(|p| a.sign(&p[0])).collect();
    let far = chain.iter().map(|p| {
        let sign = a.sign(p.last()?)?;
        Some(if p.len() % 2 == 0 { -sign } else { sign })
    });
    let far = changes(far.collect())?;
    Some((far.checked_sub(changes(at_zero)?)?, distinct))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{Arithmetic as _, Balls, Rationals};
    use lie_symbolic::exact::Precision;

    fn rows(m: &[&[i64]]) -> Vec<Vec<Rational>> {
        m.iter()
            .map(|row| row.iter().map(|x| Rational::from(*x)).collect())
            .collect()
    }

    fn counts(m: &[&[i64]]) -> Inertia {
        inertia(&Rationals, rows(m)).expect("rational numbers have signs")
    }

    #[test]
    fn inertia_by_congruences() {
        let of = |positive, negative, zero| Inertia {
            positive,
            negative,
            zero,
        };
        assert_eq!(counts(&[&[0, 1], &[1, 0]]), of(1, 1, 0));
        assert_eq!(counts(&[&[1, 2], &[2, 4]]), of(1, 0, 1));
        assert_eq!(counts(&[&[-2, 1], &[1, -2]]), of(0, 2, 0));
        assert_eq!(counts(&[&[0, 0, 1], &[0, 5, 0], &[1, 0, 0]]), of(2, 1, 0));
    }

    #[test]
    fn roots_are_counted() {
        let of = |q: &[i64]| {
            let q: Vec<Rational> = q.iter().map(|c| Rational::from(*c)).collect();
            negative_roots(&Rationals, &q)
        };
        // (s + 1)(s + 2), (s + 1)^2, s^2 + 1, (s + 1)(s - 1)
        assert_eq!(of(&[2, 3, 1]), Some((2, 2)));
        assert_eq!(of(&[1, 2, 1]), Some((1, 1)));
        assert_eq!(of(&[1, 0, 1]), Some((0, 2)));
        assert_eq!(of(&[-1, 0, 1]), Some((1, 2)));
        // (s + 1)^2 (s^2 + s + 1): three different roots, one of them negative
        assert_eq!(of(&[1, 3, 4, 3, 1]), Some((1, 3)));
    }

    #[test]
    fn an_open_sign_is_no_answer() {
        let balls = Balls(Precision::new(64));
        let wide = balls.around_zero(-20);
        assert!(inertia(&balls, vec![vec![wide.clone()]]).is_none());
        let two = balls.rational(&Rational::from(2));
        let near = balls.add(&two, &wide);
        let found = inertia(&balls, vec![vec![near]]).expect("all members are positive");
        assert_eq!(found.positive, 1);
        assert!(wide.magnitude() <= -19, "{}", wide.magnitude());
    }
}
