"""Prints single steps of two coupled spins for tests/steps/collective.rs, with 40 digits by mpmath: the spherical
midpoint method by its definition, and Gauss on T*R^2 over each spin by the Hopf map and its lift.

    python lab/tools/spin_steps.py
"""

from mpmath import mp, mpf

mp.dps = 50

# [a_i, a_j] = C a_k and cyclic: mu' = C mu x grad H
SCALES = (mpf(2), mpf(-1))
START = ([mpf(v) / 10 for v in (3, 4, -6)], [mpf(v) / 10 for v in (-5, 2, 7)])


def gradient(x, y):
    """H = x1 y1 + x2 y2/2 - x3 y3/3 + x3^2/4 + sin(y1)/5 + x1 y3^2/7"""
    return ([y[0] + y[2] ** 2 / 7, y[1] / 2, -y[2] / 3 + x[2] / 2],
            [x[0] + mp.cos(y[0]) / 5, x[1] / 2, -x[2] / 3 + 2 * x[0] * y[2] / 7])


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return mp.sqrt(sum(v * v for v in a))


def limit(function, start):
    """The fixed point of a function of a list of numbers."""
    x = start
    for _ in range(1000):
        new = function(x)
        change = max(abs(a - b) for a, b in zip(new, x))
        x = new
        if change < mpf(10) ** -46:
            return x
    raise ArithmeticError("no convergence")


def spherical(h):
    def step(ends):
        middle = []
        for start, end in zip(START, (ends[:3], ends[3:])):
            total = [a + b for a, b in zip(start, end)]
            middle.append([norm(start) / norm(total) * v for v in total])
        new = []
        for start, w, slope, scale in zip(START, middle, gradient(*middle), SCALES):
            new += [a + h * scale * v for a, v in zip(start, cross(w, slope))]
        return new
    return limit(step, START[0] + START[1])


def hopf(z):
    """The Hopf map of z = (q1, q2, p1, p2), and its derivative."""
    q1, q2, p1, p2 = z
    value = [2 * q1 * q2 + 2 * p1 * p2, 2 * q2 * p1 - 2 * q1 * p2, q1 ** 2 + p1 ** 2 - q2 ** 2 - p2 ** 2]
    slopes = [[2 * q2, 2 * q1, 2 * p2, 2 * p1], [-2 * p2, 2 * p1, 2 * q2, -2 * q1], [2 * q1, -2 * q2, 2 * p1, -2 * p2]]
    return [v / 4 for v in value], [[v / 4 for v in row] for row in slopes]


def lift(mu):
    r = norm(mu)
    if mu[2] >= 0:
        q1 = mp.sqrt(2 * (r + mu[2]))
        return [q1, 2 * mu[0] / q1, mpf(0), -2 * mu[1] / q1]
    q2 = mp.sqrt(2 * (r - mu[2]))
    return [2 * mu[0] / q2, q2, 2 * mu[1] / q2, mpf(0)]


def tableau(stages):
    if stages == 1:
        return [mpf(1)], [[mpf(1) / 2]]
    s = mp.sqrt(3) / 6
    return [mpf(1) / 2] * 2, [[mpf(1) / 4, mpf(1) / 4 - s], [mpf(1) / 4 + s, mpf(1) / 4]]


def field(z):
    """The canonical equations of H(C_1 J(z_1), C_2 J(z_2)) on both spaces."""
    values, slopes = zip(*(hopf(z[4 * k:4 * k + 4]) for k in (0, 1)))
    momenta = [[scale * v for v in value] for scale, value in zip(SCALES, values)]
    out = []
    for scale, slope, g in zip(SCALES, slopes, gradient(*momenta)):
        d = [scale * sum(g[i] * slope[i][j] for i in range(3)) for j in range(4)]
        out += [d[2], d[3], -d[0], -d[1]]
    return out


def collective(stages, h):
    b, a = tableau(stages)
    start = sum((lift([v / scale for v in mu]) for mu, scale in zip(START, SCALES)), [])

    def slopes(flat):
        k = [flat[8 * i:8 * i + 8] for i in range(stages)]
        return sum((field([x + h * sum(a[i][j] * k[j][n] for j in range(stages)) for n, x in enumerate(start)])
                    for i in range(stages)), [])
    flat = limit(slopes, field(start) * stages)
    end = [x + h * sum(b[i] * flat[8 * i + n] for i in range(stages)) for n, x in enumerate(start)]
    return sum(([scale * v for v in hopf(end[4 * k:4 * k + 4])[0]] for k, scale in enumerate(SCALES)), [])


def main():
    methods = {"spherical-midpoint": spherical, "collective2": lambda h: collective(1, h), "collective4": lambda h: collective(2, h)}
    for name, method in methods.items():
        for h in (mpf(1) / 10, -mpf(1) / 5):
            x1, x2, x3, y1, y2, y3 = method(h)
            print(name, mp.nstr(h, 3), [mp.nstr(v, 20) for v in (x1, y1, x2, y2, x3, y3)])


if __name__ == "__main__":
    main()
