//! Equations of implicit methods, generated against generic ones.

use lie_runtime::methods::{
    Cayley, Exp, Gauss4, Gauss6, ImplicitMidpoint, LieMidpoint, Retraction,
};
use lie_runtime::{CayleyPoisson, Equation, Implicit, LiePoisson, Scalar, State, Unknown, generic};

use crate::errors::{Errors, entries, nudged, unknown_entries};
use crate::systems::Random;

/// An equation as lists of numbers, so that what compares two of them is compiled once.
trait ErasedEquation {
    fn set_base(&mut self, base: &[f64]);
    fn initial_guess(&mut self) -> Vec<f64>;
    fn residual(&mut self, unknown: &[f64]) -> Vec<f64>;
    /// The residual, and the Jacobian row after row.
    fn linearize(&mut self, unknown: &[f64]) -> [Vec<f64>; 2];
    /// What the last Jacobian makes of the last residual; none where a pivot is near 0.
    fn correction(&mut self) -> Option<Vec<f64>>;
    /// The state at the end.
    fn result(&mut self, base: &[f64], unknown: &[f64]) -> Vec<f64>;
    /// The element of the group, where it is told by one vector.
    fn group_factor(&mut self, unknown: &[f64]) -> Option<(Retraction, Vec<f64>)>;
}

/// An equation with a place for each of its results.
struct Buffered<'e, E: Equation<f64>> {
    equation: &'e mut E,
    state: E::State,
    unknown: E::Unknown,
    residual: E::Unknown,
    matrix: E::Matrix,
}

impl<'e, E: Equation<f64>> Buffered<'e, E> {
    fn new(equation: &'e mut E, state: &E::State) -> Self {
        Self {
            state: state.clone(),
            unknown: equation.zero_unknown(),
            residual: equation.zero_unknown(),
            matrix: equation.zero_matrix(),
            equation,
        }
    }

    fn set_unknown(&mut self, unknown: &[f64]) {
        for (index, entry) in unknown.iter().enumerate() {
            self.unknown.set_entry(index, *entry);
        }
    }
}

impl<E: Equation<f64>> ErasedEquation for Buffered<'_, E> {
    fn set_base(&mut self, base: &[f64]) {
        self.state.as_mut_slice().copy_from_slice(base);
        self.equation.set_base(&self.state);
    }
    fn initial_guess(&mut self) -> Vec<f64> {
        self.equation.initial_guess(&mut self.unknown);
        unknown_entries(&self.unknown)
    }
    fn residual(&mut self, unknown: &[f64]) -> Vec<f64> {
        self.set_unknown(unknown);
        self.equation.residual(&self.unknown, &mut self.residual);
        unknown_entries(&self.residual)
    }
    fn linearize(&mut self, unknown: &[f64]) -> [Vec<f64>; 2] {
        self.set_unknown(unknown);
        self.equation
            .linearize(&self.unknown, &mut self.residual, &mut self.matrix);
        [unknown_entries(&self.residual), entries(&self.matrix)]
    }
    fn correction(&mut self) -> Option<Vec<f64>> {
        if !self.equation.factor(&mut self.matrix) {
            return None;
        }
        self.equation.solve(&self.matrix, &mut self.residual);
        Some(unknown_entries(&self.residual))
    }
    fn result(&mut self, base: &[f64], unknown: &[f64]) -> Vec<f64> {
        self.set_unknown(unknown);
        self.state.as_mut_slice().copy_from_slice(base);
        self.equation.result(&self.unknown, &mut self.state);
        self.state.as_slice().to_vec()
    }
    fn group_factor(&mut self, unknown: &[f64]) -> Option<(Retraction, Vec<f64>)> {
        self.set_unknown(unknown);
        let retraction = self.equation.group_factor(&self.unknown, &mut self.state)?;
        Some((retraction, self.state.as_slice().to_vec()))
    }
}

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
    let (mut fused, mut reference) = (Buffered::new(fused, mu), Buffered::new(reference, mu));
    let both: [&mut dyn ErasedEquation; 2] = [&mut fused, &mut reference];
    compare(name, both, mu.as_slice(), random, errors);
}

fn compare(
    name: &str,
    [fused, reference]: [&mut dyn ErasedEquation; 2],
    mu: &[f64],
    random: &mut Random,
    errors: &mut Errors,
) {
    fused.set_base(mu);
    reference.set_base(&nudged(mu, errors));
    let (mut unknown, mut other) = (fused.initial_guess(), reference.initial_guess());
    errors.compare(&format!("{name}, initial_guess"), &unknown, &other);
    // off the solution, as in the first iterations
    for index in 0..unknown.len() {
        let entry = other[index] + 0.05 * random.number();
        unknown[index] = entry;
        other[index] = entry * (1.0 + errors.nudge);
    }
    let size = unknown.len();
    let [residual_of_linearize, left] = fused.linearize(&unknown);
    // the unknowns that the iteration finds: the others have an empty row
    let row = |i: &usize| left[i * size..][..size].iter().any(|entry| *entry != 0.0);
    let iterated: Vec<usize> = (0..size).filter(row).collect();
    // The fused equation knows the unknowns that its iteration leaves out: first those with a formula in the state, then
    // those that need the others. Their residuals in the generic one are `u - formula`, or small multiples of the step beside that
    // where few of them depend on each other.
    for _ in 0..60 {
        let residual = reference.residual(&other);
        for index in (0..size).filter(|index| !iterated.contains(index)) {
            other[index] -= residual[index];
        }
    }
    let of = |entries: &[f64]| -> Vec<f64> { iterated.iter().map(|i| entries[*i]).collect() };
    let expected = of(&reference.residual(&other));
    errors.compare(
        &format!("{name}, residual of linearize"),
        &of(&residual_of_linearize),
        &expected,
    );
    let residual = fused.residual(&unknown);
    errors.compare(&format!("{name}, residual"), &of(&residual), &expected);
    for index in (0..size).filter(|index| !iterated.contains(index)) {
        assert_eq!(residual[index], 0.0, "{name}: what is left out never moves");
    }
    let [_, right] = reference.linearize(&other);
    let block = |matrix: &[f64]| -> Vec<f64> {
        let rows = iterated.iter();
        let entries = rows.flat_map(|i| iterated.iter().map(move |j| i * size + j));
        entries.map(|place| matrix[place]).collect()
    };
    errors.compare(&format!("{name}, Jacobian"), &block(&left), &block(&right));
    let corrections = [fused.correction(), reference.correction()];
    let [Some(correction), Some(expected)] = corrections else {
        panic!("{name}: the pivots are near 1");
    };
    errors.compare(
        &format!("{name}, correction"),
        &of(&correction),
        &of(&expected),
    );
    errors.compare(
        &format!("{name}, result"),
        &fused.result(mu, &unknown),
        &reference.result(mu, &other),
    );
    let factors = [fused.group_factor(&unknown), reference.group_factor(&other)];
    let retractions = factors.each_ref();
    let [one, other] = retractions.map(|factor| factor.as_ref().map(|(retraction, _)| *retraction));
    assert_eq!(one, other, "{name}");
    if let [Some((_, found)), Some((_, expected))] = &factors {
        errors.compare(&format!("{name}, group factor"), found, expected);
    }
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
