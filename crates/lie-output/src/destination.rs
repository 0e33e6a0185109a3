//! A file, or stdout, possibly through a spool file.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// The smallest size of a page, and what a pipe takes at once.
const PAGE: usize = 4096;

/// Where rows go. A file that it made and to which nothing was sent is taken away again.
pub struct Destination {
    to: To,
    /// Takes everything until the end, where the first bytes depend on what follows and the
    /// destination cannot be rewound.
    spool: Option<File>,
    /// Bytes of what was sent whole, and bytes that arrived.
    good: u64,
    arrived: u64,
    /// What becomes of a reader that goes away, which is an error unless the rest is dropped.
    reader: Reader,
}

/// A reader at the other end of a pipe.
#[derive(Clone, Copy, PartialEq)]
enum Reader {
    Needed,
    Welcome,
    Gone,
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
            arrived: 0,
            reader: Reader::Needed,
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
            arrived: 0,
            reader: Reader::Needed,
        })
    }

    /// Whether it is a file on a disk.
    pub fn is_regular(&self) -> bool {
        match &self.to {
            To::Stdout => false,
            To::File { file, .. } => file.metadata().is_ok_and(|found| found.is_file()),
        }
    }

    /// Brings what was sent to the disk.
    pub(super) fn sync(&self) -> io::Result<()> {
        match &self.to {
            To::Stdout => Ok(()),
            To::File { file, .. } => file.sync_data(),
        }
    }

    /// Goes on behind so many bytes of what the file holds.
    pub(super) fn take_up(&mut self, length: u64) -> io::Result<()> {
        if let Some(file) = self.file_behind() {
            file.set_len(length)?;
            file.seek(SeekFrom::Start(length))?;
        }
        (self.good, self.arrived) = (length, length);
        Ok(())
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

    /// Bytes that were sent whole.
    pub(super) fn length(&self) -> u64 {
        self.good
    }

    /// Bytes that arrived: after a failure also a part of what was sent last.
    pub(super) fn arrived(&self) -> u64 {
        self.arrived
    }

    /// The file that can be rewound, if there is one: the spool, else the file itself.
    fn file_behind(&mut self) -> Option<&mut File> {
        match (&mut self.spool, &mut self.to) {
            (Some(file), _) | (None, To::File { file, .. }) => Some(file),
            (None, To::Stdout) => None,
        }
    }

    /// Where a reader goes away, what is left for it is dropped, until the end.
    pub(super) fn outlives_readers(&mut self) {
        self.reader = Reader::Welcome;
    }

    pub(super) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.reader == Reader::Gone {
            return Ok(());
        }
        match self.write(bytes) {
            Err(error)
                if error.kind() == io::ErrorKind::BrokenPipe && self.reader == Reader::Welcome =>
            {
                self.reader = Reader::Gone;
                Ok(())
            }
            sent => sent,
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Some(file) = self.file_behind() else {
            let mut stdout = io::stdout().lock();
            stdout.write_all(bytes).and_then(|()| stdout.flush())?;
            self.good += bytes.len() as u64;
            return Ok(());
        };
        let mut left = bytes;
        let sent = loop {
            if left.is_empty() {
                break Ok(());
            }
            match file.write(left) {
                Ok(0) => break Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => left = &left[count..],
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => break Err(error),
            }
        };
        self.arrived = self.good + (bytes.len() - left.len()) as u64;
        if sent.is_ok() {
            self.good = self.arrived;
        }
        sent
    }

    /// Takes away what stands behind so many bytes. Devices cannot be cut, and need not be.
    pub(super) fn cut(&mut self, length: u64) {
        if let Some(file) = self.file_behind() {
            let _ = file.set_len(length);
            let _ = file.seek(SeekFrom::Start(length));
        }
        self.good = length;
        self.arrived = length;
    }

    /// Overwrites the first bytes.
    pub(super) fn patch(&mut self, start: &[u8]) -> io::Result<()> {
        let good = self.good;
        let Some(file) = self.file_behind() else {
            return Ok(());
        };
        file.seek(SeekFrom::Start(0))?;
        file.write_all(start)?;
        file.seek(SeekFrom::Start(good))?;
        Ok(())
    }

    /// Puts an end in place of what stands behind so many bytes. Where that is at least as long, this needs no more
    /// room than there is.
    pub(super) fn close(&mut self, from: u64, end: &[u8]) -> io::Result<()> {
        let Some(file) = self.file_behind() else {
            return Ok(());
        };
        file.seek(SeekFrom::Start(from))?;
        file.write_all(end)?;
        self.cut(from + end.len() as u64);
        Ok(())
    }

    /// Writes all of a file at once.
    ///
    /// # Errors
    /// The destination cannot be written; a part of the file does not stay.
    pub fn replace(mut self, bytes: &[u8]) -> io::Result<()> {
        self.begin(false)?;
        let sent = self.send(bytes);
        if sent.is_err() {
            self.cut(0);
        }
        sent
    }

    /// Hands on what the spool has taken.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        if let Some(spool) = self.spool.take() {
            self.hand_on(spool)?;
        }
        match self.reader {
            Reader::Gone => Err(io::ErrorKind::BrokenPipe.into()),
            Reader::Needed | Reader::Welcome => Ok(()),
        }
    }

    fn hand_on(&mut self, mut spool: File) -> io::Result<()> {
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

impl Drop for Destination {
    fn drop(&mut self) {
        if let To::File {
            path,
            created: true,
            ..
        } = &self.to
            && self.good == 0
        {
            let _ = std::fs::remove_file(path);
        }
    }
}
