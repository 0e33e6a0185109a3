//! The files of a command: what it reads, and what it may write to.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use lie_in_process::request::Request;
use lie_syntax::front::spec::files;

use crate::compiler::Spec;
use crate::message::{Failure, Message};
use lie_output::{Destination, Identity};

/// What was read: what it is, and which file.
#[derive(Default)]
pub struct Inputs(Vec<(String, Identity)>);

impl Inputs {
    /// A spec, by the path where it was read, and the files that it names.
    pub fn of_spec(path: &Path, spec: &Spec) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        let named = files(&spec.source.text).into_iter();
        let named =
            named.map(|file| (format!("`{file}`, which the spec reads"), folder.join(file)));
        let mut inputs = Self::default();
        inputs.add("the spec".to_owned(), path);
        named.for_each(|(what, path): (String, PathBuf)| inputs.add(what, &path));
        inputs
    }

    /// The same, and the files of a request.
    pub fn of_request(path: &Path, spec: &Spec, request: &Request) -> Self {
        let files = request.files().into_iter();
        files.fold(Self::of_spec(path, spec), |inputs, (option, file)| {
            inputs.with(option, &file)
        })
    }

    /// The same with the file of an option.
    #[must_use]
    pub fn with(mut self, option: &str, path: &Path) -> Self {
        self.add(format!("the file of `{option}`"), path);
        self
    }

    fn add(&mut self, what: String, path: &Path) {
        self.0.extend(Identity::at(path).map(|file| (what, file)));
    }

    /// Opens a file to write to before anything is computed, so that long work does not end in front of a closed door.
    ///
    /// # Errors
    /// `option`, with exit code 2, if it is one of them; `io`, with exit code 1.
    pub fn open(&self, option: &str, path: &Path) -> Result<Destination, Failure> {
        self.refuse(option, Identity::at(path), "give another file")?;
        Destination::file(path).map_err(|error| unwritable(path, &error))
    }

    /// Opens the files of `--out` and `--plot`, which are two.
    ///
    /// # Errors
    /// As of [`Self::open`].
    pub fn open_both(
        &self,
        out: Option<&Path>,
        plot: Option<&Path>,
    ) -> Result<[Option<Destination>; 2], Failure> {
        // whatever is refused, nothing has been made
        for (option, path) in [("--out", out), ("--plot", plot)] {
            let file = path.and_then(Identity::at);
            self.refuse(option, file, "give another file")?;
        }
        let open =
            |option, path: Option<&Path>| path.map(|path| self.open(option, path)).transpose();
        let opened = [open("--out", out)?, open("--plot", plot)?];
        if let (Some(out), Some(plot)) = (out, plot) {
            let file = Identity::at(out);
            if out == plot || file.is_some() && file == Identity::at(plot) {
                let message =
                    Message::option("--plot", "rows and picture cannot go to the same file");
                return Err(message.help("give another file").into());
            }
        }
        Ok(opened)
    }

    /// The same, and the file of the rows.
    #[must_use]
    pub fn with_rows(&self, path: &Path) -> Self {
        let mut files = Self(self.0.clone());
        files.add("the file of the rows".to_owned(), path);
        files
    }

    /// Refuses to write to one of them.
    ///
    /// # Errors
    /// `option`, with exit code 2.
    pub fn spare(&self, option: &str, path: &Path) -> Result<(), Failure> {
        self.refuse(option, Identity::at(path), "give another file")
    }

    /// Refuses to write to one of them by standard output.
    ///
    /// # Errors
    /// `option`, with exit code 2.
    pub fn spare_from_stdout(&self) -> Result<(), Failure> {
        let help = "send the output to another file";
        self.refuse("standard output", Identity::of_stdout(), help)
    }

    fn refuse(&self, option: &str, file: Option<Identity>, help: &str) -> Result<(), Failure> {
        let Some((what, _)) = self
            .0
            .iter()
            .find(|(_, input)| Some(input) == file.as_ref())
        else {
            return Ok(());
        };
        let text = format!("this is {what}, and would be overwritten");
        Err(Message::option(option, text).help(help).into())
    }
}

/// Writes a file that is not there yet.
///
/// # Errors
/// `io` where it is, or cannot be written.
pub fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| {
        let text = format!("{} cannot be written: {error}", path.display());
        let help = match error.kind() {
            io::ErrorKind::AlreadyExists => "choose another name, or remove the file first",
            _ => "choose a folder that can be written",
        };
        Failure::surroundings(Message::io(path, text).help(help))
    })
}

/// A file that does not take anything.
pub fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("cannot be written: {error}"));
    Failure::surroundings(message.help("give a file in a folder that exists and can be written"))
}

/// Writes a file in place of what is there, as a whole: whatever ends this, there is the one or the other.
///
/// # Errors
/// Those of the file system: what is there stays.
pub fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut draft = path.as_os_str().to_owned();
    draft.push(".new");
    let draft = PathBuf::from(draft);
    let written = File::create(&draft).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&draft, path)
    });
    if written.is_err() {
        let _ = fs::remove_file(&draft);
    }
    written?;
    // the name is on the disk too; where folders cannot be opened, the system sees to that
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if let Ok(folder) = File::open(folder.unwrap_or(Path::new("."))) {
        let _ = folder.sync_all();
    }
    Ok(())
}
