//! Numbers in the words of measurements.

use serde_json::{Value, json};

/// A number in few characters: `3.1e-15`, `0`, `2.98`.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.is_infinite() {
        "∞".to_owned()
    } else if value.is_nan() {
        "none".to_owned()
    } else if value.fract() == 0.0 && value.abs() < 1e6 {
        format!("{value}")
    } else if (0.01..100.0).contains(&value.abs()) {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}

/// So many of something: `1 step`, `2 steps`.
pub fn counted(count: u64, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// A number, or null for what is none.
pub fn number(value: f64) -> Value {
    match value.is_finite() {
        true => json!(value),
        false => Value::Null,
    }
}
