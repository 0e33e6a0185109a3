//! Discrete gradients of a polynomial H in closed form.
//!
//! With the ends x and u of a step, `m = (x + u)/2`, `d = u - x` and D the derivative along d, the
//! increment of a polynomial is a finite sum of odd terms about the middle,
//! `H(u) - H(x) = sum_(k odd) D^k H(m)/(2^(k-1) k!)`, without any cancellation. Hence
//!
//! - mean value: `g = sum_(k even) D^k grad H(m)/(2^k (k+1)!)`;
//! - Gonzalez: `g = grad H(m) + c e` with the direction `e = d/|d|` and
//!   `c = sum_(k odd > 1) E D^(k-1) H(m)/(2^(k-1) k!)`, E the derivative along e;
//! - Itoh and Abe: on each edge the mean value of `dH/dmu_i` in one coordinate, of two paths of edges.
//!
//! For a quadratic H all three are `grad H(m)`. e has no entry for the momentum of the time, which moves as it does, nor for the
//! time where H does not depend on it.

use super::{Argument, Block, Kernel, Source};
use crate::methods::Gradient;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// A discrete gradient with its derivative in u, row by row, in the symbols of both ends and of what
/// is defined from them.
#[derive(Clone, Debug)]
pub(crate) struct Closed {
    pub(crate) value: Vec<ExprId>,
    pub(crate) slopes: Vec<Vec<ExprId>>,
    pub(crate) definitions: Vec<(Symbol, ExprId)>,
}

/// `1/(2^k (k + 1)!)`
fn mean_coefficient(k: u32) -> Rational {
    let factorial: i64 = (1..=i64::from(k) + 1).product();
    Rational::new(1, (1_i64 << k) * factorial).unwrap_or(Rational::ONE)
}

impl Source {
    /// The closed form for a polynomial H of a degree.
    pub(super) fn closed_gradient(&mut self, gradient: Gradient, degree: u32) -> Closed {
        let (x, u) = (self.coordinates(), self.block(Block::Unknown));
        let mut definitions = Vec::new();
        for (i, symbol) in self.symbols(Block::Middle).into_iter().enumerate() {
            definitions.push((symbol, self.graph.add(x[i], u[i])));
        }
        for (i, symbol) in self.symbols(Block::Difference).into_iter().enumerate() {
            definitions.push((symbol, self.graph.sub(u[i], x[i])));
        }
        if gradient == Gradient::Gonzalez && degree > 2 {
            return self.gonzalez(degree, definitions);
        }
        let value = match gradient {
            _ if degree <= 2 => self.middle_gradient(),
            Gradient::ItohAbe => self.itoh_abe(degree),
            _ => self.mean_value(degree),
        };
        let slopes = self.slopes_in_end(&value);
        Closed {
            value,
            slopes,
            definitions,
        }
    }

    /// The middle, s/2.
    fn middle(&mut self) -> Vec<ExprId> {
        let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
        let sums = self.block(Block::Middle);
        sums.into_iter()
            .map(|s| self.graph.scale(s, &half))
            .collect()
    }

    fn middle_gradient(&mut self) -> Vec<ExprId> {
        let (gradient, middle) = (self.gradient_of_h(), self.middle());
        self.at_point(&gradient, &middle)
    }

    /// The derivative of an expression in the coordinates along a vector.
    fn along(&mut self, vector: Block, expression: ExprId) -> ExprId {
        let vector = self.block(vector);
        let terms: Vec<ExprId> = (0..self.dimension)
            .map(|j| {
                let slope = self.graph.derivative(expression, Symbol::Coordinate(j));
                self.graph.mul(vector[j], slope)
            })
            .collect();
        self.graph.sum(&terms)
    }

    fn mean_value(&mut self, degree: u32) -> Vec<ExprId> {
        let gradient = self.gradient_of_h();
        let sums: Vec<ExprId> = gradient
            .into_iter()
            .map(|entry| {
                let (mut term, mut terms) = (entry, Vec::new());
                for k in 0..degree {
                    if k % 2 == 0 {
                        terms.push((term, mean_coefficient(k)));
                    }
                    term = self.along(Block::Difference, term);
                }
                self.graph.linear(&terms)
            })
            .collect();
        let middle = self.middle();
        self.at_point(&sums, &middle)
    }

