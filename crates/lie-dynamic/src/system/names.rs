//! Words that live as long as the program: the core names parameters, and shows tables, by references without an owner.

use lie_core::structure::Entry;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Mutex, OnceLock, PoisonError};

/// One copy of each value that was ever asked for: systems that are made again share it.
struct Interner<K: 'static, V: 'static>(OnceLock<Mutex<HashMap<K, &'static V>>>)
where
    V: ?Sized;

impl<K: Eq + Hash, V: ?Sized> Interner<K, V> {
    fn get(&self, key: K, make: impl FnOnce(&K) -> Box<V>) -> &'static V {
        let map = self.0.get_or_init(Mutex::default);
        let mut map = map.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = map.get(&key) {
            return known;
        }
        let made: &'static V = Box::leak(make(&key));
        map.insert(key, made);
        made
    }
}

static TEXTS: Interner<String, str> = Interner(OnceLock::new());
static MATRICES: Interner<Vec<Vec<Bits>>, [&'static [Entry]]> = Interner(OnceLock::new());

/// An entry of a matrix: row, column, value and its rest.
type Bits = (u16, u16, u64, u64);

/// A text.
pub fn text(text: &str) -> &'static str {
    TEXTS.get(text.to_owned(), |text| text.clone().into_boxed_str())
}

/// Sparse matrices.
pub fn matrices(matrices: &[Vec<Entry>]) -> &'static [&'static [Entry]] {
    let bits = |entry: &Entry| {
        (
            entry.row,
            entry.column,
            entry.high.to_bits(),
            entry.low.to_bits(),
        )
    };
    let of = |matrix: &Vec<Entry>| matrix.iter().map(bits).collect();
    let key = matrices.iter().map(of).collect();
    MATRICES.get(key, |_| {
        let matrices = matrices.iter();
        let leaked =
            matrices.map(|matrix| -> &'static [Entry] { Box::leak(matrix.clone().into()) });
        leaked.collect()
    })
}
