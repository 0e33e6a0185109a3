//! The syntax tree that both front ends produce: nothing in it is resolved or checked yet.
//!
//! Sums and products are n-ary, so that the depth of the tree is the nesting of the text and a
//! long sum cannot exhaust the stack. Names may carry indices and sums may run over an index:
//! families of systems need both, so they are in the tree from the start.

mod attitude;
mod constraint;
mod driving;
mod family;
pub mod names;
mod parts;
mod recorded;
mod runtime;

use crate::diagnostic::Origin;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::Opaque;

pub use attitude::{Attitude, AttitudeForm};
pub use constraint::Constraint;
pub use driving::{Dissipation, DissipationKind, Input, Metric, Noise};
pub use family::{BONDS, Family, Index, SiteData, SiteValues, Size, Start};
pub use recorded::{Event, Observable};
pub use runtime::{NoPath, Runtime};

/// A name and its place.
#[derive(Clone, Debug)]
pub struct Name {
    /// The identifier.
    pub text: String,
    /// Where it stands.
    pub origin: Origin,
}

/// An expression with its place.
#[derive(Clone, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands.
    pub origin: Origin,
}

/// The forms of an expression. What few of them have is boxed: a long sum has a million others.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// An exact constant.
    Number(Rational),
    /// A name, with an index if it belongs to a family.
    Name {
        /// The identifier.
        name: String,
        /// `x[i+1]`.
        index: Option<Box<Index>>,
    },
    /// `-a`.
    Negative(Box<Expr>),
    /// `a + b - c`: the flag is true where a minus stands before the term.
    Sum(Vec<(bool, Expr)>),
    /// `a * b / c`: the flag is true where the factor divides.
    Product(Vec<(bool, Expr)>),
    /// `a ^ b`.
    Power(Box<Expr>, Box<Expr>),
    /// `f(a, …)`.
    Call {
        /// The function.
        function: Box<Name>,
        /// Its arguments.
        arguments: Vec<Expr>,
    },
    /// `sum(i in 0..N: body)`.
    IndexedSum {
        /// The running index.
        index: Box<Name>,
        /// First value.
        from: Box<Expr>,
        /// One past the last value.
        to: Box<Expr>,
        /// The summand.
        body: Box<Expr>,
    },
}

/// `[left, right] = value` of basis elements, or `{left, right} = value` of coordinates.
#[derive(Clone, Debug)]
pub struct Bracket {
    /// First name.
    pub left: Name,
    /// Second name.
    pub right: Name,
    /// Linear in basis names; of coordinates a function of the state.
    pub value: Expr,
    /// The whole bracket.
    pub origin: Origin,
}

/// The matrix that represents one basis element.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// The basis name.
    pub name: Name,
    /// Rows of exact entries.
    pub rows: Vec<Vec<Expr>>,
    /// The whole matrix.
    pub origin: Origin,
}

/// A Lie algebra as it was written.
#[derive(Clone, Debug)]
pub struct Algebra {
    /// Names of the basis.
    pub basis: Vec<Name>,
    /// The brackets; `None` where the key is absent, so that matrices may define them.
    pub brackets: Option<Vec<Bracket>>,
    /// A matrix representation.
    pub matrices: Vec<Matrix>,
    /// The whole block.
    pub origin: Origin,
}

/// What gives the Poisson bracket of the coordinates.
#[derive(Clone, Debug)]
pub enum Structure {
    /// The Lie–Poisson bracket of an algebra, and brackets of coordinates that are added to it.
    Lie {
        /// The algebra.
        algebra: Algebra,
        /// The constants that are added; none where the key is absent.
        cocycle: Vec<Bracket>,
    },
    /// The brackets of the coordinates, one by one.
    General {
        /// The brackets.
        brackets: Vec<Bracket>,
        /// The whole block.
        origin: Origin,
    },
}

