"""The members of an ensemble: initial states and parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._arguments import Array

if TYPE_CHECKING:
    from ._declared import Declared


def members_of(system: Declared, x0: npt.ArrayLike) -> Array:
    """The initial states, with what carries the time or the group element where the user left it out."""
    starts = np.ascontiguousarray(np.atleast_2d(np.asarray(x0, dtype=np.float64)))
    n = system.dimension
    if starts.ndim == 2 and starts.shape[1] != len(system._core.coordinates):
        complete = system._core.complete(starts.tolist())
        if complete is not None:
            return np.asarray(complete, dtype=np.float64).reshape(len(starts), -1)
    elif starts.ndim == 2:
        return starts
    raise ValueError(f"x0 has the shape {np.shape(x0)}, not (members, {n})")


def table_of(system: Declared, parameters: Mapping[str, Any], members: int) -> Array:
    """The values of the parameters: a row for each member, or one for all."""
    lengths = {name: np.size(value) for name, value in parameters.items()}
    if any(length not in (1, members) for length in lengths.values()):
        raise ValueError(f"parameters have lengths {lengths}, x0 has {members} members")
    varied = any(length > 1 for length in lengths.values())
    count = members if varied else 1
    scalars = system._values({name: np.ravel(value)[0] for name, value in parameters.items()})
    table = np.tile(np.asarray(scalars, dtype=np.float64), (count, 1))
    for name, value in parameters.items():
        if np.size(value) > 1:
            table[:, list(system.parameters).index(name)] = np.ravel(value)
    return table
