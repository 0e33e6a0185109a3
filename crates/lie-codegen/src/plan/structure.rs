//! What a system may have beyond its bracket: matrices, spins, inertia, a realization.

use super::constants::Code;
use super::function::Function;
use super::planner::Planner;
use crate::algebra::Columns;
use crate::derive::{Kernel, Points};
use crate::methods::Lift;
use crate::structure::inertia::Body;
use crate::structure::integrable::Motion;
use crate::structure::lifts::Smallest;
use crate::structure::spectrum;
use crate::structure::unitary::is_skew;
use crate::structure::vectors::Component;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::ExprId;

/// Matrices by rows.
pub type Matrices = Vec<Vec<Vec<Rational>>>;

/// The structure of a system.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Structure {
    /// The group of the declared matrices.
    pub group: Option<Group>,
    /// The representation, where it carries collective methods.
    pub representation: Option<Representation>,
    /// Whether no real eigenvalue but 0 has an element of matrices with parameters, of which there is no representation here.
    pub imaginary: bool,
    /// The summands of a direct sum of algebras so(3).
    pub spins: Option<Spins>,
    /// The form of the flow, where it is known.
    pub motion: Option<Motion>,
    /// The parts of so(3) with vectors.
    pub vectors: Option<Vectors>,
    /// The unitary representation that the matrices are.
    pub unitary: Option<Unitary>,
    /// The smallest linear symplectic space over the system.
    pub smallest: Option<Smallest>,
    /// The inertia of a free rigid body in four dimensions or more.
    pub inertia: Option<Inertia>,
    /// The number of momenta of a system on `T*G`, which are its first coordinates.
    pub momenta: Option<usize>,
    /// The declared realization.
    pub realization: Option<Realization>,
    /// The kernels of the declared retraction: its pullback, the slope of that, its action and its matrix; none where there is no such.
    pub retraction: Vec<Function>,
    /// The kernels of coordinates in which the bracket is constant; none where no such are known or needed.
    pub canonical: Vec<Function>,
}

/// A matrix group.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Group {
    /// The size of the matrices.
    pub size: usize,
    /// The matrix of each basis element.
    pub matrices: Matrices,
    /// Whether Gauss methods in the entries stay in the group.
    pub closed: bool,
    /// Whether the matrices are antisymmetric.
    pub orthogonal: bool,
    /// Whether the system is right-invariant.
    pub right: bool,
}

/// A representation with its dual.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Representation {
    /// The size of the matrices.
    pub size: usize,
    /// The matrix of each basis element.
    pub matrices: Matrices,
    /// Their dual matrices.
    pub dual: Matrices,
    /// Whether all of them are antisymmetric.
    pub skew: bool,
    /// What is known of the eigenvalues.
    pub spectrum: Spectrum,
    /// The columns from which methods on points start.
    pub columns: Option<Columns>,
    /// The size of a column.
    pub column: usize,
    /// The number of coordinates of a point.
    pub point: usize,
    /// The flow of columns, where a method that is asked for needs it.
    pub flow: Option<Function>,
}

/// What is known of the eigenvalues of all elements of a representation.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Spectrum {
    /// None is real but 0.
    Imaginary,
    /// The absolute value of each is at most the sum of these weights times the absolute coordinates.
    Bounded(Vec<Rational>),
}

/// The summands of a direct sum of algebras so(3).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Spins {
    /// The coordinates of each.
    pub coordinates: Vec<[usize; 3]>,
    /// The constant of the bracket of each.
    pub scales: Vec<Code>,
    /// The flow of their points, where a method that is asked for needs it.
    pub flow: Option<Function>,
}

/// The parts of so(3) with vectors.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Vectors {
    /// The coordinates of the rotations.
    pub rotation: [usize; 3],
    /// The components of each vector.
    pub vectors: Vec<[Component; 3]>,
    /// The constant of the bracket.
    pub scale: Code,
    /// The flow of their points, where a method that is asked for needs it.
    pub flow: Option<Function>,
}

/// A unitary representation.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Unitary {
    /// The number of complex rows.
    pub degree: usize,
    /// The number of coordinates of a point.
    pub point: usize,
    /// The flow of points, where a method that is asked for needs it.
    pub flow: Option<Function>,
}

/// The inertia of a free rigid body.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Inertia {
    /// From and to of each basis element `E_(to, from) - E_(from, to)`.
    pub planes: Vec<(usize, usize)>,
    /// The moment of each axis.
    pub moments: Vec<Code>,
    /// The products of inertia that are not zero, by two axes in their order.
    pub products: Vec<((usize, usize), Code)>,
}

