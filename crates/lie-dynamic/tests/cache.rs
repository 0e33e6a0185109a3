//! What is made once for each key: by one thread, while others go on.

use lie_dynamic::Cache;
use std::sync::Arc;
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
