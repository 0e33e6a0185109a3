"""How many members are where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._arguments import Array, Number, floats, whole
from ._functions import Function

if TYPE_CHECKING:
    from ._system import System

_Whole = npt.NDArray[np.intp]

#: Bands of a sphere, sectors for each of them, and bins of a coordinate.
_BANDS, _SECTORS, _COUNT = 16, 3, 50
#: So many points tell whether leaves are spheres.
_POINTS = 8


class Histogram(NamedTuple):
    """How many members are where; states that are not numbers are left out.

    ``counts``: where orbits are spheres around zero the members by their direction, shape (bands, sectors); else by the value of each coordinate,
    shape (n, bins); with rows these are the first axis. ``edges``: on spheres those of the height z/|mu|, which bands divide into equal parts,
    and of the azimuth of (x, y) in radians, so that all bins have the same area; else those of each coordinate, shape (n, bins + 1), from its least
    to its largest value. A bin has its lower edge, the last one both.
    """

    counts: Array
    edges: tuple[Array, Array] | Array


def histogram(
    system: System, states: npt.ArrayLike, bins: int | None, values: Mapping[str, Number]
) -> Histogram:
    mu = floats(states, "states")
    n = system.dimension
    if mu.ndim not in (2, 3) or mu.shape[-1] != n:
        raise ValueError(
            f"states have the shape {mu.shape}, not (members, {n}) or (members, rows, {n})"
        )
    count = None if bins is None else whole(bins, "bins", 1)
    rows = mu[:, None] if mu.ndim == 2 else mu
    if n == 3 and _has_spheres(system, values):
        bands = _BANDS if count is None else count
        shape: tuple[int, ...] = (bands, _SECTORS * bands)
        edges: Any = (np.linspace(-1, 1, shape[0] + 1), np.linspace(-np.pi, np.pi, shape[1] + 1))
        counts = [_on_sphere(_numbers(rows[:, k]), shape) for k in range(rows.shape[1])]
    else:
        shape = (n, _COUNT if count is None else count)
        low, high = np.transpose([_range(column) for column in _numbers(rows.reshape(-1, n)).T])
        edges = np.linspace(low, high, shape[1] + 1, axis=1)
        counts = [
            _by_coordinate(_numbers(rows[:, k]), low, high, shape) for k in range(rows.shape[1])
        ]
    found = np.array(counts, dtype=np.float64).reshape(rows.shape[1], *shape)
    return Histogram(found[0] if mu.ndim == 2 else found, edges)


def _has_spheres(system: System, values: Mapping[str, Number]) -> bool:
    """Whether ``Pi(x) x = 0``, and Pi is not."""
    k = np.arange(1.0, _POINTS + 1)
    points = np.stack([1 / k, 0.5 * k - 2.2, 0.3 + 0.1 * k * k], axis=1)
    parts = np.asarray(Function(system, "poisson_matrix", system._values(values))(points))
    parts = parts * points[:, None, :]
    sizes = np.abs(parts).sum(axis=2)
    return bool(np.all(np.abs(parts.sum(axis=2)) <= 1e-12 * sizes) and np.any(sizes > 0))


def _numbers(states: Array) -> Array:
    return states[np.isfinite(states).all(axis=1)]


def _range(column: Array) -> tuple[float, float]:
    if len(column) == 0:
        return 0.0, 1.0
    low, high = float(column.min()), float(column.max())
    return (low, high) if low < high else (low - 0.5, high + 0.5)


def _bins(x: Array, low: Any, high: Any, count: int) -> _Whole:
    found: _Whole = np.minimum(((x - low) / (high - low) * count).astype(np.intp), count - 1)
    return found


def _on_sphere(states: Array, shape: tuple[int, ...]) -> _Whole:
    x, y, z = states.T
    norm = np.sqrt(x * x + y * y + z * z)
    there = norm > 0
    x, y, height = x[there], y[there], z[there] / norm[there]
    band = _bins(height, -1.0, 1.0, shape[0])
    sector = _bins(np.arctan2(y, x), -np.pi, np.pi, shape[1])
    return np.bincount(band * shape[1] + sector, minlength=shape[0] * shape[1])


def _by_coordinate(states: Array, low: Array, high: Array, shape: tuple[int, ...]) -> _Whole:
    columns = _bins(states, low, high, shape[1]).T
    return np.array([np.bincount(column, minlength=shape[1]) for column in columns])
