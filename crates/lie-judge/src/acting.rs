//! What acts beside the Hamiltonian, as it was written: forces, dissipation, inputs and noise.

use crate::interpret::Scope;
use crate::number::Number;
use crate::system::Declared;
use lie_codegen::model::configuration::Configuration;
use lie_syntax::ast::{DissipationKind, Expr, Metric, Noise, Structure};

impl Declared {
    /// What forces and dissipation add to the field: `F - R grad H + K grad S + c Pi G Pi grad H`, and along the momentum of the time
    /// minus what that does to H; `None` where nothing is declared.
    pub(super) fn driven<T: Number>(&self, mu: &[T], velocity: &[f64]) -> Option<Vec<T>> {
        let declaration = &self.declaration;
        let configuration = self
            .configuration
            .as_ref()
            .filter(|_| declaration.is_driven())?;
        let own = configuration.own_momenta();
        let mut extra = vec![T::integer(0); mu.len()];
        let slopes = self.gradient(mu, |mu| self.hamiltonian(mu, velocity));
        let poisson = self.poisson(mu);
        let scope = self.state(mu);
        let matrix = |rows: &[Vec<Expr>]| -> Vec<Vec<T>> {
            let row = |row: &Vec<Expr>| row.iter().map(|entry| scope.evaluate(entry)).collect();
            rows.iter().map(row).collect()
        };
        let times = |rows: &[Vec<T>], vector: &[T]| -> Vec<T> {
            let row = |row: &Vec<T>| T::sum(row.iter().zip(vector).map(|(a, b)| a.mul(b)));
            rows.iter().map(row).collect()
        };
        let mut add = |values: Vec<T>| {
            for (slot, value) in extra.iter_mut().zip(values).take(own) {
                *slot = slot.add(&value);
            }
        };
        let mut forces = vec![T::integer(0); own];
        for (name, value) in &declaration.forces {
            let place = declaration.state.iter().position(|c| c.text == name.text);
            if let Some(slot) = place.and_then(|place| forces.get_mut(place)) {
                *slot = scope.evaluate(value);
            }
        }
        add(forces);
        for dissipation in &declaration.dissipation {
            add(match &dissipation.kind {
                DissipationKind::Rayleigh { matrix: rows } => {
                    let drag = times(&matrix(rows), &slopes);
                    drag.iter().map(T::neg).collect()
                }
                DissipationKind::Metriplectic { entropy, metric } => {
                    let slope = self.gradient(mu, |mu| self.function(entropy, mu));
                    match metric {
                        Metric::Entries(rows) => times(&matrix(rows), &slope),
                        Metric::Factor(rows) => {
                            let factor = matrix(rows);
                            let width = factor.first().map_or(0, Vec::len);
                            let column = |c: usize| {
                                T::sum(factor.iter().zip(&slope).map(|(row, s)| row[c].mul(s)))
                            };
                            let inner: Vec<T> = (0..width).map(column).collect();
                            times(&factor, &inner)
                        }
                    }
                }
                DissipationKind::DoubleBracket { strength, metric } => {
                    let moved = &times(&poisson, &slopes)[..own];
                    let lowered = match metric {
                        Some(rows) => times(&matrix(rows), moved),
                        None => moved.to_vec(),
                    };
                    let strength = scope.evaluate(strength);
                    let pushed: Vec<T> = lowered.iter().map(|w| strength.mul(w)).collect();
                    times(&poisson, &pushed)
                }
            });
        }
        let power = extra.iter().zip(&slopes).take(own);
        let power = T::sum(power.map(|(f, g)| f.mul(g)));
        // of an algebra the time and its momentum have the bracket of the unit
        let bracket = match declaration.structure {
            Structure::Lie { .. } => mu[configuration.clock()?.time + 1].clone(),
            Structure::General { .. } => T::integer(1),
        };
        extra[configuration.momenta - 1] = power.neg().mul(&bracket);
        self.add_noise(configuration, mu, (&poisson, &scope), &mut extra);
        Some(extra)
    }

