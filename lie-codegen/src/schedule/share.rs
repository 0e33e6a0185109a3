//! Sharing: pairs of factors, then pairs of terms, that occur more than once become quantities.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap as HashMap;

use super::formula::{Atom, AtomId, Formula, Signed};

/// Sums and products with more operands take no part in the search for pairs (it is quadratic in
/// them).
const LONGEST: usize = 48;

/// Pairs that all candidates of a kernel may look at together: seconds, not minutes.
pub const BUDGET: usize = 20_000_000;

/// Replaces repeated pairs, the most frequent first, until none is left or the budget is spent.
pub fn share(formula: &mut Formula, budget: &mut usize) {
    formula.forget_unused();
    share_pairs(formula, budget, product_pairs, replace_product_pair);
    share_pairs(formula, budget, sum_pairs, replace_sum_pair);
}

/// Two factors, or two terms with their relative sign.
type Pair = (AtomId, AtomId, bool);

/// Where each pair occurs, and the pairs by how often they do.
#[derive(Default)]
struct Index {
    users: HashMap<Pair, Users>,
    frequency: BTreeSet<(usize, Reverse<Pair>)>,
    budget: usize,
}

/// How often a pair occurs, in all and in each atom.
#[derive(Default)]
struct Users {
    total: usize,
    atoms: BTreeMap<AtomId, usize>,
}

impl Index {
    /// The most frequent pair that occurs more than once; of equals the first.
    fn best(&self) -> Option<Pair> {
        self.frequency
            .last()
            .filter(|(count, _)| *count > 1)
            .map(|(_, Reverse(pair))| *pair)
    }

    /// Replaces what is known of the pairs of an atom.
    fn update(&mut self, atom: AtomId, old: &HashMap<Pair, usize>, new: &HashMap<Pair, usize>) {
        self.budget = self.budget.saturating_sub(old.len() + new.len());
        for pair in old.keys().filter(|pair| !new.contains_key(pair)) {
            self.set(*pair, atom, 0);
        }
        for (pair, count) in new
            .iter()
            .filter(|(pair, count)| old.get(pair) != Some(count))
        {
            self.set(*pair, atom, *count);
        }
    }

    fn set(&mut self, pair: Pair, atom: AtomId, count: usize) {
        let users = self.users.entry(pair).or_default();
        let before = users.total;
        let was = if count == 0 {
            users.atoms.remove(&atom)
        } else {
            users.atoms.insert(atom, count)
        };
        users.total = before + count - was.unwrap_or(0);
        let after = users.total;
        if after == 0 {
            self.users.remove(&pair);
        }
        self.frequency.remove(&(before, Reverse(pair)));
        if after > 0 {
            self.frequency.insert((after, Reverse(pair)));
        }
    }
}

fn share_pairs(
    formula: &mut Formula,
    budget: &mut usize,
    pairs_of: fn(&Atom) -> HashMap<Pair, usize>,
    replace: fn(&mut Formula, AtomId, Pair, AtomId),
) {
    let mut pairs: Vec<HashMap<Pair, usize>> = formula.atoms.iter().map(pairs_of).collect();
    let mut index = Index {
        budget: *budget,
        ..Index::default()
    };
    for (atom, new) in pairs.iter().enumerate() {
        index.update(atom, &HashMap::default(), new);
    }
    while let Some(pair) = index.best().filter(|_| index.budget > 0) {
        let users: Vec<AtomId> = index.users[&pair].atoms.keys().copied().collect();
        let (left, right, opposite) = pair;
        let shared = match &formula.atoms[users[0]] {
            Atom::Product(_) => formula.intern(Atom::Product(vec![left, right])),
            _ => formula.intern(Atom::Sum(vec![(false, left), (opposite, right)])),
        };
        pairs.resize(formula.atoms.len(), HashMap::default());
        for user in users {
            // The pair itself stays as it is and takes part no more.
            let new = if user == shared {
                HashMap::default()
            } else {
                replace(formula, user, pair, shared);
                let mut new = pairs_of(&formula.atoms[user]);
                new.remove(&pair);
                new
            };
            index.update(user, &pairs[user], &new);
            pairs[user] = new;
        }
    }
    *budget = index.budget;
}

fn product_pairs(atom: &Atom) -> HashMap<Pair, usize> {
    let Atom::Product(factors) = atom else {
        return HashMap::default();
    };
    let mut powers: Vec<(AtomId, usize)> = Vec::new();
    for &factor in factors {
        match powers.last_mut() {
            Some((last, n)) if *last == factor => *n += 1,
            _ => powers.push((factor, 1)),
        }
    }
    let mut pairs = HashMap::default();
    if powers.len() > LONGEST {
        return pairs;
    }
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
    let Atom::Product(factors) = &mut formula.atoms[user] else {
        return;
    };
    while let Some(first) = factors.iter().position(|f| *f == a) {
        let Some(second) = (0..factors.len()).find(|&i| i != first && factors[i] == b) else {
            break;
        };
        factors.remove(first.max(second));
        factors.remove(first.min(second));
        factors.push(shared);
    }
    factors.sort_unstable();
}

fn sum_pairs(atom: &Atom) -> HashMap<Pair, usize> {
    let Atom::Sum(terms) = atom else {
        return HashMap::default();
    };
    let mut pairs = HashMap::default();
    if terms.len() > LONGEST {
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
    let Atom::Sum(terms) = &mut formula.atoms[user] else {
        return;
    };
    let find = |terms: &[Signed], atom| terms.iter().position(|(_, id)| *id == atom);
    let (Some(first), Some(second)) = (find(terms, a), find(terms, b)) else {
        return;
    };
    let sign = terms[first].0;
    if (sign != terms[second].0) != opposite {
        return;
    }
    terms.remove(first.max(second));
    terms.remove(first.min(second));
    terms.push((sign, shared));
    terms.sort_by_key(|(negative, atom)| (*atom, *negative));
}
