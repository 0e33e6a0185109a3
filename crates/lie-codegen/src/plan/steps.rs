//! Which equation the step of each method solves: fused where asked for, generic elsewhere.

use std::collections::BTreeSet;

use super::constants::Table;
use super::elimination::Elimination;
use super::equation::{
    Chart, Ending, Fused, Guess, Item, Motion, Partner, Solver, Sparse, Unknown,
};
use super::pattern::Pattern;
use super::planner::Planner;
use crate::derive::{Kernel, Shape};
use crate::methods::{Carrier, Choice, Lift, Retraction, Row};
use crate::structure::inertia::Body;
use lie_symbolic::schedule::{Program, Value};

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
        let mut rows: Vec<&'static Row> = Row::all().iter().collect();
        rows.sort_by_key(|row| place(&row.choice));
        for row in rows {
            let Some(statement) = row.statement(|carrier| self.carries(carrier)) else {
                continue;
            };
            let solver = self
                .is_solved(&row.choice)
                .then(|| self.solver(&row.choice));
            match solver.flatten() {
                Some(solver) => {
                    let method = row.choice.clone().into();
                    self.items.push(Item::Method(method, solver));
                }
                None => generic.push(statement.key.to_owned()),
            }
        }
        self.series(&mut generic);
        generic
    }

    /// Whether a method that is asked for solves the equation of a choice, which is its own.
    fn is_solved(&self, choice: &Choice) -> bool {
        let carries = |carrier| self.carries(carrier);
        self.methods.iter().any(|method| {
            let equation = Row::find(method).equation(&carries);
            equation.is_some_and(|(own, _)| own == choice)
        })
    }

    /// Whether a method may move along the declared retraction: one that is asked for, or any where none is named.
    pub(super) fn follows_retraction(&self) -> bool {
        let along = |choice: &Choice| {
            matches!(
                choice.solved(),
                Choice::LieMidpoint(Retraction::Spec) | Choice::Variational(_, Retraction::Spec)
            )
        };
        let asked = self.methods.is_empty() || self.methods.iter().any(along);
        asked && self.structure.retraction.is_some()
    }

    /// Whether a method may step in the coordinates in which the bracket is constant: one that is asked for, or any where none is named.
    pub(super) fn follows_canonical(&self) -> bool {
        let along = |choice: &Choice| matches!(choice.solved(), Choice::Canonical(_));
        let asked = self.methods.is_empty() || self.methods.iter().any(along);
        asked && self.structure.conjugate.is_some() && self.source.energy.expression().is_some()
    }

    /// Whether the system has the generic equations of a carrier.
    fn carries(&self, carrier: Carrier) -> bool {
        let source = &self.source;
        let closed = source.triple().is_some();
        match carrier {
            Carrier::Any => true,
            Carrier::Algebra => source.is_lie(),
            Carrier::Closed => closed,
            Carrier::Retraction => self.follows_retraction(),
            Carrier::Canonical => self.follows_canonical(),
            Carrier::Matrices => source.matrices().is_some(),
            Carrier::Reductive => source.matrices().is_some() && !closed,
            Carrier::Spins => source.spins().is_some(),
            Carrier::Spheres => source.spheres().is_some(),
            Carrier::Body => matches!(source.body(), Some(Body::Three)),
            Carrier::BodyOfMany => matches!(source.body(), Some(Body::Many { .. })),
            Carrier::Lagrangian => source.energy.reduced().is_some(),
            Carrier::ClosedLagrangian => source.energy.reduced().is_some() && closed,
            Carrier::RetractedLagrangian => {
                source.energy.reduced().is_some() && self.follows_retraction()
            }
            Carrier::LagrangianOnGroup => source.is_transformed() && source.momenta().is_some(),
            Carrier::ClosedLagrangianOnGroup => self.carries(Carrier::LagrangianOnGroup) && closed,
            Carrier::DiscreteLagrangian => source.discrete().is_some(),
            Carrier::ClosedDiscreteLagrangian => source.discrete().is_some() && closed,
        }
    }

    /// The generic equation of a method.
    pub(super) fn partner(&self, choice: &Choice) -> Partner {
        let equation = Row::find(choice).equation(&|carrier| self.carries(carrier));
        let (of, equation) =
            equation.unwrap_or_else(|| unreachable!("the system has the equation"));
        Partner::Catalogue {
            of,
            equation,
            along: None,
        }
    }

    /// The equation of a method that has code of its own; none where that saves too little.
    fn solver(&mut self, choice: &Choice) -> Option<Solver> {
        // what acts beside H stands in the field, of which these are made
        let of_field = matches!(choice, Choice::Midpoint | Choice::Gauss(_));
        if (self.source.is_damped() || self.source.force().is_some()) && !of_field {
            return None;
        }
        match choice {
            Choice::Midpoint => Some(self.midpoint()),
            Choice::Gauss(stages) => match self.gauss(*stages) {
                Solver::Generic(_) => None,
                solver => Some(solver),
            },
            Choice::LieMidpoint(Retraction::Cayley) => self.cayley(),
            // without a closed form an elimination of its own saves under 3% beside the series of the exponential
            Choice::LieMidpoint(Retraction::Exp) => self.exp(),
            Choice::DiscreteGradient(gradient, _) => Some(self.discrete_gradient(*gradient)),
            Choice::OrbitEnergy(gradient) if self.source.is_lie() => {
                Some(self.orbit_energy(*gradient))
            }
            Choice::CohenHairer(order) => Some(self.cohen_hairer(*order as usize / 2)),
            Choice::Generating(_, Retraction::Cayley) => self.cayley_generating(),
            Choice::Generating(order, Retraction::Exp) => self.generating(*order),
            Choice::GeneratingSecondKind2 => self.generating_second_kind(),
            Choice::HamiltonJacobi(order) => self.hamilton_jacobi(*order),
            // with one stage an elimination of its own saves 2% of a step
            Choice::Collective(2, Lift::Hopf) => None,
            Choice::Collective(..) | Choice::Isospectral(_) => self.momenta(choice),
            Choice::SphericalMidpoint => self.spherical(),
            Choice::MoserVeselov => self.body(),
            _ => None,
        }
    }

    /// The Taylor series.
    fn series(&mut self, generic: &mut Vec<String>) {
        let mut methods = vec![(Choice::Taylor, "taylor")];
        if self.source.is_lie() {
            methods.push((Choice::LieTaylor, "lie_taylor"));
        }
        for (choice, key) in methods {
            // over truncated series nobody sees where branches change
            let joints = !self.structure.joints.is_empty();
            let own_functions = self.source.has_own_functions();
            if (joints || self.is_requested(&choice)) && !own_functions {
                let recurrence = self.recurrence(choice == Choice::LieTaylor);
                self.items.push(Item::Recurrence(Box::new(recurrence)));
            } else if !joints {
                generic.push(key.to_owned());
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
                ..Form::new("Midpoint", "midpoint", planner.partner(&Choice::Midpoint))
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
            let elimination = stage_elimination(stages, n, &pattern);
            let full = Elimination::multiplications_of_full(stages * n);
            if !elimination.is_unrolled() && 5 * elimination.multiplications() > 4 * full {
                return Solver::Generic(planner.partner(&Choice::Gauss(stages)));
            }
            let (suffix, label) = (format!("Gauss{order}"), format!("gauss{order}"));
            let unknown = Unknown::Stages(stages);
            let partner = planner.partner(&Choice::Gauss(stages));
            planner.eliminated(partner, &suffix, &label, unknown, pattern)
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
                self.partner(&Choice::LieMidpoint(Retraction::Cayley)),
            )
        };
        Some(self.fused(form, &kernels))
    }

    /// The retraction method with the exponential, where that has a closed form.
    fn exp(&mut self) -> Option<Solver> {
        let kernels = self.source.exp_kernels()?;
        let form = Form {
            docs: &[
                "The retraction method with the exponential, unknown the momentum `m` at the midpoint:",
                "`m - phi1(ad*_x) mu = 0` with `x = h grad H(m)`, `phi1(z) = (e^z - 1)/z`, then `mu1 = exp(ad*_x) mu`.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            ..Form::new(
                "ExpMidpoint",
                "lie-midpoint",
                self.partner(&Choice::LieMidpoint(Retraction::Exp)),
            )
        };
        Some(self.fused(form, &kernels))
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
                elimination = jacobian_elimination(self.source.dimension, places, &program);
            }
            let label = format!("{} {}", form.label, kernel.name);
            functions.push(self.program_function(label, kernel, &program, &mut step));
        }
        let has = |name: &str| kernels.iter().any(|kernel| kernel.name == name);
        let of_body = form.partner.choice() == Some(&Choice::MoserVeselov);
        let ending = match has("result") {
            true => Ending::Kernel,
            false if of_body => Ending::Partner,
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
        match self.source.matrices() {
            Some(numbers) => spectrum(&numbers.matrices) != Spectrum::Imaginary,
            None => !self.source.is_imaginary(),
        }
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
            elimination: stage_elimination(unknown.states(), self.source.dimension, &block),
        };
        self.items.push(Item::Sparse(sparse));
        self.eliminations.push((unknown, block, name.clone()));
        Solver::Eliminated(partner, name)
    }
}

