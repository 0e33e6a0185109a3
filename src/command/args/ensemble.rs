//! The command line of ensembles.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use lie_in_process::request::{Request, Value};

/// `lie ensemble`.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "FILE.npy is an array of float64 for `numpy.load`: (members, coordinates) of the final states, or with --every or \
        --at (members, rows, coordinates). FILE.npy.json beside it says the times, the names, and which members ended early: what \
        they did not reach is not a number. The bytes are the same for every number of threads and shares.
An event that stops ends its member: FILE.stops.npy says when, (members, events that stop), and FILE.npy.json how many members go \
        on at each of the times. Reductions are over these.
Members: --initial-file has one in each row; --members draws them around the initial state; a parameter NAME=FROM:TO:COUNT has \
        all of these for each of its values, the last parameter fastest.
Exit codes: 0 done, 1 surroundings failed, 2 invalid input, 3 a member ended early, the others are whole, 130 Ctrl-C, 143 SIGTERM, \
        129 SIGHUP: members so far are kept."
)]
pub struct Ensemble {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    #[command(flatten)]
    pub request: Request,
    /// Draws so many initial states: each is where a random element of the group takes that of the spec or of --initial, on its
    /// coadjoint orbit. With --initial-file it has to be their number
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub members: Option<Value>,
    /// How far they go: the standard deviation of the element's coordinates in the algebra (default 0.1; on so(3) an angle about
    /// each axis), or `orbit`: uniformly over the orbit, of a compact group
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub spread: Option<Value>,
    /// Runs the K-th of N shares of the members alone, for `lie merge`; `slurm` takes both from the array job that it is in,
    /// `slurm/N` K alone
    #[arg(long, value_name = "K/N", allow_hyphen_values = true)]
    pub shard: Option<String>,
    /// Computes these of all members that come to it, at each of the times, into FILE.mean.npy, FILE.covariance.npy, FILE.quantiles.npy,
    /// FILE.histogram.npy; of shares `lie merge` does
    #[arg(long, value_enum, value_name = "LIST", value_delimiter = ',')]
    pub reduce: Vec<Reduce>,
    /// The probabilities of the quantiles, separated by commas (default: 0.05,0.25,0.5,0.75,0.95)
    #[arg(long, value_name = "P1,P2,…", allow_hyphen_values = true)]
    pub quantiles: Option<Value>,
    /// Bins of the histogram: so many of each coordinate (default 50), or where orbits are spheres so many bands of three times as
    /// many sectors (default 16)
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub bins: Option<Value>,
    /// Where the members go
    #[arg(long, value_name = "FILE.npy")]
    pub out: PathBuf,
    /// Writes the events of the members, those that the spec declares, as a table: member,event,t,state (CSV); that of a share
    /// stands beside its members
    #[arg(long, value_name = "FILE.csv")]
    pub events: Option<PathBuf>,
    /// How many threads (default: all processors)
    #[arg(long, value_name = "K")]
    pub threads: Option<NonZeroUsize>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}

/// `--reduce`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Reduce {
    /// The mean of each coordinate
    Mean,
    /// The covariances of the coordinates, over the number of members less one
    Covariance,
    /// Quantiles of each coordinate, interpolated linearly
    Quantiles,
    /// How many members are where: on spheres in bins of equal area, elsewhere by each coordinate
    Histogram,
}

/// `lie merge`.
#[derive(Args, Debug)]
#[command(
    after_help = "The file, and what stands beside it, have the bytes of an ensemble that was never divided.
Exit codes: 0 done, 1 a share is lost, or the surroundings failed, 2 the files do not belong together."
)]
pub struct Merge {
    /// The files of `lie ensemble --shard`, in any order
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Where all members go
    #[arg(long, value_name = "FILE.npy")]
    pub out: PathBuf,
    /// Where all events go, of shares with tables of them
    #[arg(long, value_name = "FILE.csv")]
    pub events: Option<PathBuf>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}
