//! Members on their way into the file, in order.

use std::io;

use lie_in_process::key::Key;
use lie_in_process::members::Member;
use lie_in_process::reduce::Moments;
use lie_in_process::share::{Failed, Record};

use super::beside::{Beside, Rest};
use crate::command::run::outputs::writing_failed;
use crate::message::Failure;
use crate::output::{Rows, Run};

/// Takes members.
pub struct Gathering {
    rows: Rows,
    rest: Rest,
    record: Record,
    moments: Option<Moments>,
    /// Where the columns stand in a state.
    places: Vec<usize>,
    /// How many members were taken.
    taken: usize,
    /// Of their numbers.
    key: Key,
}

impl Gathering {
    /// Before the first member: what the file will be is said, and that it is not that yet.
    ///
    /// # Errors
    /// `io`.
    pub fn begin(beside: Beside, record: Record, places: Vec<usize>) -> Result<Self, Failure> {
        let (members, rest) = beside.split();
        rest.say(&record)?;
        let shape = [record.times.len(), record.columns.len()];
        Ok(Self {
            rows: Rows::of_array(members, record.shape()),
            moments: rest.wants_moments().then(|| Moments::new(shape)),
            rest,
            record,
            places,
            taken: 0,
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
        let mut numbers = Vec::with_capacity(members.len() * wanted * self.places.len());
        for member in members {
            let rows = member.times.len();
            if rows > wanted || (rows < wanted && member.failed.is_none() && !member.ended) {
                let text = format!("a member has {rows} rows for {wanted} times");
                return Err(io::Error::new(io::ErrorKind::InvalidData, text));
            }
            if let Some(width) = member.states.len().checked_div(rows) {
                let states = member.states.chunks_exact(width);
                numbers
                    .extend(states.flat_map(|state| self.places.iter().map(|&place| state[place])));
            }
            numbers.extend(std::iter::repeat_n(
                f64::NAN,
                (wanted - rows) * self.places.len(),
            ));
            self.record
                .failures
                .extend(member.failed.map(|(time, why)| Failed {
                    member: before + self.taken,
                    time,
                    why,
                }));
            self.taken += 1;
        }
        self.push(&numbers)
    }

    /// Takes the numbers of whole members.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn push(&mut self, numbers: &[f64]) -> io::Result<()> {
        if let Some(moments) = &mut self.moments {
            let size = self.record.times.len() * self.record.columns.len();
            numbers
                .chunks_exact(size)
                .for_each(|member| moments.push(member));
        }
        for number in numbers {
            self.key = std::mem::take(&mut self.key).bytes(&number.to_le_bytes());
        }
        self.rows.open(&Run::default())?;
        self.rows.push(numbers)
    }

    /// Ends it in the middle; answers how many members are in the file.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn abandon(self) -> io::Result<usize> {
        self.rows.finish()?;
        Ok(self.taken)
    }

    /// Writes what stands beside all members, and that they are all.
    ///
    /// # Errors
    /// `io`.
    pub fn end(mut self, out: &std::path::Path) -> Result<Record, Failure> {
        let finished = self.rows.finish();
        finished.map_err(|error| writing_failed(Some(out), &error))?;
        let found = self
            .moments
            .map_or((Vec::new(), Vec::new()), Moments::found);
        self.rest.reduce(&mut self.record, found)?;
        self.record.complete = true;
        self.record.numbers = Some(self.key.hex());
        self.rest.say(&self.record)?;
        Ok(self.record)
    }
}
