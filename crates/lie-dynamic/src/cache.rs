//! What is made once for each key, where it is first asked for.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// One value, once it was made.
type Cell<T> = Arc<OnceLock<Option<Arc<T>>>>;

/// What was made for each key; `None` where there is none.
///
/// The lock is held while a key is looked up, not while its value is made: threads that ask for the same value wait for the first
/// of them, and others for nothing.
#[derive(Debug)]
pub struct Cache<T, K>(Mutex<HashMap<K, Cell<T>>>);

impl<T, K> Default for Cache<T, K> {
    fn default() -> Self {
        Self(Mutex::new(HashMap::new()))
    }
}

impl<T, K: Clone + Eq + Hash> Cache<T, K> {
    fn all(&self) -> MutexGuard<'_, HashMap<K, Cell<T>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// That of a key, made where it is asked for the first time. What makes it may ask for other keys.
    pub fn get(&self, key: &K, make: impl FnOnce() -> Option<T>) -> Option<Arc<T>> {
        let known = self.all().get(key).cloned();
        let cell = known.unwrap_or_else(|| self.all().entry(key.clone()).or_default().clone());
        cell.get_or_init(|| make().map(Arc::new)).clone()
    }

    /// All that were made whose keys are such.
    pub fn all_of(&self, is: impl Fn(&K) -> bool) -> Vec<Arc<T>> {
        let all = self.all();
        let found = all.iter().filter(|(key, _)| is(key));
        found.filter_map(|(_, cell)| cell.get()?.clone()).collect()
    }

    /// That of a key where it was made before.
    pub fn cached(&self, key: &K) -> Option<Arc<T>> {
        self.all().get(key)?.get()?.clone()
    }

    /// Whether it was tried to make that of a key.
    pub fn has_tried(&self, key: &K) -> bool {
        self.all().get(key).is_some_and(|cell| cell.get().is_some())
    }
}
