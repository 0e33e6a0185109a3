"""Families: states and names of many sites."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Array, floats

if TYPE_CHECKING:
    from ._declared import Declared


class Sites:
    """The sites of a family at values of its parameters: ``shape`` is (N,), of a lattice (N, M) or (L, N, M)."""

    def __init__(self, system: Declared, values: list[float]) -> None:
        sizes = system._core.sites(values) or (1,)
        self.shape = tuple(sizes)[-system._core.axes :]
        self.each = len(system._core.coordinates)
        self.dimension = self.each * math.prod(sizes)

    def state(self, x0: Any) -> Array:
        """A state, from numbers in its order or from an array with a row of coordinates for each site."""
        given = floats(x0, "x0")
        if given.shape == (self.dimension,):
            return given
        if given.shape == (*self.shape, self.each):
            return np.ascontiguousarray(np.moveaxis(given, -1, 0)).reshape(-1)
        raise ValueError(
            f"x0 has the shape {given.shape}: give ({self.dimension},), all first coordinates before all second ones, "
            f"or {(*self.shape, self.each)}, the coordinates of each site"
        )

    def of(self, mu: Array) -> Array:
        """States, shape (…, n), by sites: (…, N, coordinates), of a lattice (…, N, M, coordinates) or (…, L, N, M, coordinates)."""
        by_coordinate = mu.reshape(*mu.shape[:-1], self.each, *self.shape)
        return np.moveaxis(by_coordinate, mu.ndim - 1, -1)
