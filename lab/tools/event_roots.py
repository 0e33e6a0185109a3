"""Zeros of a function along a free rigid body, from the closed form to 40 digits.

    python lab/tools/event_roots.py >lie-runtime/tests/event_roots.txt

The body turns about the axis of its largest moment of inertia, I1 < I2 < I3, with a modulus up to 1 - 1e-4:

    m1 = A cn(u),  m2 = B sn(u),  m3 = C dn(u),  u = rate t + u0,

L. D. Landau, E. M. Lifshitz, "Mechanics", section 37. The event is a zero of a m1 + b m2 + c m3 + q m1 m2 - d. A line of the table has the moments of inertia, the initial state, a, b, c, q, d and the end, all of them
exact doubles, then the times in their order with the sign of the slope and its size. Every fourth function comes close to an extremum: two
zeros within a part of a step, or none.
"""

import random

import mpmath as mp
from scipy.optimize import brentq
from scipy.special import ellipj

mp.mp.dps = 45
CASES, TIME = 330, 12.0


class Body:
    """The motion from an initial state; none where the body turns about another axis."""

    def __init__(self, inertia, start):
        one, two, three = (1 / mp.mpf(i) for i in inertia)
        first, second, third = three - two, one - three, two - one
        m1, m2, m3 = (mp.mpf(m) for m in start)
        squares = m1**2 + m2**2 * -first / second, m3**2 + m2**2 * -third / second
        self.a, self.c = mp.sqrt(squares[0]), mp.sqrt(squares[1]) * mp.sign(m3)
        self.b = self.a * mp.sqrt(second / -first)
        self.modulus = -third * self.b**2 / (second * self.c**2)
        if self.modulus < 1:
            self.rate = second * self.a * self.c / self.b
            self.start = mp.ellipf(mp.atan2(m2 / self.b, m1 / self.a), self.modulus)
            self.nome = mp.qfrom(m=self.modulus)

    def at(self, t):
        """The state and its rate."""
        u = self.rate * t + self.start
        sn, cn, dn = (mp.ellipfun(name, u, q=self.nome) for name in ("sn", "cn", "dn"))
        slopes = -self.a * sn * dn, self.b * cn * dn, -self.c * self.modulus * sn * cn
        return (self.a * cn, self.b * sn, self.c * dn), [self.rate * slope for slope in slopes]

    def roughly(self, t):
        """The same in double precision."""
        a, b, c, rate, modulus = (float(x) for x in (self.a, self.b, self.c, self.rate, self.modulus))
        sn, cn, dn, _ = ellipj(rate * t + float(self.start), modulus)
        return (a * cn, b * sn, c * dn), (-rate * a * sn * dn, rate * b * cn * dn, -rate * c * modulus * sn * cn)


def function(body, coefficients):
    """The event function with its derivative."""
    a, b, c, q, d = coefficients

    def both(t, motion=body.at):
        (m1, m2, m3), (s1, s2, s3) = motion(t)
        return a * m1 + b * m2 + c * m3 + q * m1 * m2 - d, a * s1 + b * s2 + c * s3 + q * (s1 * m2 + m1 * s2)

    return both


def zeros(body, coefficients, end):
    """All zeros before the end, in the order in which the run meets them, and the values at extrema: between these there is one at most.

    They are found in double precision, and each is taken to 40 digits by Newton's iteration, whose last step must be below 1e-20.
    """
    count, both = 400, function(body, coefficients)

    def roughly(t):
        return both(t, body.roughly)

    times = [end * k / count for k in range(count + 1)]
    slopes = [roughly(t)[1] for t in times]
    turns = (k for k in range(count) if slopes[k] * slopes[k + 1] < 0)
    extrema = [brentq(lambda t: roughly(t)[1], times[k], times[k + 1], xtol=1e-15) for k in turns]
    places = [times[0], *extrema, times[-1]]
    values = [roughly(t)[0] for t in places]
    found = []
    for k in range(len(places) - 1):
        if values[k] * values[k + 1] < 0:
            t = mp.mpf(brentq(lambda t: roughly(t)[0], places[k], places[k + 1], xtol=1e-15))
            for _ in range(3):
                value, slope = both(t)
                t -= value / slope
            assert abs(value / slope) < mp.mpf(10) ** -20, f"{value} at {t}"
            found.append((t, slope))
    return found, values[1:-1]


def main():
    source = random.Random(2018)
    cases = 0
    while cases < CASES:
        inertia = sorted(source.uniform(0.5, 3.0) for _ in range(3))
        if min(inertia[1] - inertia[0], inertia[2] - inertia[1]) < 0.1:
            continue
        start = [source.uniform(-3.0, 3.0) for _ in range(3)]
        body = Body(inertia, start)
        if not body.modulus < 1 - 1e-4:
            continue
        q = source.choice([0.0, source.uniform(-1.0, 1.0)])
        coefficients = [source.uniform(-1.0, 1.0) for _ in range(3)] + [q, 0.0]
        end = TIME if cases % 2 == 0 else -TIME
        _, extrema = zeros(body, coefficients, end)
        low, high = (min(extrema), max(extrema)) if extrema else (-1, 1)
        if cases % 4 == 0 and extrema:
            coefficients[-1] = float(source.choice(extrema) - source.choice([-1, 1]) * (high - low) * 10 ** -source.uniform(1, 6))
        else:
            coefficients[-1] = float(low + (high - low) * source.uniform(0.02, 0.98))
        found, extrema = zeros(body, coefficients, end)
        # what touches zero to round-off is decided by no double
        if any(abs(value) < 1e-9 for value in extrema) or any(abs(t) < 1e-6 for t, _ in found):
            continue
        numbers = [*inertia, *start, *coefficients, end]
        parts = [f"{mp.nstr(t, 20)} {mp.nstr(slope, 6)}" for t, slope in found]
        print("; ".join([" ".join(repr(x) for x in numbers), *parts]))
        cases += 1


if __name__ == "__main__":
    main()