/// A parameter with its default.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: Name,
    /// Its default, an expression in constants.
    pub default: Expr,
    /// Whether brackets may use it (as an exact number).
    pub exact: bool,
    /// Whether it takes positive values only.
    pub positive: bool,
    /// Unit, for people, as Markdown within a line.
    pub unit: Option<String>,
    /// Description, for people, as Markdown.
    pub description: Option<String>,
}

/// A Casimir; an unnamed one is named later.
#[derive(Clone, Debug)]
pub struct Casimir {
    /// `NAME =`, if it was there.
    pub name: Option<Name>,
    /// The function.
    pub value: Expr,
}

/// The function that gives the equations of motion.
#[derive(Clone, Debug)]
pub enum Energy {
    /// H(mu).
    Hamiltonian(Expr),
    /// The reduced Lagrangian l(xi) and the names of the components of the velocity xi.
    Lagrangian {
        /// One name for each basis element.
        velocity: Vec<Name>,
        /// The function.
        value: Expr,
    },
    /// A discrete Lagrangian l_d of one step of size `h`, in the coordinates x of a retraction.
    DiscreteLagrangian {
        /// The names of x, one for each basis element.
        velocity: Vec<Name>,
        /// The function.
        value: Expr,
    },
}

impl Energy {
    /// The function.
    pub fn expression(&self) -> &Expr {
        match self {
            Self::Hamiltonian(value)
            | Self::Lagrangian { value, .. }
            | Self::DiscreteLagrangian { value, .. } => value,
        }
    }

    /// The names of the velocity of a Lagrangian, or of the coordinates of a discrete one; none of a Hamiltonian.
    pub fn velocity(&self) -> &[Name] {
        match self {
            Self::Hamiltonian(_) => &[],
            Self::Lagrangian { velocity, .. } | Self::DiscreteLagrangian { velocity, .. } => {
                velocity
            }
        }
    }

    /// Whether it may contain the step size `h`.
    pub fn has_step(&self) -> bool {
        matches!(self, Self::DiscreteLagrangian { .. })
    }
}

/// A realization of the bracket: a map from canonical coordinates (q, p) to the state.
#[derive(Clone, Debug)]
pub struct Realization {
    /// Names of the positions q.
    pub positions: Vec<Name>,
    /// Names of the momenta p.
    pub momenta: Vec<Name>,
    /// `STATE = expression` for each coordinate.
    pub map: Vec<(Name, Expr)>,
    /// A point (q, p) near which points over a state are sought.
    pub start: Option<Vec<Expr>>,
    /// The whole declaration.
    pub origin: Origin,
}

impl Realization {
    /// Positions, then momenta.
    pub fn names(&self) -> impl Iterator<Item = &Name> {
        self.positions.iter().chain(&self.momenta)
    }
}

/// A map from the algebra to the group near the identity, in matrices.
#[derive(Clone, Debug)]
pub struct Retraction {
    /// The rows of the matrix, whose entries are functions of the components of the velocity.
    pub map: Vec<Vec<Expr>>,
    /// Those of the matrix at the other end of the step, if there is one.
    pub second: Option<Vec<Vec<Expr>>>,
    /// The whole declaration.
    pub origin: Origin,
}

impl Retraction {
    /// All entries.
    pub fn entries(&self) -> impl Iterator<Item = &Expr> {
        self.map
            .iter()
            .chain(self.second.iter().flatten())
            .flatten()
    }
}

/// Which invariance the system has; the right-invariant one has the opposite sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Invariance {
    /// `mu' = ad*_{grad H} mu`.
    #[default]
    Left,
    /// `mu' = -ad*_{grad H} mu`.
    Right,
}

/// One entry of `run`: option name (as on the command line, without dashes) and its text.
#[derive(Clone, Debug)]
pub struct RunOption {
    /// The option.
    pub name: Name,
    /// Its values: one for most options, several for `at`.
    pub values: Vec<(String, Origin)>,
}

