#!/usr/bin/env python3
"""Values of the elementary functions to 90 digits, by mpmath, for the tests of ball arithmetic.

Writes crates/lie-symbolic/src/exact/ball/values.txt: function, argument (or y and x of atan2), value. The arguments are
dyadic rationals, so that they are the same numbers everywhere: small, moderate and large ones, of both signs, and
ones next to the ends of intervals and to zeros.
"""
import pathlib
import random

from mpmath import mp, mpf

mp.dps = 120
random.seed(2018)

FUNCTIONS = {
    "exp": mp.exp, "log": mp.log, "sqrt": mp.sqrt, "sin": mp.sin, "cos": mp.cos, "tan": mp.tan, "asin": mp.asin,
    "acos": mp.acos, "atan": mp.atan, "sinh": mp.sinh, "cosh": mp.cosh, "tanh": mp.tanh,
    "cuberoot": lambda x: mp.exp(mp.log(x) / 3), "atan2": mp.atan2,
    "cbrt": lambda x: mp.sign(x) * mp.cbrt(abs(x)), "log1p": mp.log1p, "expm1": mp.expm1, "asinh": mp.asinh,
    "acosh": mp.acosh, "atanh": mp.atanh,
}


def dyadic(name):
    """An integer n and an exponent k of the argument n/2^k inside the domain."""
    while True:
        k = random.choice([4, 12, 20, 40, 60])
        size = random.choice([-40, -10, -3, -1, 0, 1, 2, 5])
        n = int(random.uniform(0.5, 1) * 2 ** (k + size))
        if n == 0:
            continue
        if name in ("asin", "acos", "atanh", "log1p"):
            n = min(n, 2 ** k - 1)
        if name == "acosh":
            n += 2 ** k
        if name not in ("log", "sqrt", "cuberoot", "acosh") and random.random() < 0.5:
            n = -n
        return n, k


lines = []
for name, function in FUNCTIONS.items():
    for _ in range(24):
        arguments = [dyadic(name) for _ in range(2 if name == "atan2" else 1)]
        value = function(*(mpf(n) / mpf(2) ** k for n, k in arguments))
        texts = " ".join(f"{n}/{2 ** k}" for n, k in arguments)
        lines.append(f"{name} {texts} = {mp.nstr(value, 90, strip_zeros=False, min_fixed=-10**9, max_fixed=10**9)}")
target = pathlib.Path(__file__).parents[2] / "crates/lie-symbolic/src/exact/ball/values.txt"
target.write_text("\n".join(lines) + "\n")
