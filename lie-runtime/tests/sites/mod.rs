//! What tests of families share.

use lie_runtime::methods::Method;
use lie_runtime::prelude::*;

/// The state of a family from that of a direct sum, site after site.
pub fn by_component(sites: &[f64], n: usize) -> Vec<f64> {
    let count = sites.len() / n;
    (0..sites.len())
        .map(|place| sites[place % count * n + place / count])
        .collect()
}

pub fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let differences = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, Scalar::max)
}

/// The end of a run of so many steps.
pub fn end<P, M>(system: &P, method: M, mu: &[f64], h: f64, steps: u32) -> Vec<f64>
where
    P: Poisson<f64, State = Vec<f64>>,
    M: Method<f64, P>,
{
    let mut mu = mu.to_vec();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}