    /// With `r = 1/|d|`, the correction c and the direction e defined, the derivative in `u_j` of
    /// `c e_i` is `e_i t_j + c r delta_ij`, `t_j = dc/ds_j + dc/dd_j + r (dc/de_j - 2 c e_j)`.
    fn gonzalez(&mut self, degree: u32, mut definitions: Vec<(Symbol, ExprId)>) -> Closed {
        let n = self.dimension;
        let (mut term, mut terms) = (self.function(), Vec::new());
        for k in 1..=degree {
            if k > 1 && k % 2 == 1 {
                let directed = self.along(Block::Direction, term);
                terms.push((directed, mean_coefficient(k - 1)));
            }
            term = self.along(Block::Difference, term);
        }
        let correction = self.graph.linear(&terms);
        let middle = self.middle();
        let correction = self.at_point(&[correction], &middle)[0];
        let inverse = self.block(Block::Given)[0];
        let difference = self.block(Block::Difference);
        let zero = self.graph.integer(0);
        let mut counts = vec![true; n];
        if let Some(clock) = self.clock() {
            counts[clock.momentum] = false;
            counts[clock.time] = self.gradient_of_h()[clock.time] != zero;
        }
        for (i, symbol) in self.symbols(Block::Direction).into_iter().enumerate() {
            if !counts[i] {
                continue;
            }
            definitions.push((symbol, self.graph.mul(inverse, difference[i])));
        }
        definitions.push((self.symbols(Block::Correction)[0], correction));
        let defined = self.block(Block::Correction)[0];
        let mut direction = self.block(Block::Direction);
        for (entry, _) in direction
            .iter_mut()
            .zip(&counts)
            .filter(|(_, counts)| !**counts)
        {
            *entry = zero;
        }
        let minus_two = self.graph.integer(-2);
        let directions = self.symbols(Block::Direction);
        for (j, symbol) in self.symbols(Block::Tilt).into_iter().enumerate() {
            let through_ends = self.slope_in_end(correction, j);
            let through_direction = self.graph.derivative(correction, directions[j]);
            let turned = self.graph.product(&[minus_two, defined, direction[j]]);
            let turned = self.graph.add(through_direction, turned);
            let turned = self.graph.mul(inverse, turned);
            definitions.push((symbol, self.graph.add(through_ends, turned)));
        }
        let gradient = self.middle_gradient();
        let mut slopes = self.slopes_in_end(&gradient);
        let tilt = self.block(Block::Tilt);
        let across = self.graph.mul(defined, inverse);
        let mut value = Vec::with_capacity(n);
        for i in 0..n {
            let along = self.graph.mul(defined, direction[i]);
            value.push(self.graph.add(gradient[i], along));
            for j in 0..n {
                let bent = self.graph.mul(direction[i], tilt[j]);
                slopes[i][j] = self.graph.add(slopes[i][j], bent);
            }
            if counts[i] {
                slopes[i][i] = self.graph.add(slopes[i][i], across);
            }
        }
        Closed {
            value,
            slopes,
            definitions,
        }
    }

    fn itoh_abe(&mut self, degree: u32) -> Vec<ExprId> {
        let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
        let gradient = self.gradient_of_h();
        let (x, u) = (self.coordinates(), self.block(Block::Unknown));
        let (middle, difference) = (self.middle(), self.block(Block::Difference));
        gradient
            .into_iter()
            .enumerate()
            .map(|(i, entry)| {
                let (mut term, mut terms) = (entry, Vec::new());
                for k in 0..degree {
                    if k % 2 == 0 {
                        terms.push((term, mean_coefficient(k)));
                    }
                    let slope = self.graph.derivative(term, Symbol::Coordinate(i));
                    term = self.graph.mul(slope, difference[i]);
                }
                let mean = self.graph.linear(&terms);
                // the corners of the path that changes the coordinates in order, and of the other one
                let corner = |first: &[ExprId], last: &[ExprId]| -> Vec<ExprId> {
                    let mut point = last.to_vec();
                    point[..i].copy_from_slice(&first[..i]);
                    point[i] = middle[i];
                    point
                };
                let there = self.at_point(&[mean], &corner(&u, &x))[0];
                let back = self.at_point(&[mean], &corner(&x, &u))[0];
                self.graph
                    .linear(&[(there, half.clone()), (back, half.clone())])
            })
            .collect()
    }

    /// The derivative in `u_j` of an expression in u, s and d.
    fn slope_in_end(&mut self, expression: ExprId, j: usize) -> ExprId {
        let blocks = [Block::Unknown, Block::Middle, Block::Difference];
        let terms = blocks.map(|block| {
            let symbol = self.symbols(block)[j];
            self.graph.derivative(expression, symbol)
        });
        self.graph.sum(&terms)
    }

    fn slopes_in_end(&mut self, value: &[ExprId]) -> Vec<Vec<ExprId>> {
        let columns = 0..self.dimension;
        value
            .iter()
            .map(|entry| {
                columns
                    .clone()
                    .map(|j| self.slope_in_end(*entry, j))
                    .collect()
            })
            .collect()
    }

    /// Value and derivative of a discrete gradient.
    pub fn gradient_kernels(&mut self, gradient: Gradient, degree: u32) -> Vec<Kernel> {
        let closed = self.closed_gradient(gradient, degree);
        let graph = &self.graph;
        let value = Kernel::vector(graph, "value", "`g(mu, u)`", Vec::new(), &closed.value);
        let both = Kernel::fused(
            graph,
            "linearize",
            "`g(mu, u)` and `dg/du`",
            Vec::new(),
            &closed.value,
            &closed.slopes,
        );
        let inverse = Argument {
            name: "inverse",
            symbols: self.symbols(Block::Given)[..1].to_vec(),
        };
        [value, both]
            .map(|kernel| self.complete(kernel, &closed.definitions, &inverse))
            .into()
    }
}
