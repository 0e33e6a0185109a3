//! Names of real simple algebras by dimension and signature of the Killing form.
//!
//! A real form of a complex simple algebra is determined by the type of the latter and the number of positive
//! squares in its Killing form, the dimension of a noncompact complement (Helgason, Differential Geometry, Lie Groups, and
//! Symmetric Spaces, chapter X, table V). The type is determined by the dimension, except for B_n and C_n, n >= 3, which `series` tells
//! apart, and E_6, which is neither of those of its dimension; the coincidences of small rank are named once. A name is given where
//! no other form has both numbers.

use super::series::Series;

/// The name of a real form of dimension `dimension` with so many positive squares, if there is only one; `possible` are
/// the types that B_n and C_n leave open.
pub fn real_form(dimension: usize, positive: usize, possible: &[Series]) -> Option<String> {
    let forms = forms(dimension, possible);
    let mut fitting = forms
        .into_iter()
        .filter(|(_, squares)| *squares == positive);
    let (name, _) = fitting.next()?;
    fitting.next().is_none().then_some(name)
}

/// The n >= 3 of which B_n and C_n have this dimension.
pub fn ambiguous(dimension: usize) -> Option<usize> {
    (3..=dimension).find(|n| n * (2 * n + 1) == dimension)
}

/// The real forms of a dimension, with the positive squares of each.
fn forms(dimension: usize, possible: &[Series]) -> Vec<(String, usize)> {
    let mut all = Vec::new();
    let rank = |of: &dyn Fn(usize) -> usize| (1..=dimension).find(|&n| of(n) == dimension);
    if let Some(n) = rank(&|n| n * (n + 2)) {
        special(n + 1, &mut all);
    }
    if dimension == 10 {
        orthogonal(5, &mut all);
    }
    if let Some(n) = ambiguous(dimension) {
        for series in possible {
            match series {
                Series::Orthogonal => orthogonal(2 * n + 1, &mut all),
                Series::Symplectic => symplectic(n, &mut all),
            }
        }
    }
    if let Some(n) = rank(&|n| n * (2 * n).saturating_sub(1)).filter(|n| *n >= 4) {
        orthogonal(2 * n, &mut all);
        // so*(8) is so(6,2)
        if n > 4 {
            all.push((format!("so*({})", 2 * n), n * (n - 1)));
        }
    }
    let exceptional: &[(&str, usize)] = match dimension {
        14 => &[("g2", 0), ("g2(2)", 8)],
        52 => &[("f4", 0), ("f4(-20)", 16), ("f4(4)", 28)],
        78 => &[
            ("e6", 0),
            ("e6(-26)", 26),
            ("e6(-14)", 32),
            ("e6(2)", 40),
            ("e6(6)", 42),
        ],
        133 => &[("e7", 0), ("e7(-25)", 54), ("e7(-5)", 64), ("e7(7)", 70)],
        248 => &[("e8", 0), ("e8(-24)", 112), ("e8(8)", 128)],
        _ => &[],
    };
    all.extend(
        exceptional
            .iter()
            .map(|(name, squares)| ((*name).to_owned(), *squares)),
    );
    all
}

/// The forms of sl(n).
fn special(n: usize, all: &mut Vec<(String, usize)>) {
    if n == 2 {
        all.extend([("so(3)".to_owned(), 0), ("sl(2,R)".to_owned(), 2)]);
        return;
    }
    all.push((format!("su({n})"), 0));
    all.extend((1..=n / 2).map(|q| (format!("su({},{q})", n - q), 2 * q * (n - q))));
    all.push((format!("sl({n},R)"), (n - 1) * (n + 2) / 2));
    if n.is_multiple_of(2) {
        let half = n / 2;
        all.push((format!("su*({n})"), (half - 1) * (2 * half + 1)));
    }
}

/// The forms of so(n) that keep a quadratic form.
fn orthogonal(n: usize, all: &mut Vec<(String, usize)>) {
    all.push((format!("so({n})"), 0));
    let forms = (1..=n / 2).map(|q| (format!("so({},{q})", n - q), q * (n - q)));
    all.extend(forms.map(|(name, squares)| match name.as_str() {
        "so(3,2)" => ("sp(4,R)".to_owned(), squares),
        _ => (name, squares),
    }));
}

/// The forms of sp(2n), n >= 3.
fn symplectic(n: usize, all: &mut Vec<(String, usize)>) {
    all.push((format!("sp({n})"), 0));
    all.extend((1..=n / 2).map(|q| (format!("sp({},{q})", n - q), 4 * q * (n - q))));
    all.push((format!("sp({},R)", 2 * n), n * (n + 1)));
}

/// The name of a complex simple algebra as a real one of this dimension.
pub fn complex(dimension: usize) -> Option<&'static str> {
    Some(match dimension {
        6 => "so(3,1)",
        16 => "sl(3,C)",
        20 => "so(5,C)",
        28 => "g2(C)",
        30 => "sl(4,C)",
        48 => "sl(5,C)",
        _ => return None,
    })
}

/// What a name is also called.
pub fn alias(name: &str) -> Option<&'static str> {
    Some(match name {
        "so(3)" => "su(2), Bianchi IX",
        "sl(2,R)" => "so(2,1), su(1,1), Bianchi VIII",
        "so(4)" => "so(3) + so(3)",
        "so(2,2)" => "sl(2,R) + sl(2,R)",
        "so(3,1)" => "sl(2,C)",
        "sp(4,R)" => "so(3,2)",
        "su(4)" => "so(6)",
        "sl(4,R)" => "so(3,3)",
        "su(2,2)" => "so(4,2)",
        "su*(4)" => "so(5,1)",
        "heisenberg(1)" => "Bianchi II",
        "se(2)" => "Bianchi VII_0",
        "bianchi(VI, 0)" => "iso(1,1), poincare(1)",
        "poincare(3)" => "iso(3,1)",
        "aff(1) + R" => "Bianchi III",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_told_apart_or_not_named() {
        let both = [Series::Orthogonal, Series::Symplectic];
        let name = |dimension, positive| real_form(dimension, positive, &both);
        for (dimension, positive, expected) in [
            (3, 0, "so(3)"),
            (3, 2, "sl(2,R)"),
            (8, 0, "su(3)"),
            (8, 4, "su(2,1)"),
            (8, 5, "sl(3,R)"),
            (10, 0, "so(5)"),
            (10, 4, "so(4,1)"),
            (10, 6, "sp(4,R)"),
            (14, 8, "g2(2)"),
            (15, 5, "su*(4)"),
            (15, 9, "sl(4,R)"),
            (24, 0, "su(5)"),
            (28, 12, "so(6,2)"),
            (63, 27, "su*(8)"),
        ] {
            assert_eq!(name(dimension, positive).as_deref(), Some(expected));
        }
        // so(7) and sp(3), so(4,3) and sp(6,R)
        assert_eq!((name(21, 0), name(21, 12)), (None, None));
        assert_eq!(name(21, 6).as_deref(), Some("so(6,1)"));
        assert_eq!(real_form(21, 12, &both[..1]).as_deref(), Some("so(4,3)"));
        assert_eq!(real_form(21, 12, &both[1..]).as_deref(), Some("sp(6,R)"));
        // E_6 is what is neither
        assert_eq!(
            (name(78, 0), real_form(78, 0, &[]).as_deref()),
            (None, Some("e6"))
        );
        assert_eq!((name(3, 1), name(7, 0)), (None, None));
    }
}
