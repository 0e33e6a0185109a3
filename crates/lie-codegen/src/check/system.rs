//! Everything behind names and sizes: the expressions, then the identities among them, then the model.

use super::algebra::{self, Algebra};
use super::casimirs::{self, Candidate};
use super::energy::Declared;
use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use super::{
    breadth, cocycle, defaults, domain, energy, initial, lets, matrix, naming, opaque, parameters,
    poisson, realization, sign, size,
};
use crate::algebra::rank as algebra_rank;
use crate::model::configuration::Configuration;
use crate::model::{
    self, Bracket, Casimir, Energy, Hamiltonian, Model, Parameter, PoissonMatrix, Realization,
};
use lie_symbolic::exact::Rational;
use lie_symbolic::prove::degree;
use lie_symbolic::symbolic::{ExprId, Graph};
use lie_syntax::ast::{self, Declaration};
use lie_syntax::diagnostic::{Origin, Report};

/// Checks a declaration; of a system on `T*G` it is the one with all coordinates.
pub fn check(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    report: &mut Report,
) -> Option<Model> {
    let lowered = lowered(declaration, configuration, report)?;
    let algebra = lowered.algebra.as_ref();
    let defaults = defaults::check(declaration, algebra, &lowered.parameters, report)?;
    let mut system = System::of(declaration, configuration, lowered, report)?;
    system.sizes(report);
    if report.has_errors() {
        return None;
    }
    let bracket = system.bracket(report);
    let degrees = system.casimir_degrees(report);
    system.check_realization(report);
    let candidates = std::mem::take(&mut system.candidates);
    let casimirs = naming::independent(declaration, &system.graph, candidates, &degrees?, report);
    let rank = system.generic_rank(&bracket, casimirs.len());
    let energy = system.energy();
    let (mut model, matrix, mut scratch) = system.into_model(bracket, energy, casimirs, &rank);
    domain::check(&model, declaration.initial_origin, report);
    if report.has_errors() {
        return None;
    }
    model.initial_rank = initial_rank(&model, (&matrix, &mut scratch), &defaults);
    // where no sample is in the domain, what is known is the rank at the initial state
    if rank.generic.is_none() {
        model.generic_rank = model.initial_rank.unwrap_or(rank.bound);
    }
    Some(model)
}

/// The rank at the initial state, rounded to double precision, with default parameters.
fn initial_rank(
    model: &Model,
    (matrix, scratch): (&PoissonMatrix, &mut Graph),
    defaults: &[Rational],
) -> Option<usize> {
    let mu = model.initial_values(&model.defaults())?;
    match &model.bracket {
        Bracket::Lie(algebra) => {
            let mu: Option<Vec<Rational>> = mu.into_iter().map(Rational::from_f64).collect();
            algebra_rank::at(&algebra.exact, &mu?, defaults, model.generic_rank)
        }
        _ => matrix::initial_rank(model, matrix, scratch, &mu),
    }
}

/// All expressions of a declaration in one arena.
struct Lowered {
    graph: Graph,
    algebra: Option<Algebra>,
    parameters: Vec<Parameter>,
    brackets: Vec<poisson::Entry>,
    energy: ExprId,
    casimirs: Vec<ExprId>,
    realization: Option<Realization>,
    initial: Option<Vec<ExprId>>,
}

/// Lowers everything, so that the mistakes of all expressions are reported together.
fn lowered(
    declaration: &Declaration,
    configuration: Option<&Configuration>,
    report: &mut Report,
) -> Option<Lowered> {
    let algebra = match declaration.algebra() {
        Some(algebra) => algebra::check(declaration, algebra, report).map(Some),
        None => Some(None),
    };
    cocycle::parameters(declaration, report);
    let mut graph = Graph::new();
    let mut environment = Environment::new(declaration);
    let parameters = parameters::check(declaration, &mut graph, &environment, report);
    lets::check(declaration, &mut graph, &mut environment, report);
    let brackets = poisson::check(declaration, &mut graph, &environment, report);
    let mut lower =
        |expr, allowed| Lowering::new(&mut graph, &environment, report, allowed).lower(expr);
    let energy = lower(
        declaration.energy.expression(),
        match declaration.energy {
            ast::Energy::Hamiltonian(_) => Allowed::State,
            ast::Energy::Lagrangian { .. } | ast::Energy::DiscreteLagrangian { .. } => {
                Allowed::Velocity(configuration.map_or(usize::MAX, |c| c.momenta))
            }
        },
    );
    let casimirs = declaration.casimirs.iter();
    let casimirs: Vec<_> = casimirs.map(|c| lower(&c.value, Allowed::State)).collect();
    let realization =
        realization::lower(declaration, configuration, &mut graph, &environment, report);
    let initial = initial::check(declaration, &mut graph, &environment, report);
    opaque::check(declaration, &graph, brackets.as_deref(), energy, report);
    if report.has_errors() {
        return None;
    }
    Some(Lowered {
        graph,
        algebra: algebra?,
        parameters: parameters?,
        brackets: brackets?,
        energy: energy?,
        casimirs: casimirs.into_iter().collect::<Option<_>>()?,
        realization: realization?,
        initial: initial?,
    })
}

