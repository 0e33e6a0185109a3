//! Many trajectories of one declaration: members of an ensemble or of a sweep, eight at a time in lanes by methods whose step is a
//! program, and by Taylor series.
//!
//! Every lane has the bits of the member run alone, so that nobody can tell which members were side by side. A member that
//! fails is run again alone, and says what it says alone; the others of its group are run again without it. Where members choose
//! their own steps, they take turns.

mod kept;
mod member;
mod turns;

use lie_codegen::methods::Choice;
use lie_dynamic::{Declared, Dynamic, Method, Tolerances, is_compiled_for_lanes};
use lie_methods::{method, method_in_lanes};
use lie_program::protocol::{Held, Sources};
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{
    IntegrateError, OptionError, Options, Pace, Problem, Save, Status, integrate,
};
use lie_runtime::{ParameterError, Poisson, Scalar};
use std::ops::Range;
use std::sync::atomic::Ordering;

use kept::Kept;
pub use member::{Member, Stop, Watch};
use turns::method_in_turns;
pub use turns::take_turns;

/// Lanes of double precision.
type Wide = <f64 as Scalar>::Wide;

/// So many members are side by side.
pub const LANES: usize = Wide::LANES;
/// Fewer members than this are run alone: a step in lanes takes as long as 2 to 5 steps alone, whether all lanes are used or not.
const LEAST: usize = 6;
/// So often a group is run again without the members that failed; then all are run alone.
const TRIES: usize = 2;

/// What is integrated.
pub struct Members<'a> {
    /// The system before its parameters have values.
    pub declared: &'a Declared,
    /// The method.
    pub choice: &'a Choice,
    /// The tolerances of a method that has some.
    pub tolerances: Tolerances,
    /// A row for each member, or one for all.
    pub parameters: Vec<Vec<f64>>,
    /// The initial state of each member.
    pub starts: Vec<Vec<f64>>,
    /// How many there are in all, of which these may be some.
    pub count: usize,
    /// The options of every run; of [`Save::Ends`] the end alone is kept.
    pub options: Options,
    /// Start and end.
    pub span: (f64, f64),
    /// What is held from step to step; streams of noise are numbered from that of the first member on.
    pub held: Held,
    /// Where the values of inputs come from, in a call.
    pub sources: Sources,
    /// Whether events are kept. Those that stop end their members anyway.
    pub events: bool,
}

/// What a thread needs to run members.
struct Worker<'a> {
    members: &'a Members<'a>,
    watch: &'a Watch,
    alone: Method,
    /// Side by side with steps of the same number, and taking turns.
    together: Option<Method<Wide>>,
    turns: Option<Method<Wide>>,
}

/// Why a group was not run to its end.
enum Lost {
    /// These lanes failed.
    Lanes(u64),
    /// The options suit no run.
    All,
}

impl Members<'_> {
    /// Runs some of the members, in order. Sets `stop` where the options suit no member, and ends early where it is set.
    pub fn run(&self, some: Range<usize>, watch: &Watch) -> Vec<Member> {
        let alone = method(self.choice, self.tolerances);
        let in_lanes = || method_in_lanes(self.choice, self.tolerances);
        let worker = Worker {
            members: self,
            watch,
            alone,
            together: self.takes_lanes().then(in_lanes).flatten(),
            turns: method_in_turns(self.choice, self.tolerances),
        };
        let mut found = Vec::with_capacity(some.len());
        while found.len() < some.len() && !watch.stopped() {
            let left = some.start + found.len()..some.end;
            match worker.in_turns(left.clone()) {
                Some(done) => worker.rest_alone(left.start, done, &mut found),
                None => worker.group(left.start..left.end.min(left.start + LANES), &mut found),
            }
        }
        found.resize_with(some.len(), Member::default);
        found
    }

    /// Whether members go in lanes: with a fixed step, and a method that is compiled for lanes, or where there are steps enough,
    /// one whose step is compiled as a whole.
    pub fn takes_lanes(&self) -> bool {
        let fixed = matches!(self.options.pace, Pace::Step(_));
        let apart = is_compiled_for_lanes(self.choice) || self.is_long();
        fixed && apart && method_in_lanes(self.choice, self.tolerances).is_some()
    }

    /// Whether all members together make so many steps that programs of the whole pay.
    fn is_long(&self) -> bool {
        self.steps() > f64::from(self.declared.patience())
    }

    /// The steps of all members; none where each run chooses its own.
    fn steps(&self) -> f64 {
        match self.options.pace {
            Pace::Step(step) => ((self.span.1 - self.span.0) / step).abs() * self.count as f64,
            Pace::Tolerance(_) => 0.0,
        }
    }

    /// Whether members of a system look for its events, which no two of them do side by side.
    fn await_events(&self, system: &Dynamic<f64>) -> bool {
        let count = Poisson::<f64>::event_count(system);
        let stops = |index| Poisson::<f64>::event_rule(system, index).stops;
        (0..count).any(|index| self.events || stops(index))
    }

    fn parameters(&self, member: usize) -> &[f64] {
        match self.parameters.as_slice() {
            [only] => only,
            all => &all[member],
        }
    }

    /// The systems of members: one for all where they have the same parameters.
    fn systems(&self, members: Range<usize>) -> Vec<Result<Dynamic<f64>, ParameterError>> {
        let made = |member| {
            let system = self.declared.system(self.parameters(member))?;
            Ok(match self.is_long() {
                true => system.without_patience(),
                false => system,
            })
        };
        match self.parameters.len() {
            1 => vec![made(members.start); members.len()],
            _ => members.map(made).collect(),
        }
    }
}

