//! The declared system in its own coordinates, or in those that constraints leave.
//!
//! With constraints a state is the part `m_f = <mu, e_f>` of mu that sees no reaction. The rest follows from the constraints, which H
//! satisfies where it is stationary along their forms; the bracket is that of the declared coordinates between the elements e_f.

use crate::derivatives::{derivatives, directions};
use crate::interpret::Scope;
use crate::linear::{self, Rows, times};
use crate::number::Number;
use crate::system::Declared;
use lie_codegen::model::configuration::Configuration;

impl Declared {
    /// The number of components of mu as they were declared.
    fn own(&self) -> usize {
        let state = self.declaration.state.len();
        let configuration = self.configuration.as_ref();
        configuration.map_or(state, Configuration::own_momenta)
    }

    /// The names at a state.
    pub(super) fn state(&self, mu: &[Number]) -> Scope {
        match self.determined.is_empty() {
            true => self.declared_state(mu),
            false => self.declared_state(&self.on_constraint(mu)),
        }
    }

    /// The energy as it was declared; of a Lagrangian `<mu, xi> - l(xi)` with `l'(xi) = mu`, xi near `velocity`.
    pub(super) fn energy(&self, mu: &[Number], velocity: &[f64]) -> Number {
        match self.determined.is_empty() {
            true => self.declared_energy(mu, velocity),
            false => self.declared_energy(&self.on_constraint(mu), &[]),
        }
    }

    /// The energy with the momentum of the time.
    pub(super) fn hamiltonian(&self, mu: &[Number], velocity: &[f64]) -> Number {
        let energy = self.energy(mu, velocity);
        match &self.configuration {
            Some(configuration) if configuration.time => {
                let momentum = configuration.momenta - 1 - self.determined.len();
                energy.add(&mu[momentum])
            }
            _ => energy,
        }
    }

    /// The Poisson matrix; with constraints `E^T Pi E`, where the columns of E are the elements that are left.
    pub(super) fn poisson(&self, mu: &[Number]) -> Rows {
        if self.determined.is_empty() {
            return self.declared_poisson(mu);
        }
        let declared = self.declared_poisson(&self.on_constraint(mu));
        let forms = self.reduced_forms();
        let columns: Rows = self
            .kept()
            .map(|index| {
                let mut column = vec![Number::integer(0); declared.len()];
                column[index] = Number::integer(1);
                for (pivot, form) in self.determined.iter().zip(&forms) {
                    if let Some(ratio) = form.get(index) {
                        column[*pivot] = ratio.neg();
                    }
                }
                column
            })
            .collect();
        let each = |rows: &Rows| -> Rows { columns.iter().map(|c| times(rows, c)).collect() };
        each(&each(&declared))
    }

    /// The declared coordinates to which those of the state belong.
    fn kept(&self) -> impl Iterator<Item = usize> {
        let all = 0..self.declared_dimension();
        all.filter(|index| !self.determined.contains(index))
    }

    /// The forms of the constraints, each with 1 at its own component and 0 at those of the others.
    fn reduced_forms(&self) -> Rows {
        let own = self.own();
        let rest = vec![Number::integer(0); self.declared_dimension()];
        let rows = self.declaration.constraint.iter().map(|constraint| {
            let coefficient = |i: usize| {
                let unit = |k: usize| Number::integer(i32::from(i == k));
                let unit: Vec<Number> = (0..own).map(unit).collect();
                let mut scope = self.coordinates(&rest);
                if self.declaration.energy.velocity().is_empty() {
                    self.abbreviate(&mut scope);
                    for (name, value) in self.declaration.basis().iter().zip(&unit) {
                        scope.bind(&name.text, value.clone());
                    }
                } else {
                    self.bind_velocity(&mut scope, &unit);
                    self.abbreviate(&mut scope);
                }
                let left = scope.evaluate(&constraint.left);
                left.sub(&scope.evaluate(&constraint.right))
            };
            (0..own).map(coefficient).collect()
        });
        let rows: Rows = rows.collect();
        let square = |row: &Vec<Number>| -> Vec<Number> {
            let pivots = self.determined.iter();
            pivots.map(|pivot| row[*pivot].clone()).collect()
        };
        linear::solve(rows.iter().map(square).collect(), rows)
    }

    /// The state in the declared coordinates: `mu_f = m_f + sum_p R_pf nu_p` with multipliers `nu_p = mu_p` at which H is stationary. H is
    /// quadratic in them, so that one step of Newton's iteration from 0 finds them.
    fn on_constraint(&self, mu: &[Number]) -> Vec<Number> {
        let forms = self.reduced_forms();
        let mut start = vec![Number::integer(0); self.declared_dimension()];
        for (index, value) in self.kept().zip(mu) {
            start[index] = value.clone();
        }
        let count = self.determined.len();
        let zero = vec![Number::integer(0); count];
        let (slope, second) = derivatives(&zero, directions(mu), |nu| {
            let mut state = start.clone();
            for (nu, form) in nu.iter().zip(&forms) {
                for (entry, ratio) in state.iter_mut().zip(form) {
                    *entry = entry.add(&ratio.mul(nu));
                }
            }
            self.declared_energy(&state, &[])
        });
        let right = slope.iter().map(|slope| vec![slope.neg()]).collect();
        let nu = linear::solve(second, right);
        for (nu, form) in nu.iter().zip(&forms) {
            for (entry, ratio) in start.iter_mut().zip(form) {
                *entry = entry.add(&ratio.mul(&nu[0]));
            }
        }
        start
    }
}
