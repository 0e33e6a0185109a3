//! The checkpoint of a run: a file from which `lie resume` goes on.
//!
//! It is written beside its place and renamed, after the rows that it counts are on the disk: whatever ends the run, there is a
//! whole one, and all that it speaks of.

use std::fs;
use std::io;
use std::path::Path;

use lie_in_process::checkpoint::Unread;
pub use lie_in_process::checkpoint::{Checkpoint, Place};
use lie_syntax::diagnostic::Kind;
use lie_syntax::front::spec::files;

use crate::build::{self, Key};
use crate::command::args;
use crate::command::files::put;
use crate::compiler::Spec;
use crate::message::{Failure, Message, Place as At};

/// What is wrong with a checkpoint.
pub fn refused(path: &Path, text: impl Into<String>) -> Message {
    Message::new(Kind::Checkpoint, text).at_place(At::File(path.display().to_string()))
}

/// That of a run that has not begun.
///
/// # Errors
/// `option` for arguments that are no text; `io` for inputs that cannot be read again.
pub fn of(flags: &args::Run, spec: &Spec) -> Result<Checkpoint, Failure> {
    let arguments = std::env::args_os().skip(1).map(|one| one.into_string());
    let arguments = arguments.collect::<Result<_, _>>().map_err(|_| {
        let text = "a checkpoint keeps the command line, which is not UTF-8";
        Message::option("--checkpoint", text).help("give the files names that are text")
    })?;
    let path = &flags.specs[0];
    let mut inputs = vec![(path.clone(), Key::digest(spec.source.text.as_bytes()))];
    let folder = path.parent().unwrap_or(Path::new(""));
    let named = files(&spec.source.text)
        .into_iter()
        .map(|file| folder.join(file));
    let asked = flags.request.files().into_iter().map(|(_, path)| path);
    for path in named.chain(asked) {
        let bytes = fs::read(&path).map_err(|error| unreadable(&path, &error))?;
        inputs.push((path, Key::digest(unmarked(&bytes))));
    }
    Ok(Checkpoint {
        arguments,
        folder: std::env::current_dir().unwrap_or_default(),
        inputs,
        place: None,
        finished: false,
    })
}

/// Reads one.
///
/// # Errors
/// `checkpoint` for what is none, is damaged, or was written by another version; `io`.
pub fn read(path: &Path) -> Result<Checkpoint, Failure> {
    match path.metadata() {
        Ok(found) if found.is_file() => {}
        Ok(_) => return Err(none(path).into()),
        Err(error) => return Err(unreadable(path, &error)),
    }
    let bytes = fs::read(path).map_err(|error| unreadable(path, &error))?;
    let ours = build::version();
    Checkpoint::read(&bytes, ours).map_err(|unread| {
        let message = match unread {
            Unread::Foreign => none(path),
            Unread::Version(writer) => {
                let text =
                    format!("the checkpoint was written by lie {writer}, and this is lie {ours}");
                let help = "go on with the program that has written it, or begin the run anew with `lie run`";
                refused(path, text).help(help)
            }
            Unread::Damaged(what) => {
                let message = refused(path, format!("the checkpoint is damaged: {what}"));
                message.help("begin the run anew with `lie run`, or take a copy of the checkpoint if there is one")
            }
        };
        message.into()
    })
}

/// Writes it in place of what is there.
///
/// # Errors
/// Those of the file system: what is there stays.
pub fn write(checkpoint: &Checkpoint, path: &Path) -> io::Result<()> {
    let text = checkpoint.text(build::version())?;
    put(path, text.as_bytes())
}

/// Whether its inputs are what they were.
///
/// # Errors
/// `checkpoint` at the first that is not.
pub fn check_inputs(checkpoint: &Checkpoint) -> Result<(), Failure> {
    for (path, digest) in &checkpoint.inputs {
        let text = match fs::read(path) {
            Ok(bytes) if Key::digest(unmarked(&bytes)) == *digest => continue,
            Ok(_) => "this file has changed since the run began".to_owned(),
            Err(error) => format!("this file, which the run has read, is not there: {error}"),
        };
        let help = "put it back as it was, or begin the run anew with `lie run`";
        return Err(refused(path, text).help(help).into());
    }
    Ok(())
}

/// The bytes of a file without the mark that some editors put in front.
fn unmarked(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

fn none(path: &Path) -> Message {
    let help = "give the file that was named by `--checkpoint`";
    refused(path, "this is no checkpoint of this form").help(help)
}

fn unreadable(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("cannot be read: {error}"));
    Failure::surroundings(message.help("give the file that was named by `--checkpoint`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes of one.
    fn whole(path: &Path) -> Vec<u8> {
        let milestone = serde_json::json!({
            "index": 1000, "time": 10.0, "step": 4, "state": [1, 2], "branch": null, "element": [],
            "stats": {
                "steps": 1000, "evaluations": 4000, "newton": 0, "fixed_point": 0, "factorizations": 0, "pivoted": 0,
                "accepted": 1000, "rejected": 0, "failures": 0
            },
            "division": { "parts": 1, "shortened": null, "slow": [0, 0], "watched": null }
        });
        let content = serde_json::json!({
            "arguments": ["run", "body.json"], "folder": "/", "inputs": [["body.json", "00"]], "finished": false,
            "place": {
                "milestone": milestone, "written": null, "shortened": null, "seconds": 0.5,
                "drift": { "invariants": [[1, 2]], "scale": 3, "time": 4 }
            }
        });
        let checkpoint: Checkpoint = serde_json::from_value(content).unwrap();
        super::write(&checkpoint, path).unwrap();
        fs::read(path).unwrap()
    }

    #[test]
    fn whatever_is_damaged_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ck");
        let whole = whole(&path);
        let read = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            let read = super::read(&path);
            if let Err(failure) = &read {
                let [message] = failure.messages.as_slice() else {
                    panic!("{} messages", failure.messages.len())
                };
                assert_eq!((message.kind, failure.code), (Kind::Checkpoint, 2));
                assert!(message.help.is_some());
            }
            read.is_ok()
        };
        assert!(read(&whole), "the control");
        for length in 0..whole.len() {
            assert!(!read(&whole[..length]), "cut to {length} bytes");
        }
        for place in 0..whole.len() {
            for bit in 0..8 {
                let mut flipped = whole.clone();
                flipped[place] ^= 1 << bit;
                assert!(!read(&flipped), "bit {bit} of byte {place}");
            }
        }
        let others = [&whole[..], &whole].concat();
        assert!(!read(&others) && !read(&[0; 10_000]) && !read(b"\n\n\n"));
    }
}
