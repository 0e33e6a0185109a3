//! The Casimirs of an algebra, found: functions F on its dual with `sum_jk C_ij^k mu_k dF/dmu_j = 0` for all i.
//!
//! Polynomials are looked for degree by degree. The equations are linear in the coefficients; they are taken apart by the
//! finest grading of the algebra (`grading`), reduced modulo a prime (`kernel`), and the solution is brought back to rational
//! numbers and verified over them. With parameters in the structure constants the same elimination runs over rational
//! functions. A solution is kept where its gradient is independent of those before it, modulo a prime at one point, which proves
//! that it is no function of them, no product above all. Where a basis mixes so many elements that elimination would take long,
//! an invariant of degree 4 of a semisimple algebra is the trace of a power (`traces`).
//!
//! The number of independent Casimirs is the dimension less the generic rank (Beltrametti and Blasi, Phys. Lett. 20 (1966) 62,
//! doi:10.1016/0031-9163(66)91048-1); where it is reached, nothing else is looked for.

mod characters;
mod field;
mod grading;
mod invariants;
mod kernel;
mod normal;
mod operators;
mod quotients;
mod residues;
mod traces;

use crate::algebra::{StructureConstants, rank};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Polynomial};

use invariants::Search;

/// Linear equations over residues and over rational functions, for those that look for other functions.
pub(crate) mod solve {
    pub(crate) use super::field::drawn;
    pub(crate) use super::field::{Field, Functions, PRIMES, Prime};
    pub(crate) use super::kernel::{Sparse, kernel};
    pub(crate) use super::normal::cleared;
    pub(crate) use super::operators::Echelon;
}

pub use field::{Field, PRIMES, Prime};
pub use operators::MAX_DEGREE;
pub use quotients::{HIGHEST as MAX_FACTOR_DEGREE, LARGEST as MAX_EXPONENT};

/// Work allowed in a declaration: less than a tenth of a second without optimisation.
pub const WORK: u64 = 2_000_000;
/// Work allowed in a report, where the compiler is optimised: spent to the end, four to seven seconds (su(8)).
pub const REPORT: u64 = 400_000_000;
/// Work allowed for rational ones.
const RATIONAL: u64 = 400_000;
/// Work allowed where somebody waits for it.
pub const DEEP: u64 = 20_000_000_000;
/// The largest algebra whose invariants are looked for.
const LARGEST: usize = 250;

/// A function that was found to be a Casimir, in its normal form: integer coefficients without common divisor, the first one
/// positive. Variable i below the dimension n is a coordinate, n + p the parameter p.
#[derive(Clone, Debug, PartialEq)]
pub enum Casimir {
    /// A polynomial.
    Polynomial(Polynomial),
    /// A product of powers of polynomials, some of them negative.
    Rational(Vec<(Polynomial, i64)>),
}

impl Casimir {
    /// The degree in the n coordinates, above every degree where it is no polynomial.
    fn degree(&self, n: usize) -> u32 {
        let Self::Polynomial(function) = self else {
            return u32::MAX;
        };
        let of = |(m, _): (&Monomial, _)| m.powers().filter(|(v, _)| *v < n).map(|(_, e)| e).sum();
        function.terms().map(of).max().unwrap_or(0)
    }
}

/// What is known of a bracket with linear and constant terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Whether the last basis element is the unit, which stands for the constant terms: it is central, set to one and not counted.
    pub with_unit: bool,
    /// Whether it satisfies the Jacobi identity.
    pub jacobi: bool,
}

impl Kind {
    /// The bracket of a Lie algebra.
    pub const LINEAR: Self = Self {
        with_unit: false,
        jacobi: true,
    };

    /// The number of the unit among n elements.
    fn unit(self, n: usize) -> Option<usize> {
        self.with_unit.then(|| n - 1)
    }
}

/// What a search found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Independent Casimirs by ascending degree, polynomials first.
    pub casimirs: Vec<Casimir>,
    /// Whether the search ended because its work was done, and not because the budget was.
    pub complete: bool,
}

