//! Equations of implicit methods, generated against generic ones.

use lie_runtime::generic;
use lie_runtime::{
    CayleyEquations, Equation, GaussEquations, LieMidpointEquations, MidpointEquations, State,
    Unknown,
};

use crate::errors::{Errors, entries, unknown_entries};
use crate::systems::Random;

/// An equation against its generic form: start, residual, Jacobian, correction, result.
pub fn equation<F, G>(
    name: &str,
    fused: &mut F,
    reference: &mut G,
    mu: &F::State,
    random: &mut Random,
    errors: &mut Errors,
) where
    F: Equation<f64>,
    G: Equation<f64, State = F::State, Unknown = F::Unknown>,
{
    fused.set_base(mu);
    let mut base = mu.clone();
    base.as_mut_slice()
        .iter_mut()
        .for_each(|x| *x *= 1.0 + errors.nudge);
    reference.set_base(&base);
    let (mut unknown, mut start) = (fused.zero_unknown(), fused.zero_unknown());
    fused.initial_guess(&mut start);
    reference.initial_guess(&mut unknown);
    errors.compare(
        &format!("{name}, initial_guess"),
        &unknown_entries(&start),
        &unknown_entries(&unknown),
    );
    // off the solution, as in the first iterations
    for index in 0..unknown.len() {
        unknown.set_entry(index, unknown.entry(index) + 0.05 * random.number());
    }
    let mut other = unknown.clone();
    for index in 0..unknown.len() {
        other.set_entry(index, unknown.entry(index) * (1.0 + errors.nudge));
    }
    let mut residuals = [fused.zero_unknown(), fused.zero_unknown()];
    fused.residual(&unknown, &mut residuals[0]);
    reference.residual(&other, &mut residuals[1]);
    let [left, right] = residuals.each_ref().map(unknown_entries);
    errors.compare(&format!("{name}, residual"), &left, &right);
    let (mut left, mut right) = (fused.zero_matrix(), reference.zero_matrix());
    fused.linearize(&unknown, &mut residuals[0], &mut left);
    errors.compare(
        &format!("{name}, residual of linearize"),
        &unknown_entries(&residuals[0]),
        &unknown_entries(&residuals[1]),
    );
    reference.linearize(&other, &mut residuals[1], &mut right);
    errors.compare(
        &format!("{name}, Jacobian"),
        &entries(&left),
        &entries(&right),
    );
    assert!(
        fused.factor(&mut left) && reference.factor(&mut right),
        "{name}: the pivots are near 1"
    );
    fused.solve(&left, &mut residuals[0]);
    reference.solve(&right, &mut residuals[1]);
    let [left, right] = residuals.each_ref().map(unknown_entries);
    errors.compare(&format!("{name}, correction"), &left, &right);
    let (mut end, mut expected) = (mu.clone(), mu.clone());
    fused.result(&unknown, &mut end);
    reference.result(&other, &mut expected);
    errors.compare(
        &format!("{name}, result"),
        end.as_slice(),
        expected.as_slice(),
    );
}

/// The equations that every Lie–Poisson system has.
pub fn equations<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: MidpointEquations<f64>
        + GaussEquations<f64, 1>
        + GaussEquations<f64, 2>
        + GaussEquations<f64, 3>
        + LieMidpointEquations<f64>,
{
    let left = &mut fused.midpoint_equation(h);
    equation(
        "midpoint",
        left,
        &mut generic::Midpoint::new(reference, h),
        mu,
        random,
        errors,
    );
    let left = &mut GaussEquations::<f64, 1>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 1>::new(reference, h);
    equation("gauss2", left, right, mu, random, errors);
    let left = &mut GaussEquations::<f64, 2>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 2>::new(reference, h);
    equation("gauss4", left, right, mu, random, errors);
    let left = &mut GaussEquations::<f64, 3>::gauss_equation(fused, h);
    let right = &mut generic::Gauss::<_, _, 3>::new(reference, h);
    equation("gauss6", left, right, mu, random, errors);
    let left = &mut fused.exp_equation(h);
    equation(
        "exp",
        left,
        &mut generic::ExpMidpoint::new(reference, h),
        mu,
        random,
        errors,
    );
}

pub fn cayley_equation<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: CayleyEquations<f64>,
{
    let left = &mut fused.cayley_equation(h);
    equation(
        "cayley",
        left,
        &mut generic::CayleyMidpoint::new(reference, h),
        mu,
        random,
        errors,
    );
}
