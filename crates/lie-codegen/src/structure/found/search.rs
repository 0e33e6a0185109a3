//! The ways to take a Hamiltonian apart.

use super::atoms::{Atom, Commuting};
use super::congruence::{Order, Quadratic};
use super::invariants::Invariant;
use super::{Classified, additive, casimirs, colouring, recognition};
use crate::model::Model;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::symbolic::{ExprId, Graph};

/// What work is left.
#[derive(Clone, Copy)]
pub(super) struct Work<'a> {
    pub forms: &'a Budget,
    pub colouring: &'a Budget,
}

/// The search for one Hamiltonian.
pub(super) struct Search<'a> {
    pub model: &'a Model,
    pub commuting: Commuting<'a>,
    pub invariants: &'a [Invariant],
    pub work: Work<'a>,
}

impl Search<'_> {
    /// All ways that are looked at.
    pub fn ways(&self, graph: &mut Graph, start: ExprId) -> Vec<Classified> {
        let of_algebra: Vec<Invariant> = self
            .invariants
            .iter()
            .filter(|known| known.moved.is_empty())
            .cloned()
            .collect();
        let mut starts = vec![start];
        for known in [&of_algebra[..], self.invariants] {
            if let Some(value) = recognition::substitute_casimirs(graph, start, known)
                && !starts.contains(&value)
            {
                starts.push(value);
            }
        }
        let quadratic = |of: &dyn Fn(&Invariant) -> bool| -> Vec<&Invariant> {
            let all = self.invariants.iter();
            all.filter(|known| known.quadratic && of(known)).collect()
        };
        let own = quadratic(&|known| known.moved.is_empty());
        let inner = quadratic(&|known| !known.moved.is_empty());
        let mut values = Vec::new();
        for start in starts {
            let mut reached = vec![start];
            for casimirs in [&own, &inner] {
                for value in reached.clone() {
                    let known = (value, &casimirs[..]);
                    let less = casimirs::subtract_casimirs(
                        self.model,
                        &self.commuting,
                        graph,
                        known,
                        self.work,
                    );
                    reached.extend(less);
                }
            }
            for value in reached {
                if !values.contains(&value) {
                    values.push(value);
                }
            }
        }
        let mut all = Vec::new();
        for value in values {
            let rest = self.rest(graph, start, value);
            for mut atoms in self.variants(graph, value) {
                let count = atoms.len();
                atoms.retain(|atom| !self.commuting.is_casimir(atom));
                let classes = classes(&self.commuting, &atoms, self.work);
                all.push(Classified {
                    count: colouring::count(&classes),
                    rest,
                    whole: rest.is_none() && atoms.len() == count,
                    atoms,
                    classes,
                });
            }
        }
        all
    }

    /// A function with Casimirs in the place of their symbols, where that is not H.
    fn rest(&self, graph: &mut Graph, start: ExprId, value: ExprId) -> Option<ExprId> {
        let value = graph.substitute(&[value], &|symbol| {
            let of = |known: &&Invariant| known.symbol == symbol;
            self.invariants.iter().find(of).map(|known| known.value)
        });
        let value = graph.normal(value[0]);
        let difference = graph.sub(value, start);
        let terms = additive::terms(graph, difference);
        terms.is_none_or(|terms| !terms.is_empty()).then_some(value)
    }

    /// The ways to take a function apart into functions of quantities that commute.
    fn variants(&self, graph: &mut Graph, value: ExprId) -> Vec<Vec<Atom>> {
        let commuting = &self.commuting;
        let Some(terms) = additive::terms(graph, value) else {
            return Vec::new();
        };
        let mut all = Vec::new();
        let plain = commuting.by_arguments(graph, &terms);
        let fits = |atoms: &[Atom]| {
            atoms.iter().all(|atom| match atom {
                Atom::Function(set, _) => commuting.mixed(set).is_empty(),
                Atom::Form { .. } => true,
            })
        };
        if fits(&plain) {
            all.push(plain);
        }
        let n = self.model.dimension();
        let Some(quadratic) = Quadratic::from_terms(graph, &terms, n, self.work.forms) else {
            return all;
        };
        if let Some((form, others)) = quadratic.linear_part(graph) {
            let mut atoms = commuting.by_arguments(graph, &others);
            atoms.push(form);
            if fits(&atoms) {
                all.push(atoms);
            }
        }
        let default = |p: &crate::model::Parameter| Rational::from_f64(p.default_value);
        let defaults: Vec<Option<Rational>> = self.model.parameters.iter().map(default).collect();
        for order in [Order::Entangled, Order::Last] {
            let work = self.work.forms;
            let squares = quadratic
                .clone()
                .squares(graph, commuting, &defaults, order, work);
            let Ok(Some((mut squares, others))) = squares else {
                continue;
            };
            if squares.is_empty() {
                break;
            }
            // what was put together again may cancel
            let rest = graph.sum(&others);
            let Some(others) = additive::terms(graph, rest) else {
                continue;
            };
            squares.extend(commuting.by_arguments(graph, &others));
            if fits(&squares) {
                all.push(squares);
            }
        }
        all
    }
}

/// The fewest classes of parts that commute.
pub(super) fn classes(commuting: &Commuting<'_>, atoms: &[Atom], work: Work<'_>) -> Vec<usize> {
    let conflict = |one: &Atom, other: &Atom| !commuting.commute(one, other, work.forms);
    let mut conflicts = vec![vec![false; atoms.len()]; atoms.len()];
    for (i, one) in atoms.iter().enumerate() {
        for (j, other) in atoms.iter().enumerate().skip(i + 1) {
            conflicts[i][j] = conflict(one, other);
            conflicts[j][i] = conflicts[i][j];
        }
    }
    colouring::fewest(&conflicts, work.colouring)
}
