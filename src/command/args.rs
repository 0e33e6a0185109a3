//! The command line, as clap reads it; what is asked of a run is a [`Request`].

mod ensemble;
mod equilibria;
mod measured;
mod motion;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use lie_in_process::request::Request;
use lie_output::Format;

pub use ensemble::{Ensemble, Merge, Reduce};
pub use equilibria::Equilibria;
pub use measured::{Bench, Measured, Sense, Stress, Verify};
pub use motion::{Exponents, Frequencies};

/// Structure-preserving integrators for Lie–Poisson systems.
#[derive(Debug, Parser)]
#[command(
    name = "lie",
    version,
    about,
    max_term_width = 100,
    disable_help_subcommand = true
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Checks specs: algebra, Hamiltonian, Casimirs, and which methods apply
    Check(Check),
    /// Prints the generated Rust code of a spec
    Expand(Expand),
    /// Integrates a spec with its generated, compiled code
    Run(Box<Run>),
    /// Goes on with a run of `lie run --checkpoint` that was ended, whatever ended it
    Resume(Resume),
    /// Integrates many members of a spec, as one array: states drawn on the orbit or from a file, ranges of parameters
    Ensemble(Box<Ensemble>),
    /// Puts the shares of `lie ensemble --shard` together
    Merge(Merge),
    /// Measures every fact that the methods claim, on a spec
    Verify(Verify),
    /// Compares methods on a spec: the error at the end against the run time
    Bench(Bench),
    /// Takes methods to the limits of steps, parameters and states, and through a long run
    Stress(Stress),
    /// Finds relative equilibria on a leaf, their spectra and stability, and follows them in a parameter
    Equilibria(Equilibria),
    /// Measures Lyapunov exponents along an orbit, by the tangents of the steps
    Exponents(Exponents),
    /// Finds the frequencies of coordinates and declared functions along an orbit, by refined Fourier analysis
    Frequencies(Box<Frequencies>),
    /// Writes a page of HTML: mathematics, trajectory, orbit, errors against run time, generated code
    Report(Box<Report>),
    /// Lists the methods: order, what they preserve, what they need, reference
    Methods(Methods),
    /// Prints the JSON Schema of spec files
    Schema,
    /// Writes a spec that runs, for an algebra by its name
    New(New),
    /// Writes a spec in coordinates in which its bracket is constant, such as logarithms of populations
    Canonical(Canonical),
    /// Shows where built programs are kept, or removes them
    Cache(Cache),
    #[command(flatten)]
    Later(Later),
}

/// Names that are kept for commands to come.
#[derive(Debug, Subcommand)]
pub enum Later {
    #[command(hide = true)]
    Advise(Anything),
}

impl Later {
    /// The name as it was typed.
    pub fn name(&self) -> &'static str {
        match self {
            Later::Advise(_) => "advise",
        }
    }
}

/// `lie new`.
#[derive(Args, Debug)]
pub struct New {
    /// The name of the file, without `.json`
    #[arg(value_name = "NAME")]
    pub name: String,
    /// The algebra, as in `"algebra"` of a spec
    #[arg(long, value_name = "ALGEBRA", default_value = "so(3)")]
    pub algebra: String,
}

/// `lie canonical`.
#[derive(Args, Debug)]
pub struct Canonical {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// Where the spec goes, a new file (default: stdout)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// `lie report`.
#[derive(Args, Debug)]
#[command(
    after_help = "Exit codes: 0 the page is written, 1 a file cannot be, 2 invalid input, 3 a run stopped early and the \
        page says why, 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP."
)]
pub struct Report {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// The method, see `lie methods`; given several times, all are compared, and the first is shown in full
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,
    /// Step size
    #[arg(long, alias = "h", value_name = "H", allow_hyphen_values = true)]
    pub step: Option<String>,
    /// Relative error at the end, in place of --step
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    pub tol: Option<String>,
    /// Final time
    #[arg(long, alias = "t", value_name = "T", allow_hyphen_values = true)]
    pub until: Option<String>,
    /// Sets a parameter (repeatable)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub param: Vec<String>,
    /// Initial state, separated by commas
    #[arg(long, alias = "x0", value_name = "V1,V2,…", allow_hyphen_values = true)]
    pub initial: Option<String>,
    /// Leaves out the comparison of methods, which takes some seconds
    #[arg(long)]
    pub no_bench: bool,
    /// Where the page goes (default: the name of the spec, .html)
    #[arg(long, value_name = "FILE.html")]
    pub out: Option<PathBuf>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
}

/// `lie cache`.
#[derive(Args, Debug)]
pub struct Cache {
    /// Removes all that is in it
    #[arg(long)]
    pub clear: bool,
}

