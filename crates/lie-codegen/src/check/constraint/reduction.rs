//! The system on the subspace of a constraint.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::forms::Distribution;
use super::multipliers::{Solution, Stationary};
use super::names;
use super::tidy::{collected, collected_in};
use crate::check::coordinates::Whole;
use crate::check::energy::Declared;
use crate::check::poisson::Entry;
use crate::check::system::{System, too_large};
use crate::check::{jacobi, symbols};
use crate::model::{Configuration, Constraint, Energy, Equation, PoissonMatrix};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Declaration, Expr, ExprKind, Observable, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// A declaration and its system in the coordinates that the constraints leave. Declared coordinates that are others are observables.
pub fn reduced<'a>(
    whole: Whole<'a>,
    system: System,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<(Whole<'a>, System)> {
    let distribution = system.lowered.distribution.clone()?;
    let configuration = whole.configuration.as_ref();
    let configuration = configuration
        .and_then(|configuration| configuration.with_fewer_momenta(distribution.pivots.len()));
    let mut graph = system.scratch.clone();
    let reduction = Reduction::new(&whole.declaration, &distribution, &system, &mut graph);
    let reduction = reduction.map_err(|mistake| mistakes.push(mistake)).ok()?;
    let system = reduction.system(system, &mut graph, configuration.as_ref());
    let declaration = reduction.declaration();
    let whole = Whole {
        declaration: Cow::Owned(declaration),
        configuration,
        sums: None,
    };
    mistakes.extend(too_large(&whole.declaration, &system));
    (!crate::check::has_errors(mistakes)).then_some((whole, system))
}

/// What the constraints make of the coordinates.
struct Reduction<'a> {
    declared: &'a Declaration,
    distribution: &'a Distribution,
    /// Each declared coordinate in the reduced ones.
    momenta: Vec<ExprId>,
    /// The Hamiltonian, without the momentum of the time.
    energy: ExprId,
    /// `(i, c)` of `e_alpha = sum_i c e_i` for every reduced coordinate; of those beside mu a unit vector.
    columns: Vec<Vec<(usize, ExprId)>>,
    forms: Vec<String>,
}

impl<'a> Reduction<'a> {
    fn new(
        declared: &'a Declaration,
        distribution: &'a Distribution,
        system: &System,
        graph: &mut Graph,
    ) -> Result<Self, Diagnostic> {
        let origin = declared.energy.expression().origin;
        if let Energy::Legendre(..) = &system.energy {
            let message = "beside a constraint a Lagrangian is quadratic in the velocity, and this one is not shown to be";
            return Err(Diagnostic::new(Kind::Constraint, origin, message)
                .help("write its kinetic energy as a quadratic form in the velocity"));
        }
        let energy = system.energy.value(|energy| energy.energy);
        let ratios: Vec<Vec<ExprId>> = distribution
            .ratios
            .iter()
            .map(|row| row.iter().map(|r| graph.rational_function(r)).collect())
            .collect();
        // mu_f = m_f + sum_p R_pf nu_p and mu_p = nu_p, each at the place of its index
        let raised: Vec<ExprId> = distribution
            .free
            .iter()
            .enumerate()
            .map(|(place, index)| {
                let mut terms = vec![graph.symbol(Symbol::Coordinate(*index))];
                for (pivot, row) in distribution.pivots.iter().zip(&ratios) {
                    let nu = graph.symbol(Symbol::Coordinate(*pivot));
                    terms.push(graph.mul(row[place], nu));
                }
                graph.sum(&terms)
            })
            .collect();
        let free = |i: usize| distribution.free.iter().position(|f| *f == i);
        let lifted = graph.substitute(&[energy], &|symbol| match symbol {
            Symbol::Coordinate(i) => Some(raised[free(i)?]),
            _ => None,
        });
        let forms = names::forms(declared, distribution);
        let defaults = system.lowered.parameters.iter();
        let defaults: Vec<f64> = defaults.map(|p| p.default_value).collect();
        let stationary = Stationary {
            energy: lifted[0],
            multipliers: &distribution.pivots,
            origin,
            forms: &forms,
            defaults: &defaults,
        };
        let Solution {
            multipliers,
            energy,
            mixed,
        } = stationary.solve(graph)?;
        let energy = collected_in(graph, energy, &mixed);
        // the multipliers, then the places of the reduced coordinates
        let pivot = |i: usize| distribution.pivots.iter().position(|p| *p == i);
        let n = declared.state.len();
        let mut momenta = Vec::new();
        for i in 0..n {
            let value = match (free(i), pivot(i)) {
                (Some(place), _) => raised[place],
                (_, Some(place)) => multipliers[place],
                _ => graph.symbol(Symbol::Coordinate(i)),
            };
            let solved = graph.substitute(&[value], &|symbol| match symbol {
                Symbol::Coordinate(i) => Some(multipliers[pivot(i)?]),
                _ => None,
            });
            momenta.push(collected(graph, solved[0]));
        }
        let kept: Vec<usize> = (0..n).filter(|i| pivot(*i).is_none()).collect();
        let renumbered = |graph: &mut Graph, roots: &[ExprId]| {
            let new: BTreeMap<usize, ExprId> = kept
                .iter()
                .enumerate()
                .map(|(new, old)| (*old, graph.symbol(Symbol::Coordinate(new))))
                .collect();
            graph.substitute(roots, &|symbol| match symbol {
                Symbol::Coordinate(i) => new.get(&i).copied(),
                _ => None,
            })
        };
        let momenta = renumbered(graph, &momenta);
        let energy = renumbered(graph, &[energy])[0];
        let one = graph.integer(1);
        let columns = kept.iter().map(|index| {
            let mut column = vec![(*index, one)];
            if let Some(place) = free(*index) {
                for (pivot, row) in distribution.pivots.iter().zip(&ratios) {
                    if !graph.is_zero(row[place]) {
                        column.push((*pivot, graph.neg(row[place])));
                    }
                }
            }
            column.sort_unstable_by_key(|(i, _)| *i);
            column
        });
        let columns = columns.collect();
        Ok(Self {
            declared,
            distribution,
            momenta,
            energy,
            columns,
            forms,
        })
    }