/// A whole declaration.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Visibility tokens of the macro form (`pub`, `pub(crate)`, nothing); `pub` for specs.
    pub visibility: proc_macro2::TokenStream,
    /// Name of the system.
    pub name: Name,
    /// Doc lines (macro, as the user wrote them) or the description (spec, escaped to Markdown).
    pub description: Vec<String>,
    /// References, for people, as Markdown within a line.
    pub references: Vec<String>,
    /// The algebra, or the brackets of the coordinates.
    pub structure: Structure,
    /// The name of the group element, where functions may use its entries.
    pub group: Option<Name>,
    /// Names of the coordinates of `mu`; of a family those of a site.
    pub state: Vec<Name>,
    /// Present where the system is many copies of the algebra.
    pub family: Option<Family>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// Functions of Rust.
    pub functions: Vec<OwnFunction>,
    /// Abbreviations, each may use the earlier ones.
    pub lets: Vec<(Name, Expr)>,
    /// The Hamiltonian or the Lagrangian.
    pub energy: Energy,
    /// Forces: what is added to the rates of coordinates.
    pub forces: Vec<(Name, Expr)>,
    /// What dissipates energy beside them.
    pub dissipation: Vec<Dissipation>,
    /// Noise, each with a Wiener process of its own.
    pub noise: Vec<Noise>,
    /// What is set from outside.
    pub inputs: Vec<Input>,
    /// Linear equations that the velocity satisfies.
    pub constraint: Vec<Constraint>,
    /// A realization, for collective methods.
    pub realization: Option<Realization>,
    /// A retraction of the user's own.
    pub retraction: Option<Retraction>,
    /// Declared Casimirs.
    pub casimirs: Vec<Casimir>,
    /// Declared first integrals.
    pub integrals: Vec<(Name, Expr)>,
    /// Functions of the state that are recorded beside it.
    pub observables: Vec<Observable>,
    /// Functions whose zeros are found.
    pub events: Vec<Event>,
    /// Methods that get fused code.
    pub methods: Vec<Name>,
    /// Left or right invariance.
    pub invariance: Invariance,
    /// The initial state, expressions in constants and parameters.
    pub initial: Option<Vec<Expr>>,
    /// Where `initial` stands.
    pub initial_origin: Option<Origin>,
    /// The initial group element.
    pub attitude: Option<Attitude>,
    /// Defaults of `lie run`.
    pub run: Vec<RunOption>,
}

/// A function that is written in Rust.
#[derive(Clone, Debug)]
pub struct OwnFunction {
    /// Its name in expressions.
    pub name: Name,
    /// What is known of it.
    pub function: Opaque,
    /// Its paths, each as text and as tokens at their places.
    pub paths: Vec<(String, proc_macro2::TokenStream)>,
}

impl Declaration {
    /// The algebra, if there is one.
    pub fn algebra(&self) -> Option<&Algebra> {
        match &self.structure {
            Structure::Lie { algebra, .. } => Some(algebra),
            Structure::General { .. } => None,
        }
    }

    /// What has a value for each site of a family.
    pub fn site_data(&self) -> &[SiteData] {
        self.family.as_ref().map_or(&[], |family| &family.data)
    }

    /// Names of the basis of the algebra; none where there is no algebra.
    pub fn basis(&self) -> &[Name] {
        self.algebra().map_or(&[], |algebra| &algebra.basis)
    }

    /// The number of coordinates that the bracket asks for.
    pub fn dimension(&self) -> usize {
        match &self.structure {
            Structure::Lie { algebra, .. } => algebra.basis.len(),
            Structure::General { .. } => self.state.len(),
        }
    }

    /// Where the bracket is declared.
    pub fn place(&self) -> Origin {
        match &self.structure {
            Structure::Lie { algebra, .. } => algebra.origin,
            Structure::General { origin, .. } => *origin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A Hamiltonian of 10 MB is several million of these.
    #[test]
    fn an_expression_is_small() {
        assert!(size_of::<Expr>() <= 64);
    }
}
