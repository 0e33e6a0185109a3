//! States at rest where the bracket has a lower rank than generically, or the Casimirs are no coordinates of the leaves.
//!
//! Of a Poisson bracket such a state lies on a leaf of fewer dimensions than the states around it; of an almost-Poisson one, which has no
//! leaves, it is where the body of Suslov turns steadily. H need not be stationary there. They need not be isolated, and members of
//! one family differ in their energy and stability: a family counts once for each count of eigenvalues on either side of the axis. What is
//! shown of it has the energy of the initial state where there is such a member.
//!
//! The linearisation is the slope of the motion, on the common kernel of the gradients of the Casimirs. Where all of its eigenvalues but
//! those along the family have negative real parts, motion nearby tends to the family, and each member is stable (J. Carr 1981, *Applications of
//! Centre Manifold Theory*, Springer, doi:10.1007/978-1-4612-5929-9).

use num_complex::Complex64 as c64;

use crate::dense::{Singular, add, norm, restricted, symmetric_eigen, unit_vectors};
use crate::eigenvalues::eigenvalues;
use crate::family::{SAME, STRIDE, Solutions};
use crate::field::{Field, Linear};
use crate::newton::At;
use crate::proof::Inertia;
use crate::stability::{Judgement, Reason, Stability, signs};

/// An entry below this part of the scale is zero.
pub const ZERO: f64 = 1e-12;
/// Equations that are round-off.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// A residual of a solution.
const SOLVED: f64 = 1e-11;
/// A real part below this part of the largest eigenvalue counts as zero.
const IMAGINARY: f64 = 1e-6;
/// A state beyond so many times the scale is none of those that are looked for.
const FAR: f64 = 1e3;
/// Eigenvalues nearer to the axis, in parts of what is usual, are those of a state near a change of the family.
const CLEAR: f64 = 1e-4;

/// A state at rest where the rank drops, or a member of a family of them.
#[derive(Clone, Debug)]
pub struct LowRank {
    /// The n coordinates.
    pub state: Vec<f64>,
    /// By how much they are known.
    pub error: f64,
    /// H.
    pub energy: f64,
    /// The rank of Pi there.
    pub rank: usize,
    /// How many of the gradients of the Casimirs are independent there.
    pub gradients: usize,
    /// The dimension of the family, 0 where it is isolated.
    pub family: usize,
    /// Whether the linearisation has a kernel along which no solutions go on, as far as the numbers tell.
    pub degenerate: bool,
    /// How often the search found it.
    pub hits: usize,
    /// The eigenvalues on the common kernel of the gradients of the Casimirs.
    pub eigenvalues: Vec<c64>,
    /// Its stability, by numbers.
    pub judgement: Judgement,
    /// How many eigenvalues have a positive, a negative and no real part.
    pub(crate) sides: [usize; 3],
    /// Whether families lead through it.
    pub(crate) crosses: bool,
    /// How many eigenvalues are zero.
    pub(crate) resting: usize,
    /// The smallest real part that has a sign, or imaginary part, in parts of what is usual.
    pub(crate) gap: f64,
    /// Whether it has the energy of the initial state.
    pub(crate) at_energy: bool,
}

impl LowRank {
    /// Whether it is far from where its family changes.
    pub(crate) fn is_clear(&self) -> bool {
        match (self.family, self.degenerate) {
            (1.., true) => false,
            (0, true) if self.crosses && self.judgement.stability != Stability::Stable => false,
            (0, true) => self.error <= SAME * norm(&self.state).max(SAME),
            _ => self.gap > CLEAR && self.resting == self.family,
        }
    }
}

/// A solution in parts of the scale, with its zeros made exact.
struct Settled {
    z: Vec<f64>,
    linear: Linear,
    family: usize,
    kernel: usize,
    crosses: bool,
    error: f64,
}

