//! Functions of `ad*_x` in closed form: the coadjoint action of `exp(x)` and the dual of `dexp_x`.
//!
//! `f_k(z) = sum_n z^n/(n + k)!` is the exponential for k = 0 and `phi1(z) = (e^z - 1)/z` for k = 1. Where the minimal polynomial
//! of `A = ad*_x` is `z^a` times a factor,
//! `f_k(A) = sum_(j<a) A^j/(j + k)! + A^a f_(a + k)(A)`, and the last function is expanded about the root of the factor:
//! about `l` where it is `(z - l)^b`; where it is `(z^2 + w)^b`, `f_m(z) = S_m(-z^2) + z S_(m + 1)(-z^2)` with both Stumpff
//! functions about w. Neither divides by anything, so that nothing is singular; the rest vanishes.

use super::coadjoint::xi;
use super::field::mu;
use super::tape::{Tangents, Tape};
use super::{Block, Kernel, Source};
use crate::structure::exponential::{Factor, Summand};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Function, Symbol};

/// A combination of the functions of one argument, by their indices.
type Combination = Vec<(u8, Rational)>;

/// A weight and the vector that it multiplies.
type Term = (ExprId, Vec<ExprId>);

/// Which functions a factor needs.
#[derive(Clone, Copy)]
enum Family {
    Stumpff,
    Phi,
}

impl Family {
    fn member(self, k: u8) -> Function {
        match self {
            Self::Stumpff => Function::Stumpff(k),
            Self::Phi => Function::Phi(k),
        }
    }

    /// The derivative: `S_k' = (k S_(k+2) - S_(k+1))/2`, `phi_k' = phi_k - k phi_(k+1)`.
    fn derivative(self, of: &Combination) -> Combination {
        let mut out = Combination::new();
        let mut add = |k: u8, value: Rational| match out.iter_mut().find(|(known, _)| *known == k) {
            Some((_, known)) => *known = &*known + &value,
            None => out.push((k, value)),
        };
        for (k, coefficient) in of {
            let index = Rational::from(i64::from(*k));
            match self {
                Self::Stumpff => {
                    let half = &(coefficient / &Rational::from(2));
                    add(k + 2, half * &index);
                    add(k + 1, -half);
                }
                Self::Phi => {
                    add(*k, coefficient.clone());
                    add(k + 1, -&(coefficient * &index));
                }
            }
        }
        out
    }
}

/// `1/n!`
fn inverse_factorial(n: usize) -> Rational {
    let factorial: i64 = (1..=n as i64).product();
    Rational::new(1, factorial).unwrap_or(Rational::ZERO)
}

impl Source {
    /// `f_k(ad*_x) m` in closed form. New quantities become definitions; the increment of m is one, so that its addition
    /// is the only rounding in units of m.
    pub(crate) fn closed_function(
        &mut self,
        tape: &mut Tape,
        (x, m): (&[ExprId], &[ExprId]),
        k: usize,
    ) -> Vec<ExprId> {
        let summands = match &self.exponential {
            Some(exponential) => exponential.summands.clone(),
            None => Vec::new(),
        };
        let mut increments: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for summand in &summands {
            let terms = self.increment(tape, summand, (x, m), k);
            match &summand.projection {
                None => {
                    for (sum, term) in increments.iter_mut().zip(terms) {
                        sum.push(term);
                    }
                }
                Some(projection) => {
                    let terms = tape.define_all(self, &terms);
                    for (row, column, value) in projection {
                        let term = self.graph.scale(terms[*column], value);
                        increments[*row].push(term);
                    }
                }
            }
        }
        let entries = m.iter().zip(increments);
        entries
            .map(|(entry, terms)| {
                let increment = self.graph.sum(&terms);
                let increment = tape.define(self, increment);
                self.graph.add(*entry, increment)
            })
            .collect()
    }

