//! The order of convergence as a slope.

/// A fitted order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The slope of log error over log step.
    pub slope: f64,
    /// How many of the points were used; the rest lie on the plateau of round-off.
    pub points: usize,
}

/// Fits `error = C h^p` to measured errors by least squares in the logarithms.
///
/// The points are taken from the largest step downwards and cut off at the plateau of round-off:
/// where an error is below `floor`, or falls at less than three quarters of the rate seen before. None if fewer
/// than three points remain.
pub fn order_of_convergence(points: &[(f64, f64)], floor: f64) -> Option<Order> {
    let mut points: Vec<(f64, f64)> = points.iter().map(|&(h, e)| (h.abs(), e)).collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    let slope = |a: (f64, f64), b: (f64, f64)| (a.1 / b.1).ln() / (a.0 / b.0).ln();
    let mut used = usize::from(points.first().is_some_and(|&(_, error)| error > floor));
    let mut steepest = f64::NEG_INFINITY;
    while used > 0 && used < points.len() {
        let here = slope(points[used - 1], points[used]);
        if points[used].1.partial_cmp(&floor) != Some(core::cmp::Ordering::Greater)
            || !here.is_finite()
            || here < 0.75 * steepest
        {
            break;
        }
        steepest = steepest.max(here);
        used += 1;
    }
    if used < 3 {
        return None;
    }
    let logs = points[..used]
        .iter()
        .map(|&(h, error)| (h.ln(), error.ln()));
    let count = used as f64;
    let (x, y) = logs
        .clone()
        .fold((0.0, 0.0), |sum, log| (sum.0 + log.0, sum.1 + log.1));
    let (x, y) = (x / count, y / count);
    let (xy, xx) = logs.fold((0.0, 0.0), |sum, log| {
        (
            sum.0 + (log.0 - x) * (log.1 - y),
            sum.1 + (log.0 - x) * (log.0 - x),
        )
    });
    Some(Order {
        slope: xy / xx,
        points: used,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plateau_does_not_count() {
        let points: Vec<(f64, f64)> = (0..8)
            .map(|k| 0.5_f64.powi(k))
            .map(|h| (h, 1e-3 * h.powi(4) + 1e-11))
            .collect();
        let order = order_of_convergence(&points, 0.0).unwrap();
        assert!((order.slope - 4.0).abs() < 0.03, "{order:?}");
        assert!(order.points < 8);
        let order = order_of_convergence(&points, 1e-7).unwrap();
        assert!((order.slope - 4.0).abs() < 1e-3, "{order:?}");
    }

    #[test]
    fn too_few_points_give_no_order() {
        assert_eq!(
            order_of_convergence(&[(0.1, 1e-3), (0.05, 1e-4)], 0.0),
            None
        );
        assert_eq!(
            order_of_convergence(&[(0.1, 1e-3), (0.05, f64::NAN), (0.02, 1e-6)], 0.0),
            None
        );
        assert_eq!(order_of_convergence(&[], 0.0), None);
    }
}
