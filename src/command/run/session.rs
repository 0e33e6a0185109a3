//! Runs on the way, one behind the other.

use std::io::{self, IsTerminal as _};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lie_in_process::request::{Member, Several};
use lie_program::protocol::{Held, Obstacle};
use lie_runtime::driver::{Density, Pace};

use super::bar::Bar;
use super::checkpoint::refused;
use super::events::{self, Table};
use super::keeper::{Keeper, Unwritten};
use super::layout::Layout;
use super::picked;
use super::picture::{Form, Picture, rounded};
use super::reception::{Received, Reception};
use super::said::{
    missed, of_density, of_noise, of_projection, of_tolerance, stopped_text, title, word,
};
use super::summary::{self, Drift, Steps};
use super::tally::{MOST_LINES, Tally};
use super::{assessed_up_to, impossible, outputs};
use crate::build::talk::{Outcome, Worker};
use crate::command::args;
use crate::command::files::unwritable;
use crate::command::fold::folded;
use crate::compiler::Spec;
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED, keep_refused, step_refused};
use crate::render;
use lie_output::{Destination, Rows, Run};

/// What all runs have in common.
pub struct Session<'a> {
    pub spec: &'a Spec,
    pub several: &'a Several,
    pub flags: &'a args::Run,
    pub workers: &'a [Arc<Worker>],
    pub interrupt: &'a Interrupt,
}

