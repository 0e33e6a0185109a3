//! What quadratic invariants change by, beyond the rounding of their own evaluation.

/// What the squared entries of a state with these weights sum to beyond what those of another do, without rounding on the
/// way.
pub fn change(weights: [f64; 3], state: &[f64], start: &[f64]) -> f64 {
    let (mut high, mut low) = (0.0, 0.0);
    let terms = weights.iter().zip(state).map(|(w, &x)| (w, x, x));
    for (w, x, y) in terms.chain(weights.iter().zip(start).map(|(w, &x)| (w, x, -x))) {
        let square = x * y;
        let term = w * square;
        low += w.mul_add(square, -term) + w * x.mul_add(y, -square);
        let sum: f64 = high + term;
        let other = sum - high;
        low += (high - (sum - other)) + (term - other);
        high = sum;
    }
    high + low
}
