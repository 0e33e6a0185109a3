//! The flows of pieces that were found: `exp(t s ad*_v) mu` for each of the commuting elements v of a piece, by blocks; where one of them
//! has no blocks, `exp(ad*_x) mu` with `x = t sum s v` by the minimal polynomial of `ad*_x`.

use super::field::mu;
use super::splitting::{PieceKernel, Update, kernel};
use super::tape::Tape;
use super::{Kernel, Source};
use crate::structure::found::{Factor, Found, Piece};
use crate::symbolic::{ExprId, Symbol};

/// Symbols of intermediate quantities, beyond those of all vector arguments.
const FIRST: usize = 1 << 24;

/// The flow of a piece that was found.
#[derive(Clone, Debug)]
pub struct FoundKernel {
    /// Its terms.
    pub terms: Vec<ExprId>,
    /// Flows that make it up, one after the other; `None` where the series is summed.
    pub flows: Option<Vec<PieceKernel>>,
    /// The gradient of the piece, which is constant along its flow.
    pub direction: Kernel,
}

impl Source {
    /// The flows of the pieces that were found.
    pub fn found_kernels(&mut self) -> Option<Vec<FoundKernel>> {
        let found = self.found.clone()?;
        let pieces = found.pieces.iter().enumerate();
        Some(
            pieces
                .map(|(place, piece)| self.found_kernel(&found, place, piece))
                .collect(),
        )
    }

    fn found_kernel(&mut self, found: &Found, place: usize, piece: &Piece) -> FoundKernel {
        let factors: Vec<Factor> = piece
            .factors
            .iter()
            .map(|factor| Factor {
                slope: self.as_written(found, place, factor),
                ..factor.clone()
            })
            .collect();
        let mut entries: Vec<Vec<ExprId>> = vec![Vec::new(); self.dimension];
        for factor in &factors {
            for (i, v) in &factor.direction {
                entries[*i].push(self.graph.mul(factor.slope, *v));
            }
        }
        let entries: Vec<ExprId> = entries.iter().map(|terms| self.graph.sum(terms)).collect();
        let arguments = vec![mu(self)];
        let formula = "the gradient of the piece";
        let direction = Kernel::vector(&self.graph, "direction", formula, arguments, &entries);
        let closed = factors.iter().all(|factor| factor.blocks.is_some());
        let flows = if closed {
            Some(
                factors
                    .iter()
                    .flat_map(|factor| self.factor_flow(factor))
                    .collect(),
            )
        } else {
            self.exponential_flow(found, &entries)
                .map(|flow| vec![flow])
        };
        FoundKernel {
            terms: piece.terms.clone(),
            flows,
            direction,
        }
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

    /// `exp(ad*_x) mu`, `x = t xi`, where functions of `ad*_x` have a closed form.
    fn exponential_flow(&mut self, found: &Found, xi: &[ExprId]) -> Option<PieceKernel> {
        let exponential = Some(found.exponential.clone()?);
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
        let increments: Vec<ExprId> = moved
            .iter()
            .zip(&m)
            .map(|(a, b)| self.graph.sub(*a, *b))
            .collect();
        let formula = "`mu -> exp(ad*_x) mu`, `x = t xi`, xi the gradient of the piece";
        let mut kernel = Kernel::vector(&self.graph, "flow", formula, vec![mu(self)], &increments);
        kernel.task.definitions = tape.definitions().to_vec();
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
fn symbols(graph: &crate::symbolic::Graph, id: ExprId) -> Vec<usize> {
    let symbols = graph.symbols(id).into_iter();
    let coordinates = symbols.filter_map(|symbol| match symbol {
        Symbol::Coordinate(i) => Some(i),
        _ => None,
    });
    coordinates.collect()
}
