//! Numeric literals: exact decimals, and the products and suffixes that look like one.

use num_bigint::BigInt;

use super::names::{Names, arity};
use crate::diagnostic::Kind;
use lie_symbolic::exact::Rational;

/// The most digits that a literal may have.
const MAX_DIGITS: usize = 1000;
/// The largest power of ten in a literal; `f64` ends at 308.
const MAX_EXPONENT: i64 = 1000;

/// What is wrong with a literal.
#[derive(Debug)]
pub struct Mistake {
    /// Kind of the mistake.
    pub kind: Kind,
    /// What is wrong.
    pub message: String,
    /// What to write.
    pub help: String,
}

impl Mistake {
    fn new(kind: Kind, message: String, help: String) -> Self {
        Self {
            kind,
            message,
            help,
        }
    }
}

/// The exact value of a literal token.
///
/// `2e3` is 2000 unless `e3` is a declared name; then, as in `2x`, a `*` is missing. Where `e3` is
/// declared in another name space (a basis name, in the Hamiltonian), the literal is refused too:
/// reading a misplaced name as a power of ten would go unnoticed.
pub fn read(literal: &str, names: &Names) -> Result<Rational, Mistake> {
    let bytes = literal.as_bytes();
    let is_name = |name: &str| names.knows(name) || arity(name).is_some();
    if bytes[0] == b'0'
        && matches!(bytes.get(1), Some(b'x' | b'o' | b'b'))
        && bytes.get(2).is_some_and(u8::is_ascii_hexdigit)
    {
        return Err(Mistake::new(
            Kind::Number,
            format!("`{literal}` is not a decimal number"),
            "numbers are decimal; a literal has no prefix `0x`, `0o` or `0b`".into(),
        ));
    }
    let mantissa = literal
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(literal.len());
    let (factor, tail) = literal.split_at(mantissa);
    if !tail.is_empty() && is_name(tail) {
        return Err(product(literal, factor, tail));
    }
    if names.declares_elsewhere(tail)
        && let Ok(value) = decimal(literal)
    {
        return Err(Mistake::new(
            Kind::Syntax,
            format!(
                "`{literal}` can be read as a product with `{tail}`, a name that is declared but cannot stand here"
            ),
            format!("write `{}` if the number is meant", plain(&value, literal)),
        ));
    }
    let exponent = exponent_length(tail);
    let suffix = &tail[exponent..];
    if suffix.is_empty() {
        return decimal(literal);
    }
    let value = &literal[..literal.len() - suffix.len()];
    if is_name(suffix) {
        return Err(product(literal, value, suffix));
    }
    if suffix.contains('_') && suffix.chars().all(|c| c == '_' || c.is_ascii_digit())
        || tail.starts_with('_')
    {
        let clean: String = literal.chars().filter(|c| *c != '_').collect();
        return Err(Mistake::new(
            Kind::Number,
            format!("`{literal}` contains an underscore"),
            format!("write `{clean}`"),
        ));
    }
    Err(with_suffix(literal, value, suffix))
}

/// A factor and a name without a `*` between them.
fn product(literal: &str, factor: &str, name: &str) -> Mistake {
    let mut help = format!("write `{factor}*{name}`");
    if let Ok(value) = decimal(literal) {
        help.push_str(&format!(
            ", or `{}` if the number is meant",
            plain(&value, literal)
        ));
    }
    let message = format!("`*` is missing between `{factor}` and `{name}`, which is a name");
    Mistake::new(Kind::Syntax, message, help)
}

fn with_suffix(literal: &str, value: &str, suffix: &str) -> Mistake {
    let is_type =
        suffix.starts_with(['f', 'i', 'u']) && suffix[1..].bytes().all(|b| b.is_ascii_digit());
    let help = if is_type {
        format!("write `{value}`; numbers are exact and have no type")
    } else {
        format!("if `{suffix}` is meant as a name, declare it and write `{value}*{suffix}`")
    };
    let message = format!("`{literal}` is a number with the suffix `{suffix}`");
    Mistake::new(Kind::Number, message, help)
}

/// `2000` for `2e3`, or the literal with its exponent marked where that would be long.
fn plain(value: &Rational, literal: &str) -> String {
    match value.to_integer() {
        Some(integer) => integer.to_string(),
        None => {
            let at = literal.find(['e', 'E']).unwrap_or(literal.len());
            format!(
                "{}*10^{}",
                &literal[..at],
                literal.get(at + 1..).unwrap_or("0")
            )
        }
    }
}

/// Length of `e5`, `E-5` at the beginning of the text, zero where there is none.
fn exponent_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    if !matches!(bytes.first(), Some(b'e' | b'E')) {
        return 0;
    }
    let sign = usize::from(matches!(bytes.get(1), Some(b'+' | b'-')));
    let digits = bytes[1 + sign..]
        .iter()
        .take_while(|b| b.is_ascii_digit())
        .count();
    if digits == 0 { 0 } else { 1 + sign + digits }
}