    /// What one summand adds to m.
    fn increment(
        &mut self,
        tape: &mut Tape,
        summand: &Summand,
        (x, m): (&[ExprId], &[ExprId]),
        k: usize,
    ) -> Vec<ExprId> {
        let zero = self.graph.integer(0);
        let mut vector = vec![zero; self.dimension];
        for i in &summand.coordinates {
            vector[*i] = m[*i];
        }
        let mut terms = Vec::new();
        for j in 1..summand.nilpotent {
            vector = self.moved_by(tape, x, &vector);
            let weight = self.graph.number(inverse_factorial(j + k));
            terms.push((weight, vector.clone()));
        }
        if !matches!(summand.factor, Factor::None) {
            vector = self.moved_by(tape, x, &vector);
        }
        let first = (summand.nilpotent + k) as u8;
        match &summand.factor {
            Factor::None => {}
            Factor::Linear(form, _) => {
                let form = form.iter().map(|(i, c)| self.scaled(c, &[x[*i]]));
                let form: Vec<ExprId> = form.collect();
                let root = self.graph.sum(&form);
                let root = tape.define(self, root);
                self.about_root(
                    tape,
                    (x, vector),
                    (root, first),
                    &summand.supports,
                    &mut terms,
                );
            }
            Factor::Quadratic(form, _) => {
                let form = form.iter().map(|(i, j, c)| self.scaled(c, &[x[*i], x[*j]]));
                let form: Vec<ExprId> = form.collect();
                let square = self.graph.sum(&form);
                let square = tape.define(self, square);
                self.about_pair(
                    tape,
                    (x, vector),
                    (square, first),
                    &summand.supports,
                    &mut terms,
                );
            }
        }
        let entries = 0..self.dimension;
        entries
            .map(|row| {
                let terms = terms.iter();
                let terms: Vec<ExprId> = terms
                    .map(|(weight, vector)| self.graph.mul(*weight, vector[row]))
                    .collect();
                self.graph.sum(&terms)
            })
            .collect()
    }

    /// `ad*_x` of a vector, each entry a quantity.
    fn moved_by(&mut self, tape: &mut Tape, x: &[ExprId], vector: &[ExprId]) -> Vec<ExprId> {
        let moved = self.ad_star_of(x, vector);
        tape.define_all(self, &moved)
    }

    /// `phi_m(A) v = sum_i phi_m^(i)(l)/i! (A - l)^i v`
    fn about_root(
        &mut self,
        tape: &mut Tape,
        (x, mut vector): (&[ExprId], Vec<ExprId>),
        (root, first): (ExprId, u8),
        supports: &[Vec<usize>],
        terms: &mut Vec<Term>,
    ) {
        let mut weight = vec![(first, Rational::ONE)];
        for i in 0..supports.len() {
            let value = self.combination(Family::Phi, &weight, root, &inverse_factorial(i));
            terms.push((value, vector.clone()));
            if let Some(support) = supports.get(i + 1) {
                let moved = self.ad_star_of(x, &vector);
                let root = (root, &Rational::MINUS_ONE);
                vector = self.shifted(tape, (&moved, &vector), root, support);
                weight = Family::Phi.derivative(&weight);
            }
        }
    }

    /// `f_m(A) v = sum_i (-1)^i/i! (S_m^(i)(w) + S_(m + 1)^(i)(w) A) (A^2 + w)^i v`
    fn about_pair(
        &mut self,
        tape: &mut Tape,
        (x, mut vector): (&[ExprId], Vec<ExprId>),
        (square, first): (ExprId, u8),
        supports: &[Vec<usize>],
        terms: &mut Vec<Term>,
    ) {
        let mut even = vec![(first, Rational::ONE)];
        let mut odd = vec![(first + 1, Rational::ONE)];
        for i in 0..supports.len() {
            let sign = Rational::from(if i.is_multiple_of(2) { 1 } else { -1 });
            let scale = &inverse_factorial(i) * &sign;
            let value = self.combination(Family::Stumpff, &even, square, &scale);
            terms.push((value, vector.clone()));
            let next = self.moved_by(tape, x, &vector);
            let value = self.combination(Family::Stumpff, &odd, square, &scale);
            terms.push((value, next.clone()));
            if let Some(support) = supports.get(i + 1) {
                let moved = self.ad_star_of(x, &next);
                let square = (square, &Rational::ONE);
                vector = self.shifted(tape, (&moved, &vector), square, support);
                even = Family::Stumpff.derivative(&even);
                odd = Family::Stumpff.derivative(&odd);
            }
        }
    }

