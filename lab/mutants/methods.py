"""The calls of `lie verify` that judge changes: methods by the specs on which they are verified."""

METHODS = {
    "so3_nonpolynomial": [
        "midpoint", "gauss4", "gauss6", "lie-midpoint", "lie-midpoint --retraction cayley", "rk4", "dopri5", "taylor", "lie-taylor",
        "lie-euler", "rkmk2", "rkmk3", "rkmk4", "rkmk6", "cg3", "cf4", "compose4(midpoint)", "compose6(midpoint)", "compose8(midpoint)",
        "generating2", "generating4", "generating4 --retraction cayley", "generating6", "generating-second-kind2", "collective2",
        "collective4 --lift hopf", "isospectral4", "spherical-midpoint", "gonzalez", "mean-value", "itoh-abe", "orbit-energy",
        "cohen-hairer4", "cohen-hairer6",
    ],
    "so3_free_rigid_body": [
        "splitting1", "splitting2", "splitting4", "splitting6", "splitting8", "moser-veselov",
    ],
    "so4_manakov": [
        "moser-veselov",
    ],
    "se3_heavy_top": [
        "collective4",
    ],
    "lotka_volterra": [
        "k-hj2", "k-hj4", "k-hj6", "orbit-energy", "canonical2", "canonical4", "canonical6",
    ],
    "heisenberg_h3": [
        "cohen-hairer2", "gonzalez", "mean-value", "itoh-abe", "orbit-energy", "orbit-energy --gradient mean-value", "cohen-hairer4",
    ],
}
