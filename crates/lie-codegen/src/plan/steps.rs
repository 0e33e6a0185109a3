//! Which equation the step of each method solves: fused where asked for, generic elsewhere.

use std::collections::BTreeSet;

use lie_core::methods::gauss::BY_NEWTON;

use super::constants::Table;
use super::elimination::Elimination;
use super::equation::{
    Chart, Ending, Fused, Guess, Item, Motion, Partner, Solver, Sparse, Unknown,
};
use super::pattern::Pattern;
use super::planner::Planner;
use crate::derive::{Kernel, Shape};
use crate::methods::{CATALOGUE, Choice, Lift, Retraction};
use crate::schedule::{Program, Value};

/// What distinguishes one fused equation from another.
pub(super) struct Form {
    /// The end of its type's name.
    pub suffix: &'static str,
    /// Label in the table of operation counts.
    pub label: &'static str,
    /// Its doc lines.
    pub docs: &'static [&'static str],
    /// Where Newton's iteration begins.
    pub guess: Guess,
    /// The generic equation of the same step.
    pub partner: Partner,
    /// How a step moves the group element.
    pub motion: Motion,
    /// The element that must be joined to the identity.
    pub chart: Option<Chart>,
}

impl Form {
    /// A step whose unknown is its end, from a guess along the field.
    pub fn new(suffix: &'static str, label: &'static str, partner: Partner) -> Self {
        Self {
            suffix,
            label,
            docs: &[],
            guess: Guess::WholeStep,
            partner,
            motion: Motion::Velocity,
            chart: None,
        }
    }
}

