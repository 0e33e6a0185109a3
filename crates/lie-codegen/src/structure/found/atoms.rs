//! What pieces are put together from: functions of linear forms that commute, and of Casimirs of subalgebras that commute with them.

use std::collections::BTreeSet;

use super::invariants::{self, Invariant};
use crate::model::Algebra;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// A linear form `l = sum_i v_i x_i` by the entries of v that do not vanish: the element v of the algebra.
pub(super) type Form = Vec<(usize, Fraction)>;

/// A part of H that is a function of quantities that commute, so that they are constant along its flow.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// A sum of terms in the same arguments: i below the dimension n is a coordinate, n + k the invariant k.
    Function(BTreeSet<usize>, Vec<ExprId>),
    /// `square l^2/2 + slope l`
    Form {
        form: Form,
        square: Fraction,
        slope: Fraction,
    },
}

impl Atom {
    /// Its terms.
    pub(super) fn terms(&self, graph: &mut Graph) -> Vec<ExprId> {
        let Self::Form {
            form,
            square,
            slope,
        } = self
        else {
            let Self::Function(_, terms) = self else {
                return Vec::new();
            };
            return terms.clone();
        };
        let l = linear(graph, form);
        let two = Rational::from(2);
        let mut terms = Vec::new();
        if !square.is_zero() {
            let factor = graph.rational_function(square);
            let power = graph.pow(l, &two);
            let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
            let term = graph.mul(factor, power);
            terms.push(graph.scale(term, &half));
        }
        if !slope.is_zero() {
            let factor = graph.rational_function(slope);
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
        let factor = graph.rational_function(value);
        let x = graph.symbol(Symbol::Coordinate(*i));
        terms.push(graph.mul(factor, x));
    }
    graph.sum(&terms)
}

/// Which coordinates and invariants commute.
#[derive(Clone, Debug)]
pub(super) struct Commuting<'a> {
    algebra: &'a Algebra,
    /// Which symbols stand for invariants.
    symbols: Vec<Symbol>,
    /// Pairs of arguments that do not.
    pairs: Vec<Vec<bool>>,
}

impl<'a> Commuting<'a> {
    pub(super) fn new(algebra: &'a Algebra, graph: &mut Graph, invariants: &[Invariant]) -> Self {
        let n = algebra.basis.len();
        let size = n + invariants.len();
        let mut pairs = vec![vec![false; size]; size];
        let mut conflict = |i: usize, j: usize| {
            pairs[i][j] = true;
            pairs[j][i] = true;
        };
        for (i, j, ..) in algebra.exact.entries() {
            conflict(*i, *j);
        }
        for (k, invariant) in invariants.iter().enumerate() {
            for i in &invariant.moved {
                conflict(n + k, *i);
            }
            for (l, other) in invariants.iter().enumerate().take(k) {
                if !invariants::commute(algebra, graph, invariant, other) {
                    conflict(n + k, n + l);
                }
            }
        }
        Self {
            algebra,
            symbols: invariants.iter().map(|known| known.symbol).collect(),
            pairs,
        }
    }

    /// Number of coordinates.
    fn dimension(&self) -> usize {
        self.algebra.basis.len()
    }

    /// Whether two arguments do not commute.
    pub(super) fn conflict(&self, i: usize, j: usize) -> bool {
        self.pairs[i][j]
    }

    /// With how many other coordinates a coordinate does not commute.
    pub(super) fn degree(&self, i: usize) -> usize {
        let row = self.pairs[i].iter().take(self.dimension());
        row.filter(|conflict| **conflict).count()
    }

    /// Whether an argument generates no flow.
    fn is_central(&self, i: usize) -> bool {
        !self.pairs[i].contains(&true)
    }

    /// The arguments of an atom; of a form those in it.
    fn arguments(atom: &Atom) -> Vec<usize> {
        match atom {
            Atom::Function(set, _) => set.iter().copied().collect(),
            Atom::Form { form, .. } => form.iter().map(|(i, _)| *i).collect(),
        }
    }

    /// Whether an atom generates no flow.
    pub(super) fn is_idle(&self, atom: &Atom) -> bool {
        let mut arguments = Self::arguments(atom).into_iter();
        arguments.all(|i| self.is_central(i))
    }

    /// Whether an atom is a function of Casimirs of the algebra alone.
    pub(super) fn is_casimir(&self, atom: &Atom) -> bool {
        let mut arguments = Self::arguments(atom).into_iter();
        arguments.all(|i| i >= self.dimension() && self.is_central(i))
    }

    /// The pairs of arguments in a set that do not commute.
    pub(super) fn mixed(&self, arguments: &BTreeSet<usize>) -> Vec<(usize, usize)> {
        let pairs = arguments
            .iter()
            .flat_map(|i| arguments.range(i + 1..).map(move |j| (*i, *j)));
        pairs.filter(|(i, j)| self.conflict(*i, *j)).collect()
    }

    /// Whether two atoms commute.
    pub(super) fn commute(&self, one: &Atom, other: &Atom, budget: &Budget) -> bool {
        let (left, right) = (Self::arguments(one), Self::arguments(other));
        let pairwise = left
            .iter()
            .all(|i| right.iter().all(|j| !self.conflict(*i, *j)));
        if pairwise {
            return true;
        }
        let (Some(left), Some(right)) = (self.forms(one), self.forms(other)) else {
            return false;
        };
        left.iter().all(|v| {
            right
                .iter()
                .all(|w| self.bracket_vanishes(v, w, budget).unwrap_or(false))
        })
    }

    /// The forms of which an atom is a function; `None` where it is one of invariants too.
    fn forms(&self, atom: &Atom) -> Option<Vec<Form>> {
        match atom {
            Atom::Function(set, _) => set
                .iter()
                .map(|i| (*i < self.dimension()).then(|| unit(*i)))
                .collect(),
            Atom::Form { form, .. } => Some(vec![form.clone()]),
        }
    }

    fn bracket_vanishes(&self, v: &Form, w: &Form, budget: &Budget) -> Result<bool, Exhausted> {
        let n = self.dimension();
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

    /// Terms by the arguments that they contain.
    pub(super) fn by_arguments(&self, graph: &Graph, terms: &[ExprId]) -> Vec<Atom> {
        let mut sets: Vec<(BTreeSet<usize>, Vec<ExprId>)> = Vec::new();
        for &term in terms {
            let symbols = graph.symbols(term).into_iter();
            let arguments = symbols.filter_map(|symbol| match symbol {
                Symbol::Coordinate(i) => Some(i),
                other => {
                    let place = self.symbols.iter().position(|known| *known == other);
                    place.map(|k| self.dimension() + k)
                }
            });
            let set: BTreeSet<usize> = arguments.collect();
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
            .map(|(set, terms)| Atom::Function(set, terms))
            .collect()
    }
}
