//! The flows of pieces that were found: `exp(t s ad*_v) mu` for each of the commuting elements v of a piece, by blocks; where one of them
//! has no blocks, `exp(ad*_x) mu` with `x = t sum s v` by the minimal polynomial of `ad*_x`. Of a Casimir c of a subalgebra
//! `x = t s grad c(mu)`, by the minimal polynomial on that subalgebra; what commutes with c is left alone. On a bracket that is declared by
//! its entries a flow is the map that was found.

use super::field::mu;
use super::splitting::{PieceKernel, Update, kernel};
use super::tape::Tape;
use super::{Kernel, Source};
use crate::structure::elementwise::Change;
use crate::structure::exponential::Exponential;
use crate::structure::found::{Factor, Found, Piece};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Symbols of intermediate quantities, beyond those of all vector arguments.
const FIRST: usize = 1 << 24;

/// The flow of a piece that was found.
#[derive(Clone, Debug)]
pub struct FoundKernel {
    /// Its terms.
    pub terms: Vec<ExprId>,
    /// The one-parameter groups of which its flow is the product, one after the other: that of all forms together, and one for each
    /// Casimir of the algebra or of a subalgebra.
    pub parts: Vec<PartKernel>,
    /// The gradient of the piece.
    pub direction: Kernel,
}

/// A part of a flow whose element is constant along it.
#[derive(Clone, Debug)]
pub struct PartKernel {
    /// Flows that make it up, one after the other; `None` where the series is summed.
    pub flows: Option<Vec<PieceKernel>>,
    /// The gradient of this part of the piece.
    pub direction: Kernel,
}

impl Source {
    /// The flows of the pieces that were found.
    pub fn found_kernels(&mut self, found: &Found) -> Vec<FoundKernel> {
        let pieces = found.pieces.iter().enumerate();
        pieces
            .map(|(place, piece)| self.found_kernel(found, place, piece))
            .collect()
    }

    fn found_kernel(&mut self, found: &Found, place: usize, piece: &Piece) -> FoundKernel {
        if let Some(map) = &piece.map {
            return self.map_kernel(piece, map);
        }
        let factors: Vec<Factor> = piece
            .factors
            .iter()
            .map(|factor| Factor {
                slope: self.as_written(found, place, factor),
                ..factor.clone()
            })
            .collect();
        let mut elements: Vec<Vec<Vec<ExprId>>> = Vec::new();
        let mut flows = Vec::new();
        if !factors.is_empty() {
            let of_forms = factors.iter().map(|f| (f.slope, &f.direction[..]));
            elements.push(self.element(of_forms));
            let closed = factors.iter().all(|factor| factor.blocks.is_some());
            let entries = self.sums(&elements[0]);
            flows.push(if closed {
                let factors = factors.iter();
                Some(factors.flat_map(|f| self.factor_flow(f)).collect())
            } else {
                let moved: Vec<usize> = (0..self.dimension).collect();
                self.exponential_flow(found.exponential.as_ref(), &entries, &moved)
                    .map(|flow| vec![flow])
            });
        }
        for conserved in &piece.conserved {
            let element = self.element([(conserved.slope, &conserved.gradient[..])].into_iter());
            let entries = self.sums(&element);
            elements.push(element);
            flows.push(match conserved.moved.as_slice() {
                [] => Some(Vec::new()),
                moved => self
                    .exponential_flow(conserved.exponential.as_ref(), &entries, moved)
                    .map(|flow| vec![flow]),
            });
        }
        let mut whole = vec![Vec::new(); self.dimension];
        for element in &elements {
            for (all, terms) in whole.iter_mut().zip(element) {
                all.extend(terms.iter().copied());
            }
        }
        let parts = flows.into_iter().zip(&elements);
        FoundKernel {
            terms: piece.terms.clone(),
            parts: parts
                .map(|(flows, element)| PartKernel {
                    flows,
                    direction: self.direction(element),
                })
                .collect(),
            direction: self.direction(&whole),
        }
    }

    /// The flow of a piece that is given as a map.
    fn map_kernel(&mut self, piece: &Piece, map: &[(usize, Change)]) -> FoundKernel {
        let value = self.graph.sum(&piece.terms);
        let gradient = (0..self.dimension).map(|i| {
            let slope = self.graph.derivative(value, Symbol::Coordinate(i));
            vec![slope]
        });
        let gradient: Vec<Vec<ExprId>> = gradient.collect();
        let direction = self.direction(&gradient);
        let mut values = vec![self.graph.integer(0); self.dimension];
        let updates = map.iter().map(|(i, change)| {
            let (update, value) = match change {
                Change::Add(value) => (Update::Add, value),
                Change::Multiply(value) => (Update::Multiply, value),
            };
            values[*i] = *value;
            update
        });
        let updates = updates.collect();
        let formula = "`x -> x(t)`, `x' = Pi(x) grad f(x)`, f the piece";
        let kernel = Kernel::vector(&self.graph, "flow", formula, vec![mu(self)], &values);
        FoundKernel {
            terms: piece.terms.clone(),
            parts: vec![PartKernel {
                flows: Some(vec![PieceKernel {
                    coordinate: map.first().map_or(0, |(i, _)| *i),
                    kernel: Some(kernel),
                    updates,
                }]),
                direction: direction.clone(),
            }],
            direction,
        }
    }

