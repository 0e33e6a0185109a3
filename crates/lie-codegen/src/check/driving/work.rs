//! The expressions of a driven system.

use super::metric::{Checks, Rows};
use crate::model::PoissonMatrix;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::Diagnostic;

/// What noise adds to the force and to the generator.
pub struct Loud {
    pub force: Vec<ExprId>,
    pub damping: Vec<ExprId>,
    /// How many Wiener processes there are so far.
    pub count: usize,
}

impl Loud {
    /// The rate `dW/dt` of the next Wiener process.
    pub fn rate(&mut self, work: &mut Work<'_>) -> ExprId {
        let symbol = (work.rate)(self.count);
        self.count += 1;
        work.graph.symbol(symbol)
    }
}

/// What the expressions of a driven system are made of.
pub struct Work<'a> {
    pub graph: &'a mut Graph,
    /// How many coordinates were declared.
    pub own: usize,
    /// The first of them.
    pub first: usize,
    /// Where the generator has what the time takes, behind the declared coordinates.
    pub time: usize,
    /// The gradient of H, with all coordinates that go with the declared ones.
    pub slopes: Vec<ExprId>,
    /// The brackets of these.
    pub matrix: PoissonMatrix,
    /// The rates of Wiener processes.
    pub rate: &'a dyn Fn(usize) -> Symbol,
}

