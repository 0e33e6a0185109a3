//! Many trajectories on several threads. The bits of a member depend neither on the number of threads nor on the members
//! beside it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use lie_program::protocol::{End, Held, Obstacle, Sources, Times};
use lie_program::session::Session;
use lie_runtime::driver::{Grid, Options, Pace, Place, Save};

use crate::draw::Drawn;
use crate::members::{LANES, Member, Members, Watch, take_turns};
use crate::memory::{self, Exceeded};
use crate::request::Plan;
use crate::{Question, Work};

/// The most members that a thread takes at a time; more where they take turns, so that few lanes are empty at the end.
const SHARE: usize = 64;
const TURNS: usize = 256;
/// Shares of each thread, so that none waits long for another.
const SHARES: usize = 8;
/// So many shares of each thread may wait for one before them, of the size at most that they have where nobody takes turns.
const AHEAD: usize = 16;
/// Between two looks whether all is to end.
const PAUSE: Duration = Duration::from_millis(20);

/// Who takes part.
#[derive(Clone)]
pub struct Cast {
    /// The values of the parameters: a row for each initial state, or one for all.
    pub parameters: Vec<Vec<f64>>,
    /// The initial states.
    pub starts: Vec<Vec<f64>>,
    /// Members are drawn around each of them, where there is more to say than that.
    pub drawn: Option<Drawn>,
}

impl Cast {
    /// How many members there are.
    pub fn count(&self) -> usize {
        self.starts.len().saturating_mul(self.each())
    }

    /// How many are drawn around each state.
    fn each(&self) -> usize {
        self.drawn.as_ref().map_or(1, |drawn| drawn.draw.count)
    }

    /// The parameters of some members, one row where they have the same, and their initial states.
    fn some(&self, some: Range<usize>) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let each = self.each();
        let of = |start: usize| match self.parameters.as_slice() {
            [only] => only,
            all => &all[start],
        };
        let (first, last) = (some.start / each, (some.end - 1) / each);
        let parameters = match self.parameters.len() == 1 || first == last {
            true => vec![of(first).clone()],
            false => some
                .clone()
                .map(|member| of(member / each).clone())
                .collect(),
        };
        let mut starts = Vec::with_capacity(some.len());
        for start in first..=last {
            let whole = start * each..(start + 1) * each;
            let own = some.start.max(whole.start)..some.end.min(whole.end);
            let from = &self.starts[start];
            let drawn = self.drawn.as_ref().and_then(|drawn| {
                // that parameters are impossible, each member says itself
                Some((drawn, drawn.declared.system(of(start)).ok()?))
            });
            let drawn = drawn.as_ref();
            let within = drawn.map(|(drawn, system)| drawn.draw.within(system, drawn.orbits));
            let state = |member: usize| match &within {
                None => from.clone(),
                Some(within) => within.state(from, (member - whole.start) as u64),
            };
            starts.extend(own.map(state));
        }
        (parameters, starts)
    }
}

/// Trajectories by one method from many starts.
pub struct Ensemble {
    /// How each of them is made.
    pub plan: Plan,
    /// Whether only their ends are kept.
    pub ends: bool,
    /// Who takes part.
    pub cast: Cast,
    /// The members that are run.
    pub some: Range<usize>,
    /// On so many threads.
    pub threads: usize,
    /// Whether the events of members are kept.
    pub events: bool,
}

impl Ensemble {
    /// Whether there is memory for the rows of all members at once: of each alone, and of all together.
    ///
    /// # Errors
    /// There is not.
    pub fn fits(&self) -> Result<(), Exceeded> {
        memory::fits(self.size(self.some.len()))
    }

    /// Bytes of the rows of so many members, twice.
    fn size(&self, members: usize) -> f64 {
        let plan = &self.plan;
        let rows = match (self.ends, plan.pace.0) {
            (false, Pace::Step(step)) => memory::rows(&plan.times, plan.from, step),
            (false, Pace::Tolerance(_)) => memory::rows(&plan.times, plan.from, f64::INFINITY),
            (true, _) => 1.0,
        };
        let width = 1.0
            + self
                .cast
                .starts
                .first()
                .map_or(0.0, |start| start.len() as f64);
        2.0 * rows * width * members as f64 * memory::NUMBER
    }
}

/// The times of the rows of each member that comes to its end: of the ends alone one.
pub fn times(plan: &Plan, ends: bool) -> Vec<f64> {
    let (start, end) = plan.run(Default::default()).span();
    let grid = match plan.pace.0 {
        Pace::Step(step) => Grid::new((start, end), step).ok(),
        Pace::Tolerance(_) => None,
    };
    let last = grid.map_or(end, |grid| match grid.locate(end) {
        Place::On(index) => grid.time(index),
        Place::After(..) => end,
    });
    match (&plan.times, grid) {
        _ if ends => vec![last],
        (Times::At(times) | Times::Within { times, .. }, _) => {
            let mut times = times.clone();
            times.sort_by(f64::total_cmp);
            if end < start {
                times.reverse();
            }
            times
        }
        (Times::Until { every, .. }, Some(grid)) => {
            let multiples = (0..=grid.steps() / every).map(|k| grid.time(k * every));
            let mut times: Vec<f64> = multiples.collect();
            if times.last() != Some(&last) {
                times.push(last);
            }
            times
        }
        (Times::Until { .. }, None) => Vec::new(),
    }
}

/// How many of so many members a thread takes at a time: as many as there are lanes, or less where some threads had none.
fn share(count: usize, threads: usize, most: usize) -> usize {
    let lanes = count.div_ceil(threads).clamp(1, LANES);
    let groups = count / (threads * SHARES * lanes);
    lanes * groups.clamp(1, most / LANES)
}

