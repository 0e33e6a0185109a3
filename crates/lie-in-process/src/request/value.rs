//! Values of options: text that may be an exact constant, and numbers.

use std::convert::Infallible;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// The value of an option.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A word, an exact constant such as `1/7`, or several of them between commas.
    Text(String),
    /// Several values.
    List(Vec<Value>),
}

impl FromStr for Value {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(Self::Text(text.to_owned()))
    }
}

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Parameter {
    /// `NAME=VALUE`, or `NAME=FROM:TO:COUNT`.
    Written(String),
    /// Name and value.
    Set(String, Value),
}

impl FromStr for Parameter {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(Self::Written(text.to_owned()))
    }
}