impl Work<'_> {
    /// `Pi w` in the declared coordinates.
    pub fn moved(&mut self, w: &[ExprId]) -> Vec<ExprId> {
        let mut terms = vec![Vec::new(); w.len()];
        for (i, j, entry) in &self.matrix.entries {
            let forth = self.graph.mul(*entry, w[*j]);
            let back = self.graph.mul(*entry, w[*i]);
            terms[*i].push(forth);
            terms[*j].push(self.graph.scale(back, &Rational::MINUS_ONE));
        }
        let own = terms.into_iter().take(self.own);
        own.map(|terms| self.graph.sum(&terms)).collect()
    }

    /// `M w` of the first coordinates.
    pub fn times(&mut self, rows: &Rows, w: &[ExprId]) -> Vec<ExprId> {
        let row = |row: &Vec<ExprId>| {
            let products: Vec<ExprId> = row
                .iter()
                .zip(w)
                .map(|(a, b)| self.graph.mul(*a, *b))
                .collect();
            self.graph.sum(&products)
        };
        rows.iter().map(row).collect()
    }

    pub fn add_rayleigh(&mut self, rows: &Rows, force: &mut [ExprId]) {
        let slopes = self.slopes.clone();
        for (slot, drag) in force.iter_mut().zip(self.times(rows, &slopes)) {
            *slot = self.graph.sub(*slot, drag);
        }
    }

    pub fn add_double_bracket(
        &mut self,
        strength: ExprId,
        metric: Option<&Rows>,
        damping: &mut [ExprId],
    ) {
        let slopes = self.slopes.clone();
        let v = self.moved(&slopes);
        let lowered = match metric {
            Some(rows) => self.times(rows, &v),
            None => v.clone(),
        };
        let mut power = Vec::new();
        for (i, (v, w)) in v.into_iter().zip(lowered).enumerate() {
            let part = self.graph.mul(strength, w);
            damping[i] = self.graph.add(damping[i], part);
            power.push(self.graph.mul(part, v));
        }
        let power = self.graph.sum(&power);
        damping[self.time] = self.graph.sub(damping[self.time], power);
    }

    /// The derivatives of a function by the first so many coordinates.
    fn derivatives(&mut self, function: ExprId, count: usize) -> Vec<ExprId> {
        let coordinates = (self.first..self.first + count).map(Symbol::Coordinate);
        coordinates
            .map(|x| self.graph.derivative(function, x))
            .collect()
    }

    /// `xi += grad sigma dW/dt`, without what that does to the momentum of the time.
    pub fn add_hamiltonian_noise(&mut self, function: ExprId, noise: &mut Loud) {
        let rate = noise.rate(self);
        let slopes = self.derivatives(function, self.slopes.len());
        for (i, slope) in slopes.into_iter().enumerate() {
            if i != self.time {
                let part = self.graph.mul(slope, rate);
                noise.damping[i] = self.graph.add(noise.damping[i], part);
            }
        }
    }

    /// The noise of a dissipation at a temperature T: `sigma sigma^T = 2 c T G` along the orbit with the strength c, `2 T R` as a force
    /// without one.
    pub fn warm(
        &mut self,
        checks: &Checks<'_>,
        (temperature, strength): (ExprId, Option<ExprId>),
        metric: Option<&Rows>,
        noise: &mut Loud,
    ) -> Option<Diagnostic> {
        if strength.is_none() {
            let rows = metric?;
            if let Some(mistake) = checks.symmetric(self.graph, "the matrix R", rows) {
                return Some(mistake);
            }
            let divergence = self.divergence();
            if let Some(mistake) = checks.unimodular(self.graph, &divergence) {
                return Some(mistake);
            }
        }
        let two = self.graph.integer(2);
        let half = Rational::ONE / Rational::from(2);
        let mut factors = vec![two, temperature];
        factors.extend(strength);
        let scale = self.graph.product(&factors);
        let (columns, pivots) = checks.factors(self.graph, metric);
        for (column, pivot) in columns.into_iter().zip(pivots) {
            let square = self.graph.mul(scale, pivot);
            let amplitude = self.graph.pow(square, &half);
            let rate = noise.rate(self);
            let rate = self.graph.mul(amplitude, rate);
            let target = match strength {
                Some(_) => &mut noise.damping,
                None => &mut noise.force,
            };
            for (i, entry) in column.into_iter().enumerate() {
                let part = self.graph.mul(entry, rate);
                target[i] = self.graph.add(target[i], part);
            }
        }
        debug_assert!(
            self.graph.is_zero(noise.damping[self.time]),
            "noise does no work"
        );
        None
    }

    /// `sum_i dPi_ij/dx_i` for each declared coordinate j: zero where every Hamiltonian field has no divergence.
    pub fn divergence(&mut self) -> Vec<ExprId> {
        let mut terms = vec![Vec::new(); self.own];
        let coordinate = |i: &usize| Symbol::Coordinate(self.first + i);
        for (i, j, entry) in &self.matrix.entries {
            if *i < self.own && *j < self.own {
                terms[*j].push(self.graph.derivative(*entry, coordinate(i)));
                let other = self.graph.derivative(*entry, coordinate(j));
                terms[*i].push(self.graph.neg(other));
            }
        }
        terms
            .into_iter()
            .map(|terms| self.graph.sum(&terms))
            .collect()
    }

    pub fn add_metriplectic(&mut self, entropy: ExprId, rows: &Rows, force: &mut [ExprId]) {
        let slopes = self.derivatives(entropy, self.own);
        for (slot, push) in force.iter_mut().zip(self.times(rows, &slopes)) {
            *slot = self.graph.add(*slot, push);
        }
    }

    /// The metric K, once all that it promises is proven.
    pub fn metriplectic(
        &mut self,
        entropy: ExprId,
        rows: &Rows,
        factor: bool,
        checks: &Checks<'_>,
    ) -> Result<Rows, Diagnostic> {
        let rows = match factor {
            true => checks.square(self.graph, rows)?,
            false => rows.clone(),
        };
        checks.shape("the metric K", &rows).map_or(Ok(()), Err)?;
        let degenerate = self.times(&rows, &self.slopes.clone());
        let mut slopes = self.derivatives(entropy, self.own);
        slopes.resize(self.slopes.len(), self.graph.integer(0));
        let moved = self.moved(&self.slopes.clone());
        let products = moved.iter().zip(&slopes);
        let products: Vec<ExprId> = products.map(|(a, b)| self.graph.mul(*a, *b)).collect();
        let bracket = self.graph.sum(&products);
        checks.metriplectic(self.graph, &rows, factor, &degenerate, bracket)?;
        Ok(rows)
    }

    /// `<F, grad H>`
    pub fn power(&mut self, force: &[ExprId]) -> ExprId {
        let parts = force.iter().zip(&self.slopes).take(self.own);
        let parts: Vec<ExprId> = parts.map(|(f, g)| self.graph.mul(*f, *g)).collect();
        self.graph.sum(&parts)
    }
}