impl Settled {
    /// `None` where z is none, or none of the system: H has no value where round-off is taken for zero.
    fn new(field: &Field<'_>, mut z: Vec<f64>) -> Option<Self> {
        if norm(&z) > FAR {
            return None;
        }
        snap(&mut z, ZERO);
        let settled = Self::at(field, z, f64::INFINITY)?;
        if settled.family == settled.kernel || norm(&settled.linear.value) == 0.0 {
            return Some(settled);
        }
        // where families cross the equations have no linear part, and perhaps no quadratic one
        let off = norm(&settled.linear.value).max(ROUNDING);
        let error = settled.error.max(off.cbrt());
        let mut snapped = settled.z.clone();
        snap(&mut snapped, 4.0 * error);
        let snapped = field.polish(snapped).and_then(|mut z| {
            snap(&mut z, ZERO);
            Self::at(field, z, error)
        });
        let snapped =
            snapped.filter(|snapped| snapped.z != settled.z && norm(&snapped.linear.value) <= off);
        Some(snapped.unwrap_or(Self { error, ..settled }))
    }

    /// What is known at a point, which is uncertain by so much at most.
    fn at(field: &Field<'_>, z: Vec<f64>, most: f64) -> Option<Self> {
        let linear = field.linear(&z)?;
        let off = norm(&linear.value);
        if off > SOLVED {
            return None;
        }
        let directions = field.kernel(&z)?;
        let stride = 0.1 * STRIDE * norm(&z).max(0.1);
        let goes_on = |direction: &&Vec<f64>| {
            let mut both = [stride, -stride].into_iter();
            both.any(|stride| field.goes_on(&z, direction, directions.len(), stride))
        };
        let kernel = directions.len();
        // where families cross the kernel is larger than beside
        let leads_on = |direction: &Vec<f64>| {
            let mut both = [stride, -stride].into_iter();
            both.any(|stride| (1..kernel).any(|less| field.goes_on(&z, direction, less, stride)))
        };
        let family = directions.iter().filter(goes_on).count();
        let error = match off {
            0.0 => f64::EPSILON,
            _ => field.reach(&z, family)?.min(most).max(off),
        };
        let crosses = family < kernel && directions.iter().any(leads_on);
        Some(Self {
            z,
            linear,
            family,
            kernel,
            crosses,
            error,
        })
    }
}

/// The eigenvalues on the level set, and how many are on either side of the imaginary axis.
struct Spectrum {
    values: Vec<c64>,
    /// What counts as zero.
    bound: f64,
    /// With a positive, a negative and no real part.
    sides: [usize; 3],
    resting: usize,
}

impl Spectrum {
    fn new(field: &Field<'_>, settled: &Settled, tangent: &[Vec<f64>]) -> Self {
        let motion = field.motion(&settled.linear);
        let values = eigenvalues(
            &restricted(&motion, settled.z.len(), tangent),
            tangent.len(),
        );
        let largest = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let uncertain = (1e-9 + 10.0 * settled.error) * field.rate();
        let bound = (IMAGINARY * largest).max(uncertain);
        let count = |of: &dyn Fn(&c64) -> bool| values.iter().filter(|z| of(z)).count();
        Self {
            sides: [
                count(&|z| z.re > bound),
                count(&|z| z.re < -bound),
                count(&|z| z.re.abs() <= bound),
            ],
            resting: count(&|z| z.norm() <= bound),
            bound,
            values,
        }
    }

    /// The smallest part that tells two kinds of eigenvalues apart.
    fn gap(&self) -> f64 {
        let parts = self.values.iter().flat_map(|z| [z.re.abs(), z.norm()]);
        let parts = parts.filter(|part| *part > self.bound);
        parts.fold(f64::INFINITY, f64::min)
    }
}

