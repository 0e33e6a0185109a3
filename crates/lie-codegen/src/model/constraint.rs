//! A system with a constraint on its velocity, in the coordinates that the constraint leaves.

use super::{Model, at_parameters};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Name;

/// A coefficient below this part of its equation is zero beside it.
const SINGULAR: f64 = 1e-13;
/// A declared state may be off the constraint by this part of its momenta, as one that is written with few digits is.
const OFF_THE_CONSTRAINT: f64 = 1e-6;

/// Linear equations `<a_j, xi> = 0` between the components of `xi = grad H`, and the subspace D of the algebra that they leave.
///
/// The coordinates of the model are `m_alpha = <mu, e_alpha>` for a basis e_alpha of D. Momenta and velocity are functions of them.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// The equations, as they were reduced: each has a component that no other one has.
    pub forms: Vec<String>,
    /// The equations as they are declared, which hold for other velocities where a parameter has another value.
    pub equations: Vec<Equation>,
    /// The declared coordinates, those of mu first.
    pub declared: Vec<Name>,
    /// The names of the components of xi: those of the velocity, or of the basis.
    pub components: Vec<String>,
    /// The names of the basis of the algebra.
    pub elements: Vec<String>,
    /// The basis of D: `(i, c)` for each component of `e_alpha = sum_i c e_i` that is not zero.
    pub basis: Vec<Vec<(usize, ExprId)>>,
    /// The declared coordinates.
    pub momenta: Vec<ExprId>,
    /// The velocity.
    pub velocity: Vec<ExprId>,
    /// The coordinate of mu that each equation determines.
    pub determined: Vec<usize>,
    /// The initial state in the declared coordinates, where it is given in these.
    pub declared_initial: Option<Vec<ExprId>>,
    /// Whether the Jacobi identity holds, although nothing presupposes it; `None` where it was not decided.
    pub jacobi: Option<bool>,
}

/// An equation `<a, xi> = 0` as it is declared.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The equation.
    pub text: String,
    /// The coefficients a, one for each component, functions of the parameters.
    pub coefficients: Vec<ExprId>,
}

/// A state in the declared coordinates off the constraint.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The coordinate that the equation determines.
    pub coordinate: usize,
    /// What is wrong.
    pub message: String,
    /// What to write.
    pub help: String,
}

impl Constraint {
    /// The names of the reduced coordinates with the elements of D to which they belong.
    pub fn basis_in_words(&self, model: &Model) -> Vec<(String, String)> {
        let element = |(alpha, vector): (usize, &Vec<(usize, ExprId)>)| {
            let mut text = String::new();
            for (i, value) in vector {
                let shown = model.display(*value);
                let name = &self.elements[*i];
                let (sign, size) = match shown.strip_prefix('-') {
                    Some(size) if !size.contains(['+', '-', ' ']) => ("-", size.to_owned()),
                    _ if shown.contains(['+', '-', ' ']) => ("+", format!("({shown})")),
                    _ => ("+", shown),
                };
                let factor = if size == "1" {
                    name.clone()
                } else {
                    format!("{size}*{name}")
                };
                text = match (text.is_empty(), sign) {
                    (true, "-") => format!("-{factor}"),
                    (true, _) => factor,
                    (false, sign) => format!("{text} {sign} {factor}"),
                };
            }
            (model.coordinates[alpha].text.clone(), text)
        };
        self.basis.iter().enumerate().map(element).collect()
    }

    /// `<mu, e_alpha>` for a declared state, with what stands behind mu in it.
    fn reduced(&self, graph: &Graph, declared: &[f64], parameters: &[f64]) -> Vec<f64> {
        let own = self.components.len();
        let mut state: Vec<f64> = Vec::new();
        for vector in &self.basis {
            let coefficients: Vec<ExprId> = vector.iter().map(|(_, value)| *value).collect();
            let coefficients = at_parameters(graph, &coefficients, parameters);
            let terms = vector.iter().zip(coefficients);
            state.push(terms.map(|((i, _), c)| c * declared[*i]).sum());
        }
        state.extend_from_slice(&declared[own..]);
        state
    }
}

impl Model {
    /// The reduced state of one that is given in the declared coordinates, of a system with a constraint.
    pub(super) fn on_constraint(&self, given: &[f64], parameters: &[f64]) -> Option<Vec<f64>> {
        let constraint = self.constraint.as_ref()?;
        let is_declared = self.is_declared_state(given.len());
        is_declared.then(|| constraint.reduced(&self.graph, given, parameters))
    }

    /// Whether so many values are those of the coordinates as they were declared, which a constraint makes fewer.
    fn is_declared_state(&self, count: usize) -> bool {
        self.constraint.as_ref().is_some_and(|constraint| {
            let own = constraint.components.len();
            count == own || count == constraint.declared.len()
        })
    }