/// A system whose expressions are known, and whose identities are not proven.
struct System<'a> {
    declaration: &'a Declaration,
    configuration: Option<&'a Configuration>,
    /// The arena of the model.
    graph: Graph,
    /// One that may be littered, with the Poisson matrix in it.
    scratch: Graph,
    /// As the system has it: the opposite one of a right-invariant declaration.
    algebra: Option<model::Algebra>,
    brackets: Vec<poisson::Entry>,
    matrix: PoissonMatrix,
    declared: Energy<Declared>,
    candidates: Vec<Candidate>,
    parameters: Vec<Parameter>,
    realization: Option<Realization>,
    initial: Option<Vec<ExprId>>,
}

/// The rank of the Poisson matrix at a generic point, if there is one in the domain, and a bound of it.
struct Rank {
    generic: Option<usize>,
    bound: usize,
}

impl<'a> System<'a> {
    /// The system of lowered expressions, with its Hamiltonian and its Poisson matrix.
    fn of(
        declaration: &'a Declaration,
        configuration: Option<&'a Configuration>,
        lowered: Lowered,
        report: &mut Report,
    ) -> Option<Self> {
        let Lowered {
            mut graph,
            algebra,
            parameters,
            brackets,
            energy,
            casimirs,
            realization,
            initial,
        } = lowered;
        let algebra = algebra.map(|algebra| algebra.of_system(declaration, &mut graph));
        if algebra.is_some() {
            cocycle::values(&brackets, &graph, &parameters, report);
        }
        let is_lie = algebra.is_some() && brackets.is_empty();
        let motion = energy::Motion {
            declaration,
            parameters: &parameters,
            configuration,
            on_algebra: configuration.is_none() && is_lie,
        };
        let declared = motion.energy(&mut graph, energy, report)?;
        let mut scratch = graph.clone();
        let constants = algebra.as_ref().map(|algebra| &algebra.constants);
        let matrix = matrix::of(&mut scratch, declaration.dimension(), constants, &brackets);
        // The matrix of an algebra is looked at here and no more: it leaves the arena as it is.
        if !is_lie {
            graph = scratch.clone();
        }
        Some(Self {
            declaration,
            configuration,
            graph,
            scratch,
            algebra,
            brackets,
            matrix,
            declared,
            candidates: naming::named(declaration, &casimirs),
            parameters,
            realization,
            initial,
        })
    }

    /// The Hamiltonian, and where it stands.
    fn hamiltonian(&self) -> (ExprId, Origin) {
        let function = match &self.declared {
            Energy::Expression(hamiltonian) | Energy::Lagrangian(_, hamiltonian) => {
                hamiltonian.value
            }
            Energy::Legendre(_, function) => *function,
        };
        (function, self.declaration.energy.expression().origin)
    }

    /// Reports what is too large for what comes next.
    fn sizes(&self, report: &mut Report) {
        let declaration = self.declaration;
        let place = declaration
            .algebra()
            .map_or(declaration.place(), |algebra| algebra.origin);
        let (energy, matrix) = (self.hamiltonian(), &self.matrix);
        if breadth::check(&self.scratch, (matrix, place), energy, report) {
            let functions: Vec<_> = self.candidates.iter().map(|c| (c.expr, c.origin)).collect();
            size::derived(&self.scratch, matrix, energy, &functions, report);
        }
    }

