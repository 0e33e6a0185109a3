//! States at rest where the rank of the bracket drops, for people.

use lie_equilibria::{Equations, LowRank, Stability, c64};
use lie_in_process::words::counted;

use super::numbers::{digits, known_to, uncertainty};
use super::words::{reason, word};

/// A part of an eigenvalue below this part of the largest is round-off.
const SAME: f64 = 1e-6;

/// How many there are.
pub fn found(all: &[LowRank]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let families = all.iter().filter(|one| one.family > 0).count();
    let mut what = Vec::new();
    match all.len() - families {
        0 => {}
        1 => what.push("1 isolated equilibrium".to_owned()),
        count => what.push(format!("{count} isolated equilibria")),
    }
    match families {
        0 => {}
        1 => what.push("1 family".to_owned()),
        count => what.push(format!("{count} families")),
    }
    format!(
        "and where the rank of the bracket drops: {}, of which others may be missing\n",
        what.join(" and ")
    )
}

/// One of them.
pub fn block(number: usize, equations: &Equations, one: &LowRank) -> String {
    let sizes = equations.sizes;
    let generic = sizes.n - sizes.m;
    let drops = one.rank < generic;
    let kind = match (one.family, one.degenerate) {
        (0, false) => "isolated".to_owned(),
        (0, true) => "with a degenerate linearisation".to_owned(),
        (1, _) => "a family: one member of a curve of equilibria".to_owned(),
        (d, _) => format!("a family: one member of a set of {d} dimensions"),
    };
    let place = match (drops, equations.system.has_leaves) {
        (true, true) => format!(
            ", on a smaller leaf, of {}",
            counted(one.rank as u64, "dimension")
        ),
        (true, false) => ", where the rank of the bracket drops".to_owned(),
        (false, _) => ", where the gradients of the Casimirs depend on each other".to_owned(),
    };
    let state = equations.system.coordinates.iter().zip(&one.state);
    let error = if one.degenerate { one.error } else { 0.0 };
    let state = state.map(|(name, x)| format!("{name} = {}", known_to(*x, error)));
    let state: Vec<String> = state.collect();
    let mut text = format!(
        "\n{number}. {kind}{place}\n  state: {}{}\n",
        state.join(", "),
        uncertainty(error)
    );
    text.push_str(&format!("  energy: {}\n", digits(one.energy)));
    if drops {
        text.push_str(&format!(
            "  rank of the bracket: {}, and {generic} generically\n",
            one.rank
        ));
    }
    text.push_str(&format!(
        "  eigenvalues: {} on the level set\n",
        spectrum(&one.eigenvalues)
    ));
    let (stability, why) = (one.judgement.stability, &one.judgement.reason);
    let word = match (one.family > 0, stability) {
        (true, Stability::Stable) => "stable as a family",
        _ => word(stability),
    };
    let why = reason(why, one.family, "level set");
    text.push_str(&match stability {
        Stability::Undecided => format!("  stability: {word}: {why}\n"),
        _ => format!("  stability: {word} (numerical): {why}\n"),
    });
    text
}

/// Eigenvalues, which need not be in pairs of both signs: `-0.3, 0.1±2i, 0 twice`.
fn spectrum(values: &[c64]) -> String {
    let scale = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let is_small = |x: f64| x.abs() <= SAME * scale;
    let mut shown: Vec<(String, usize)> = Vec::new();
    for z in values.iter().filter(|z| z.im >= -SAME * scale) {
        let text = match (is_small(z.re), is_small(z.im)) {
            (true, true) => "0".to_owned(),
            (true, false) => format!("±{}i", digits(z.im)),
            (false, true) => digits(z.re),
            (false, false) => format!("{}±{}i", digits(z.re), digits(z.im)),
        };
        match shown.iter_mut().find(|(known, _)| *known == text) {
            Some((_, count)) => *count += 1,
            None => shown.push((text, 1)),
        }
    }
    let times = |(text, count): &(String, usize)| match count {
        1 => text.clone(),
        2 => format!("{text} twice"),
        count => format!("{text} {count} times"),
    };
    let shown: Vec<String> = shown.iter().map(times).collect();
    match shown.is_empty() {
        true => "none".to_owned(),
        false => shown.join(", "),
    }
}
