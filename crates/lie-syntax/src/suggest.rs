//! "Did you mean": the nearest of a few known words.

use std::collections::HashMap;
use std::sync::LazyLock;

use strsim::{damerau_levenshtein, jaro_winkler};

use crate::hints;

/// What is meant by the words of other tools, by these without what makes no difference.
static OF_OTHERS: LazyLock<HashMap<String, Vec<&str>>> = LazyLock::new(|| {
    let mut meant: HashMap<String, Vec<&str>> = HashMap::new();
    for (theirs, ours) in hints::table("words of other tools") {
        for word in theirs.split(' ') {
            meant.entry(plain(word)).or_default().push(ours);
        }
    }
    meant
});

/// A word without what makes no difference.
fn plain(word: &str) -> String {
    word.to_lowercase().replace(['-', '_'], "")
}

/// The word of the language, option or command that is meant by a word: what other tools call so, or
/// the nearest one. Underscores, hyphens and case make no difference to other tools' words.
pub fn meant<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str> + Clone,
) -> Option<&'a str> {
    let word_plain = plain(word);
    let called_so = OF_OTHERS.get(&word_plain).map_or(&[][..], Vec::as_slice);
    // A word that is ours but for its case or one exchange of letters is a slip, not another tool's.
    let same = candidates
        .clone()
        .into_iter()
        .find(|candidate| plain(candidate) == word_plain);
    same.or_else(|| {
        let mut ours = candidates.clone().into_iter();
        ours.find(|candidate| called_so.contains(candidate))
    })
    .or_else(|| did_you_mean(word, candidates))
}

/// The candidate nearest to a misspelt word, `None` if none is near.
///
/// Near means: equal up to case, or at most a third of the letters wrong by the distance of Damerau
/// and Levenshtein, where a wrong, missing, additional or exchanged letter counts one. Words of two
/// letters must begin alike. Of equally near candidates the one wins whose beginning agrees better
/// (Jaro and Winkler), then the first.
pub fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let letters = word.chars().count();
    // Nobody misspells a longer word; the distance is quadratic in the length.
    if letters > 64 {
        return None;
    }
    let lower = word.to_lowercase();
    let mut best: Option<((usize, f64), &str)> = None;
    for candidate in candidates {
        let other = candidate.chars().count();
        let longest = letters.max(other);
        let allowed = (longest / 3).max(usize::from(longest == 2));
        if letters.abs_diff(other) > allowed || longest > 64 {
            continue;
        }
        let distance = match candidate.to_lowercase() == lower {
            true => 0,
            false => damerau_levenshtein(word, candidate),
        };
        let begins_alike = word.chars().next() == candidate.chars().next();
        if distance > allowed || longest == 2 && distance > 0 && !begins_alike {
            continue;
        }
        let likeness = jaro_winkler(word, candidate);
        let nearer =
            |(least, most): (usize, f64)| distance < least || distance == least && likeness > most;
        if best.is_none_or(|(found, _)| nearer(found)) {
            best = Some(((distance, likeness), candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// The declared name that a misspelt one is meant to be. A name that differs in its number alone, `e4` from
/// `e1`, is another element of a series and no slip.
pub fn misspelt<'a>(name: &str, declared: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let others = declared.into_iter();
    did_you_mean(name, others.filter(|other| !differ_in_number(name, other)))
}

/// The declared names that differ from a name in its number alone, in order.
pub fn series<'a>(name: &str, declared: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let declared = declared.into_iter();
    declared
        .filter(|other| differ_in_number(name, other))
        .collect()
}

fn differ_in_number(name: &str, other: &str) -> bool {
    let numbered = |text: &str| text.contains(|c: char| c.is_ascii_digit());
    let letters = |text: &str| -> Vec<char> {
        let stem = text
            .chars()
            .map(|c| if c.is_ascii_digit() { '0' } else { c });
        let mut stem: Vec<char> = stem.collect();
        stem.dedup_by(|a, b| *a == '0' && *b == '0');
        stem
    };
    name != other && numbered(name) && numbered(other) && letters(name) == letters(other)
}

/// Names as text, the first dozen of them.
pub fn listed(names: &[&str]) -> String {
    let shown = names.iter().take(12).map(|name| format!("`{name}`"));
    let mut text = shown.collect::<Vec<_>>().join(", ");
    if names.len() > 12 {
        text.push_str(", …");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found() {
        let known = ["hamiltonian", "state", "basis", "Pi1", "x"];
        assert_eq!(did_you_mean("hamiltonain", known), Some("hamiltonian"));
        assert_eq!(did_you_mean("pi1", known), Some("Pi1"));
        assert_eq!(did_you_mean("X", known), Some("x"));
        assert_eq!(did_you_mean("sate", known), Some("state"));
        assert_eq!(did_you_mean("I4", ["x", "I1"]), Some("I1"));
        let commands = [
            "run", "check", "expand", "verify", "bench", "stress", "methods", "schema",
        ];
        assert_eq!(did_you_mean("chekc", commands), Some("check"));
        assert_eq!(did_you_mean("bnech", commands), Some("bench"));
        // Equally far from both: the beginning decides.
        assert_eq!(did_you_mean("tome", ["time", "tame", "home"]), Some("time"));
        assert_eq!(
            did_you_mean("omegaa2", ["zmegaa2", "omegaa1"]),
            Some("omegaa1")
        );
    }

    #[test]
    fn far_words_are_not() {
        let known = ["hamiltonian", "state", "x"];
        assert_eq!(did_you_mean("energy", known), None);
        assert_eq!(did_you_mean("y", known), None);
        assert_eq!(did_you_mean("", known), None);
        assert_eq!(did_you_mean("dt", ["at"]), None);
        assert_eq!(did_you_mean(&"x".repeat(1 << 20), known), None);
    }

    #[test]
    fn another_number_is_no_slip() {
        assert_eq!(misspelt("e4", ["e1", "e2", "e3"]), None);
        assert_eq!(misspelt("x10", ["x1", "x2"]), None);
        assert_eq!(misspelt("I12", ["I11", "mass"]), None);
        assert_eq!(misspelt("x1z", ["x2z", "x1y"]), Some("x1y"));
        assert_eq!(misspelt("omga1", ["omega1", "omega2"]), Some("omega1"));
        assert_eq!(misspelt("pi1", ["Pi1", "Pi2"]), Some("Pi1"));
        assert_eq!(series("e4", ["e1", "f1", "e2", "e"]), ["e1", "e2"]);
    }

    #[test]
    fn words_of_other_tools() {
        let run = ["method", "step", "until", "every", "at", "rtol", "atol"];
        let keys = [
            "name",
            "state",
            "parameters",
            "hamiltonian",
            "casimirs",
            "initial",
            "let",
        ];
        for (word, known, expected) in [
            ("dt", &run[..], Some("step")),
            ("t_end", &run, Some("until")),
            ("tEnd", &run, Some("until")),
            ("T-max", &run, Some("until")),
            ("relTol", &run, Some("rtol")),
            ("setp", &run, Some("step")),
            ("solver", &run, Some("method")),
            ("saveat", &run, Some("at")),
            ("x0", &keys, Some("initial")),
            ("params", &keys, Some("parameters")),
            ("H", &keys, Some("hamiltonian")),
            ("sate", &keys, Some("state")),
            ("colour", &keys, None),
        ] {
            assert_eq!(meant(word, known.iter().copied()), expected, "{word}");
        }
    }
}
