//! Calls of `lie` on their way: signals to them, their end, and what they show on a terminal.

// Each test file uses its own part of this.
#![allow(dead_code)]

use std::fmt::Write as _;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, Once, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::fs::{Mode, OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_default;

use crate::common::Run;

/// Nothing takes so long on a machine that works, however busy: whoever waits for longer fails.
const PATIENCE: Duration = Duration::from_secs(600);

/// Starts a command that hears signals. A signal that is ignored stays so in whatever is started (`nohup cargo test`, a
/// job of a script); one that is handled gets its default back there.
pub fn start(command: &mut Command) -> Child {
    static HANDLED: Once = Once::new();
    HANDLED.call_once(|| {
        for signal in [SIGHUP, SIGINT, SIGTERM] {
            // the tests themselves go on to do what they did
            let default = Arc::new(AtomicBool::new(!is_ignored(signal)));
            register_conditional_default(signal, default).expect("a handler");
        }
    });
    command.spawn().expect("it starts")
}

fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 != 0)
}

/// Waits until something is so.
#[track_caller]
pub fn wait(what: &str, done: impl Fn() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < PATIENCE, "no {what} in {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Waits for a file of at least so many bytes.
#[track_caller]
pub fn wait_for_bytes(out: &Path, bytes: u64) {
    wait("rows", || {
        std::fs::metadata(out).is_ok_and(|file| file.len() > bytes)
    });
}

/// Sends a signal (`-INT`) to a process.
#[track_caller]
pub fn signal(id: impl ToString, name: &str) {
    let status = Command::new("kill").args([name, &id.to_string()]).status();
    assert!(status.is_ok_and(|status| status.success()), "kill {name}");
}

/// Waits for the end.
#[track_caller]
pub fn ended(child: Child) -> Run {
    let id = child.id();
    let (tell, told) = mpsc::channel();
    std::thread::spawn(move || tell.send(child.wait_with_output()));
    match told.recv_timeout(PATIENCE) {
        Ok(output) => output.expect("its end").into(),
        Err(_) => {
            signal(id, "-KILL");
            panic!("it did not end in {PATIENCE:?}");
        }
    }
}

/// A terminal that a command writes its progress to.
pub struct Terminal {
    shown: Arc<Mutex<String>>,
    reader: JoinHandle<()>,
}

impl Terminal {
    /// Starts a command with a terminal as its standard error.
    pub fn start(mut command: Command) -> (Child, Self) {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
        grantpt(&ours).expect("it is ours");
        unlockpt(&ours).expect("it can be opened");
        let name = ptsname(&ours, Vec::new()).expect("its name");
        let theirs = open(name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty());
        command.stderr(Stdio::from(theirs.expect("its other side")));
        command.env("TERM", "xterm").env_remove("NO_COLOR");
        let child = start(&mut command);
        let shown = Arc::new(Mutex::new(String::new()));
        let screen = Arc::clone(&shown);
        let reader = std::thread::spawn(move || {
            let (mut ours, mut piece) = (File::from(ours), [0; 4096]);
            // an error is the end: nobody has the other side open any more
            while let Ok(count @ 1..) = ours.read(&mut piece) {
                let text = String::from_utf8_lossy(&piece[..count]);
                let _ = screen.lock().expect("the text").write_str(&text);
            }
        });
        (child, Self { shown, reader })
    }

    /// Waits until what it has shown is so.
    #[track_caller]
    pub fn wait(&self, what: &str, is_there: impl Fn(&str) -> bool) {
        wait(what, || is_there(&self.shown.lock().expect("the text")));
    }

    /// All that it has shown to the end of the command.
    pub fn text(self) -> String {
        self.reader.join().expect("the terminal is read");
        let shown = self.shown.lock().expect("the text");
        shown.clone()
    }
}