/// The exact value of a decimal literal, optionally signed: `0.1` is 1/10.
pub fn decimal(literal: &str) -> Result<Rational, Mistake> {
    let malformed = || {
        Mistake::new(
            Kind::Number,
            format!("`{}` is not a number", shorten(literal)),
            "numbers are written like 2, 0.5 or 1.5e-3, exact quotients like 1/3".into(),
        )
    };
    let too_large = |what: &str| {
        Mistake::new(
            Kind::Limit,
            format!("`{}` has {what}", shorten(literal)),
            format!(
                "a literal has at most {MAX_DIGITS} digits and a power of ten between -{MAX_EXPONENT} and {MAX_EXPONENT}"
            ),
        )
    };
    let (negative, unsigned) = match literal.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, literal),
    };
    let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let exponent_digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    if whole.is_empty()
        || exponent_digits.is_empty()
        || ![whole, fraction, exponent_digits]
            .into_iter()
            .all(is_digits)
    {
        return Err(malformed());
    }
    if whole.len() + fraction.len() > MAX_DIGITS {
        return Err(too_large("too many digits"));
    }
    // Both limits stand before any number is built: `1e999999999` must not allocate.
    let exponent: i64 = exponent
        .parse()
        .map_err(|_| too_large("too large an exponent"))?;
    if exponent.unsigned_abs() > MAX_EXPONENT.unsigned_abs() {
        return Err(too_large("too large an exponent"));
    }
    let digits: BigInt = format!("{whole}{fraction}")
        .parse()
        .map_err(|_| malformed())?;
    let digits = if negative { -digits } else { digits };
    let power = exponent - fraction.len() as i64;
    let ten = BigInt::from(10).pow(power.unsigned_abs() as u32);
    let value = if power >= 0 {
        Rational::from_big(digits * ten, 1.into())
    } else {
        Rational::from_big(digits, ten)
    };
    value.ok_or_else(malformed)
}

/// The beginning of a long literal.
fn shorten(literal: &str) -> String {
    match literal.char_indices().nth(30) {
        Some((at, _)) => format!("{}…", &literal[..at]),
        None => literal.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(literal: &str) -> String {
        read(literal, &Names::default()).map_or_else(|m| m.kind.to_string(), |v| v.to_string())
    }

    #[test]
    fn decimals_are_exact() {
        for (literal, expected) in [
            ("0.1", "1/10"),
            ("1.5e-3", "3/2000"),
            ("2e3", "2000"),
            ("2E+3", "2000"),
            ("1.", "1"),
            ("007", "7"),
            ("0.30000000000000004", "7500000000000001/25000000000000000"),
        ] {
            assert_eq!(value(literal), expected, "{literal}");
        }
        assert_eq!(decimal("-1.25").unwrap().to_string(), "-5/4");
        assert!(decimal("--1").is_err() && decimal("").is_err() && decimal("1e").is_err());
    }

    #[test]
    fn malformed_literals_are_number_errors() {
        for literal in [
            "1f64", "1_000", "1_f64", "1.5_0", "0x1", "0xF", "0o7", "0b1", "2u8", "1e3_0", "2foo",
        ] {
            assert_eq!(value(literal), "number", "{literal}");
        }
    }

    #[test]
    fn names_make_products() {
        let names: Names = ["x", "x1", "e3", "f64", "Δ", "e3x"].into_iter().collect();
        let help = |literal: &str| {
            let mistake = read(literal, &names).unwrap_err();
            assert_eq!(mistake.kind, Kind::Syntax, "{literal}");
            mistake.help
        };
        assert_eq!(help("2x"), "write `2*x`");
        assert_eq!(
            help("2e3"),
            "write `2*e3`, or `2000` if the number is meant"
        );
        assert_eq!(help("2.5Δ"), "write `2.5*Δ`");
        assert_eq!(help("2e3x"), "write `2*e3x`");
        assert_eq!(help("2e4x"), "write `2e4*x`");
        assert_eq!(help("1f64"), "write `1*f64`");
        assert_eq!(help("2pi"), "write `2*pi`");
        assert_eq!(help("2sin"), "write `2*sin`");
        assert_eq!(read("0x1", &names).unwrap_err().kind, Kind::Number);
        assert_eq!(help("0x"), "write `0*x`");
        let basis = Names::default().with_elsewhere(["e3", "x"]);
        let refused = read("2e3", &basis).unwrap_err();
        assert_eq!(
            (refused.kind, refused.help.as_str()),
            (Kind::Syntax, "write `2000` if the number is meant")
        );
        assert_eq!(read("2x", &basis).unwrap_err().kind, Kind::Number);
        assert_eq!(read("2e4", &names).unwrap().to_string(), "20000");
    }

    #[test]
    fn hostile_literals_are_refused_before_they_are_built() {
        for literal in [
            "1e999999999",
            "1e-999999999",
            "1e99999999999999999999",
            &"9".repeat(2000),
        ] {
            assert_eq!(value(literal), "limit");
        }
        assert_eq!(value("1e-1000").len(), 1003);
    }
}
