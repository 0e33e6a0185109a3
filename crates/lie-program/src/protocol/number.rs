//! Numbers in JSON: to the last bit, and also those that JSON does not know, as `"NaN"`, `"inf"`, `"-inf"`.
//!
//! Fields name this module: `#[serde(with = "number")]`, of a vector `number::list`, of vectors `number::lists`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// A number that serializes whatever it is.
#[derive(Clone, Copy)]
struct Number(f64);

/// What it is written as.
#[derive(Deserialize, Serialize)]
#[serde(untagged)]
enum Written<'a> {
    Finite(f64),
    Other(Cow<'a, str>),
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(value) = *self;
        let written = if value.is_finite() {
            Written::Finite(value)
        } else {
            Written::Other(value.to_string().into())
        };
        written.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Written::deserialize(deserializer)? {
            Written::Finite(value) => Ok(Self(value)),
            Written::Other(text) => match text.parse::<f64>() {
                Ok(value) if !value.is_finite() => Ok(Self(value)),
                _ => Err(serde::de::Error::custom(format!(
                    "`{text}` is not a number"
                ))),
            },
        }
    }
}

/// Writes a number.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    Number(*value).serialize(serializer)
}

/// Reads a number.
///
/// # Errors
/// What stands there is no number.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Number::deserialize(deserializer).map(|Number(value)| value)
}

/// Vectors.
pub mod list {
    use super::{Deserialize, Deserializer, Number, Serializer};

    /// Writes a vector.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().copied().map(Number))
    }

    /// Reads a vector.
    ///
    /// # Errors
    /// What stands there is no vector of numbers.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        let numbers = Vec::<Number>::deserialize(deserializer)?;
        Ok(numbers.into_iter().map(|Number(value)| value).collect())
    }
}

/// Lists of vectors.
pub mod lists {
    use super::{Deserialize, Deserializer, Serialize, Serializer, list};

    /// A vector among others.
    #[derive(Deserialize, Serialize)]
    #[serde(transparent)]
    struct List(#[serde(with = "list")] Vec<f64>);

    /// Writes vectors.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(lists: &[Vec<f64>], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(lists.iter().cloned().map(List))
    }

    /// Reads vectors.
    ///
    /// # Errors
    /// What stands there is no list of vectors of numbers.
    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<Vec<f64>>, D::Error> {
        let lists = Vec::<List>::deserialize(deserializer)?;
        Ok(lists.into_iter().map(|List(list)| list).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::number;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, Deserialize, Serialize)]
    struct All {
        #[serde(with = "number")]
        one: f64,
        #[serde(with = "number::list")]
        list: Vec<f64>,
        #[serde(with = "number::lists")]
        lists: Vec<Vec<f64>>,
    }

    fn there_and_back(one: f64) -> All {
        let (list, lists) = (vec![one, 1.0], vec![vec![], vec![one]]);
        let text = serde_json::to_string(&All { one, list, lists }).expect("text");
        serde_json::from_str(&text).expect("numbers")
    }

    #[test]
    fn every_bit_comes_back() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let random = (0..20_000).map(|_| {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            f64::from_bits(bits)
        });
        let chosen = [
            0.0,
            -0.0,
            0.1 + 0.2,
            5e-324,
            f64::MAX,
            1e22,
            -1e23,
            9e15,
            1.0,
        ];
        for value in random.filter(|value| value.is_finite()).chain(chosen) {
            let back = there_and_back(value);
            let expected = value.to_bits();
            assert_eq!(back.one.to_bits(), expected, "{value:?}");
            assert_eq!(back.list[0].to_bits(), expected, "{value:?}");
            assert_eq!(back.lists[1][0].to_bits(), expected, "{value:?}");
        }
    }

    #[test]
    fn what_json_does_not_know_comes_back() {
        assert!(there_and_back(f64::NAN).lists[1][0].is_nan());
        for value in [f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(there_and_back(value).list, [value, 1.0]);
        }
        for wrong in [
            r#"{"one":"1","list":[],"lists":[]}"#,
            r#"{"one":null,"list":[],"lists":[]}"#,
        ] {
            assert!(serde_json::from_str::<All>(wrong).is_err(), "{wrong}");
        }
    }
}
