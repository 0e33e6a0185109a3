//! The spline through the points of a table, in exact arithmetic.
//!
//! Of degree d = 2m - 1 it is a polynomial between the knots `x_m, …, x_(n-m)` of the points `x_0, …, x_n`, and all its
//! derivatives but that of order d are continuous there. The points next to the ends are no knots ("not-a-knot"), so that
//! polynomials of degree d are met exactly (de Boor, "A Practical Guide to Splines", 1978, chapter XIII).
//!
//! Each coefficient is an affine function of m - 1 numbers: the first piece is any polynomial through its m + 1 points, the
//! next ones follow, and what is left of the last piece are m - 1 equations for these numbers.

use lie_symbolic::exact::Rational;

/// A constant, and the factors of the numbers that are not known yet.
type Affine = Vec<Rational>;

/// A polynomial in `x - center`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    /// Where its coefficients are derivatives, and where it begins.
    pub center: Rational,
    /// The coefficients, from that of order 0 on.
    pub coefficients: Vec<Rational>,
}

impl Piece {
    /// The value, and the derivative, at a place.
    pub fn value_and_slope(&self, x: &Rational) -> [Rational; 2] {
        let t = x - &self.center;
        let zero = [Rational::ZERO, Rational::ZERO];
        let terms = self.coefficients.iter().rev();
        terms.fold(zero, |[value, slope], c| {
            [&(&value * &t) + c, &(&slope * &t) + &value]
        })
    }
}

/// The pieces of the spline of an odd degree through points whose places ascend, of which there are more than the degree says.
/// `None` where the equations have no solution.
pub(super) fn spline(points: &[(Rational, Rational)], degree: usize) -> Option<Vec<Piece>> {
    let m = degree.div_ceil(2);
    let last = points.len() - 1;
    if last < 2 * m {
        let whole = through(points, degree, 0);
        return resolved(vec![(points[0].0.clone(), whole)], &[]);
    }
    let mut pieces = vec![(points[0].0.clone(), through(&points[..=m], degree, m - 1))];
    for knot in m..=last - m {
        let (center, before) = &pieces[pieces.len() - 1];
        let place = points[knot].0.clone();
        let mut next = shifted(before, &(&place - center));
        next[degree] = vec![Rational::ZERO; m];
        let rest = residual(&next, &place, &points[knot + 1]);
        let h = &points[knot + 1].0 - &place;
        let power = h.pow(i32::try_from(degree).ok()?)?;
        next[degree] = rest.iter().map(|r| &(-r) / &power).collect();
        pieces.push((place, next));
    }
    let (center, end) = &pieces[pieces.len() - 1];
    let left = &points[last - m + 2..];
    let equations: Vec<Affine> = left.iter().map(|p| residual(end, center, p)).collect();
    let known = solve(equations)?;
    resolved(pieces, &known)
}

/// The polynomial through points by divided differences, in `x - x_0`, and what vanishes at all of them.
fn through(points: &[(Rational, Rational)], degree: usize, free: usize) -> Vec<Affine> {
    let mut all = vec![vec![Rational::ZERO; free + 1]; degree + 1];
    let mut product = vec![Rational::ONE];
    let mut differences: Vec<Rational> = points.iter().map(|(_, y)| y.clone()).collect();
    for (k, (x, _)) in points.iter().enumerate() {
        for (coefficient, factor) in all.iter_mut().zip(&product) {
            coefficient[0] = &coefficient[0] + &(&differences[0] * factor);
        }
        for i in 0..points.len() - k - 1 {
            let width = &points[i + k + 1].0 - &points[i].0;
            differences[i] = &(&differences[i + 1] - &differences[i]) / &width;
        }
        let shift = x - &points[0].0;
        product.push(Rational::ZERO);
        for i in (0..product.len()).rev() {
            let below = if i == 0 {
                Rational::ZERO
            } else {
                product[i - 1].clone()
            };
            product[i] = &below - &(&product[i] * &shift);
        }
    }
    for number in 0..free {
        for (coefficient, factor) in all[number..].iter_mut().zip(&product) {
            coefficient[number + 1] = factor.clone();
        }
    }
    all
}

/// The coefficients in `x - (center + h)`.
fn shifted(coefficients: &[Affine], h: &Rational) -> Vec<Affine> {
    let mut shifted = coefficients.to_vec();
    let count = shifted.len();
    for first in 0..count {
        for i in (first..count - 1).rev() {
            for part in 0..shifted[i].len() {
                shifted[i][part] = &shifted[i][part] + &(&shifted[i + 1][part] * h);
            }
        }
    }
    shifted
}

/// What a polynomial differs from a point by.
fn residual(coefficients: &[Affine], center: &Rational, (x, y): &(Rational, Rational)) -> Affine {
    let t = x - center;
    let mut value = vec![Rational::ZERO; coefficients[0].len()];
    for coefficient in coefficients.iter().rev() {
        for (value, part) in value.iter_mut().zip(coefficient) {
            *value = &(&*value * &t) + part;
        }
    }
    value[0] = &value[0] - y;
    value
}

