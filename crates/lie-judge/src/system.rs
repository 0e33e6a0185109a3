//! A declaration as it was written, with values for its parameters: energy, brackets, Casimirs over any numbers.

use crate::derivatives::{derivatives, directions};
use crate::interpret::{Scope, size};
use crate::linear::{self, Rows, dot};
use crate::number::Number;
use lie_codegen::model::configuration::{Configuration, TIME, entries_of};
use lie_syntax::ast::{Algebra, Declaration, Energy, Expr, Invariance, Name, Structure};

/// Newton's iterations of a Legendre transform, from a velocity that is nearly right.
const ITERATIONS: usize = 6;
/// A step of Newton's iteration that needs no other one, as a part of the velocity.
const NEAR: f64 = 1e-9;
/// The step at which the limit of a discrete Lagrangian is taken, extrapolated.
const SMALL: f64 = 1e-4;

/// The declared system.
///
/// Systems on `T*G` and systems of the time are read as what they mean, `g' = g xi`, `mu' = ad*_xi mu - g^T dH/dg` and a
/// canonical pair of the time and its momentum, whatever larger algebra the compiler makes of them.
#[derive(Clone, Debug)]
pub(super) struct Declared {
    pub(super) declaration: Declaration,
    /// What stands beside mu, of which a constraint takes nothing away.
    pub(super) configuration: Option<Configuration>,
    pub(super) parameters: Vec<f64>,
    /// The components of the velocity that constraints determine.
    pub(super) determined: Vec<usize>,
}

impl Declared {
    /// The number of declared coordinates.
    pub(super) fn declared_dimension(&self) -> usize {
        let own = self.declaration.state.len();
        self.configuration
            .as_ref()
            .map_or(own, Configuration::dimension)
    }

    /// The nodes of the energy, of the abbreviations and of what acts beside it.
    pub(super) fn size(&self) -> usize {
        let lets = self.declaration.lets.iter().map(|(_, value)| size(value));
        let driving = self.declaration.driving().map(size);
        let all = lets.sum::<usize>()
            + size(self.declaration.energy.expression())
            + driving.sum::<usize>();
        match (&self.declaration.energy, &self.declaration.group) {
            // an elimination for each pair of components, on both sides of the limit, over derivatives
            (Energy::DiscreteLagrangian { .. }, Some(_)) => {
                let rows = self.declaration.algebra();
                let rows = rows.and_then(|algebra| Some(algebra.matrices.first()?.rows.len()));
                let n = self.declaration.state.len();
                (all + 2 * rows.unwrap_or(0).pow(3)) * 4 * n * n
            }
            _ => all,
        }
    }

    fn parameters(&self) -> Scope {
        let mut scope = Scope::new();
        let pairs = self.declaration.parameters.iter().zip(&self.parameters);
        for (parameter, &value) in pairs {
            let units = if value.fract() == 0.0 { 0.0 } else { 1.0 };
            scope.bind(&parameter.name.text, Number::rounded(value, units));
        }
        scope
    }

    /// Parameters and coordinates, without the abbreviations.
    pub(super) fn coordinates(&self, mu: &[Number]) -> Scope {
        let mut scope = self.parameters();
        for (name, value) in self.declaration.state.iter().zip(mu) {
            scope.bind(&name.text, value.clone());
        }
        if let Some(configuration) = &self.configuration {
            let entries = configuration.entries();
            for (place, name) in entries.iter().enumerate() {
                scope.bind(name, mu[configuration.momenta + place].clone());
            }
            if let Some(clock) = configuration.clock() {
                scope.bind(TIME, mu[clock.time].clone());
            }
            let inputs = self.declaration.inputs.iter();
            for (input, place) in inputs.zip(configuration.held_places()) {
                scope.bind(&input.name.text, mu[place].clone());
            }
        }
        scope
    }

