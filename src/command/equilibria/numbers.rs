//! Numbers in the digits that are known.

/// A number in seven digits.
pub fn digits(value: f64) -> String {
    let value = value + 0.0;
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => {
            let places = (6 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{value:.places$}");
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => text,
            }
        }
        _ => format!("{value:.6e}"),
    }
}

/// A number in the digits that an error leaves of it.
pub fn known_to(value: f64, error: f64) -> String {
    let places = -error.log10().floor();
    match error > 0.0 && (0.0..17.0).contains(&places) {
        true if value != 0.0 => format!("{:.*}", places as usize, value),
        _ => digits(value),
    }
}

/// What is said of an error behind numbers.
pub fn uncertainty(error: f64) -> String {
    match error > 0.0 {
        true => format!(", each up to ± {error:.0e}"),
        false => String::new(),
    }
}
