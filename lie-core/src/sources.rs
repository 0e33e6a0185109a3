//! This crate's own files, for tools that build generated programs without a registry.
//!
//! Write every file of [`FILES`] below a folder `src` and [`MANIFEST`] beside it as `Cargo.toml`.

/// The manifest: no workspace, no dependencies of tests.
pub const MANIFEST: &str = include_str!("standalone.toml");

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!($path))),*]
    };
}

/// Paths relative to the folder `src`, and contents.
pub const FILES: &[(&str, &str)] = files![
    "elimination.rs",
    "equation.rs",
    "generating.rs",
    "generic/cayley_midpoint.rs",
    "generic/cayley_variational.rs",
    "generic/chart.rs",
    "generic/cohen_hairer.rs",
    "generic/coordinate_flows.rs",
    "generic/dexp_slope.rs",
    "generic/discrete_body.rs",
    "generic/discrete_gradient/gonzalez.rs",
    "generic/discrete_gradient/itoh_abe.rs",
    "generic/discrete_gradient/mean_value.rs",
    "generic/discrete_gradient/mod.rs",
    "generic/discrete_gradient/resolution.rs",
    "generic/discrete_gradient_step.rs",
    "generic/discrete_top.rs",
    "generic/euler_arnold.rs",
    "generic/exp_midpoint.rs",
    "generic/exp_variational.rs",
    "generic/galerkin/mod.rs",
    "generic/galerkin/path.rs",
    "generic/gauss.rs",
    "generic/generating/derivatives.rs",
    "generic/generating/mod.rs",
    "generic/generating/slopes.rs",
    "generic/inverse_tangent.rs",
    "generic/kernels.rs",
    "generic/matrix_stages.rs",
    "generic/midpoint.rs",
    "generic/mod.rs",
    "generic/orbit_energy.rs",
    "generic/quadrature.rs",
    "generic/quaternion_stages.rs",
    "generic/realized.rs",
    "generic/rotation.rs",
    "generic/second_kind.rs",
    "generic/series.rs",
    "generic/spherical.rs",
    "generic/stage_momenta.rs",
    "generic/tableau.rs",
    "generic/tensor.rs",
    "lagrangian/declared.rs",
    "lagrangian/discrete.rs",
    "lagrangian/legendre.rs",
    "lagrangian/mod.rs",
    "lagrangian/path.rs",
    "lib.rs",
    "matrix.rs",
    "methods/coefficients.rs",
    "methods/cohen_hairer.rs",
    "methods/collective.rs",
    "methods/commutator_free.rs",
    "methods/compose.rs",
    "methods/crouch_grossman.rs",
    "methods/discrete_euler_poincare.rs",
    "methods/dopri5.rs",
    "methods/euler_arnold.rs",
    "methods/explicit.rs",
    "methods/facts.rs",
    "methods/gauss.rs",
    "methods/generating.rs",
    "methods/generating_second_kind.rs",
    "methods/gonzalez.rs",
    "methods/implicit.rs",
    "methods/isospectral.rs",
    "methods/itoh_abe.rs",
    "methods/lie_euler.rs",
    "methods/lie_midpoint.rs",
    "methods/mean_value.rs",
    "methods/midpoint.rs",
    "methods/mod.rs",
    "methods/moser_veselov.rs",
    "methods/orbit_energy.rs",
    "methods/realized.rs",
    "methods/rk4.rs",
    "methods/rkmk.rs",
    "methods/spherical_midpoint.rs",
    "methods/splitting.rs",
    "methods/stepper.rs",
    "methods/tensor.rs",
    "methods/variational.rs",
    "newton/convergence.rs",
    "newton/dense.rs",
    "newton/exchanging.rs",
    "newton/mod.rs",
    "newton/options.rs",
    "newton/pivoted.rs",
    "newton/report.rs",
    "newton/solver.rs",
    "newton/update.rs",
    "parameter.rs",
    "pieces.rs",
    "poisson.rs",
    "scalar/dual.rs",
    "scalar/float.rs",
    "scalar/lanes.rs",
    "scalar/mask.rs",
    "scalar/mod.rs",
    "sources.rs",
    "standalone.toml",
    "state.rs",
    "structure.rs",
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
        for name in ["libm", "nalgebra", "thiserror", "wide"] {
            assert_eq!(requirement(MANIFEST, name), requirement(&workspace, name));
        }
    }
}
