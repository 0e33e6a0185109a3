//! How much memory there is, so that what does not fit is refused before anything is computed: a process that takes more than
//! there is is ended by the system, and all that it has found with it.

use std::fmt;
use std::fs::{File, read_to_string};
use std::io::{self, Read as _};
use std::path::Path;

use lie_program::protocol::Times;

/// Of what is free, so much is left for everything that is not counted.
const LEFT: f64 = 0.1;
/// So many bytes are had without asking: what is free is read from half a dozen files of the system, which takes longer than many a run.
const LITTLE: u64 = 1 << 20;
/// Bytes of a number.
pub const NUMBER: f64 = 8.0;

/// Bytes that a coordinate of a family takes: its value in the states of a step, and its name. Measured: 300 with `rk4`.
pub const COORDINATE: f64 = 300.0;

/// The rows of a run from a time on whose step is known.
pub fn rows(times: &Times, from: f64, step: f64) -> f64 {
    match times {
        Times::At(times) | Times::Within { times, .. } => times.len() as f64,
        // the first and the last among them
        Times::Until { end, every } => ((end - from) / step).abs() / *every as f64 + 2.0,
    }
}

/// More than there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// The bytes that are needed, and those that are free.
    needed: f64,
    free: f64,
}

impl Exceeded {
    /// So many bytes could not be had.
    pub fn by(needed: f64) -> Self {
        let free = free().unwrap_or(0.0).min(needed);
        Self { needed, free }
    }
}

impl fmt::Display for Exceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (needed, free) = (self.needed / 1e9, self.free / 1e9);
        write!(
            f,
            "{needed:.3} GB of memory are needed, and {free:.3} GB are free"
        )
    }
}

impl std::error::Error for Exceeded {}

impl From<Exceeded> for io::Error {
    fn from(exceeded: Exceeded) -> Self {
        Self::new(io::ErrorKind::OutOfMemory, exceeded)
    }
}

/// Whether so many bytes can be had.
///
/// # Errors
/// They cannot; what is little fits, and everything where the system tells nothing.
pub fn fits(needed: f64) -> Result<(), Exceeded> {
    if needed <= LITTLE as f64 {
        return Ok(());
    }
    match free().map(|free| free * (1.0 - LEFT)) {
        Some(free) if needed > free => Err(Exceeded { needed, free }),
        _ => Ok(()),
    }
}

/// Makes room for so many more numbers.
///
/// # Errors
/// There is none.
pub fn reserve(numbers: &mut Vec<f64>, more: usize) -> io::Result<()> {
    let needed = more as f64 * NUMBER;
    let reserved = numbers
        .try_reserve(more)
        .or_else(|_| numbers.try_reserve_exact(more));
    reserved.map_err(|_| Exceeded::by(needed).into())
}

/// The bytes of a file, which has to fit several times: its numbers are kept beside its text.
///
/// # Errors
/// Those of the file system, and a file that is too large.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut file = File::open(path)?;
    if file.by_ref().take(LITTLE).read_to_end(&mut bytes)? < LITTLE as usize {
        return Ok(bytes);
    }
    let most = free().map_or(u64::MAX, |free| (free / 4.0) as u64);
    file.take(most.saturating_sub(LITTLE))
        .read_to_end(&mut bytes)?;
    match bytes.len() as u64 >= most {
        true => Err(io::Error::new(
            io::ErrorKind::OutOfMemory,
            "it is larger than a quarter of the free memory",
        )),
        false => Ok(bytes),
    }
}

/// The bytes that this process may still take: what the machine has, within the limits of the process and its group.
fn free() -> Option<f64> {
    [
        machine(),
        limit("Max address space", "VmSize"),
        limit("Max data size", "VmData"),
        group(),
    ]
    .into_iter()
    .flatten()
    .reduce(f64::min)
}

/// The number of kB behind a name.
fn kilobytes(file: &str, name: &str) -> Option<f64> {
    let text = read_to_string(file).ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix(':'))?;
    let number: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * number)
}

fn machine() -> Option<f64> {
    kilobytes("/proc/meminfo", "MemAvailable")
}

/// What is left of a limit that a shell sets by `ulimit`.
fn limit(name: &str, taken: &str) -> Option<f64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
    // of a process without a limit, `unlimited`
    let limit: f64 = line.split_whitespace().next()?.parse().ok()?;
    let taken = kilobytes("/proc/self/status", taken)?;
    Some((limit - taken).max(0.0))
}

/// What is left of the limit of a container or of a job of a scheduler.
fn group() -> Option<f64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let own = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let root = Path::new("/sys/fs/cgroup");
    let all = Path::new(own).ancestors().map(|part| root.join(part));
    all.filter_map(|folder| {
        let number = |file: &str| -> Option<f64> {
            read_to_string(folder.join(file)).ok()?.trim().parse().ok()
        };
        // without a limit, `max`
        let (limit, taken) = (number("memory.max")?, number("memory.current")?);
        // pages of files are given back where there is need
        let pages = read_to_string(folder.join("memory.stat")).unwrap_or_default();
        let pages = pages
            .lines()
            .find_map(|line| line.strip_prefix("inactive_file "));
        let pages: f64 = pages
            .and_then(|pages| pages.trim().parse().ok())
            .unwrap_or(0.0);
        Some((limit - taken + pages).max(0.0))
    })
    .reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_counted_beforehand() {
        let until = |end, every| Times::Until { end, every };
        assert_eq!(rows(&until(10.0, 5), 5.0, 0.5), 4.0);
        assert_eq!(rows(&until(-10.0, 1), 0.0, -0.5), 22.0);
        assert_eq!(rows(&until(1e300, 1), 0.0, 1e-300), f64::INFINITY);
        assert_eq!(rows(&Times::At(vec![1.0, 2.0]), 0.0, 1e-3), 2.0);
    }

    #[test]
    fn little_fits_and_more_than_there_is_does_not() {
        assert_eq!(fits(1.0), Ok(()));
        let mut numbers = Vec::new();
        reserve(&mut numbers, 10).unwrap();
        let error = reserve(&mut numbers, usize::MAX / 16).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::OutOfMemory);
        assert!(
            error.to_string().contains("GB of memory are needed"),
            "{error}"
        );
        if cfg!(target_os = "linux") {
            let exceeded = fits(1e18).unwrap_err().to_string();
            assert!(exceeded.starts_with("1000000000.000 GB"), "{exceeded}");
            assert!(machine().unwrap() > 1e6);
            assert!(read(Path::new("/proc/self/limits")).unwrap().len() > 100);
        }
    }
}
