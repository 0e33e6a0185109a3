//! Integrals of rational functions of one variable, by partial fractions.
//!
//! ```math
//! \frac{d}{n} = p + \sum_{r, k} \frac{a_{rk}}{(x - r)^k} + \sum_k \frac{b_k x + c_k}{q^k}, \qquad q = x^2 + b x + c
//! ```
//!
//! where n has rational zeros r, and beside them those of a power of one quadratic q.

use super::Side;
use crate::structure::algebra::roots::rational_roots;
use lie_symbolic::exact::matrix::solve;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::symbolic::{Elementary, ExprId, Graph};

/// Work allowed for one function.
const WORK: u64 = 200_000;
/// The largest degree.
const MOST: usize = 12;

/// The coefficients of a polynomial, from that of 1 on, without a leading 0.
pub(super) type Coefficients = Vec<Rational>;

/// A polynomial by its monic factors, each with its exponent.
struct Factors {
    lead: Rational,
    linear: Vec<(Rational, usize)>,
    /// b and c of `x^2 + b x + c`, which has no rational zeros.
    quadratic: Option<([Rational; 2], usize)>,
}

/// A term of the sum.
enum Part {
    /// `x^k`
    Power(usize),
    /// `1/(x - r)^k`
    Pole(Rational, usize),
    /// `x^e/q^k`
    Quadratic(usize, usize),
}

/// `int (above/below) dx`, with what keeps its sign between the zeros of both; none where a zero has no such form.
pub(super) fn integral(
    above: &Coefficients,
    below: &Coefficients,
    x: ExprId,
    graph: &mut Graph,
) -> Option<(ExprId, Vec<Side>)> {
    if above.len() > MOST || below.len() > MOST {
        return None;
    }
    let (poles, zeros) = (factors(below)?, factors(above)?);
    let mut writer = Writer { x, graph };
    let value = writer.sum(above, below, &poles)?;
    let mut sides = Vec::new();
    for factors in [&poles, &zeros] {
        for (root, _) in &factors.linear {
            sides.push(Side::Sign(writer.linear(root)));
        }
        if let Some((quadratic, _)) = &factors.quadratic {
            sides.extend(writer.sides(quadratic));
        }
    }
    Some((value, sides))
}

fn factors(polynomial: &Coefficients) -> Option<Factors> {
    let lead = polynomial.last()?.clone();
    let mut rest: Coefficients = polynomial.iter().map(|c| c / &lead).collect();
    let mut linear = Vec::new();
    for root in rational_roots(&rest) {
        let factor = vec![-root.clone(), Rational::ONE];
        let mut power = 0;
        while let (quotient, remainder) = divide(&rest, &factor)
            && remainder.is_empty()
        {
            rest = quotient;
            power += 1;
        }
        linear.push((root, power));
    }
    let power = (rest.len() - 1) / 2;
    if power == 0 {
        let whole = rest.len() == 1;
        return whole.then_some(Factors {
            lead,
            linear,
            quadratic: None,
        });
    }
    // q^m = x^(2m) + m b x^(2m - 1) + ..., and its last but one coefficient at the other end is m b c^(m - 1)
    let degree = rest.len() - 1;
    let m = Rational::from(power as i64);
    let b = &rest[degree - 1] / &m;
    // that of x^(2m - 2) is m c + m (m - 1) b^2/2
    let pairs = &(&m * &(&m - &Rational::ONE)) / &Rational::from(2);
    let c = &(&rest[degree - 2] - &(&pairs * &(&b * &b))) / &m;
    let quadratic = [b, c];
    let expected = (0..power).fold(vec![Rational::ONE], |product, _| {
        times(&product, &of_quadratic(&quadratic))
    });
    (expected == rest).then_some(Factors {
        lead,
        linear,
        quadratic: Some((quadratic, power)),
    })
}

fn of_quadratic([b, c]: &[Rational; 2]) -> Coefficients {
    vec![c.clone(), b.clone(), Rational::ONE]
}

pub(super) fn times(a: &[Rational], b: &[Rational]) -> Coefficients {
    let mut product = vec![Rational::ZERO; a.len() + b.len() - 1];
    for (i, first) in a.iter().enumerate() {
        for (j, second) in b.iter().enumerate() {
            product[i + j] = &product[i + j] + &(first * second);
        }
    }
    product
}

