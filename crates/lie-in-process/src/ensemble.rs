//! Many trajectories on several threads. The bits of a member depend neither on the number of threads nor on the members
//! beside it.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use lie_program::protocol::{End, Obstacle};
use lie_program::session::Session;
use lie_runtime::driver::{Options, Pace, Save};

use crate::members::{LANES, Member, Members, Watch};
use crate::memory::{self, Exceeded};
use crate::request::Plan;
use crate::{Question, Work};

/// The most members that a thread takes at a time.
const SHARE: usize = 64;
/// Shares of each thread, so that none waits long for another.
const SHARES: usize = 8;
/// Between two looks how far the threads are.
const PAUSE: Duration = Duration::from_millis(1);

/// Trajectories by one method from many starts.
pub struct Ensemble {
    /// How each of them is made.
    pub plan: Plan,
    /// Whether only their ends are kept.
    pub ends: bool,
    /// The values of the parameters: a row for each member, or one for all.
    pub parameters: Vec<Vec<f64>>,
    /// Their initial states.
    pub starts: Vec<Vec<f64>>,
    /// On so many threads.
    pub threads: usize,
}

impl Ensemble {
    /// Bytes of all rows: of each member alone, and of all together.
    fn size(&self) -> f64 {
        let plan = &self.plan;
        let rows = match (self.ends, plan.pace.0) {
            (false, Pace::Step(step)) => memory::rows(&plan.times, plan.from, step),
            (false, Pace::Tolerance(_)) => memory::rows(&plan.times, plan.from, f64::INFINITY),
            (true, _) => 1.0,
        };
        let width = 1.0 + self.starts.first().map_or(0.0, |start| start.len() as f64);
        2.0 * rows * width * self.starts.len() as f64 * memory::NUMBER
    }
}

/// How many of so many members a thread takes at a time: as many as there are lanes, or less where some threads had none.
fn share(count: usize, threads: usize) -> usize {
    let lanes = count.div_ceil(threads).clamp(1, LANES);
    let groups = count / (threads * SHARES * lanes);
    lanes * groups.clamp(1, SHARE / LANES)
}

impl Question for Ensemble {
    /// All members, in order; or that there is not enough memory for their rows.
    type Found = Result<Vec<Member>, Exceeded>;

    fn put(self, work: &Work, session: &mut Session<'_, Self::Found>) -> Result<(), End> {
        let run = self.plan.run(Default::default());
        let size = self.size();
        if let Err(exceeded) = memory::fits(size) {
            session.found(Err(exceeded));
            return Ok(());
        }
        let options = run.options();
        let members = Members {
            declared: work.declared(),
            choice: &self.plan.method,
            tolerances: self.plan.tolerances,
            parameters: self.parameters,
            starts: self.starts,
            span: run.span(),
            options: Options {
                save: if self.ends { Save::Ends } else { options.save },
                assess: 0,
                ..options
            },
        };
        let watch = Watch::default();
        let found = on_threads(&members, self.threads, &watch, session)?;
        if let Some(error) = found.iter().find_map(|member| member.refused.as_ref()) {
            return Err(End::refused(Obstacle::Option, error.to_string()));
        }
        session.found(match watch.full() {
            true => Err(Exceeded::by(size)),
            false => Ok(found),
        });
        Ok(())
    }
}

/// All members, on so many threads.
fn on_threads(
    members: &Members<'_>,
    threads: usize,
    watch: &Watch,
    session: &mut Session<'_, Result<Vec<Member>, Exceeded>>,
) -> Result<Vec<Member>, End> {
    let count = members.starts.len();
    let threads = threads.clamp(1, count.max(1));
    let share = share(count, threads);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done: Vec<(usize, Member)> = Vec::new();
        loop {
            let first = next.fetch_add(share, Ordering::Relaxed);
            if first >= count || watch.stop.load(Ordering::Relaxed) {
                return done;
            }
            let last = (first + share).min(count);
            done.extend((first..last).zip(members.run(first..last, watch)));
        }
    };
    let mut all: Vec<(usize, Member)> = std::thread::scope(|scope| {
        // where the machine gives fewer threads, these do it all
        let spawn = |_| std::thread::Builder::new().spawn_scoped(scope, work).ok();
        let threads: Vec<_> = (0..threads).map_while(spawn).collect();
        if threads.is_empty() {
            return Err(End::refused(
                Obstacle::Option,
                "the machine gives no thread",
            ));
        }
        let mut told = session.stage(0, count as u64, "members");
        while threads.iter().any(|thread| !thread.is_finished()) {
            std::thread::sleep(PAUSE);
            if told.is_ok() {
                let done = watch.done.load(Ordering::Relaxed) as u64;
                told = session.progress(done, count as u64);
            }
            watch.stop.fetch_or(told.is_err(), Ordering::Relaxed);
        }
        told?;
        let found = threads.into_iter().map(|thread| thread.join());
        let found: Result<Vec<_>, _> = found.collect();
        let failed = |_| End::refused(Obstacle::Option, "a thread of the ensemble failed");
        Ok(found.map_err(failed)?.into_iter().flatten().collect())
    })?;
    all.sort_by_key(|(member, _)| *member);
    Ok(all.into_iter().map(|(_, member)| member).collect())
}
