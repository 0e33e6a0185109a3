//! What the names in an expression stand for.

use std::collections::HashMap;

use super::recorded::{Columns, element};
use crate::model::{CANONICAL, ENTRIES, data_number, shared_number};
use lie_symbolic::symbolic::{ExprId, Function, Opaque, Symbol};
use lie_syntax::ast::{Declaration, Name, OwnFunction, Realization};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use lie_syntax::front::habits;
use lie_syntax::suggest::{listed, misspelt, series};

/// So many names are listed.
const MOST_LISTED: usize = 12;

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// A coordinate or a parameter.
    Symbol(Symbol),
    /// An abbreviation; `None` where its own expression is wrong (which was reported there).
    Let(Option<ExprId>),
    /// An abbreviation that is declared further down.
    Later,
    /// A basis element.
    Basis,
}

/// Which names may stand in an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Allowed {
    /// None: a constant.
    Constants,
    /// Parameters.
    Parameters,
    /// Coordinates of mu too.
    State,
    /// The same, and what has a value for each site of a family.
    Site,
    /// Parameters, what all sites of a family share, and what has a value for each.
    Strength,
    /// Components of the velocity, and of the coordinates those from this one on: a Lagrangian may depend on
    /// the group element and the time, but not on mu.
    Velocity(usize),
    /// Components of the velocity of a system with a constraint, and parameters.
    Constraint,
    /// Components of an element of the algebra, and parameters: a retraction.
    Retraction,
    /// Canonical coordinates of a realization.
    Canonical,
    /// Both: an abbreviation may serve either.
    Everything,
}

/// The names of a declaration as its expressions see them.
#[derive(Clone, Debug, Default)]
pub struct Environment<'a> {
    bindings: HashMap<&'a str, Binding>,
    /// The coordinates of the basis elements.
    duals: HashMap<&'a str, &'a str>,
    functions: &'a [OwnFunction],
    /// The names of the declaration, which say what one might have been meant for.
    columns: Option<Columns<'a>>,
}

impl Allowed {
    /// Whether functions of the user may stand.
    pub fn has_own_functions(self) -> bool {
        matches!(
            self,
            Self::State | Self::Site | Self::Velocity(_) | Self::Everything
        )
    }

    /// Whether a symbol may stand.
    pub fn permits(self, symbol: Symbol) -> bool {
        match symbol {
            Symbol::Parameter(_) => self != Self::Constants,
            Symbol::Coordinate(i) => match self {
                Self::State | Self::Site | Self::Everything => true,
                Self::Velocity(first) => i >= first,
                Self::Constants
                | Self::Parameters
                | Self::Strength
                | Self::Constraint
                | Self::Retraction
                | Self::Canonical => false,
            },
            _ if data_number(symbol).is_some() => matches!(self, Self::Site | Self::Strength),
            _ if shared_number(symbol).is_some() => matches!(
                self,
                Self::State | Self::Site | Self::Strength | Self::Everything
            ),
            Symbol::Input(i) if i >= CANONICAL => self == Self::Canonical,
            Symbol::Input(i) if i >= ENTRIES => {
                matches!(self, Self::Velocity(_) | Self::Everything)
            }
            Symbol::Input(_) => {
                matches!(
                    self,
                    Self::Velocity(_) | Self::Constraint | Self::Retraction | Self::Everything
                )
            }
            Symbol::Step => matches!(self, Self::Velocity(_) | Self::Everything),
            _ => false,
        }
    }
}

impl<'a> Environment<'a> {
    /// All names, abbreviations still unbound. Of a repeated name the first one counts; the
    /// repetition is reported elsewhere.
    pub fn new(declaration: &'a Declaration) -> Self {
        let mut bindings = HashMap::new();
        // the coordinates that carry the time have names that nobody can write
        let visible = |name: &&Name| !name.text.starts_with('_');
        for (i, name) in declaration
            .state
            .iter()
            .enumerate()
            .filter(|(_, n)| visible(n))
        {
            bindings
                .entry(name.text.as_str())
                .or_insert(Binding::Symbol(Symbol::Coordinate(i)));
        }
        for (i, name) in declaration.energy.velocity().iter().enumerate() {
            bindings
                .entry(name.text.as_str())
                .or_insert(Binding::Symbol(Symbol::Input(i)));
        }
        let canonical = declaration.realization.iter().flat_map(Realization::names);
        for (i, name) in canonical.enumerate() {
            bindings
                .entry(name.text.as_str())
                .or_insert(Binding::Symbol(Symbol::Input(CANONICAL + i)));
        }
        for (i, parameter) in declaration.parameters.iter().enumerate() {
            bindings
                .entry(parameter.name.text.as_str())
                .or_insert(Binding::Symbol(Symbol::Parameter(i)));
        }
        for (name, _) in &declaration.lets {
            bindings.entry(name.text.as_str()).or_insert(Binding::Later);
        }
        if declaration.energy.has_step() {
            bindings.entry("h").or_insert(Binding::Symbol(Symbol::Step));
        }
        for name in declaration.basis() {
            bindings.entry(name.text.as_str()).or_insert(Binding::Basis);
        }
        let duals = declaration.basis().iter().zip(&declaration.state);
        Self {
            bindings,
            duals: duals
                .map(|(e, x)| (e.text.as_str(), x.text.as_str()))
                .collect(),
            functions: &declaration.functions,
            columns: Some(Columns::new(declaration)),
        }
    }

