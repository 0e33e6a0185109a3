//! The checked model: everything that derivation and emission need, with no mistake left in it.

mod attitude;
mod bracket;
mod casimir;
pub mod configuration;
mod constraint;
mod driving;
mod energy;
mod family;
mod larger;
mod quantity;
mod realization;
mod retraction;

use std::collections::HashSet;

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Invariance, Name, RunOption};
use lie_syntax::diagnostic::Origin;

pub use attitude::{Attitude, Form};
pub use bracket::{Algebra, Bracket, Cocycle, Extension, PoissonMatrix, bracket_of};
pub use casimir::{Casimir, CasimirKind};
pub use configuration::Configuration;
pub use constraint::{Constraint, Equation, Violation};
pub use driving::{Acting, Driving, Input};
pub use energy::{Discrete, ENTRIES, Energy, Hamiltonian, InEntries, Lagrangian};
pub use family::{
    Family, SiteData, SiteSum, Size, Start, apart, data_number, data_symbol, shared_number,
    shared_symbol, slope_symbol, wrong_bond,
};
pub use quantity::{Event, Quantity, QuantityKind, WORK};
pub use realization::{CANONICAL, Descent, Realization};
pub use retraction::Retraction;

/// A parameter of the system.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub origin: Origin,
    /// Its default, a constant expression.
    pub default: ExprId,
    /// The default in double precision.
    pub default_value: f64,
    /// The default of an exact parameter, which structure constants may use.
    pub exact: Option<Rational>,
    /// Whether it takes positive values only, which proofs use and which is checked when a system is made.
    pub positive: bool,
    /// Unit, for people, as Markdown within a line.
    pub unit: Option<String>,
    /// Description, for people, as Markdown.
    pub description: Option<String>,
}

/// A checked system.
///
/// The right-invariant sign is already in the bracket, so that `mu' = Pi(mu) grad H(mu)`, of an algebra
/// `mu' = ad*_{grad H} mu`, holds for every model.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the system.
    pub name: String,
    /// Where the name stands.
    pub name_origin: Origin,
    /// Description, by lines of Markdown.
    pub description: Vec<String>,
    /// References, for people, as Markdown within a line.
    pub references: Vec<String>,
    /// The arena of all expressions.
    pub graph: Graph,
    /// What the bracket is.
    pub bracket: Bracket,
    /// Names of the coordinates.
    pub coordinates: Vec<Name>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// How it was declared.
    pub invariance: Invariance,
    /// Where the equations of motion come from.
    pub energy: Energy,
    /// Where the Hamiltonian or the Lagrangian stands.
    pub energy_origin: Origin,
    /// What the velocity satisfies; the coordinates are those that are left then, and the bracket is almost Poisson.
    pub constraint: Option<Constraint>,
    /// What the coordinates beside mu are, of a system on `T*G` or one that depends on the time.
    pub configuration: Option<Configuration>,
    /// The sums of a family. All else is that of a site, and its Hamiltonian is 0.
    pub family: Option<Family>,
    /// What acts beside the Hamiltonian.
    pub driving: Option<Driving>,
    /// What is set from outside, the first of what is held.
    pub inputs: Vec<Input>,
    /// The realization, for collective methods.
    pub realization: Option<Realization>,
    /// The retraction of the user's own.
    pub retraction: Option<Retraction>,
    /// The Casimirs that are declared, those that are functions of others left out.
    pub declared_casimirs: Vec<Casimir>,
    /// What is recorded beside state, energy and Casimirs.
    pub quantities: Vec<Quantity>,
    /// The functions whose zeros along a run are found.
    pub events: Vec<Event>,
    /// The names that the declaration uses, so that nothing that is found is called the same.
    pub taken: HashSet<String>,
    /// Methods that get fused code.
    pub methods: Vec<Name>,
    /// The initial state, expressions in constants and parameters.
    pub initial: Option<Vec<ExprId>>,
    /// Where its entries stand.
    pub initial_origins: Vec<Origin>,
    /// The initial group element.
    pub attitude: Option<Attitude>,
    /// Defaults of the run.
    pub run: Vec<RunOption>,
    /// Rank of the Poisson matrix at a generic point and for generic values of the parameters.
    pub generic_rank: usize,
    /// Its rank at the initial state, rounded to double precision, with default parameters.
    pub initial_rank: Option<usize>,
}

