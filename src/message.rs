//! How a command fails: what it says on stderr, and its exit code.

use lie_in_process::message::Fault;
pub use lie_in_process::message::{Message, Place, Source};

/// Exit code: a check failed, or the surroundings did (unwritable file, full disk, no cargo).
pub const SURROUNDINGS: u8 = 1;
/// Exit code: the input is invalid, nothing was run.
pub const INVALID: u8 = 2;
/// Exit code: the integration stopped early; the rows so far are written.
pub const STOPPED: u8 = 3;
/// Exit code: Ctrl-C; the rows so far are written. Other signals have codes of their own.
pub const INTERRUPTED: u8 = 130;

/// A step that does not lead to the end of the run.
pub fn step_refused(why: String) -> Message {
    let help = "give another step by `--step`, or another end";
    Message::option("--step", why).help(help)
}

/// A start from which a projection cannot keep what is asked for.
pub fn keep_refused(why: String) -> Message {
    let help = "begin elsewhere, where all that is to be kept has a value, or keep less";
    Message::option("--keep", why).help(help)
}

/// Why a command ends early: what it says, and its exit code.
#[derive(Debug)]
pub struct Failure {
    /// What is printed, in this order.
    pub messages: Vec<Message>,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The input is invalid, or this machine too small for it.
    pub fn invalid(messages: Vec<Message>) -> Self {
        let small = messages.iter().any(|one| one.fault == Fault::Memory);
        Self {
            messages,
            code: if small { SURROUNDINGS } else { INVALID },
        }
    }

    /// The surroundings failed.
    pub fn surroundings(message: Message) -> Self {
        Self {
            messages: vec![message],
            code: SURROUNDINGS,
        }
    }

    /// A signal ended it.
    pub fn interrupted(code: u8) -> Self {
        Self {
            messages: Vec::new(),
            code,
        }
    }

    /// Ends without a word: the reader of our output went away.
    pub fn quiet() -> Self {
        Self {
            messages: Vec::new(),
            code: 0,
        }
    }
}

impl From<Message> for Failure {
    fn from(message: Message) -> Self {
        Self::invalid(vec![message])
    }
}
