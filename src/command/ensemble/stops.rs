//! When events ended members: an array beside them, and statistics of it.

use std::io;
use std::path::{Path, PathBuf};

use lie_in_process::key::Key;
use lie_in_process::reduce::{Moments, quantiles};
use lie_in_process::share::{Ended, Record, Stops};
use lie_in_process::words::{counted, with_digits, with_error};

use super::beside::{numbers, path_of_stops};
use crate::command::files::unwritable;
use crate::message::Failure;
use lie_output::{Destination, Rows, Run};

/// Takes the times at which members were ended: of each one for every event that stops, not a number where it was not that one.
pub struct Stopping {
    path: PathBuf,
    rows: Rows,
    events: usize,
    /// A row for each event.
    moments: Moments,
    key: Key,
    /// The time of the one row of members, where they have one.
    end: Option<f64>,
    /// Which members have a state there of an earlier time, at which they were ended.
    gone: Vec<bool>,
    members: usize,
}

impl Stopping {
    /// Before the first member.
    pub fn begin(destination: Destination, out: &Path, record: &Record) -> Self {
        let events = record.stopping();
        Self {
            path: path_of_stops(out),
            rows: Rows::of_array(destination, vec![events]),
            events,
            moments: Moments::new([events, 1]),
            key: Key::new(),
            end: record.times.last().copied().filter(|_| !record.rows),
            gone: Vec::new(),
            members: 0,
        }
    }

    /// Takes the times of whole members.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn push(&mut self, times: &[f64]) -> io::Result<()> {
        for member in times.chunks_exact(self.events) {
            self.moments.push(member);
            self.members += 1;
            if let Some(end) = self.end {
                let gone = member.iter().any(|time| !time.is_nan() && *time != end);
                self.gone.push(gone);
            }
        }
        for time in times {
            self.key = std::mem::take(&mut self.key).bytes(&time.to_le_bytes());
        }
        let pushed = self.rows.open(&Run::default());
        let pushed = pushed.and_then(|()| self.rows.push(times));
        let named = |error: io::Error| {
            io::Error::new(error.kind(), format!("{}: {error}", self.path.display()))
        };
        pushed.map_err(named)
    }

    /// Whether the state of a member is none of the time of its row.
    pub fn is_gone(&self, member: usize) -> bool {
        self.gone.get(member) == Some(&true)
    }

    /// Ends it in the middle.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn abandon(self) -> io::Result<()> {
        self.rows.finish()
    }

    /// Computes what is said of the times; answers which members are gone.
    ///
    /// # Errors
    /// `io`.
    pub fn end(self, stops: &mut Stops) -> Result<Vec<bool>, Failure> {
        let (path, size) = (&self.path, (self.members, self.events));
        let finished = self.rows.finish();
        let probabilities = &stops.quantiles;
        let found = finished.and_then(|()| quantiles(|| numbers(path), size, probabilities));
        let quantiles = found.map_err(|error| unwritable(path, &error))?;
        let moments = self.moments.found();
        for (place, ended) in stops.events.iter_mut().enumerate() {
            let (mean, variance) = (moments.means[place], moments.covariances[place]);
            ended.members = moments.counts[place];
            ended.mean = Some(mean).filter(|mean| mean.is_finite());
            ended.deviation = Some(variance.sqrt()).filter(|size| size.is_finite());
            let own = quantiles.iter().skip(place).step_by(self.events);
            ended.quantiles = own.copied().filter(|time| time.is_finite()).collect();
        }
        stops.numbers = Some(self.key.hex());
        Ok(self.gone)
    }
}

/// What the summary says of members that were ended, event by event.
pub fn said(record: &Record) -> Vec<String> {
    let all = record.share.members(record.members).len() as u64;
    let stops = record.stops.iter();
    let line = |stops: &Stops, ended: &Ended| {
        let (event, of) = (&ended.event, counted(all, "member"));
        let Some(mean) = ended.mean else {
            return format!("`{event}` ended none of {of}");
        };
        let deviation = ended.deviation.filter(|size| *size > 0.0);
        let deviation = deviation.unwrap_or(f64::NAN);
        let mean = with_error(mean, deviation / (ended.members as f64).sqrt());
        let times = stops.quantiles.iter().zip(&ended.quantiles);
        let times = times.map(|(p, time)| format!("{p}: {}", with_digits(*time, deviation / 10.0)));
        let times: Vec<String> = times.collect();
        format!(
            "`{event}` ended {} of {of}, at t = {mean} in the mean; quantiles {}",
            ended.members,
            times.join(", ")
        )
    };
    let lines = stops.flat_map(|stops| stops.events.iter().map(move |ended| line(stops, ended)));
    lines.collect()
}
