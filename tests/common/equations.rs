//! Equations of implicit methods, generated against generic ones.

use lie_runtime::methods::{Cayley, Exp, Gauss4, Gauss6, ImplicitMidpoint, LieMidpoint};
use lie_runtime::{CayleyPoisson, Equation, Implicit, LiePoisson, Scalar, State, Unknown, generic};

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
    G: Equation<f64, State = F::State>,
{
    fused.set_base(mu);
    let mut base = mu.clone();
    base.as_mut_slice()
        .iter_mut()
        .for_each(|x| *x *= 1.0 + errors.nudge);
    reference.set_base(&base);
    let (mut unknown, mut other) = (fused.zero_unknown(), reference.zero_unknown());
    fused.initial_guess(&mut unknown);
    reference.initial_guess(&mut other);
    errors.compare(
        &format!("{name}, initial_guess"),
        &unknown_entries(&unknown),
        &unknown_entries(&other),
    );
    // off the solution, as in the first iterations
    for index in 0..unknown.len() {
        let entry = other.entry(index) + 0.05 * random.number();
        unknown.set_entry(index, entry);
        other.set_entry(index, entry * (1.0 + errors.nudge));
    }
    let (mut residual, mut expected) = (fused.zero_unknown(), reference.zero_unknown());
    let (mut left, mut right) = (fused.zero_matrix(), reference.zero_matrix());
    fused.linearize(&unknown, &mut residual, &mut left);
    let iterated = iterated(&left, unknown.len());
    // The fused equation knows the unknowns that its iteration leaves out: first those with a formula in the state, then
    // those that need the others. Their residuals in the generic one are `u - formula`, or small multiples of the step beside that
    // where few of them depend on each other.
    for _ in 0..60 {
        reference.residual(&other, &mut expected);
        for index in (0..other.len()).filter(|index| !iterated.contains(index)) {
            other.set_entry(index, other.entry(index) - expected.entry(index));
        }
    }
    let of = |entries: Vec<f64>| -> Vec<f64> { iterated.iter().map(|i| entries[*i]).collect() };
    reference.residual(&other, &mut expected);
    let expected_entries = of(unknown_entries(&expected));
    let found = of(unknown_entries(&residual));
    errors.compare(
        &format!("{name}, residual of linearize"),
        &found,
        &expected_entries,
    );
    fused.residual(&unknown, &mut residual);
    let found = of(unknown_entries(&residual));
    errors.compare(&format!("{name}, residual"), &found, &expected_entries);
    for index in (0..unknown.len()).filter(|index| !iterated.contains(index)) {
        assert_eq!(
            residual.entry(index),
            0.0,
            "{name}: what is left out never moves"
        );
    }
    reference.linearize(&other, &mut expected, &mut right);
    let block = |matrix: &[f64]| -> Vec<f64> {
        let n = unknown.len();
        let entries = iterated
            .iter()
            .flat_map(|i| iterated.iter().map(move |j| i * n + j));
        entries.map(|place| matrix[place]).collect()
    };
    errors.compare(
        &format!("{name}, Jacobian"),
        &block(&entries(&left)),
        &block(&entries(&right)),
    );
    assert!(
        fused.factor(&mut left) && reference.factor(&mut right),
        "{name}: the pivots are near 1"
    );
    fused.solve(&left, &mut residual);
    reference.solve(&right, &mut expected);
    errors.compare(
        &format!("{name}, correction"),
        &of(unknown_entries(&residual)),
        &of(unknown_entries(&expected)),
    );
    let (mut end, mut expected) = (mu.clone(), mu.clone());
    fused.result(&unknown, &mut end);
    reference.result(&other, &mut expected);
    errors.compare(
        &format!("{name}, result"),
        end.as_slice(),
        expected.as_slice(),
    );
    let factors = (
        fused.group_factor(&unknown, &mut end),
        reference.group_factor(&other, &mut expected),
    );
    assert_eq!(factors.0, factors.1, "{name}");
    if factors.0.is_some() {
        errors.compare(
            &format!("{name}, group factor"),
            end.as_slice(),
            expected.as_slice(),
        );
    }
}

/// The unknowns that the iteration finds: the others have an empty row.
fn iterated<M: lie_runtime::SquareMatrix<f64>>(matrix: &M, size: usize) -> Vec<usize> {
    let row = |i: &usize| (0..size).any(|j| matrix.get(*i, j) != 0.0);
    (0..size).filter(row).collect()
}

/// What every system has.
pub trait Implicits<S: Scalar>:
    Implicit<S, ImplicitMidpoint>
    + Implicit<S, Gauss4>
    + Implicit<S, Gauss6>
    + Implicit<S, LieMidpoint<Exp>>
    + LiePoisson<S>
{
}

impl<S: Scalar, P> Implicits<S> for P where
    P: Implicit<S, ImplicitMidpoint>
        + Implicit<S, Gauss4>
        + Implicit<S, Gauss6>
        + Implicit<S, LieMidpoint<Exp>>
        + LiePoisson<S>
{
}

/// The equations that every Lie–Poisson system has.
pub fn equations<P: Implicits<f64>>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) {
    of_field(fused, reference, mu, h, random, errors);
    let mut compare = Comparison { mu, random, errors };
    compare.run(
        "exp",
        fused.equation(&LieMidpoint::exp(), h),
        generic::ExpMidpoint::new(reference, h),
    );
}

/// The equations that every Poisson system has.
pub fn of_field<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: Implicit<f64, ImplicitMidpoint> + Implicit<f64, Gauss4> + Implicit<f64, Gauss6>,
{
    let mut compare = Comparison { mu, random, errors };
    compare.run(
        "midpoint",
        fused.equation(&ImplicitMidpoint, h),
        generic::Midpoint::new(reference, h),
    );
    compare.run(
        "gauss4",
        fused.equation(&Gauss4, h),
        generic::Gauss::<_, _, 2>::new(reference, h),
    );
    compare.run(
        "gauss6",
        fused.equation(&Gauss6, h),
        generic::Gauss::<_, _, 3>::new(reference, h),
    );
}

/// The equation of the Cayley map.
pub fn cayley_equation<P>(
    fused: &P,
    reference: &P,
    mu: &P::State,
    h: f64,
    random: &mut Random,
    errors: &mut Errors,
) where
    P: Implicit<f64, LieMidpoint<Cayley>> + CayleyPoisson<f64>,
{
    let mut compare = Comparison { mu, random, errors };
    compare.run(
        "cayley",
        fused.equation(&LieMidpoint::cayley(), h),
        generic::CayleyMidpoint::new(reference, h),
    );
}

/// What all comparisons of one state share.
pub struct Comparison<'a, V> {
    pub mu: &'a V,
    pub random: &'a mut Random,
    pub errors: &'a mut Errors,
}

impl<V> Comparison<'_, V> {
    /// A fused equation against its generic form.
    pub fn run<F, G>(&mut self, name: &str, mut fused: F, mut reference: G)
    where
        F: Equation<f64, State = V>,
        G: Equation<f64, State = V>,
    {
        equation(
            name,
            &mut fused,
            &mut reference,
            self.mu,
            self.random,
            self.errors,
        );
    }
}
