"""Single steps of generating-function methods in 60 digits, from the Hamilton-Jacobi equation itself.

The function is not taken from a formula: with `z = (dtau_{-grad S}^{-1})^* p` the equation
`dS/dt = H(z)`, `S(0) = 0` is solved as a power series in t, symbolically, for exponential, Cayley and
second-kind coordinates. The step then solves `(dtau_xi^{-1})^* p = mu`, `xi = h grad S`, by Newton's method.

    python lab/tools/generating_functions.py            # rewrites tests/data/vectors/generating.json
    python lab/tools/generating_functions.py --check    # recomputes and compares instead
"""

import itertools
import json
import pathlib
import sys

import mpmath as mp
import sympy as sp

from lie_spec import load

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGET = ROOT / "tests/data/vectors/generating.json"
DIGITS = 40
mp.mp.dps = 60

METHODS = [
    ("generating4", "cayley", 3),
    ("generating6", "exp", 5),
    ("generating-second-kind2", "second", 2),
]
SYSTEMS = [
    "e2_pendulum", "heisenberg_h3", "se3_heavy_top", "sl2_quadratic", "so3_free_rigid_body",
    "so3_nonpolynomial", "so4_manakov", "toda3_solvable",
]


class Algebra:
    """Operations on vectors of sympy or mpmath numbers, from the structure constants."""

    def __init__(self, system):
        self.n = system.dimension
        self.constants = [(i, j, k, v) for (i, j, k), v in system.constants.items()]
        self.triple = triple_product(system.matrices) if system.matrices else None

    def ad_star(self, xi, mu):
        out = [0] * self.n
        for i, j, k, value in self.constants:
            out[j] += value * xi[i] * mu[k]
        return out

    def square(self, xi, zeta, mu):
        """`out_b = T_abc^d xi^a zeta^c mu_d`."""
        out = [0] * self.n
        for a, b, c, d, value in self.triple:
            out[b] += value * xi[a] * zeta[c] * mu[d]
        return out


def triple_product(matrices):
    """`(a, b, c, d, T)` with `(abc + cba)/2 = T_abc^d` in the representation; None if it is not closed."""
    n = len(matrices)
    columns = sp.Matrix([[entry for entry in m] for m in matrices]).T
    gram = (columns.T * columns).inv() * columns.T
    out = []
    for a, b, c in itertools.product(range(n), repeat=3):
        value = (matrices[a] * matrices[b] * matrices[c] + matrices[c] * matrices[b] * matrices[a]) / 2
        flat = sp.Matrix([entry for entry in value])
        coordinates = gram * flat
        if columns * coordinates != flat:
            return None
        out += [(a, b, c, d, v) for d, v in enumerate(coordinates) if v != 0]
    return out


def end_of_step(algebra, kind, xi, p):
    """Coefficients in t of `(dtau_{-xi(t)}^{-1})^* p`; `xi[a]` is the coefficient of t^a, xi[0] = 0."""
    length, n = len(xi), algebra.n

    def times(apply, series):
        out = [[0] * n for _ in range(length)]
        for a in range(1, length):
            for b in range(length - a):
                out[a + b] = [u + v for u, v in zip(out[a + b], apply(xi[a], series[b]))]
        return out

    start = [list(p)] + [[0] * n for _ in range(length - 1)]
    if kind == "exp":
        # sum of B_k/k! (-ad*_xi)^k, B_1 = -1/2
        total, power = [row[:] for row in start], start
        for k in range(1, length):
            power = times(algebra.ad_star, power)
            weight = sp.Rational(1, 2) if k == 1 else sp.bernoulli(k) / sp.factorial(k) * (-1) ** k
            total = [[u + weight * v for u, v in zip(a, b)] for a, b in zip(total, power)]
        return total
    if kind == "cayley":
        total = [row[:] for row in start]
        first = times(algebra.ad_star, start)
        total = [[u + v / sp.Integer(2) for u, v in zip(a, b)] for a, b in zip(total, first)]
        for a, c in itertools.product(range(1, length), repeat=2):
            if a + c < length:
                part = algebra.square(xi[a], xi[c], p)
                total[a + c] = [u - v / sp.Integer(4) for u, v in zip(total[a + c], part)]
        return total
    # D_L^{-T} p to first order: column i of D_L is e_i - sum_(j>i) xi_j [e_j, e_i]
    assert length <= 2
    total = [row[:] for row in start]
    for i, j, k, value in algebra.constants:
        if i > j and length == 2:
            total[1][j] += value * xi[1][i] * p[k]
    return total


