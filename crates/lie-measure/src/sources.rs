//! This crate's own files, for tools that build generated programs without a registry.

use include_dir::{Dir, include_dir};

/// The folder `src`, with the manifest to be put beside it in the file `standalone.toml`.
pub static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/src");