    /// The declared coordinates of mu that are none of the reduced ones.
    fn others(&self) -> impl Iterator<Item = usize> {
        (0..self.own()).filter(|index| {
            let mut free = self.distribution.free.iter();
            free.position(|f| f == index).is_none_or(|place| {
                let mut ratios = self.distribution.ratios.iter();
                ratios.any(|row| !row[place].is_zero())
            })
        })
    }

    /// Functions of the declared coordinates as functions of the reduced ones.
    fn restricted(&self, graph: &mut Graph, functions: &[ExprId]) -> Vec<ExprId> {
        let restricted = graph.substitute(functions, &|symbol| match symbol {
            Symbol::Coordinate(i) => self.momenta.get(i).copied(),
            _ => None,
        });
        let restricted = restricted.into_iter();
        restricted.map(|f| collected(graph, f)).collect()
    }

    /// `E^T Pi E` at `mu(m)`.
    fn matrix(&self, system: &System, graph: &mut Graph) -> Vec<Entry> {
        let rows = system.matrix.rows(graph);
        let mut entries = Vec::new();
        for (row, left) in self.columns.iter().enumerate() {
            for (column, right) in self.columns.iter().enumerate().skip(row + 1) {
                let mut terms = Vec::new();
                for (i, a) in left {
                    for (j, b) in right {
                        terms.push(graph.product(&[*a, rows[*i][*j], *b]));
                    }
                }
                let sum = graph.sum(&terms);
                let value = self.restricted(graph, &[sum])[0];
                if !graph.is_zero(value) {
                    entries.push(Entry {
                        row,
                        column,
                        value,
                        origin: self.distribution.origin,
                    });
                }
            }
        }
        entries
    }

