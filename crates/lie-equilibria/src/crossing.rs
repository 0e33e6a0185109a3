//! Where a smooth function along a step of a branch is zero, from values on both sides of it.
//!
//! Where an eigenvalue passes zero other branches may cross, and Newton's iteration has a singular matrix: nothing can be computed close to
//! the change itself. The function and the points of the branch are smooth through it, so that polynomials through Chebyshev's nodes of the
//! whole step tell them there to round-off. The error is what the result moves by if one of the nodes is left out.

use std::f64::consts::PI;

use crate::dense::add;

/// Nodes of a step.
const NODES: usize = 9;
/// So many of them must be points.
const LEAST: usize = 6;

/// No parameter is known better, relative to its size: what the functions are computed from is rounded.
pub const LAST_DIGITS: f64 = 8.0 * f64::EPSILON;

/// A point of a step.
pub struct Node {
    /// Where along the step.
    pub place: f64,
    /// The function.
    pub value: f64,
    /// The point, of which the last entry is the parameter.
    pub u: Vec<f64>,
}

/// The places of the nodes of a step.
pub fn places(length: f64) -> impl Iterator<Item = f64> {
    let angle = |k: usize| PI * (2 * k + 1) as f64 / (2 * NODES) as f64;
    (0..NODES).map(move |k| 0.5 * length * (1.0 - angle(k).cos()))
}

/// The point in which the function is zero, and by how much its parameter is known; `None` where the nodes tell no zero.
pub fn zero(nodes: &[Node], length: f64) -> Option<(Vec<f64>, f64)> {
    if nodes.len() < LEAST {
        return None;
    }
    let all: Vec<&Node> = nodes.iter().collect();
    let found = point(&all, length)?;
    let parameter = found.last().copied()?;
    let mut error = LAST_DIGITS * parameter.abs();
    for left_out in 0..nodes.len() {
        let mut rest = all.clone();
        rest.remove(left_out);
        error = error.max(2.0 * (point(&rest, length)?.last()? - parameter).abs());
    }
    Some((found, error))
}

fn point(nodes: &[&Node], length: f64) -> Option<Vec<f64>> {
    let value = |place: f64| {
        let weights = weights(nodes, place);
        let terms = weights.iter().zip(nodes);
        terms.map(|(weight, node)| weight * node.value).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, length);
    let first = value(low);
    if first * value(high) >= 0.0 {
        return None;
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        match value(middle) * first > 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    let mut u = vec![0.0; nodes[0].u.len()];
    for (weight, node) in weights(nodes, low).iter().zip(nodes) {
        add(&mut u, *weight, &node.u);
    }
    Some(u)
}

/// Lagrange's polynomials of the nodes at a place.
fn weights(nodes: &[&Node], place: f64) -> Vec<f64> {
    let of = |own: usize| {
        let others = (0..nodes.len()).filter(|other| *other != own);
        others.fold(1.0, |product, other| {
            let [a, b] = [nodes[own].place, nodes[other].place];
            product * (place - b) / (a - b)
        })
    };
    (0..nodes.len()).map(of).collect()
}
