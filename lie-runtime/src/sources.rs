//! The files of this crate and of [`lie_core`], for tools that build generated programs without a registry.
//!
//! Of each of the [`CRATES`], write every file below a folder `NAME/src` and the manifest as `NAME/Cargo.toml`.

/// A file: its path below the folder `src`, and its content.
pub type File = (&'static str, &'static str);

/// The crates that a generated program is built with: name, manifest, files.
pub const CRATES: [(&str, &str, &[File]); 2] = [
    (
        "lie-core",
        lie_core::sources::MANIFEST,
        lie_core::sources::FILES,
    ),
    ("lie-runtime", MANIFEST, FILES),
];

/// The manifest: no workspace, no macros, no dependencies of tests.
pub const MANIFEST: &str = include_str!("standalone.toml");

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!($path))),*]
    };
}

/// Paths relative to the folder `src`, and contents.
pub const FILES: &[(&str, &str)] = files![
    "diagnostics/any.rs",
    "diagnostics/basis.rs",
    "diagnostics/drift.rs",
    "diagnostics/integrals.rs",
    "diagnostics/mod.rs",
    "diagnostics/newton_order.rs",
    "diagnostics/orbit.rs",
    "diagnostics/order.rs",
    "diagnostics/poisson_defect.rs",
    "diagnostics/random.rs",
    "diagnostics/reference.rs",
    "diagnostics/symmetry.rs",
    "diagnostics/verify/controls.rs",
    "diagnostics/verify/failing.rs",
    "diagnostics/verify/findings.rs",
    "diagnostics/verify/ground.rs",
    "diagnostics/verify/group.rs",
    "diagnostics/verify/invariants.rs",
    "diagnostics/verify/mod.rs",
    "diagnostics/verify/order.rs",
    "diagnostics/verify/plain.rs",
    "diagnostics/verify/solver.rs",
    "driver/error.rs",
    "driver/grid.rs",
    "driver/group_matrix.rs",
    "driver/mod.rs",
    "driver/observer.rs",
    "driver/options.rs",
    "driver/problem.rs",
    "driver/reconstruction.rs",
    "driver/solution.rs",
    "driver/solve.rs",
    "driver/stats.rs",
    "lib.rs",
    "program/measure/bench.rs",
    "program/measure/driven.rs",
    "program/measure/kernels.rs",
    "program/measure/mod.rs",
    "program/measure/outside.rs",
    "program/measure/stress/growth.rs",
    "program/measure/stress/mod.rs",
    "program/measure/stress/outcome.rs",
    "program/measure/timing.rs",
    "program/measure/verify.rs",
    "program/mod.rs",
    "program/request.rs",
    "program/rows.rs",
    "program/tests.rs",
    "sources.rs",
    "standalone.toml",
    "test_systems.rs",
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    fn collect(folder: &Path, root: &Path, found: &mut BTreeSet<String>) {
        for entry in fs::read_dir(folder).expect("the sources are there") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, root, found);
            } else {
                let relative = path.strip_prefix(root).expect("below the root");
                found.insert(relative.to_string_lossy().replace('\\', "/"));
            }
        }
    }

    #[test]
    fn the_list_is_complete() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut found = BTreeSet::new();
        collect(&root, &root, &mut found);
        let listed: BTreeSet<String> = FILES.iter().map(|(path, _)| (*path).to_owned()).collect();
        assert_eq!(listed, found);
        assert_eq!(listed.len(), FILES.len(), "no file twice");
    }

    #[test]
    fn the_manifest_agrees_with_this_crate() {
        let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
        let msrv = format!("rust-version = \"{}\"", env!("CARGO_PKG_RUST_VERSION"));
        for line in [version, msrv] {
            assert!(MANIFEST.lines().any(|other| other == line), "{line}");
        }
        // within the repository: the same requirements as the workspace
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
        let Ok(workspace) = fs::read_to_string(workspace) else {
            return;
        };
        let requirement = |text: &str, name: &str| {
            let line = text
                .lines()
                .find(|line| line.starts_with(&format!("{name} = ")) && !line.contains("dep:"));
            let line = line
                .unwrap_or_else(|| panic!("{name} is required"))
                .to_owned();
            line.replace(", optional = true", "")
        };
        for name in ["libm", "nalgebra", "thiserror"] {
            assert_eq!(requirement(MANIFEST, name), requirement(&workspace, name));
        }
    }
}
