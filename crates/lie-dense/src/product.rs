//! Products of skew-Hermitian matrices: three real products in the place of a complex one.
//!
//! With `P = A + i S`, A antisymmetric and S symmetric, and any `X = X1 + i X2`:
//!
//! ```text
//! X P = (X1 A - X2 S) + i ((X1 + X2)(A + S) - X1 A - X2 S)
//! ```
//!
//! The real products are those of ndarray, by the library matrixmultiply, which chooses its kernels by the processor.

use crate::plane::{Plane, Tile, block, block_mut, load, scaled, store, tiles, transposed, zipped};
use crate::skew::{SkewHermitian, places};
use crate::triangle::lower_product;
use lie_runtime::State;
use ndarray::linalg::general_mat_mul;
use pulp::{Arch, NullaryFnOnce};

/// Three real matrices: of a skew-Hermitian one `A + i S` they are A, S, A + S; of any `X1 + i X2` X1, X2, X1 + X2.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    real: Plane,
    imaginary: Plane,
    sum: Plane,
}

impl Planes {
    pub(crate) fn zeros(size: usize) -> Self {
        Self {
            real: Plane::zeros(size),
            imaginary: Plane::zeros(size),
            sum: Plane::zeros(size),
        }
    }

    /// Takes a factor times a skew-Hermitian matrix.
    pub(crate) fn spread(&mut self, matrix: &SkewHermitian, factor: f64) {
        widest(Spread(self, matrix, factor));
    }

    #[inline(always)]
    fn spread_entries(&mut self, matrix: &SkewHermitian, factor: f64) {
        for (column, row) in tiles(self.real.size) {
            let [im, re] = load(matrix, column, row);
            let (im, re) = (scaled(&im, factor), scaled(&re, factor));
            if row != column {
                let (im, re) = (transposed(&im), scaled(&transposed(&re), -1.0));
                self.set_tiles(row, column, [&re, &im]);
            }
            self.set_tiles(column, row, [&re, &im]);
        }
    }

    #[inline(always)]
    fn set_tiles(&mut self, column: usize, row: usize, [re, im]: [&Tile; 2]) {
        self.real.set_tile(column, row, re);
        self.imaginary.set_tile(column, row, im);
        self.sum
            .set_tile(column, row, &zipped(re, im, |x, y| x + y));
    }

    /// `self = X = left right`, and `change = X - X^H`.
    pub(crate) fn multiply(&mut self, left: &Self, right: &Self, change: &mut SkewHermitian) {
        for (out, left, right) in [
            (&mut self.real, &left.real, &right.real),
            (&mut self.imaginary, &left.imaginary, &right.imaginary),
            (&mut self.sum, &left.sum, &right.sum),
        ] {
            general_mat_mul(1.0, &left.view(), &right.view(), 0.0, &mut out.view_mut());
        }
        widest(Combine(self, change));
    }

    /// The parts of a product, from its three real ones.
    #[inline(always)]
    fn combine(&mut self, change: &mut SkewHermitian) {
        for (column, row) in tiles(self.real.size) {
            let [re, im] = self.combine_tile(column, row);
            let [opposite_re, opposite_im] = if row == column {
                [re, im]
            } else {
                self.combine_tile(row, column)
            };
            let re = zipped(&re, &transposed(&opposite_re), |x, y| x - y);
            let im = zipped(&im, &transposed(&opposite_im), |x, y| x + y);
            store(change, column, row, [&im, &re]);
        }
    }

    #[inline(always)]
    fn combine_tile(&mut self, column: usize, row: usize) -> [Tile; 2] {
        let first = self.real.tile(column, row);
        let second = self.imaginary.tile(column, row);
        let third = self.sum.tile(column, row);
        let re = zipped(&first, &second, |x, y| x - y);
        let im = zipped(&third, &zipped(&first, &second, |x, y| x + y), |x, y| x - y);
        let sum = zipped(&third, &second, |x, y| x - (y + y));
        self.real.set_tile(column, row, &re);
        self.imaginary.set_tile(column, row, &im);
        self.sum.set_tile(column, row, &sum);
        [re, im]
    }

    /// The three products of `left right` below and on the diagonal, for [`Planes::advance`].
    pub(crate) fn multiply_below(&mut self, left: &Self, right: &Self) {
        for (out, left, right) in [
            (&mut self.real, &left.real, &right.real),
            (&mut self.imaginary, &left.imaginary, &right.imaginary),
            (&mut self.sum, &left.sum, &right.sum),
        ] {
            lower_product(left.view(), right.view(), out.view_mut());
        }
    }

    /// `out = base + change + Y` with the skew-Hermitian product Y that [`Planes::multiply_below`] has found; the sizes of
    /// `out - before` and of `out`, not finite where an entry is not.
    pub(crate) fn advance(
        &self,
        [base, change, before]: [&SkewHermitian; 3],
        out: &mut SkewHermitian,
    ) -> [f64; 2] {
        widest(Advance(self, [base, change, before], out))
    }

