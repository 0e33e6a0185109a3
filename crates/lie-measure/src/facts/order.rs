//! The order, as the slope of the error over the step.

use super::findings::Finding;
use super::ground::{Exact, Ground};
use super::{Made, Subject};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::driver::Stats;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Lift;
use lie_runtime::scalar::Scalar;
use lie_runtime::state::State;

/// Numbers of steps over the span, by factors of about the fourth root of 2.
const STEPS: [u64; 31] = [
    3, 4, 5, 6, 7, 8, 10, 11, 13, 16, 19, 23, 27, 32, 38, 45, 54, 64, 76, 91, 108, 128, 152, 181,
    215, 256, 304, 362, 431, 512, 609,
];
/// Points of the slope: a factor of 4 in the step.
const POINTS: usize = 9;
/// As few may do, where the next step is at round-off already.
const LEAST: usize = 4;
/// An error that is below this at the largest steps is at round-off before an order shows.
const NEGLIGIBLE: f64 = 1e-9;
/// Within this multiple of the error of the reference, of what round-off at the start changes, and of a few units of round-off an
/// error counts for no slope.
const NOISE: f64 = 100.0;
/// How much smaller than the order a slope may be at the end of the ladder.
const SLACK: f64 = 0.3;
/// The same as a part of the order, up to order 8, to order 12 and beyond. Methods of high order have few steps between
/// failure and round-off, and at most of these they have not reached their order: Gauss collocation of order 16 measures
/// 14.7 on the heavy top and 12.8 on the non-polynomial spin, between errors of 1e-6 and 1e-13.
const RELATIVE_SLACK: [f64; 3] = [0.05, 0.1, 0.25];
/// A slope that is too small by less than so many of its standard errors tells nothing.
const CERTAIN: f64 = 2.0;

pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> Finding {
    let adaptive = subject.with_tolerance.as_deref();
    measured(system, ground, &*subject.method, adaptive)
}

/// Of a method with steps of a fixed size.
pub(super) fn finding_of<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
) -> Finding {
    measured(system, ground, method, None)
}

fn measured<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    adaptive: Option<&dyn Fn(f64) -> Made<f64, P>>,
) -> Finding {
    let order = method.claims().order;
    // across a joint of H no method has more
    let order = ground.reach.map_or(order, |reach| reach.min(order));
    let claim = f64::from(order);
    let relative = RELATIVE_SLACK[usize::from(order > 8) + usize::from(order > 12)] * claim;
    let bound = claim - SLACK.max(relative);
    let (mut exact_everywhere, mut arrives) = (true, false);
    let mut largest = f64::NAN;
    let mut best: Vec<(f64, f64)> = Vec::new();
    for exact in &ground.exact {
        let floor = NOISE * exact.error.max(f64::EPSILON);
        let measured = match adaptive {
            Some(make) => by_tolerance(system, exact, make, floor),
            None => by_step(system, ground, exact, method, floor),
        };
        let mut above: Vec<(f64, f64)> = measured.iter().filter(|p| p.1 > floor).copied().collect();
        // the smallest steps end where the solution does
        arrives |= measured.last().is_some_and(|last| last.1 <= floor);
        if adaptive.is_none() && slope(tail(&above, order)) < bound {
            // a method may amplify round-off, as differences divided by small increments do
            above.retain(|&(h, error)| error > NOISE * noise(system, exact, method, h));
        }
        exact_everywhere &= measured.len() >= 3 && above.is_empty();
        if above.len() > best.len() || largest.is_nan() {
            let errors = measured.iter().map(|(_, error)| *error);
            largest = errors.fold(f64::NAN, f64::max);
            best = above;
        }
        if best.len() >= LEAST {
            break;
        }
    }
    if exact_everywhere {
        return Finding::at_least("order", true, f64::INFINITY, claim, bound)
            .note("exact to round-off".to_owned());
    }
    if is_short(&best) && largest < NEGLIGIBLE {
        return Finding::at_least("order", true, f64::INFINITY, claim, bound).note(format!(
            "at round-off from the largest step on, {largest:.1e}"
        ));
    }
    if best.len() < LEAST {
        let finding = match arrives {
            true => Finding::not_measurable("order", claim, bound),
            false => Finding::at_least("order", true, f64::NAN, claim, bound),
        };
        return finding.note("too few steps between failure and round-off".to_owned());
    }
    let last = tail(&best, order);
    let note = format!("errors {:.1e} to {:.1e}", last[0].1, last[last.len() - 1].1);
    let found = slope(last);
    if found < bound && arrives && adaptive.is_none() {
        let scatter = scatter(last);
        if is_rising(last) || found + CERTAIN * scatter > bound {
            return Finding::not_measurable("order", claim, bound).note(format!(
                "slope {found:.1} ± {scatter:.1} where round-off begins, {note}"
            ));
        }
    }
    Finding::at_least("order", true, found, claim, bound)
        .at_step(last[0].0)
        .note(note)
}

/// The standard error of the slope by least squares.
fn scatter(points: &[(f64, f64)]) -> f64 {
    let slope = least_squares(points);
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0.ln()), mean(|p| p.1.ln()));
    let (left, spread) = points.iter().fold((0.0, 0.0), |(left, spread), p| {
        let dx = p.0.ln() - x;
        let residual = p.1.ln() - y - slope * dx;
        (left + residual * residual, spread + dx * dx)
    });
    (left / (count - 2.0) / spread).sqrt()
}

/// Whether the smaller steps of some have a larger slope: they have not reached the order, which a fault would lower there.
fn is_rising(points: &[(f64, f64)]) -> bool {
    let half = points.len() / 2;
    let (coarse, fine) = (&points[..points.len() - half], &points[half..]);
    half >= 2 && slope(fine) > slope(coarse) + SLACK
}

