//! The table of the families, and the arguments in their names.

use super::{
    NamedAlgebra, bianchi, euclidean, linear, nilpotent, orthogonal, relativity, symplectic, toda,
    unitary,
};
use lie_symbolic::exact::Rational;

/// An argument of a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// A word, such as the type in `bianchi(VI, -1/4)`.
    Word(String),
    /// An exact number.
    Number(Rational),
}

/// An argument that names no algebra.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrong {
    /// Which argument.
    pub argument: usize,
    /// What is wrong with it.
    pub message: String,
    /// What to write.
    pub help: String,
}

/// An algebra whose name was read.
pub trait Constructor {
    /// Its dimension, which is known before anything is built.
    fn dimension(&self) -> usize;
    /// The algebra.
    fn build(&self) -> NamedAlgebra;
}

/// What the arguments of a name stand for.
type Read = fn(&[Argument]) -> Result<Box<dyn Constructor>, Wrong>;

/// Algebras of one name, distinguished by arguments.
pub struct Family {
    /// The names.
    pub names: &'static [&'static str],
    /// The arguments, for people.
    pub form: &'static str,
    /// The least and the largest number of arguments.
    pub arguments: (usize, usize),
    /// Reads arguments of which there are as many as there may be.
    pub read: Read,
}

/// Every family.
pub const FAMILIES: &[Family] = &[
    orthogonal::FAMILY,
    unitary::SPECIAL,
    unitary::ALL,
    linear::SPECIAL,
    linear::GENERAL,
    linear::AFFINE,
    symplectic::FAMILY,
    euclidean::FAMILY,
    relativity::GALILEI,
    relativity::POINCARE,
    nilpotent::HEISENBERG,
    nilpotent::OSCILLATOR,
    nilpotent::UPPER,
    nilpotent::ABELIAN,
    toda::FAMILY,
    bianchi::FAMILY,
];

/// The family of a name.
pub fn family(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().find(|family| family.names.contains(&name))
}

/// A whole argument of at least `least`, for `what`, such as `so(n)`.
pub fn size(arguments: &[Argument], index: usize, least: i64, what: &str) -> Result<usize, Wrong> {
    let wrong = |message: String| Wrong {
        argument: index,
        message,
        help: format!("write {what} with a whole number of at least {least}"),
    };
    let number = match arguments.get(index) {
        Some(Argument::Number(number)) => number,
        Some(Argument::Word(word)) => {
            let word = word.escape_debug();
            return Err(wrong(format!("`{word}` is not a size")));
        }
        None => return Err(wrong("a size is missing".into())),
    };
    if !number.is_integer() {
        return Err(wrong(format!("{number} is not a whole number")));
    }
    let size = number.to_integer().unwrap_or(if number.is_negative() {
        i64::MIN
    } else {
        i64::MAX
    });
    if size < least {
        return Err(wrong(format!("{number} is too small")));
    }
    Ok(usize::try_from(size).unwrap_or(usize::MAX))
}

/// The field, if it is written: `R`, as in `sl(2, R)`.
pub fn real(arguments: &[Argument], what: &str) -> Result<(), Wrong> {
    match arguments.get(1) {
        None => Ok(()),
        Some(Argument::Word(word)) if word == "R" => Ok(()),
        Some(other) => {
            let text = match other {
                Argument::Word(word) => word.escape_debug().to_string(),
                Argument::Number(number) => number.to_string(),
            };
            Err(Wrong {
                argument: 1,
                message: format!("`{text}` is not a field that is known here"),
                help: format!("write {what}, which is real"),
            })
        }
    }
}
