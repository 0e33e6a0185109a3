//! The parts of steps that the compiler derives itself, as symbols: a discrete gradient, a generating function, flows of pieces.

use super::sym::{Session, Sym, with_session};
use super::system::{Square, State, SymbolicSystem, ids, write};
use crate::derive::{Closed, Definitions, Generating, Slope, moved, slope, symmetric};
use crate::structure::separable;
use lie_core::GeneratingFunction;
use lie_core::generic::{Actions, DiscreteGradient};

/// The discrete gradient in closed form that a system is given.
#[derive(Debug)]
pub(crate) struct SymbolicGradient;

impl DiscreteGradient<Sym, SymbolicSystem> for SymbolicGradient {
    fn new(_system: &SymbolicSystem) -> Self {
        Self
    }
    fn set_start(&mut self, _system: &SymbolicSystem, _start: &State) {}
    fn value(&mut self, system: &SymbolicSystem, _end: &State, out: &mut State) {
        let Closed {
            value, definitions, ..
        } = system.gradient();
        let value = with_session(
            |Session {
                 source,
                 tape,
                 given,
                 ..
             }| {
                *given = 1;
                tape.extend(source, definitions);
                tape.define_all(source, value)
            },
        );
        write(value, out);
    }
    fn linearize(
        &mut self,
        system: &SymbolicSystem,
        end: &State,
        out: &mut State,
        derivative: &mut Square,
    ) {
        self.value(system, end, out);
        let slopes = system.gradient().slopes.concat();
        system.matrix(slopes.into_iter().map(Sym).collect(), derivative);
    }
}

/// A generating function whose gradient is derived in closed form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SymbolicFunction(pub(crate) Generating);

impl GeneratingFunction<Sym> for SymbolicFunction {
    type State = State;
    type Jacobian = Square;

    fn gradient(&mut self, p: &State, xi: &mut State) {
        let p = ids(p);
        let entries = with_session(|Session { source, tape, .. }| {
            let Slope {
                tape: list,
                entries,
            } = slope(source, self.0);
            tape.adopt(source, (&list, &entries), &p)
        });
        write(entries, xi);
    }
    fn linearize(&mut self, p: &State, xi: &mut State, hessian: &mut Square) {
        let p = ids(p);
        let (entries, rows) = with_session(|Session { source, tape, .. }| {
            let Slope {
                tape: mut list,
                mut entries,
            } = slope(source, self.0);
            let rows = symmetric(list.jacobian(source, &entries));
            entries.extend(rows.concat());
            let mut entries = tape.adopt(source, (&list, &entries), &p);
            let rows = entries.split_off(p.len());
            (entries, rows)
        });
        write(entries, xi);
        hessian.entries = rows.into_iter().map(Sym).collect();
    }
}

/// Actions in closed form.
#[derive(Debug, Default)]
pub(crate) struct SymbolicActions(Definitions);

impl Actions<Sym, SymbolicSystem> for SymbolicActions {
    fn new(_system: &SymbolicSystem) -> Self {
        Self::default()
    }
    fn act(&mut self, _system: &SymbolicSystem, i: usize, s: Sym, m: &State, out: &mut State) {
        let m = ids(m);
        let moved = with_session(|Session { source, tape, .. }| {
            let algebra = source.structure.bracket.algebra();
            let blocks = algebra.and_then(|algebra| separable::action_of(algebra, i));
            let blocks = blocks.expect("a closed form of each action");
            let known = self.0.all().len();
            let moved = moved(source, &blocks, s.0, &m, &mut self.0);
            tape.extend(source, &self.0.all()[known..]);
            moved
        });
        write(moved, out);
    }
}
