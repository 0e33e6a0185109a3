//! Which methods no other is better than.

use super::Curve;

/// The error below which a method is measured against others.
const SERIOUS: f64 = 1e-2;

/// Which curves have a point that no other curve beats in both; the floor is no number where errors need no reference.
pub(super) fn front(curves: &[&Curve], floor: f64) -> Vec<bool> {
    let on_front = |curve: &Curve| {
        // errors of the size of the solution are no contest, nor are those that nobody knows
        let serious = curve
            .points
            .iter()
            .filter(|point| point.1 < SERIOUS && (floor.is_nan() || point.1 > floor));
        serious.into_iter().any(|&(seconds, error)| {
            let others = curves.iter().filter(|other| other.name != curve.name);
            let beaten = others
                .flat_map(|other| segments(&other.points))
                .any(|(from, to)| beats(from, to, seconds, error));
            !beaten
        })
    };
    curves.iter().map(|curve| on_front(curve)).collect()
}

/// The points that none beats, whatever their class; controls do not count.
pub(super) fn fastest(curves: &[Curve]) -> Vec<(f64, f64)> {
    let all = curves.iter().filter(|curve| !curve.control);
    let mut points: Vec<(f64, f64)> = all.flat_map(|curve| curve.points.iter().copied()).collect();
    points.retain(|point| point.1 < SERIOUS);
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|point| {
        let better = point.1 < least;
        least = least.min(point.1);
        better
    });
    points
}

fn segments(points: &[(f64, f64)]) -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
    points.iter().enumerate().map(|(index, &point)| {
        let next = points.get(index + 1).copied().unwrap_or(point);
        (point, next)
    })
}

/// Whether a segment passes below and left of a point.
fn beats(from: (f64, f64), to: (f64, f64), seconds: f64, error: f64) -> bool {
    let better = |p: (f64, f64)| p.0 < seconds && p.1 < error;
    if better(from) || better(to) {
        return true;
    }
    if from.0 >= seconds || to.0 <= seconds {
        return false;
    }
    let part = (seconds / from.0).ln() / (to.0 / from.0).ln();
    let there = from.1.ln() + part * (to.1 / from.1).ln();
    there < error.ln() - 1e-9
}