    #[inline(always)]
    fn advance_entries(&self, inputs: [&SkewHermitian; 3], out: &mut SkewHermitian) -> [f64; 2] {
        let (size, stride) = (self.real.size, self.real.stride);
        let mut sizes = Sizes::default();
        for k in 0..size {
            let (im, re) = places(size, k);
            let first = &self.real.entries[k * stride + k..k * stride + size];
            let second = &self.imaginary.entries[k * stride + k..k * stride + size];
            let third = &self.sum.entries[k * stride + k..k * stride + size];
            let columns = inputs.map(|matrix| &matrix.as_slice()[im.clone()]);
            let out_column = &mut out.as_mut_slice()[im];
            let product = |x: f64, y: f64, z: f64| z - (x + y);
            sizes.advance(columns, [first, second, third], out_column, product);
            let columns = inputs.map(|matrix| &matrix.as_slice()[re.clone()]);
            let out_column = &mut out.as_mut_slice()[re];
            let parts = [&first[1..], &second[1..], &third[1..]];
            sizes.advance(columns, parts, out_column, |x, y, _| x - y);
        }
        sizes.largest()
    }

    /// `out = i X` of an anti-Hermitian multiple: takes X, which must be Hermitian, as `-i` times a skew-Hermitian matrix.
    pub(crate) fn times_i(&self, out: &mut SkewHermitian) {
        let size = self.real.size;
        for column in 0..size {
            for row in column..size {
                let place = column * self.real.stride + row;
                let (re, im) = (self.real.entries[place], self.imaginary.entries[place]);
                out.set_lower(row, column, (-im, re));
            }
        }
    }

    /// `Re tr(X^H Y)`.
    pub(crate) fn inner(&self, other: &Self) -> f64 {
        let (size, stride) = (self.real.size, self.real.stride);
        let mut sum = 0.0;
        for column in 0..size {
            let place = column * stride..column * stride + size;
            for plane in [
                (&self.real, &other.real),
                (&self.imaginary, &other.imaginary),
            ] {
                let pairs = plane.0.entries[place.clone()]
                    .iter()
                    .zip(&plane.1.entries[place.clone()]);
                sum += pairs.map(|(x, y)| x * y).sum::<f64>();
            }
        }
        sum
    }
}

/// Runs a pass over entries compiled for the widest registers of the processor; the operations and their order, and so the
/// result, are the same on every one.
pub(crate) fn widest<P: NullaryFnOnce>(pass: P) -> P::Output {
    Arch::new().dispatch(pass)
}

struct Spread<'a>(&'a mut Planes, &'a SkewHermitian, f64);
struct Combine<'a>(&'a mut Planes, &'a mut SkewHermitian);
struct Advance<'a>(&'a Planes, [&'a SkewHermitian; 3], &'a mut SkewHermitian);

impl NullaryFnOnce for Spread<'_> {
    type Output = ();
    #[inline(always)]
    fn call(self) {
        self.0.spread_entries(self.1, self.2);
    }
}

impl NullaryFnOnce for Combine<'_> {
    type Output = ();
    #[inline(always)]
    fn call(self) {
        self.0.combine(self.1);
    }
}

impl NullaryFnOnce for Advance<'_> {
    type Output = [f64; 2];
    #[inline(always)]
    fn call(self) -> [f64; 2] {
        self.0.advance_entries(self.1, self.2)
    }
}

/// Entries of a column that are treated together.
const LANES: usize = 8;

/// The largest update and the largest entry so far, in lanes.
#[derive(Default)]
struct Sizes {
    update: [f64; LANES],
    size: [f64; LANES],
    /// 0, or not a number where an entry was not finite.
    spoiled: [f64; LANES],
}

impl Sizes {
    #[inline(always)]
    fn advance(
        &mut self,
        [base, change, before]: [&[f64]; 3],
        [first, second, third]: [&[f64]; 3],
        out: &mut [f64],
        product: impl Fn(f64, f64, f64) -> f64,
    ) {
        let (mut update, mut size, mut spoiled) = (self.update, self.size, self.spoiled);
        let count = out.len();
        let whole = count - count % LANES;
        for k in (0..whole).step_by(LANES) {
            let (base, change) = (block::<LANES>(base, k), block::<LANES>(change, k));
            let first = block::<LANES>(first, k);
            let second = block::<LANES>(second, k);
            let third = block::<LANES>(third, k);
            let before = block::<LANES>(before, k);
            let out = block_mut::<LANES>(out, k);
            for lane in 0..LANES {
                let product = product(first[lane], second[lane], third[lane]);
                let value = base[lane] + change[lane] + product;
                let difference = (value - before[lane]).abs();
                out[lane] = value;
                update[lane] = larger(update[lane], difference);
                size[lane] = larger(size[lane], value.abs());
                spoiled[lane] += difference * 0.0;
            }
        }
        for k in whole..count {
            let value = base[k] + change[k] + product(first[k], second[k], third[k]);
            let difference = (value - before[k]).abs();
            out[k] = value;
            update[k - whole] = larger(update[k - whole], difference);
            size[k - whole] = larger(size[k - whole], value.abs());
            spoiled[k - whole] += difference * 0.0;
        }
        (self.update, self.size, self.spoiled) = (update, size, spoiled);
    }

    #[inline(always)]
    fn largest(&self) -> [f64; 2] {
        let spoiled: f64 = self.spoiled.iter().sum();
        [self.update, self.size].map(|lanes| lanes.into_iter().fold(0.0, larger) + spoiled)
    }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