    /// `sum s v`, entry by entry.
    fn element<'a>(
        &mut self,
        parts: impl Iterator<Item = (ExprId, &'a [(usize, ExprId)])>,
    ) -> Vec<Vec<ExprId>> {
        let mut entries: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for (slope, direction) in parts {
            for (i, v) in direction {
                entries[*i].push(self.graph.mul(slope, *v));
            }
        }
        entries
    }

    fn sums(&mut self, element: &[Vec<ExprId>]) -> Vec<ExprId> {
        let entries = element.iter();
        entries.map(|terms| self.graph.sum(terms)).collect()
    }

    fn direction(&mut self, element: &[Vec<ExprId>]) -> Kernel {
        let entries = self.sums(element);
        let formula = "the gradient of the piece";
        Kernel::vector(&self.graph, "direction", formula, vec![mu(self)], &entries)
    }

    /// The slope of a coordinate as it was written, where it is that of the piece: H is split as it is, and no other
    /// piece contains the coordinate.
    fn as_written(&mut self, found: &Found, place: usize, factor: &Factor) -> ExprId {
        let contains = |graph, piece: &Piece, i: usize| {
            piece.factors.iter().any(|f| {
                f.direction.iter().any(|(j, _)| *j == i) || symbols(graph, f.slope).contains(&i)
            })
        };
        let (Some(i), None) = (factor.coordinate(&self.graph), found.rest) else {
            return factor.slope;
        };
        // a Casimir in the place of a part of H makes other derivatives
        let mut pieces = found.pieces.iter();
        if pieces.any(|piece| !piece.conserved.is_empty()) {
            return factor.slope;
        }
        let others = found
            .pieces
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != place);
        if others
            .map(|(_, piece)| piece)
            .any(|piece| contains(&self.graph, piece, i))
        {
            return factor.slope;
        }
        let written = self.gradient_of_h()[i];
        let piece = &found.pieces[place];
        let mut factors = piece.factors.iter();
        if factors.any(|factor| factor.coordinate(&self.graph).is_none()) {
            return factor.slope;
        }
        let inside = symbols(&self.graph, written).into_iter().all(|j| {
            piece
                .factors
                .iter()
                .any(|f| f.coordinate(&self.graph) == Some(j))
        });
        if inside { written } else { factor.slope }
    }

    /// `exp(t s ad*_v) mu` by blocks; none where v acts as zero.
    fn factor_flow(&mut self, factor: &Factor) -> Option<PieceKernel> {
        let blocks = factor.blocks.as_ref().filter(|blocks| !blocks.is_empty())?;
        let coordinate = factor.direction.first().map_or(0, |(i, _)| *i);
        Some(kernel(self, coordinate, blocks, factor.slope))
    }

    /// `exp(ad*_x) mu`, `x = t xi`, where functions of `ad*_x` have a closed form; only some coordinates move.
    fn exponential_flow(
        &mut self,
        exponential: Option<&Exponential>,
        xi: &[ExprId],
        moved_ones: &[usize],
    ) -> Option<PieceKernel> {
        let exponential = Some(exponential.cloned()?);
        let before = std::mem::replace(&mut self.exponential, exponential);
        let time = self.graph.symbol(Symbol::Time);
        let mut tape = Tape::new(self, FIRST);
        let x: Vec<ExprId> = xi
            .iter()
            .map(|entry| {
                let entry = self.graph.mul(time, *entry);
                tape.define(self, entry)
            })
            .collect();
        let m = self.coordinates();
        let moved = self.closed_function(&mut tape, (&x, &m), 0);
        self.exponential = before;
        let mut increments = vec![self.graph.integer(0); self.dimension];
        for &i in moved_ones {
            increments[i] = self.graph.sub(moved[i], m[i]);
        }
        let formula = "`mu -> exp(ad*_x) mu`, `x = t xi`, xi the gradient of the piece";
        let mut kernel = Kernel::vector(&self.graph, "flow", formula, vec![mu(self)], &increments);
        kernel.task.definitions = self.needed(tape.definitions(), &kernel.task.outputs);
        let count = increments
            .iter()
            .filter(|id| !self.graph.is_zero(**id))
            .count();
        Some(PieceKernel {
            coordinate: xi.iter().position(|id| !self.graph.is_zero(*id))?,
            kernel: Some(kernel),
            updates: vec![Update::Add; count],
        })
    }
}

/// The coordinates in an expression.
fn symbols(graph: &lie_symbolic::symbolic::Graph, id: ExprId) -> Vec<usize> {
    let symbols = graph.symbols(id).into_iter();
    let coordinates = symbols.filter_map(|symbol| match symbol {
        Symbol::Coordinate(i) => Some(i),
        _ => None,
    });
    coordinates.collect()
}
