//! Methods that a user wrote: their equation is traced as those of the catalogue are.

use super::equation::{Chart, Item, Method, Motion, Partner};
use super::planner::Planner;
use super::steps::Form;
use crate::derive::trace::{self, Formulas, Step, Sym, SymbolicSystem};
use crate::derive::{Kernel, Source};
use crate::structure::Structure;

/// An implicit method of a user: a type that names it, and an equation over any scalar whose unknown is a state.
#[derive(Clone, Copy, Debug)]
pub struct Own {
    /// The end of the name of the fused equation's type.
    pub name: &'static str,
    /// The path of the method's type where the generated code stands: `crate::Trapezoid`.
    pub method: &'static str,
    /// The path of the equation's type, whose parameters are a lifetime, the scalar and the system, and which has a
    /// function `new(system, h)`: `crate::TrapezoidEquation`.
    pub equation: &'static str,
    /// Doc lines of the fused equation.
    pub docs: &'static [&'static str],
    /// Formulas of its kernels, for their documentation.
    pub formulas: Formulas,
    /// Runs the equation over expressions: `|system, h| trace::step(TrapezoidEquation::new(system, h))`.
    pub trace: fn(&SymbolicSystem, Sym) -> Step,
}

impl Own {
    /// Whether the method can be fused with a system.
    ///
    /// # Errors
    /// Why it stays generic.
    pub fn check(&self, structure: &Structure) -> Result<(), String> {
        let method = self.method;
        if structure.energy.expression().is_none() {
            return Err(format!(
                "`{method}` stays generic: the Hamiltonian of `{}` has no expression",
                structure.name
            ));
        }
        match self.kernels(&mut Source::new(structure)) {
            Some(_) => Ok(()),
            None => Err(format!(
                "`{method}` stays generic: its equation compares numbers, so that it has no formula"
            )),
        }
    }

    fn kernels(&self, source: &mut Source) -> Option<Vec<Kernel>> {
        source.energy.expression()?;
        trace::kernels(source, &self.formulas, self.trace)
    }
}

impl Planner<'_> {
    /// The fused equation of a method that a user wrote, where it has one.
    pub(super) fn own(&mut self, own: &Own) {
        let Some(kernels) = own.kernels(&mut self.source) else {
            return;
        };
        let form = Form {
            docs: own.docs,
            motion: Motion::Either,
            chart: Some(Chart::OfPartner),
            ..Form::new(own.name, own.name, Partner::Own(own.equation))
        };
        let solver = self.fused(form, &kernels);
        self.items
            .push(Item::Method(Method::Own(own.method), solver));
    }
}