/// The numbers at which all equations are zero.
fn solve(mut rows: Vec<Affine>) -> Option<Vec<Rational>> {
    let count = rows.len();
    for column in 0..count {
        let pivot = (column..count).find(|row| !rows[*row][column + 1].is_zero())?;
        rows.swap(column, pivot);
        let scale = &Rational::ONE / &rows[column][column + 1];
        let own: Affine = rows[column].iter().map(|part| part * &scale).collect();
        for (place, row) in rows.iter_mut().enumerate() {
            let factor = row[column + 1].clone();
            if place != column && !factor.is_zero() {
                let reduced = row
                    .iter()
                    .zip(&own)
                    .map(|(part, own)| part - &(&factor * own));
                *row = reduced.collect();
            }
        }
        rows[column] = own;
    }
    Some(rows.iter().map(|row| -&row[0]).collect())
}

fn resolved(pieces: Vec<(Rational, Vec<Affine>)>, known: &[Rational]) -> Option<Vec<Piece>> {
    let value = |affine: &Affine| {
        let terms = affine[1..].iter().zip(known);
        terms.fold(affine[0].clone(), |sum, (factor, number)| {
            &sum + &(factor * number)
        })
    };
    let pieces = pieces.into_iter().map(|(center, coefficients)| Piece {
        center,
        coefficients: coefficients.iter().map(value).collect(),
    });
    Some(pieces.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(n: i64) -> Rational {
        Rational::from(n)
    }

    /// A polynomial with these coefficients at a place.
    fn value(coefficients: &[i64], x: &Rational) -> Rational {
        let terms = coefficients.iter().rev();
        terms.fold(Rational::ZERO, |sum, c| &(&sum * x) + &number(*c))
    }

    /// Points at places that are not at equal distances.
    fn points(count: i64, of: impl Fn(&Rational) -> Rational) -> Vec<(Rational, Rational)> {
        let places = (0..count).filter_map(|k| Rational::new(k * k + 3 * k - 5, 4));
        places.map(|x| (x.clone(), of(&x))).collect()
    }

    /// The derivative of some order at a place, over its factorial.
    fn derivative(piece: &Piece, x: &Rational, order: usize) -> Rational {
        let affine: Vec<Affine> = piece.coefficients.iter().map(|c| vec![c.clone()]).collect();
        shifted(&affine, &(x - &piece.center))[order][0].clone()
    }

    #[test]
    fn polynomials_of_the_degree_are_met_exactly() {
        let polynomial = [3, -2, 5, 1, -4, 2, 7, 1];
        for degree in [1, 3, 5, 7] {
            for count in [degree as i64 + 1, degree as i64 + 2, 14] {
                let own = &polynomial[..=degree];
                let points = points(count, |x| value(own, x));
                let pieces = spline(&points, degree).expect("a spline");
                for piece in &pieces {
                    for shift in [-1, 0, 2, 7] {
                        let x = &piece.center + &number(shift);
                        assert_eq!(
                            piece.value_and_slope(&x)[0],
                            value(own, &x),
                            "degree {degree}"
                        );
                    }
                }
                // the control: one degree more is not met
                let more = &polynomial[..=(degree + 1).min(7)];
                if degree < 7 {
                    let points = self::points(14, |x| value(more, x));
                    let pieces = spline(&points, degree).expect("a spline");
                    let x = &points[6].0 + &(&Rational::ONE / &number(3));
                    let piece = pieces.iter().rfind(|p| p.center <= x).expect("a piece");
                    assert_ne!(piece.value_and_slope(&x)[0], value(more, &x));
                }
            }
        }
    }

    #[test]
    fn all_derivatives_but_the_last_are_continuous_at_the_knots() {
        for degree in [1, 3, 5, 7] {
            let jumpy = |x: &Rational| if x.is_negative() { number(2) } else { x * x };
            let points = points(14, jumpy);
            let pieces = spline(&points, degree).expect("a spline");
            assert_eq!(pieces.len(), 14 - degree, "degree {degree}");
            for (x, y) in &points {
                let piece = pieces.iter().rfind(|p| p.center <= *x).expect("a piece");
                assert_eq!(piece.value_and_slope(x)[0], *y);
            }
            let mut jumps = 0;
            for pair in pieces.windows(2) {
                let x = &pair[1].center;
                for order in 0..degree {
                    let [before, after] = [0, 1].map(|k| derivative(&pair[k], x, order));
                    assert_eq!(before, after, "degree {degree}, order {order}");
                }
                let [before, after] = [0, 1].map(|k| derivative(&pair[k], x, degree));
                jumps += usize::from(before != after);
            }
            assert!(jumps > 0);
        }
    }
}