impl Question for Ensemble {
    /// The next members, in order; or that there is not enough memory for their rows.
    type Found = Result<Vec<Member>, Exceeded>;

    fn put(self, work: &Work, session: &mut Session<'_, Self::Found>) -> Result<(), End> {
        let threads = self.threads.clamp(1, self.some.len().max(1));
        let most = match take_turns(&self.plan.method, self.plan.tolerances) {
            true => TURNS,
            false => SHARE,
        };
        let share = share(self.some.len(), threads, most);
        let ahead = share.min(SHARE) * threads * AHEAD;
        let waiting = self.size(self.some.len().min(ahead + share * threads));
        if let Err(exceeded) = memory::fits(waiting) {
            session.found(Err(exceeded));
            return Ok(());
        }
        let run = self.plan.run(Default::default());
        let options = run.options();
        let ensemble = Running {
            work,
            options: Options {
                save: if self.ends { Save::Ends } else { options.save },
                assess: 0,
                ..options
            },
            span: run.span(),
            asked: &self,
            share,
            ahead,
            watch: Watch::default(),
            queue: Mutex::new((self.some.start, self.some.start)),
            moved: Condvar::new(),
        };
        ensemble.on_threads(threads, session)?;
        if ensemble.watch.full() {
            session.found(Err(Exceeded::by(waiting)));
        }
        Ok(())
    }
}

/// An ensemble on its way.
struct Running<'a> {
    work: &'a Work,
    asked: &'a Ensemble,
    options: Options,
    span: (f64, f64),
    /// Members that a thread takes at a time.
    share: usize,
    /// Members that may be done before those that come before them.
    ahead: usize,
    watch: Watch,
    /// The next member to be run, and the next to be told of.
    queue: Mutex<(usize, usize)>,
    /// Members were told of, or all is to end.
    moved: Condvar,
}

/// A share: its first member, and all.
type Done = (usize, Vec<Member>);

impl Running<'_> {
    fn stops(&self) -> bool {
        self.watch.stop.load(Ordering::Relaxed)
    }

    fn queue(&self) -> MutexGuard<'_, (usize, usize)> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next share, as soon as it is not too far ahead; none at the end.
    fn next(&self) -> Option<Range<usize>> {
        let end = self.asked.some.end;
        let mut queue = self.queue();
        while !self.stops() && queue.0 < end && queue.0 >= queue.1 + self.ahead {
            let waited = self.moved.wait_timeout(queue, PAUSE);
            queue = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        if self.stops() || queue.0 >= end {
            return None;
        }
        let some = queue.0..(queue.0 + self.share).min(end);
        queue.0 = some.end;
        Some(some)
    }

    fn members(&self, some: Range<usize>) -> Vec<Member> {
        let (parameters, starts) = self.asked.cast.some(some.clone());
        let members = Members {
            declared: self.work.declared(),
            choice: &self.asked.plan.method,
            tolerances: self.asked.plan.tolerances,
            parameters,
            starts,
            count: self.asked.some.len(),
            span: self.span,
            options: self.options.clone(),
            held: Held {
                stream: self.asked.plan.held.stream + some.start as u64,
                ..self.asked.plan.held.clone()
            },
            sources: Sources(self.asked.plan.sources.clone()),
            events: self.asked.events,
        };
        members.run(0..some.len(), &self.watch)
    }

    fn work(&self, done: &Sender<Done>) {
        while let Some(some) = self.next() {
            let members = self.members(some.clone());
            // what was ended early is not whole
            let refused = members.iter().any(|member| member.refused.is_some());
            if (self.stops() && !refused) || done.send((some.start, members)).is_err() {
                return;
            }
        }
    }

    /// Runs all members on so many threads, and tells of them in order.
    fn on_threads(
        &self,
        threads: usize,
        session: &mut Session<'_, <Ensemble as Question>::Found>,
    ) -> Result<(), End> {
        std::thread::scope(|scope| {
            let (sender, done) = channel();
            // where the machine gives fewer threads, these do it all
            let spawn = |_| {
                let sender = sender.clone();
                let work = move || self.work(&sender);
                std::thread::Builder::new().spawn_scoped(scope, work).ok()
            };
            let threads: Vec<_> = (0..threads).map_while(spawn).collect();
            drop(sender);
            if threads.is_empty() {
                return Err(End::refused(
                    Obstacle::Option,
                    "the machine gives no thread",
                ));
            }
            let told = self.tell(&done, session);
            self.watch.stop.fetch_or(told.is_err(), Ordering::Relaxed);
            drop(done);
            let failed = |_| End::refused(Obstacle::Option, "a thread of the ensemble failed");
            let joined = threads.into_iter().try_for_each(|thread| thread.join());
            told.and(joined.map_err(failed))
        })
    }

    fn tell(
        &self,
        done: &std::sync::mpsc::Receiver<Done>,
        session: &mut Session<'_, <Ensemble as Question>::Found>,
    ) -> Result<(), End> {
        let count = self.asked.some.len() as u64;
        session.stage(0, count, "members")?;
        let mut waiting: BTreeMap<usize, Vec<Member>> = BTreeMap::new();
        loop {
            match done.recv_timeout(PAUSE) {
                Ok((first, members)) => {
                    if let Some(error) = members.iter().find_map(|one| one.refused.as_ref()) {
                        return Err(End::refused(Obstacle::Option, error.to_string()));
                    }
                    waiting.insert(first, members);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            }
            let mut told = self.queue().1;
            while let Some(members) = waiting.remove(&told) {
                told += members.len();
                session.found(Ok(members));
                self.queue().1 = told;
                self.moved.notify_all();
            }
            session.progress(self.watch.done.load(Ordering::Relaxed) as u64, count)?;
        }
    }
}
