//! The degree of a function in the coordinates, from its structure.
//!
//! At infinity every rational function has a degree: that of a product is the sum, that of a sum the
//! largest unless the leading parts cancel. The leading part is therefore known at a few points
//! modulo a prime, parameters and all, and nothing is expanded or brought to a common denominator.
//! Where the values of the leading part are not zero, the degree is proven; where they are, or where
//! roots and functions of the coordinates take part, the normal form decides, unless values on a line
//! show that there is no polynomial of a degree up to twelve.

use super::confirmation::Confirmation;
use super::normal::NormalForm;
use super::residues;
use crate::exact::{Budget, Rational, Residue};
use crate::symbolic::{Elementary, ExprId, Graph, Node, Symbol};

/// Work allowed for the normal form.
const WORK: u64 = 300_000;
/// Points at which leading parts are looked at.
const POINTS: usize = 2;
/// Quotients of a higher degree are left to the normal form.
const MOST_POINTS: i64 = 64;

/// The total degree in the coordinates, if the function is a polynomial in them and small enough
/// to tell.
pub fn degree(graph: &Graph, function: ExprId) -> Option<u32> {
    let growths = growths(graph, function);
    match growths.last().and_then(Option::as_ref) {
        Some(growth) if growth.uncertain => {}
        Some(growth) if growth.polynomial => return u32::try_from(growth.degree).ok(),
        Some(growth) if growth.degree < 0 => return None,
        Some(growth) if leaves_its_polynomial(graph, function, growth.degree) => return None,
        _ => return parts(graph, function, &growths),
    }
    normal(graph, function)
}

fn normal(graph: &Graph, function: ExprId) -> Option<u32> {
    // Most functions that get here are none, and values say so at once.
    if Confirmation::new(graph, &[]).is_no_polynomial(function) {
        return None;
    }
    let budget = Budget::new(WORK);
    NormalForm::new(graph, &budget).degree(function)
}

/// How a function grows at infinity.
#[derive(Clone, Debug)]
struct Growth {
    /// Its degree there, that of a polynomial or the difference of those of a quotient; where it is
    /// uncertain, an upper bound.
    degree: i64,
    /// Its leading part at the points; none where something is divided by zero.
    leading: [Option<Residue>; POINTS],
    /// Whether it is a polynomial in the coordinates; with degree 0 a constant, then.
    polynomial: bool,
    /// Whether roots or functions of parameters take part in the leading part: they may obey relations.
    opaque: bool,
    /// Whether the leading part may vanish through such relations.
    uncertain: bool,
}

impl Growth {
    fn is_constant(&self) -> bool {
        self.polynomial && self.degree == 0
    }

    /// The same, if its leading part is seen not to vanish.
    fn proven(self) -> Option<Self> {
        let seen = |value: &Option<Residue>| value.is_some_and(|value| !value.is_zero());
        self.leading.iter().any(seen).then_some(self)
    }
}

/// A constant or a coordinate.
fn leaf(degree: i64, value: impl Fn(usize) -> Option<Residue>) -> Option<Growth> {
    let growth = Growth {
        degree,
        leading: std::array::from_fn(value),
        polynomial: true,
        opaque: false,
        uncertain: false,
    };
    growth.proven()
}

/// The growth of everything that a function is made of, the function last; `None` where the structure
/// does not tell.
fn growths(graph: &Graph, function: ExprId) -> Vec<Option<Growth>> {
    let parts = graph.dependencies(&[function]);
    let mut known: Vec<Option<Growth>> = Vec::with_capacity(parts.len());
    for id in &parts {
        let of = |child: &ExprId| {
            let place = parts.binary_search(child).ok()?;
            known[place].as_ref()
        };
        let growth = match graph.node(*id) {
            Node::Number(value) => leaf(0, |_| Residue::from_rational(value)),
            // transcendental, so that no relation holds for it
            Node::Pi => leaf(0, |point| Some(residues::pi_value(point))),
            Node::Symbol(symbol) => {
                let degree = i64::from(matches!(symbol, Symbol::Coordinate(_)));
                leaf(degree, |point| Some(residues::symbol_value(point, *symbol)))
            }
            Node::Sum { constant, terms } => {
                let terms = terms.iter().map(|(term, c)| Some((of(term)?, c)));
                terms
                    .collect::<Option<Vec<_>>>()
                    .and_then(|terms| sum(constant, &terms))
            }
            Node::Written(terms) => {
                let terms = terms.iter().map(|(term, c)| Some((of(term)?, c)));
                terms
                    .collect::<Option<Vec<_>>>()
                    .and_then(|terms| sum(&Rational::ZERO, &terms))
            }
            Node::Product(factors) => product(factors, &of),
            Node::Call(function, arguments) => {
                let constant = arguments
                    .iter()
                    .all(|a| of(a).is_some_and(Growth::is_constant));
                let value = |point| Some(residues::constant_value(point, id.index() as u64));
                leaf(0, value).filter(|_| constant).map(|leaf| Growth {
                    opaque: true,
                    uncertain: *function != Elementary::Exp.into(),
                    ..leaf
                })
            }
        };
        known.push(growth);
    }
    known
}

