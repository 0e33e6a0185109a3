"""100,000 rigid bodies with initial states of the normal distribution until t = 10, by lie-poisson, heyoka's batches and SciPy, side by
side: the table of docs/python.md.

    pip install liepoisson scipy heyoka
    python lab/tools/ensembles.py [--members 100000] [--rounds 3]

Every round times every row once, one after the other, so that a slow moment of the machine falls on all of them; a cell is the median of
the rounds. Errors are the largest distance of a component over the first 200 members, from RK4 with steps of 0.001.
"""

import argparse
import statistics
import sys
import time
from pathlib import Path

import liepoisson as lp
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
UNTIL = 10.0
CHECKED = 200
# of SciPy's one by one
ALONE = 300

OURS = [
    ("`lie-midpoint`, h = 0.1", "lie-midpoint", {"h": 0.1}),
    ("`midpoint`, h = 0.1", "midpoint", {"h": 0.1}),
    ("`gauss4`, h = 0.1", "gauss4", {"h": 0.1}),
    ("`gauss16`, h = 0.5", "gauss16", {"h": 0.5}),
    ("`splitting4`, h = 0.1", "splitting4", {"h": 0.1}),
    ("`splitting8`, h = 0.25", "splitting8", {"h": 0.25}),
    ("`taylor`, h = 10, rtol = 1e-15", "taylor", {"h": 10.0, "rtol": 1e-15}),
    ("`taylor`, h = 10, rtol = 1e-8", "taylor", {"h": 10.0, "rtol": 1e-8}),
    ("`rk4`, h = 0.02", "rk4", {"h": 0.02}),
    ("`dopri5`, rtol = atol = 1e-8", "dopri5", {"h": 10.0, "rtol": 1e-8, "atol": 1e-8}),
]


def ours(body, start, method, options, threads):
    """The states at the end, one row per member."""
    return np.asarray(body.ensemble(start, method, t=UNTIL, threads=threads, **options).mu).reshape(len(start), -1)[:, -3:]


def coefficients(body):
    """Of Euler's equations: x' = a y z, y' = b z x, z' = c x y."""
    i1, i2, i3 = (float(body.parameters[name]) for name in ("I1", "I2", "I3"))
    return 1 / i3 - 1 / i2, 1 / i1 - 1 / i3, 1 / i2 - 1 / i1


def heyoka_batches(factors, tolerance):
    import heyoka as hy

    x, y, z = hy.make_vars("x", "y", "z")
    a, b, c = factors
    batch = hy.taylor_adaptive_batch([(x, a * y * z), (y, b * z * x), (z, c * x * y)], np.zeros((3, 8)), tol=tolerance)

    def run(start):
        ends = np.empty_like(start)
        for first in range(0, len(start), 8):
            batch.set_time(0.0)
            batch.state[:] = start[first : first + 8].T
            batch.propagate_until(UNTIL)
            ends[first : first + 8] = batch.state.T
        return ends

    return run


def dop853(factors, start, members):
    from scipy.integrate import solve_ivp

    a, b, c = factors

    def field(_, state):
        x, y, z = state.reshape(3, -1)
        return np.concatenate([a * y * z, b * z * x, c * x * y])

    ends = [
        solve_ivp(field, (0.0, UNTIL), group.T.ravel(), method="DOP853", rtol=1e-8, atol=1e-8).y[:, -1].reshape(3, -1).T
        for group in np.array_split(start, members)
    ]
    return np.concatenate(ends)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--members", type=int, default=100_000, help="a multiple of 8")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    if arguments.members % 8 or arguments.members < ALONE:
        parser.error(f"--members is a multiple of 8, at least {ALONE}")

    body = lp.load(ROOT / "specs" / "so3_free_rigid_body.json")
    factors = coefficients(body)
    start = np.random.default_rng(1).normal(size=(arguments.members, 3))
    assert np.allclose(body.function("vector_field")(start[0]), [f * start[0, i - 2] * start[0, i - 1] for i, f in enumerate(factors)])
    reference = ours(body, start[:CHECKED], "rk4", {"h": 0.001}, 1)

    # name, threads, part of the members, what computes the states at the end
    rows = [
        (name, threads, 1.0, lambda m=method, o=options, n=threads: ours(body, start, m, o, n))
        for name, method, options in OURS
        for threads in (1, 2)
    ]
    try:
        import heyoka

        for tolerance in ("2.2e-16", "1e-8"):
            run = heyoka_batches(factors, float(tolerance))
            rows.append((f"heyoka {heyoka.__version__}, batches of 8, tolerance {tolerance}", 1, 1.0, lambda r=run: r(start)))
    except ImportError:
        print("heyoka is left out: pip install heyoka", file=sys.stderr)
    try:
        import scipy

        name = f"SciPy {scipy.__version__}, DOP853"
        rows.append((f"{name}, all as one system, rtol = atol = 1e-8", 1, 1.0, lambda: dop853(factors, start, 1)))
        part = arguments.members / ALONE
        rows.append((f"{name}, one by one ({ALONE} members, scaled)", 1, part, lambda: dop853(factors, start[:ALONE], ALONE)))
    except ImportError:
        print("SciPy is left out: pip install scipy", file=sys.stderr)

    times, errors = {}, {}
    for _ in range(arguments.rounds):
        for name, threads, scale, compute in rows:
            begun = time.perf_counter()
            ends = compute()
            times.setdefault((name, threads), []).append((time.perf_counter() - begun) * scale)
            errors[name] = np.abs(ends[:CHECKED] - reference).max()

    print("| what | one thread, s | two threads, s | error |")
    print("|---|---|---|---|")
    for name, error in errors.items():
        cells = [f"{statistics.median(times[name, threads]):.3g}" if (name, threads) in times else "" for threads in (1, 2)]
        print(f"| {name} | {cells[0]} | {cells[1]} | {error:.0e} |".replace("e-0", "e-"))


if __name__ == "__main__":
    main()