impl Model {
    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    /// The value of an expression at the default parameters, where it depends on parameters alone and is finite.
    pub fn at_defaults(&self, graph: &Graph, id: ExprId) -> Option<f64> {
        let symbols = graph.symbols(id);
        let alone = symbols
            .iter()
            .all(|symbol| matches!(symbol, Symbol::Parameter(_)));
        let value = || {
            graph.evaluate(id, &|symbol| match symbol {
                Symbol::Parameter(k) => self.parameters[k].default_value,
                _ => f64::NAN,
            })
        };
        alone.then(value).filter(|value| value.is_finite())
    }

    /// Whether the bracket is the Lie–Poisson bracket of an algebra and nothing else.
    pub fn is_lie_poisson(&self) -> bool {
        matches!(self.bracket, Bracket::Lie(_))
    }

    /// Whether the time matters: H depends on it, or something acts.
    pub fn is_timed(&self) -> bool {
        let configuration = self.configuration.as_ref();
        let single = configuration.is_some_and(|c| c.time && !c.idle);
        single || self.family.as_ref().is_some_and(|family| family.timed)
    }

    /// Whether inputs or noise are held from step to step.
    pub fn holds(&self) -> bool {
        let configuration = self.configuration.as_ref();
        configuration.is_some_and(|configuration| !configuration.held.is_empty())
    }

    /// The Hamiltonian in mu; of [`Energy::Legendre`] in mu and its velocity.
    pub fn hamiltonian(&self) -> ExprId {
        self.energy.value(|hamiltonian| hamiltonian.value)
    }

    /// How many independent Casimirs a user may look for. The unit beside the time is one that nobody has to
    /// declare.
    pub fn casimirs_to_find(&self) -> usize {
        let unit = self.configuration.as_ref().is_some_and(|c| c.time);
        let held = self.configuration.as_ref().map_or(0, |c| c.held.len());
        (self.dimension() - self.generic_rank).saturating_sub(usize::from(unit) + held)
    }

    /// The brackets of the coordinates that are declared with theirs, without those that carry the time; none beside a group element.
    pub fn own_matrix(&self) -> Option<PoissonMatrix> {
        let mut matrix = self.bracket.matrix()?.clone();
        if let Some(configuration) = &self.configuration {
            if configuration.group.is_some() {
                return None;
            }
            matrix.dimension = configuration.own_momenta();
            matrix.entries.retain(|(_, j, _)| *j < matrix.dimension);
        }
        Some(matrix)
    }

    /// The coordinates that are shown: all but those that carry the time.
    pub fn shown_coordinates(&self) -> Vec<usize> {
        let hidden = |i: &usize| self.configuration.as_ref().is_some_and(|c| c.is_hidden(*i));
        (0..self.dimension()).filter(|i| !hidden(i)).collect()
    }

    /// The state for the values that a user gives: all coordinates, or of a system on `T*G` the momenta alone, at the declared
    /// attitude for these parameters or at the identity. With a constraint also in the declared coordinates. `None` where the number of
    /// values is another.
    pub fn complete_state(&self, given: &[f64], parameters: &[f64]) -> Option<Vec<f64>> {
        let reduced = self.on_constraint(given, parameters);
        let given = reduced.as_deref().unwrap_or(given);
        let Some(configuration) = &self.configuration else {
            return (given.len() == self.dimension()).then(|| given.to_vec());
        };
        let mut state = configuration.complete(given, Rational::to_f64)?;
        if let Some(attitude) = &self.attitude
            && given.len() == configuration.own_momenta()
        {
            let rows = attitude.rows(&self.graph, parameters);
            let entries = state[configuration.momenta..].iter_mut().zip(rows);
            let entries = entries.take(configuration.entries().len());
            entries.for_each(|(entry, value)| *entry = value);
        }
        Some(state)
    }

