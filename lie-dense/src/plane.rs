//! Real square matrices, read and written by small squares, and the squares of a skew-Hermitian matrix.

#![allow(
    clippy::needless_range_loop,
    reason = "by iterators the compiler does not keep squares in registers: a pass takes twice as long"
)]

use crate::skew::{SkewHermitian, imaginary_start, real_start};
use core::ops::Range;
use faer::{MatMut, MatRef};
use lie_runtime::State;

/// Columns are farther apart than rows are many: a distance of a power of two would put a row into few lines of the cache.
const PADDING: usize = 8;
/// Transposition goes by squares of this many rows.
pub(crate) const TILE: usize = 4;

/// A real square matrix, columns first.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    pub(crate) size: usize,
    pub(crate) stride: usize,
    pub(crate) entries: Vec<f64>,
}

impl Plane {
    pub(crate) fn zeros(size: usize) -> Self {
        let tiled = size.next_multiple_of(TILE);
        let stride = tiled + PADDING;
        Self {
            size,
            stride,
            entries: vec![0.0; stride * tiled],
        }
    }

    pub(crate) fn get(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice_with_stride(
            &self.entries[..self.stride * self.size],
            self.size,
            self.size,
            self.stride,
        )
    }

    pub(crate) fn get_mut(&mut self) -> MatMut<'_, f64> {
        MatMut::from_column_major_slice_with_stride_mut(
            &mut self.entries[..self.stride * self.size],
            self.size,
            self.size,
            self.stride,
        )
    }

    /// A square, columns first; beyond the matrix it is of no meaning.
    #[inline(always)]
    pub(crate) fn tile(&self, column: usize, row: usize) -> Tile {
        let place = column * self.stride + row;
        let mut tile = [[0.0; TILE]; TILE];
        for j in 0..TILE {
            tile[j] = *block(&self.entries, place + j * self.stride);
        }
        tile
    }

    #[inline(always)]
    pub(crate) fn set_tile(&mut self, column: usize, row: usize, tile: &Tile) {
        let place = column * self.stride + row;
        for j in 0..TILE {
            *block_mut(&mut self.entries, place + j * self.stride) = tile[j];
        }
    }
}

/// Some entries in a row.
#[inline(always)]
pub(crate) fn block<const COUNT: usize>(entries: &[f64], place: usize) -> &[f64; COUNT] {
    match entries[place..].first_chunk() {
        Some(block) => block,
        None => unreachable!("squares lie within the plane"),
    }
}

#[inline(always)]
pub(crate) fn block_mut<const COUNT: usize>(
    entries: &mut [f64],
    place: usize,
) -> &mut [f64; COUNT] {
    match entries[place..].first_chunk_mut() {
        Some(block) => block,
        None => unreachable!("squares lie within the plane"),
    }
}

/// A square of a matrix, columns first.
pub(crate) type Tile = [[f64; TILE]; TILE];

/// Column and row where each square on and below the diagonal starts.
pub(crate) fn tiles(size: usize) -> impl Iterator<Item = (usize, usize)> {
    let starts = move |from: usize| (from..size).step_by(TILE);
    starts(0).flat_map(move |column| starts(column).map(move |row| (column, row)))
}

#[inline(always)]
pub(crate) fn transposed(tile: &Tile) -> Tile {
    let mut out = [[0.0; TILE]; TILE];
    for j in 0..TILE {
        for i in 0..TILE {
            out[j][i] = tile[i][j];
        }
    }
    out
}

#[inline(always)]
pub(crate) fn scaled(tile: &Tile, factor: f64) -> Tile {
    let mut out = *tile;
    for j in 0..TILE {
        for i in 0..TILE {
            out[j][i] *= factor;
        }
    }
    out
}

#[inline(always)]
pub(crate) fn zipped(one: &Tile, other: &Tile, operation: impl Fn(f64, f64) -> f64) -> Tile {
    let mut out = *one;
    for j in 0..TILE {
        for i in 0..TILE {
            out[j][i] = operation(one[j][i], other[j][i]);
        }
    }
    out
}

/// The places of a square's column j among the coordinates, imaginary and real parts, and the rows of the square where they
/// start.
#[inline(always)]
fn spans(size: usize, column: usize, row: usize, j: usize) -> [(Range<usize>, usize); 2] {
    let rows = TILE.min(size - row);
    let first = if row == column { j } else { 0 };
    let im = imaginary_start(size, column + j) + row + first - column - j;
    let below = if row == column { (j + 1).min(rows) } else { 0 };
    let re = (real_start(size, column + j) + row + below) - (column + j + 1);
    [
        (im..im + rows - first, first),
        (re..re + rows - below, below),
    ]
}

/// Imaginary and real parts of a square on or below the diagonal.
#[inline(always)]
pub(crate) fn load(matrix: &SkewHermitian, column: usize, row: usize) -> [Tile; 2] {
    let (size, coordinates) = (matrix.size(), matrix.as_slice());
    let mut tiles = [[[0.0; TILE]; TILE]; 2];
    if row > column && row + TILE <= size {
        for j in 0..TILE {
            let im = imaginary_start(size, column + j) + row - column - j;
            let re = real_start(size, column + j) + row - column - j - 1;
            tiles[0][j] = *block(coordinates, im);
            tiles[1][j] = *block(coordinates, re);
        }
        return tiles;
    }
    for j in 0..TILE.min(size - column) {
        for (tile, (span, first)) in tiles.iter_mut().zip(spans(size, column, row, j)) {
            let values = &coordinates[span];
            for (out, &value) in tile[j][first..].iter_mut().zip(values) {
                *out = value;
            }
        }
    }
    tiles
}

/// Writes imaginary and real parts of a square on or below the diagonal.
#[inline(always)]
pub(crate) fn store(matrix: &mut SkewHermitian, column: usize, row: usize, tiles: [&Tile; 2]) {
    let size = matrix.size();
    let coordinates = matrix.as_mut_slice();
    if row > column && row + TILE <= size {
        for j in 0..TILE {
            let im = imaginary_start(size, column + j) + row - column - j;
            let re = real_start(size, column + j) + row - column - j - 1;
            *block_mut(coordinates, im) = tiles[0][j];
            *block_mut(coordinates, re) = tiles[1][j];
        }
        return;
    }
    for j in 0..TILE.min(size - column) {
        for (tile, (span, first)) in tiles.iter().zip(spans(size, column, row, j)) {
            let out = &mut coordinates[span];
            for (out, &value) in out.iter_mut().zip(&tile[j][first..]) {
                *out = value;
            }
        }
    }
}