    pub(super) fn abbreviate(&self, scope: &mut Scope) {
        for (name, value) in &self.declaration.lets {
            let value = scope.evaluate(value);
            scope.bind(&name.text, value);
        }
    }

    /// The names at a state in the declared coordinates.
    pub(super) fn declared_state(&self, mu: &[Number]) -> Scope {
        let mut scope = self.coordinates(mu);
        self.abbreviate(&mut scope);
        scope
    }

    /// The energy as it was declared; of a Lagrangian `<mu, xi> - l(xi)` with `l'(xi) = mu`, xi near `velocity`.
    pub(super) fn declared_energy(&self, mu: &[Number], velocity: &[f64]) -> Number {
        match &self.declaration.energy {
            Energy::Hamiltonian(value) => self.declared_state(mu).evaluate(value),
            _ => {
                let xi = self.velocity(mu, velocity);
                dot(&xi, mu).sub(&self.lagrangian(&xi, mu))
            }
        }
    }

    /// l(xi), also where it is the limit `l_d(h, h xi)/h` of a discrete one.
    pub(super) fn lagrangian(&self, xi: &[Number], mu: &[Number]) -> Number {
        let Energy::DiscreteLagrangian { .. } = &self.declaration.energy else {
            let mut scope = self.coordinates(mu);
            self.bind_velocity(&mut scope, xi);
            self.abbreviate(&mut scope);
            return scope.evaluate(self.declaration.energy.expression());
        };
        let at = |h: f64| {
            let h = Number::rounded(h, 0.0);
            let x: Vec<Number> = xi.iter().map(|xi| xi.mul(&h)).collect();
            self.discrete(&h, &x).div(&h)
        };
        // the error is even or odd in h: both are gone to second order
        let (one, two) = (at(SMALL), at(-SMALL));
        one.add(&two).div(&Number::integer(2))
    }

    /// `l_d(h, x)`
    pub(super) fn discrete(&self, h: &Number, x: &[Number]) -> Number {
        let mut scope = self.parameters();
        self.bind_velocity(&mut scope, x);
        scope.bind("h", h.clone());
        if let Some(group) = &self.declaration.group {
            for (name, value) in self.cayley_entries(&group.text, x) {
                scope.bind(&name, value);
            }
        }
        self.abbreviate(&mut scope);
        scope.evaluate(self.declaration.energy.expression())
    }

    pub(super) fn bind_velocity(&self, scope: &mut Scope, xi: &[Number]) {
        for (name, value) in self.declaration.energy.velocity().iter().zip(xi) {
            scope.bind(&name.text, value.clone());
        }
    }

    /// The entries of `(1 - X/2)^-1 (1 + X/2)`.
    fn cayley_entries(&self, group: &str, x: &[Number]) -> Vec<(String, Number)> {
        let Some(matrices) = self.matrices() else {
            return Vec::new();
        };
        let size = matrices.first().map_or(0, Vec::len);
        let half = |sign: i32| -> Rows {
            let entry = |r: usize, c: usize| {
                let terms = matrices.iter().zip(x);
                let terms = terms.filter(|(m, _)| m[r][c].value() != 0.0);
                let sum = Number::sum(terms.map(|(m, x)| m[r][c].mul(x)));
                let half = sum.div(&Number::integer(2 * sign));
                half.add(&Number::integer(i32::from(r == c)))
            };
            (0..size)
                .map(|r| (0..size).map(|c| entry(r, c)).collect())
                .collect()
        };
        let g = linear::solve(half(-1), half(1));
        let names = entries_of(group, size);
        names.into_iter().zip(g.into_iter().flatten()).collect()
    }

