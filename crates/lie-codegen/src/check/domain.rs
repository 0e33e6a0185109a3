//! The domain: the Hamiltonian, its gradient and the Casimirs must be finite where a run begins.

mod sizes;

use super::velocity::velocity;
use super::{attitude, retraction};
use crate::model::{Bracket, Energy, Model, QuantityKind, Retraction};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Node, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use std::sync::OnceLock;

/// A group element within this of the group is one, written with few digits.
const OFF_THE_GROUP: f64 = 1e-4;

/// Something that is not finite at a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The coordinate that is involved, the first if there are several.
    pub coordinate: Option<usize>,
    /// What is not finite.
    pub message: String,
}

/// What is not finite at the initial state, at the entry that is involved.
pub fn initial_domain(model: &Model, origin: Option<Origin>) -> Option<Diagnostic> {
    let parameters = model.defaults();
    let fault = fault(model, &model.initial_values(&parameters)?, &parameters)?;
    let origins = &model.initial_origins;
    let entry = fault.coordinate.and_then(|i| origins.get(i));
    let group = model
        .configuration
        .as_ref()
        .is_some_and(|c| c.group.is_some());
    let help = match model.bracket {
        _ if group => "begin at an element of the group, inside the domain of the Hamiltonian",
        Bracket::General(_) => {
            "begin inside the domain of the brackets, of the Hamiltonian and of the Casimirs"
        }
        _ => "begin inside the domain of the Hamiltonian and of the Casimirs",
    };
    let message = format!("{} at the initial state", fault.message);
    let place = entry.copied().or(origin).or(origins.first().copied());
    let place = place.unwrap_or(model.name_origin);
    Some(Diagnostic::new(Kind::Domain, place, message).help(help))
}

/// The first thing that is not finite at a state: a coordinate, the Hamiltonian, a component of
/// its gradient, a Casimir, a bracket of a general Poisson matrix.
pub fn fault(model: &Model, mu: &[f64], parameters: &[f64]) -> Option<Fault> {
    Domain::of(model).fault(model, mu, parameters)
}

/// What must be finite, derived once for many states.
pub struct Domain {
    graph: Graph,
    /// The functions with their names.
    functions: Vec<(ExprId, String)>,
    /// All that they are made of: children come before parents.
    parts: Vec<ExprId>,
    /// Whether the initial group element depends on parameters; one that does not was looked at with the declaration.
    attitude_varies: bool,
    /// What must hold of a retraction that depends on parameters.
    retraction: Option<retraction::Identities>,
    /// The default parameters.
    defaults: Vec<f64>,
    /// Up to which size of the entries all is finite, at the first parameters that were asked for.
    certain: OnceLock<(Vec<f64>, Option<f64>)>,
}

impl Domain {
    /// Of a model.
    pub fn of(model: &Model) -> Self {
        let mut graph: Graph = model.graph.clone();
        let mut functions = functions(model, &mut graph);
        // what a function of the user is at a state is known at run time
        functions.retain(|(id, _)| graph.own_functions(*id).is_empty());
        let roots: Vec<ExprId> = functions.iter().map(|(id, _)| *id).collect();
        let attitude = model.attitude.iter();
        let mut entries = attitude.flat_map(|attitude| &attitude.entries);
        let retraction = model.retraction.iter();
        let varies = |entry: &ExprId| {
            let symbols = graph.symbols(*entry);
            symbols.iter().any(|s| matches!(s, Symbol::Parameter(_)))
        };
        let varies = retraction.flat_map(Retraction::entries).any(varies);
        Self {
            defaults: model.defaults(),
            certain: OnceLock::new(),
            retraction: varies.then(|| retraction::Identities::of(model)).flatten(),
            attitude_varies: entries.any(|entry| !graph.symbols(*entry).is_empty()),
            parts: graph.dependencies(&roots),
            graph,
            functions,
        }
    }

