#!/usr/bin/env python3
"""The verdicts of the prover on random identities, against mpmath: shares no code with the compiler.

    LIE_IDENTITIES=10000 LIE_IDENTITIES_SHOWN=1 cargo test -p unit-tests --test unit_symbolic no_verdict -- --nocapture > verdicts.txt
    python lab/tools/identities.py verdicts.txt

Each line of the file is `verdict|value|change|expression`. The expression is evaluated with 75 digits (400, where
it is not zero, to tell a difference from what cancels) at up to twelve points of its domain, of all signs.
"""
import random
import re
import sys

import mpmath
from mpmath import mp, mpf

mp.dps = 75
random.seed(2018)


class Value:
    """A number of which powers are real, or not defined."""

    def __init__(self, value):
        self.value = mpf(value)

    def __add__(self, other):
        return Value(self.value + other.value)

    def __sub__(self, other):
        return Value(self.value - other.value)

    def __mul__(self, other):
        return Value(self.value * other.value)

    def __truediv__(self, other):
        return Value(self.value / other.value)

    def __neg__(self):
        return Value(-self.value)

    def __pow__(self, other):
        exponent = other.value
        if exponent == int(exponent):
            return Value(self.value ** int(exponent))
        if self.value < 0:
            raise ValueError("not real")
        return Value(self.value**exponent)


def function(name, defined=lambda *_: True):
    def apply(*arguments):
        arguments = [argument.value for argument in arguments]
        if not defined(*arguments):
            raise ValueError("not real")
        return Value(getattr(mpmath, name)(*arguments))

    return apply


DOMAINS = {"sqrt": lambda x: x >= 0, "log": lambda x: x > 0, "asin": lambda x: abs(x) <= 1, "acos": lambda x: abs(x) <= 1}
NAMES = "sqrt exp log sin cos tan asin acos atan sinh cosh tanh atan2".split()
FUNCTIONS = {name: function(name, DOMAINS.get(name, lambda *_: True)) for name in NAMES}


def evaluate(code, point):
    names = {**FUNCTIONS, "Value": Value, "pi": Value(+mp.pi), **{k: Value(v) for k, v in point.items()}}
    return eval(code, names).value


def truth(text):
    """Whether the expression is zero at all points that were found in its domain; None without such."""
    code = compile(re.sub(r"(?<![\w.])(\d+)", r"Value(\1)", text.replace("^", "**")), text, "eval")
    seen = 0
    for k in range(60):
        scale = [0.4, 1, 3, 2][k % 4] if k >= 8 else 1
        point = {name: (-1) ** (k >> i & 1) * scale * random.uniform(0.05, 1.2) for i, name in enumerate("xyk")}
        try:
            value = evaluate(code, point)
            if abs(value) > mpf(10) ** -55:
                with mp.workdps(400):
                    if abs(evaluate(code, point)) > abs(value) * mpf(10) ** -100:
                        return False
        except (ValueError, ZeroDivisionError, OverflowError):
            continue
        seen += 1
        if seen == 12:
            break
    return True if seen else None


def main():
    count = {}
    for line in open(sys.argv[1], errors="replace"):
        parts = line.rstrip("\n").split("|")
        if len(parts) != 4:
            continue
        verdict = parts[0].split("(")[0]
        zero = truth(parts[3])
        count[verdict, zero] = count.get((verdict, zero), 0) + 1
        if (verdict, zero) in [("Zero", False), ("Nonzero", True)]:
            print("wrong:", line)
    for (verdict, zero), times in sorted(count.items(), key=str):
        print(f"{verdict}: {times} that are {({True: 'zero', False: 'not zero', None: 'defined at no point'})[zero]}")
    return ("Zero", False) in count or ("Nonzero", True) in count


if __name__ == "__main__":
    sys.exit(main())
