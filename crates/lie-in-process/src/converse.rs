//! Conversations with work in this process: a thread answers, and its words come by a channel; or who asks does the work.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use lie_program::protocol::{End, Message, Progress};
use lie_program::session::{Interruption, Output, attend};

use crate::{Question, Work};

/// Between two looks whether the work is to end early.
const PAUSE: Duration = Duration::from_millis(5);
/// Messages that wait to be taken, at most.
const WAITING: usize = 64;

/// Who hears what is said.
pub trait Listener<F> {
    /// Takes what is found.
    ///
    /// # Errors
    /// Nothing more is wanted, which ends the work.
    fn found(&mut self, found: F) -> io::Result<()>;

    /// Hears how far it is.
    fn progress(&mut self, progress: &Progress);

    /// Whether the work is to end early; asked now and then.
    fn stops(&mut self) -> bool;
}

/// How a conversation ended.
#[derive(Debug)]
pub enum Last {
    /// With these words; without any where the work failed.
    Said(Option<End>),
    /// With something that was not taken.
    NotTaken(io::Error),
    /// With work that was left behind, to end with this process, since it did not stop in time.
    Left,
}

/// Has a question answered. Work that is to end early has so much time for that, if it is limited.
///
/// # Errors
/// There is no thread.
pub fn converse<Q: Question>(
    work: &Arc<Work>,
    question: Q,
    grace: Option<Duration>,
    listener: &mut dyn Listener<Q::Found>,
) -> io::Result<Last> {
    let (mut sender, news) = sync_channel::<Message<Q::Found>>(WAITING);
    let interruption = Interruption::default();
    let (work, interrupted) = (Arc::clone(work), interruption.clone());
    let served = std::thread::Builder::new().spawn(move || {
        attend(&mut sender, interrupted, |session| {
            question.put(&work, session)
        });
    })?;
    let (mut end, mut since) = (None, None);
    let heard = loop {
        match news.recv_timeout(PAUSE) {
            Ok(Message::Found(found)) => {
                if let Err(error) = listener.found(found) {
                    break Last::NotTaken(error);
                }
            }
            Ok(Message::Progress(progress)) => listener.progress(&progress),
            Ok(Message::End(last)) => end = Some(last),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break Last::Said(end),
        }
        if since.is_none() && listener.stops() {
            interruption.set();
            since = Some(Instant::now());
        }
        let over = |since: Instant| grace.is_some_and(|grace| since.elapsed() > grace);
        if since.is_some_and(over) {
            return Ok(Last::Left);
        }
    };
    // what waits to say more fails at that, and ends
    drop(news);
    interruption.set();
    match served.join() {
        Ok(()) => Ok(heard),
        Err(_) => Ok(Last::Said(None)),
    }
}

/// Has a question answered by the thread that asks, for work that is known to be brief: a thread takes longer to make than many a run.
/// It is asked to end early only where it says how far it is.
pub fn converse_here<Q: Question>(
    work: &Work,
    question: Q,
    listener: &mut dyn Listener<Q::Found>,
) -> Last {
    let interruption = Interruption::default();
    let mut heard = Heard {
        listener,
        interruption: interruption.clone(),
        end: None,
        not_taken: None,
    };
    let attended = catch_unwind(AssertUnwindSafe(|| {
        attend(&mut heard, interruption, |session| {
            question.put(work, session)
        });
    }));
    match (attended, heard.not_taken) {
        (Err(_), _) => Last::Said(None),
        (Ok(()), Some(error)) => Last::NotTaken(error),
        (Ok(()), None) => Last::Said(heard.end),
    }
}

/// Hands on what is said at once.
struct Heard<'l, F> {
    listener: &'l mut dyn Listener<F>,
    interruption: Interruption,
    end: Option<End>,
    not_taken: Option<io::Error>,
}

impl<F> Output<F> for Heard<'_, F> {
    fn say(&mut self, message: Message<F>) -> io::Result<()> {
        match message {
            Message::Found(found) => {
                if let Err(error) = self.listener.found(found) {
                    self.not_taken = Some(error);
                    return Err(io::ErrorKind::BrokenPipe.into());
                }
            }
            Message::Progress(progress) => {
                self.listener.progress(&progress);
                if self.listener.stops() {
                    self.interruption.set();
                }
            }
            Message::End(end) => self.end = Some(end),
        }
        Ok(())
    }
}
