//! What acts on each site, where its flow is exact: linear friction, constant forces, and noise along constant directions.

use super::{Form, Piece, Push, Search};
use crate::model::{Driving, slope_symbol};
use crate::structure::exponential;
use lie_core::lattice::AXES;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::joints::joints_in;
use lie_symbolic::prove::proof::Prover;
use lie_symbolic::symbolic::{ExprId, Function, Symbol};

/// Work allowed for one expression.
const WORK: u64 = 2_000_000;

impl Search<'_> {
    /// The pieces of what acts: friction, and behind it noise.
    ///
    /// # Errors
    /// What has no flow in closed form.
    pub(super) fn acting(&mut self) -> Result<(), String> {
        let Some(driving) = &self.model.driving else {
            return Ok(());
        };
        let n = self.n();
        let damping = self.quiet(&driving.damping[..n]);
        if damping.into_iter().any(|value| !self.vanishes(value)) {
            return Err("a double bracket damps, whose flow has no closed form".into());
        }
        let force = self.quiet(&driving.force[..n]);
        self.friction(&force)?;
        self.noise(driving)
    }

    /// A piece of all sites.
    fn of_sites(&mut self, form: Form) {
        self.found.push(Piece {
            offset: [0; AXES],
            spans: [None; AXES],
            form,
            timed: None,
        });
    }

    fn vanishes(&self, value: ExprId) -> bool {
        let name = |symbol| self.model.acting_name(symbol);
        let budget = Budget::new(WORK);
        self.graph.is_zero(value)
            || Prover::new(self.graph, &budget, &[value], &name).vanishes(value)
    }

    /// Expressions without noise.
    fn quiet(&mut self, values: &[ExprId]) -> Vec<ExprId> {
        let (zero, processes) = (self.graph.integer(0), self.processes());
        let rates: Vec<Symbol> = processes.map(|k| self.family.rate_symbol(k)).collect();
        (self.graph).substitute(values, &|symbol| rates.contains(&symbol).then_some(zero))
    }

    fn processes(&self) -> std::ops::Range<usize> {
        0..self.model.driving.as_ref().map_or(0, |d| d.noises)
    }

    /// The name of a coordinate, or of a component of dH/dmu, on which an expression is not shown not to depend.
    fn depends_on(&mut self, value: ExprId, but: Option<Symbol>) -> Option<String> {
        let places = 0..self.family.names.len();
        let slopes = (0..self.n()).map(slope_symbol);
        let symbols: Vec<Symbol> = places.map(Symbol::Coordinate).chain(slopes).collect();
        let mut others = symbols.iter().filter(|symbol| Some(**symbol) != but);
        let on = others.find(|symbol| {
            let slope = self.graph.derivative(value, **symbol);
            !self.vanishes(slope)
        });
        // a branch that is taken by the state has no derivative
        let places = joints_in(self.graph, value, &|_| true).into_iter();
        let mut branches = places.flat_map(|place| self.graph.symbols(place));
        let on = on
            .copied()
            .or_else(|| branches.find(|on| symbols.contains(on)))?;
        Some(match on {
            Symbol::Coordinate(place) => format!("`{}`", self.family.names[place]),
            Symbol::Input(a) => format!("dH/d`{}`", self.target(a)),
            _ => "the state".to_owned(),
        })
    }

    /// The name of a coordinate of the site.
    fn target(&self, a: usize) -> &str {
        &self.family.names[self.family.own * self.n() + a]
    }

    /// Friction `a - k x` on each coordinate x: `x + t (a - k x) phi_1(-k t)` is where it takes it.
    fn friction(&mut self, force: &[ExprId]) -> Result<(), String> {
        let n = self.n();
        let time = self.graph.symbol(Symbol::Time);
        let mut moved = Vec::new();
        for (a, &value) in force.iter().enumerate() {
            let own = Symbol::Coordinate(self.family.own * n + a);
            let slope = self.graph.derivative(value, own);
            let other = self.depends_on(value, Some(own));
            let bends = self.depends_on(slope, None);
            if let Some(on) = other.as_ref().or(bends.as_ref()) {
                let x = self.target(a);
                let what = match other.is_some() {
                    true => format!("depends on {on}"),
                    false => format!("is not linear in `{x}`"),
                };
                return Err(format!(
                    "forces have a flow in closed form where each is `a - k*x` on its coordinate `x`, and that on `{x}` {what}"
                ));
            }
            let x = self.graph.symbol(Symbol::Coordinate(a));
            if self.vanishes(value) {
                moved.push(x);
                continue;
            }
            let [push, slope] = [value, slope].map(|value| self.alone_at_own(value));
            let pull = self.graph.mul(slope, x);
            let speed = self.graph.add(push, pull);
            let reach = self.graph.mul(slope, time);
            let weight = match self.graph.is_zero(slope) {
                true => time,
                false => {
                    let weight = self.graph.call(Function::Phi(1), &[reach]);
                    self.graph.mul(time, weight)
                }
            };
            let change = self.graph.mul(weight, speed);
            moved.push(self.graph.add(x, change));
        }
        self.force(Push::Friction, moved);
        Ok(())
    }

    /// The piece of a force that takes the coordinates there, if it moves any.
    fn force(&mut self, push: Push, moved: Vec<ExprId>) {
        let own = (0..self.n()).map(|a| self.graph.symbol(Symbol::Coordinate(a)));
        if !own.eq(moved.iter().copied()) {
            self.of_sites(Form::Force(push, moved));
        }
    }

    /// The part of values that one process makes, which depends on no coordinate.
    fn direction(
        &mut self,
        what: &str,
        values: &[ExprId],
        process: usize,
    ) -> Result<Vec<ExprId>, String> {
        let symbol = self.family.rate_symbol(process);
        let rate = self.graph.symbol(symbol);
        let mut direction = Vec::new();
        for value in values {
            let part = self.graph.derivative(*value, symbol);
            if let Some(on) = self.depends_on(part, None) {
                return Err(format!(
                    "{what} has a flow in closed form along constant directions alone, and here its direction depends on {on}"
                ));
            }
            let part = self.alone_at_own(part);
            direction.push(self.graph.mul(part, rate));
        }
        Ok(direction)
    }

    /// An expression at coordinates that are 0, which has one value at all of them or is linear.
    fn alone_at_own(&mut self, value: ExprId) -> ExprId {
        let (n, zero) = (self.n(), self.graph.integer(0));
        let value = self.graph.substitute(&[value], &|symbol| match symbol {
            Symbol::Coordinate(_) => Some(zero),
            Symbol::Input(place) if place < n => Some(zero),
            _ => None,
        })[0];
        self.around(value, self.family.own)
    }

    /// The pieces of noise: a turn for each coordinate along which there is some, and for each process along another direction; of forces one.
    fn noise(&mut self, driving: &Driving) -> Result<(), String> {
        let (n, zero) = (self.n(), self.graph.integer(0));
        let (mut along, mut others, mut push) = (vec![zero; n], Vec::new(), vec![zero; n]);
        for process in self.processes() {
            let damping = &driving.damping[..n];
            let direction = self.direction("noise along a Hamiltonian", damping, process)?;
            let moves = (0..n).filter(|a| !self.graph.is_zero(direction[*a]));
            match moves.collect::<Vec<_>>()[..] {
                [] => {}
                [a] => along[a] = self.graph.add(along[a], direction[a]),
                _ => others.push(direction),
            }
            let force = self.direction("noise as a force", &driving.force[..n], process)?;
            for (sum, part) in push.iter_mut().zip(force) {
                *sum = self.graph.add(*sum, part);
            }
        }
        let constants = self.model.bracket.algebra().map(|algebra| &algebra.exact);
        let closed = constants.is_some_and(|all| exponential::closed_form(all).is_some());
        if !others.is_empty() && !closed {
            let why = "the exponential of the algebra has no closed form, along which noise moves";
            return Err(why.into());
        }
        let along = along.into_iter().enumerate();
        let along: Vec<_> = along.filter(|(_, part)| *part != zero).collect();
        for (a, part) in along {
            self.of_sites(Form::Noise(a, part));
        }
        for direction in others {
            self.of_sites(Form::Turn(direction));
        }
        let time = self.graph.symbol(Symbol::Time);
        let moved = push.into_iter().enumerate().map(|(a, part)| {
            let x = self.graph.symbol(Symbol::Coordinate(a));
            let change = self.graph.mul(time, part);
            self.graph.add(x, change)
        });
        let moved = moved.collect();
        self.force(Push::Noise, moved);
        Ok(())
    }
}