def series(system, algebra, kind, order):
    """`grad S_k` for k = 1..order-1 and `S_order`, as expressions in the coordinates."""
    x, t = system.coordinates, sp.Symbol("t_")
    energy = system.hamiltonian
    gradients = [[0] * algebra.n, [sp.diff(energy, v) for v in x]]
    for m in range(1, order):
        if kind != "second" and m % 2 == 1:
            # tau(-xi) is the inverse of tau(xi): S is odd
            gradients.append([sp.Integer(0)] * algebra.n)
            continue
        moved = end_of_step(algebra, kind, gradients[:m + 1], x)
        marks = [[sp.Symbol(f"z_{a}_{i}") for i in range(algebra.n)] for a in range(m + 1)]
        path = {v: v + sum(t ** a * marks[a][i] for a in range(1, m + 1)) for i, v in enumerate(x)}
        along = sp.diff(energy.xreplace(path), t, m).subs(t, 0) / sp.factorial(m)
        values = {marks[a][i]: moved[a][i] for a in range(1, m + 1) for i in range(algebra.n)}
        coefficient = along.xreplace(values) / (m + 1)
        if m + 1 == order:
            return gradients[1:], coefficient
        gradients.append([sp.diff(coefficient, v) for v in x])
    raise ValueError("S_order vanishes")


def exponential(apply, start):
    """The exponential series of a linear map on a vector."""
    total, term, k = list(start), list(start), 0
    while max(abs(v) for v in term) > mp.mpf(10) ** -75:
        k += 1
        term = [v / k for v in apply(term)]
        total = [u + v for u, v in zip(total, term)]
    return total


def unit(n, i):
    return [mp.mpf(int(j == i)) for j in range(n)]


def scaled(factor, vector):
    return [factor * v for v in vector]


def ends(algebra, kind, xi, p):
    """`(dtau_xi^{-1})^* p` and `(dtau_{-xi}^{-1})^* p`."""
    n = algebra.n
    if kind == "cayley":
        first, second = algebra.ad_star(xi, p), algebra.square(xi, xi, p)
        both = [[p[i] - sign * first[i] / 2 - second[i] / 4 for i in range(n)] for sign in (1, -1)]
        return both
    if kind == "exp":
        # the matrix of phi1(ad*_xi), then one linear system
        out = []
        for sign in (1, -1):
            columns = []
            for j in range(n):
                total, term, k = unit(n, j), unit(n, j), 0
                while max(abs(v) for v in term) > mp.mpf(10) ** -75:
                    k += 1
                    term = [v / (k + 1) for v in algebra.ad_star(scaled(sign, xi), term)]
                    total = [u + v for u, v in zip(total, term)]
                columns.append(total)
            matrix = mp.matrix(n)
            for i, j in itertools.product(range(n), repeat=2):
                matrix[i, j] = columns[j][i]
            out.append(list(mp.lu_solve(matrix, mp.matrix(p))))
        return out

    def adjoint(i, vector):
        """Ad_(exp(-xi_i e_i)) of a vector."""
        def bracket(v):
            out = [mp.mpf(0)] * n
            for a, b, k, value in algebra.constants:
                if a == i:
                    out[k] -= xi[i] * value * v[b]
            return out
        return exponential(bracket, vector)

    # columns of D_L, and Ad of the inverse of the product
    left = mp.matrix(n)
    for i in range(n):
        vector = unit(n, i)
        for j in range(i + 1, n):
            vector = adjoint(j, vector)
        for row in range(n):
            left[row, i] = vector[row]
    inverse = mp.matrix(n)
    for i in range(n):
        vector = unit(n, i)
        for j in range(n):
            vector = adjoint(j, vector)
        for row in range(n):
            inverse[row, i] = vector[row]
    right = mp.inverse(inverse) * left
    return [list(mp.lu_solve(matrix.T, mp.matrix(p))) for matrix in (right, left)]


