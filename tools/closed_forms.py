"""Rewrites lie-core/src/closed/values.txt: Stumpff functions and phi functions, to 50 digits before they are rounded."""

from pathlib import Path

from mpmath import factorial, mp, mpf, nstr

mp.dps = 500  # the sums cancel where the argument is large
ROOT = Path(__file__).resolve().parent.parent
SIZES = [1e-24, 1e-13, 1e-6, 1e-3, 0.05, 0.3, 0.9, 1.0, 1.0000001, 1.5, 3.0, 4.0, 4.0001, 9.0, 15.9, 16.0, 16.0001, 17.0, 40.0, 100.0,
         350.0, 1e4]
FUNCTIONS = 9


def series(x, k, stride):
    """sum_n x^n/(stride n + k)!"""
    total, term, n = mpf(0), 1 / factorial(k), 0
    while n < 20 or abs(term) > mpf(10) ** -60 * abs(total):
        total += term
        divisor = mpf(1)
        for j in range(stride):
            divisor *= stride * n + k + 1 + j
        term, n = term * x / divisor, n + 1
    return total


def rows(name, sign, stride, largest):
    for x in [0.0] + [s * size for size in SIZES for s in (1, -1) if size <= largest]:
        values = [series(sign * mpf(x), k, stride) for k in range(FUNCTIONS)]
        yield " ".join([name, repr(x)] + [nstr(value, 25) for value in values])


lines = [*rows("stumpff", -1, 2, 1e4), *rows("phi", 1, 1, 350)]
path = ROOT / "lie-core/src/closed/values.txt"
path.parent.mkdir(exist_ok=True)
path.write_text("\n".join(lines) + "\n")
