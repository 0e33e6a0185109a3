//! Quadratic functions as sums of squares of linear forms: Lagrange's reduction, over the rational functions of the parameters.
//!
//! A square is split off for a coordinate at a time, `H = d l^2/2 + beta l + …` with the coefficient 1 before that coordinate
//! in l, until no two coordinates in one term are left that do not commute. Signs and eigenvalues are not asked for:
//! squares with any factors have flows of the same form.
//!
//! Source: J.-L. Lagrange, "Recherches sur la méthode de maximis et minimis", Miscellanea Taurinensia 1 (1759) 18–42.

use super::atoms::{Atom, Commuting, Form};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};

/// Larger systems are left as they are.
const LARGEST: usize = 64;

/// A Hamiltonian by the terms of degree at most 2 and all others.
#[derive(Clone, Debug)]
pub(super) struct Quadratic {
    /// The second derivatives of the quadratic part.
    square: Vec<Vec<Fraction>>,
    /// The first derivatives of the linear part.
    slope: Vec<Fraction>,
    /// What is of another form.
    others: Vec<ExprId>,
}

/// Functions of forms, and the terms beside them.
pub(super) type Parts = (Vec<Atom>, Vec<ExprId>);

/// The coordinate whose square is split off next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// The one in most terms with others that it does not commute with, of several that which commutes with the fewest.
    Entangled,
    /// The last such coordinate.
    Last,
}

impl Quadratic {
    /// The parts of a sum of terms; `None` where the system is too large.
    pub(super) fn from_terms(
        graph: &mut Graph,
        terms: &[ExprId],
        n: usize,
        budget: &Budget,
    ) -> Option<Self> {
        if n > LARGEST {
            return None;
        }
        let zero = Fraction::default();
        let mut parts = Self {
            square: vec![vec![zero.clone(); n]; n],
            slope: vec![zero; n],
            others: Vec::new(),
        };
        for &term in terms {
            let Some((factor, powers)) = monomial(graph, term) else {
                parts.others.push(term);
                continue;
            };
            match powers.as_slice() {
                [] => {}
                [(i, 1)] => parts.slope[*i] = parts.slope[*i].add(&factor, budget).ok()?,
                [(i, 2)] => {
                    let twice = factor.scale(&Rational::from(2));
                    parts.square[*i][*i] = parts.square[*i][*i].add(&twice, budget).ok()?;
                }
                [(i, 1), (j, 1)] => {
                    for (i, j) in [(*i, *j), (*j, *i)] {
                        parts.square[i][j] = parts.square[i][j].add(&factor, budget).ok()?;
                    }
                }
                _ => parts.others.push(term),
            }
        }
        Some(parts)
    }

    /// The forms whose squares were split off, and what is left of the terms; `defaults` are values at which no
    /// denominator may vanish.
    pub(super) fn squares(
        mut self,
        graph: &mut Graph,
        commuting: &Commuting<'_>,
        defaults: &[Option<Rational>],
        order: Order,
        budget: &Budget,
    ) -> Result<Option<Parts>, Exhausted> {
        let mut atoms = Vec::new();
        loop {
            let entangled = self.entangled(commuting);
            if entangled.iter().all(|count| *count == 0) {
                return Ok(Some((atoms, self.rest(graph))));
            }
            let places = (0..entangled.len()).filter(|i| entangled[*i] > 0);
            let mut usable = places.filter(|i| size(&self.square[*i][*i], defaults).is_some());
            let pivot = match order {
                Order::Entangled => {
                    usable.max_by_key(|i| (entangled[*i], commuting.degree(*i), usize::MAX - i))
                }
                Order::Last => usable.next_back(),
            };
            let split = match pivot {
                Some(pivot) => self.split_off(pivot, budget)?.map(|atom| vec![atom]),
                None => self.split_off_product(commuting, defaults, budget)?,
            };
            match split {
                Some(split) => atoms.extend(split),
                None => return Ok(None),
            }
        }
    }

    /// All linear terms as one form, and the other terms, where there are several.
    pub(super) fn linear_part(&self, graph: &mut Graph) -> Option<(Atom, Vec<ExprId>)> {
        let entries = self.slope.iter().enumerate();
        let form: Form = entries
            .filter(|(_, value)| !value.is_zero())
            .map(|(i, value)| (i, value.clone()))
            .collect();
        let others = Self {
            slope: vec![Fraction::default(); self.slope.len()],
            ..self.clone()
        };
        (form.len() > 1).then(|| {
            let atom = Atom::Form {
                form,
                square: Fraction::default(),
                slope: Fraction::from(Rational::ONE),
            };
            (atom, others.rest(graph))
        })
    }

    /// With how many others that it does not commute with each coordinate shares a term.
    fn entangled(&self, commuting: &Commuting<'_>) -> Vec<usize> {
        let n = self.slope.len();
        let shares =
            |i: usize, j: &usize| commuting.conflict(i, *j) && !self.square[i][*j].is_zero();
        (0..n)
            .map(|i| (0..n).filter(|j| shares(i, j)).count())
            .collect()
    }

