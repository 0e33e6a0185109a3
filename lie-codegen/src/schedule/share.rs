//! Sharing: pairs of factors, then pairs of terms, that occur more than once become quantities.

use std::collections::HashMap;

use super::formula::{Atom, AtomId, Formula, Signed};

/// Sums with more terms take no part in the search for pairs (it is quadratic in them).
const LONGEST_SUM: usize = 48;

/// Replaces repeated pairs, the most frequent first.
pub fn share(formula: &mut Formula) {
    formula.forget_unused();
    share_pairs(formula, product_pairs, replace_product_pair);
    share_pairs(formula, sum_pairs, replace_sum_pair);
}

/// Two factors, or two terms with their relative sign.
type Pair = (AtomId, AtomId, bool);

fn share_pairs(
    formula: &mut Formula,
    pairs_of: fn(&Atom) -> HashMap<Pair, usize>,
    replace: fn(&mut Formula, AtomId, Pair, AtomId),
) {
    let mut counts: HashMap<Pair, usize> = HashMap::new();
    let mut pairs: Vec<HashMap<Pair, usize>> = formula.atoms.iter().map(pairs_of).collect();
    for of_atom in &pairs {
        for (pair, n) in of_atom {
            *counts.entry(*pair).or_insert(0) += n;
        }
    }
    loop {
        let best = counts.iter().map(|(pair, n)| (*n, std::cmp::Reverse(*pair))).max();
        let Some((n, std::cmp::Reverse(pair))) = best else { return };
        if n < 2 {
            return;
        }
        let users: Vec<AtomId> = (0..pairs.len()).filter(|id| pairs[*id].contains_key(&pair)).collect();
        let (left, right, opposite) = pair;
        let shared = match &formula.atoms[users[0]] {
            Atom::Product(_) => formula.intern(Atom::Product(vec![left, right])),
            _ => formula.intern(Atom::Sum(vec![(false, left), (opposite, right)])),
        };
        pairs.resize(formula.atoms.len(), HashMap::new());
        for user in users {
            if user == shared {
                // The pair itself stays as it is and takes part no more.
                for (pair, n) in std::mem::take(&mut pairs[user]) {
                    forget(&mut counts, pair, n);
                }
                continue;
            }
            replace(formula, user, pair, shared);
            let new = pairs_of(&formula.atoms[user]);
            for (pair, n) in std::mem::replace(&mut pairs[user], new.clone()) {
                forget(&mut counts, pair, n);
            }
            for (pair, n) in new {
                *counts.entry(pair).or_insert(0) += n;
            }
        }
        counts.remove(&pair);
    }
}

fn forget(counts: &mut HashMap<Pair, usize>, pair: Pair, n: usize) {
    if let Some(count) = counts.get_mut(&pair) {
        *count = count.saturating_sub(n);
        if *count == 0 {
            counts.remove(&pair);
        }
    }
}

fn product_pairs(atom: &Atom) -> HashMap<Pair, usize> {
    let Atom::Product(factors) = atom else { return HashMap::new() };
    let mut powers: Vec<(AtomId, usize)> = Vec::new();
    for &factor in factors {
        match powers.last_mut() {
            Some((last, n)) if *last == factor => *n += 1,
            _ => powers.push((factor, 1)),
        }
    }
    let mut pairs = HashMap::new();
    for (position, &(a, n)) in powers.iter().enumerate() {
        if n >= 2 {
            pairs.insert((a, a, false), n / 2);
        }
        for &(b, m) in &powers[position + 1..] {
            pairs.insert((a, b, false), n.min(m));
        }
    }
    pairs
}

fn replace_product_pair(formula: &mut Formula, user: AtomId, (a, b, _): Pair, shared: AtomId) {
    let Atom::Product(factors) = &mut formula.atoms[user] else { return };
    while let Some(first) = factors.iter().position(|f| *f == a) {
        let Some(second) = (0..factors.len()).find(|&i| i != first && factors[i] == b) else { break };
        factors.remove(first.max(second));
        factors.remove(first.min(second));
        factors.push(shared);
    }
    factors.sort_unstable();
}

fn sum_pairs(atom: &Atom) -> HashMap<Pair, usize> {
    let Atom::Sum(terms) = atom else { return HashMap::new() };
    let mut pairs = HashMap::new();
    if terms.len() > LONGEST_SUM {
        return pairs;
    }
    for (position, (sign, a)) in terms.iter().enumerate() {
        for (other, b) in &terms[position + 1..] {
            if a != b {
                pairs.insert((*a.min(b), *a.max(b), sign != other), 1);
            }
        }
    }
    pairs
}

fn replace_sum_pair(formula: &mut Formula, user: AtomId, (a, b, opposite): Pair, shared: AtomId) {
    let Atom::Sum(terms) = &mut formula.atoms[user] else { return };
    let find = |terms: &[Signed], atom| terms.iter().position(|(_, id)| *id == atom);
    let (Some(first), Some(second)) = (find(terms, a), find(terms, b)) else { return };
    let sign = terms[first].0;
    if (sign != terms[second].0) != opposite {
        return;
    }
    terms.remove(first.max(second));
    terms.remove(first.min(second));
    terms.push((sign, shared));
    terms.sort_by_key(|(negative, atom)| (*atom, *negative));
}
