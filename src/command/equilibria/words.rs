//! What was found, for people.

use lie_equilibria::{ChangeKind, Equations, Equilibrium, Paths, Presence, Reason, Stability, c64};
use lie_in_process::words::counted;

use super::numbers::{digits, known_to, uncertainty};
use super::{Leaf, Range, low_rank};
use crate::command::fold::folded;

/// Eigenvalues that differ by less than this part of the largest are shown as one.
const SAME: f64 = 1e-6;

/// The word of a stability, in tables and JSON.
pub fn word(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Spectral => "spectrally stable",
        Stability::Unstable => "unstable",
        Stability::Undecided => "not decided",
    }
}

/// The word of a change.
pub fn change(kind: ChangeKind) -> &'static str {
    match kind {
        ChangeKind::Fold => "fold",
        ChangeKind::Meeting => "branches meet",
        ChangeKind::Zero => "an eigenvalue passes zero",
        ChangeKind::Collision => "eigenvalues meet",
        ChangeKind::Other => "stability changes",
    }
}

/// The equilibria of a leaf.
pub fn leaf(name: &str, equations: &Equations, leaf: &Leaf) -> String {
    let system = &equations.system;
    let (n, m) = (equations.sizes.n, equations.sizes.m);
    let levels = system.casimirs.iter().zip(&leaf.levels);
    let levels = levels.map(|(casimir, level)| format!("{} = {}", casimir.name, digits(*level)));
    let levels: Vec<String> = levels.collect();
    let mut text = format!(
        "{name}: relative equilibria on the {} of {} dimensions{}{}{}\n",
        set(equations),
        n - m,
        if m > 0 { " with " } else { "" },
        levels.join(", "),
        match system.has_leaves {
            true => "",
            false => " of an almost-Poisson bracket, which has no leaves",
        }
    );
    text.push_str(&searched(set(equations), leaf));
    for (number, equilibrium) in leaf.equilibria.iter().enumerate() {
        text.push_str(&block(number + 1, equations, equilibrium));
    }
    let before = leaf.equilibria.len();
    for (number, one) in leaf.low_rank.iter().enumerate() {
        text.push_str(&low_rank::block(before + number + 1, equations, one));
    }
    folded(&text)
}

/// What the values of Casimirs leave: a leaf, where there are leaves.
pub fn set(equations: &Equations) -> &'static str {
    match equations.system.has_leaves {
        true => "leaf",
        false => "level set",
    }
}

/// How much was searched, and what that means.
fn searched(set: &str, leaf: &Leaf) -> String {
    let (found, equilibria) = (&leaf.found, &leaf.equilibria);
    let isolated = equilibria.iter().filter(|one| one.family == 0).count();
    let mut what = vec![counted(isolated as u64, "isolated equilibrium")];
    if isolated != 1 {
        what[0] = format!("{isolated} isolated equilibria");
    }
    let families = equilibria.len() - isolated;
    match families {
        0 => {}
        1 => what.push("1 family".to_owned()),
        _ => what.push(format!("{families} families")),
    }
    let mut text = format!(
        "found: {} from {}, {} of which ended on the {set}\n",
        what.join(" and "),
        counted(found.starts as u64, "start"),
        found.converged
    );
    text.push_str(&match found.paths {
        None => "searched, not proven to be all: the equations are no polynomials, have too many complex solutions to follow all, or the scale of the initial state is not that of the leaf\n".to_owned(),
        Some(paths) => {
            let sure = equilibria.iter().filter(|one| one.family == 0 && !one.degenerate);
            complete(paths, [isolated, sure.count()], !leaf.low_rank.is_empty())
        }
    });
    let others = equilibria
        .iter()
        .filter(|one| one.on_other_leaf == Some(true));
    match others.count() {
        0 => {}
        1 => text.push_str("1 of them is on another leaf with the same values of the Casimirs than the initial state\n"),
        count => text.push_str(&format!("{count} of them are on other leaves with the same values of the Casimirs than the initial state\n")),
    }
    text.push_str(&low_rank::found(&leaf.low_rank));
    text
}

