//! Sparse eliminations: as codes, or as tables where they are long.

mod codes;
mod table;

use crate::code::Code;
use crate::compiled::{CodeBuilder, Values};
use crate::engine::ARGUMENTS;
use codes::Layout;
use lie_codegen::plan::elimination::Elimination as Pattern;
use lie_core::family::LateMatrix;
use lie_runtime::{Scalar, SquareMatrix, StageMatrix, Unknown};
use table::Table;

/// With more multiplications than this an elimination is run from its table: machine code of it would take longer to make than it
/// saves in most runs.
const LONGEST: usize = 2000;

/// An elimination with pivots in a fixed order, as generated code writes it out.
#[derive(Clone, Debug, Default)]
pub struct Elimination {
    table: Table,
    codes: Option<Codes>,
}

/// The codes of factorisation and solution.
#[derive(Clone, Copy, Debug)]
struct Codes {
    factor: usize,
    solve: usize,
    layout: Layout,
}

/// Matrices in square blocks, each of which lies in one piece, row after row.
pub trait Blocks<S> {
    /// The number of blocks in a row of them.
    fn block_count(&self) -> usize;
    /// A block.
    fn block(&self, row: usize, column: usize) -> &[S];
    /// A block, to be written.
    fn block_mut(&mut self, row: usize, column: usize) -> &mut [S];
}

impl<S: Scalar> Blocks<S> for LateMatrix<S> {
    fn block_count(&self) -> usize {
        1
    }
    fn block(&self, _row: usize, _column: usize) -> &[S] {
        self.as_slice()
    }
    fn block_mut(&mut self, _row: usize, _column: usize) -> &mut [S] {
        self.as_mut_slice()
    }
}

impl<S, M: Blocks<S>, const STAGES: usize> Blocks<S> for StageMatrix<M, STAGES> {
    fn block_count(&self) -> usize {
        STAGES * self.0[0][0].block_count()
    }
    fn block(&self, row: usize, column: usize) -> &[S] {
        let count = self.0[0][0].block_count();
        self.0[row / count][column / count].block(row % count, column % count)
    }
    fn block_mut(&mut self, row: usize, column: usize) -> &mut [S] {
        let count = self.0[0][0].block_count();
        self.0[row / count][column / count].block_mut(row % count, column % count)
    }
}

/// What codes read and write of a matrix in several blocks, and of a vector.
#[derive(Clone, Debug, Default)]
pub struct Scratch<S> {
    read: Vec<S>,
    factors: Vec<S>,
    solution: Vec<S>,
}

impl<S: Scalar> Scratch<S> {
    /// All blocks of a matrix one behind the other; the matrix itself where it has one.
    fn gathered<'a, M: Blocks<S>>(read: &'a mut Vec<S>, matrix: &'a M) -> &'a [S] {
        let across = matrix.block_count();
        if across == 1 {
            return matrix.block(0, 0);
        }
        read.clear();
        for place in 0..across * across {
            read.extend_from_slice(matrix.block(place / across, place % across));
        }
        read
    }
}

impl Elimination {
    /// The elimination of a pattern, of a matrix in blocks of so many rows.
    pub fn new(pattern: &Pattern, size: usize, making: &mut CodeBuilder) -> Self {
        let table = Table::new(pattern);
        let codes = (pattern.multiplications() <= LONGEST).then(|| {
            let layout = Layout::new(size, pattern.order.len());
            Codes {
                factor: making.push(table.factorisation(layout)),
                solve: making.push(table.solution(layout)),
                layout,
            }
        });
        Self { table, codes }
    }

    /// A code that writes the residual of a state and its Jacobian, with the elimination: it writes the solution with the
    /// residual behind it, and the factors. None where the elimination is long.
    pub fn update(&self, linearize: &Code, size: usize) -> Option<Code> {
        let short = self.codes.is_some();
        short.then(|| self.table.update(linearize, size))
    }

    /// The lanes in which every pivot of a matrix in one block was safe, by its factors.
    pub fn are_safe<S: Scalar>(&self, factors: &[S], size: usize) -> S::Mask {
        self.table.are_safe(|index| factors[index * size + index])
    }

    /// The codes, where they fit a matrix.
    fn codes<S: Scalar, M: Blocks<S> + SquareMatrix<S>>(&self, matrix: &M) -> Option<Codes> {
        let codes = self.codes?;
        let fits = codes.layout.fits(matrix.block_count(), matrix.dimension());
        fits.then_some(codes)
    }

    /// Replaces a matrix by its triangular factors; the lanes in which every pivot was safe.
    pub fn factor<S: Scalar, M: Blocks<S> + SquareMatrix<S>>(
        &self,
        values: &Values<S>,
        matrix: &mut M,
        scratch: &mut Scratch<S>,
    ) -> S::Mask {
        let Some(codes) = self.codes(matrix) else {
            return self.table.factor(matrix);
        };
        let Scratch { read, factors, .. } = scratch;
        factors.resize(codes.layout.entries(), S::zero());
        let from = Scratch::gathered(read, matrix);
        let frame = values.frame([from, &[], &[], &[]], &[], &[]);
        values.run(codes.factor, &frame, [factors, &mut []]);
        let across = matrix.block_count();
        let blocks = factors.chunks_exact(codes.layout.entries() / (across * across));
        for (place, block) in blocks.enumerate() {
            let into = matrix.block_mut(place / across, place % across);
            into.copy_from_slice(block);
        }
        self.table
            .are_safe(|index| factors[codes.layout.place(index, index)])
    }

    /// Solves in place of the right side.
    pub fn solve<S: Scalar, M: Blocks<S> + SquareMatrix<S>, U: Unknown<S>>(
        &self,
        values: &Values<S>,
        factors: &M,
        vector: &mut U,
        scratch: &mut Scratch<S>,
    ) {
        let Some(codes) = self.codes(factors) else {
            return self.table.solve(factors, vector);
        };
        let Scratch { read, solution, .. } = scratch;
        solution.resize(vector.len(), S::zero());
        let from = Scratch::gathered(read, factors);
        let mut places: [&[S]; ARGUMENTS] = [from, &[], &[], &[]];
        for (place, part) in places[1..].iter_mut().zip(0..vector.parts()) {
            *place = vector.part(part);
        }
        let frame = values.frame(places, &[], &[]);
        values.run(codes.solve, &frame, [solution, &mut []]);
        let width = solution.len() / vector.parts();
        for (part, values) in solution.chunks_exact(width).enumerate() {
            vector.part_mut(part).copy_from_slice(values);
        }
    }
}