    /// `l'(xi) = mu`, by Newton's iteration over the numbers themselves.
    ///
    /// That of a discrete Lagrangian in entries of the group element takes much work. It is found for the values first, and then with
    /// derivatives to the first order: `<mu, xi> - l(xi)` is stationary, so that its second derivatives need no more.
    pub(super) fn velocity(&self, mu: &[Number], near: &[f64]) -> Vec<Number> {
        let n = self.declaration.state.len();
        let start = |k: usize| near.get(k).copied().unwrap_or(0.0);
        let mut xi: Vec<Number> = (0..n).map(|k| Number::rounded(start(k), 0.0)).collect();
        let in_entries = self.declaration.energy.has_step() && self.declaration.group.is_some();
        if in_entries {
            let values: Vec<Number> = mu[..n].iter().map(|m| Number::input(m.value())).collect();
            for _ in 0..ITERATIONS {
                if self.improve(&mut xi, &values) < NEAR {
                    break;
                }
            }
        }
        let rest = match (in_entries, directions(mu)) {
            (true, varying) => varying.min(1),
            (false, _) => ITERATIONS,
        };
        for _ in 0..rest {
            self.improve(&mut xi, mu);
        }
        xi
    }

    /// One of Newton's iterations, and the size of its step as a part of the velocity.
    fn improve(&self, xi: &mut [Number], mu: &[Number]) -> f64 {
        let n = xi.len();
        let (slope, second) = derivatives(xi, directions(mu), |xi| self.lagrangian(xi, mu));
        let gap = (0..n).map(|i| vec![mu[i].sub(&slope[i])]).collect();
        let step = linear::solve(second, gap);
        let (mut moved, mut all) = (0.0_f64, f64::MIN_POSITIVE);
        for (xi, step) in xi.iter_mut().zip(step) {
            *xi = xi.add(&step[0]);
            moved = moved.max(step[0].value().abs());
            all = all.max(xi.value().abs());
        }
        moved / all
    }

    /// A function of the state that was declared.
    pub(super) fn function(&self, expr: &Expr, mu: &[Number]) -> Number {
        self.state(mu).evaluate(expr)
    }

    /// The components of the realization at a point.
    pub(super) fn momentum_map(&self, z: &[Number]) -> Option<Vec<Number>> {
        let realization = self.declaration.realization.as_ref()?;
        let mut scope = self.parameters();
        for (name, value) in realization.names().zip(z) {
            scope.bind(&name.text, value.clone());
        }
        self.abbreviate(&mut scope);
        let component = |name: &Name| {
            let found = realization.map.iter().find(|(n, _)| n.text == name.text);
            found.map(|(_, value)| scope.evaluate(value))
        };
        self.declaration.state.iter().map(component).collect()
    }

    /// The declared matrices, in the order of the basis.
    pub(super) fn matrices(&self) -> Option<Vec<Rows>> {
        let algebra = self.declaration.algebra()?;
        let mut scope = self.parameters();
        self.abbreviate(&mut scope);
        let matrix = |name: &Name| {
            let found = algebra.matrices.iter().find(|m| m.name.text == name.text)?;
            let rows = found.rows.iter();
            Some(
                rows.map(|row| row.iter().map(|e| scope.evaluate(e)).collect())
                    .collect(),
            )
        };
        algebra.basis.iter().map(matrix).collect()
    }

    /// The Poisson matrix `{mu_i, mu_j}` in the declared coordinates.
    pub(super) fn declared_poisson(&self, mu: &[Number]) -> Rows {
        let n = self.declared_dimension();
        let mut matrix = vec![vec![Number::integer(0); n]; n];
        let mut set = |i: usize, j: usize, value: Number| {
            matrix[j][i] = value.neg();
            matrix[i][j] = value;
        };
        match &self.declaration.structure {
            Structure::General { brackets, .. } => {
                let scope = self.declared_state(mu);
                for bracket in brackets {
                    let (i, j) = self.pair(&self.declaration.state, bracket);
                    set(i, j, scope.evaluate(&bracket.value));
                }
                if let Some(clock) = self.configuration.as_ref().and_then(|c| c.clock()) {
                    set(clock.time, clock.momentum, Number::integer(1));
                }
            }
            Structure::Lie { algebra, cocycle } => {
                for (i, j, value) in self.brackets(algebra, mu) {
                    set(i, j, value);
                }
                if self.configuration.is_some() {
                    self.configured(mu, &mut set);
                }
                let scope = self.parameters();
                let unit = self.unit(mu);
                for bracket in cocycle {
                    let (i, j) = self.pair(&self.declaration.state, bracket);
                    let value = scope.evaluate(&bracket.value).mul(&unit);
                    let sum = matrix[i][j].add(&value);
                    matrix[j][i] = sum.neg();
                    matrix[i][j] = sum;
                }
            }
        }
        matrix
    }