/// What the paths say of completeness.
fn complete(paths: Paths, [isolated, sure]: [usize; 2], drops: bool) -> String {
    let mut parts = vec![format!(
        "{} at isolated solutions, {} of them real",
        paths.isolated, paths.real
    )];
    if paths.singular > 0 {
        parts.push(format!(
            "{} at multiple ones or in families",
            paths.singular
        ));
    }
    if paths.infinite > 0 {
        parts.push(format!("{} at infinity", paths.infinite));
    }
    let ends = format!(
        "{} in the complex plane end: {}",
        counted(paths.all as u64, "path"),
        parts.join(", ")
    );
    match (paths.lost, paths.real <= isolated) {
        (0, true) if sure > paths.real => format!(
            "{ends}: some equilibria are at the end of none, since their scales differ, and others may be missing\n"
        ),
        (0, true) if paths.all > 0 && paths.infinite == paths.all => format!(
            "{ends}: by these numbers there is none within a million times the scale of the state\n"
        ),
        (0, true) => format!("{ends}: by these numbers no isolated equilibrium is missing\n"),
        (0, false) if drops => {
            format!("{ends}: some of them are where the rank of the bracket drops\n")
        }
        (0, false) => format!("{ends}: some of them are no equilibria on the leaf\n"),
        (lost, _) => format!(
            "{ends}; {lost} were lost, so that an equilibrium may be missing: try another `--seed`\n"
        ),
    }
}

fn block(number: usize, equations: &Equations, one: &Equilibrium) -> String {
    let system = &equations.system;
    let presence = match &one.presence {
        Presence::Rational(_) => ", proven to be there: its coordinates are rational",
        Presence::Enclosed => ", proven to be there, alone in a box of 27 digits",
        Presence::Numerical => "",
    };
    let kind = match (one.family, one.degenerate) {
        (0, false) => "isolated".to_owned(),
        (0, true) => "with a degenerate linearisation".to_owned(),
        (1, _) => "a family: one member of a curve of equilibria".to_owned(),
        (d, _) => format!("a family: one member of a set of {d} dimensions"),
    };
    let elsewhere = match one.on_other_leaf {
        Some(true) => ", on another leaf than the initial state",
        _ => "",
    };
    let pairs = |names: &mut dyn Iterator<Item = &String>, values: &[f64]| -> String {
        let pairs = names.zip(values);
        let pairs: Vec<String> = pairs
            .map(|(name, value)| format!("{name} = {}", known_to(*value, one.error)))
            .collect();
        pairs.join(", ")
    };
    let mut text = format!("\n{number}. {kind}{elsewhere}{presence}\n");
    text.push_str(&format!(
        "  state: {}{}\n",
        pairs(&mut system.coordinates.iter(), &one.state),
        uncertainty(one.error)
    ));
    text.push_str(&format!("  energy: {}\n", digits(one.energy)));
    if !one.multipliers.is_empty() {
        let mut names = system.casimirs.iter().map(|casimir| &casimir.name);
        text.push_str(&format!(
            "  multipliers: {}\n",
            pairs(&mut names, &one.multipliers)
        ));
    }
    text.push_str(&format!(
        "  eigenvalues: {}{}\n",
        eigenvalues(
            &one.linearisation.eigenvalues,
            one.linearisation.zeros,
            set(equations)
        ),
        match one.error > 0.0 {
            true => ", those near zero uncertain",
            false => "",
        }
    ));
    let judgement = &one.judgement;
    let word = match (one.family > 0, judgement.stability) {
        (true, Stability::Stable) => "stable as a family",
        (_, stability) => word(stability),
    };
    let certainty = if judgement.proven {
        "proven"
    } else {
        "numerical"
    };
    let why = reason(&judgement.reason, one.family, set(equations));
    text.push_str(&match judgement.stability {
        Stability::Undecided => format!("  stability: {word}: {why}\n"),
        _ => format!("  stability: {word} ({certainty}): {why}\n"),
    });
    text
}

/// Eigenvalues in pairs: `±1.5i, ±0.3, 0 twice`.
pub fn eigenvalues(values: &[c64], zeros: usize, set: &str) -> String {
    let scale = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let is_small = |x: f64| x.abs() <= SAME * scale;
    let mut shown: Vec<(String, usize)> = Vec::new();
    for z in values {
        let text = match (is_small(z.re), is_small(z.im)) {
            (true, true) => "0".to_owned(),
            (true, false) if z.im > 0.0 => format!("±{}i", digits(z.im)),
            (false, true) if z.re > 0.0 => format!("±{}", digits(z.re)),
            (false, false) if z.re > 0.0 && z.im > 0.0 => {
                format!("±{}±{}i", digits(z.re), digits(z.im))
            }
            _ => continue,
        };
        match shown.iter_mut().find(|(known, _)| *known == text) {
            Some((_, count)) => *count += 1,
            None => shown.push((text, 1)),
        }
    }
    let times = |count: usize| match count {
        1 => String::new(),
        2 => " twice".to_owned(),
        count => format!(" {count} times"),
    };
    let shown: Vec<String> = shown
        .iter()
        .map(|(text, count)| format!("{text}{}", times(*count)))
        .collect();
    let own = match shown.is_empty() {
        true => "none".to_owned(),
        false => shown.join(", "),
    };
    match zeros {
        0 => format!("{own} on the {set}"),
        zeros => format!("{own} on the {set}; 0{} for the Casimirs", times(zeros)),
    }
}