/// A Poisson map from canonical coordinates.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Realization {
    /// Names of the canonical coordinates.
    pub names: Vec<String>,
    /// The map and its derivatives.
    pub functions: Vec<Function>,
    /// A point near which points over a state are sought, entry by entry.
    pub start: Vec<Code>,
    /// Whether the declaration gives it.
    pub given: bool,
    /// Whether Gauss methods over it are methods for the state.
    pub descends: bool,
}

impl Structure {
    /// What is known of the eigenvalues of the matrices.
    pub fn spectrum(&self) -> Option<&Spectrum> {
        let of_numbers = self.representation.as_ref();
        let of_numbers = of_numbers.map(|representation| &representation.spectrum);
        of_numbers.or(self.imaginary.then_some(&Spectrum::Imaginary))
    }
}

impl Planner<'_> {
    /// The structure of the system.
    pub(super) fn structure(&mut self) -> Structure {
        let spins = self.spins();
        let inertia = self.inertia();
        let vectors = self.vectors();
        Structure {
            group: self.group(),
            representation: self.representation(),
            imaginary: self.source.is_imaginary(),
            spins,
            motion: self.source.motion(),
            vectors,
            unitary: self.unitary(),
            smallest: self.structure.smallest,
            inertia,
            momenta: self.source.momenta(),
            realization: self.realization(),
            retraction: self.retraction(),
            canonical: self.canonical(),
        }
    }

    fn group(&self) -> Option<Group> {
        let group = self.source.group()?;
        Some(Group {
            size: group.size,
            matrices: group.matrices.clone(),
            closed: group.closed,
            orthogonal: group.matrices.iter().all(is_skew),
            right: group.right,
        })
    }

    fn representation(&mut self) -> Option<Representation> {
        let flow = self.flow_on(Lift::Representation);
        let points = self.source.columns();
        let representation = self.source.matrices()?;
        let dual = representation.dual.as_ref()?;
        let mut all = representation.matrices.iter().chain(dual);
        Some(Representation {
            size: representation.dimension,
            matrices: representation.matrices.clone(),
            dual: dual.clone(),
            skew: all.all(is_skew),
            column: points.as_ref().map_or(0, |points| points.size),
            point: points.as_ref().map_or(0, Points::count),
            columns: points.map(|points| points.columns),
            flow,
            spectrum: match spectrum::spectrum(&representation.matrices) {
                spectrum::Spectrum::Imaginary => Spectrum::Imaginary,
                spectrum::Spectrum::Bounded(weights) => {
                    Spectrum::Bounded(weights.into_iter().filter_map(Rational::from_f64).collect())
                }
            },
        })
    }

    fn spins(&mut self) -> Option<Spins> {
        let spins = self.source.spheres()?.to_vec();
        Some(Spins {
            coordinates: spins.iter().map(|spin| spin.coordinates).collect(),
            scales: spins.iter().map(|spin| self.value(spin.scale)).collect(),
            flow: self
                .source
                .spins()
                .is_some()
                .then(|| self.flow_on(Lift::Hopf))
                .flatten(),
        })
    }

    fn inertia(&mut self) -> Option<Inertia> {
        let Body::Many {
            planes,
            moments,
            products,
        } = self.source.body()?.clone()
        else {
            return None;
        };
        let products = products.into_iter();
        Some(Inertia {
            planes,
            moments: moments.iter().map(|moment| self.value(*moment)).collect(),
            products: products
                .map(|(axes, product)| (axes, self.value(product)))
                .collect(),
        })
    }

    fn retraction(&mut self) -> Vec<Function> {
        if !self.follows_retraction() {
            return Vec::new();
        }
        let kernels = self.source.retraction_kernels();
        kernels.map_or_else(Vec::new, |kernels| self.functions(&kernels))
    }

    fn canonical(&mut self) -> Vec<Function> {
        if !self.follows_canonical() {
            return Vec::new();
        }
        let kernels = self.source.canonical_kernels();
        kernels.map_or_else(Vec::new, |kernels| self.functions(&kernels))
    }

    fn realization(&mut self) -> Option<Realization> {
        let realization = self.source.realization()?;
        let kernels = self.source.realization_kernels()?;
        let functions = self.functions(&kernels);
        let start = realization.start.iter();
        Some(Realization {
            start: start.map(|value| self.value(*value)).collect(),
            functions,
            names: realization.names,
            given: realization.given,
            descends: realization.descends,
        })
    }

    /// The program of one value that depends on the parameters alone.
    pub(super) fn value(&mut self, value: ExprId) -> Code {
        let kernel = Kernel::scalar("", "", Vec::new(), value);
        let program = kernel.program(&mut self.source.graph);
        self.code_of_system(&program)
    }
}
