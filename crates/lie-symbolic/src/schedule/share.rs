//! Sharing: pairs of factors, then pairs of terms, that occur more than once become quantities.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::collections::hash_map::Entry;

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

/// Two factors, or two terms with their relative sign, as one number: millions of them are compared. The order
/// is that of the first atoms, then of the second ones, then equal signs before opposite ones.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Pair(u64);

impl Pair {
    /// Atoms are far fewer than 2^31: the arena is bounded.
    fn new(first: AtomId, second: AtomId, opposite: bool) -> Self {
        Self((first as u64) << 32 | (second as u64) << 1 | u64::from(opposite))
    }

    fn parts(self) -> (AtomId, AtomId, bool) {
        let second = (self.0 >> 1) & 0x7fff_ffff;
        ((self.0 >> 32) as AtomId, second as AtomId, self.0 & 1 == 1)
    }
}

/// The pairs of an atom, in order, each with how often it occurs.
type Pairs = Vec<(Pair, usize)>;

/// Where each pair occurs, and those that occur more than once by how often they do.
#[derive(Default)]
struct Index {
    users: HashMap<Pair, Users>,
    frequency: BTreeSet<(usize, Reverse<Pair>)>,
    budget: usize,
}

/// The atoms with a pair, and how often each has it; most pairs have one.
enum Users {
    One(AtomId, usize),
    Many {
        total: usize,
        /// In order; an atom that no longer has the pair stays with none.
        atoms: Vec<(AtomId, usize)>,
    },
}

impl Users {
    fn total(&self) -> usize {
        match self {
            Users::One(_, count) => *count,
            Users::Many { total, .. } => *total,
        }
    }

    fn atoms(&self) -> Vec<AtomId> {
        match self {
            Users::One(atom, _) => vec![*atom],
            Users::Many { atoms, .. } => {
                let users = atoms.iter().filter(|(_, count)| *count > 0);
                users.map(|(atom, _)| *atom).collect()
            }
        }
    }

    /// Says how often an atom has the pair.
    fn set(&mut self, atom: AtomId, count: usize) {
        match self {
            Users::One(only, known) if *only == atom => *known = count,
            Users::One(other, known) => {
                let mut atoms = vec![(*other, *known), (atom, count)];
                atoms.sort_unstable();
                *self = Users::Many {
                    total: *known + count,
                    atoms,
                };
            }
            Users::Many { total, atoms } => {
                match atoms.binary_search_by_key(&atom, |(atom, _)| *atom) {
                    Ok(place) => {
                        *total -= atoms[place].1;
                        atoms[place].1 = count;
                    }
                    Err(place) => atoms.insert(place, (atom, count)),
                }
                *total += count;
            }
        }
    }
}

impl Index {
    /// The most frequent pair that occurs more than once; of equals the first.
    fn best(&self) -> Option<Pair> {
        self.frequency.last().map(|(_, Reverse(pair))| *pair)
    }

    /// Replaces what is known of the pairs of an atom.
    fn update(&mut self, atom: AtomId, old: &[(Pair, usize)], new: &[(Pair, usize)]) {
        self.budget = self.budget.saturating_sub(old.len() + new.len());
        let (mut old, mut new) = (old.iter().peekable(), new.iter().peekable());
        loop {
            // Both are in order: the smaller pair is in one list only.
            match (old.peek(), new.peek()) {
                (Some((gone, _)), later) if later.is_none_or(|(pair, _)| gone < pair) => {
                    self.set(*gone, atom, 0);
                    old.next();
                }
                (Some((same, was)), Some((pair, count))) if same == pair => {
                    if was != count {
                        self.set(*pair, atom, *count);
                    }
                    old.next();
                    new.next();
                }
                (_, Some((pair, count))) => {
                    self.set(*pair, atom, *count);
                    new.next();
                }
                (_, None) => return,
            }
        }
    }

    fn set(&mut self, pair: Pair, atom: AtomId, count: usize) {
        let mut entry = match self.users.entry(pair) {
            Entry::Vacant(entry) => {
                entry.insert(Users::One(atom, count));
                if count > 1 {
                    self.frequency.insert((count, Reverse(pair)));
                }
                return;
            }
            Entry::Occupied(entry) => entry,
        };
        let before = entry.get().total();
        entry.get_mut().set(atom, count);
        let after = entry.get().total();
        if after == 0 {
            entry.remove();
        }
        if before == after {
            return;
        }
        if before > 1 {
            self.frequency.remove(&(before, Reverse(pair)));
        }
        if after > 1 {
            self.frequency.insert((after, Reverse(pair)));
        }
    }
}

fn share_pairs(
    formula: &mut Formula,
    budget: &mut usize,
    pairs_of: fn(&Atom) -> Pairs,
    replace: fn(&mut Formula, AtomId, Pair, AtomId),
) {
    let mut pairs: Vec<Pairs> = formula.atoms.iter().map(pairs_of).collect();
    let mut index = Index {
        budget: *budget,
        ..Index::default()
    };
    for (atom, new) in pairs.iter().enumerate() {
        index.update(atom, &[], new);
    }
    while let Some(pair) = index.best().filter(|_| index.budget > 0) {
        let users = index.users[&pair].atoms();
        let (left, right, opposite) = pair.parts();
        let shared = match &formula.atoms[users[0]] {
            Atom::Product(_) => formula.intern(Atom::Product(vec![left, right])),
            _ => formula.intern(Atom::Sum(vec![(false, left), (opposite, right)])),
        };
        pairs.resize(formula.atoms.len(), Pairs::default());
        for user in users {
            // The pair itself stays as it is and takes part no more.
            let new = if user == shared {
                Pairs::default()
            } else {
                replace(formula, user, pair, shared);
                let mut new = pairs_of(&formula.atoms[user]);
                new.retain(|(known, _)| *known != pair);
                new
            };
            index.update(user, &pairs[user], &new);
            pairs[user] = new;
        }
    }
    *budget = index.budget;
}

fn product_pairs(atom: &Atom) -> Pairs {
    let Atom::Product(factors) = atom else {
        return Pairs::default();
    };
    // Factors are in order, and so are the pairs.
    let mut powers: Vec<(AtomId, usize)> = Vec::new();
    for &factor in factors {
        match powers.last_mut() {
            Some((last, n)) if *last == factor => *n += 1,
            _ => powers.push((factor, 1)),
        }
    }
    let mut pairs = Pairs::default();
    if powers.len() > LONGEST {
        return pairs;
    }
    for (position, &(a, n)) in powers.iter().enumerate() {
        if n >= 2 {
            pairs.push((Pair::new(a, a, false), n / 2));
        }
        for &(b, m) in &powers[position + 1..] {
            pairs.push((Pair::new(a, b, false), n.min(m)));
        }
    }
    pairs
}

fn replace_product_pair(formula: &mut Formula, user: AtomId, pair: Pair, shared: AtomId) {
    let (a, b, _) = pair.parts();
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

fn sum_pairs(atom: &Atom) -> Pairs {
    let Atom::Sum(terms) = atom else {
        return Pairs::default();
    };
    let mut pairs = Pairs::default();
    if terms.len() > LONGEST {
        return pairs;
    }
    for (position, (sign, a)) in terms.iter().enumerate() {
        for (other, b) in &terms[position + 1..] {
            if a != b {
                pairs.push((Pair::new(*a.min(b), *a.max(b), sign != other), 1));
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

fn replace_sum_pair(formula: &mut Formula, user: AtomId, pair: Pair, shared: AtomId) {
    let (a, b, opposite) = pair.parts();
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