    /// The names of constraints: components of the velocity, by the basis where the velocity has no names of its own. The declared
    /// algebra has so many.
    #[must_use]
    pub fn of_velocity(&self, declaration: &'a Declaration, own: usize) -> Self {
        let mut names = self.clone();
        if declaration.energy.velocity().is_empty() {
            for (i, name) in declaration.basis().iter().take(own).enumerate() {
                let component = Binding::Symbol(Symbol::Input(i));
                names.bindings.insert(&name.text, component);
            }
        }
        names
    }

    /// Gives a name its symbol, unless it has another meaning.
    pub fn bind_symbol(&mut self, name: &'a str, symbol: Symbol) {
        let binding = Binding::Symbol(symbol);
        self.bindings.entry(name).or_insert(binding);
    }

    /// Gives a name that nothing else has an expression.
    pub fn bind_value(&mut self, name: &'a str, value: ExprId) {
        self.bindings
            .entry(name)
            .or_insert(Binding::Let(Some(value)));
    }

    /// Gives an abbreviation its meaning.
    pub fn bind(&mut self, name: &'a str, value: Option<ExprId>) {
        if let Some(binding @ Binding::Later) = self.bindings.get_mut(name) {
            *binding = Binding::Let(value);
        }
    }

    /// The function of the user that has this name.
    pub fn function(&self, name: &str) -> Option<Opaque> {
        let mut functions = self.functions.iter();
        let found = functions.find(|own| own.name.text == name)?;
        Some(found.function)
    }

    /// What a name stands for.
    pub fn get(&self, name: &str) -> Option<Binding> {
        self.bindings.get(name).copied()
    }

    /// The error for a name that may not stand here.
    pub fn unknown(&self, name: &str, origin: Origin, allowed: Allowed) -> Diagnostic {
        let (kind, (message, help)) = if name == "t" {
            (Kind::ReservedName, on_time())
        } else {
            let declared = self.get(name).and_then(|b| misplaced(name, b, allowed));
            let declared = declared.map(|(message, help)| match self.duals.get(name) {
                Some(dual)
                    if self.get(name) == Some(Binding::Basis)
                        && matches!(allowed, Allowed::State | Allowed::Site) =>
                {
                    (
                        message,
                        format!(
                            "{help}, `{dual}`; a parameter needs a name that no basis element has"
                        ),
                    )
                }
                _ => (message, help),
            });
            let mistake = declared.unwrap_or_else(|| self.undeclared(name, allowed));
            (Kind::UnknownSymbol, mistake)
        };
        Diagnostic::new(kind, origin, message).help(help)
    }