    /// The first thing that is not finite at a state, see [`fault`]. The model is that of this domain.
    pub fn fault(&self, model: &Model, mu: &[f64], parameters: &[f64]) -> Option<Fault> {
        if let Some(i) = mu.iter().position(|value| !value.is_finite()) {
            let message = format!("`{}` is not finite", model.coordinates[i].text);
            return Some(Fault {
                coordinate: Some(i),
                message,
            });
        }
        if parameters != self.defaults
            && let Some(message) = undetermined(model, parameters)
        {
            return Some(Fault {
                coordinate: None,
                message,
            });
        }
        if self.attitude_varies
            && let Some(wrong) = attitude::violation(model, parameters)
        {
            return Some(Fault {
                coordinate: None,
                message: wrong.message,
            });
        }
        let retraction = self.retraction.as_ref();
        if let Some((message, _)) = retraction.and_then(|retraction| retraction.wrong(parameters)) {
            return Some(Fault {
                coordinate: None,
                message,
            });
        }
        if let Some(fault) = outside_the_group(model, mu) {
            return Some(fault);
        }
        if self.is_certain(mu, parameters) {
            return None;
        }
        let xi = match &model.energy {
            Energy::Legendre(lagrangian, _) => {
                let mut scratch = self.graph.clone();
                match velocity(&mut scratch, lagrangian, mu, parameters) {
                    Some(xi) => xi,
                    None => return Some(no_velocity()),
                }
            }
            _ => Vec::new(),
        };
        let value = |symbol| match symbol {
            Symbol::Coordinate(i) => mu[i],
            Symbol::Parameter(p) => parameters[p],
            Symbol::Input(i) => xi.get(i).copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        };
        let (root, what) = self.first_not_finite(&value)?;
        let mut scratch = self.graph.clone();
        let origin = first_part(&mut scratch, *root, &value);
        let symbols = scratch.symbols(origin);
        let coordinate = symbols.into_iter().find_map(|symbol| match symbol {
            Symbol::Coordinate(i) => Some(i),
            _ => None,
        });
        let shown = scratch.display(origin, &|symbol| model.symbol_name(symbol));
        let because = if shown.chars().count() <= 80 {
            format!(" because of `{shown}`")
        } else {
            String::new()
        };
        Some(Fault {
            coordinate,
            message: format!("{what} is not finite{because}"),
        })
    }

    fn first_not_finite(&self, value: &dyn Fn(Symbol) -> f64) -> Option<&(ExprId, String)> {
        let mut values = vec![f64::NAN; self.parts.last().map_or(0, |last| last.index() + 1)];
        for &part in &self.parts {
            let known = |child: ExprId| values[child.index()];
            values[part.index()] = self.graph.evaluate_node(part, &known, value);
        }
        let mut functions = self.functions.iter();
        functions.find(|(root, _)| !values[root.index()].is_finite())
    }
}

/// That brackets are computed from matrices which are dependent at values of the parameters; at the defaults they are not.
fn undetermined(model: &Model, parameters: &[f64]) -> Option<String> {
    let parametric = model.bracket.parametric();
    let parametric = parametric.filter(|parametric| parametric.gives_brackets)?;
    let value = |p: usize| Rational::from_f64(parameters[p]).unwrap_or(Rational::ZERO);
    // what is not finite is said of the brackets
    parametric.relation(&value).ok().flatten()?;
    Some("the algebra, whose matrices are linearly dependent for these values of the parameters, is not determined".into())
}

fn no_velocity() -> Fault {
    Fault {
        coordinate: None,
        message: "the Hamiltonian is not finite because no velocity with this momentum was found"
            .into(),
    }
}

