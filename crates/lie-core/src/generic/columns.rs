//! Points of `T*V^r` over a matrix representation V. Beside them are the momentum of the time and the time, where H
//! depends on it: their part of the algebra has no columns, since these would grow with the time.

use core::ops::Range;

use super::StageSlopes;
use super::lifts::LinearLift;
use crate::clock::{Clock, holds};
use crate::methods::Representation;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::ColumnPoisson;

/// The momentum `mu_k = sum_j y_j rho(e_k) x_j` of columns `x_j` and rows `y_j`.
#[inline(always)]
pub fn momentum_of_columns<S: Scalar, P: ColumnPoisson<S>>(
    system: &P,
    point: &P::Columns,
    out: &mut P::State,
) {
    let size = system.column_size();
    let clock = system.clock();
    let (columns, rows, pair) = parts(clock, point.as_slice());
    if let (Some(clock), &[momentum, time]) = (clock, pair) {
        let out = out.as_mut_slice();
        out[clock.momentum] = momentum;
        out[clock.time] = time;
        out[clock.time + 1] = S::one();
    }
    let matrices = system.representation().matrices.iter().enumerate();
    let counted = out.as_mut_slice().iter_mut().zip(matrices);
    for (out, (_, matrix)) in counted.filter(|(_, (k, _))| !holds(clock, *k)) {
        let mut sum = S::zero();
        for entry in *matrix {
            let (a, b) = entry.place();
            let pairs = columns.chunks_exact(size).zip(rows.chunks_exact(size));
            let products = pairs.map(|(x, y)| y[a] * x[b]);
            sum += entry.value::<S>() * products.fold(S::zero(), |sum, term| sum + term);
        }
        *out = sum;
    }
}

/// The canonical flow of `H o J` at a point, of which `xi` is the gradient of H at J: `x_j' = -rho(xi) x_j`,
/// `y_j' = y_j rho(xi)`.
#[inline(always)]
pub fn flow_of_columns<S: Scalar, P: ColumnPoisson<S>>(
    system: &P,
    point: &P::Columns,
    xi: &P::State,
    out: &mut P::Columns,
) {
    let size = system.column_size();
    out.fill(S::zero());
    let clock = system.clock();
    let (columns, rows, _) = parts(clock, point.as_slice());
    let middle = columns.len();
    let (out_columns, rest) = out.as_mut_slice().split_at_mut(middle);
    let (out_rows, pair) = rest.split_at_mut(middle);
    if let (Some(clock), [momentum, time]) = (clock, pair) {
        *momentum = -xi.as_slice()[clock.time];
        *time = xi.as_slice()[clock.momentum];
    }
    let matrices = system.representation().matrices.iter().enumerate();
    let counted = xi.as_slice().iter().zip(matrices);
    for (&xi, (_, matrix)) in counted.filter(|(_, (k, _))| !holds(clock, *k)) {
        for entry in *matrix {
            let (a, b) = entry.place();
            let value = entry.value::<S>() * xi;
            let pairs = out_columns.chunks_exact_mut(size);
            for (out, x) in pairs.zip(columns.chunks_exact(size)) {
                out[a] -= value * x[b];
            }
            let pairs = out_rows.chunks_exact_mut(size);
            for (out, y) in pairs.zip(rows.chunks_exact(size)) {
                out[b] += value * y[a];
            }
        }
    }
}

/// The canonical flow of `H o J` at a point; along the generator where something damps.
#[inline(always)]
pub fn flow_over_columns<S: Scalar, P: ColumnPoisson<S>>(
    system: &P,
    point: &P::Columns,
    out: &mut P::Columns,
) {
    let (mut momenta, mut generator) = (system.zero_state(), system.zero_state());
    momentum_of_columns(system, point, &mut momenta);
    system.generator(&momenta, &mut generator);
    flow_of_columns(system, point, &generator, out);
    if let Some(clock) = system.clock()
        && system.is_forced()
    {
        // the power of the damping
        system.force(&momenta, &mut generator);
        let middle = out.as_slice().len() - 2;
        out.as_mut_slice()[middle] += generator.as_slice()[clock.momentum];
    }
}

/// The point over a state: columns of the unit matrix, and rows that are linear in mu.
pub fn columns_of<S: Scalar, P: ColumnPoisson<S>>(
    system: &P,
    mu: &P::State,
    point: &mut P::Columns,
) {
    let (size, table) = (system.column_size(), system.columns());
    point.fill(S::zero());
    let half = size * table.indices.len();
    let (columns, rest) = point.as_mut_slice().split_at_mut(half);
    let (rows, pair) = rest.split_at_mut(half);
    if let (Some(clock), [momentum, time]) = (system.clock(), pair) {
        *momentum = mu.as_slice()[clock.momentum];
        *time = mu.as_slice()[clock.time];
    }
    for (column, &index) in columns.chunks_exact_mut(size).zip(table.indices) {
        column[usize::from(index)] = S::one();
    }
    for (&mu, covector) in mu.as_slice().iter().zip(table.covectors) {
        for entry in *covector {
            let (j, a) = entry.place();
            rows[size * j + a] += entry.value::<S>() * mu;
        }
    }
}

/// The columns and the rows, one after the other, and behind them what carries the time.
#[inline(always)]
fn parts<S>(clock: Option<Clock>, point: &[S]) -> (&[S], &[S], &[S]) {
    let (point, pair) = point.split_at(point.len() - if clock.is_some() { 2 } else { 0 });
    let (columns, rows) = point.split_at(point.len() / 2);
    (columns, rows, pair)
}

/// Over a group that is not compact, points become large.
impl<S: Scalar, P: ColumnPoisson<S>> LinearLift<S, P> for Representation {
    type Point = P::Columns;
    type Labels = [S; 0];
    const GROWS: bool = true;
    const SLOPES: Option<StageSlopes> = Some(StageSlopes::Representation);

    fn zero_point(system: &P) -> P::Columns {
        system.zero_columns()
    }

    fn zero_labels(_system: &P) -> [S; 0] {
        []
    }

    fn clock(system: &P) -> Option<Clock> {
        let count = system.zero_columns().as_slice().len();
        system.clock().map(|_| Clock {
            momentum: count - 2,
            time: count - 1,
        })
    }

    fn momenta(system: &P) -> Option<Range<usize>> {
        let pair = if system.clock().is_some() { 2 } else { 0 };
        let count = system.zero_columns().as_slice().len() - pair;
        Some(count / 2..count)
    }

    #[inline]
    fn lift(system: &P, mu: &P::State, _labels: &mut [S; 0], point: &mut P::Columns) {
        columns_of(system, mu, point);
    }

    #[inline(always)]
    fn project(system: &P, _labels: &[S; 0], point: &P::Columns, mu: &mut P::State) {
        momentum_of_columns(system, point, mu);
    }

    #[inline(always)]
    fn flow(system: &P, _labels: &[S; 0], point: &P::Columns, out: &mut P::Columns) {
        system.column_flow(point, out);
    }
}
