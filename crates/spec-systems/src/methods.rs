//! Which methods have fused code here.

/// Every family of methods with fused code; of `lie-midpoint` both retractions where they apply.
pub const METHODS: [&str; 19] = [
    "midpoint",
    "gauss4",
    "gauss6",
    "lie-midpoint",
    "splitting2",
    "gonzalez",
    "mean-value",
    "itoh-abe",
    "orbit-energy",
    "cohen-hairer2",
    "cohen-hairer4",
    "cohen-hairer6",
    "collective2",
    "collective4",
    "collective6",
    "spherical-midpoint",
    "moser-veselov",
    "taylor",
    "lie-taylor",
];

/// Methods whose code is much, for some systems.
pub const GENERATING: [&str; 3] = ["generating4", "generating6", "generating-second-kind2"];

/// The systems that have it.
pub const GENERATED: [&str; 7] = [
    "e2_pendulum",
    "heisenberg_h3",
    "se3_heavy_top",
    "so3_free_rigid_body",
    "so3_nonpolynomial",
    "so4_manakov",
    "toda3_solvable",
];
