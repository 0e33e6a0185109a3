//! Where the equations of motion come from.

use super::configuration::entry;
use lie_symbolic::exact::Rational;
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
    /// A Lagrangian whose velocity for a momentum is found by Newton's iteration when it is needed. The
    /// function is `<mu, xi> - l(xi)` in mu and the velocity xi of mu, so that its derivative by a momentum is a
    /// component of xi; of a system that depends on the time, that of the extended phase space.
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

    /// The Lagrangian, if the system was declared by one and its kernels are made of it.
    pub fn lagrangian(&self) -> Option<&Lagrangian> {
        match self {
            Energy::Lagrangian(lagrangian, _) | Energy::Legendre(lagrangian, _) => Some(lagrangian),
            Energy::Expression(_) | Energy::Transformed(_) => None,
        }
    }

    /// The reduced Lagrangian: a function of the velocity alone, on an algebra.
    pub fn reduced(&self) -> Option<&Lagrangian> {
        self.lagrangian().filter(|lagrangian| lagrangian.reduced)
    }

    /// Whether H is the Legendre transform of a Lagrangian that is none on an algebra alone.
    pub fn is_transformed(&self) -> bool {
        match self {
            Energy::Transformed(_) => true,
            Energy::Legendre(lagrangian, _) => !lagrangian.reduced,
            Energy::Expression(_) | Energy::Lagrangian(..) => false,
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

/// A Lagrangian.
#[derive(Clone, Debug)]
pub struct Lagrangian {
    /// Whether it is a function of the velocity alone, on an algebra. Another one depends on the group element or the time,
    /// whose coordinates follow the momenta.
    pub reduced: bool,
    /// The function l(xi); component i of the velocity is [`Symbol::Input`](lie_symbolic::symbolic::Symbol::Input) i.
    pub value: ExprId,
    /// Names of the components of the velocity.
    pub velocity: Vec<Name>,
    /// The discrete Lagrangian by which the system was declared; l is the Lagrangian that it approximates.
    pub discrete: Option<Discrete>,
}

/// [`Symbol::Input`](lie_symbolic::symbolic::Symbol::Input) of the first entry of the matrix `D = g - 1` of a step: beyond the velocity.
pub const ENTRIES: usize = 1 << 19;

/// A discrete Lagrangian.
#[derive(Clone, Debug)]
pub struct Discrete {
    /// The function, in the symbols of the velocity and the step size.
    pub value: ExprId,
    /// How it was written in the entries of the group element, and so in Cayley coordinates.
    pub in_entries: Option<InEntries>,
}

impl Discrete {
    /// The function as people read it: in the entries, where it was written in them.
    pub fn shown(&self) -> ExprId {
        let written = self.in_entries.as_ref();
        written.map_or(self.value, |written| written.value)
    }
}

/// A function of the entries of `g = (1 - X/2)^-1 (1 + X/2)`, the element of a step: of a left-invariant system
/// `g = g_k^-1 g_(k+1)`, of a right-invariant one `g = g_(k+1) g_k^-1`.
#[derive(Clone, Debug)]
pub struct InEntries {
    /// The function in the entries of `D = g - 1`, which are the symbols from [`ENTRIES`] on, row by row. Those of
    /// the velocity may stand beside them.
    pub value: ExprId,
    /// The number of rows.
    pub size: usize,
    /// The declared matrices, whose combination is X.
    pub basis: Vec<Vec<Vec<Rational>>>,
    /// The name of the group element.
    pub group: String,
}

impl InEntries {
    /// An entry of D as text: `R12`, and `(R11 - 1)` on the diagonal.
    pub fn name(&self, place: usize) -> Option<String> {
        let (row, column) = (place / self.size, place % self.size);
        let name = entry(&self.group, self.size, row + 1, column + 1);
        (row < self.size).then(|| match row == column {
            true => format!("({name} - 1)"),
            false => name,
        })
    }
}
