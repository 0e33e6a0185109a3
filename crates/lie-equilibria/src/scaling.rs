//! Equations whose states, energies and Casimirs are about 1.
//!
//! With `x = s X`, `H = h H'`, `C_k = c_k C_k'` the equilibria are those of `H'` and `C_k'` in X, with the multipliers
//! `lambda_k = lambda_k' h/c_k`. The scales are powers of two, so that this changes no digit; s is that of the initial state, and h and c_k
//! are those of `s |grad H|` and `s |grad C_k|` near it. The search has bounds and dampings that are meant for numbers about 1.

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::Symbol;

use crate::branch::Branch;
use crate::dense::norm;
use crate::newton::At;
use crate::search::Candidate;
use crate::system::{Equations, System};

/// Scales within so many powers of two are left as they are.
const NEAR: i32 = 10;

/// Equations in scaled unknowns.
pub struct Scaled {
    /// The equations.
    pub equations: Equations,
    state: f64,
    energy: f64,
    multipliers: Vec<f64>,
}

impl Scaled {
    /// Those of equations at values of the parameters; `None` where they are about 1 as they are.
    pub fn new(at: At<'_>) -> Option<Self> {
        let equations = at.equations;
        let (n, m) = (equations.sizes.n, equations.sizes.m);
        let (_, state) = equations.leaf(at.parameters)?;
        let size = match norm(&state) {
            0.0 => 1.0,
            size => size,
        };
        // beside the initial state, which may be an equilibrium
        let beside = state.iter().enumerate();
        let beside = beside.map(|(i, x)| x + size * (0.1 + 0.03 * i as f64));
        let y: Vec<f64> = beside.chain(vec![0.0; m]).collect();
        let slopes = equations.linear(&y, at.parameters)?;
        let gradients = slopes.slope[n * (n + m)..].chunks(n + m);
        let power = |value: f64| {
            let power = value.log2().round();
            (power.abs() < 1000.0).then_some(power as i32)
        };
        let state = power(size)?;
        let energy = power(size * norm(&slopes.residual[..n]))?;
        let casimirs: Option<Vec<i32>> =
            gradients.map(|row| power(size * norm(&row[..n]))).collect();
        let casimirs = casimirs?;
        if casimirs
            .iter()
            .chain([&state, &energy])
            .all(|k| k.abs() <= NEAR)
        {
            return None;
        }
        Some(Self {
            equations: {
                let scaled = system(&equations.system, state, energy, &casimirs)?;
                Equations::new(scaled, equations.varying).ok()?
            },
            state: f64::from(state).exp2(),
            energy: f64::from(energy).exp2(),
            multipliers: casimirs
                .iter()
                .map(|k| f64::from(energy - k).exp2())
                .collect(),
        })
    }

    /// Unknowns and H as they were given.
    fn unscale(&self, y: &mut [f64], energy: &mut f64) {
        let n = y.len() - self.multipliers.len();
        let (x, lambda) = y.split_at_mut(n);
        x.iter_mut().for_each(|x| *x *= self.state);
        let pairs = lambda.iter_mut().zip(&self.multipliers);
        pairs.for_each(|(lambda, factor)| *lambda *= factor);
        *energy *= self.energy;
    }

    /// What branches are in the unknowns that were given. Rates are those of `Pi W`, with W in parts of `h/s^2`.
    pub fn back_branch(&self, branch: &mut Branch) {
        for point in &mut branch.points {
            self.unscale(&mut point.y, &mut point.energy);
            point.growth *= self.energy / (self.state * self.state);
        }
        for change in &mut branch.changes {
            self.unscale(&mut change.y, &mut change.energy);
        }
    }

    /// What a candidate is in the unknowns that were given.
    pub fn back(&self, candidate: &mut Candidate) {
        self.unscale(&mut candidate.y, &mut candidate.energy);
        candidate.reach *= self.state;
    }
}

fn system(given: &System, state: i32, energy: i32, casimirs: &[i32]) -> Option<System> {
    let two = |power: i32| Rational::from(2).pow(power);
    let mut scaled = given.clone();
    let graph = &mut scaled.graph;
    let (up, down) = (two(state)?, two(-state)?);
    let coordinates = (0..given.coordinates.len()).map(|i| {
        let x = graph.symbol(Symbol::Coordinate(i));
        graph.scale(x, &up)
    });
    let coordinates: Vec<_> = coordinates.collect();
    let replace = |symbol: Symbol| match symbol {
        Symbol::Coordinate(i) => coordinates.get(i).copied(),
        _ => None,
    };
    let hamiltonian = graph.substitute(&[given.hamiltonian], &replace)[0];
    scaled.hamiltonian = graph.scale(hamiltonian, &two(-energy)?);
    for (k, power) in casimirs.iter().enumerate() {
        let factor = two(-power)?;
        let value = graph.substitute(&[given.casimirs[k].value], &replace)[0];
        scaled.casimirs[k].value = graph.scale(value, &factor);
        scaled.levels[k] = graph.scale(given.levels[k], &factor);
    }
    for entry in &mut scaled.bracket {
        entry.2 = graph.substitute(&[entry.2], &replace)[0];
    }
    for value in &mut scaled.state {
        *value = graph.scale(*value, &down);
    }
    for integral in &mut scaled.integrals {
        integral.value = graph.substitute(&[integral.value], &replace)[0];
    }
    Some(scaled)
}
