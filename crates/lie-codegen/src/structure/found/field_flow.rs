//! Flows of fields in closed form: where the Taylor series ends, and where what is not straight is an integral along straight lines.

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Nodes and weights of Gauss's quadrature over [0, 1], up to the reflection of the nodes.
const NODES: [(f64, f64); 4] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
];
/// Longer series are not looked at, nor such with more nodes.
const MOST_POWERS: usize = 8;
const MOST_NODES: usize = 4000;
/// What a field adds over a time t: `sum_(m > 0) t^m/m! D^m x`, D the derivative along it; none where that does not end.
pub(super) fn series(graph: &mut Graph, field: &[ExprId]) -> Option<Vec<ExprId>> {
    let time = graph.symbol(Symbol::Time);
    let mut increments = Vec::with_capacity(field.len());
    for speed in field {
        let (mut term, mut terms) = (graph.normal(*speed), Vec::new());
        let mut factor = Rational::ONE;
        while !graph.is_zero(term) {
            if terms.len() == MOST_POWERS || graph.dependencies(&[term]).len() > MOST_NODES {
                return None;
            }
            let power = 1 + terms.len() as i64;
            factor = &factor * &Rational::new(1, power)?;
            let times = graph.pow(time, &Rational::from(power));
            let scaled = graph.scale(term, &factor);
            terms.push(graph.mul(times, scaled));
            let mut next = Vec::new();
            for (k, speed) in field.iter().enumerate() {
                let slope = graph.derivative(term, Symbol::Coordinate(k));
                next.push(graph.mul(slope, *speed));
            }
            let next = graph.sum(&next);
            term = graph.normal(next);
        }
        increments.push(graph.sum(&terms));
    }
    Some(increments)
}

/// The same where some coordinates move along straight lines, and the others by what depends on these alone.
pub(super) fn quadrature(graph: &mut Graph, field: &[ExprId]) -> Option<Vec<ExprId>> {
    let moves = |graph: &Graph, k: usize| !graph.is_zero(field[k]);
    let straight = |graph: &Graph, k: usize| {
        let mut on = graph.coordinates(field[k]).into_iter();
        on.all(|i| !moves(graph, i))
    };
    let time = graph.symbol(Symbol::Time);
    let mut increments = Vec::with_capacity(field.len());
    for (k, speed) in field.iter().enumerate() {
        if straight(graph, k) {
            increments.push(graph.mul(time, *speed));
            continue;
        }
        let on = graph.coordinates(*speed);
        if !on.iter().all(|i| straight(graph, *i)) {
            return None;
        }
        let mut terms = Vec::new();
        for (node, weight) in NODES {
            for node in [node, 1.0 - node] {
                let part = graph.number(Rational::from_f64(node)?);
                let mut points = Vec::new();
                for &i in &on {
                    let x = graph.symbol(Symbol::Coordinate(i));
                    let moved = graph.product(&[part, time, field[i]]);
                    points.push((Symbol::Coordinate(i), graph.add(x, moved)));
                }
                let there = graph.substitute(&[*speed], &|symbol| {
                    let point = points.iter().find(|(moved, _)| *moved == symbol);
                    point.map(|(_, point)| *point)
                })[0];
                terms.push((there, Rational::from_f64(weight)?));
            }
        }
        let mean = graph.linear(&terms);
        increments.push(graph.mul(time, mean));
    }
    Some(increments)
}