/// The place of a method in the order in which equations are planned, and their constants numbered.
fn place(choice: &Choice) -> (u32, u32) {
    match choice {
        Choice::Midpoint => (0, 0),
        Choice::Gauss(_) => (1, 0),
        Choice::LieMidpoint(Retraction::Cayley) => (2, 0),
        Choice::LieMidpoint(Retraction::Exp) => (3, 0),
        Choice::DiscreteGradient(gradient, _) | Choice::OrbitEnergy(gradient) => {
            (4, *gradient as u32)
        }
        Choice::CohenHairer(_) => (5, 0),
        Choice::Generating(_, Retraction::Exp) => (6, 0),
        Choice::GeneratingSecondKind2 => (7, 0),
        Choice::Generating(_, Retraction::Cayley) => (8, 0),
        Choice::Isospectral(_) => (9, 0),
        Choice::HamiltonJacobi(_) => (10, 0),
        _ => (11, 0),
    }
}

/// The elimination of a pattern that repeats a block for each pair of stages; rows outside the pattern are those of the
/// identity.
pub(super) fn stage_elimination(stages: usize, n: usize, block: &Pattern) -> Elimination {
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
fn jacobian_elimination(n: usize, places: &[(usize, usize)], program: &Program) -> Elimination {
    let matrix = &program.outputs[program.outputs.len() - places.len()..];
    let one = |value: &Value| matches!(value, Value::Number(number) if number.is_one());
    let entries = places.iter().zip(matrix);
    let unit = entries.filter(|((i, j), value)| i == j && one(value));
    let left_out = (0..n).filter(|row| places.iter().all(|(i, _)| i != row));
    let unit: BTreeSet<usize> = unit.map(|((i, _), _)| *i).chain(left_out).collect();
    Elimination::new(n, places, &unit)
}
