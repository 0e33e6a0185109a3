"""Errors of the elementary functions that are programs, in units in the last place.

    cargo run -p lie-core --example function_values 100000 | python lab/tools/function_errors.py

The values are compared with those of mpmath at 200 bits: of each function the largest error, where it is, and the share of values that are
rounded correctly. A unit is that of the exact value; of subnormal numbers it is 2^-1074. Exit code 1 where an error is larger than a unit, of the
tangent 1.4.
"""

import struct
import sys
from collections import defaultdict

import mpmath

mpmath.mp.prec = 200


def number(word):
    return struct.unpack("<d", struct.pack("<Q", int(word, 16)))[0]


def unit(exact):
    _, exponent = mpmath.frexp(exact)
    return mpmath.ldexp(1, max(int(exponent) - 53, -1074))


def main():
    worst = defaultdict(lambda: (0.0, 0.0))
    counts = defaultdict(lambda: [0, 0])
    for line in sys.stdin:
        name, x, y = line.split()
        x, y = number(x), number(y)
        # the reduction of angles needs the digits of the argument too
        exact = getattr(mpmath, name)(mpmath.mpf(x))
        error = float(abs(mpmath.mpf(y) - exact) / unit(exact))
        key = name + (" subnormal" if abs(exact) < sys.float_info.min else "")
        worst[key] = max(worst[key], (error, x))
        counts[key][0] += 1
        counts[key][1] += error <= 0.5
    failed = False
    for key, (error, x) in sorted(worst.items()):
        all_of_them, right = counts[key]
        print(f"{key:16} {error:.3f} at {x!r}, {100 * right / all_of_them:.1f} % of {all_of_them} rounded correctly")
        failed |= error > (1.4 if key.startswith("tan") else 1.0)
    return failed


if __name__ == "__main__":
    sys.exit(main())
