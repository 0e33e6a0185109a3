//! Derivatives of functions of several numbers.

use crate::linear::Rows;
use crate::number::Number;

/// The outermost direction in which one of them varies, 0 for none.
pub(super) fn directions(numbers: &[Number]) -> usize {
    let directions = numbers.iter().map(Number::direction);
    directions.max().unwrap_or(0)
}

/// Numbers of which one, where there is such a place, is the variable of a direction that is new to them.
pub(super) fn vary(numbers: &[Number], place: usize, direction: usize) -> Vec<Number> {
    let mut varied = numbers.to_vec();
    if let Some(number) = varied.get_mut(place) {
        *number = number.variable(direction);
    }
    varied
}

/// The gradient of a function that sees its arguments and constants alone.
pub(super) fn gradient(at: &[Number], of: impl Fn(&[Number]) -> Number) -> Vec<Number> {
    let direction = directions(at) + 1;
    let slope = |place| of(&vary(at, place, direction)).slope(direction);
    (0..at.len()).map(slope).collect()
}

/// First and second derivatives of a function; `beside` is the outermost direction of other numbers that it sees.
#[expect(
    clippy::needless_range_loop,
    reason = "a matrix is filled on both sides of its diagonal"
)]
pub(super) fn derivatives(
    at: &[Number],
    beside: usize,
    of: impl Fn(&[Number]) -> Number,
) -> (Vec<Number>, Rows) {
    let n = at.len();
    let inner = directions(at).max(beside) + 1;
    let outer = inner + 1;
    let mut slope = Vec::new();
    let mut second = vec![vec![Number::integer(0); n]; n];
    for i in 0..n {
        let first = vary(at, i, inner);
        for j in i..n {
            let value = of(&vary(&first, j, outer));
            if j == i {
                slope.push(value.at(outer).slope(inner));
            }
            second[i][j] = value.slope(outer).slope(inner);
            second[j][i] = second[i][j].clone();
        }
    }
    (slope, second)
}
