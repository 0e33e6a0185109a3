//! Generating-function methods: fused functions for the generic equations of the exponential and of
//! coordinates of the second kind, and the fused equation with the Cayley map.

use super::constants::Table;
use super::equation::{Chart, Generating as Planned, Guess, Item, Motion, Solver, Unknown};
use super::planner::Planner;
use super::steps::Form;
use crate::derive::{Generating, Kernel, Shape};
use crate::methods::{Choice, Retraction};
use lie_symbolic::schedule::Program;

/// A function with more operations than this is not written out: its Hessian then comes from its
/// gradient over dual numbers, or all of it from the generic form.
const MOST_OPERATIONS: usize = 12_000;

/// How a method with a fused function is named.
struct Named {
    /// The end of the function's name.
    suffix: &'static str,
    /// Label in the table of operation counts, and id.
    label: &'static str,
    /// The function.
    formula: &'static str,
}

const FOUR: Named = Named {
    suffix: "Generating4",
    label: "generating4",
    formula: "`S = h H + h^3 S3` in exponential coordinates",
};
const SIX: Named = Named {
    suffix: "Generating6",
    label: "generating6",
    formula: "`S = h H + h^3 S3 + h^5 S5` in exponential coordinates",
};
const SECOND: Named = Named {
    suffix: "SecondKind2",
    label: "generating-second-kind2",
    formula: "`S = h H + h^2 S2` in coordinates of the second kind",
};

const REALIZED_FOUR: Named = Named {
    suffix: "HamiltonJacobi4",
    label: "k-hj4",
    formula: "`S = h H + h^3 S3` on the symplectic realization of the bracket",
};
const REALIZED_SIX: Named = Named {
    suffix: "HamiltonJacobi6",
    label: "k-hj6",
    formula: "`S = h H + h^3 S3 + h^5 S5` on the symplectic realization of the bracket",
};

impl Planner<'_> {
    /// The equation of a K-HJ method; that of order 2 has no function but H.
    pub(super) fn hamilton_jacobi(&mut self, order: u32) -> Option<Solver> {
        let named = match order {
            2 => return None,
            4 => REALIZED_FOUR,
            _ => REALIZED_SIX,
        };
        self.along_function(&named, Generating::First(Retraction::Exp, order))
    }

    /// The equation of a generating-function method with the exponential.
    pub(super) fn generating(&mut self, order: u32) -> Option<Solver> {
        let named = match order {
            4 => FOUR,
            _ => SIX,
        };
        self.along_function(&named, Generating::First(Retraction::Exp, order))
    }

    /// The same in coordinates of the second kind.
    pub(super) fn generating_second_kind(&mut self) -> Option<Solver> {
        let fused = self.second_kind();
        fused.or_else(|| self.along_function(&SECOND, Generating::Second))
    }

    /// A generic equation along a fused function; `None` if the function would be too long.
    fn along_function(&mut self, named: &Named, kind: Generating) -> Option<Solver> {
        let function = self.source.generating_function(kind)?;
        let short = function.gradient.program(&mut self.source.graph);
        if size(&short) > MOST_OPERATIONS {
            return None;
        }
        let long = function.linearize.and_then(|linearize| {
            let program = linearize.program(&mut self.source.graph);
            (size(&program) <= MOST_OPERATIONS).then_some((linearize, program))
        });
        let mut step = Table::default();
        let label = format!("{} gradient", named.label);
        let gradient = self.program_function(label, &function.gradient, &short, &mut step);
        let linearize = long.map(|(kernel, program)| {
            let label = format!("{} linearize", named.label);
            self.program_function(label, &kernel, &program, &mut step)
        });
        let planned = Planned {
            suffix: named.suffix,
            formula: named.formula,
            gradient,
            linearize,
            step: self.prepared(&step, "_h"),
        };
        self.items.push(Item::Generating(Box::new(planned)));
        let (choice, pattern) = match kind {
            Generating::Second => (
                Choice::GeneratingSecondKind2,
                self.second_kind_pattern(&function.pattern),
            ),
            Generating::First(retraction, order) if self.source.is_lie() => (
                Choice::Generating(order, retraction),
                self.exp_pattern(&function.pattern),
            ),
            Generating::First(_, order) => {
                // the way leaves no entry of the matrix zero that is worth an elimination of its own
                let partner = self.partner(&Choice::HamiltonJacobi(order));
                return Some(Solver::Generic(partner.with_own_code(named.suffix)));
            }
        };
        let partner = self.partner(&choice).with_own_code(named.suffix);
        Some(self.eliminated(partner, named.suffix, named.label, Unknown::State, pattern))
    }

    /// The equation in coordinates of the second kind, where every action has a closed form.
    fn second_kind(&mut self) -> Option<Solver> {
        let kernels = self.source.second_kind_kernels()?;
        if !self.short(&kernels) {
            return None;
        }
        let form = Form {
            docs: &[
                "The generating-function method in coordinates of the second kind, unknown p, with",
                "`S = h H + h^2 S2`: the actions `exp(xi_i ad*_(e_i))`, `xi = grad S(p)`, in closed form.",
            ],
            motion: Motion::Factor,
            ..Form::new(
                "SecondKind2Equation",
                SECOND.label,
                self.partner(&Choice::GeneratingSecondKind2),
            )
        };
        Some(self.fused(form, &kernels))
    }

    /// Whether the longest of the kernels of an equation may be written out.
    fn short(&mut self, kernels: &[Kernel]) -> bool {
        let mut kernels = kernels.iter();
        let longest = kernels.find(|kernel| matches!(kernel.shape, Shape::VectorAndMatrix(..)));
        longest
            .is_none_or(|kernel| size(&kernel.program(&mut self.source.graph)) <= MOST_OPERATIONS)
    }

    pub(super) fn cayley_generating(&mut self) -> Option<Solver> {
        let kernels = self.source.cayley_generating_kernels(4)?;
        if !self.short(&kernels) {
            return None;
        }
        let form = Form {
            docs: &[
                "The generating-function method of order 4 with the Cayley map, unknown p:",
                "`p - ad*_xi p/2 - Q_xi p/4 - mu = 0` with `xi = grad S(p)`, `S = h H + h^3 S3`, then",
                "`mu1 = mu + ad*_xi p`.",
            ],
            guess: Guess::HalfStep,
            motion: Motion::Factor,
            chart: Some(Chart::OfFactor),
            ..Form::new(
                "CayleyGenerating4",
                "generating4 cayley",
                self.partner(&Choice::Generating(4, Retraction::Cayley)),
            )
        };
        Some(self.fused(form, &kernels))
    }
}

/// All operations of a program.
fn size(program: &Program) -> usize {
    let counts = program.counts;
    counts.add + counts.mul + counts.div + counts.call
}
