//! The files of an ensemble: the members, what they are, and what is computed of them.

use std::fs::File;
use std::io::{self, BufReader, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use clap::ValueEnum as _;
use lie_in_process::reduce::{Found, Going, quantiles};
use lie_in_process::share::{Record, Share};

use crate::command::args::Reduce;
use crate::command::files::{Inputs, put, unwritable};
use crate::message::Failure;
use lie_output::{Destination, npy};

/// The name of a reduction.
pub fn name(reduce: Reduce) -> &'static str {
    match reduce {
        Reduce::Mean => "mean",
        Reduce::Covariance => "covariance",
        Reduce::Quantiles => "quantiles",
        Reduce::Histogram => "histogram",
    }
}

/// Where what members are is said: beside their file, under its whole name.
pub fn path_of_record(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Where the times are at which events ended members, if some are declared to do that.
pub fn path_of_stops(out: &Path) -> PathBuf {
    out.with_extension("stops.npy")
}

/// The numbers of an array in a file, from the beginning.
///
/// # Errors
/// What cannot be read.
pub fn numbers(path: &Path) -> io::Result<BufReader<File>> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(npy::LENGTH as u64))?;
    Ok(BufReader::with_capacity(1 << 20, file))
}

/// The files, opened before anything is computed.
pub struct Beside {
    out: PathBuf,
    members: Destination,
    stops: Option<Destination>,
    reductions: Vec<(Reduce, PathBuf, Destination)>,
}

impl Beside {
    /// Opens them. Of a share nothing is computed.
    ///
    /// # Errors
    /// `option` for an input, with exit code 2; `io`, with exit code 1.
    pub fn open(out: &Path, inputs: &Inputs, record: &Record) -> Result<Self, Failure> {
        let stops = record.stops.as_ref().map(|_| path_of_stops(out));
        for path in [path_of_record(out)].iter().chain(&stops) {
            inputs.spare("--out", path)?;
        }
        let wanted = Reduce::value_variants().iter().copied().filter(|one| {
            record.share == Share::WHOLE && record.reduce.iter().any(|known| known == name(*one))
        });
        let reductions = wanted.map(|one| {
            let path = out.with_extension(format!("{}.npy", name(one)));
            inputs.spare("--out", &path)?;
            Ok((one, path))
        });
        // whatever is refused, nothing has been made
        let reductions: Vec<(Reduce, PathBuf)> = reductions.collect::<Result<_, Failure>>()?;
        let members = inputs.open("--out", out)?;
        let open = |(one, path): (Reduce, PathBuf)| {
            let file = inputs.open("--out", &path)?;
            Ok((one, path, file))
        };
        Ok(Self {
            out: out.to_owned(),
            members,
            stops: stops.map(|path| inputs.open("--out", &path)).transpose()?,
            reductions: reductions
                .into_iter()
                .map(open)
                .collect::<Result<_, Failure>>()?,
        })
    }

    /// Where the members go, where the times go at which they were ended, and what is left to be written.
    pub fn split(self) -> (Destination, Option<Destination>, Rest) {
        let Self {
            out,
            members,
            stops,
            reductions,
        } = self;
        (members, stops, Rest { out, reductions })
    }
}

/// The files beside the members.
pub struct Rest {
    /// The file of the members.
    pub out: PathBuf,
    reductions: Vec<(Reduce, PathBuf, Destination)>,
}

impl Rest {
    /// Whether mean or covariance is wanted.
    pub fn wants_moments(&self) -> bool {
        let moments = [Reduce::Mean, Reduce::Covariance];
        self.reductions
            .iter()
            .any(|(one, ..)| moments.contains(one))
    }

    /// Writes what the members are.
    ///
    /// # Errors
    /// `io`.
    pub fn say(&self, record: &Record) -> Result<(), Failure> {
        let path = path_of_record(&self.out);
        let text = serde_json::to_string(record).map_err(io::Error::from);
        let written = text.and_then(|text| put(&path, format!("{text}\n").as_bytes()));
        written.map_err(|error| unwritable(&path, &error))
    }

    /// Writes what is computed: mean and covariance as they were found, quantiles and histograms from the members in the file without
    /// those that are gone.
    ///
    /// # Errors
    /// `io`.
    pub fn reduce(
        &mut self,
        record: &mut Record,
        (found, gone): (&Found, &[bool]),
    ) -> Result<(), Failure> {
        let shape = record.shape();
        let columns = shape.iter().product();
        let again = || Ok(Going::new(numbers(&self.out)?, columns, gone));
        for (one, path, destination) in self.reductions.drain(..) {
            let array = match one {
                Reduce::Mean => Ok(npy::array(&shape, &found.means)),
                Reduce::Covariance => {
                    let shape = [&shape[..], &shape[shape.len() - 1..]].concat();
                    Ok(npy::array(&shape, &found.covariances))
                }
                Reduce::Quantiles => {
                    let shape = [&[record.quantiles.len()], &shape[..]].concat();
                    let found = quantiles(again, (record.members, columns), &record.quantiles);
                    found.map(|found| npy::array(&shape, &found))
                }
                Reduce::Histogram => {
                    let size = [record.times.len(), record.columns.len()];
                    let Some(bins) = &mut record.histogram else {
                        continue;
                    };
                    let rows = if record.rows { &size[..1] } else { &[] };
                    let shape = [rows, &bins.shape(size[1])].concat();
                    let found = bins.count(again, record.members, size);
                    found.map(|found| npy::array(&shape, &found))
                }
            };
            let written = array.and_then(|array| destination.replace(&array));
            written.map_err(|error| unwritable(&path, &error))?;
        }
        Ok(())
    }
}