    /// A coefficient times entries of x.
    fn scaled(
        &mut self,
        coefficient: &lie_symbolic::exact::Fraction,
        entries: &[ExprId],
    ) -> ExprId {
        let coefficient = self.graph.rational_function(coefficient);
        let product = self.graph.product(entries);
        self.graph.mul(coefficient, product)
    }

    /// `moved + sign * form * vector` in the rows where that does not vanish.
    fn shifted(
        &mut self,
        tape: &mut Tape,
        (moved, vector): (&[ExprId], &[ExprId]),
        (form, sign): (ExprId, &Rational),
        support: &[usize],
    ) -> Vec<ExprId> {
        let entries = moved.iter().zip(vector).enumerate();
        let entries = entries.map(|(row, (moved, entry))| {
            if !support.contains(&row) {
                return self.graph.integer(0);
            }
            let term = self.graph.mul(form, *entry);
            let term = self.graph.scale(term, sign);
            self.graph.add(*moved, term)
        });
        let entries: Vec<ExprId> = entries.collect();
        tape.define_all(self, &entries)
    }

    /// A combination of functions at an argument, scaled.
    fn combination(
        &mut self,
        family: Family,
        of: &Combination,
        argument: ExprId,
        scale: &Rational,
    ) -> ExprId {
        let terms: Vec<(ExprId, Rational)> = of
            .iter()
            .map(|(k, c)| (self.graph.call(family.member(*k), &[argument]), c * scale))
            .collect();
        self.graph.linear(&terms)
    }

    /// The kernels of the closed form: the coadjoint action of `exp(xi)`, the dual of `dexp_xi`, and that with its derivative
    /// in xi where steps solve equations. None where there is no closed form.
    pub fn exponential_kernels(&mut self, derivatives: bool) -> Vec<Kernel> {
        if self.exponential.is_none() {
            return Vec::new();
        }
        let (x, m) = (self.block(Block::Xi), self.coordinates());
        let first = Block::COUNT * self.dimension;
        let mut kernels = Vec::new();
        for (k, name, formula) in [
            (0, "coadjoint_action", "`Ad*_(exp xi) mu = exp(ad*_xi) mu`"),
            (1, "dexp_dual", "`phi1(ad*_xi) mu`, `phi1(z) = (e^z - 1)/z`"),
        ] {
            let mut tape = Tape::new(self, first);
            let value = self.closed_function(&mut tape, (&x, &m), k);
            let arguments = vec![xi(self), mu(self)];
            let mut kernel = Kernel::vector(&self.graph, name, formula, arguments, &value);
            kernel.task.definitions = tape.definitions().to_vec();
            kernels.push(kernel);
        }
        if derivatives {
            kernels.push(self.slope_kernel(&x, &m, first));
        }
        kernels
    }

    fn slope_kernel(&mut self, x: &[ExprId], m: &[ExprId], first: usize) -> Kernel {
        let mut tape = Tape::new(self, first);
        let value = self.closed_function(&mut tape, (x, m), 1);
        let symbols: Vec<Symbol> = self.symbols(Block::Xi);
        let rows = tape.jacobian_in(self, &value, &symbols, Tangents::Named);
        let arguments = vec![xi(self), mu(self)];
        let mut kernel = Kernel::fused(
            &self.graph,
            "dexp_dual_slope",
            "`phi1(ad*_xi) mu` and its derivative in xi",
            arguments,
            &value,
            &rows,
        );
        kernel.task.definitions = self.needed(tape.definitions(), &kernel.task.outputs);
        kernel
    }
}
