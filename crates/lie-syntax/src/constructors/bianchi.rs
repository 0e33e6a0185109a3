//! The Bianchi types, the Lie algebras of dimension 3, as Ellis and MacCallum write them (1969, doi:10.1007/BF01645908):
//! `[e1, e2] = n3 e3 + a e2`, `[e2, e3] = n1 e1`, `[e3, e1] = n2 e2 - a e3`.
//!
//! The parameter of VI and VII is their `h = a^2/(n2 n3)`. With `a = h`, `n2 = 1`, `n3 = h` it enters rationally, where the usual
//! `n3 = -1` or `1` asks for a square root. VI with h = 0 has `n2 = 1`, `n3 = -1`, VII with h = 0 has `n2 = n3 = 1`. III is VI with h = -1.

use super::family::{Argument, Constructor, Family, Wrong};
use super::matrix::{Entries, add, integer_matrix, unit};
use super::{Constants, Matrices, NamedAlgebra};
use crate::suggest::did_you_mean;
use lie_symbolic::exact::Rational;

pub const FAMILY: Family = Family {
    names: &["bianchi"],
    form: "bianchi(IX)`, or `bianchi(VI, h)` and `bianchi(VII, h)",
    arguments: (1, 2),
    read,
};

/// The types without a parameter, with a, n1, n2, n3.
const TYPES: &[(&str, [i64; 4])] = &[
    ("I", [0, 0, 0, 0]),
    ("II", [0, 1, 0, 0]),
    ("III", [-1, 0, 1, -1]),
    ("IV", [1, 0, 0, 1]),
    ("V", [1, 0, 0, 0]),
    ("VI0", [0, 0, 1, -1]),
    ("VII0", [0, 0, 1, 1]),
    ("VIII", [0, 1, 1, -1]),
    ("IX", [0, 1, 1, 1]),
];

struct Bianchi {
    a: Rational,
    n: [Rational; 3],
}

fn read(arguments: &[Argument]) -> Result<Box<dyn Constructor>, Wrong> {
    let wrong = |argument, message: String, help: String| Wrong {
        argument,
        message,
        help,
    };
    let name = match &arguments[0] {
        Argument::Word(name) => name.as_str(),
        Argument::Number(number) => {
            let help = "write the type in Roman numerals, such as `bianchi(IX)`";
            return Err(wrong(
                0,
                format!("{number} is no Bianchi type"),
                help.into(),
            ));
        }
    };
    let parameter = match arguments.get(1) {
        None => None,
        Some(Argument::Number(number)) => Some(number.clone()),
        Some(Argument::Word(word)) => {
            let message = format!("`{}` is not a rational number", word.escape_debug());
            let help = "write the parameter as an exact number, such as `bianchi(VI, -1/4)`";
            return Err(wrong(1, message, help.into()));
        }
    };
    if let Some(sign) = sign(name) {
        return with_parameter(name, parameter, sign);
    }
    let Some((_, numbers)) = TYPES.iter().find(|(known, _)| *known == name) else {
        let help = match did_you_mean(name, TYPES.iter().map(|(known, _)| *known)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "the types are I, II, III, IV, V, VI, VII, VIII and IX".into(),
        };
        return Err(wrong(
            0,
            format!("`{}` is no Bianchi type", name.escape_debug()),
            help,
        ));
    };
    if parameter.is_some() {
        let message = format!("the Bianchi type {name} has no parameter");
        return Err(wrong(1, message, format!("write `bianchi({name})`")));
    }
    let [a, n @ ..] = numbers.map(Rational::from);
    Ok(Box::new(Bianchi { a, n }))
}

/// The sign of the parameter of a type that has one.
fn sign(name: &str) -> Option<i64> {
    match name {
        "VI" => Some(-1),
        "VII" => Some(1),
        _ => None,
    }
}

fn with_parameter(
    name: &str,
    h: Option<Rational>,
    sign: i64,
) -> Result<Box<dyn Constructor>, Wrong> {
    let bound = if sign < 0 { "at most" } else { "at least" };
    let help = format!("write `bianchi({name}, h)` with a rational number h of {bound} zero");
    let Some(h) = h else {
        let message = format!("the Bianchi type {name} has a parameter h");
        return Err(Wrong {
            argument: 0,
            message,
            help,
        });
    };
    if !h.is_zero() && h.is_negative() != (sign < 0) {
        let message = format!("the parameter {h} of the Bianchi type {name} has the wrong sign");
        return Err(Wrong {
            argument: 1,
            message,
            help,
        });
    }
    let n3 = if h.is_zero() {
        Rational::from(sign)
    } else {
        h.clone()
    };
    Ok(Box::new(Bianchi {
        a: h,
        n: [Rational::ZERO, Rational::ONE, n3],
    }))
}

impl Constructor for Bianchi {
    fn dimension(&self) -> usize {
        3
    }

    fn build(&self) -> NamedAlgebra {
        let mut constants = Constants::new();
        let [n1, n2, n3] = &self.n;
        let brackets = [
            ((0, 1), [(2, n3.clone()), (1, self.a.clone())]),
            ((1, 2), [(0, n1.clone()), (1, Rational::ZERO)]),
            ((0, 2), [(1, -n2), (2, self.a.clone())]),
        ];
        for (pair, terms) in brackets {
            let terms = terms.into_iter().filter(|(_, value)| !value.is_zero());
            let terms: std::collections::BTreeMap<_, _> = terms.collect();
            if !terms.is_empty() {
                constants.insert(pair, terms);
            }
        }
        let mut named = NamedAlgebra {
            basis: ["e1", "e2", "e3"].map(str::to_owned).into(),
            state: ["x", "y", "z"].map(str::to_owned).into(),
            constants,
            representation: None,
        };
        named.representation = Some(self.matrices(&named));
        named
    }
}

impl Bianchi {
    /// Matrices of size 3, of I of size 4.
    fn matrices(&self, named: &NamedAlgebra) -> Matrices {
        let zeros = self.n.iter().filter(|n| n.is_zero()).count();
        let flat = self.a.is_zero();
        let (size, entries) = match zeros {
            // the centre is zero
            0 => return named.adjoint(),
            2 if flat && !self.n[0].is_zero() => (3, [unit(0, 2), unit(0, 1), unit(1, 2)].into()),
            3 if flat => (4, (0..3).map(|i| unit(i, 3)).collect()),
            _ => (3, self.affine()),
        };
        Matrices { size, entries }
    }

    /// e1 as the linear map `ad e1` of the plane of e2 and e3, and these as its translations.
    fn affine(&self) -> Vec<Entries> {
        let [_, n2, n3] = &self.n;
        let mut turn = Entries::new();
        for (row, column, value) in [(0, 0, &self.a), (1, 0, n3), (0, 1, &-n2), (1, 1, &self.a)] {
            add(&mut turn, (row, column), value);
        }
        vec![
            turn,
            integer_matrix(&[(0, 2, 1)]),
            integer_matrix(&[(1, 2, 1)]),
        ]
    }
}