def steps(name):
    system = load(ROOT / "specs" / f"{name}.json")
    algebra = Algebra(system)
    start = [mp.mpf(sp.N(v, 70)) for v in system.initial]
    numeric = Algebra(system)
    numeric.constants = [(i, j, k, mp.mpf(int(v.p)) / int(v.q)) for i, j, k, v in map(
        lambda c: (*c[:3], sp.Rational(c[3])), algebra.constants)]
    if algebra.triple:
        numeric.triple = [(a, b, c, d, mp.mpf(int(v.p)) / int(v.q)) for a, b, c, d, v in algebra.triple]
    out = []
    for method, kind, order in METHODS:
        if kind == "cayley" and algebra.triple is None:
            continue
        gradients, last = series(system, algebra, kind, order)
        code = sp.lambdify([system.coordinates], gradients, "mpmath", cse=True)
        last = sp.lambdify([system.coordinates], last, "mpmath", cse=True)
        for h in ("1/10", "-1/5"):
            step = mp.mpf(h.split("/")[0]) / int(h.split("/")[1])

            def slope(p):
                rows = [*code(p), difference(last, p)]
                return [sum(step ** (k + 1) * row[i] for k, row in enumerate(rows)) for i in range(algebra.n)]

            p = solve(lambda p: [a - b for a, b in zip(ends(numeric, kind, slope(p), p)[0], start)], start)
            state = ends(numeric, kind, slope(p), p)[1]
            out.append({"method": method, "retraction": kind, "h": h,
                        "state": [mp.nstr(v, DIGITS, strip_zeros=False, min_fixed=-9) for v in state]})
            print(name, method, kind, h, [mp.nstr(v, 12) for v in state], flush=True)
    return out


def difference(function, p):
    """The gradient by central differences of order 4, with digits enough that none of ours is lost."""
    with mp.workdps(200):
        width, out = mp.mpf(10) ** -30, []
        for i in range(len(p)):
            def value(factor):
                return function([mp.mpf(v) + (factor * width if i == j else 0) for j, v in enumerate(p)])
            out.append((8 * (value(1) - value(-1)) - (value(2) - value(-2))) / (12 * width))
    return out


def solve(residual, start):
    """Newton's method with a matrix of differences at the start, to stagnation."""
    n, p = len(start), list(start)
    value, width = residual(p), mp.mpf(10) ** -30
    matrix = mp.matrix(n)
    for j in range(n):
        shifted = [v + (width if i == j else 0) for i, v in enumerate(p)]
        for i, entry in enumerate(residual(shifted)):
            matrix[i, j] = (entry - value[i]) / width
    inverse = mp.inverse(matrix)
    for _ in range(200):
        p = [a - b for a, b in zip(p, inverse * mp.matrix(value))]
        value = residual(p)
        if max(abs(v) for v in value) < mp.mpf(10) ** -52:
            return p
    raise ArithmeticError("no convergence")


def main():
    document = {"format": "lie-poisson-generating/1", "systems": {name: steps(name) for name in SYSTEMS}}
    text = json.dumps(document, indent=1) + "\n"
    if "--check" in sys.argv:
        assert TARGET.read_text() == text, f"{TARGET} differs"
    else:
        TARGET.write_text(text)


if __name__ == "__main__":
    main()
