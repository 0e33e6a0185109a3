//! Where the equations of motion come from.

use lie_symbolic::symbolic::ExprId;
use lie_syntax::ast::Name;

/// Where the equations of motion come from. Of its Hamiltonian a checked system knows what is in [`Hamiltonian`];
/// before that it is an expression.
#[derive(Clone, Debug)]
pub enum Energy<H = Hamiltonian> {
    /// A Hamiltonian that was declared.
    Expression(H),
    /// The Legendre transform of a Lagrangian that is none on an algebra alone: the space carries the group element or the time, or the
    /// bracket is another one.
    Transformed(H),
    /// A reduced Lagrangian and its Legendre transform, an expression in mu.
    Lagrangian(Lagrangian, H),
    /// A reduced Lagrangian whose velocity for a momentum is found by Newton's iteration when it is needed. The
    /// function is `<mu, xi> - l(xi)` in mu and the velocity xi of mu, so that its derivative by a coordinate is a
    /// component of xi.
    Legendre(Lagrangian, ExprId),
}

impl<H> Energy<H> {
    /// The Hamiltonian, where it is an expression in mu alone, which methods can take apart.
    pub fn expression(&self) -> Option<&H> {
        match self {
            Energy::Expression(hamiltonian)
            | Energy::Transformed(hamiltonian)
            | Energy::Lagrangian(_, hamiltonian) => Some(hamiltonian),
            Energy::Legendre(..) => None,
        }
    }

    /// The function whose derivatives by the coordinates are the gradient: H, of [`Energy::Legendre`] in mu and its velocity.
    pub fn value(&self, of: impl FnOnce(&H) -> ExprId) -> ExprId {
        match self {
            Energy::Expression(hamiltonian)
            | Energy::Transformed(hamiltonian)
            | Energy::Lagrangian(_, hamiltonian) => of(hamiltonian),
            Energy::Legendre(_, function) => *function,
        }
    }

    /// The reduced Lagrangian, if the system was declared by one.
    pub fn lagrangian(&self) -> Option<&Lagrangian> {
        match self {
            Energy::Lagrangian(lagrangian, _) | Energy::Legendre(lagrangian, _) => Some(lagrangian),
            Energy::Expression(_) | Energy::Transformed(_) => None,
        }
    }

    /// The same with another thing known of the Hamiltonian.
    pub fn with<K>(self, of: impl FnOnce(H) -> K) -> Energy<K> {
        match self {
            Energy::Expression(hamiltonian) => Energy::Expression(of(hamiltonian)),
            Energy::Transformed(hamiltonian) => Energy::Transformed(of(hamiltonian)),
            Energy::Lagrangian(lagrangian, hamiltonian) => {
                Energy::Lagrangian(lagrangian, of(hamiltonian))
            }
            Energy::Legendre(lagrangian, function) => Energy::Legendre(lagrangian, function),
        }
    }
}

/// A Hamiltonian that is an expression in mu.
#[derive(Clone, Debug)]
pub struct Hamiltonian {
    /// The function; of a system that depends on the time, that of the extended phase space.
    pub value: ExprId,
    /// The energy: the Hamiltonian as it was declared.
    pub energy: ExprId,
    /// Its total degree in the coordinates, where it is a polynomial in them.
    pub degree: Option<u32>,
}

/// A reduced Lagrangian.
#[derive(Clone, Debug)]
pub struct Lagrangian {
    /// The function l(xi); component i of the velocity is [`Symbol::Input`](lie_symbolic::symbolic::Symbol::Input) i.
    pub value: ExprId,
    /// Names of the components of the velocity.
    pub velocity: Vec<Name>,
    /// The discrete Lagrangian by which the system was declared; l is the Lagrangian that it approximates.
    pub discrete: Option<Discrete>,
}

/// A discrete Lagrangian.
#[derive(Clone, Copy, Debug)]
pub struct Discrete {
    /// The function, in the symbols of the velocity and the step size.
    pub value: ExprId,
    /// Whether it was written in the entries of the group element, and so in Cayley coordinates.
    pub in_entries: bool,
}
