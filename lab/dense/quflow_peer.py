"""Steps of the Euler equations on the sphere by quflow's isospectral midpoint, for `run`: initial states, then one line of JSON each.

    python3 quflow_peer.py FOLDER states     writes the initial states and step sizes
    python3 quflow_peer.py FOLDER measure    steps from them
"""

import json
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("NUMBA_NUM_THREADS", "1")
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np  # noqa: E402
from scipy.linalg import solve_banded  # noqa: E402

SIZES = (32, 64, 128)
STEPS = 100
ROTATION = 0.05
"""The step: |h/2 P/hbar| in the spectral norm at the start."""


def uniform(seed):
    """SplitMix64, uniform in [0, 1)."""
    mask = 2**64 - 1
    state = seed
    while True:
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        yield ((z ^ (z >> 31)) >> 11) * 2.0**-53


def inverse_laplacian(w):
    """P with Delta_N P = W, diagonal by diagonal."""
    size = len(w)
    p = np.zeros_like(w)
    for m in range(size):
        k = np.arange(size - m)
        diagonal = 2.0 * k * (k + m) - (size - 1) * (2 * k + 1 + m)
        beside = np.sqrt(1.0 * (k + m) * (size - k - m) * k * (size - k))
        right = np.diagonal(w, -m).copy()
        if m == 0:
            right -= right.mean()
            diagonal[0] -= 0.5
        bands = np.zeros((3, size - m))
        bands[1] = diagonal
        bands[0, 1:] = beside[1:]
        bands[2, :-1] = beside[1:]
        solution = solve_banded((1, 1), bands, right)
        if m == 0:
            solution -= solution.mean()
        p[k + m, k] = solution
        if m:
            p[k, k + m] = -solution.conj()
    return p


def states(folder):
    """A random matrix smoothed by the inverse Laplacian, of norm 1."""
    for size in SIZES:
        draw = uniform(99)
        numbers = np.array([2 * next(draw) - 1 for _ in range(2 * size * size)]).reshape(2, size, size)
        w = numbers[0] + 1j * numbers[1]
        w -= w.conj().T
        w -= np.eye(size) * np.trace(w) / size
        w = inverse_laplacian(w)
        w = np.ascontiguousarray((w - w.conj().T) / 2)
        w /= np.linalg.norm(w, 2)
        w.tofile(folder / f"w0_{size}.bin")
        hbar = 2 / np.sqrt(size**2 - 1)
        h = 2 * hbar * ROTATION / np.linalg.norm(inverse_laplacian(w), 2)
        (folder / f"h_{size}.txt").write_text(repr(float(h)))


def measure(folder):
    from quflow.integrators.isospectral import isomp_fixedpoint

    for size in SIZES:
        start = np.fromfile(folder / f"w0_{size}.bin", dtype=complex).reshape(size, size)
        h = float((folder / f"h_{size}.txt").read_text())
        norm = np.linalg.norm(start, np.inf)
        # "auto" with the compensated sum is quflow's own choice of round-off
        for until, options in (
            ("round-off", {"tol": "auto", "compsum": True, "maxit": 50}),
            ("round-off, plain sum", {"tol": np.finfo(float).eps * 2 * ROTATION * norm, "maxit": 50}),
            ("1e-10", {"tol": 1e-10 * norm, "maxit": 50}),
        ):
            times, end, stats = np.full(STEPS, np.inf), None, {}
            for _ in range(4):
                stats = {"iterations": 0.0}
                clock = []
                end = isomp_fixedpoint(start.copy(), h, steps=STEPS, stats=stats,
                                       callback=lambda *_: clock.append(time.process_time()), **options)
                # the first step is not seen alone: it counts as the second
                spent = np.diff(clock)
                times = np.minimum(times, np.concatenate((spent[:1], spent)))
            best = times.sum()
            end.tofile(folder / f"quflow_{size}_{until}.bin")
            change = np.abs(np.sort(np.linalg.eigvalsh(1j * end)) - np.sort(np.linalg.eigvalsh(1j * start))).max()
            print(json.dumps({
                "peer": "quflow", "N": size, "until": until, "us_per_step": best / STEPS * 1e6,
                "iterations": float(stats["iterations"]), "us_per_iteration": best / STEPS / stats["iterations"] * 1e6,
                "spectrum": float(change)}), flush=True)


if __name__ == "__main__":
    where = Path(sys.argv[1])
    {"states": states, "measure": measure}[sys.argv[2]](where)