impl Session<'_> {
    /// Makes all runs: one that stops early does not keep the others from theirs.
    ///
    /// # Errors
    /// As of `lie run`.
    pub fn run_all(
        &self,
        mut rows: Rows,
        (mut picture, mut events): (Option<(Picture<'_>, Form, Destination)>, Option<Table>),
        mut keeper: Option<Keeper>,
    ) -> Result<u8, Failure> {
        let clock = Instant::now();
        if !self.flags.quiet {
            picked::say(self.spec, &self.several.plans);
        }
        let mut tally = Tally::new(self.several);
        let mut ended = Ok(0);
        // Rows that scroll by on the same terminal say enough.
        let scrolls = self.flags.out.is_none() && io::stdout().is_terminal();
        let bar = Bar::new(!self.flags.quiet && !scrolls);
        for (number, member) in self.several.members.iter().enumerate() {
            let start = Instant::now();
            let drawn = picture.as_mut().map(|(picture, ..)| picture);
            let kept = keeper.as_mut();
            let before = kept.as_ref().map_or(Duration::ZERO, |kept| kept.before());
            let run = self.one((number, member), &mut rows, drawn, kept, &bar);
            let (outcome, received) = match run {
                Ok(run) => run,
                Err(failure) => {
                    ended = Err(failure);
                    break;
                }
            };
            if let Some(table) = &mut events {
                table.add(number, &received.events);
            }
            let goes_on = matches!(outcome, Outcome::Done | Outcome::Stopped(_));
            let done = matches!(outcome, Outcome::Done);
            let interrupted = matches!(outcome, Outcome::Interrupted(_));
            if !self.flags.quiet && done {
                let time = before + start.elapsed();
                bar.aside(|| self.say(number, member, &received, time, &mut tally));
            }
            if let Some((picture, ..)) = &mut picture {
                let name = self.short_name(number, member);
                let event = received.events.last().filter(|event| event.stops);
                match (&outcome, event) {
                    (Outcome::Stopped(stop), _) => picture.stopped(&name, stop.time),
                    (Outcome::Done, Some(event)) => picture.ended(&name, event),
                    _ => {}
                }
            }
            let drift = &received.drift;
            let code = bar.aside(|| self.ended(number, member, outcome, drift, &mut tally));
            if let (Some(keeper), true) = (&keeper, interrupted && !self.flags.quiet) {
                render::say(&keeper.remedy());
            }
            match code {
                Ok(0) => {}
                other => ended = other,
            }
            if !goes_on {
                break;
            }
        }
        bar.clear();
        let whole = matches!(ended, Ok(0 | STOPPED));
        let written = match whole || rows.have_begun() {
            true => rows.finish().map_err(|error| self.lost(error)),
            false => Ok(()),
        };
        // rows that cannot be written do not take the picture with them
        let drawn = picture.map_or(Ok(()), |picture| self.draw(picture, whole));
        let listed = events.map_or(Ok(()), |table| table.finish(self.flags));
        let kept = match &mut keeper {
            Some(keeper) if matches!(ended, Ok(0)) && written.is_ok() => {
                keeper.finish().map_err(|error| self.lost(error))
            }
            _ => Ok(()),
        };
        if !self.flags.quiet {
            let several = self.several.labels.is_some();
            for plan in self.several.plans.iter().filter(|_| several) {
                let notes = of_projection(self.spec, plan).into_iter();
                for note in notes
                    .chain(of_density(plan))
                    .chain(of_noise(self.spec, plan))
                {
                    render::say(&folded(&format!("{}: {note}", plan.method.title())));
                }
            }
            render::say_all(&folded(&tally.text(clock.elapsed())));
        }
        [written, drawn, listed, kept].into_iter().fold(ended, also)
    }

    /// Writes the picture: of runs that did not come to their end, what there is of them; where there is nothing, the file stays
    /// as it was.
    fn draw(
        &self,
        (picture, form, destination): (Picture<'_>, Form, Destination),
        whole: bool,
    ) -> Result<(), Failure> {
        if !whole && picture.is_empty() {
            return Ok(());
        }
        let (svg, note) = picture.finish();
        let written = form.bytes(&svg)?;
        if let Some(path) = &self.flags.plot {
            let replaced = destination.replace(&written);
            replaced.map_err(|error| unwritable(path, &error))?;
        }
        if let Some(note) = note.filter(|_| !self.flags.quiet) {
            render::say(&format!("warning: {note}"));
        }
        Ok(())
    }

    fn lost(&self, error: io::Error) -> Failure {
        let inner = error.get_ref();
        if let Some(unwritten) = inner.and_then(|inner| inner.downcast_ref::<Unwritten>()) {
            let path = unwritten.0.display();
            let help = format!("make room; then `lie resume {path}` goes on from the one before");
            let message = Message::io(&unwritten.0, unwritten.to_string());
            return Failure::surroundings(message.help(help));
        }
        match (error.kind(), &self.flags.out) {
            (io::ErrorKind::BrokenPipe, None) => Failure::quiet(),
            (_, out) => outputs::writing_failed(out.as_deref(), &error),
        }
    }

    /// Makes one run.
    fn one<'a>(
        &self,
        (number, member): (usize, &Member),
        rows: &mut Rows,
        mut picture: Option<&mut Picture<'a>>,
        keeper: Option<&mut Keeper>,
        bar: &Bar,
    ) -> Result<(Outcome, Received), Failure> {
        let plan = &self.several.plans[member.plan];
        let run = Run {
            number,
            method: match self.several.labels {
                Some(_) => plan.method.label(),
                None => plan.method.id().to_owned(),
            },
            parameters: member.parameters.clone(),
            step: f64::NAN,
            kept: plan.kept(self.spec),
            density: plan.density,
            seed: self
                .spec
                .model
                .driving
                .as_ref()
                .filter(|d| d.is_noisy())
                .map(|_| plan.held.seed),
        };
        let layout = Layout::new(&self.spec.model, plan.chart, &member.start.parameters);
        if let Some(picture) = &mut picture {
            picture.begin(&self.short_name(number, member), plan, &member.start);
        }
        let place = keeper.as_ref().and_then(|keeper| keeper.place().cloned());
        let milestones = keeper.as_ref().map(|keeper| keeper.milestones());
        let curve = picture.is_some();
        let mut reception = Reception::new(self.spec, plan, layout, run, rows, (picture, keeper));
        let request = lie_program::protocol::Run {
            times: reception.times(plan),
            from_milestone: place.as_ref().map(|place| place.milestone.clone()),
            milestones: milestones.unwrap_or_default(),
            assess: assessed_up_to(plan),
            curve,
            held: Held {
                stream: member.point as u64,
                ..plan.held.clone()
            },
            ..plan.run_of(&self.spec.model, member.start.clone())
        };
        if let Some(place) = &place {
            reception.take_up(place).map_err(|error| self.lost(error))?;
        }
        let (before, all) = (number as u64, self.several.members.len() as u64);
        let worker = &self.workers[member.plan];
        let outcome = worker.talk(
            request,
            self.interrupt,
            &mut |found| reception.record(found),
            &mut |progress| bar.show(before * progress.all + progress.done, all * progress.all),
        );
        let outcome = match outcome {
            Ok(Outcome::NotTaken(error)) if error.kind() == io::ErrorKind::InvalidData => {
                Outcome::Broken(error.to_string())
            }
            Ok(Outcome::NotTaken(error)) => {
                // what cannot take rows has ended them itself
                if error.get_ref().is_some_and(|inner| inner.is::<Unwritten>()) {
                    let _ = reception.finish("failed");
                }
                return Err(self.lost(error));
            }
            Ok(outcome) => outcome,
            Err(error) => return Err(worker.not_started(&error)),
        };
        let received = reception.finish(word(&outcome));
        Ok((outcome, received.map_err(|error| self.lost(error))?))
    }

    /// Says what a run has done.
    fn say(
        &self,
        number: usize,
        member: &Member,
        received: &Received,
        time: Duration,
        tally: &mut Tally,
    ) {
        let plan = &self.several.plans[member.plan];
        let (work, drift) = (&received.work, &received.drift);
        tally.record(member.plan, number, received);
        if self.several.labels.is_none() {
            let notes = of_projection(self.spec, plan).into_iter();
            let notes = notes
                .chain(of_density(plan))
                .chain(of_noise(self.spec, plan));
            for note in notes.chain(of_tolerance(plan, received)) {
                render::say(&folded(&note));
            }
            let title = title(self.spec, plan, received.smallest());
            let whose = match (plan.method.is_adaptive(), plan.pace.0) {
                (false, _) => Steps::Constant,
                (true, Pace::Step(_)) => Steps::Own,
                (true, Pace::Tolerance(_)) => Steps::OwnByTolerance,
            };
            let text = summary::text(&title, work, whose, drift, time);
            render::say(&folded(&text));
            if let Some(text) = events::said(&self.spec.model, &received.events) {
                render::say(&folded(&text));
            }
        } else if self.several.members.len() <= MOST_LINES {
            let mut title = self.named(number, member);
            if let Some(warning) = missed(received) {
                render::say(&folded(&format!("warning: {title}: {warning}")));
            }
            if let Pace::Tolerance(_) = plan.pace.0 {
                title.push_str(&format!(", step {:?}", received.smallest()));
            }
            let text = summary::line(&title, work, drift, time);
            render::say(&folded(&text));
        }
    }

    /// `run 3, midpoint, k = 1.2`.
    fn named(&self, number: usize, member: &Member) -> String {
        let mut parts = vec![format!("run {number}")];
        parts.extend(self.parts(member, |value| value));
        parts.join(", ")
    }

    /// `midpoint, k = 1.2`, where that tells it apart: as a picture has room for it.
    fn short_name(&self, number: usize, member: &Member) -> String {
        let parts = self.parts(member, rounded);
        match parts.is_empty() || self.several.repeated(number) {
            true => [vec![format!("run {number}")], parts].concat().join(", "),
            false => parts.join(", "),
        }
    }

    /// What tells the run apart, beside its number; numbers as they are to be written.
    fn parts(&self, member: &Member, written: fn(f64) -> f64) -> Vec<String> {
        let Some(labels) = &self.several.labels else {
            return Vec::new();
        };
        let method = labels.method.as_ref();
        let method = method.map(|_| self.several.plans[member.plan].method.title());
        let values = labels.parameters.iter().zip(&member.parameters);
        let values = values.map(|(name, value)| format!("{name} = {:?}", written(*value)));
        method.into_iter().chain(values).collect()
    }

    /// Says how a run ended, if not at its end; answers the exit code.
    fn ended(
        &self,
        number: usize,
        member: &Member,
        outcome: Outcome,
        drift: &Drift,
        tally: &mut Tally,
    ) -> Result<u8, Failure> {
        let plan = &self.several.plans[member.plan];
        let by_tolerance = matches!(plan.pace.0, Pace::Tolerance(_));
        let worker = &self.workers[member.plan];
        match outcome {
            Outcome::Done => Ok(0),
            Outcome::Interrupted(code) => {
                if !self.flags.quiet {
                    let time = drift.time();
                    render::say(&format!(
                        "Interrupted at t = {time:?}; the rows so far are written."
                    ));
                }
                Ok(code)
            }
            Outcome::Stopped(stop) => {
                if tally.stopped(member.plan) {
                    let who = match self.several.labels {
                        Some(_) => format!("{}: ", self.named(number, member)),
                        None => String::new(),
                    };
                    let why = stopped_text(&stop, "the rows so far are written");
                    render::stopped(&format!("{who}{why}"), &stop.remedy);
                }
                Ok(STOPPED)
            }
            Outcome::Refused(Obstacle::Option, why) if plan.density == Density::Reversible => {
                let help = "leave it out, for steps of one size";
                Err(Message::option("--density", why).help(help).into())
            }
            Outcome::Refused(Obstacle::Option, why) if by_tolerance => {
                let help = "give a step by `--step`, or another tolerance";
                Err(Message::option("--tol", why).help(help).into())
            }
            Outcome::Refused(Obstacle::Option, why) => Err(step_refused(why).into()),
            Outcome::Refused(Obstacle::Keep, why) => Err(keep_refused(why).into()),
            Outcome::Refused(Obstacle::Milestone, why) => {
                let path = self.flags.checkpoint.as_deref().unwrap_or(Path::new(""));
                let help = "begin the run anew with `lie run`";
                Err(refused(path, why).help(help).into())
            }
            Outcome::Parameter(name, why) => Err(impossible(&name, &why)),
            Outcome::Refused(what, why) => Err(worker.broken(&format!("{what:?}: {why}"))),
            Outcome::Broken(how) => Err(worker.broken(&how)),
            Outcome::NotTaken(error) => Err(worker.broken(&error.to_string())),
        }
    }
}

/// What a command ends with, of which something else has failed too.
fn also(ended: Result<u8, Failure>, further: Result<(), Failure>) -> Result<u8, Failure> {
    match (ended, further) {
        (ended, Ok(())) => ended,
        (Ok(code), Err(further)) if further.messages.is_empty() && code != 0 => Ok(code),
        (Ok(_), Err(further)) => Err(further),
        (Err(mut failure), Err(further)) => {
            failure.messages.extend(further.messages);
            Err(failure)
        }
    }
}
