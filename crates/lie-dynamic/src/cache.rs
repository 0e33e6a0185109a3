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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

    /// Longer than any of these takes.
    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn a_value_is_made_once_by_the_first_of_several_threads() {
        let (cache, made) = (Cache::<u32, u32>::default(), AtomicU32::new(0));
        let values: Vec<_> = thread::scope(|scope| {
            let ask = || {
                cache.get(&7, || {
                    // the others come while it is made
                    thread::sleep(Duration::from_millis(20));
                    made.fetch_add(1, Ordering::Relaxed);
                    Some(42)
                })
            };
            let threads: Vec<_> = (0..8).map(|_| scope.spawn(ask)).collect();
            let values = threads.into_iter().map(|thread| thread.join());
            values.map(|value| value.expect("it ends")).collect()
        });
        assert_eq!(made.load(Ordering::Relaxed), 1);
        let first = values[0].as_ref().expect("there is one");
        let same = |value: &Option<Arc<u32>>| value.as_ref().is_some_and(|v| Arc::ptr_eq(v, first));
        assert!(values.iter().all(same));
    }

    #[test]
    fn others_do_not_wait_for_what_is_being_made() {
        let cache = &Cache::<u32, u32>::default();
        let ((begun, has_begun), (go, may_go)) = (channel(), channel());
        let went_on = thread::scope(|scope| {
            let slow = scope.spawn(move || {
                let mut went_on = false;
                cache.get(&1, || {
                    begun.send(()).expect("somebody waits");
                    went_on = may_go.recv_timeout(LONG).is_ok();
                    Some(1)
                });
                went_on
            });
            has_begun.recv_timeout(LONG).expect("it begins");
            assert_eq!(cache.cached(&1), None, "it is not there yet");
            assert!(!cache.has_tried(&1) && cache.all_of(|_| true).is_empty());
            assert_eq!(cache.get(&2, || Some(2)).as_deref(), Some(&2));
            go.send(()).expect("it waits");
            slow.join().expect("it ends")
        });
        assert!(went_on, "the second key waited for the first");
        assert_eq!(cache.cached(&1).as_deref(), Some(&1));
    }

    #[test]
    fn what_cannot_be_made_is_tried_once_and_making_may_ask() {
        let cache = Cache::<u32, u32>::default();
        assert_eq!(cache.get(&1, || None), None);
        assert_eq!(cache.get(&1, || panic!("it is known")), None);
        assert!(cache.has_tried(&1) && !cache.has_tried(&2));
        let sum = cache.get(&3, || Some(1 + *cache.get(&2, || Some(2))?));
        assert_eq!(sum.as_deref(), Some(&3));
    }
}