    /// The system in the reduced coordinates.
    fn system(
        &self,
        mut system: System,
        graph: &mut Graph,
        configuration: Option<&Configuration>,
    ) -> System {
        let brackets = self.matrix(&system, graph);
        let entries = brackets.iter().map(|e| (e.row, e.column, e.value));
        let matrix = PoissonMatrix {
            dimension: self.columns.len(),
            entries: entries.collect(),
            degree: None,
        };
        let value = match configuration {
            Some(configuration) if configuration.time => {
                let momentum = graph.symbol(Symbol::Coordinate(configuration.momenta - 1));
                graph.add(self.energy, momentum)
            }
            _ => self.energy,
        };
        let lowered = &mut system.lowered;
        for functions in [
            &mut lowered.casimirs,
            &mut lowered.integrals,
            &mut lowered.observables,
            &mut lowered.events,
        ] {
            *functions = self.restricted(graph, functions);
        }
        let others: Vec<ExprId> = self.others().map(|i| self.momenta[i]).collect();
        lowered.observables.splice(0..0, others);
        let constraint = self.constraint(graph, &brackets, lowered.initial.as_deref());
        if let Some(initial) = &lowered.initial
            && initial.len() == self.momenta.len()
        {
            let state = self.columns.iter().map(|column| {
                let mut terms = Vec::new();
                for (i, value) in column {
                    terms.push(graph.mul(*value, initial[*i]));
                }
                graph.sum(&terms)
            });
            lowered.initial = Some(state.collect());
        }
        lowered.brackets = brackets;
        lowered.graph = graph.clone();
        System {
            scratch: graph.clone(),
            algebra: None,
            matrix,
            energy: Energy::Expression(Declared {
                value,
                energy: self.energy,
            }),
            driving: None,
            constraint: Some(constraint),
            ..system
        }
    }

    /// The number of coordinates of mu as it was declared.
    fn own(&self) -> usize {
        self.distribution.free.len() + self.distribution.pivots.len()
    }

    fn constraint(
        &self,
        graph: &mut Graph,
        brackets: &[Entry],
        declared_initial: Option<&[ExprId]>,
    ) -> Constraint {
        let dimension = self.distribution.free.len();
        let basis: Vec<Vec<(usize, ExprId)>> = self.columns[..dimension].to_vec();
        let mut velocity = vec![Vec::new(); self.own()];
        for (alpha, column) in basis.iter().enumerate() {
            let slope = graph.derivative(self.energy, Symbol::Coordinate(alpha));
            for (i, value) in column {
                velocity[*i].push(graph.mul(*value, slope));
            }
        }
        let velocity = velocity.iter().map(|terms| {
            let sum = graph.sum(terms);
            collected(graph, sum)
        });
        let velocity = velocity.collect();
        let reduced = self.declaration();
        let name = |symbol| symbols::symbol_name(&reduced, symbol);
        let texts = names::declared(self.declared, self.distribution);
        let equations = texts.into_iter().zip(&self.distribution.declared);
        let equations = equations.map(|(text, row)| Equation {
            text,
            coefficients: row.iter().map(|c| graph.rational_function(c)).collect(),
        });
        Constraint {
            forms: self.forms.clone(),
            equations: equations.collect(),
            declared: self.declared.state.clone(),
            components: names::components(self.declared)[..self.own()].to_vec(),
            elements: self.declared.basis()[..self.own()]
                .iter()
                .map(|name| name.text.clone())
                .collect(),
            basis,
            momenta: self.momenta.clone(),
            velocity,
            determined: self.distribution.pivots.clone(),
            declared_initial: declared_initial
                .filter(|initial| initial.len() == self.momenta.len())
                .map(<[ExprId]>::to_vec),
            jacobi: jacobi::holds(reduced.state.len(), brackets, &mut graph.clone(), &name),
        }
    }

    /// The declaration with the reduced coordinates.
    fn declaration(&self) -> Declaration {
        let mut reduced = self.declared.clone();
        let mut state = names::reduced(self.declared, self.distribution);
        state.extend_from_slice(&self.declared.state[self.own()..]);
        let others = self.others().map(|index| &self.declared.state[index]);
        let others = others.map(|name| Observable {
            name: name.clone(),
            value: Expr {
                kind: ExprKind::Name {
                    name: name.text.clone(),
                    index: None,
                },
                origin: name.origin,
            },
            unwrap: false,
        });
        let others: Vec<Observable> = others.collect();
        reduced.observables.splice(0..0, others);
        reduced.structure = Structure::General {
            brackets: Vec::new(),
            origin: self.distribution.origin,
        };
        if let Some(initial) = &mut reduced.initial
            && initial.len() == self.declared.state.len()
        {
            let mut place = 0..;
            initial.retain(|_| {
                !self
                    .distribution
                    .pivots
                    .contains(&place.next().unwrap_or(0))
            });
        }
        reduced.state = state;
        reduced
    }
}