impl Worker<'_> {
    /// Runs members that may be side by side.
    fn group(&self, members: Range<usize>, found: &mut Vec<Member>) {
        let systems = self.members.systems(members.clone());
        let mut all: Vec<Option<Member>> = vec![None; members.len()];
        if let Some(together) = &self.together {
            let there = systems.iter().enumerate();
            let there = there.filter_map(|(index, system)| Some((index, system.as_ref().ok()?)));
            let mut left: Vec<_> = there
                .filter(|(_, system)| system.takes_lanes(self.members.choice))
                .collect();
            // families of other sizes are other systems
            if let Some(sizes) = left.first().map(|(_, system)| system.sizes()) {
                left.retain(|(_, system)| system.sizes() == sizes);
            }
            for _ in 0..TRIES {
                if left.len() < LEAST {
                    break;
                }
                let starts = left.iter().map(|(index, _)| members.start + index);
                let starts: Vec<_> = starts
                    .map(|member| self.members.starts[member].as_slice())
                    .collect();
                let side_by_side: Vec<_> = left.iter().map(|(_, system)| *system).collect();
                let streams = left
                    .iter()
                    .map(|(index, _)| self.stream(members.start + index));
                let streams: Vec<u64> = streams.collect();
                match self.together(together, &side_by_side, (&starts, &streams)) {
                    Ok(lanes) => {
                        self.watch.done(lanes.len());
                        for ((index, _), member) in left.drain(..).zip(lanes) {
                            all[index] = Some(member);
                        }
                    }
                    Err(Lost::Lanes(lost)) => {
                        let mut lane = 0;
                        left.retain(|_| {
                            lane += 1;
                            lost >> (lane - 1) & 1 == 0
                        });
                    }
                    Err(Lost::All) => break,
                }
            }
        }
        let alone = members.zip(systems).zip(all);
        found.extend(alone.map(|((member, system), done)| {
            let alone = || self.one(system, member);
            done.unwrap_or_else(alone)
        }));
    }

    /// Takes members from the first on; those that are not there are run alone, unless all is to end.
    fn rest_alone(&self, first: usize, done: Vec<Option<Member>>, found: &mut Vec<Member>) {
        found.extend((first..).zip(done).map(|(member, done)| match done {
            Some(done) => done,
            None if self.watch.stopped() => Member::default(),
            None => {
                let system = self.members.systems(member..member + 1).remove(0);
                self.one(system, member)
            }
        }));
    }

    /// One member.
    fn one(&self, system: Result<Dynamic<f64>, ParameterError>, member: usize) -> Member {
        let member = match system {
            Ok(system) => self.alone(system, member),
            Err(error) => Member::failing(self.members.span.0, error.to_string()),
        };
        self.watch.done(1);
        member
    }

    /// A group side by side.
    fn together(
        &self,
        method: &Method<Wide>,
        systems: &[&Dynamic<f64>],
        (starts, streams): (&[&[f64]], &[u64]),
    ) -> Result<Vec<Member>, Lost> {
        let of_lane = |lane: usize| *starts.get(lane).unwrap_or(&starts[0]);
        let lengths = systems[0].dimension();
        // each member ends steps where its own parameters say, and runs at its own events
        let events = self.members.await_events(systems[0]);
        let joints = Poisson::<f64>::joint_count(systems[0]) > 0 || events;
        // and a controller sees one state
        let controlled = !self.members.sources.0.is_empty();
        if joints || controlled || starts.iter().any(|start| start.len() != lengths) {
            return Err(Lost::All);
        }
        let gather = |entry| Wide::new(std::array::from_fn(|lane| of_lane(lane)[entry]));
        let problem = Problem {
            system: Dynamic::in_lanes(systems),
            mu0: (0..lengths).map(gather).collect(),
            span: self.members.span,
        };
        let options = &self.members.options;
        let mut kept = Kept::new(options, self.watch);
        let (held, sources) = (&self.members.held, &self.members.sources);
        let held = held.in_lanes(&problem.system, problem.span.0, sources, streams);
        kept.held = held;
        match integrate(&problem, Forgotten(method.as_ref()), options, &mut kept) {
            Ok(_) => Ok((0..systems.len())
                .map(|lane| Member {
                    times: kept.times.clone(),
                    states: kept.states.iter().map(|entry| entry.lane(lane)).collect(),
                    ..Member::default()
                })
                .collect()),
            Err(IntegrateError::Step(error)) => Err(Lost::Lanes(error.failure.lanes)),
            Err(IntegrateError::Option(_)) => Err(Lost::All),
        }
    }

    /// Whether all members that come so far have a row at a time.
    fn has_row(&self, time: f64) -> bool {
        let (options, (start, end)) = (&self.members.options, self.members.span);
        let is_multiple = |of: f64| start + ((time - start) / of).round() * of == time;
        match (&options.save, options.pace) {
            (Save::At(times), _) => times.contains(&time),
            // the last row is at the end, on the grid or off it
            (Save::Every(_) | Save::Interval(_), _) if time == end => true,
            (Save::Every(every), Pace::Step(step)) => is_multiple(*every as f64 * step),
            (Save::Interval(interval), _) => is_multiple(*interval),
            _ => false,
        }
    }

    /// The stream of noise of a member.
    fn stream(&self, member: usize) -> u64 {
        self.members.held.stream + member as u64
    }

    fn alone(&self, system: Dynamic<f64>, member: usize) -> Member {
        let problem = Problem {
            system,
            mu0: self.members.starts[member].clone(),
            span: self.members.span,
        };
        let options = &self.members.options;
        let mut kept = Kept::new(options, self.watch);
        let (held, sources) = (&self.members.held, &self.members.sources);
        kept.awaits_events = self.members.await_events(&problem.system);
        kept.keeps_events = self.members.events;
        let streams = [self.stream(member)];
        kept.held = held.in_lanes(&problem.system, problem.span.0, sources, &streams);
        let outcome = integrate(&problem, Forgotten(self.alone.as_ref()), options, &mut kept);
        let mut member = Member {
            times: kept.times,
            states: kept.states,
            events: kept.events,
            ..Member::default()
        };
        match outcome {
            Ok((_, status)) => {
                member.stopped = kept.stopped.filter(|_| matches!(status, Status::Event(_)));
                // others have no row there
                if member.stopped.is_some()
                    && !kept.last_alone
                    && member.times.last().is_some_and(|time| !self.has_row(*time))
                {
                    member.times.pop();
                    let left = member.times.len() * problem.mu0.len();
                    member.states.truncate(left);
                }
                member
            }
            Err(IntegrateError::Step(error)) => {
                if kept.last_alone {
                    // the end was not reached
                    member.times.clear();
                    member.states.clear();
                }
                member.failed = Some((error.time, error.to_string()));
                member
            }
            Err(IntegrateError::Option(error @ OptionError::NoStep { .. })) => {
                Member::failing(self.members.span.0, error.to_string())
            }
            Err(IntegrateError::Option(error)) => {
                self.watch.stop.store(true, Ordering::Relaxed);
                Member {
                    refused: Some(error),
                    ..Member::default()
                }
            }
        }
    }
}