/// The quotient and the remainder by a polynomial whose leading coefficient is 1.
fn divide(a: &[Rational], monic: &[Rational]) -> (Coefficients, Coefficients) {
    let mut rest = a.to_vec();
    let shift = monic.len() - 1;
    let mut quotient = vec![Rational::ZERO; a.len().saturating_sub(shift)];
    for k in (0..quotient.len()).rev() {
        let factor = rest[k + shift].clone();
        for (j, coefficient) in monic.iter().enumerate() {
            rest[k + j] = &rest[k + j] - &(&factor * coefficient);
        }
        quotient[k] = factor;
    }
    while rest.last().is_some_and(Rational::is_zero) {
        rest.pop();
    }
    (quotient, rest)
}

struct Writer<'a> {
    x: ExprId,
    graph: &'a mut Graph,
}

impl Writer<'_> {
    fn number(&mut self, value: &Rational) -> ExprId {
        self.graph.number(value.clone())
    }

    /// `x - r`
    fn linear(&mut self, root: &Rational) -> ExprId {
        let root = self.number(root);
        self.graph.sub(self.x, root)
    }

    /// `x^2 + b x + c`
    fn quadratic(&mut self, [b, c]: &[Rational; 2]) -> ExprId {
        let square = self.graph.pow(self.x, &Rational::from(2));
        let moved = self.graph.scale(self.x, b);
        let constant = self.number(c);
        self.graph.sum(&[square, moved, constant])
    }

    /// `2 x + b`
    fn slope(&mut self, b: &Rational) -> ExprId {
        let doubled = self.graph.scale(self.x, &Rational::from(2));
        let constant = self.number(b);
        self.graph.add(doubled, constant)
    }

    fn root(&mut self, value: Rational) -> ExprId {
        let value = self.number(&value);
        self.graph.pow(value, &half())
    }

    /// `log |value|`
    fn logarithm(&mut self, value: ExprId) -> ExprId {
        logarithm(self.graph, value)
    }

    /// What keeps its sign between the zeros of a quadratic.
    fn sides(&mut self, quadratic: &[Rational; 2]) -> Vec<Side> {
        let width = width(quadratic);
        if !width.is_negative() {
            return Vec::new();
        }
        let root = self.root(-width);
        let slope = self.slope(&quadratic[0]);
        vec![
            Side::Sign(self.graph.sub(slope, root)),
            Side::Sign(self.graph.add(slope, root)),
        ]
    }

    fn sum(
        &mut self,
        above: &Coefficients,
        below: &Coefficients,
        poles: &Factors,
    ) -> Option<ExprId> {
        let monic: Coefficients = below.iter().map(|c| c / &poles.lead).collect();
        let scaled: Coefficients = above.iter().map(|c| c / &poles.lead).collect();
        let (whole, mut rest) = divide(&scaled, &monic);
        let mut parts: Vec<(Part, Rational)> = Vec::new();
        for (k, coefficient) in whole.into_iter().enumerate() {
            parts.push((Part::Power(k), coefficient));
        }
        rest.resize(monic.len() - 1, Rational::ZERO);
        let (names, columns) = fractions(&monic, poles);
        let rows: Vec<Vec<Rational>> = (0..rest.len())
            .map(|row| {
                let entries = columns.iter().map(|column| column.get(row));
                entries
                    .map(|entry| entry.cloned().unwrap_or(Rational::ZERO))
                    .collect()
            })
            .collect();
        let solution = solve(&rows, &rest, &Budget::new(WORK)).ok()??;
        parts.extend(names.into_iter().zip(solution));
        let mut terms = Vec::new();
        let mut over_powers = vec![[Rational::ZERO, Rational::ZERO]; monic.len()];
        for (part, coefficient) in parts {
            if coefficient.is_zero() {
                continue;
            }
            match part {
                Part::Quadratic(e, k) => over_powers[k][e] = coefficient,
                Part::Power(k) => {
                    let above = Rational::from(k as i64 + 1);
                    let power = self.graph.pow(self.x, &above);
                    terms.push((power, &coefficient / &above));
                }
                Part::Pole(root, 1) => {
                    let base = self.linear(&root);
                    terms.push((self.logarithm(base), coefficient));
                }
                Part::Pole(root, k) => {
                    let base = self.linear(&root);
                    let above = Rational::from(1 - k as i64);
                    let power = self.graph.pow(base, &above);
                    terms.push((power, &coefficient / &above));
                }
            }
        }
        if let Some((quadratic, _)) = &poles.quadratic {
            for (k, [constant, slope]) in over_powers.iter().enumerate() {
                self.over_quadratic(quadratic, k, [constant, slope], &mut terms);
            }
        }
        Some(self.graph.linear(&terms))
    }

    /// `int (e_0 + e_1 x)/q^k dx`
    fn over_quadratic(
        &mut self,
        quadratic: &[Rational; 2],
        k: usize,
        [constant, slope]: [&Rational; 2],
        terms: &mut Vec<(ExprId, Rational)>,
    ) {
        // (e_1/2) q'/q^k + (e_0 - e_1 b/2)/q^k
        let along = slope * &half();
        let rest = constant - &(&along * &quadratic[0]);
        if !along.is_zero() {
            let base = self.quadratic(quadratic);
            if k == 1 && width(quadratic).is_negative() {
                terms.push((self.logarithm(base), along));
            } else if k == 1 {
                terms.push((self.graph.call(Elementary::Log, &[base]), along));
            } else {
                let above = Rational::from(1 - k as i64);
                let power = self.graph.pow(base, &above);
                terms.push((power, &along / &above));
            }
        }
        if !rest.is_zero() {
            let value = self.inverse_power(quadratic, k);
            terms.push((value, rest));
        }
    }

    /// `int dx/q^k`: with `w = 4 c - b^2` for k above 1 `(2 x + b)/((k - 1) w q^(k-1)) + 2 (2 k - 3)/((k - 1) w) int dx/q^(k-1)`.
    fn inverse_power(&mut self, quadratic: &[Rational; 2], k: usize) -> ExprId {
        let width = width(quadratic);
        let slope = self.slope(&quadratic[0]);
        if k > 1 {
            let below = self.inverse_power(quadratic, k - 1);
            let k = k as i64;
            let divisor = &Rational::from(k - 1) * &width;
            let factor = &Rational::from(2 * (2 * k - 3)) / &divisor;
            let base = self.quadratic(quadratic);
            let power = self.graph.pow(base, &Rational::from(1 - k));
            let first = self.graph.mul(slope, power);
            let inverse = &Rational::ONE / &divisor;
            return self.graph.linear(&[(first, inverse), (below, factor)]);
        }
        if width.is_negative() {
            let root = self.root(-width);
            let [below, above] = [self.graph.sub(slope, root), self.graph.add(slope, root)];
            let [below, above] = [self.logarithm(below), self.logarithm(above)];
            let difference = self.graph.sub(below, above);
            return self.graph.div(difference, root);
        }
        let root = self.root(width);
        let ratio = self.graph.div(slope, root);
        let angle = self.graph.call(Elementary::Atan, &[ratio]);
        let angle = self.graph.div(angle, root);
        self.graph.scale(angle, &Rational::from(2))
    }
}