    /// What the bracket is, its identities proven.
    fn bracket(&mut self, report: &mut Report) -> Bracket {
        let (declaration, brackets) = (self.declaration, &self.brackets);
        let scratch = &mut self.scratch;
        let mut matrix = self.matrix.clone();
        match self.algebra.clone() {
            Some(algebra) if brackets.is_empty() => Bracket::Lie(algebra),
            Some(algebra) => {
                cocycle::check(declaration, brackets, &algebra.constants, scratch, report);
                matrix.degree = Some(1);
                Bracket::Extended(algebra, matrix)
            }
            None => {
                poisson::jacobi(declaration, brackets, scratch, report);
                let degrees = matrix.entries.iter();
                let mut degrees = degrees.map(|(.., value)| degree::degree(&self.graph, *value));
                matrix.degree = degrees.try_fold(0, |most, degree| Some(most.max(degree?)));
                Bracket::General(matrix)
            }
        }
    }

    /// The degrees of the Casimirs, `None` if one is none. Of a bracket of an algebra it is said which of the declared
    /// ones seems to have the wrong sign.
    fn casimir_degrees(&mut self, report: &mut Report) -> Option<Vec<Option<u32>>> {
        let name = |symbol| poisson::symbol_name(self.declaration, symbol);
        let (matrix, scratch) = (&self.matrix, &mut self.scratch);
        let mut found = Report::new();
        let candidates = self.candidates.iter();
        let degrees = candidates.map(|c| casimirs::check(c, scratch, matrix, &name, &mut found));
        let degrees: Vec<Option<Option<u32>>> = degrees.collect();
        let failed = found.has_errors();
        let mut found = found.into_diagnostics();
        let on_algebra = self.configuration.is_none() && self.brackets.is_empty();
        if let Some(algebra) = self.algebra.as_ref().filter(|_| failed && on_algebra) {
            let candidates = &self.candidates;
            sign::explain(
                self.declaration,
                &algebra.exact,
                candidates,
                scratch,
                &mut found,
            );
        }
        found.into_iter().for_each(|d| report.push(d));
        degrees.into_iter().collect()
    }

    /// Checks the realization against the bracket.
    fn check_realization(&mut self, report: &mut Report) {
        if let Some(realization) = &mut self.realization {
            let name = |symbol| poisson::symbol_name(self.declaration, symbol);
            realization::check(realization, &self.matrix, &mut self.scratch, &name, report);
        }
    }

    /// The rank at generic points, of a system with this many independent Casimirs.
    fn generic_rank(&mut self, bracket: &Bracket, casimirs: usize) -> Rank {
        let dimension = self.declaration.dimension();
        let bound = (dimension - casimirs.min(dimension)) & !1;
        let generic = match bracket {
            Bracket::Lie(algebra) => Some(algebra_rank::generic(&algebra.exact, bound)),
            _ => matrix::generic_rank(&mut self.scratch, &self.matrix, bound),
        };
        Rank { generic, bound }
    }

    /// The energy with what is known of its Hamiltonian.
    fn energy(&self) -> Energy {
        let scratch = &self.scratch;
        self.declared
            .clone()
            .with(|Declared { value, energy }| Hamiltonian {
                value,
                energy,
                degree: degree::degree(scratch, value),
            })
    }

    /// The model, with what its rank at the initial state is computed from.
    fn into_model(
        self,
        bracket: Bracket,
        energy: Energy,
        casimirs: Vec<Casimir>,
        rank: &Rank,
    ) -> (Model, PoissonMatrix, Graph) {
        let System {
            graph,
            scratch,
            matrix,
            parameters,
            realization,
            initial,
            declaration,
            configuration,
            ..
        } = self;
        let initial_origins = declaration.initial.iter().flatten().map(|e| e.origin);
        let model = Model {
            name: declaration.name.text.clone(),
            name_origin: declaration.name.origin,
            description: declaration.description.clone(),
            references: declaration.references.clone(),
            graph,
            bracket,
            coordinates: declaration.state.clone(),
            parameters,
            invariance: declaration.invariance,
            energy,
            energy_origin: declaration.energy.expression().origin,
            configuration: configuration.cloned(),
            family: None,
            realization,
            declared_casimirs: casimirs,
            taken: naming::taken(declaration),
            methods: declaration.methods.clone(),
            initial,
            initial_origins: initial_origins.collect(),
            run: declaration.run.clone(),
            generic_rank: rank.generic.unwrap_or(rank.bound),
            initial_rank: None,
        };
        (model, matrix, scratch)
    }
}
