//! Ctrl-C: ends a run in order, rows kept; a second one ends it at once.

use std::process::ChildStdin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::message::INTERRUPTED;

/// Remembers Ctrl-C, and holds the line by which the program is told to stop.
#[derive(Clone, Default)]
pub struct Interrupt(Arc<Inner>);

#[derive(Default)]
struct Inner {
    seen: AtomicBool,
    /// Set while there is something to end in order.
    running: AtomicBool,
    /// The program stops when its standard input ends.
    lifeline: Mutex<Option<ChildStdin>>,
}

impl Interrupt {
    /// Starts to listen; without the system's leave, Ctrl-C just kills.
    pub fn install() -> Self {
        let interrupt = Self::default();
        let handler = interrupt.clone();
        let _ = ctrlc::set_handler(move || handler.raise());
        interrupt
    }

    fn raise(&self) {
        let again = self.0.seen.swap(true, Ordering::SeqCst);
        if again || !self.0.running.load(Ordering::SeqCst) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        self.stop();
    }

    /// Whether Ctrl-C was pressed.
    pub fn seen(&self) -> bool {
        self.0.seen.load(Ordering::SeqCst)
    }

    /// From now on the program that reads `stdin` is asked to stop.
    pub fn watch(&self, stdin: ChildStdin) {
        *self.lifeline() = Some(stdin);
        self.0.running.store(true, Ordering::SeqCst);
    }

    /// Asks the program to stop.
    pub fn stop(&self) {
        drop(self.lifeline().take());
    }

    fn lifeline(&self) -> std::sync::MutexGuard<'_, Option<ChildStdin>> {
        self.0
            .lifeline
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}
