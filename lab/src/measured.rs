//! Runs with a tolerance on drawn members, and the error over it.

use crate::drawn::algebra::Space;
use crate::drawn::member::{Member, off};
use crate::drawn::system::Drawn;
use lie_runtime::methods::{Collective16 as OrderSixteen, Method};
use lie_runtime::prelude::*;

/// A method with what it is called, its tolerances, and for which members it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Way {
    /// What `lie run --tol` takes where no method is asked for.
    Gauss16,
    /// Over the smallest of the spaces that are known.
    Collective16,
    /// Keeps the energy.
    CohenHairer16,
    /// Series.
    Taylor,
    /// Series in the algebra.
    LieTaylor,
    /// Order 2.
    Midpoint,
    /// Order 2, by the exponential.
    LieMidpoint,
    /// Order 4, explicit.
    Rk4,
    /// Order 4, where H is a sum of functions of one coordinate.
    Splitting4,
}

/// What a run has shown.
#[derive(Clone, Debug)]
pub struct Row {
    /// The number of the member.
    pub number: u64,
    /// The method.
    pub way: Way,
    /// The tolerance.
    pub tolerance: f64,
    /// Growth of changes and doubt of the reference, as the member has them.
    pub growth: f64,
    /// The same.
    pub doubt: f64,
    /// The error over the tolerance and whether the run warned; none of a run that was refused.
    pub ratio: Option<(f64, bool)>,
}

impl Row {
    /// A run of a member.
    pub fn measure(member: &Member, way: Way, tolerance: f64, assessed: bool) -> Self {
        let ratio = match way.run(member, tolerance, assessed) {
            Outcome::Done { error, warned, .. } => Some((error / tolerance, warned)),
            Outcome::Refused(_) => None,
        };
        Self {
            number: member.seed,
            way,
            tolerance,
            growth: member.growth,
            doubt: member.doubt,
            ratio,
        }
    }

    /// A line of a file.
    pub fn to_line(&self) -> String {
        let (ratio, warned) = self.ratio.unwrap_or((f64::NAN, true));
        let Self {
            number,
            tolerance,
            growth,
            doubt,
            ..
        } = self;
        format!(
            "{number} {} {tolerance:e} {growth:e} {doubt:e} {ratio:e} {warned}",
            self.way.id()
        )
    }

    /// From such a line.
    pub fn from_line(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [number, id, tolerance, growth, doubt, ratio, warned] = words[..] else {
            return None;
        };
        let ratio: f64 = ratio.parse().ok()?;
        Some(Self {
            number: number.parse().ok()?,
            way: Way::ALL.into_iter().find(|way| way.id() == id)?,
            tolerance: tolerance.parse().ok()?,
            growth: growth.parse().ok()?,
            doubt: doubt.parse().ok()?,
            ratio: (!ratio.is_nan()).then_some((ratio, warned == "true")),
        })
    }
}

/// How a run came out.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// The relative error at the end, and whether the run says that the tolerance may be missed.
    Done {
        /// The error.
        error: f64,
        /// Whether the run says so.
        warned: bool,
        /// Steps.
        steps: u64,
        /// Evaluations of the field.
        evaluations: u64,
    },
    /// Why there was no run to the end.
    Refused(String),
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Gauss16,
        Self::Collective16,
        Self::CohenHairer16,
        Self::Taylor,
        Self::LieTaylor,
        Self::Midpoint,
        Self::LieMidpoint,
        Self::Rk4,
        Self::Splitting4,
    ];

    /// The id of the method.
    pub fn id(self) -> &'static str {
        match self {
            Self::Gauss16 => "gauss16",
            Self::Collective16 => "collective16",
            Self::CohenHairer16 => "cohen-hairer16",
            Self::Taylor => "taylor",
            Self::LieTaylor => "lie-taylor",
            Self::Midpoint => "midpoint",
            Self::LieMidpoint => "lie-midpoint",
            Self::Rk4 => "rk4",
            Self::Splitting4 => "splitting4",
        }
    }

    /// The tolerances that make sense.
    pub fn tolerances(self) -> &'static [f64] {
        match self {
            Self::Midpoint | Self::LieMidpoint => &[1e-3, 1e-5],
            Self::Rk4 | Self::Splitting4 => &[1e-4, 1e-6, 1e-8],
            _ => &[1e-4, 1e-6, 1e-9, 1e-11],
        }
    }

    /// Whether the method is for a member.
    pub fn applies(self, member: &Member) -> bool {
        match self {
            Self::Collective16 => member.system.algebra.space != Space::None,
            Self::Splitting4 => member.system.energy.separable,
            _ => true,
        }
    }

    /// Runs a member with a tolerance.
    pub fn run(self, member: &Member, tolerance: f64, assessed: bool) -> Outcome {
        let tolerance = (tolerance, assessed);
        // as the command does
        let per_step = (0.01 * tolerance.0).max(1e-15);
        match self {
            Self::Gauss16 => run(member, Gauss16, tolerance),
            Self::Collective16 => match &member.system.algebra.space {
                Space::Spins(_) => run(member, OrderSixteen::hopf(), tolerance),
                Space::Vectors(..) => run(member, OrderSixteen::quaternion(), tolerance),
                _ => run(member, OrderSixteen::representation(), tolerance),
            },
            Self::CohenHairer16 => run(member, CohenHairer16::default(), tolerance),
            Self::Taylor => run(member, Taylor::with_tolerance(per_step), tolerance),
            Self::LieTaylor => run(member, LieTaylor::with_tolerance(per_step), tolerance),
            Self::Midpoint => run(member, ImplicitMidpoint, tolerance),
            Self::LieMidpoint => run(member, LieMidpoint::exp(), tolerance),
            Self::Rk4 => run(member, Rk4, tolerance),
            Self::Splitting4 => run(member, Splitting4::new(), tolerance),
        }
    }
}

fn run<M: Method<f64, Drawn>>(
    member: &Member,
    method: M,
    (tolerance, assess): (f64, bool),
) -> Outcome {
    let problem = Problem::new(
        member.system.clone(),
        member.start.clone(),
        (0.0, member.span),
    );
    let options = Options::tolerance(tolerance).save(Save::Ends);
    let options = if assess { options.assessed() } else { options };
    match solve(&problem, method, &options) {
        Ok(solution) => {
            let end = solution.mu.last().expect("the end is saved");
            let error = off(end, &member.end);
            let warned =
                solution.lost.is_some() || solution.assessed.is_some_and(|found| found.missed());
            let stats = solution.stats;
            Outcome::Done {
                error: if error.is_nan() { f64::INFINITY } else { error },
                warned,
                steps: stats.steps,
                evaluations: stats.evaluations,
            }
        }
        Err(error) => Outcome::Refused(error.to_string()),
    }
}
