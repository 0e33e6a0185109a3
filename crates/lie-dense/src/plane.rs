//! Real square matrices, read and written by small squares, and the squares of a skew-Hermitian matrix.

#![allow(
    clippy::needless_range_loop,
    reason = "by iterators the compiler does not keep squares in registers: a pass takes twice as long"
)]

use crate::skew::{SkewHermitian, imaginary_start, real_start};
use lie_runtime::State;
use ndarray::{ArrayView2, ArrayViewMut2, ShapeBuilder};

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

    pub(crate) fn view(&self) -> ArrayView2<'_, f64> {
        let shape = (self.size, self.size).strides((1, self.stride));
        match ArrayView2::from_shape(shape, &self.entries) {
            Ok(view) => view,
            Err(error) => unreachable!("there are as many entries: {error}"),
        }
    }

    pub(crate) fn view_mut(&mut self) -> ArrayViewMut2<'_, f64> {
        let shape = (self.size, self.size).strides((1, self.stride));
        match ArrayViewMut2::from_shape(shape, &mut self.entries) {
            Ok(view) => view,
            Err(error) => unreachable!("there are as many entries: {error}"),
        }
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

/// Where the imaginary and real parts of a square's column j stand from its first row on, as if all of them were kept. On the
/// diagonal what is above it belongs to other columns.
#[inline(always)]
fn starts(size: usize, column: usize, row: usize, j: usize) -> [usize; 2] {
    [
        imaginary_start(size, column + j) + row - column - j,
        real_start(size, column + j) + row - column - j - 1,
    ]
}

/// Imaginary and real parts of a square on or below the diagonal.
#[inline(always)]
pub(crate) fn load(matrix: &SkewHermitian, column: usize, row: usize) -> [Tile; 2] {
    let (size, coordinates) = (matrix.size(), matrix.as_slice());
    let mut tiles = [[[0.0; TILE]; TILE]; 2];
    if row + TILE <= size {
        for j in 0..TILE {
            let places = starts(size, column, row, j);
            tiles[0][j] = *block(coordinates, places[0]);
            tiles[1][j] = *block(coordinates, places[1]);
        }
    } else {
        for j in 0..TILE.min(size - column) {
            let places = starts(size, column, row, j);
            for (tile, place) in tiles.iter_mut().zip(places) {
                let rows = size - row;
                tile[j][..rows].copy_from_slice(&coordinates[place..place + rows]);
            }
        }
    }
    if row == column {
        return reflected(tiles);
    }
    tiles
}

/// Makes imaginary and real parts of a square on the diagonal those of a skew-Hermitian matrix, by what is below the diagonal.
#[inline(always)]
fn reflected([mut im, mut re]: [Tile; 2]) -> [Tile; 2] {
    for j in 0..TILE {
        for i in 0..j {
            im[j][i] = im[i][j];
            re[j][i] = -re[i][j];
        }
        re[j][j] = 0.0;
    }
    [im, re]
}

/// Writes imaginary and real parts of a square on or below the diagonal.
#[inline(always)]
pub(crate) fn store(matrix: &mut SkewHermitian, column: usize, row: usize, tiles: [&Tile; 2]) {
    let size = matrix.size();
    let coordinates = matrix.as_mut_slice();
    if row > column && row + TILE <= size {
        for j in 0..TILE {
            let places = starts(size, column, row, j);
            *block_mut(coordinates, places[0]) = tiles[0][j];
            *block_mut(coordinates, places[1]) = tiles[1][j];
        }
        return;
    }
    let rows = TILE.min(size - row);
    for j in 0..TILE.min(size - column) {
        let places = starts(size, column, row, j);
        let above = if row == column { [j, j + 1] } else { [0, 0] };
        for part in 0..2 {
            for i in 0..TILE {
                if i >= above[part] && i < rows {
                    coordinates[places[part] + i] = tiles[part][j][i];
                }
            }
        }
    }
}
