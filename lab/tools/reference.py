"""Reference trajectories straight from the structure constants, three independent ways:

* `taylor`: the power series of the solution, by Picard iteration on series with python-flint (320 bits);
* `dop853`: scipy's DOP853 in double precision, which also integrates the variational equation;
* `gauss6`: the three-stage Gauss method in double precision, to know what a correct implementation can reach.
"""

import math
import re

import numpy as np
import sympy as sp
from flint import arb, arb_series, ctx
from scipy.integrate import solve_ivp

BITS = 320


def program(outputs, inputs):
    """Straight-line form of expressions: temporaries first (common subexpressions), then outputs."""
    temporaries, results = sp.cse(outputs, symbols=sp.numbered_symbols("tmp_"))
    return inputs, temporaries, results


def evaluate(code, values, number, calls):
    """Runs a program; `number` converts a rational, `calls` has the functions and `power`."""
    inputs, temporaries, results = code
    known = dict(zip(inputs, values))

    def walk(node):
        if node in known:
            return known[node]
        if node.is_Rational:
            return number(node)
        if node is sp.pi:
            return calls["pi"]
        if node.is_Add or node.is_Mul:
            total = walk(node.args[0])
            for argument in node.args[1:]:
                total = total + walk(argument) if node.is_Add else total * walk(argument)
            return total
        if node.is_Pow:
            return calls["power"](walk(node.base), node.exp)
        return calls[node.func.__name__](*(walk(argument) for argument in node.args))

    for symbol, expression in temporaries:
        known[symbol] = walk(expression)
    return [walk(expression) for expression in results]


# ------------------------------------------------------------------ power series

def _rational(q):
    return arb(int(q.p)) / int(q.q)


def _series_power(base, exponent):
    if exponent.is_Integer and 0 < exponent <= 16:
        result = base
        for _ in range(int(exponent) - 1):
            result = result * base
        return result
    if exponent.is_Integer and exponent < 0:
        return 1 / _series_power(base, -exponent)
    if exponent == sp.Rational(1, 2):
        return base.sqrt()
    if exponent == sp.Rational(-1, 2):
        return base.rsqrt()
    if (2 * exponent).is_Integer and exponent > 0:
        return _series_power(base, exponent - sp.Rational(1, 2)) * base.sqrt()
    if (2 * exponent).is_Integer:
        return 1 / _series_power(base, -exponent)
    return (base.log() * _rational(exponent)).exp()


def _sinh(x):
    e = x.exp()
    return (e - 1 / e) / 2


def _cosh(x):
    e = x.exp()
    return (e + 1 / e) / 2


def _tanh(x):
    e = (2 * x).exp()
    return (e - 1) / (e + 1)


SERIES = {
    "power": _series_power, "exp": lambda x: x.exp(), "log": lambda x: x.log(),
    "sin": lambda x: x.sin(), "cos": lambda x: x.cos(), "tan": lambda x: x.tan(),
    "asin": lambda x: x.asin(), "acos": lambda x: x.acos(), "atan": lambda x: x.atan(),
    "sinh": _sinh, "cosh": _cosh, "tanh": _tanh,
}


def _field_series(system, code, states):
    """mu'_j = C_ij^k (dH/dmu_i) mu_k on series."""
    gradient = evaluate(code, states, lambda q: arb_series([_rational(q)]), {**SERIES, "pi": arb_series([arb.pi()])})
    out = [arb_series([0]) for _ in states]
    for (i, j, k), value in system.constants.items():
        if system.gradient[i] != 0:
            out[j] = out[j] + gradient[i] * states[k] * _rational(value)
    return out


def taylor(system, times, order, digits):
    """States at the rational times (increasing), as balls; local errors below 10^-digits.

    Each step computes the Taylor polynomial of the given order by `order` Picard iterations, each of
    which makes one more coefficient exact, and takes the step at which the last two terms are small.
    """
    ctx.prec = BITS
    code = program(system.gradient, system.coordinates)
    point = []
    for value in system.initial:
        text = sp.N(value, 110)
        point.append(_rational(value) if value.is_Rational else arb(str(text)))
    now, out, tolerance = arb(0), [], 10.0 ** -digits
    for target in times:
        goal = _rational(sp.Rational(target))
        while True:
            left = goal - now
            if float(left.mid()) <= 1e-80:
                break
            series = [arb_series([p]) for p in point]
            for length in range(2, order + 2):
                ctx.cap = length
                field = _field_series(system, code, series)
                series = [arb_series([p]) + f.integral() for p, f in zip(point, field)]
            step = float("inf")
            for s in series:
                coefficients = s.coeffs()
                for k in (order - 1, order):
                    size = abs(float(coefficients[k].mid())) if len(coefficients) > k else 0.0
                    if size > 0:
                        step = min(step, (tolerance / size) ** (1 / k))
            step = min(arb(math.floor(step * 2**20)) / 2**20, left, key=lambda a: float(a.mid()))
            point = [_horner(s.coeffs(), step).mid() for s in series]
            now = (now + step).mid() if step is not left else goal
        out.append(list(point))
    return out