    /// Message and remedy for a name that is not declared.
    fn undeclared(&self, name: &str, allowed: Allowed) -> (String, String) {
        if Function::is_name(name) {
            let help = format!("write its argument: `{name}(…)`");
            return (format!("`{name}` is a function"), help);
        }
        let usable = |binding: &Binding| match binding {
            Binding::Symbol(symbol) => allowed.permits(*symbol),
            Binding::Let(_) => allowed != Allowed::Constants,
            Binding::Later | Binding::Basis => false,
        };
        if let Some(latin) = habits::in_latin(name)
            && self.get(&latin).is_some_and(|binding| usable(&binding))
        {
            let message =
                format!("unknown symbol `{name}`: it looks like `{latin}`, but has other letters");
            return (message, format!("write `{latin}`"));
        }
        if allowed == Allowed::State
            && let Some(mistake) = self.columns.as_ref().and_then(|all| all.meant(name))
        {
            return mistake;
        }
        let bindings = self.bindings.iter();
        // sums of a family stand under names that nobody can write
        let written = |name: &str| !name.contains(' ');
        let candidates = bindings.filter(|(n, b)| usable(b) && written(n));
        let candidates = candidates.map(|(n, _)| *n);
        let mut candidates: Vec<&str> = candidates.collect();
        candidates.sort_unstable();
        candidates.push("pi");
        let near = misspelt(name, candidates.iter().copied());
        if near.is_none()
            && let Some((message, help)) = habits::constant(name)
        {
            return (message, help.to_owned());
        }
        let mut declare = format!("declare `{name}` as a parameter, an abbreviation or an input");
        if matches!(allowed, Allowed::State | Allowed::Velocity(_)) {
            let declaration = self.columns.as_ref().map(|all| all.declaration);
            let element = declaration.and_then(|all| element(all, name));
            declare.extend(element);
        }
        let others = series(name, candidates);
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None if allowed == Allowed::Constants => {
                "only numbers and `pi` may stand here".to_owned()
            }
            None if others.is_empty() => match self.coordinates(allowed).as_slice() {
                [] => declare,
                names => format!("the coordinates are {}; {declare}", listed(names)),
            },
            None => format!(
                "{declare}; in this series there {} {}",
                if others.len() == 1 { "is" } else { "are" },
                listed(&others)
            ),
        };
        (format!("unknown symbol `{name}`"), help)
    }

    /// The names of the coordinates that may stand, in their order; none where they are too many to read.
    fn coordinates(&self, allowed: Allowed) -> Vec<&str> {
        let mut names: Vec<(Symbol, &str)> = Vec::new();
        for (name, binding) in &self.bindings {
            if let Binding::Symbol(symbol @ Symbol::Coordinate(_)) = binding
                && allowed.permits(*symbol)
                && !name.contains(' ')
            {
                names.push((*symbol, name));
            }
        }
        names.sort_unstable();
        match names.len() {
            0..=MOST_LISTED => names.into_iter().map(|(_, name)| name).collect(),
            _ => Vec::new(),
        }
    }
}

fn on_time() -> (String, String) {
    (
        "`t` is the time, which cannot stand here".to_owned(),
        "remove it; a parameter takes the place of a frozen time".to_owned(),
    )
}

/// Message and remedy for a name that is declared, but for something else; `None` for a basis name among constants,
/// which is taken for one that is not declared.
fn misplaced(name: &str, binding: Binding, allowed: Allowed) -> Option<(String, String)> {
    let (rule, help) = match (binding, allowed) {
        (Binding::Later, _) => (
            "is not known yet: an abbreviation may use only earlier ones",
            "change the order of the abbreviations; none may use itself",
        ),
        (Binding::Basis, Allowed::Constants | Allowed::Parameters) => return None,
        (Binding::Basis, Allowed::Velocity(_)) => (
            "is a basis element; a Lagrangian is written in the components of the velocity",
            "use the velocity name of the same position",
        ),
        (Binding::Basis, Allowed::Constraint) => (
            "is a basis element; with `velocity`, a constraint is written in its names",
            "use the velocity name of the same position",
        ),
        (Binding::Basis, Allowed::Retraction) => (
            "is a basis element; with `velocity`, a retraction is written in its names",
            "use the velocity name of the same position",
        ),
        (Binding::Basis, _) => (
            "is a basis element; functions are written in the coordinates of the state",
            "use the state name of the same position",
        ),
        (_, Allowed::Constants) => ("cannot stand here: only constants may", "write its value"),
        (_, Allowed::Velocity(_)) => (
            "cannot stand here: a reduced Lagrangian depends on the velocity, not on mu",
            "use the velocity names; mu is the derivative of the Lagrangian",
        ),
        (_, Allowed::Constraint) => (
            "cannot stand here: a constraint is a linear equation between components of the velocity",
            "use basis names, or those of `velocity` where it is declared; the coefficients are functions of parameters",
        ),
        (_, Allowed::Retraction) => (
            "cannot stand here: a retraction is a function of an element of the algebra",
            "use basis names, or those of `velocity` where it is declared, and parameters",
        ),
        (_, Allowed::Canonical) => (
            "cannot stand here: the map of a realization depends on positions and momenta alone",
            "use their names",
        ),
        (_, Allowed::State | Allowed::Site) => (
            "cannot stand here: it depends on the velocity, and this is a function of mu",
            "use the state names",
        ),
        (_, Allowed::Parameters | Allowed::Strength | Allowed::Everything) => (
            "cannot stand here: only constants and parameters may",
            "write its value",
        ),
    };
    Some((format!("`{name}` {rule}"), help.to_owned()))
}
