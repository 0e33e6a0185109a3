//! What tells a file from all others, whatever it is called.

use std::path::Path;

/// A file on a disk. Pipes, terminals and other devices have none: to write to them takes nothing away.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity(Unique);

/// Device and inode.
#[cfg(unix)]
type Unique = (u64, u64);
/// The path without links.
#[cfg(not(unix))]
type Unique = std::path::PathBuf;

impl Identity {
    /// The file at a path, behind all links.
    pub fn at(path: &Path) -> Option<Self> {
        let metadata = path.metadata().ok().filter(std::fs::Metadata::is_file)?;
        Self::of(path, &metadata)
    }

    /// The file that standard output goes to.
    #[cfg(unix)]
    pub fn of_stdout() -> Option<Self> {
        use std::os::fd::AsFd as _;
        let copy = std::io::stdout().as_fd().try_clone_to_owned().ok()?;
        let metadata = std::fs::File::from(copy).metadata().ok()?;
        metadata
            .is_file()
            .then(|| Self::of(Path::new(""), &metadata))?
    }

    /// The system does not tell.
    #[cfg(not(unix))]
    pub fn of_stdout() -> Option<Self> {
        None
    }

    #[cfg(unix)]
    fn of(_: &Path, metadata: &std::fs::Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt as _;
        Some(Self((metadata.dev(), metadata.ino())))
    }

    #[cfg(not(unix))]
    fn of(path: &Path, _: &std::fs::Metadata) -> Option<Self> {
        path.canonicalize().ok().map(Self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_all_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a"), "").unwrap();
        std::fs::write(path("b"), "").unwrap();
        let file = Identity::at(&path("a"));
        assert!(file.is_some() && file == Identity::at(&path("./a")));
        assert_ne!(file, Identity::at(&path("b")));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", path("soft")).unwrap();
            std::fs::hard_link(path("a"), path("hard")).unwrap();
            assert!(
                ["soft", "hard"]
                    .iter()
                    .all(|name| file == Identity::at(&path(name)))
            );
            assert_eq!(Identity::at(Path::new("/dev/null")), None);
        }
        assert_eq!(Identity::at(&path("none")), None);
        assert_eq!(Identity::at(folder.path()), None);
    }
}
