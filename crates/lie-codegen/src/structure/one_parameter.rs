//! Closed forms of `exp(s A)` for a constant matrix A, by its minimal polynomial.
//!
//! A is taken apart into blocks that do not act on each other. A block is a factor c, which may depend
//! on parameters, times a matrix R of rational numbers; with `sigma = s c`,
//!
//! * `R^k = 0`: `1 + sigma R + … + sigma^(k-1) R^(k-1)/(k-1)!`;
//! * `R^2 = a R`: `1 + (e^(a sigma) - 1)/a R`;
//! * `R^3 = kappa R`, `kappa = -w^2`: `1 + sin(w sigma)/w R + (1 - cos(w sigma))/w^2 R^2`, and with sinh
//!   and cosh for `kappa = w^2`.
//!
//! R has no parameters, so the sign of kappa is known and nothing is divided by a number that may
//! become zero. A block that is no such product, or has another minimal polynomial, has no closed
//! form here.

use lie_symbolic::exact::{Budget, Fraction, Rational};

/// Larger blocks are left to the series.
const LARGEST: usize = 32;
/// Work allowed for the quotients of one block.
const WORK: u64 = 100_000;

/// Row, column and value of an entry of A.
pub type Entry = (usize, usize, Fraction);

/// A matrix of rational numbers: row, column and value, none zero.
pub type Sparse = Vec<(usize, usize, Rational)>;

/// A block of A that acts on its own rows alone.
#[derive(Clone, Debug)]
pub struct Block {
    /// The factor c, if it is not 1.
    pub factor: Option<Fraction>,
    /// R, R^2, … as far as the form needs them.
    pub powers: Vec<Sparse>,
    /// The form of its exponential.
    pub form: Form,
}

impl Block {
    /// The row of a block of one row.
    pub fn only_row(&self) -> Option<usize> {
        match self.powers.first().map(Vec::as_slice) {
            Some([(row, column, _)]) if row == column => Some(*row),
            _ => None,
        }
    }
}

/// How the exponential of a block is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// A power of R vanishes.
    Polynomial,
    /// `R^2 = a R`
    Exponential(Rational),
    /// `R^3 = kappa R`
    Quadratic(Rational),
}

/// The closed form of `exp(s A)`, if every block has one.
pub fn closed_form(entries: &[Entry]) -> Option<Vec<Block>> {
    let components = components(entries);
    components.iter().map(|entries| block(entries)).collect()
}

/// The entries of each block, in the order of their first rows.
fn components(entries: &[Entry]) -> Vec<Vec<Entry>> {
    let size = entries.iter().map(|(i, j, _)| 1 + i.max(j)).max();
    let mut leader: Vec<usize> = (0..size.unwrap_or(0)).collect();
    loop {
        let before = leader.clone();
        for (row, column, _) in entries {
            let least = leader[*row].min(leader[*column]);
            leader[*row] = least;
            leader[*column] = least;
        }
        if leader == before {
            break;
        }
    }
    let mut components: Vec<Vec<Entry>> = vec![Vec::new(); leader.len()];
    for entry in entries {
        components[leader[entry.0]].push(entry.clone());
    }
    components.retain(|component| !component.is_empty());
    components
}

fn block(entries: &[Entry]) -> Option<Block> {
    let mut places: Vec<usize> = entries.iter().flat_map(|(i, j, _)| [*i, *j]).collect();
    places.sort_unstable();
    places.dedup();
    if places.len() > LARGEST {
        return None;
    }
    let constant = entries
        .iter()
        .all(|(.., value)| value.as_constant().is_some());
    let factor = (!constant).then(|| entries[0].2.clone());
    let budget = Budget::new(WORK);
    let mut first = Sparse::new();
    for (row, column, value) in entries {
        let value = match &factor {
            None => value.as_constant()?,
            Some(factor) => value.div(factor, &budget).ok()??.as_constant()?,
        };
        first.push((*row, *column, value));
    }
    first.sort_unstable();
    let second = multiply(&first, &first);
    let form = match ratio(&second, &first) {
        Some(a) if !a.is_zero() => Some((Form::Exponential(a), 1)),
        _ => {
            let third = multiply(&second, &first);
            match ratio(&third, &first) {
                Some(kappa) if !kappa.is_zero() => Some((Form::Quadratic(kappa), 2)),
                _ => None,
            }
        }
    };
    let powers = vec![first, second];
    if let Some((form, needed)) = form {
        let powers = powers.into_iter().take(needed).collect();
        return Some(Block {
            factor,
            powers,
            form,
        });
    }
    let powers = nilpotent(powers, places.len())?;
    let form = Form::Polynomial;
    Some(Block {
        factor,
        powers,
        form,
    })
}