/// Whatever follows the name of a command that does not exist yet.
#[derive(Args, Debug)]
pub struct Anything {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    _rest: Vec<String>,
}

/// `lie check`.
#[derive(Args, Debug)]
pub struct Check {
    /// The spec files
    #[arg(value_name = "SPEC", required = true)]
    pub specs: Vec<PathBuf>,
    /// Prints one JSON object (an array for several specs)
    #[arg(long)]
    pub json: bool,
    /// Looks for Casimirs as long as it takes, up to minutes
    #[arg(long)]
    pub deep: bool,
}

/// `lie expand`.
#[derive(Args, Debug)]
pub struct Expand {
    /// The spec file
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// Emits fused code for this method (repeatable), in place of the spec's `methods`: an id, with every option that
    /// applies, or with options such as "lie-midpoint --retraction cayley"
    #[arg(long, value_name = "ID")]
    pub method: Vec<String>,
    /// The path at which the code finds the runtime, where another crate re-exports it [default: ::lie_runtime]
    #[arg(long = "crate", value_name = "PATH")]
    pub runtime: Option<String>,
    /// Prints the plan of the code instead: what is computed, with operation counts
    #[arg(long)]
    pub plan: bool,
    /// Writes a cargo project instead, into a folder that is new or empty: the code, a program that integrates it as the spec's `run`
    /// says and prints the rows, and the runtime
    #[arg(long, value_name = "DIR", conflicts_with_all = ["plan", "runtime"])]
    pub project: Option<PathBuf>,
}

/// `lie methods`.
#[derive(Args, Debug)]
pub struct Methods {
    /// Prints the catalogue as JSON
    #[arg(long)]
    pub json: bool,
}

/// `lie resume`.
#[derive(Args, Debug)]
#[command(
    after_help = "All else is that of the run: its spec, options and files, which must be what they were. The rows go behind those \
        in the file of --out, which becomes that of a run that was never ended, byte by byte.
Exit codes: as of `lie run`."
)]
pub struct Resume {
    /// The file of --checkpoint
    #[arg(value_name = "FILE")]
    pub checkpoint: PathBuf,
}

/// `lie run`.
#[derive(Args, Clone, Debug, Default)]
#[command(after_help = "Numbers may be exact constants: 1/7, -1/2, cos(11/10).
Flags override the `run` keys of the spec; without either: --method lie-midpoint (midpoint \
    if the bracket is not the Lie–Poisson bracket of an algebra) --step 0.01 --until 10.
Exit codes: 0 done, 1 surroundings failed, 2 invalid input, 3 integration stopped early, 130 Ctrl-C, 143 SIGTERM, \
    129 SIGHUP: ended in order, rows kept.")]
pub struct Run {
    /// The spec file
    #[arg(value_name = "SPEC", required = true)]
    pub specs: Vec<PathBuf>,
    #[command(flatten)]
    pub request: Request,
    /// Form of the output (default: what the extension of --out says, csv where there is none)
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// Writes to a file instead of stdout
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draws the runs: .svg, .png or .pdf
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// What --plot draws: components (over time, with the errors of the invariants; default of one run), orbit (the coadjoint
    /// orbit of a three-dimensional algebra), phase or phase:X,Y, section or section:X=VALUE, attitude (with --group), compare
    /// (runs side by side; default of several)
    #[arg(long, value_name = "KIND")]
    pub picture: Option<String>,
    /// Writes the events that the spec declares as a table: event,t,state (CSV)
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
    /// Keeps in a file what `lie resume` needs to go on after Ctrl-C, a kill or a loss of power, written about once a second at a
    /// multiple of 1000 steps; with --out
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Writes it every K steps instead, rounded up to a multiple of 1000
    #[arg(long, value_name = "K", requires = "checkpoint", value_parser = clap::value_parser!(u64).range(1..))]
    pub checkpoint_every: Option<u64>,
    /// Says nothing on stderr unless something fails
    #[arg(long)]
    pub quiet: bool,
    /// Build a program with cargo and run that, in place of machine code made here: for very long runs (the results are the
    /// same, bit for bit)
    #[arg(long)]
    pub compile: bool,
    /// Which processor to compile for (the results are the same, bit for bit); as --fma, implies --compile
    #[arg(long, value_enum)]
    pub cpu: Option<Cpu>,
    /// Rounds a product and its sum once (faster; other digits than on a processor without it)
    #[arg(long)]
    pub fma: bool,
}

/// `--cpu`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Cpu {
    /// This machine's, with every instruction that it has
    #[default]
    Native,
    /// Any of this machine's architecture
    Portable,
}
