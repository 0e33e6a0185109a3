//! One program of the cache: where it is, whether it is whole, and how it gets there.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use super::Key;
use super::cache;

/// The folder of a program: its source, the program, and a sum by which damage is noticed.
pub struct Entry {
    /// The folder.
    pub folder: PathBuf,
    /// The program in it.
    pub program: PathBuf,
}

impl Entry {
    /// The entry of a key; nothing needs to be there.
    pub fn new(cache: &Path, key: &str) -> Self {
        let folder = cache.join("programs").join(key);
        let program = folder.join(format!("program{}", std::env::consts::EXE_SUFFIX));
        Self { folder, program }
    }

    /// The program appears last, by a rename: where it is, the source beside it is what it was built from. The sum
    /// tells whether it still is what was put there: a disk that was full, or someone else, may have damaged it.
    pub fn is_whole(&self, source: &str) -> bool {
        let same = |file: &str, text: &str| {
            std::fs::read(self.folder.join(file)).is_ok_and(|found| found == text.as_bytes())
        };
        same("main.rs", source)
            && std::fs::read(&self.program).is_ok_and(|bytes| same(SUM, &Key::digest(&bytes)))
    }

    /// Puts a built program in its place: beside it first, then by a rename.
    pub fn install(&self, built: &Path) -> io::Result<()> {
        let mut draft = OsString::from(&self.program);
        draft.push(format!(".{}", std::process::id()));
        let draft = PathBuf::from(draft);
        let _ = std::fs::remove_file(&draft);
        if std::fs::hard_link(built, &draft).is_err() {
            std::fs::copy(built, &draft)?;
        }
        let sum = Key::digest(&std::fs::read(&draft)?);
        cache::write(&self.folder.join(SUM), sum.as_bytes())?;
        std::fs::rename(&draft, &self.program)
    }
}

/// The file that holds the sum.
const SUM: &str = "sum";