    /// The unit beside the time; of a system with a constraint, whose bracket is no more that of an algebra, it is the number.
    fn unit(&self, mu: &[Number]) -> Number {
        let clock = self.configuration.as_ref().and_then(|c| c.clock());
        let clock = clock.filter(|_| self.determined.is_empty());
        clock.map_or(Number::integer(1), |clock| mu[clock.time + 1].clone())
    }

    fn pair(&self, names: &[Name], bracket: &lie_syntax::ast::Bracket) -> (usize, usize) {
        let place = |name: &Name| names.iter().position(|n| n.text == name.text);
        (
            place(&bracket.left).unwrap_or(0),
            place(&bracket.right).unwrap_or(0),
        )
    }

    /// `{mu_i, mu_j} = -<mu, [e_i, e_j]>`, of a right-invariant system with the other sign.
    fn brackets(&self, algebra: &Algebra, mu: &[Number]) -> Vec<(usize, usize, Number)> {
        let left = self.declaration.invariance == Invariance::Left;
        let sign = |value: Number| if left { value.neg() } else { value };
        if let Some(brackets) = &algebra.brackets {
            // the value is linear in the basis: its names stand for the coordinates
            let mut scope = self.parameters();
            self.abbreviate(&mut scope);
            for (name, value) in algebra.basis.iter().zip(mu) {
                scope.bind(&name.text, value.clone());
            }
            let written = brackets.iter().map(|bracket| {
                let (i, j) = self.pair(&algebra.basis, bracket);
                (i, j, sign(scope.evaluate(&bracket.value)))
            });
            return written.filter(|(i, j, _)| i != j).collect();
        }
        let matrices = self.matrices().unwrap_or_default();
        let mut all = Vec::new();
        for i in 0..matrices.len() {
            for j in i + 1..matrices.len() {
                let commutator = linear::difference(
                    &linear::product(&matrices[i], &matrices[j]),
                    &linear::product(&matrices[j], &matrices[i]),
                );
                let coordinates = linear::coordinates(&matrices, &commutator);
                all.push((i, j, sign(dot(&coordinates, mu))));
            }
        }
        all
    }

    /// `{g, mu_i} = g rho(e_i)`, or `rho(e_i) g`, and `{t, p} = 1`.
    fn configured(&self, mu: &[Number], set: &mut impl FnMut(usize, usize, Number)) {
        let Some(configuration) = &self.configuration else {
            return;
        };
        if let (Some((_, size)), Some(matrices)) = (&configuration.group, self.matrices()) {
            let (first, size) = (configuration.momenta, *size);
            let g = &mu[first..first + size * size];
            let left = self.declaration.invariance == Invariance::Left;
            for (i, rho) in matrices.iter().enumerate() {
                for a in 0..size {
                    for b in 0..size {
                        let terms = (0..size).map(|c| {
                            if left {
                                g[a * size + c].mul(&rho[c][b])
                            } else {
                                rho[a][c].mul(&g[c * size + b])
                            }
                        });
                        set(first + a * size + b, i, Number::sum(terms));
                    }
                }
            }
        }
        if let Some(clock) = configuration.clock() {
            set(clock.time, clock.momentum, self.unit(mu));
        }
    }
}
