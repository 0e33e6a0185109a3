//! The steps that have code of their own.

use super::constants::Constants;
use super::elimination::Elimination;
use super::function::Function;
use super::recurrence::Recurrence;
use crate::derive::Shape;
use crate::derive::trace::COMPLETED;
use crate::methods::{self, Choice, GenericEquation};
use lie_symbolic::schedule::Counts;

/// A definition that the steps of methods are made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// A fused equation.
    Fused(Box<Fused>),
    /// The elimination of a pattern, for generic equations.
    Sparse(Sparse),
    /// A discrete gradient in closed form.
    Gradient(Gradient),
    /// A generating function.
    Generating(Box<Generating>),
    /// A method and the equation that its step solves.
    Method(Method, Solver),
    /// The Taylor coefficients of field and gradient.
    Recurrence(Box<Recurrence>),
}

/// A method whose step solves an equation.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// One of the catalogue.
    Catalogue(Choice),
    /// One that a user wrote, by the path of its type.
    Own(&'static str),
}

impl From<Choice> for Method {
    fn from(choice: Choice) -> Self {
        Self::Catalogue(choice)
    }
}

/// An equation with kernels of its own.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Fused {
    /// The end of its type's name.
    pub suffix: &'static str,
    /// Its doc lines.
    pub docs: &'static [&'static str],
    /// Residual, residual with Jacobian, and where there are such the initial guess and the state at the end.
    pub functions: Vec<Function>,
    /// The elimination of its Jacobian.
    pub elimination: Elimination,
    /// What is computed once for a step size.
    pub step: Constants,
    /// Where Newton's iteration begins.
    pub guess: Guess,
    /// The generic equation of the same step.
    pub partner: Partner,
    /// How a step moves the group element.
    pub motion: Motion,
    /// How a step is kept on the chart of its retraction, where that has poles.
    pub chart: Option<Chart>,
    /// Where the state at the end of the step is found.
    pub ending: Ending,
}

impl Fused {
    /// The kernel that completes the unknowns, where the iteration leaves some out.
    pub fn completed(&self) -> Option<&Function> {
        self.functions
            .iter()
            .find(|function| function.name == COMPLETED)
    }

    /// The unknowns that the iteration leaves out.
    pub fn left_out(&self) -> Vec<usize> {
        let mut functions = self.functions.iter();
        let residual = functions.find(|function| function.name == "residual");
        match (self.completed(), residual.map(|residual| &residual.shape)) {
            (Some(_), Some(Shape::Vector(iterated))) => {
                let all = 0..self.elimination.order.len();
                all.filter(|i| !iterated.contains(i)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// What an iteration with a Jacobian costs and one without, in instructions about: the operations of their kernels,
    /// and what the iteration does with each coordinate.
    pub fn costs(&self) -> Option<[usize; 2]> {
        let weight = |name: &str| {
            let mut functions = self.functions.iter();
            let function = functions.find(|function| function.name == name)?;
            Some(function.program.counts.weight())
        };
        let size = self.elimination.order.len();
        let elimination = 3 * self.elimination.multiplications();
        let jacobian = weight("linearize")? + elimination + 35 + 25 * size;
        Some([jacobian, weight("residual")? + 25 + 12 * size])
    }
}

/// Where Newton's iteration begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guess {
    /// At `mu + h f(mu)`.
    WholeStep,
    /// At `mu + (h/2) f(mu)`.
    HalfStep,
    /// Where a kernel says.
    Kernel,
}

/// How a step moves the group element: which of its methods the equation takes from the generic one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// By one factor; the method is of coadjoint form.
    Factor,
    /// Along velocities at stages.
    Velocity,
    /// By either, as a user wrote it.
    Either,
}

/// The element of a step that must be joined to the identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Chart {
    /// `h grad H` at the unknown.
    OfField,
    /// The group factor of the equation.
    OfFactor,
    /// What the generic equation says.
    OfPartner,
}

/// Where the state at the end of a step is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ending {
    /// It is the unknown.
    Unknown,
    /// A kernel computes it.
    Kernel,
    /// The generic equation does.
    Partner,
}

/// A generic equation of the numeric core.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Partner {
    /// That of a method of the catalogue.
    Catalogue {
        /// The method whose own equation it is.
        of: &'static Choice,
        /// The equation.
        equation: &'static GenericEquation,
        /// The generating function or the discrete gradient that has code of its own, by the end of its type's name.
        along: Option<&'static str>,
    },
    /// That of a method which a user wrote, by the path of its type.
    Own(&'static str),
}

impl Partner {
    /// The same along a function or a gradient that has code of its own.
    pub(super) fn with_own_code(self, suffix: &'static str) -> Self {
        match self {
            Self::Catalogue { of, equation, .. } => Self::Catalogue {
                of,
                equation,
                along: Some(suffix),
            },
            own => own,
        }
    }

    /// The method of the catalogue whose own equation it is.
    pub fn choice(&self) -> Option<&'static Choice> {
        match self {
            Self::Catalogue { of, .. } => Some(of),
            Self::Own(_) => None,
        }
    }
}

/// The equation that the step of a method solves.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Solver {
    /// A fused one, by the end of its type's name.
    Fused(&'static str),
    /// A generic one under an elimination of its own, by the end of that type's name.
    Eliminated(Partner, String),
    /// A generic one as it is, which is not the method's own.
    Generic(Partner),
}

/// What an equation is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// A state.
    State,
    /// So many of them, one for each stage.
    Stages(usize),
}

impl Unknown {
    /// The number of states.
    pub fn states(self) -> usize {
        match self {
            Self::State => 1,
            Self::Stages(count) => count,
        }
    }
}

/// The elimination of a pattern that repeats one block for each pair of stages.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Sparse {
    /// The end of its type's name.
    pub suffix: String,
    /// Its name in the table of operation counts.
    pub label: String,
    /// What is solved for.
    pub unknown: Unknown,
    /// The elimination.
    pub elimination: Elimination,
}

/// A discrete gradient in closed form.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Gradient {
    /// Which.
    pub gradient: methods::Gradient,
    /// The gradient, and the gradient with its derivative.
    pub functions: Vec<Function>,
}

/// A generating function.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Generating {
    /// The end of its type's name.
    pub suffix: &'static str,
    /// The function, as a formula.
    pub formula: &'static str,
    /// Its gradient.
    pub gradient: Function,
    /// Its gradient and Hessian; without it the Hessian comes from the gradient over dual numbers.
    pub linearize: Option<Function>,
    /// What is computed once for a step size.
    pub step: Constants,
}

impl Item {
    /// Its kernels.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        let (list, gradient, linearize) = match self {
            Self::Fused(fused) => (fused.functions.as_slice(), None, None),
            Self::Gradient(gradient) => (gradient.functions.as_slice(), None, None),
            Self::Generating(function) => {
                let function: &Generating = function;
                (
                    &[][..],
                    Some(&function.gradient),
                    function.linearize.as_ref(),
                )
            }
            Self::Sparse(_) | Self::Method(..) | Self::Recurrence(_) => (&[][..], None, None),
        };
        list.iter().chain(gradient).chain(linearize)
    }

    /// The label and the operation counts of an elimination that stands alone.
    pub fn elimination(&self) -> Option<(String, Counts)> {
        match self {
            Self::Sparse(sparse) => Some((sparse.label.clone(), sparse.elimination.counts())),
            _ => None,
        }
    }

    /// The labels and the operation counts of a recurrence.
    pub fn recurrence(&self) -> Vec<(String, Counts)> {
        match self {
            Self::Recurrence(recurrence) => recurrence.counts().into(),
            _ => Vec::new(),
        }
    }
}
