//! Whether the group element beside a run belongs to it.
//!
//! With `g' = g xi` the momentum in space, `Ad*_(g^-1) mu`, is constant: to round-off where a method is of coadjoint form,
//! elsewhere to its order. The element is that of the chart of matrices, by the driver; the action is that of the
//! matrices on the declared ones, which the driver does not use.

use super::findings::Finding;
use super::ground::Ground;
use super::{PER_STEP, largest, smaller_steps};
use crate::basis::Basis;
use lie_runtime::SquareMatrix;
use lie_runtime::diagnostics::{AnyMethod, Forgotten};
use lie_runtime::driver::{Chart, Options, Problem, Reconstruction, Save, solve_observed};
use lie_runtime::methods::StepFailure;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;
use lie_runtime::structure::MatrixGroup;

/// Steps of a run, and where in between a row is.
const STEPS: f64 = 8.0;
const BETWEEN: f64 = 2.3;
/// How much smaller the measured order may be.
const SLACK: f64 = 0.7;
/// An error that is below this needs no order.
const NEGLIGIBLE: f64 = 1e-10;

type Rows = Vec<Vec<f64>>;

/// The check of a system with matrices; whether the element only goes along with the steps of the method.
pub type GroupCheck<P> = fn(&P, &Ground<P>, &dyn AnyMethod<f64, P>, bool) -> Finding;

/// The finding on one method.
pub(super) fn finding<P>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    beside: bool,
) -> Finding
where
    P: Lift<f64> + MatrixGroup<f64> + Clone,
{
    if system.is_forced() {
        return Finding::absent("group", "forces change the momentum in space");
    }
    if has_cocycle(system) {
        return Finding::absent("group", "a cocycle changes the momentum in space");
    }
    let claims = method.claims();
    let exact = claims.preserves.on(system).orbit && !beside;
    let order = f64::from(claims.order);
    let round_off = 4.0 * PER_STEP * STEPS * f64::EPSILON;
    let measured = smaller_steps(ground.step, |h| {
        let (coarse, moves) = run(system, ground, method, h, STEPS)?;
        if exact || !moves || coarse < NEGLIGIBLE {
            return Ok((coarse, f64::INFINITY, moves));
        }
        let (fine, _) = run(system, ground, method, 0.25 * h, 4.0 * STEPS)?;
        // what comes to round-off at once has an order that cannot be told
        let slope = match fine <= 4.0 * round_off {
            true => f64::INFINITY,
            false => (coarse / fine).ln() / 4.0_f64.ln(),
        };
        Ok((coarse, slope, moves))
    });
    match measured {
        Ok(((_, _, false), _)) => Finding::absent("group", "no motion on the group"),
        Ok(((error, _, true), _)) if exact => Finding::zero("group", true, error, round_off),
        Ok(((error, slope, true), _)) => {
            let note = format!("momentum in space to {error:.1e}");
            Finding::at_least("group", true, slope, order, order - SLACK).note(note)
        }
        Err(failure) => Finding::unmeasured("group", true, &failure),
    }
}

/// Whether brackets of coordinates that do not carry the time are constants, beside others.
fn has_cocycle<P: Poisson<f64>>(system: &P) -> bool {
    let Some(clock) = system.clock() else {
        return false;
    };
    let mut origin = system.zero_state();
    origin.as_mut_slice()[clock.time + 1] = 1.0;
    let mut matrix = system.zero_jacobian();
    system.poisson_matrix(&origin, &mut matrix);
    let own: Vec<usize> = (0..system.dimension())
        .filter(|&k| !clock.holds(k))
        .collect();
    let mut pairs = own.iter().flat_map(|&i| own.iter().map(move |&j| (i, j)));
    pairs.any(|(i, j)| matrix.get(i, j) != 0.0)
}

/// The largest error of the momentum in space over the rows, relative to what the element can make of round-off, and
/// whether there was a motion at all. It is infinite where rows off the grid change the others or the charts disagree.
fn run<P>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
    steps: f64,
) -> Result<(f64, bool), StepFailure>
where
    P: Lift<f64> + MatrixGroup<f64> + Clone,
{
    let mut worst = 0.0_f64;
    let mut moves = false;
    for mu in &ground.states[..ground.states.len().min(2)] {
        let times = |off: bool| {
            let mut times = vec![2.0 * h, 5.0 * h, steps * h];
            if off {
                times.push(BETWEEN * h);
            }
            times
        };
        let run = |chart, off| trajectory(system, mu, method, h, chart, times(off));
        let (elements, states) = run(Chart::Matrix, true)?;
        let (without, _) = run(Chart::Matrix, false)?;
        // rows at 2, 2.3, 5, 8 and 2, 5, 8
        if elements.first() != without.first() || elements[2..] != without[1..] {
            return Ok((f64::INFINITY, true));
        }
        moves |= method_moves(system, method, h, mu);
        for (element, state) in elements.iter().zip(&states) {
            worst = f64::max(worst, defect(system, element, state, mu.as_slice()));
            if worst.is_nan() {
                return Ok((f64::NAN, moves));
            }
        }
        if system.group().size == 3 && system.group().orthogonal {
            let (turns, _) = run(Chart::Quaternion, true)?;
            for (turn, element) in turns.iter().zip(&elements) {
                let pairs = rotation(turn).into_iter().zip(element);
                let gaps: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
                if largest(&gaps) > 16.0 * steps * PER_STEP * f64::EPSILON {
                    return Ok((f64::INFINITY, true));
                }
            }
        }
    }
    Ok((worst, moves))
}

