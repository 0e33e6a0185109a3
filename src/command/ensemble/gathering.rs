//! Members on their way into the file, in order.

use std::io;

use lie_in_process::key::Key;
use lie_in_process::members::Member;
use lie_in_process::reduce::{Found, Moments};
use lie_in_process::share::{Failed, Record};

use super::beside::{Beside, Rest};
use super::stops::Stopping;
use super::table::Table;
use crate::command::run::outputs::writing_failed;
use crate::message::Failure;
use lie_output::{Rows, Run};

/// What is taken of a member.
#[derive(Default)]
pub struct Taking {
    /// Where the columns stand in a state.
    pub places: Vec<usize>,
    /// Which of the declared events end members.
    pub stops: Vec<usize>,
    /// Where its events go.
    pub table: Option<Table>,
}

/// Takes members.
pub struct Gathering {
    rows: Rows,
    stopping: Option<Stopping>,
    rest: Rest,
    record: Record,
    moments: Option<Moments>,
    taking: Taking,
    /// How many members were taken, by their states and by their numbers.
    taken: usize,
    pushed: usize,
    /// Of their numbers.
    key: Key,
}

impl Gathering {
    /// Before the first member: what the file will be is said, and that it is not that yet.
    ///
    /// # Errors
    /// `io`.
    pub fn begin(beside: Beside, mut record: Record, mut taking: Taking) -> Result<Self, Failure> {
        let (members, stops, rest) = beside.split();
        rest.say(&record)?;
        taking.table.as_mut().map_or(Ok(()), Table::begin)?;
        let shape = [record.times.len(), record.columns.len()];
        record.counts = vec![0; shape[0]];
        Ok(Self {
            rows: Rows::of_array(members, record.shape()),
            stopping: stops.map(|stops| Stopping::begin(stops, &rest.out, &record)),
            moments: rest.wants_moments().then(|| Moments::new(shape)),
            rest,
            record,
            taking,
            taken: 0,
            pushed: 0,
            key: Key::new(),
        })
    }

    /// Takes the next members.
    ///
    /// # Errors
    /// They cannot be written; `InvalidData` for rows that are not those of the times.
    pub fn take(&mut self, members: Vec<Member>) -> io::Result<()> {
        let wanted = self.record.times.len();
        let before = self.record.share.members(self.record.members).start;
        let mut numbers = Vec::with_capacity(members.len() * wanted * self.taking.places.len());
        let mut stops = Vec::with_capacity(members.len() * self.taking.stops.len());
        for member in members {
            let rows = member.times.len();
            let is_short = member.failed.is_some() || member.stopped.is_some();
            if rows > wanted || (rows < wanted && !is_short) {
                let text = format!("a member has {rows} rows for {wanted} times");
                return Err(io::Error::new(io::ErrorKind::InvalidData, text));
            }
            let places = &self.taking.places;
            if let Some(width) = member.states.len().checked_div(rows) {
                for state in member.states.chunks_exact(width) {
                    numbers.extend(places.iter().map(|&place| state[place]));
                }
            }
            numbers.extend(std::iter::repeat_n(
                f64::NAN,
                (wanted - rows) * places.len(),
            ));
            stops.extend(self.taking.stops.iter().map(|&event| {
                let stop = member.stopped.filter(|stop| stop.event == event);
                stop.map_or(f64::NAN, |stop| stop.time)
            }));
            let number = before + self.taken;
            if let Some(table) = &mut self.taking.table {
                table.add(number, &member.events);
            }
            self.record
                .failures
                .extend(member.failed.map(|(time, why)| Failed {
                    member: number,
                    time,
                    why,
                }));
            self.taken += 1;
        }
        self.push(&numbers, &stops)?;
        match &mut self.taking.table {
            Some(table) => table.send(),
            None => Ok(()),
        }
    }

    /// Takes the numbers of whole members, and when events ended these.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn push(&mut self, numbers: &[f64], stops: &[f64]) -> io::Result<()> {
        if let Some(stopping) = &mut self.stopping {
            stopping.push(stops)?;
        }
        let columns = self.record.columns.len();
        let size = self.record.times.len() * columns;
        let none = vec![f64::NAN; size];
        for member in numbers.chunks_exact(size) {
            let gone = self.stopping.as_ref();
            let gone = gone.is_some_and(|stopping| stopping.is_gone(self.pushed));
            let going = if gone { &none } else { member };
            for (count, state) in self
                .record
                .counts
                .iter_mut()
                .zip(going.chunks_exact(columns))
            {
                *count += u64::from(!state.iter().any(|x| x.is_nan()));
            }
            if let Some(moments) = &mut self.moments {
                moments.push(going);
            }
            self.pushed += 1;
        }
        for number in numbers {
            self.key = std::mem::take(&mut self.key).bytes(&number.to_le_bytes());
        }
        self.rows.open(&Run::default())?;
        self.rows.push(numbers)
    }

    /// Where lines of events go.
    pub fn table(&mut self) -> Option<&mut Table> {
        self.taking.table.as_mut()
    }

    /// Ends it in the middle; answers how many members are in the file.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn abandon(self) -> io::Result<usize> {
        self.rows.finish()?;
        self.stopping.map_or(Ok(()), Stopping::abandon)?;
        Ok(self.taken)
    }

    /// Writes what stands beside all members, and that they are all.
    ///
    /// # Errors
    /// `io`.
    pub fn end(mut self, out: &std::path::Path) -> Result<Record, Failure> {
        let finished = self.rows.finish();
        finished.map_err(|error| writing_failed(Some(out), &error))?;
        let gone = match (self.stopping, &mut self.record.stops) {
            (Some(stopping), Some(stops)) => stopping.end(stops)?,
            _ => Vec::new(),
        };
        let found = self.moments.map_or_else(Found::default, Moments::found);
        self.rest.reduce(&mut self.record, (&found, &gone))?;
        if let (Some(said), Some(table)) = (&mut self.record.events, &self.taking.table) {
            said.digest = Some(table.digest());
        }
        self.record.complete = true;
        self.record.numbers = Some(self.key.hex());
        self.rest.say(&self.record)?;
        Ok(self.record)
    }
}
