"""The motion of a drawn system, from its structure constants and its own gradient: no part of it knows lie-poisson."""

import math

import mpmath
import numpy as np
from scipy.integrate import solve_ivp


class Floats:
    """Numbers of the machine."""

    @staticmethod
    def number(value):
        return float(value)

    @staticmethod
    def function(name, x):
        return derivative(math, name, x)


class Digits:
    """Numbers of mpmath, with the digits of its context."""

    @staticmethod
    def number(value):
        return mpmath.mpf(value.numerator) / value.denominator

    @staticmethod
    def function(name, x):
        return derivative(mpmath, name, x)


def derivative(library, name, x):
    match name:
        case "sin":
            return library.sin(x), library.cos(x)
        case "cos":
            return library.cos(x), -library.sin(x)
        case "exp":
            value = library.exp(x)
            return value, value
        case "sqrt":
            value = library.sqrt(x)
            return value, 1 / (2 * value)
        case "log":
            return library.log(x), 1 / x
        case "tanh":
            value = library.tanh(x)
            return value, 1 - value * value
        case "atan":
            return library.atan(x), 1 / (1 + x * x)
    raise ValueError(name)


def field(system, calculus):
    """mu'_j = sum_ik C_ij^k (dH/dmu_i) mu_k, with the other sign for right-invariant systems."""
    state = system.spec["state"]
    n = len(state)
    entries = [
        (i, j, k, calculus.number(system.sign * c))
        for i, rows in enumerate(system.constants)
        for j, row in enumerate(rows)
        for k, c in enumerate(row)
        if c
    ]
    fixed = {name: (calculus.number(value), {}) for name, value in system.parameters.items()}

    def at(t, mu):
        values = fixed | {"t": (t, {})} | {name: (mu[k], {k: 1}) for k, name in enumerate(state)}
        _, slopes = system.hamiltonian.jet(values, calculus)
        out = [calculus.number(0 * system.initial[0])] * n
        for i, j, k, c in entries:
            if i in slopes:
                out[j] = out[j] + c * slopes[i] * mu[k]
        return out

    return at


def end(system, until):
    """The state at a time, by DOP853 at the least tolerances it takes."""
    start = [float(x) for x in system.initial]
    solution = solve_ivp(field(system, Floats), (0, until), start, method="DOP853", rtol=1e-13, atol=1e-15)
    return solution.y[:, -1] if solution.success else None


def end_in_digits(system, until, digits=30, steps=16):
    """The same by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer), with so many digits."""
    with mpmath.workdps(digits):
        at = field(system, Digits)
        mu = [Digits.number(x) for x in system.initial]
        width = mpmath.mpf(until) / steps
        for step in range(steps):
            mu = extrapolated(at, step * width, mu, width)
        return np.array([float(x) for x in mu])


def extrapolated(at, t, mu, width, columns=9):
    rows = []
    for row in range(columns):
        count = 2 * (row + 1)
        new = [modified_midpoint(at, t, mu, width, count)]
        for column in range(1, row + 1):
            ratio = mpmath.mpf(row + 1) / (row + 1 - column)
            factor = 1 / (ratio * ratio - 1)
            new.append([a + factor * (a - b) for a, b in zip(new[-1], rows[-1][column - 1])])
        rows.append(new)
    return rows[-1][-1]


def modified_midpoint(at, t, mu, width, count):
    h = width / count
    before, here = mu, [y + h * f for y, f in zip(mu, at(t, mu))]
    for k in range(1, count):
        slope = at(t + k * h, here)
        before, here = here, [y + 2 * h * f for y, f in zip(before, slope)]
    slope = at(t + width, here)
    return [(a + b + h * f) / 2 for a, b, f in zip(before, here, slope)]
