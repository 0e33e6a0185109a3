//! What shares have in their files, on its way into those of the whole.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use lie_in_process::key::Key;
use lie_in_process::share::Share;

use super::beside::{numbers, path_of_stops};
use super::gathering::Gathering;
use super::merge::Part;
use crate::command::run::outputs::writing_failed;
use crate::message::{Failure, Message};
use lie_output::npy;

/// Numbers, and bytes of a table, that are read at a time.
const CHUNK: usize = 1 << 16;

impl Part<'_> {
    /// Where its table of events is, if it has one.
    pub fn table(&self) -> Option<PathBuf> {
        let name = self.record.events.as_ref()?.file.as_ref()?;
        Some(self.path.with_file_name(name))
    }

    /// Its files beside those of the members and of what is said of them.
    pub fn files(&self) -> Vec<PathBuf> {
        let stops = self.record.stops.as_ref();
        let stops = stops.map(|_| path_of_stops(self.path));
        stops.into_iter().chain(self.table()).collect()
    }

    fn members(&self) -> usize {
        self.record.share.members(self.record.members).len()
    }

    /// A file of it that is not what its record speaks of.
    fn spoilt(&self, path: &Path, how: &str) -> Failure {
        let Share { number, of } = self.record.share;
        let text = format!("{how} of share {number} of {of}");
        self.again(path, text)
    }

    fn again(&self, path: &Path, text: String) -> Failure {
        let Share { number, of } = self.record.share;
        let help = format!("run it by `lie ensemble … --shard {number}/{of}`, and merge again");
        Failure::surroundings(Message::io(path, text).help(help))
    }

    /// Whether its files have as much as its record speaks of.
    ///
    /// # Errors
    /// `io`: they have not.
    pub fn is_whole(&self) -> Result<(), Failure> {
        self.has_array(self.path, "members", &self.record.shape())?;
        if self.record.stops.is_some() {
            let path = path_of_stops(self.path);
            self.has_array(&path, "times of stops", &[self.record.stopping()])?;
        }
        let Some(table) = self.table() else {
            return Ok(());
        };
        table.metadata().map(drop).map_err(|error| {
            let Share { number, of } = self.record.share;
            let text = format!("the events of share {number} of {of} are not there: {error}");
            self.again(&table, text)
        })
    }

    fn has_array(&self, path: &Path, what: &str, shape: &[usize]) -> Result<(), Failure> {
        let members = self.members();
        let expected = npy::header(members as u64, shape);
        let length = npy::LENGTH as u64 + 8 * (members * shape.iter().product::<usize>()) as u64;
        let mut header = vec![0; npy::LENGTH];
        let read = File::open(path).and_then(|mut file| {
            file.read_exact(&mut header)?;
            file.metadata()
        });
        let how = match read {
            Ok(found) if found.len() == length && header == expected => return Ok(()),
            Ok(found) => format!("it has {} bytes of {length}, or other ones", found.len()),
            Err(error) => error.to_string(),
        };
        let Share { number, of } = self.record.share;
        let text = format!("the {what} of share {number} of {of} are not in this file: {how}");
        Err(self.again(path, text))
    }

    /// Hands on what it has, and sees whether that is what its record speaks of.
    ///
    /// # Errors
    /// `io`: it is not, or something cannot be read or written.
    pub fn copy(&self, gathering: &mut Gathering, out: &Path) -> Result<(), Failure> {
        let size = self.record.shape().iter().product::<usize>().max(1);
        let mut states = Numbers::open(self.path)?;
        let stops = self.record.stops.as_ref();
        let mut times = stops
            .map(|_| Numbers::open(&path_of_stops(self.path)))
            .transpose()?;
        let mut left = self.members();
        while left > 0 {
            let some = left.min((CHUNK / size).max(1));
            let states = states.read(some * size)?;
            let times = times.as_mut();
            let times = times.map(|times| times.read(some * self.record.stopping()));
            let times = times.transpose()?.unwrap_or_default();
            let pushed = gathering.push(&states, &times);
            pushed.map_err(|error| writing_failed(Some(out), &error))?;
            left -= some;
        }
        if self.record.numbers != Some(states.key.hex()) {
            return Err(self.spoilt(self.path, "the numbers in this file are not those"));
        }
        let digest = stops.and_then(|stops| stops.numbers.clone());
        if let Some(times) = times.filter(|times| digest != Some(times.key.hex())) {
            return Err(self.spoilt(&times.path, "the times in this file are not those"));
        }
        self.copy_events(gathering, out)
    }

    /// Hands on the lines of its table of events, the first one of the first share alone.
    fn copy_events(&self, gathering: &mut Gathering, out: &Path) -> Result<(), Failure> {
        let (Some(path), Some(table)) = (self.table(), gathering.table()) else {
            return Ok(());
        };
        let mut file = File::open(&path).map_err(|error| unread(&path, &error))?;
        let mut key = Key::new();
        let mut is_header = self.record.share.number > 1;
        let mut bytes = vec![0; CHUNK];
        loop {
            let count = file.read(&mut bytes);
            let count = count.map_err(|error| unread(&path, &error))?;
            if count == 0 {
                break;
            }
            let mut lines = &bytes[..count];
            key = key.bytes(lines);
            if is_header {
                let end = lines.iter().position(|byte| *byte == b'\n');
                is_header = end.is_none();
                lines = &lines[end.map_or(count, |end| end + 1)..];
            }
            let pushed = table.push(lines);
            pushed.map_err(|error| writing_failed(Some(out), &error))?;
        }
        let digest = self.record.events.as_ref();
        let digest = digest.and_then(|events| events.digest.clone());
        match digest == Some(key.hex()) {
            true => Ok(()),
            false => Err(self.spoilt(&path, "the events in this file are not those")),
        }
    }
}

/// The numbers of an array in a file, one behind the other.
struct Numbers {
    path: PathBuf,
    file: BufReader<File>,
    /// Of those that were read.
    key: Key,
}

impl Numbers {
    fn open(path: &Path) -> Result<Self, Failure> {
        Ok(Self {
            path: path.to_owned(),
            file: numbers(path).map_err(|error| unread(path, &error))?,
            key: Key::new(),
        })
    }

    fn read(&mut self, count: usize) -> Result<Vec<f64>, Failure> {
        let mut bytes = vec![0; 8 * count];
        let read = self.file.read_exact(&mut bytes);
        read.map_err(|error| unread(&self.path, &error))?;
        self.key = std::mem::take(&mut self.key).bytes(&bytes);
        let numbers = bytes.chunks_exact(8);
        let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
        Ok(numbers.map(number).collect())
    }
}

fn unread(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("it cannot be read any more: {error}"));
    Failure::surroundings(message.help("check that the disk is still there, and merge again"))
}
