//! A file, or stdout, possibly through a spool file.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The first bytes of a growing file are brought up to date this often.
const PATCH: Duration = Duration::from_millis(200);

/// The smallest size of a page, and what a pipe takes at once.
const PAGE: usize = 4096;

/// Where rows go.
pub struct Destination {
    to: To,
    /// Takes everything until the end, where the first bytes depend on what follows and the
    /// destination cannot be rewound.
    spool: Option<File>,
    /// Bytes that arrived.
    good: u64,
    patched: Option<Instant>,
}

enum To {
    Stdout,
    File {
        file: File,
        path: PathBuf,
        created: bool,
    },
}

impl Destination {
    /// stdout.
    pub fn stdout() -> Self {
        Self {
            to: To::Stdout,
            spool: None,
            good: 0,
            patched: None,
        }
    }

    /// A file; what it holds stays until the first bytes are sent.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn file(path: &Path) -> io::Result<Self> {
        let created = !path.exists();
        let file = File::options()
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)?;
        let to = To::File {
            file,
            path: path.to_owned(),
            created,
        };
        Ok(Self {
            to,
            spool: None,
            good: 0,
            patched: None,
        })
    }

    /// Takes an empty file away again, if nothing was sent and it was not there before.
    pub fn discard(self) {
        if let To::File {
            file,
            path,
            created: true,
        } = self.to
        {
            drop(file);
            let _ = std::fs::remove_file(path);
        }
    }

    /// Empties the file, or sets up a spool where the start is to be patched and cannot be.
    pub(super) fn begin(&mut self, patches: bool) -> io::Result<()> {
        let regular = match &self.to {
            To::Stdout => false,
            To::File { file, .. } => file.metadata()?.is_file(),
        };
        if let (To::File { file, .. }, true) = (&self.to, regular) {
            file.set_len(0)?;
        }
        if patches && !regular {
            self.spool = Some(tempfile::tempfile()?);
        }
        Ok(())
    }

    /// Bytes until the next page of the file begins.
    pub(super) fn room_in_page(&self) -> usize {
        PAGE - (self.good % PAGE as u64) as usize
    }

    pub(super) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let sent = match (&mut self.spool, &mut self.to) {
            (Some(file), _) | (None, To::File { file, .. }) => file.write_all(bytes),
            (None, To::Stdout) => {
                let mut stdout = io::stdout().lock();
                stdout.write_all(bytes).and_then(|()| stdout.flush())
            }
        };
        match (&sent, &self.to) {
            (Ok(()), _) => self.good += bytes.len() as u64,
            // A part of the batch may have arrived. Devices cannot be cut, and need not be.
            (Err(_), To::File { file, .. }) => drop(file.set_len(self.good)),
            _ => {}
        }
        sent
    }

    /// Overwrites the first bytes, at most every now and then unless it is the last time.
    pub(super) fn patch(&mut self, start: &[u8], last: bool) -> io::Result<()> {
        if !last && self.patched.is_some_and(|at| at.elapsed() < PATCH) {
            return Ok(());
        }
        self.patched = Some(Instant::now());
        let ((Some(file), _) | (None, To::File { file, .. })) = (&mut self.spool, &mut self.to)
        else {
            return Ok(());
        };
        file.seek(SeekFrom::Start(0))?;
        file.write_all(start)?;
        file.seek(SeekFrom::End(0))?;
        Ok(())
    }

    /// Writes all of a file at once.
    ///
    /// # Errors
    /// The destination cannot be written.
    pub fn replace(mut self, bytes: &[u8]) -> io::Result<()> {
        self.begin(false)?;
        self.send(bytes)
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        let Some(mut spool) = self.spool.take() else {
            return Ok(());
        };
        spool.seek(SeekFrom::Start(0))?;
        let mut chunk = vec![0; 1 << 16];
        loop {
            let read = spool.read(&mut chunk)?;
            if read == 0 {
                return Ok(());
            }
            self.send(&chunk[..read])?;
        }
    }
}
