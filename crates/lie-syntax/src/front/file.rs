//! The file of a spec: its bytes, of which there are not too many.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use crate::diagnostic::{Diagnostic, Kind, Origin};

/// The largest spec file in bytes. The largest system that kernels are made for, with a dense
/// quadratic Hamiltonian, takes a tenth of it.
pub const MAX_BYTES: usize = 16 << 20;

/// The bytes of a file; of one that is larger than [`MAX_BYTES`] one byte more than that, so that
/// nobody reads an endless file to its end.
///
/// # Errors
/// Those of the file system.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = u64::try_from(MAX_BYTES).unwrap_or(u64::MAX);
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The mistake of a file that is larger than [`MAX_BYTES`], at its beginning.
pub fn oversized(length: usize) -> Option<Diagnostic> {
    (length > MAX_BYTES).then(|| {
        let message = format!("the spec has more than {} MB", MAX_BYTES >> 20);
        Diagnostic::new(Kind::Limit, Origin::Text { start: 0, end: 0 }, message)
            .help("declare a smaller system, and keep data out of its file")
    })
}
