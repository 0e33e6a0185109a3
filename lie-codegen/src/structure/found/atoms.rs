//! What pieces are put together from: functions of linear forms that commute.

use std::collections::BTreeSet;

use crate::check::expression;
use crate::exact::{Budget, Exhausted, Fraction, Rational};
use crate::model::Algebra;
use crate::symbolic::{ExprId, Graph, Symbol};

/// A linear form `l = sum_i v_i x_i` by the entries of v that do not vanish: the element v of the algebra.
pub(super) type Form = Vec<(usize, Fraction)>;

/// A part of H that is a function of linear forms whose elements commute, so that they and its gradient are constant
/// along its flow.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// A sum of terms in the same coordinates.
    Coordinates(BTreeSet<usize>, Vec<ExprId>),
    /// `square l^2/2 + slope l`
    Form {
        form: Form,
        square: Fraction,
        slope: Fraction,
    },
}

impl Atom {
    /// The forms of which it is a function.
    pub(super) fn forms(&self) -> Vec<Form> {
        match self {
            Self::Coordinates(coordinates, _) => coordinates.iter().map(|i| unit(*i)).collect(),
            Self::Form { form, .. } => vec![form.clone()],
        }
    }

    /// Its terms.
    pub(super) fn terms(&self, graph: &mut Graph) -> Vec<ExprId> {
        let Self::Form {
            form,
            square,
            slope,
        } = self
        else {
            let Self::Coordinates(_, terms) = self else {
                return Vec::new();
            };
            return terms.clone();
        };
        let l = linear(graph, form);
        let two = Rational::from(2);
        let mut terms = Vec::new();
        if !square.is_zero() {
            let factor = expression(graph, square);
            let power = graph.pow(l, &two);
            let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
            let term = graph.mul(factor, power);
            terms.push(graph.scale(term, &half));
        }
        if !slope.is_zero() {
            let factor = expression(graph, slope);
            terms.push(graph.mul(factor, l));
        }
        terms
    }
}

/// The form that is a coordinate.
pub(super) fn unit(i: usize) -> Form {
    vec![(i, Fraction::from(Rational::ONE))]
}

/// A form as an expression.
pub(super) fn linear(graph: &mut Graph, form: &Form) -> ExprId {
    let mut terms = Vec::new();
    for (i, value) in form {
        let factor = expression(graph, value);
        let x = graph.symbol(Symbol::Coordinate(*i));
        terms.push(graph.mul(factor, x));
    }
    graph.sum(&terms)
}

/// Which elements commute.
#[derive(Clone, Debug)]
pub(super) struct Commuting<'a> {
    algebra: &'a Algebra,
    /// Pairs of basis elements that do not.
    pairs: Vec<Vec<bool>>,
}

impl<'a> Commuting<'a> {
    pub(super) fn of(algebra: &'a Algebra) -> Self {
        let n = algebra.basis.len();
        let mut pairs = vec![vec![false; n]; n];
        for (i, j, ..) in algebra.exact.entries() {
            pairs[*i][*j] = true;
            pairs[*j][*i] = true;
        }
        Self { algebra, pairs }
    }

    /// Whether two basis elements do not commute.
    pub(super) fn conflict(&self, i: usize, j: usize) -> bool {
        self.pairs[i][j]
    }

    /// With how many others a basis element does not commute.
    pub(super) fn degree(&self, i: usize) -> usize {
        self.pairs[i].iter().filter(|conflict| **conflict).count()
    }

    /// Whether a basis element acts as zero.
    pub(super) fn is_central(&self, i: usize) -> bool {
        !self.pairs[i].contains(&true)
    }

    /// Whether an atom contains central coordinates alone.
    pub(super) fn is_idle(&self, atom: &Atom) -> bool {
        let entries = atom.forms().into_iter().flatten();
        entries.map(|(i, _)| i).all(|i| self.is_central(i))
    }

    /// The pairs of coordinates in a set that do not commute.
    pub(super) fn mixed(&self, coordinates: &BTreeSet<usize>) -> Vec<(usize, usize)> {
        let pairs = coordinates
            .iter()
            .flat_map(|i| coordinates.range(i + 1..).map(move |j| (*i, *j)));
        pairs.filter(|(i, j)| self.conflict(*i, *j)).collect()
    }

    /// Whether functions of some forms and of others commute.
    pub(super) fn commute(&self, one: &Atom, other: &Atom, budget: &Budget) -> bool {
        if let (Atom::Coordinates(one, _), Atom::Coordinates(other, _)) = (one, other) {
            return one
                .iter()
                .all(|i| other.iter().all(|j| !self.conflict(*i, *j)));
        }
        let (one, other) = (one.forms(), other.forms());
        one.iter().all(|v| {
            other
                .iter()
                .all(|w| self.bracket_vanishes(v, w, budget).unwrap_or(false))
        })
    }

    fn bracket_vanishes(&self, v: &Form, w: &Form, budget: &Budget) -> Result<bool, Exhausted> {
        let n = self.pairs.len();
        let entry = |form: &Form, i: usize| {
            let found = form.iter().find(|(j, _)| *j == i);
            found.map(|(_, value)| value.clone())
        };
        let mut bracket = vec![Fraction::default(); n];
        for (i, j, k, constant) in self.algebra.exact.entries() {
            for (i, j, sign) in [(*i, *j, Rational::ONE), (*j, *i, Rational::MINUS_ONE)] {
                let (Some(a), Some(b)) = (entry(v, i), entry(w, j)) else {
                    continue;
                };
                let term = a.mul(&b, budget)?.mul(constant, budget)?.scale(&sign);
                bracket[*k] = bracket[*k].add(&term, budget)?;
            }
        }
        Ok(bracket.iter().all(Fraction::is_zero))
    }
}

/// Terms by the coordinates that they contain.
pub(super) fn by_coordinates(graph: &Graph, terms: &[ExprId]) -> Vec<Atom> {
    let mut sets: Vec<(BTreeSet<usize>, Vec<ExprId>)> = Vec::new();
    for &term in terms {
        let set: BTreeSet<usize> = graph.coordinates(term).into_iter().collect();
        if set.is_empty() {
            continue;
        }
        match sets.iter_mut().find(|(known, _)| *known == set) {
            Some((_, terms)) => terms.push(term),
            None => sets.push((set, vec![term])),
        }
    }
    sets.sort_by(|(one, _), (other, _)| one.cmp(other));
    let atoms = sets.into_iter();
    atoms
        .map(|(set, terms)| Atom::Coordinates(set, terms))
        .collect()
}
