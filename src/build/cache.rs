//! Where built programs are kept.

use std::io;
use std::path::{Path, PathBuf};

use lie_syntax::diagnostic::Kind;

use crate::message::{Failure, Message};

/// The cache folder, made if it is not there.
///
/// # Errors
/// `io` if no such folder is known or can be created, or if others could put programs into it.
pub fn root() -> Result<PathBuf, Failure> {
    let root = place()?;
    create(&root).map_err(|error| failure(&root, &error))?;
    is_ours(&root)?;
    Ok(root)
}

/// Where the cache folder is or would be: `$LIE_CACHE_DIR`, else `lie-poisson` in the platform's folder for caches.
///
/// # Errors
/// `io` if no such folder is known.
pub fn place() -> Result<PathBuf, Failure> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    let root = chosen(&variable).ok_or_else(|| {
        let text = "no folder for the cache: none of LIE_CACHE_DIR, XDG_CACHE_HOME, HOME is set";
        let help = "set LIE_CACHE_DIR to a folder that can be written";
        Failure::surroundings(Message::new(Kind::Io, text).help(help))
    })?;
    Ok(std::path::absolute(&root).unwrap_or(root))
}

/// Makes the folder, for its owner alone: programs come from it.
fn create(root: &Path) -> io::Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.recursive(true).create(root)
}

/// Whoever can write there decides what our user runs. A group may share a cache: that is how its folder was made.
#[cfg(unix)]
fn is_ours(root: &Path) -> Result<(), Failure> {
    use std::os::unix::fs::MetadataExt as _;
    let found = std::fs::metadata(root).map_err(|error| failure(root, &error))?;
    let (owner, us) = (found.uid(), rustix::process::geteuid().as_raw());
    let root = root.display();
    let (text, help) = if owner != us && owner != 0 {
        (
            format!("the cache {root} belongs to another user, who could put programs into it"),
            "set LIE_CACHE_DIR to a folder of your own".to_owned(),
        )
    } else if found.mode() & 0o002 != 0 {
        (
            format!("every user can write to the cache {root} and put programs into it"),
            format!(
                "make it yours with `chmod o-w {root}`, or set LIE_CACHE_DIR to another folder"
            ),
        )
    } else {
        return Ok(());
    };
    Err(Failure::surroundings(
        Message::new(Kind::Io, text).help(help),
    ))
}

#[cfg(not(unix))]
fn is_ours(_root: &Path) -> Result<(), Failure> {
    Ok(())
}

fn chosen(variable: &dyn Fn(&str) -> Option<std::ffi::OsString>) -> Option<PathBuf> {
    if let Some(folder) = variable("LIE_CACHE_DIR") {
        return Some(folder.into());
    }
    // The XDG specification wants relative values ignored.
    let xdg = variable("XDG_CACHE_HOME")
        .map(PathBuf::from)
        .filter(|path| path.is_absolute());
    let folder = if let Some(xdg) = xdg {
        xdg
    } else if cfg!(windows) {
        variable("LOCALAPPDATA")?.into()
    } else if cfg!(target_os = "macos") {
        Path::new(&variable("HOME")?).join("Library/Caches")
    } else {
        Path::new(&variable("HOME")?).join(".cache")
    };
    Some(folder.join("lie-poisson"))
}

/// A file of the cache that cannot be read or written.
pub fn failure(path: &Path, error: &io::Error) -> Failure {
    let message = Message::io(path, format!("the cache cannot be used: {error}"));
    Failure::surroundings(message.help("set LIE_CACHE_DIR to a folder that can be written"))
}

/// Writes a file so that other processes see all of it or nothing.
pub fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    io::Write::write_all(&mut file, content)?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_of_the_variables() {
        let with = |set: &'static [(&str, &str)]| {
            chosen(&move |name| {
                set.iter()
                    .find(|(known, _)| *known == name)
                    .map(|(_, value)| value.into())
            })
        };
        let all = &[
            ("LIE_CACHE_DIR", "a"),
            ("XDG_CACHE_HOME", "/x"),
            ("HOME", "/h"),
        ];
        assert_eq!(with(all), Some("a".into()));
        assert_eq!(with(&all[1..]), Some("/x/lie-poisson".into()));
        if cfg!(target_os = "linux") {
            assert_eq!(with(&all[2..]), Some("/h/.cache/lie-poisson".into()));
            let relative = &[("XDG_CACHE_HOME", "x"), ("HOME", "/h")];
            assert_eq!(with(relative), Some("/h/.cache/lie-poisson".into()));
            assert_eq!(with(&[]), None);
        }
    }
}