/// The powers before the first that vanishes.
fn nilpotent(mut powers: Vec<Sparse>, size: usize) -> Option<Vec<Sparse>> {
    while let Some(last) = powers.last() {
        if last.is_empty() {
            powers.pop();
            return Some(powers);
        }
        if powers.len() >= size {
            return None;
        }
        powers.push(multiply(last, &powers[0]));
    }
    None
}

fn multiply(left: &Sparse, right: &Sparse) -> Sparse {
    let mut product: std::collections::BTreeMap<(usize, usize), Rational> = Default::default();
    for (row, middle, a) in left {
        for (_, column, b) in right.iter().filter(|(row, ..)| row == middle) {
            let entry = product.entry((*row, *column)).or_insert(Rational::ZERO);
            *entry = &*entry + &(a * b);
        }
    }
    let entries = product.into_iter().filter(|(_, value)| !value.is_zero());
    entries.map(|((i, j), value)| (i, j, value)).collect()
}

/// The number by which one matrix is a multiple of another, which is not zero.
fn ratio(matrix: &Sparse, other: &Sparse) -> Option<Rational> {
    if matrix.is_empty() {
        return Some(Rational::ZERO);
    }
    let factor = &matrix[0].2 / &other[0].2;
    let same = matrix.len() == other.len()
        && matrix
            .iter()
            .zip(other)
            .all(|(a, b)| (a.0, a.1) == (b.0, b.1) && a.2 == &b.2 * &factor);
    same.then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(entries: &[(usize, usize, i64)]) -> Vec<Entry> {
        let entry = |&(i, j, value): &(usize, usize, i64)| (i, j, Rational::from(value).into());
        entries.iter().map(entry).collect()
    }

    fn forms(entries: &[Entry]) -> Option<Vec<Form>> {
        Some(closed_form(entries)?.into_iter().map(|b| b.form).collect())
    }

    #[test]
    fn forms_of_small_matrices() {
        let kappa = |value: i64| Form::Quadratic(Rational::from(value));
        let rotation = matrix(&[(1, 2, -2), (2, 1, 2)]);
        assert_eq!(forms(&rotation), Some(vec![kappa(-4)]));
        let boost = matrix(&[(0, 2, 3), (2, 0, 1)]);
        assert_eq!(forms(&boost), Some(vec![kappa(3)]));
        let shift = matrix(&[(0, 1, 1), (1, 2, 5)]);
        let blocks = closed_form(&shift).expect("nilpotent");
        assert_eq!(blocks[0].form, Form::Polynomial);
        assert_eq!(blocks[0].powers[1], vec![(0, 2, Rational::from(5))]);
        assert_eq!(blocks[0].powers.len(), 2);
        let stretch = matrix(&[(1, 1, 2)]);
        assert_eq!(forms(&stretch), Some(vec![Form::Exponential(2.into())]));
        let both = matrix(&[(1, 1, 2), (4, 4, -2)]);
        let exponential = |value: i64| Form::Exponential(Rational::from(value));
        assert_eq!(forms(&both), Some(vec![exponential(2), exponential(-2)]));
        // two frequencies, in two blocks
        let two = matrix(&[(0, 1, 1), (1, 0, -1), (2, 3, 3), (3, 2, -3)]);
        assert_eq!(forms(&two), Some(vec![kappa(-1), kappa(-9)]));
        // a Jordan block with an eigenvalue, and two eigenvalues in one block
        assert_eq!(forms(&matrix(&[(0, 0, 1), (0, 1, 1), (1, 1, 1)])), None);
        assert_eq!(forms(&matrix(&[(0, 0, 1), (0, 1, 1), (1, 1, 2)])), None);
    }

    #[test]
    fn a_parameter_is_a_factor_or_there_is_no_form() {
        let k = Fraction::variable(0);
        let rotation = vec![(0, 1, k.clone()), (1, 0, k.neg())];
        let blocks = closed_form(&rotation).expect("a rotation");
        let factor = blocks[0].factor.as_ref().expect("a factor");
        assert!(factor.equals(&k, &Budget::new(WORK)).expect("cheap"));
        assert_eq!(blocks[0].form, Form::Quadratic(Rational::MINUS_ONE));
        // the sign of k decides between sine and hyperbolic sine
        let undecided = vec![(0, 1, k), (1, 0, Rational::ONE.into())];
        assert!(closed_form(&undecided).is_none());
    }
}