/// Why.
pub fn reason(reason: &Reason, family: usize, set: &str) -> String {
    match reason {
        Reason::Definite { minimum } => {
            let what = if *minimum { "minimum" } else { "maximum" };
            match family {
                0 => format!("H has a strict {what} on the {set}"),
                _ => format!("H has a {what} on the {set} along the family, and is definite across it"),
            }
        }
        Reason::Integrals { energy, stationary, held } => {
            let mut text = String::new();
            if stationary.iter().any(|(_, weight)| *weight != 0.0) {
                let scale = energy.abs().max(f64::MIN_POSITIVE);
                let terms = stationary.iter().map(|(name, weight)| {
                    let weight = weight / scale;
                    let sign = if weight < 0.0 { "-" } else { "+" };
                    format!(" {sign} {} ({name})", digits(weight.abs()))
                });
                let sign = if *energy < 0.0 { "-H" } else { "H" };
                text.push_str(&format!("{sign}{} has a minimum on the {set}", terms.collect::<String>()));
            } else {
                text.push_str(&format!("H is definite on the {set}"));
            }
            if !held.is_empty() {
                text.push_str(&format!(" where {} {} held", held.join(", "), if held.len() == 1 { "is" } else { "are" }));
            }
            if family > 0 {
                text.push_str(", but along the family");
            }
            text
        }
        Reason::Right => "an eigenvalue has a positive real part".to_owned(),
        Reason::Attracting if family == 0 => "all eigenvalues have negative real parts".to_owned(),
        Reason::Attracting => {
            "all eigenvalues but those along the family have negative real parts: motion nearby tends to it".to_owned()
        }
        Reason::NoneRight => {
            "no eigenvalue has a positive real part, and some are imaginary or zero, which decides nothing".to_owned()
        }
        Reason::Degenerate => {
            "the linearisation is degenerate, as far as double precision tells, and decides nothing".to_owned()
        }
        Reason::Imaginary { simple: true } => {
            "all eigenvalues are imaginary and different, and H is indefinite: nonlinear stability is not decided".to_owned()
        }
        Reason::Imaginary { simple: false } => {
            "all eigenvalues are imaginary, some of them equal or zero, which decides nothing".to_owned()
        }
    }
}

/// The branches over a range.
pub fn range(name: &str, equations: &Equations, range: &Range) -> String {
    let traced = &range.traced;
    let (first, last) = (range.values[0], range.values[range.values.len() - 1]);
    let nodes: Vec<String> = traced.nodes.iter().map(|node| digits(*node)).collect();
    let mut text = format!(
        "{name}: {} of relative equilibria for {} from {} to {}\nsearched at {} = {}, with {} each: a branch that lies between them alone may be missing\n",
        match traced.branches.len() {
            1 => "1 branch".to_owned(),
            count => format!("{count} branches"),
        },
        range.name,
        digits(first),
        digits(last),
        range.name,
        nodes.join(", "),
        counted(traced.starts as u64, "start"),
    );
    for (number, branch) in traced.branches.iter().enumerate() {
        let kind = match branch.family {
            0 => String::new(),
            d => format!(
                ", each of which is a family of {}",
                counted(d as u64, "dimension")
            ),
        };
        let ends = [branch.points.first(), branch.points.last()];
        let ends = ends.map(|end| end.map_or(f64::NAN, |point| point.parameter));
        text.push_str(&format!(
            "\n{}. from {} = {} to {}{kind}\n",
            number + 1,
            range.name,
            digits(ends[0]),
            digits(ends[1])
        ));
        for end in ends_of(branch) {
            let state = equations.system.coordinates.iter().zip(&end.y);
            let state = state.map(|(name, x)| format!("{name} = {}", digits(*x)));
            let state: Vec<String> = state.collect();
            text.push_str(&format!(
                "  at {} = {}: {}, energy {}, {}\n",
                range.name,
                digits(end.parameter),
                state.join(", "),
                digits(end.energy),
                match end.threshold {
                    None => word(end.stability).to_owned(),
                    Some(kind) => format!("at a threshold and not decided: {}", change(kind)),
                }
            ));
        }
        for found in &branch.changes {
            let [from, to] = found.stability.map(word);
            let stability = if from == to {
                from.to_owned()
            } else {
                format!("{from} to {to}")
            };
            text.push_str(&format!(
                "  {} = {} ± {:.0e}: {}, {stability}\n",
                range.name,
                found.parameter,
                found.error.max(1e-17),
                change(found.kind),
            ));
        }
    }
    folded(&text)
}

fn ends_of(branch: &lie_equilibria::Branch) -> Vec<&lie_equilibria::Point> {
    match branch.points.as_slice() {
        [] => Vec::new(),
        [one] => vec![one],
        [first, .., last] => vec![first, last],
    }
}
