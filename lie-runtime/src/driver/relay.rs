//! Members of an ensemble that take turns in the lanes of one stepper, by methods that choose their own steps: a lane whose member
//! has come to its end takes the next one, so that none waits for the slowest of eight.

use super::checks::{check_domain, check_start};
use super::grid::{Grid, Place};
use super::options::{OptionError, Options, Pace, Save};
use super::rows::Rows;
use crate::methods::{Keep, Legs, Method, Relay, StepReport, Stepper as _};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State as _;
use core::iter::Peekable;

/// Who takes turns.
pub trait Crew<S: Scalar, V> {
    /// Puts the initial state of the next member into a lane; answers the step of its grid, or nothing where there is no other member.
    fn enter(&mut self, lane: usize, mu: &mut V) -> Option<f64>;
    /// Takes a row of the member in a lane.
    fn row(&mut self, lane: usize, time: f64, mu: &V);
    /// Takes the member out of its lane: at its end, or else where its run could not begin or go on.
    fn leave(&mut self, lane: usize, is_at_end: bool);
    /// Whether all is to end early.
    fn stops(&self) -> bool;
}

/// Integrates members of one system from start to end, each with a grid of its own. A member has the rows of a run by itself, bit for
/// bit; why it could not go on, such a run says.
///
/// False where that cannot be, and nothing was done: the method does not choose its own steps, levels are kept, steps end at joints of
/// the time, or a row lies between two points of a grid.
///
/// # Errors
/// [`OptionError`] for invalid options.
pub fn relay<S: Scalar, P: Poisson<S>, M: Method<S, P>>(
    system: &P,
    method: &M,
    (span, options): ((f64, f64), &Options),
    crew: &mut impl Crew<S, P::State>,
) -> Result<bool, OptionError> {
    let on_grids = match options.pace {
        Pace::Step(step) => {
            let mut rows = Grid::new(span, step)?.rows(&options.save)?;
            rows.all(|row| matches!(row.place, Place::On(_)))
        }
        Pace::Tolerance(_) => options.save == Save::Ends,
    };
    let apart = options.keep != Keep::NOTHING || system.joint_count() > 0;
    if !method.own_steps() || apart || !on_grids {
        return Ok(false);
    }
    let mut stepper = method.stepper(system, S::one(), &options.newton);
    let mut members = Members {
        system,
        span,
        save: &options.save,
        crew,
        lanes: (0..S::LANES).map(|_| None).collect(),
    };
    Ok(stepper.relay(&mut system.zero_state(), &mut members))
}

/// How far the member in a lane has come.
struct Course {
    grid: Grid,
    rows: Peekable<Rows>,
    index: u64,
}

impl Course {
    fn new(span: (f64, f64), step: f64, save: &Save) -> Result<Self, OptionError> {
        let grid = Grid::new(span, step)?;
        Ok(Self {
            grid,
            rows: grid.rows(save)?.peekable(),
            index: 0,
        })
    }
}

/// The members in the lanes.
struct Members<'a, P, C> {
    system: &'a P,
    span: (f64, f64),
    save: &'a Save,
    crew: &'a mut C,
    lanes: Vec<Option<Course>>,
}

impl<P, C> Members<'_, P, C> {
    fn leave<S: Scalar>(&mut self, lane: usize, is_at_end: bool)
    where
        P: Poisson<S>,
        C: Crew<S, P::State>,
    {
        self.lanes[lane] = None;
        self.crew.leave(lane, is_at_end);
    }

    /// Puts a member into a lane, if there is another one that can begin.
    fn enter<S: Scalar>(&mut self, lane: usize, mu: &mut P::State) -> bool
    where
        P: Poisson<S>,
        C: Crew<S, P::State>,
    {
        while let Some(step) = self.crew.enter(lane, mu) {
            if let Ok(course) = Course::new(self.span, step, self.save) {
                self.lanes[lane] = Some(course);
                self.set_time(lane, mu);
                return true;
            }
            self.leave(lane, false);
        }
        false
    }

    /// Sets the time of the state in a lane, where H depends on it.
    fn set_time<S: Scalar>(&self, lane: usize, mu: &mut P::State)
    where
        P: Poisson<S>,
    {
        if let (Some(clock), Some(course)) = (self.system.clock(), &self.lanes[lane]) {
            let time = S::Lane::from_f64(course.grid.time(course.index));
            let entry = &mut mu.as_mut_slice()[clock.time];
            *entry = entry.with_lane(lane, time);
        }
    }

    /// Shows the rows where the member in a lane is; whether it goes on from there.
    fn goes_on<S: Scalar>(&mut self, lane: usize, mu: &P::State) -> bool
    where
        P: Poisson<S>,
        C: Crew<S, P::State>,
    {
        let Some(course) = &mut self.lanes[lane] else {
            return false;
        };
        let here = Place::On(course.index);
        while let Some(row) = course.rows.next_if(|row| row.place == here) {
            self.crew.row(lane, row.time, mu);
        }
        let is_at_end = course.index == course.grid.steps();
        if is_at_end {
            self.leave(lane, true);
        }
        !is_at_end
    }

    /// The steps of the grids, and 1 where there is no member.
    fn steps<S: Scalar>(&self) -> S {
        let step = |course: &Course| course.grid.step();
        S::from_lanes(|lane| S::Lane::from_f64(self.lanes[lane].as_ref().map_or(1.0, step)))
    }
}

impl<S: Scalar, P: Poisson<S>, C: Crew<S, P::State>> Relay<S, P::State> for Members<'_, P, C> {
    fn next(&mut self, mu: &mut P::State, arrived: S::Mask, refused: S::Mask) -> Legs<S> {
        let (mut looked, mut refused) = (arrived.bits(), refused.bits());
        for lane in S::Mask::from_bits(looked).lanes() {
            if let Some(course) = &mut self.lanes[lane] {
                course.index += 1;
            }
            self.set_time(lane, mu);
        }
        if looked != 0 {
            let checked = check_domain(self.system, mu, StepReport::default());
            refused |= checked.map_or_else(|failure| failure.lanes & looked, |()| 0);
        }
        let (mut begin, mut anew) = (0, 0);
        loop {
            S::Mask::from_bits(refused)
                .lanes()
                .for_each(|lane| self.leave(lane, false));
            for lane in S::Mask::from_bits(looked & !refused).lanes() {
                begin |= u64::from(self.goes_on(lane, mu)) << lane;
            }
            if self.crew.stops() {
                begin = 0;
                break;
            }
            looked = 0;
            for lane in 0..S::LANES {
                let entered = self.lanes[lane].is_none() && self.enter(lane, mu);
                looked |= u64::from(entered) << lane;
            }
            if looked == 0 {
                break;
            }
            anew |= looked;
            let checked = check_start(self.system, mu);
            refused = checked.map_or_else(|failure| failure.lanes & looked, |()| 0);
        }
        Legs {
            begin: S::Mask::from_bits(begin),
            anew: S::Mask::from_bits(anew & begin),
            h: self.steps(),
        }
    }
}
