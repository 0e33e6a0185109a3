//! "Did you mean": the nearest of a few known words.

/// The candidate nearest to a misspelt word, `None` if none is near.
///
/// Near means: equal up to case, or at most a third of the letters wrong, where a wrong, missing,
/// additional or exchanged letter counts one. Of equally near candidates the first wins.
pub fn did_you_mean<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let letters: Vec<char> = word.chars().collect();
    // Nobody misspells a longer word; the distance is quadratic in the length.
    if letters.len() > 64 {
        return None;
    }
    let mut best = None;
    for candidate in candidates {
        let other: Vec<char> = candidate.chars().collect();
        let longest = letters.len().max(other.len());
        let allowed = (longest / 3).max(usize::from(longest >= 2));
        if letters.len().abs_diff(other.len()) > allowed || longest > 64 {
            continue;
        }
        let distance = if word.to_lowercase() == candidate.to_lowercase() {
            0
        } else {
            distance(&letters, &other)
        };
        if distance <= allowed && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Number of insertions, deletions, replacements and exchanges of neighbours between two words
/// (the restricted Damerau–Levenshtein distance).
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
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
    }

    #[test]
    fn far_words_are_not() {
        let known = ["hamiltonian", "state", "x"];
        assert_eq!(did_you_mean("energy", known), None);
        assert_eq!(did_you_mean("y", known), None);
        assert_eq!(did_you_mean("", known), None);
        assert_eq!(did_you_mean(&"x".repeat(1 << 20), known), None);
    }

    #[test]
    fn distances() {
        let distance = |a: &str, b: &str| {
            distance(
                &a.chars().collect::<Vec<_>>(),
                &b.chars().collect::<Vec<_>>(),
            )
        };
        assert_eq!(distance("ab", "ba"), 1);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "ωΠ"), 2);
    }
}