impl At<'_> {
    /// What a solution is; `None` where the rank is the generic one.
    pub(crate) fn low_rank_at(self, field: &Field<'_>, z: Vec<f64>) -> Option<LowRank> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let settled = Settled::new(field, z)?;
        let state: Vec<f64> = settled.z.iter().map(|z| z * field.size).collect();
        let y = [state.as_slice(), &vec![0.0; m]].concat();
        let shape = self.equations.shape(&y, self.parameters)?;
        let (typical, generic) = &field.typical;
        let part = 1e-9 + 10.0 * settled.error;
        let values = field.singular(&settled.z)?;
        let rank = values.iter().filter(|x| **x > part * typical[0]).count();
        let normal = Singular::new(&settled.linear.slope[n * n..(n + m) * n], m, n)?;
        let gradients = normal.values.iter().filter(|x| **x > 1e-6 + part).count();
        if rank >= *generic && gradients == m {
            return None;
        }
        let tangent = match m {
            0 => unit_vectors(n),
            _ => normal.kernel(gradients).to_vec(),
        };
        let drops = rank >= *generic || field.rank_returns(&settled.z, rank);
        if !self.is_at_levels(&y) || !drops {
            return None;
        }
        let spectrum = Spectrum::new(field, &settled, &tangent);
        let family = settled.family;
        let numerical = |stability, reason| Judgement {
            stability,
            reason,
            proven: false,
        };
        let judgement = match self.stationary(&state, &tangent) {
            _ if spectrum.values.len() < tangent.len() => {
                numerical(Stability::Undecided, Reason::Degenerate)
            }
            Some(inertia) if inertia.is_definite(family) => {
                let minimum = inertia.negative == 0;
                numerical(Stability::Stable, Reason::Definite { minimum })
            }
            _ if spectrum.sides[0] > 0 => numerical(Stability::Unstable, Reason::Right),
            _ if spectrum.sides[2] == family && spectrum.resting == family => {
                numerical(Stability::Stable, Reason::Attracting)
            }
            _ => numerical(Stability::Undecided, Reason::NoneRight),
        };
        Some(LowRank {
            state,
            // the residual is zero, and not round-off
            error: match settled.error <= f64::EPSILON {
                true => 0.0,
                false => settled.error * field.size,
            },
            energy: shape.energy,
            rank,
            gradients,
            family,
            degenerate: family < settled.kernel,
            crosses: settled.crosses,
            hits: 1,
            judgement,
            sides: spectrum.sides,
            resting: spectrum.resting,
            gap: spectrum.gap() / field.rate(),
            at_energy: false,
            eigenvalues: spectrum.values,
        })
    }

    /// Whether the Casimirs have their values, not beside the scale alone but beside those.
    fn is_at_levels(self, y: &[f64]) -> bool {
        let found = || {
            let (levels, state) = self.equations.leaf(self.parameters)?;
            let linear = self.equations.linear(y, self.parameters)?;
            let mut pairs = linear.residual[state.len()..].iter().zip(&levels);
            Some(pairs.all(|(off, level)| *level == 0.0 || off.abs() <= SAME * level.abs()))
        };
        found().unwrap_or(false)
    }

    /// The signs of the Hessian of `H - sum_k lambda_k C_k` where H is stationary with multipliers.
    fn stationary(self, state: &[f64], tangent: &[Vec<f64>]) -> Option<Inertia> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let y = [state, &vec![0.0; m]].concat();
        let shape = self.equations.shape(&y, self.parameters)?;
        let gradient = self.equations.linear(&y, self.parameters)?.residual[..n].to_vec();
        let transposed = (0..n).flat_map(|i| (0..m).map(move |k| (k, i)));
        let transposed: Vec<f64> = transposed
            .map(|(k, i)| shape.gradients[k * n + i])
            .collect();
        let lambda = match m {
            0 => Vec::new(),
            _ => {
                let fit = Singular::new(&transposed, n, m)?;
                fit.shortest(&gradient, fit.rank(1e-10))
            }
        };
        let mut rest = gradient;
        let mut form = shape.hessian;
        for (k, lambda) in lambda.iter().enumerate() {
            add(&mut rest, -lambda, &shape.gradients[k * n..(k + 1) * n]);
            add(&mut form, -lambda, &shape.casimirs[k]);
        }
        let size = self.size(&y);
        if norm(&rest) > 1e-9 * norm(&form) * size {
            return None;
        }
        let form = restricted(&form, n, tangent);
        Some(signs(&symmetric_eigen(&form, tangent.len())?.0))
    }
}

/// Makes entries below a bound zero.
fn snap(z: &mut [f64], bound: f64) {
    let small = z.iter_mut().filter(|z| z.abs() < bound);
    small.for_each(|z| *z = 0.0);
}