/// Whether a step shows any motion.
fn method_moves<P: Lift<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
    mu: &P::State,
) -> bool {
    let mut motions = lie_runtime::diagnostics::Motions::new();
    let newton = lie_runtime::newton::NewtonOptions::default();
    let mut state = mu.clone();
    let mut stepper = method.any_stepper(system, h, &newton);
    stepper.step_with_motions(&mut state, &mut motions).is_ok() && !motions.is_empty()
}

/// Group elements and states at some times.
fn trajectory<P>(
    system: &P,
    mu: &P::State,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
    chart: Chart,
    mut times: Vec<f64>,
) -> Result<(Rows, Rows), StepFailure>
where
    P: Lift<f64> + MatrixGroup<f64> + Clone,
{
    times.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let end = times.last().copied().unwrap_or(h);
    let problem = Problem {
        system: system.clone(),
        mu0: mu.clone(),
        span: (0.0, end),
    };
    let mut group = Reconstruction::new(system, chart);
    let options = Options::new(h).save(Save::At(times));
    match solve_observed(&problem, Forgotten(method), &options, &mut group) {
        Ok(solution) => {
            let states = solution.mu.iter().map(|mu| mu.as_slice().to_vec());
            Ok((group.rows().to_vec(), states.collect()))
        }
        Err(lie_runtime::driver::SolveError::Step { error, .. }) => Err(error.failure),
        Err(_) => Ok((Vec::new(), Vec::new())),
    }
}

/// `|Ad*_(g^-1) mu - mu0|` relative to the sizes that round-off has in it. Of a right-invariant system g^-1 is the element
/// that moves as `G' = G xi`.
fn defect<P: MatrixGroup<f64>>(system: &P, element: &[f64], mu: &[f64], start: &[f64]) -> f64 {
    let group = system.group();
    let size = group.size;
    let Some(other) = inverse(element, size) else {
        return f64::NAN;
    };
    let (g, back) = if group.right {
        (other.as_slice(), element)
    } else {
        (element, other.as_slice())
    };
    let dense = |index: usize| {
        let mut matrix = vec![0.0; size * size];
        for entry in group.matrices[index] {
            let (row, column) = entry.place();
            matrix[row * size + column] += entry.high + entry.low;
        }
        matrix
    };
    // what carries the time has no matrix
    let moving: Vec<usize> = (0..system.dimension())
        .filter(|&k| !group.matrices[k].is_empty())
        .collect();
    let basis: Vec<Vec<f64>> = moving.iter().map(|&k| dense(k)).collect();
    let span = Basis::from_span(&basis);
    if span.rank() < basis.len() {
        return f64::NAN;
    }
    let (mut worst, mut scale) = (0.0_f64, largest(start));
    for (matrix, &index) in basis.iter().zip(&moving) {
        // Ad_(g^-1) e_i = sum_k a_k e_k, and <Ad*_(g^-1) mu, e_i> = sum_k a_k mu_k
        let moved = times(&times(back, matrix, size), g, size);
        let coordinates = span.solve(&moved, basis.len());
        let pairs = coordinates.iter().zip(&moving);
        let (sum, terms) = pairs.fold((0.0, 0.0), |(sum, terms), (a, &k)| {
            (sum + a * mu[k], terms + (a * mu[k]).abs())
        });
        worst = f64::max(worst, (sum - start[index]).abs());
        scale = f64::max(scale, terms);
    }
    worst / (scale * largest(g).max(1.0) * largest(back).max(1.0))
}

fn times(a: &[f64], b: &[f64], size: usize) -> Vec<f64> {
    let entry = |place: usize| {
        let (row, column) = (place / size, place % size);
        (0..size)
            .map(|k| a[row * size + k] * b[k * size + column])
            .sum()
    };
    (0..size * size).map(entry).collect()
}

fn inverse(matrix: &[f64], size: usize) -> Option<Vec<f64>> {
    let columns: Vec<Vec<f64>> = (0..size)
        .map(|c| (0..size).map(|r| matrix[r * size + c]).collect())
        .collect();
    let span = Basis::from_span(&columns);
    if span.rank() < size {
        return None;
    }
    let mut inverse = vec![0.0; size * size];
    for column in 0..size {
        let unit: Vec<f64> = (0..size).map(|r| f64::from(r == column)).collect();
        for (row, value) in span.solve(&unit, size).into_iter().enumerate() {
            inverse[row * size + column] = value;
        }
    }
    Some(inverse)
}

/// The matrix of a unit quaternion, the real part first.
fn rotation(q: &[f64]) -> [f64; 9] {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    [
        w * w + x * x - y * y - z * z,
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        w * w - x * x + y * y - z * z,
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        w * w - x * x - y * y + z * z,
    ]
}