/// Looks for as many independent Casimirs as there are: the dimension less the generic rank.
///
/// Without [`Kind::jacobi`] the constants are those of an almost-Poisson bracket, of which no Jacobi identity is asked: kernel functions are
/// the polynomials that every operator annihilates, and nothing else is concluded of them.
///
/// An algebra that is a sum of ideals spanned by basis elements is taken apart, and equal ideals are searched once.
pub fn find(
    constants: &StructureConstants<Fraction>,
    wanted: usize,
    bracket: Kind,
    work: u64,
) -> Found {
    let mut sum = Found {
        casimirs: Vec::new(),
        complete: true,
    };
    if wanted == 0 {
        return sum;
    }
    let n = constants.dimension();
    // what is left of a small budget is nothing: rational ones are looked for with one of their own
    let budgets = [Budget::new(work), Budget::new(work.min(RATIONAL))];
    let mut kinds: Vec<(StructureConstants<Fraction>, Found)> = Vec::new();
    for (elements, block) in constants.blocks(bracket.unit(n)) {
        let found = match kinds.iter().find(|(kind, _)| *kind == block) {
            Some((_, found)) => found,
            None => {
                let found = of_ideal(&block, bracket, &budgets);
                kinds.push((block, found));
                &kinds[kinds.len() - 1].1
            }
        };
        let inside = elements.len();
        let renamed = |function: &Polynomial| {
            function.renamed(&|v| match elements.get(v) {
                Some(&element) => element,
                None => n + v - inside,
            })
        };
        let casimirs = found.casimirs.iter().map(|casimir| match casimir {
            Casimir::Polynomial(function) => Casimir::Polynomial(renamed(function)),
            Casimir::Rational(factors) => {
                let factors = factors.iter().map(|(f, e)| (renamed(f), *e));
                Casimir::Rational(factors.collect())
            }
        });
        sum.casimirs.extend(casimirs);
        sum.complete &= found.complete;
    }
    sum.casimirs.sort_by_key(|casimir| casimir.degree(n));
    // nothing is left to be looked for
    sum.complete |= sum.casimirs.len() == wanted;
    sum
}

/// What is found in an ideal, with budgets for polynomials and for rational functions.
fn of_ideal(
    constants: &StructureConstants<Fraction>,
    bracket: Kind,
    [polynomial, rational]: &[Budget; 2],
) -> Found {
    let n = constants.dimension();
    let wanted = n - rank::generic_rank(constants, n) - usize::from(bracket.with_unit);
    let mut found = Found {
        casimirs: Vec::new(),
        complete: true,
    };
    if wanted == 0 {
        return found;
    }
    if n > LARGEST {
        found.complete = false;
        return found;
    }
    let mut search = match Search::new(constants, bracket, polynomial) {
        Ok(Some(search)) => search,
        _ => return Found::default(),
    };
    found.complete = polynomials(&mut search, wanted).is_ok();
    let missing = wanted - search.count();
    let added = match missing {
        1.. if bracket == Kind::LINEAR => quotients::add(&mut search, constants, missing, rational),
        _ => Ok(Vec::new()),
    };
    found
        .casimirs
        .extend(search.into_found().into_iter().map(Casimir::Polynomial));
    match added {
        Ok(rational) => found.casimirs.extend(rational),
        Err(Exhausted) => found.complete = false,
    }
    found.complete |= found.casimirs.len() == wanted;
    found
}

/// All polynomial invariants of one degree, as a vector space.
///
/// # Errors
/// [`Exhausted`] where the budget is too small.
pub fn invariants(
    constants: &StructureConstants<Fraction>,
    degree: usize,
    budget: &Budget,
) -> Result<Vec<Polynomial>, Exhausted> {
    let search = Search::new(constants, Kind::LINEAR, budget)?;
    search.ok_or(Exhausted)?.space(degree)
}

fn polynomials(search: &mut Search<'_>, wanted: usize) -> Result<(), Exhausted> {
    for degree in 1..=MAX_DEGREE {
        // invariants of degree 3 take the longest where the others are a trace
        if search.degree(degree, wanted)? || degree == 2 && search.trace(wanted)? {
            return Ok(());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
