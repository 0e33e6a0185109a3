//! Numbers in the words of measurements.

use lie_runtime::lattice::{AXES, shown};
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

/// Sizes along axes, `2 x 3 x 4`.
pub fn by(sizes: &[usize]) -> String {
    let sizes: Vec<String> = sizes.iter().map(usize::to_string).collect();
    sizes.join(" x ")
}

/// So many sites, `8 sites` or `2 x 4 sites`.
pub fn sites(sizes: [usize; AXES]) -> String {
    match shown(&sizes) {
        [columns] => counted(*columns as u64, "site"),
        axes => format!("{} sites", by(axes)),
    }
}

/// A number with its error: `0.1284 ± 0.0023`, `0.50000000000 ± 1.2e-10`.
pub fn with_error(value: f64, error: f64) -> String {
    let value = with_digits(value, error);
    match error {
        error if !error.is_finite() => value,
        error if error < 1e-4 => format!("{value} ± {error:.1e}"),
        error => format!("{value} ± {}", with_digits(error, error)),
    }
}

/// A number with as many digits as its error leaves.
pub fn with_digits(value: f64, error: f64) -> String {
    let digits = match error.is_finite() {
        true if error > 0.0 => (1.0 - error.log10().floor()).clamp(0.0, 15.0) as usize,
        true => 15,
        false => 6,
    };
    format!("{value:.digits$}")
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
