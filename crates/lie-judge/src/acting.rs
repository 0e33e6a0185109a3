//! What acts beside the Hamiltonian, as it was written: forces, dissipation, inputs and noise.

use crate::derivatives::gradient;
use crate::interpret::Scope;
use crate::linear::{Rows, add_to, dot, times};
use crate::number::Number;
use crate::system::Declared;
use lie_codegen::model::configuration::Configuration;
use lie_syntax::ast::{DissipationKind, Expr, Metric, Noise, Structure};

impl Declared {
    /// What forces and dissipation add to the field: `F - R grad H + K grad S + c Pi G Pi grad H`, and along the momentum of the time
    /// minus what that does to H; `None` where nothing is declared.
    pub(super) fn driven(&self, mu: &[Number], velocity: &[f64]) -> Option<Vec<Number>> {
        let declaration = &self.declaration;
        let configuration = self
            .configuration
            .as_ref()
            .filter(|_| declaration.is_driven())?;
        let own = configuration.own_momenta();
        let mut extra = vec![Number::integer(0); mu.len()];
        let slopes = gradient(mu, |mu| self.hamiltonian(mu, velocity));
        let poisson = self.poisson(mu);
        let scope = self.state(mu);
        let matrix = |rows: &[Vec<Expr>]| -> Rows {
            let row = |row: &Vec<Expr>| row.iter().map(|entry| scope.evaluate(entry)).collect();
            rows.iter().map(row).collect()
        };
        let mut add = |values: Vec<Number>| add_to(&mut extra[..own], &values);
        let mut forces = vec![Number::integer(0); own];
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
                    drag.iter().map(Number::neg).collect()
                }
                DissipationKind::Metriplectic { entropy, metric } => {
                    let slope = gradient(mu, |mu| self.function(entropy, mu));
                    match metric {
                        Metric::Entries(rows) => times(&matrix(rows), &slope),
                        Metric::Factor(rows) => {
                            let factor = matrix(rows);
                            let width = factor.first().map_or(0, Vec::len);
                            let column = |c: usize| {
                                Number::sum(factor.iter().zip(&slope).map(|(row, s)| row[c].mul(s)))
                            };
                            let inner: Vec<Number> = (0..width).map(column).collect();
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
                    let pushed: Vec<Number> = lowered.iter().map(|w| strength.mul(w)).collect();
                    times(&poisson, &pushed)
                }
            });
        }
        let power = dot(&extra[..own], &slopes);
        // of an algebra the time and its momentum have the bracket of the unit
        let bracket = match declaration.structure {
            Structure::Lie { .. } => mu[configuration.clock()?.time + 1].clone(),
            Structure::General { .. } => Number::integer(1),
        };
        extra[configuration.momenta - 1] = power.neg().mul(&bracket);
        self.add_noise(configuration, mu, (&poisson, &scope), &mut extra);
        Some(extra)
    }

    /// What noise adds to the field, of which the momentum of the time knows nothing.
    fn add_noise(
        &self,
        configuration: &Configuration,
        mu: &[Number],
        (poisson, scope): (&[Vec<Number>], &Scope),
        extra: &mut [Number],
    ) {
        let declaration = &self.declaration;
        let (n, own) = (mu.len(), configuration.own_momenta());
        let mut rates = configuration.held_places().skip(declaration.inputs.len());
        let mut rate = || {
            rates
                .next()
                .map_or(Number::integer(0), |place| mu[place].clone())
        };
        let mut along = |xi: &[Number]| add_to(extra, &times(poisson, xi));
        let mut forces = vec![Number::integer(0); n];
        for dissipation in &declaration.dissipation {
            let Some(temperature) = &dissipation.temperature else {
                continue;
            };
            let (strength, rows, is_force) = match &dissipation.kind {
                DissipationKind::DoubleBracket { strength, metric } => {
                    (scope.evaluate(strength), metric.as_ref(), false)
                }
                DissipationKind::Rayleigh { matrix } => (Number::integer(1), Some(matrix), true),
                DissipationKind::Metriplectic { .. } => continue,
            };
            let scale = Number::integer(2)
                .mul(&scope.evaluate(temperature))
                .mul(&strength);
            let entry = |i: usize, j: usize| match rows {
                Some(rows) => scope.evaluate(&rows[i][j]),
                None => Number::integer(i32::from(i == j)),
            };
            for column in roots(own, entry) {
                let size = scale.power(0.5).mul(&rate());
                let mut xi: Vec<Number> = column.iter().map(|entry| entry.mul(&size)).collect();
                xi.resize(n, Number::integer(0));
                match is_force {
                    true => add_to(&mut forces, &xi),
                    false => along(&xi),
                }
            }
        }
        for noise in &declaration.noise {
            let rate = rate();
            match noise {
                Noise::Hamiltonian(function) => {
                    let mut xi = gradient(mu, |mu| self.function(function, mu));
                    xi.iter_mut().for_each(|entry| *entry = entry.mul(&rate));
                    if let Some(clock) = configuration.clock() {
                        xi[clock.time] = Number::integer(0);
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
        add_to(extra, &forces);
    }
}

/// The columns of a root of a symmetric matrix, `M = sum_k c_k c_k^T`, by Cholesky's elimination; those of pivots that are zero are zero.
fn roots(n: usize, entry: impl Fn(usize, usize) -> Number) -> Rows {
    let mut columns: Rows = Vec::new();
    for j in 0..n {
        let rest = |i: usize| {
            let taken = columns.iter().map(|column| column[i].mul(&column[j]));
            entry(i, j).sub(&Number::sum(taken))
        };
        let pivot = rest(j);
        let column = (0..n).map(|i| match i < j || pivot.value().abs() < 1e-12 {
            true => Number::integer(0),
            false => rest(i).div(&pivot.power(0.5)),
        });
        let column = column.collect();
        columns.push(column);
    }
    columns
}