/// The points of the slope: those of the smallest steps.
fn tail(points: &[(f64, f64)], order: u32) -> &[(f64, f64)] {
    let count = if is_dense(order) {
        2 * POINTS - 1
    } else {
        POINTS
    };
    &points[points.len().saturating_sub(count)..]
}

/// How much the end of a run moves when its start moves by a few units of round-off, relative to the state.
fn noise<P: Lift<f64>>(
    system: &P,
    exact: &Exact<P::State>,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
) -> f64 {
    let steps = (exact.span / h).abs().round() as u64;
    let step = exact.span / steps as f64;
    let newton = NewtonOptions::default();
    let mut largest = 0.0_f64;
    for mu in &exact.starts {
        let end = |nudge: f64| {
            let mut state = mu.clone();
            for entry in state.as_mut_slice() {
                *entry *= 1.0 + nudge * f64::EPSILON;
            }
            let mut stepper = method.any_stepper(system, step, &newton);
            stepper.advance(&mut state, steps).ok().map(|_| state)
        };
        if let [Some(here), Some(there)] = [end(0.0), end(4.0)] {
            largest = largest.max(relative_error(&there, &here));
        }
    }
    largest
}

/// Whether the points lie too near each other for a slope that round-off does not spoil: within three factors of the fourth
/// root of 2.
fn is_short(points: &[(f64, f64)]) -> bool {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return true;
    };
    points.len() < LEAST || first.0 < 1.65 * last.0
}

/// Whether the numbers of steps go by factors of about the eighth root of 2.
fn is_dense(order: u32) -> bool {
    order > 8
}

/// Numbers of steps over the span. Beyond order 8 those between come too: there are few steps between the largest that is
/// solved and round-off.
fn ladder(order: u32) -> Vec<u64> {
    let mut steps = STEPS.to_vec();
    if is_dense(order) {
        let pairs = STEPS.iter().zip(&STEPS[1..]);
        steps.extend(pairs.map(|(few, many)| ((few * many) as f64).sqrt().round() as u64));
        steps.sort_unstable();
        steps.dedup();
    }
    steps
}

/// Errors over steps of a fixed size, the largest over the states, and the size of round-off in them.
fn by_step<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    exact: &Exact<P::State>,
    method: &dyn AnyMethod<f64, P>,
    floor: f64,
) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    let mut below = 0;
    for steps in ladder(
        ground
            .reach
            .map_or(u32::MAX, |reach| reach)
            .min(method.claims().order),
    ) {
        let h = exact.span / steps as f64;
        if let Some((error, _)) = error(system, exact, method, h, steps) {
            points.push((h.abs(), error));
            below += u32::from(error <= floor);
        }
        if below == 2 {
            break;
        }
    }
    points
}

/// Errors of an adaptive method over the mean of its own steps.
fn by_tolerance<P: Lift<f64>>(
    system: &P,
    exact: &Exact<P::State>,
    make: &dyn Fn(f64) -> Made<f64, P>,
    floor: f64,
) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for k in 0..24 {
        let tolerance = 10_f64.powf(-3.0 - 0.5 * f64::from(k));
        // one step of the grid: the span
        let Some((error, stats)) = error(system, exact, &*make(tolerance), exact.span, 1) else {
            continue;
        };
        let mean = exact.span.abs() * exact.starts.len() as f64 / stats.accepted as f64;
        if points.last().is_none_or(|last| mean < 0.9 * last.0) {
            points.push((mean, error));
        }
        if error <= floor {
            break;
        }
    }
    points
}

/// The largest error at the end of the span relative to the state, and the work of all runs.
fn error<P: Lift<f64>>(
    system: &P,
    exact: &Exact<P::State>,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
    steps: u64,
) -> Option<(f64, Stats)> {
    let newton = NewtonOptions::default();
    let mut largest = 0.0_f64;
    let mut sum = Stats::default();
    for (mu, end) in exact.starts.iter().zip(&exact.ends) {
        let mut state = mu.clone();
        let stats = method
            .any_stepper(system, h, &newton)
            .advance(&mut state, steps)
            .ok()?;
        sum.accepted += stats.accepted;
        let error = relative_error(&state, end);
        if !error.is_finite() {
            return None;
        }
        largest = largest.max(error);
    }
    Some((largest, sum))
}

/// The largest difference of a component over the largest component.
pub(crate) fn relative_error<V: State<f64>>(state: &V, exact: &V) -> f64 {
    let pairs = state.as_slice().iter().zip(exact.as_slice());
    let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, Scalar::max);
    if largest == 0.0 {
        return 0.0;
    }
    largest / exact.max_norm()
}

/// The slope of the logarithms: by least squares, or the median of the slopes of all pairs, which a few points
/// where errors cancel or round-off begins do not pull down (Sen 1968, doi:10.1080/01621459.1968.10480934).
fn slope(points: &[(f64, f64)]) -> f64 {
    f64::max(least_squares(points), median_slope(points))
}

fn median_slope(points: &[(f64, f64)]) -> f64 {
    let pairs = points.iter().enumerate();
    let mut slopes: Vec<f64> = pairs
        .flat_map(|(k, a)| {
            points[k + 1..]
                .iter()
                .map(move |b| (a.1 / b.1).ln() / (a.0 / b.0).ln())
        })
        .collect();
    slopes.sort_by(f64::total_cmp);
    slopes.get(slopes.len() / 2).copied().unwrap_or(f64::NAN)
}

fn least_squares(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let x = points.iter().map(|p| p.0.ln()).sum::<f64>() / count;
    let y = points.iter().map(|p| p.1.ln()).sum::<f64>() / count;
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| {
        let dx = p.0.ln() - x;
        (xy + dx * (p.1.ln() - y), xx + dx * dx)
    });
    xy / xx
}
