"""Case D: the initial state and the reference of a chain of spins with H = -sum s_i . s_(i+1), periodic."""

import math

import numpy as np


def splitmix(seed):
    """Uniform numbers from 0 to 1: G. L. Steele, D. Lea, C. H. Flood (2014), doi:10.1145/2660193.2660195."""
    mask = 2 ** 64 - 1
    while True:
        seed = (seed + 0x9E3779B97F4A7C15) & mask
        value = seed
        value = ((value ^ (value >> 30)) * 0xBF58476D1CE4E5B9) & mask
        value = ((value ^ (value >> 27)) * 0x94D049BB133111EB) & mask
        yield ((value ^ (value >> 31)) >> 11) * 2.0 ** -53


def initial(count, seed):
    """Spins that are uniform on the sphere, one a row."""
    numbers = splitmix(seed)
    spins = np.empty((count, 3))
    for spin in spins:
        z, angle = 2 * next(numbers) - 1, 2 * math.pi * next(numbers)
        radius = math.sqrt(max(0.0, 1 - z * z))
        spin[:] = radius * math.cos(angle), radius * math.sin(angle), z
    return spins / np.linalg.norm(spins, axis=1)[:, None]


def taylor(start, until, steps, order):
    """The state at the end by Taylor series of a fixed order, in long double."""
    state, step = start.astype(np.longdouble), np.longdouble(until) / steps
    for _ in range(steps):
        series, fields = [state], []
        for k in range(order):
            fields.append(np.roll(series[k], 1, 0) + np.roll(series[k], -1, 0))
            total = sum(np.cross(fields[j], series[k - j]) for j in range(k + 1))
            series.append(total / (k + 1))
        state = series[order]
        for coefficient in series[-2::-1]:
            state = state * step + coefficient
    return state


def reference(start, until):
    """The state at the end, and how far another step and order are from it."""
    one, other = taylor(start, until, 100, 22), taylor(start, until, 80, 24)
    return one.astype(float), float(np.abs(one - other).max())
