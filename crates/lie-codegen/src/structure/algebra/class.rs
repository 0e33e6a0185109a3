//! The class of an algebra: its series, centre, Killing form, and what follows from them.
//!
//! Everything is linear algebra over the rationals: `[g, g]` is a span of brackets, g is semisimple where its Killing form
//! has no radical (Cartan's criterion), and reductive where that of `[g, g]`, which is the restriction to this
//! ideal, has none.

use super::subspace::{Signature, Subspace};
use super::table::Table;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// What an algebra is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    /// All brackets vanish.
    pub abelian: bool,
    /// The lower central series ends at zero.
    pub nilpotent: bool,
    /// The derived series ends at zero.
    pub solvable: bool,
    /// The Killing form is nondegenerate, and there is something.
    pub semisimple: bool,
    /// A sum of a semisimple algebra and an abelian one.
    pub reductive: bool,
    /// `tr ad_x = 0` for all x, so that the flow of every H keeps volume.
    pub unimodular: bool,
}

impl Class {
    /// The properties that hold, in words.
    pub fn words(&self) -> String {
        let all = [
            (self.abelian, "abelian"),
            (self.nilpotent, "nilpotent"),
            (self.solvable, "solvable"),
            (self.semisimple, "semisimple"),
            (self.reductive, "reductive"),
            (self.unimodular, "unimodular"),
        ];
        let hold = all.iter().filter(|(holds, _)| *holds);
        let hold: Vec<&str> = hold.map(|(_, name)| *name).collect();
        if hold.is_empty() {
            "neither solvable nor reductive, and not unimodular".to_owned()
        } else {
            hold.join(", ")
        }
    }
}

/// The dimensions from which the class is seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    /// Dimensions of `g, [g, g], [[g, g], [g, g]], …` until they stay.
    pub derived: Vec<usize>,
    /// Dimensions of `g, [g, g], [g, [g, g]], …` until they stay.
    pub lower_central: Vec<usize>,
    /// Dimension of the centre.
    pub centre: usize,
    /// Dimension of the radical, the largest solvable ideal.
    pub radical: usize,
    /// Signature of the Killing form.
    pub killing: Signature,
}

/// Class and series.
pub fn class(table: &Table, budget: &Budget) -> Result<(Class, Series), Exhausted> {
    let mut sum = NOTHING;
    for (block, count) in table.blocks() {
        let of_block = of_ideal(&block, budget)?;
        for _ in 0..count {
            sum = direct_sum(&sum, &of_block);
        }
    }
    // of no dimension, nothing is semisimple
    sum.0.semisimple &= table.dimension() > 0;
    Ok(sum)
}

/// The algebra of dimension zero, as a summand.
const NOTHING: (Class, Series) = (
    Class {
        abelian: true,
        nilpotent: true,
        solvable: true,
        semisimple: true,
        reductive: true,
        unimodular: true,
    },
    Series {
        derived: Vec::new(),
        lower_central: Vec::new(),
        centre: 0,
        radical: 0,
        killing: Signature {
            positive: 0,
            negative: 0,
            zero: 0,
        },
    },
);

/// Class and series of a direct sum.
fn direct_sum((a, s): &(Class, Series), (b, t): &(Class, Series)) -> (Class, Series) {
    let class = Class {
        abelian: a.abelian && b.abelian,
        nilpotent: a.nilpotent && b.nilpotent,
        solvable: a.solvable && b.solvable,
        semisimple: a.semisimple && b.semisimple,
        reductive: a.reductive && b.reductive,
        unimodular: a.unimodular && b.unimodular,
    };
    let dimensions = |s: &[usize], t: &[usize]| {
        let at = |series: &[usize], i: usize| *series.get(i).or(series.last()).unwrap_or(&0);
        let longest = s.len().max(t.len());
        (0..longest).map(|i| at(s, i) + at(t, i)).collect()
    };
    let series = Series {
        derived: dimensions(&s.derived, &t.derived),
        lower_central: dimensions(&s.lower_central, &t.lower_central),
        centre: s.centre + t.centre,
        radical: s.radical + t.radical,
        killing: Signature {
            positive: s.killing.positive + t.killing.positive,
            negative: s.killing.negative + t.killing.negative,
            zero: s.killing.zero + t.killing.zero,
        },
    };
    (class, series)
}

/// Class and series, of the algebra as a whole.
fn of_ideal(table: &Table, budget: &Budget) -> Result<(Class, Series), Exhausted> {
    let whole = table.as_subspace(budget)?;
    let derived = table.product(&whole, &whole, budget)?;
    let derived_series = series(&whole, &derived, |last| table.product(last, last, budget))?;
    let lower_central = series(&whole, &derived, |last| table.product(&whole, last, budget))?;
    let killing = table.killing_signature(budget)?;
    let of_derived = table.subalgebra(&derived, budget)?;
    let reductive = of_derived.killing_signature(budget)?.zero == 0;
    let class = Class {
        abelian: derived.dimension() == 0,
        nilpotent: lower_central.last() == Some(&0),
        solvable: derived_series.last() == Some(&0),
        semisimple: killing.zero == 0,
        reductive,
        unimodular: table.traces().iter().all(Rational::is_zero),
    };
    let series = Series {
        derived: derived_series,
        lower_central,
        centre: table.centralizer(&whole, budget)?.dimension(),
        radical: table.radical(&derived, budget)?.dimension(),
        killing,
    };
    Ok((class, series))
}

/// The dimensions of a series until they stay.
fn series(
    whole: &Subspace,
    derived: &Subspace,
    next: impl Fn(&Subspace) -> Result<Subspace, Exhausted>,
) -> Result<Vec<usize>, Exhausted> {
    let mut dimensions = vec![whole.dimension()];
    let mut last = derived.clone();
    while dimensions.last() != Some(&last.dimension()) {
        dimensions.push(last.dimension());
        if last.dimension() == 0 {
            break;
        }
        last = next(&last)?;
    }
    Ok(dimensions)
}
