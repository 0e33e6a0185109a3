//! What `lie stress` says of the growth of round-off.

use lie_measure::stress::Growth;

use super::table::short;

/// Whether some state moved further than round-off does.
pub fn is_lost(growth: &Growth) -> bool {
    !matches!(growth.ratio, ratio if ratio <= 1.0)
}

/// `length2 N^0.95 ± 0.03`.
pub fn cell(growth: &Growth) -> String {
    format!(
        "{} N^{:.2} ± {:.2}",
        growth.invariant, growth.exponent, growth.error
    )
}

/// What happened, in one line.
pub fn text(growth: &Growth) -> String {
    format!(
        "{}, {} states near the initial one, step {}: {} beyond {} times its round-off bound after {} steps",
        growth.method,
        growth.states,
        short(growth.step),
        growth.invariant,
        short(growth.ratio),
        growth.to
    )
}

/// A line of the table of experiments: the exponent stands as the value.
pub fn csv(growth: &Growth) -> String {
    let outcome = if is_lost(growth) { "lost" } else { "kept" };
    let (energy, casimir) = match growth.invariant.as_str() {
        "energy" => (growth.end, f64::NAN),
        _ => (f64::NAN, growth.end),
    };
    format!(
        "{},growth,{},{:?},{:?},{outcome},{},NaN,{energy:?},NaN,{casimir:?},NaN,{:?},standard error {:?} from {} steps on; \
         {} states; largest {:?}\n",
        growth.method,
        growth.invariant,
        growth.exponent,
        growth.step,
        growth.to,
        growth.ratio,
        growth.error,
        growth.from,
        growth.states,
        growth.largest
    )
}

/// What the column says.
pub fn legend(growths: &[Growth]) -> String {
    let Some(growth) = growths.iter().max_by_key(|growth| growth.states) else {
        return String::new();
    };
    format!(
        "round-off: the claimed invariant that moves most, root of the mean square over {} states near the initial one against \
         the steps N, {} to {};\n  0.5 is a random walk, 1 a bias\n",
        growth.states, growth.from, growth.to
    )
}