fn sum(constant: &Rational, terms: &[(&Growth, &Rational)]) -> Option<Growth> {
    let number = leaf(0, |_| Residue::from_rational(constant));
    let one = Rational::ONE;
    let all = terms
        .iter()
        .copied()
        .chain(number.iter().map(|n| (n, &one)));
    let top = all.clone().map(|(term, _)| term.degree).max()?;
    let leading: Vec<_> = all.clone().filter(|(term, _)| term.degree == top).collect();
    let opaque = leading.iter().any(|(term, _)| term.opaque);
    Growth {
        degree: top,
        leading: std::array::from_fn(|point| {
            leading.iter().try_fold(Residue::ZERO, |sum, (term, c)| {
                Some(sum.plus(term.leading[point]?.times(Residue::from_rational(c)?)))
            })
        }),
        polynomial: all.clone().all(|(term, _)| term.polynomial),
        opaque,
        uncertain: (opaque && leading.len() > 1) || leading.iter().any(|(term, _)| term.uncertain),
    }
    .proven()
}

fn product<'a>(
    factors: &[(ExprId, Rational)],
    of: &impl Fn(&ExprId) -> Option<&'a Growth>,
) -> Option<Growth> {
    let mut all = leaf(0, |_| Some(Residue::ONE))?;
    for (base, exponent) in factors {
        let growth = of(base)?;
        let Some(power) = exponent.to_integer() else {
            // The root of a constant is one of its own, and not zero where the constant is not.
            if !growth.is_constant() {
                return None;
            }
            let place = exponent
                .to_words()
                .map_or(0, |(n, d)| n.wrapping_mul(1009) ^ d);
            for (point, leading) in all.leading.iter_mut().enumerate() {
                let value =
                    residues::constant_value(point, (base.index() as u64) << 32 ^ place as u64);
                *leading = leading.map(|l| l.times(value));
            }
            all.opaque = true;
            all.uncertain |= growth.uncertain;
            continue;
        };
        // Of an uncertain degree only the upper bound is known, which a reciprocal turns around.
        if power < 0 && growth.uncertain && !growth.is_constant() {
            return None;
        }
        all.degree = all.degree.checked_add(growth.degree.checked_mul(power)?)?;
        all.polynomial &= growth.is_constant() || (growth.polynomial && power > 0);
        all.opaque |= growth.opaque;
        all.uncertain |= growth.uncertain;
        for (leading, base) in all.leading.iter_mut().zip(&growth.leading) {
            *leading = leading.and_then(|l| Some(l.times(base.and_then(|b| b.power(power))?)));
        }
    }
    all.proven()
}

/// Whether a quotient is no polynomial of a degree up to `degree`: on a line, one more difference does
/// not vanish.
fn leaves_its_polynomial(graph: &Graph, function: ExprId, degree: i64) -> bool {
    if degree > MOST_POINTS {
        return false;
    }
    let parts = graph.dependencies(&[function]);
    let values: Option<Vec<Residue>> = (0..degree + 2)
        .map(|step| residues::on_line(graph, &parts, Residue::from_bits(step as u64)))
        .collect();
    let Some(mut values) = values else {
        return false;
    };
    for _ in 0..=degree {
        values = values
            .windows(2)
            .map(|pair| pair[1].minus(pair[0]))
            .collect();
    }
    values.iter().any(|value| !value.is_zero())
}

/// The degree of a function some terms of which are beyond the structure: these alone go through the
/// normal form.
fn parts(graph: &Graph, function: ExprId, growths: &[Option<Growth>]) -> Option<u32> {
    let Node::Sum { constant, terms } = graph.node(function) else {
        return normal(graph, function);
    };
    let below = graph.dependencies(&[function]);
    let growth = |term: &ExprId| {
        let growth = growths[below.binary_search(term).ok()?].as_ref()?;
        growth.polynomial.then_some(growth)
    };
    let (known, rest): (Vec<_>, Vec<_>) = terms
        .iter()
        .cloned()
        .partition(|(term, _)| growth(term).is_some());
    let known: Vec<_> = known
        .iter()
        .filter_map(|(term, c)| Some((growth(term)?, c)))
        .collect();
    if known.is_empty() || rest.is_empty() {
        return normal(graph, function);
    }
    let mut scratch = graph.clone();
    let rest = scratch.linear(&rest);
    let rest = i64::from(normal(&scratch, rest)?);
    match sum(constant, &known) {
        Some(known) if known.degree > rest && !known.uncertain => u32::try_from(known.degree).ok(),
        Some(known) if known.degree < rest => u32::try_from(rest).ok(),
        _ => normal(graph, function),
    }
}
