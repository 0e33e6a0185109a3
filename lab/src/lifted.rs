//! `collective16` over each of its lifts: order, defect of the executed map, drift, each beside `gauss16`.

use crate::drawn::Chance;
use crate::drawn::algebra::{Algebra, Space, all};
use crate::drawn::energy::{Energy, Kind};
use crate::drawn::member::{off, rate};
use crate::drawn::system::Drawn;
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::methods::{Collective16 as OrderSixteen, Method};
use lie_runtime::prelude::*;
use std::sync::Arc;

/// A system on which the lift is measured.
pub struct Case {
    /// What it is.
    pub name: String,
    system: Drawn,
    start: Vec<f64>,
    /// A step: two over the norm of the derivative of the field at the start.
    unit: f64,
}

/// A step at which the defect of a method that is no Poisson map is seen, in units.
pub const LARGER: f64 = 1.75;

/// What was measured of a method.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// The slope of errors against steps.
    pub order: f64,
    /// The Poisson defect of the executed step, of the unit and of [`LARGER`] units.
    pub defects: [f64; 2],
    /// None where no step reaches the end.
    pub drift: Option<Drift>,
}

/// Parts of the unit that are tried as steps of long runs.
const PARTS: [f64; 4] = [0.9, 0.6, 0.3, 0.1];

/// What became of the invariants in a long run.
#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// The step in units.
    pub part: f64,
    /// The largest relative error of the energy in the first tenth, and in the last.
    pub energy: (f64, f64),
    /// That of the quadratic form that is constant on orbits.
    pub casimir: f64,
}

/// The cases: every lift, with quadratic and other Hamiltonians.
pub fn cases() -> Vec<Case> {
    let wanted = [
        ("so(3)", Kind::Linear),
        ("so(3)", Kind::Nonpolynomial),
        ("se(3)", Kind::Linear),
        ("se(3)", Kind::Nonpolynomial),
        ("so(3) with two vectors", Kind::Linear),
        ("so(4)", Kind::Quadratic),
        ("su(3)", Kind::Quadratic),
    ];
    let algebras = all();
    let case = |&(name, kind): &(&str, Kind)| {
        let algebra = algebras
            .iter()
            .find(|a| a.name == name)
            .expect("it is one of them");
        let mut chance = Chance::new(7);
        let energy = Energy::draw(kind, algebra.dimension(), 1.0, false, &mut chance);
        let system = Drawn::new(Arc::new(algebra.clone()), energy);
        let start = chance.numbers(algebra.dimension());
        let rate = rate(&system, &start).expect("it moves");
        Case {
            name: format!("{name}, {}", format!("{kind:?}").to_lowercase()),
            unit: 2.0 / rate,
            system,
            start,
        }
    };
    wanted.iter().map(case).collect()
}

/// The sum of squares over the coordinates whose square is constant on orbits: all of compact algebras, the first vector of others.
fn casimir(algebra: &Algebra, mu: &[f64]) -> f64 {
    let part = match algebra.space {
        Space::Vectors(..) => &mu[3..6],
        _ => mu,
    };
    part.iter().map(|x| x * x).sum()
}

impl Case {
    /// `collective16`.
    pub fn collective(&self, span: f64) -> Measured {
        match self.system.algebra.space {
            Space::Spins(_) => self.measure(&OrderSixteen::hopf(), span),
            Space::Vectors(..) => self.measure(&OrderSixteen::quaternion(), span),
            _ => self.measure(&OrderSixteen::representation(), span),
        }
    }

    /// `gauss16`, which is no Poisson map.
    pub fn gauss(&self, span: f64) -> Measured {
        self.measure(&Gauss16, span)
    }

    fn measure<M>(&self, method: &M, span: f64) -> Measured
    where
        M: Method<f64, Drawn> + Method<Dual<f64>, Drawn>,
    {
        let options = NewtonOptions::default();
        let defects = [1.0, LARGER].map(|units| {
            let step = units * self.unit;
            let defect = poisson_defect(&self.system, method, step, &self.start, &options);
            defect.unwrap_or(f64::NAN)
        });
        Measured {
            order: self.order(method),
            defects,
            drift: self.drift(method, span),
        }
    }

    fn ahead<M: Method<f64, Drawn>>(&self, method: &M, time: f64, steps: u32) -> Option<Vec<f64>> {
        let mut mu = self.start.clone();
        let options = NewtonOptions::default();
        let mut stepper = method.stepper(&self.system, time / f64::from(steps), &options);
        for _ in 0..steps {
            stepper.step(&mut mu, &mut ()).ok()?;
        }
        Some(mu)
    }

    /// The slope of the errors that are above round-off and below 1e-4.
    fn order<M: Method<f64, Drawn>>(&self, method: &M) -> f64 {
        let time = 10.0 * self.unit;
        let Some(exact) = self.ahead(&Taylor::default(), time, 20) else {
            return f64::NAN;
        };
        let mut points = Vec::new();
        for steps in 4..60 {
            let Some(end) = self.ahead(method, time, steps) else {
                continue;
            };
            let error = off(&end, &exact);
            if (1e-12..1e-4).contains(&error) {
                points.push((-f64::from(steps).ln(), error.ln()));
            }
        }
        let count = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let above: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        above / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
    }

    /// The errors of energy and Casimir, with the longest of the [`PARTS`] of the unit that reaches the end.
    fn drift<M: Method<f64, Drawn>>(&self, method: &M, span: f64) -> Option<Drift> {
        PARTS
            .into_iter()
            .find_map(|part| self.drift_of(method, span, part))
    }

    /// The errors of energy and Casimir with steps of a part of the unit.
    fn drift_of<M: Method<f64, Drawn>>(&self, method: &M, span: f64, part: f64) -> Option<Drift> {
        let (h, algebra) = (part * self.unit, &self.system.algebra);
        let steps = (span / h).ceil() as u64;
        let options = NewtonOptions::default();
        let mut stepper = method.stepper(&self.system, h, &options);
        let mut mu = self.start.clone();
        let (energy, square) = (self.system.hamiltonian(&mu), casimir(algebra, &mu));
        let (mut first, mut last, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        for k in 0..steps {
            stepper.step(&mut mu, &mut ()).ok()?;
            let error = (self.system.hamiltonian(&mu) / energy - 1.0).abs();
            if 10 * k < steps {
                first = first.max(error);
            } else if 10 * k >= 9 * steps {
                last = last.max(error);
            }
            most = most.max((casimir(algebra, &mu) / square - 1.0).abs());
        }
        Some(Drift {
            part,
            energy: (first, last),
            casimir: most,
        })
    }
}
