//! Names of basis elements and coordinates, and of copies.

use std::collections::BTreeSet;

use super::NamedAlgebra;

/// A name with indices from 0 on, shown from 1 on: `E12`, in larger sizes `E1_12`.
pub fn indexed(stem: &str, indices: &[usize], size: usize) -> String {
    let indices: Vec<String> = indices
        .iter()
        .map(|index| (index + 1).to_string())
        .collect();
    stem.to_owned() + &indices.join(if size > 9 { "_" } else { "" })
}

/// A name with one index from 0 on; without it where there is only one.
pub fn numbered(stem: &str, index: usize, count: usize) -> String {
    match count {
        1 => stem.to_owned(),
        _ => format!("{stem}{}", index + 1),
    }
}

/// The name of the k-th copy: `x2`, of a name that ends with a digit `e1_2`.
fn copy(name: &str, k: usize) -> String {
    let separator = if name.ends_with(|c: char| c.is_ascii_digit()) {
        "_"
    } else {
        ""
    };
    format!("{name}{separator}{k}")
}

/// Gives the parts of a sum different names: a part that shares one with others is numbered among these, and if that
/// does not do, every part by its place.
pub fn tell_apart(parts: &mut [NamedAlgebra]) {
    let shared = (0..parts.len()).map(|i| {
        let others = (0..parts.len()).filter(|j| *j != i && share(&parts[i], &parts[*j]));
        let others: Vec<usize> = others.collect();
        let before = others.iter().filter(|j| **j < i).count();
        (!others.is_empty()).then_some(before + 1)
    });
    let shared: Vec<Option<usize>> = shared.collect();
    let mut attempt = parts.to_vec();
    for (part, number) in attempt.iter_mut().zip(shared) {
        if let Some(number) = number {
            rename(part, |name| copy(name, number));
        }
    }
    if !all_different(&attempt) {
        attempt = parts.to_vec();
        for (i, part) in attempt.iter_mut().enumerate() {
            rename(part, |name| format!("{name}_{}", i + 1));
        }
    }
    parts.clone_from_slice(&attempt);
}

fn rename(part: &mut NamedAlgebra, new: impl Fn(&str) -> String) {
    for name in part.basis.iter_mut().chain(&mut part.state) {
        *name = new(name);
    }
}

/// Whether two parts have a name in common.
fn share(a: &NamedAlgebra, b: &NamedAlgebra) -> bool {
    let common = |a: &[String], b: &[String]| a.iter().any(|name| b.contains(name));
    common(&a.basis, &b.basis) || common(&a.state, &b.state)
}

/// Whether no name stands twice.
fn all_different(parts: &[NamedAlgebra]) -> bool {
    let (mut basis, mut state) = (BTreeSet::new(), BTreeSet::new());
    let mut parts = parts.iter();
    parts.all(|part| {
        part.basis.iter().all(|name| basis.insert(name))
            && part.state.iter().all(|name| state.insert(name))
    })
}