/// What must be finite, with its name.
fn functions(model: &Model, scratch: &mut Graph) -> Vec<(ExprId, String)> {
    let hamiltonian = model.hamiltonian();
    let mut functions: Vec<(ExprId, String)> = vec![(hamiltonian, "the Hamiltonian".into())];
    for symbol in model.graph.symbols(hamiltonian) {
        if let Symbol::Coordinate(i) = symbol {
            let name = &model.coordinates[i].text;
            let component = scratch.derivative(hamiltonian, symbol);
            functions.push((
                component,
                format!("the derivative of the Hamiltonian with respect to `{name}`"),
            ));
        }
    }
    let casimirs = model.declared_casimirs.iter();
    functions.extend(casimirs.map(|c| (c.expr, format!("the Casimir `{}`", c.name))));
    let kept = model.quantities.iter();
    let kept = kept.filter(|quantity| quantity.kind == QuantityKind::Integral);
    functions.extend(kept.map(|q| (q.expr, format!("the first integral `{}`", q.name))));
    for (place, force) in model
        .driving
        .iter()
        .flat_map(|d| d.force.iter().enumerate())
    {
        let name = &model.coordinates[place].text;
        functions.push((*force, format!("the force on `{name}`")));
    }
    if let Bracket::General(matrix) = &model.bracket {
        functions.extend(matrix.entries.iter().map(|(i, j, value)| {
            let [a, b] = [*i, *j].map(|index| &model.coordinates[index].text);
            (*value, format!("the bracket {{{a}, {b}}}"))
        }));
    }
    functions
}

/// Where it begins that a function is not finite: children come before parents.
fn first_part(graph: &mut Graph, root: ExprId, value: &dyn Fn(Symbol) -> f64) -> ExprId {
    let parts = graph.dependencies(&[root]);
    let values = graph.evaluate_all(&parts, value);
    let at = |id: ExprId| Some(values[parts.binary_search(&id).ok()?]);
    let taken = graph
        .taken_dependencies(&[root], &|id| Some(at(id)? < 0.0))
        .into_iter();
    let mut not_finite = taken.filter(|id| at(*id).is_some_and(|v| !v.is_finite()));
    culprit(graph, not_finite.next().unwrap_or(root), value)
}

/// A group element off the group by more than the digits that someone may have left out. Known for groups of
/// orthogonal matrices: their algebras have antisymmetric ones.
fn outside_the_group(model: &Model, mu: &[f64]) -> Option<Fault> {
    let configuration = model.configuration.as_ref()?;
    let (name, size) = configuration.group.as_ref()?;
    let (first, size) = (configuration.momenta, *size);
    let skew = |matrix: &Vec<Vec<Rational>>| {
        let pairs = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let mut sums = pairs.map(|(i, j)| &matrix[i][j] + &matrix[j][i]);
        sums.all(|sum| sum.is_zero())
    };
    // those of the momenta begin with the block of the algebra
    let own = configuration.own_momenta();
    let orthogonal = match (model.bracket.representation(), model.bracket.parametric()) {
        (Some(known), _) => known.matrices.iter().take(own).all(skew),
        (None, Some(known)) => known.is_antisymmetric(own, size),
        (None, None) => false,
    };
    if !orthogonal {
        return None;
    }
    let entry = |i: usize, j: usize| mu[first + size * i + j];
    let mut worst = (0.0, 0);
    for i in 0..size {
        for j in 0..=i {
            let product: f64 = (0..size).map(|k| entry(i, k) * entry(j, k)).sum();
            let off = (product - f64::from(u8::from(i == j))).abs();
            if off > worst.0 {
                worst = (off, first + size * i);
            }
        }
    }
    (worst.0 > OFF_THE_GROUP).then(|| Fault {
        coordinate: Some(worst.1),
        message: format!(
            "{name} is not an element of the group (its rows are not orthonormal, by {:.1e})",
            worst.0
        ),
    })
}

/// Of a product the factor that is not finite, where there is one: in `x/(y - z)` it is the divisor.
fn culprit(graph: &mut Graph, id: ExprId, value: &dyn Fn(Symbol) -> f64) -> ExprId {
    let Node::Product(factors) = graph.node(id).clone() else {
        return id;
    };
    for (base, exponent) in factors {
        let power = graph.pow(base, &exponent);
        if !graph.evaluate(power, value).is_finite() {
            return power;
        }
    }
    id
}