def _horner(coefficients, step):
    total = arb(0)
    for c in reversed(coefficients):
        total = total * step + c
    return total


def text(value, digits=30):
    """A decimal of so many significant digits."""
    if abs(float(value)) < 1e-40:
        return "0"
    return re.sub(r"e\+?", "e", value.mid().str(digits, radius=False))


# ------------------------------------------------------------------ double precision

class Doubles:
    """The field, its Jacobian, energy and Casimirs of a system in double precision."""

    def __init__(self, system):
        n = system.dimension
        self.constants = np.zeros((n, n, n))
        for (i, j, k), value in system.constants.items():
            self.constants[i, j, k] = float(value)
        x = system.coordinates
        hessian = [[sp.diff(g, v) for v in x] for g in system.gradient]
        compiled = lambda e: sp.lambdify([x], e, "numpy", cse=True)
        self.energy, self._gradient, self._hessian = compiled(system.hamiltonian), compiled(system.gradient), compiled(hessian)
        self.casimirs = compiled([c for _, c in system.casimirs])
        self.initial = np.array([float(v) for v in system.initial])
        self.n = n

    def field(self, mu):
        return np.einsum("ijk,i,k->j", self.constants, np.array(self._gradient(mu), dtype=float), mu)

    def jacobian(self, mu):
        gradient = np.array(self._gradient(mu), dtype=float)
        hessian = np.array(self._hessian(mu), dtype=float)
        pi = -np.einsum("abk,k->ab", self.constants, mu)
        return np.einsum("ijk,i->jk", self.constants, gradient) + pi @ hessian

    def dop853(self, times):
        """States at the times."""
        result = solve_ivp(lambda t, y: self.field(y), (0, times[-1]), self.initial, method="DOP853",
                           t_eval=times, rtol=3e-14, atol=1e-15)
        if not result.success:
            raise ArithmeticError(result.message)
        return result.y.T

    def amplification(self, end, samples=40):
        """Largest norm of the propagators D phi_{t,s}, 0 <= s <= t <= end, on a grid, and the largest |mu_i|."""
        n = self.n

        def both(t, y):
            return np.concatenate([self.field(y[:n]), (self.jacobian(y[:n]) @ y[n:].reshape(n, n)).ravel()])

        def escapes(t, y):
            # A solution that goes to infinity in finite time would keep the integrator busy for ever.
            return 1e4 - np.abs(y).max()

        escapes.terminal = True
        start = np.concatenate([self.initial, np.eye(n).ravel()])
        result = solve_ivp(both, (0, end), start, method="DOP853", t_eval=np.linspace(0, end, samples + 1),
                           rtol=1e-9, atol=1e-12, events=escapes)
        if result.status != 0 or not np.all(np.isfinite(result.y)):
            return math.inf, math.inf
        maps = [column[n:].reshape(n, n) for column in result.y.T]
        worst = 0.0
        for i, earlier in enumerate(maps):
            inverse = np.linalg.inv(earlier)
            worst = max([worst] + [np.abs(later @ inverse).sum(axis=1).max() for later in maps[i:]])
        return worst, np.abs(result.y[:n]).max()

    def gauss6(self, h, steps, mu=None):
        """States after every step of the three-stage Gauss method; Newton to stagnation."""
        r = math.sqrt(15.0)
        a = np.array([[5 / 36, 2 / 9 - r / 15, 5 / 36 - r / 30],
                      [5 / 36 + r / 24, 2 / 9, 5 / 36 - r / 24],
                      [5 / 36 + r / 30, 2 / 9 + r / 15, 5 / 36]])
        b = np.array([5 / 18, 4 / 9, 5 / 18])
        mu = self.initial if mu is None else mu
        n, out = self.n, []
        k = np.tile(self.field(mu), (3, 1))
        for _ in range(steps):
            previous = math.inf
            for _ in range(12):
                stages = mu + h * a @ k
                residual = k - np.array([self.field(y) for y in stages])
                matrix = np.eye(3 * n)
                for i in range(3):
                    df = self.jacobian(stages[i])
                    for j in range(3):
                        matrix[i * n:(i + 1) * n, j * n:(j + 1) * n] -= h * a[i, j] * df
                change = np.linalg.solve(matrix, residual.ravel()).reshape(3, n)
                k = k - change
                size = np.abs(change).max()
                if size <= 1e-16 * (1 + np.abs(k).max()) or (size < 1e-12 and size >= previous):
                    break
                previous = size
            else:
                raise ArithmeticError("gauss6: no convergence")
            mu = mu + h * b @ k
            out.append(mu)
        return np.array(out)