    /// The name of a symbol.
    pub fn symbol_name(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Coordinate(i) => self.coordinates[i].text.clone(),
            Symbol::Parameter(i) => self.parameters[i].name.clone(),
            Symbol::Step => "h".into(),
            Symbol::Time => "t".into(),
            Symbol::Input(i) => {
                let discrete = self.energy.lagrangian().and_then(|l| l.discrete.as_ref());
                let written = discrete.and_then(|discrete| discrete.in_entries.as_ref());
                let entry = i.checked_sub(ENTRIES);
                if let Some(name) = written.zip(entry).and_then(|(w, k)| w.name(k)) {
                    return name;
                }
                let canonical = i.checked_sub(CANONICAL);
                let names = match (canonical, &self.realization, self.energy.lagrangian()) {
                    (Some(place), Some(realization), _) => realization.names.get(place),
                    (None, _, Some(lagrangian)) => lagrangian.velocity.get(i),
                    _ => None,
                };
                names.map_or_else(|| format!("input{i}"), |name| name.text.clone())
            }
        }
    }

    /// An expression of the model as text.
    pub fn display(&self, expr: ExprId) -> String {
        self.graph.display(expr, &|symbol| self.symbol_name(symbol))
    }

    /// A recorded function as text.
    pub fn display_quantity(&self, quantity: &Quantity) -> String {
        match &self.family {
            Some(family) => self.display_of_sums(family, quantity.expr),
            None => self.display(quantity.expr),
        }
    }

    /// The Hamiltonian of a family as text, sums written out.
    pub fn display_of_family(&self, family: &Family) -> String {
        self.display_of_sums(family, family.energy)
    }

    fn display_of_sums(&self, family: &Family, function: ExprId) -> String {
        let sizes = family.sizes.iter().map(|size| match size {
            Size::Number(count) => count.to_string(),
            Size::Parameter(p) => self.parameters[*p].name.clone(),
        });
        let sizes: Vec<String> = sizes.collect();
        let own = &family.names[family.own * self.dimension()];
        let own = own.split_once('[').map_or("", |(_, rest)| rest);
        let indices: Vec<&str> = own.trim_end_matches(']').split(',').collect();
        let range = |(index, size): (usize, &String), spans: &[Option<(usize, usize)>]| {
            let name = indices.get(index).copied().unwrap_or("i");
            match spans[spans.len() - sizes.len() + index] {
                None | Some((0, 0)) => format!("{name} in 0..{size}"),
                Some((first, 0)) => format!("{name} in {first}..{size}"),
                Some((first, left)) => format!("{name} in {first}..{size}-{left}"),
            }
        };
        self.graph.display(function, &|symbol| match symbol {
            Symbol::Coordinate(place) => {
                let Some(sum) = place
                    .checked_sub(family.names.len())
                    .and_then(|k| family.sums.get(k))
                else {
                    return family.names[place].clone();
                };
                if sum.over_bonds {
                    return format!("sum(bonds: {})", self.display_of_bond(sum.summand));
                }
                let ranges = sizes.iter().enumerate().map(|size| range(size, &sum.spans));
                let ranges: Vec<String> = ranges.collect();
                let summand = self.display_at_site(family, sum.summand);
                format!("sum({}: {summand})", ranges.join(", "))
            }
            other => self.acting_name(other),
        })
    }

    /// A summand of bonds, whose first site has the index i.
    fn display_of_bond(&self, summand: ExprId) -> String {
        self.graph.display(summand, &|symbol| match symbol {
            Symbol::Coordinate(place) => {
                format!("{}[i]", self.coordinates[place % self.dimension()].text)
            }
            other => self.acting_name(other),
        })
    }

    fn display_at_site(&self, family: &Family, summand: ExprId) -> String {
        self.graph.display(summand, &|symbol| match symbol {
            Symbol::Coordinate(place) => family.names[place].clone(),
            other => self.acting_name(other),
        })
    }

    /// The default values of the parameters.
    pub fn defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default_value).collect()
    }

    /// The initial state for given values of the parameters.
    pub fn initial_values(&self, parameters: &[f64]) -> Option<Vec<f64>> {
        Some(at_parameters(
            &self.graph,
            self.initial.as_ref()?,
            parameters,
        ))
    }
}

/// Expressions at values of the parameters, of which alone they are made.
fn at_parameters(graph: &Graph, roots: &[ExprId], parameters: &[f64]) -> Vec<f64> {
    let value = |symbol| match symbol {
        Symbol::Parameter(p) => parameters[p],
        _ => f64::NAN,
    };
    graph.evaluate_all(roots, &value)
}