impl Planner<'_> {
    /// Plans the equation of each method; the keys of those that stay generic.
    pub(super) fn equations(&mut self) -> Vec<String> {
        let mut generic = Vec::new();
        let gauss = CATALOGUE.iter().filter(|row| row.id.starts_with("gauss"));
        let gauss = gauss.filter_map(|row| Some((Choice::from_id(row.id).ok()?, row.id)));
        // those of more stages have no equation: they run on the field over all stages at once
        let gauss = gauss.filter(|(choice, _)| match choice {
            Choice::Gauss(stages) => *stages <= BY_NEWTON,
            _ => false,
        });
        let mut methods = vec![(Choice::Midpoint, "midpoint")];
        methods.extend(gauss);
        methods.push((Choice::LieMidpoint(Retraction::Cayley), "cayley"));
        for (choice, key) in methods {
            let cayley = choice == Choice::LieMidpoint(Retraction::Cayley);
            if cayley && self.source.triple().is_none() {
                continue;
            }
            let asked = self.asked(&choice) || (cayley && self.asked_beside_cayley());
            match asked.then(|| self.solver(&choice)).flatten() {
                Some(solver) => self.items.push(Item::Method(choice.into(), solver)),
                None => generic.push(key.to_owned()),
            }
        }
        if self.source.is_lie() {
            // without a closed form an elimination of its own saves under 3% beside the series of the exponential
            let choice = Choice::LieMidpoint(Retraction::Exp);
            self.method(&mut generic, choice, "exp", Self::exp);
        }
        self.energy(&mut generic);
        if self.source.is_lie() {
            self.generating(&mut generic);
            self.collective(&mut generic);
        }
        self.lagrangian(&mut generic);
        self.series(&mut generic);
        generic
    }

    /// The Taylor series.
    fn series(&mut self, generic: &mut Vec<String>) {
        let mut methods = vec![(Choice::Taylor, "taylor")];
        if self.source.is_lie() {
            methods.push((Choice::LieTaylor, "lie_taylor"));
        }
        for (choice, key) in methods {
            if self.asked(&choice) && !self.source.has_own_functions() {
                let recurrence = self.recurrence(choice == Choice::LieTaylor);
                self.items.push(Item::Recurrence(Box::new(recurrence)));
            } else {
                generic.push(key.to_owned());
            }
        }
    }

    /// Whether another method that is asked for runs on the equation of the Cayley map.
    fn asked_beside_cayley(&self) -> bool {
        let beside = [
            Choice::Generating(2, Retraction::Cayley),
            Choice::Isospectral(2),
            Choice::Collective(2, Lift::Representation),
        ];
        beside.iter().any(|choice| self.asked(choice))
    }

    fn solver(&mut self, choice: &Choice) -> Option<Solver> {
        match choice {
            Choice::Midpoint => Some(self.midpoint()),
            Choice::Gauss(stages) => Some(self.gauss(*stages)),
            Choice::LieMidpoint(Retraction::Cayley) => self.cayley(),
            _ => None,
        }
    }

    /// The equations of systems by a Lagrangian, which are generic.
    fn lagrangian(&mut self, generic: &mut Vec<String>) {
        let kinds = [
            (self.source.energy.lagrangian().is_some(), "variational"),
            (self.source.discrete().is_some(), "discrete"),
        ];
        for (_, key) in kinds.into_iter().filter(|(present, _)| *present) {
            generic.push(key.to_owned());
            if self.source.triple().is_some() {
                generic.push(format!("{key}_cayley"));
            }
        }
    }

    pub(super) fn midpoint(&mut self) -> Solver {
        self.once("midpoint", |planner| {
            let kernels = planner.source.midpoint_kernels();
            let form = Form {
                docs: &[
                    "The Poisson midpoint rule, unknown `u = mu1`: `u - mu - h f((mu + u)/2) = 0`.",
                ],
                ..Form::new("Midpoint", "midpoint", Partner::Midpoint)
            };
            planner.fused(form, &kernels)
        })
    }

    /// Gauss collocation, with an elimination of its own where that saves at least a twentieth of the step: a long one of
    /// a nearly full pattern is cheaper without index lists (`lab/docs/method_costs.md`).
    pub(super) fn gauss(&mut self, stages: usize) -> Solver {
        let order = 2 * stages;
        self.once(&format!("gauss{order}"), |planner| {
            let pattern = planner.field_pattern();
            let n = planner.source.dimension;
            let elimination = of_stages(stages, n, &pattern);
            let full = Elimination::multiplications_of_full(stages * n);
            if !elimination.is_unrolled() && 5 * elimination.multiplications() > 4 * full {
                return Solver::Generic(Partner::Gauss(stages));
            }
            let (suffix, label) = (format!("Gauss{order}"), format!("gauss{order}"));
            let unknown = Unknown::Stages(stages);
            planner.eliminated(Partner::Gauss(stages), &suffix, &label, unknown, pattern)
        })
    }

    fn cayley(&mut self) -> Option<Solver> {
        let kernels = self.source.cayley_kernels()?;
        let form = Form {
            docs: &[
                "The retraction method with the Cayley map, unknown the momentum `m` at the midpoint:",
                "`m - ad*_x m/2 - Q_x m/4 - mu = 0` with `x = h grad H(m)`, then `mu1 = mu + ad*_x m`.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            chart: Some(Chart::OfField),
            ..Form::new(
                "CayleyMidpoint",
                "lie-midpoint cayley",
                Partner::CayleyMidpoint,
            )
        };
        Some(self.fused(form, &kernels))
    }

    /// The retraction method with the exponential, where that has a closed form. Methods of the generating function `h H`
    /// have the same equation.
    pub(super) fn exp(&mut self) -> Option<Solver> {
        let known = self.known.iter().find(|(name, _)| name == "exp");
        if let Some((_, known)) = known {
            return Some(known.clone());
        }
        let kernels = self.source.exp_kernels()?;
        let form = Form {
            docs: &[
                "The retraction method with the exponential, unknown the momentum `m` at the midpoint:",
                "`m - phi1(ad*_x) mu = 0` with `x = h grad H(m)`, `phi1(z) = (e^z - 1)/z`, then `mu1 = exp(ad*_x) mu`.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            ..Form::new("ExpMidpoint", "lie-midpoint", Partner::ExpMidpoint)
        };
        Some(self.once("exp", |planner| planner.fused(form, &kernels)))
    }

    /// An equation that is planned once.
    pub(super) fn once(&mut self, key: &str, make: impl FnOnce(&mut Self) -> Solver) -> Solver {
        if let Some((_, known)) = self.known.iter().find(|(name, _)| name == key) {
            return known.clone();
        }
        let solver = make(self);
        self.known.push((key.to_owned(), solver.clone()));
        solver
    }

    /// A fused equation of these kernels.
    pub(super) fn fused(&mut self, form: Form, kernels: &[Kernel]) -> Solver {
        let mut step = Table::default();
        let mut elimination = Elimination::default();
        let mut functions = Vec::new();
        for kernel in kernels {
            let program = kernel.program(&mut self.source.graph);
            if let Shape::VectorAndMatrix(_, places) = &kernel.shape {
                elimination = of_jacobian(self.source.dimension, places, &program);
            }
            let label = format!("{} {}", form.label, kernel.name);
            functions.push(self.of_program(label, kernel, &program, &mut step));
        }
        let has = |name: &str| kernels.iter().any(|kernel| kernel.name == name);
        let bodies = [Partner::DiscreteTop, Partner::DiscreteBody];
        let ending = match has("result") {
            true => Ending::Kernel,
            false if bodies.contains(&form.partner) => Ending::Partner,
            false => Ending::Unknown,
        };
        let fused = Fused {
            suffix: form.suffix,
            docs: form.docs,
            elimination,
            step: self.prepared(&step, "_h"),
            guess: if has("initial_guess") {
                Guess::Kernel
            } else {
                form.guess
            },
            partner: form.partner,
            motion: form.motion,
            chart: form
                .chart
                .filter(|chart| *chart == Chart::OfPartner || self.has_poles()),
            ending,
            functions,
        };
        self.items.push(Item::Fused(Box::new(fused)));
        Solver::Fused(form.suffix)
    }

    /// Whether the Cayley map of the representation has poles along real elements.
    pub(super) fn has_poles(&self) -> bool {
        use crate::structure::spectrum::{Spectrum, spectrum};
        let representation = self.source.matrices();
        representation.is_none_or(|r| spectrum(&r.matrices) != Spectrum::Imaginary)
    }

    /// A generic equation under an elimination of its pattern, one block for each pair of stages. Equal patterns share
    /// the elimination of the first.
    pub(super) fn eliminated(
        &mut self,
        partner: Partner,
        suffix: &str,
        label: &str,
        unknown: Unknown,
        block: Pattern,
    ) -> Solver {
        let known = self.eliminations.iter();
        let mut known = known.filter(|(of, pattern, _)| *of == unknown && *pattern == block);
        if let Some((_, _, name)) = known.next() {
            return Solver::Eliminated(partner, name.clone());
        }
        let name = format!("{suffix}Elimination");
        let sparse = Sparse {
            suffix: name.clone(),
            label: format!("{label} elimination"),
            unknown,
            elimination: of_stages(unknown.states(), self.source.dimension, &block),
        };
        self.items.push(Item::Sparse(sparse));
        self.eliminations.push((unknown, block, name.clone()));
        Solver::Eliminated(partner, name)
    }
}

/// The elimination of a pattern that repeats a block for each pair of stages; rows outside the pattern are those of the
/// identity.
pub(super) fn of_stages(stages: usize, n: usize, block: &Pattern) -> Elimination {
    let mut pattern = Vec::new();
    for row in 0..stages {
        for column in 0..stages {
            pattern.extend(block.iter().map(|(i, j)| (row * n + i, column * n + j)));
        }
    }
    let rows: BTreeSet<usize> = pattern.iter().map(|(row, _)| *row).collect();
    let unit = (0..stages * n).filter(|row| !rows.contains(row)).collect();
    Elimination::new(stages * n, &pattern, &unit)
}

/// The elimination of a Jacobian; diagonal entries that are the number one are known to be it. So are those of empty rows,
/// whose unknowns the iteration leaves out.
fn of_jacobian(n: usize, places: &[(usize, usize)], program: &Program) -> Elimination {
    let matrix = &program.outputs[program.outputs.len() - places.len()..];
    let one = |value: &Value| matches!(value, Value::Number(number) if number.is_one());
    let entries = places.iter().zip(matrix);
    let unit = entries.filter(|((i, j), value)| i == j && one(value));
    let left_out = (0..n).filter(|row| places.iter().all(|(i, _)| i != row));
    let unit: BTreeSet<usize> = unit.map(|((i, _), _)| *i).chain(left_out).collect();
    Elimination::new(n, places, &unit)
}