    /// What is wrong with a state in the declared coordinates that is off the constraint by more than the digits that someone may have left
    /// out: its momenta are not those that belong to its reduced ones.
    pub fn violation(&self, given: &[f64], parameters: &[f64]) -> Option<Violation> {
        let constraint = self.constraint.as_ref()?;
        if !self.is_declared_state(given.len()) {
            return None;
        }
        let own = constraint.components.len();
        let reduced = constraint.reduced(&self.graph, given, parameters);
        let value = |symbol| match symbol {
            Symbol::Coordinate(i) => reduced.get(i).copied().unwrap_or(0.0),
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        };
        let right = self.graph.evaluate_all(&constraint.momenta[..own], &value);
        let size = given[..own].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = |i: &usize| (right[*i] - given[*i]).abs();
        let all = constraint.determined.iter().copied();
        let place = all.max_by(|a, b| off(a).total_cmp(&off(b)))?;
        // what is not finite is found with the domain
        if off(&place) <= OFF_THE_CONSTRAINT * size || !off(&place).is_finite() {
            return None;
        }
        let names = &self.coordinates[..constraint.basis.len()];
        let names: Vec<&str> = names.iter().map(|name| name.text.as_str()).collect();
        let right = right.iter().map(|value| shortened(*value).to_string());
        let right: Vec<String> = right.collect();
        let (name, forms) = (
            &constraint.declared[place].text,
            constraint.forms.join(", "),
        );
        Some(Violation {
            coordinate: place,
            message: format!(
                "the initial state violates the constraint {forms}: {name} is {}, and {} where it holds",
                given[place], right[place]
            ),
            help: format!(
                "give the values of {} alone, or the momenta on the constraint, {}",
                names.join(", "),
                right.join(", ")
            ),
        })
    }

    /// What is wrong with a constraint at values of the parameters, with a remedy: an equation says nothing there, or not what it was
    /// solved for. The equations were solved at the default parameters, in letters, and the solution knows nothing of a factor that
    /// becomes zero.
    pub fn void_constraint(&self, parameters: &[f64]) -> Option<[String; 2]> {
        let constraint = self.constraint.as_ref()?;
        let row =
            |equation: &Equation| at_parameters(&self.graph, &equation.coefficients, parameters);
        let rows: Vec<Vec<f64>> = constraint.equations.iter().map(row).collect();
        let all: Vec<usize> = (0..constraint.components.len()).collect();
        let other = "give other values of its parameters, or remove the equation from the spec";
        if let Some((place, size)) = dependent(rows.clone(), &all) {
            let text = &constraint.equations[place].text;
            let what = match size {
                0.0 => "holds for every velocity",
                size if size.is_finite() => "follows from those before it",
                _ => "has coefficients that are not finite",
            };
            let message = format!("the constraint {text} {what} at these parameters");
            return Some([message, other.to_owned()]);
        }
        dependent(rows, &constraint.determined)?;
        let names = constraint.determined.iter();
        let names: Vec<&str> = names.map(|i| constraint.components[*i].as_str()).collect();
        let message = format!(
            "the constraint {} cannot be solved for {} at these parameters, as it is at the default ones",
            constraint.forms.join(", "),
            names.join(", ")
        );
        let help = "write these values as the defaults of the spec: what the constraint is solved for is chosen there";
        Some([message, help.to_owned()])
    }

    /// Whether the bracket is almost Poisson: the Jacobi identity is not asked of what a constraint leaves.
    pub fn is_almost_poisson(&self) -> bool {
        self.constraint.is_some()
    }
}

/// The first of rows that depends on those before it in some columns, and how large its entries are.
fn dependent(mut rows: Vec<Vec<f64>>, columns: &[usize]) -> Option<(usize, f64)> {
    let size = |row: &Vec<f64>| match row.iter().all(|x| x.is_finite()) {
        true => row.iter().fold(0.0_f64, |most, x| most.max(x.abs())),
        false => f64::NAN,
    };
    let sizes: Vec<f64> = rows.iter().map(size).collect();
    let mut free = columns.to_vec();
    for (place, size) in sizes.into_iter().enumerate() {
        let mut row = rows[place].clone();
        let pivot = free
            .iter()
            .copied()
            .max_by(|i, j| row[*i].abs().total_cmp(&row[*j].abs()));
        let pivot = pivot.filter(|pivot| row[*pivot].abs() > SINGULAR * size);
        let Some(pivot) = pivot else {
            return Some((place, size));
        };
        free.retain(|column| *column != pivot);
        let scale = row[pivot];
        row.iter_mut().for_each(|x| *x /= scale);
        for later in &mut rows[place + 1..] {
            let factor = later[pivot];
            later
                .iter_mut()
                .zip(&row)
                .for_each(|(x, y)| *x -= factor * y);
        }
    }
    None
}

/// A number to twelve digits.
fn shortened(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}