    /// What noise adds to the field, of which the momentum of the time knows nothing.
    fn add_noise<T: Number>(
        &self,
        configuration: &Configuration,
        mu: &[T],
        (poisson, scope): (&[Vec<T>], &Scope<T>),
        extra: &mut [T],
    ) {
        let declaration = &self.declaration;
        let (n, own) = (mu.len(), configuration.own_momenta());
        let mut rates = configuration.held_places().skip(declaration.inputs.len());
        let mut rate = || {
            rates
                .next()
                .map_or(T::integer(0), |place| mu[place].clone())
        };
        let mut along = |xi: &[T]| {
            for (slot, row) in extra.iter_mut().zip(poisson) {
                let moved = T::sum(row.iter().zip(xi).map(|(a, b)| a.mul(b)));
                *slot = slot.add(&moved);
            }
        };
        let mut forces = vec![T::integer(0); n];
        for dissipation in &declaration.dissipation {
            let Some(temperature) = &dissipation.temperature else {
                continue;
            };
            let (strength, rows, is_force) = match &dissipation.kind {
                DissipationKind::DoubleBracket { strength, metric } => {
                    (scope.evaluate(strength), metric.as_ref(), false)
                }
                DissipationKind::Rayleigh { matrix } => (T::integer(1), Some(matrix), true),
                DissipationKind::Metriplectic { .. } => continue,
            };
            let scale = T::integer(2)
                .mul(&scope.evaluate(temperature))
                .mul(&strength);
            let entry = |i: usize, j: usize| match rows {
                Some(rows) => scope.evaluate(&rows[i][j]),
                None => T::integer(i32::from(i == j)),
            };
            for column in roots(own, entry) {
                let size = scale.power(0.5).mul(&rate());
                let mut xi: Vec<T> = column.iter().map(|entry| entry.mul(&size)).collect();
                xi.resize(n, T::integer(0));
                match is_force {
                    true => {
                        for (slot, xi) in forces.iter_mut().zip(&xi) {
                            *slot = slot.add(xi);
                        }
                    }
                    false => along(&xi),
                }
            }
        }
        for noise in &declaration.noise {
            let rate = rate();
            match noise {
                Noise::Hamiltonian(function) => {
                    let mut xi = self.gradient(mu, |mu| self.function(function, mu));
                    xi.iter_mut().for_each(|entry| *entry = entry.mul(&rate));
                    if let Some(clock) = configuration.clock() {
                        xi[clock.time] = T::integer(0);
                    }
                    along(&xi);
                }
                Noise::Force(parts) => {
                    for (name, value) in parts {
                        let place = declaration.state.iter().position(|c| c.text == name.text);
                        if let Some(slot) = place.map(|place| &mut forces[place]) {
                            *slot = slot.add(&scope.evaluate(value).mul(&rate));
                        }
                    }
                }
            }
        }
        for (slot, force) in extra.iter_mut().zip(&forces) {
            *slot = slot.add(force);
        }
    }
}

/// The columns of a root of a symmetric matrix, `M = sum_k c_k c_k^T`, by Cholesky's elimination; those of pivots that are zero are zero.
fn roots<T: Number>(n: usize, entry: impl Fn(usize, usize) -> T) -> Vec<Vec<T>> {
    let mut columns: Vec<Vec<T>> = Vec::new();
    for j in 0..n {
        let rest = |i: usize| {
            let taken = columns.iter().map(|column| column[i].mul(&column[j]));
            entry(i, j).sub(&T::sum(taken))
        };
        let pivot = rest(j);
        let column = (0..n).map(|i| match i < j || pivot.value().abs() < 1e-12 {
            true => T::integer(0),
            false => rest(i).div(&pivot.power(0.5)),
        });
        let column = column.collect();
        columns.push(column);
    }
    columns
}