    /// Splits off the square of a form.
    fn split_off(&mut self, pivot: usize, budget: &Budget) -> Result<Option<Atom>, Exhausted> {
        let square = self.square[pivot][pivot].clone();
        let slope = self.slope[pivot].clone();
        let mut form = Form::new();
        for (i, entry) in self.square[pivot].iter().enumerate() {
            let Some(entry) = entry.div(&square, budget)? else {
                return Ok(None);
            };
            if i == pivot {
                form.push((i, Fraction::from(Rational::ONE)));
            } else if !entry.is_zero() {
                form.push((i, entry));
            }
        }
        self.take(&form, &square, &slope, budget)?;
        Ok(Some(Atom::Form {
            form,
            square,
            slope,
        }))
    }

    /// Splits off two squares where a product of two coordinates has no square beside it:
    /// `q x y + x a + y b = q (x + b/q)(y + a/q) - a b/q`, and `u v = ((u + v)^2 - (u - v)^2)/4`.
    fn split_off_product(
        &mut self,
        commuting: &Commuting<'_>,
        defaults: &[Option<Rational>],
        budget: &Budget,
    ) -> Result<Option<Vec<Atom>>, Exhausted> {
        let n = self.slope.len();
        let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let pair = pairs.find(|(i, j)| {
            let no_square = self.square[*i][*i].is_zero() && self.square[*j][*j].is_zero();
            commuting.conflict(*i, *j)
                && no_square
                && size(&self.square[*i][*j], defaults).is_some()
        });
        let Some((i, j)) = pair else {
            return Ok(None);
        };
        let q = self.square[i][j].clone();
        let mut atoms = Vec::new();
        for sign in [Rational::ONE, Rational::MINUS_ONE] {
            // u + v and u - v with u = x_i + b/q, v = x_j + a/q
            let mut form = Form::new();
            for k in 0..n {
                let (Some(u), Some(v)) = (
                    self.square[j][k].div(&q, budget)?,
                    self.square[i][k].div(&q, budget)?,
                ) else {
                    return Ok(None);
                };
                let entry = u.add(&v.scale(&sign), budget)?;
                if !entry.is_zero() {
                    form.push((k, entry));
                }
            }
            let square = q.scale(&(&sign / &Rational::from(2)));
            let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
            let slope = self.slope[i].add(&self.slope[j].scale(&sign), budget)?;
            atoms.push((form, square, slope.scale(&half)));
        }
        for (form, square, slope) in &atoms {
            self.take(form, square, slope, budget)?;
        }
        let atoms = atoms.into_iter().map(|(form, square, slope)| Atom::Form {
            form,
            square,
            slope,
        });
        Ok(Some(atoms.collect()))
    }

    /// Takes `square l^2/2 + slope l` away.
    fn take(
        &mut self,
        form: &Form,
        square: &Fraction,
        slope: &Fraction,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        for (i, v) in form {
            let first = slope.mul(v, budget)?;
            self.slope[*i] = self.slope[*i].sub(&first, budget)?;
            for (j, w) in form {
                let second = square.mul(v, budget)?.mul(w, budget)?;
                self.square[*i][*j] = self.square[*i][*j].sub(&second, budget)?;
            }
        }
        Ok(())
    }

    /// What is left, as terms.
    fn rest(self, graph: &mut Graph) -> Vec<ExprId> {
        let mut terms = self.others;
        let mut push = |graph: &mut Graph, factor: &Fraction, product: ExprId| {
            if !factor.is_zero() {
                let factor = graph.rational_function(factor);
                terms.push(graph.mul(factor, product));
            }
        };
        let n = self.slope.len();
        for i in 0..n {
            let x = graph.symbol(Symbol::Coordinate(i));
            push(graph, &self.slope[i], x);
            for j in i..n {
                let y = graph.symbol(Symbol::Coordinate(j));
                let product = graph.mul(x, y);
                let scale = Rational::new(1, if i == j { 2 } else { 1 }).unwrap_or(Rational::ONE);
                push(graph, &self.square[i][j].scale(&scale), product);
            }
        }
        terms
    }
}

/// The absolute value of a function of the parameters at their defaults, where it has one and is not zero.
fn size(value: &Fraction, defaults: &[Option<Rational>]) -> Option<Rational> {
    let known = |p: usize| defaults.get(p).cloned().flatten();
    let polynomials = std::iter::once(value.numerator()).chain(value.denominator().map(|(f, _)| f));
    let mut monomials = polynomials
        .flat_map(|p| p.terms())
        .map(|(monomial, _)| monomial);
    if monomials.any(|monomial| monomial.powers().any(|(p, _)| known(p).is_none())) {
        return None;
    }
    let at = value.evaluate(&|p| known(p).unwrap_or(Rational::ZERO));
    at.map(|value| value.abs()).filter(|value| !value.is_zero())
}

/// A term as a factor and powers of coordinates, in ascending order; `None` where it is of another form.
fn monomial(graph: &mut Graph, term: ExprId) -> Option<(Fraction, Vec<(usize, u32)>)> {
    let (scale, term) = graph.coefficient(term);
    let factors = match graph.node(term) {
        Node::Product(factors) => factors.to_vec(),
        _ => vec![(term, Rational::ONE)],
    };
    let (mut powers, mut rest) = (Vec::new(), Vec::new());
    for (base, exponent) in factors {
        match graph.node(base) {
            Node::Symbol(Symbol::Coordinate(i)) => {
                let power = u32::try_from(exponent.to_integer()?).ok()?;
                powers.push((*i, power));
            }
            _ => rest.push((base, exponent)),
        }
    }
    let rest = graph.power_product(&rest);
    let factor = graph.fraction(rest, None)?.scale(&scale);
    powers.sort_unstable();
    Some((factor, powers))
}
