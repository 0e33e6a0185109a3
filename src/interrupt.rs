//! Signals end a run in order, rows kept and children ended; a second one, later than 0.2 seconds, ends it at once.
//!
//! | signal | sent by | exit code |
//! |---|---|---|
//! | SIGINT | Ctrl-C | 130 |
//! | SIGTERM | a scheduler, a supervisor, `kill` | 143 |
//! | SIGHUP | a terminal that closes | 129, unless `nohup` has it ignored |

use std::io;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Signals within this time are one: who signals a process and its group, as `timeout` does, means it once.
const ONE: Duration = Duration::from_millis(200);

/// Remembers the signal, and holds what it is to end.
#[derive(Clone, Default)]
pub struct Interrupt(Arc<Inner>);

#[derive(Default)]
struct Inner {
    /// The exit code of the first signal; 0 before.
    code: AtomicU8,
    /// When the first signal came.
    first: OnceLock<Instant>,
    /// Set while there is something to end in order.
    busy: AtomicBool,
    /// What works stops when this end of its input is closed.
    lifeline: Mutex<Option<Box<dyn Send>>>,
    /// The leader of the group of processes that builds.
    builder: Mutex<Option<u32>>,
}

impl Interrupt {
    /// Starts to listen; without the system's leave, signals just kill.
    pub fn install() -> Self {
        let interrupt = Self::default();
        listen(interrupt.clone());
        interrupt
    }

    fn raise(&self, code: u8) {
        let now = Instant::now();
        let first = *self.0.first.get_or_init(|| now);
        let again = self.seen().is_some();
        if again && now.duration_since(first) < ONE {
            return;
        }
        self.0.code.store(code, Ordering::SeqCst);
        if let Some(builder) = *lock(&self.0.builder) {
            kill_group(builder);
        }
        if again || !self.0.busy.load(Ordering::SeqCst) {
            std::process::exit(i32::from(code));
        }
        self.stop();
    }

    /// The exit code that a signal asks for, if there was one.
    pub fn seen(&self) -> Option<u8> {
        Some(self.0.code.load(Ordering::SeqCst)).filter(|code| *code != 0)
    }

    /// From now on what reads from the other end of `input` is asked to stop, by closing it.
    pub fn watch(&self, input: Box<dyn Send>) {
        *lock(&self.0.lifeline) = Some(input);
        self.0.busy.store(true, Ordering::SeqCst);
        // A signal that came before found nothing to stop.
        if self.seen().is_some() {
            self.stop();
        }
    }

    /// From now on a thread of this process works, and looks itself whether there was a signal.
    pub fn expect(&self) {
        self.0.busy.store(true, Ordering::SeqCst);
    }

    /// From now on nothing has to end in order: a signal ends the process at once.
    pub fn expect_no_more(&self) {
        self.0.busy.store(false, Ordering::SeqCst);
    }

    /// Asks the program to stop.
    pub fn stop(&self) {
        drop(lock(&self.0.lifeline).take());
    }

    /// Runs a command that builds, to its end or until a signal ends it with all that it has started.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn build(&self, command: &mut Command) -> io::Result<Output> {
        own_group(command);
        let command = command.stdin(Stdio::null()).stdout(Stdio::piped());
        let child = {
            // A signal waits until the group is known.
            let mut builder = lock(&self.0.builder);
            self.0.busy.store(true, Ordering::SeqCst);
            let child = command.stderr(Stdio::piped()).spawn()?;
            *builder = Some(child.id());
            child
        };
        if self.seen().is_some() {
            kill_group(child.id());
        }
        let output = child.wait_with_output();
        *lock(&self.0.builder) = None;
        output
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A group of its own, so that Ctrl-C on the terminal reaches this process alone, which then ends the others.
pub fn own_group(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(windows)]
    {
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP);
    }
    #[cfg(not(any(unix, windows)))]
    let _ = command;
}

#[cfg(unix)]
fn listen(interrupt: Interrupt) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // Where files may not grow any more, writing shall fail and not kill.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let mut wanted = vec![SIGINT, SIGTERM];
    wanted.extend((!hangup_is_ignored()).then_some(SIGHUP));
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) {
        std::thread::spawn(move || {
            for signal in signals.forever() {
                interrupt.raise(128 + signal as u8);
            }
        });
    }
}

/// Whether whoever started us wants the run to outlive the terminal, as `nohup` does. Where the system does
/// not tell, a missing terminal on stderr does.
#[cfg(unix)]
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
        Some(mask) => mask & 1 != 0,
        None => !io::IsTerminal::is_terminal(&io::stderr()),
    }
}

#[cfg(unix)]
fn kill_group(leader: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(leader) = i32::try_from(leader).ok().and_then(Pid::from_raw) {
        // It may have ended by itself.
        let _ = kill_process_group(leader, Signal::TERM);
    }
}

#[cfg(not(unix))]
fn listen(interrupt: Interrupt) {
    let _ = ctrlc::set_handler(move || interrupt.raise(crate::message::INTERRUPTED));
}

/// cargo shares the console and hears Ctrl-C itself.
#[cfg(not(unix))]
fn kill_group(_leader: u32) {}