/// The terms that a proper fraction is a sum of, and each of them times the denominator.
fn fractions(monic: &Coefficients, poles: &Factors) -> (Vec<Part>, Vec<Coefficients>) {
    let (mut names, mut columns) = (Vec::new(), Vec::new());
    for (root, power) in &poles.linear {
        let factor = [-root.clone(), Rational::ONE];
        let mut quotient = monic.clone();
        for k in 1..=*power {
            quotient = divide(&quotient, &factor).0;
            names.push(Part::Pole(root.clone(), k));
            columns.push(quotient.clone());
        }
    }
    if let Some((quadratic, power)) = &poles.quadratic {
        let factor = of_quadratic(quadratic);
        let mut quotient = monic.clone();
        for k in 1..=*power {
            quotient = divide(&quotient, &factor).0;
            for e in 0..2 {
                names.push(Part::Quadratic(e, k));
                let mut shifted = vec![Rational::ZERO; e];
                shifted.extend(quotient.iter().cloned());
                columns.push(shifted);
            }
        }
    }
    (names, columns)
}

/// `4 c - b^2`
fn width([b, c]: &[Rational; 2]) -> Rational {
    &(c * &Rational::from(4)) - &(b * b)
}

/// 1/2
pub(in crate::structure) fn half() -> Rational {
    &Rational::ONE / &Rational::from(2)
}

/// `log |value|`, as half the logarithm of the square.
pub(in crate::structure) fn logarithm(graph: &mut Graph, value: ExprId) -> ExprId {
    let square = graph.pow(value, &Rational::from(2));
    let logarithm = graph.call(Elementary::Log, &[square]);
    graph.scale(logarithm, &half())
}
