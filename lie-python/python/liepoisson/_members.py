"""The members of an ensemble: initial states and parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._arguments import Array, Number, floats, whole
from ._arguments import number as number_of
from ._sites import Sites

if TYPE_CHECKING:
    from ._declared import Declared


def members_of(system: Declared, x0: Any, parameters: Mapping[str, Any]) -> Array:
    """The initial states, with what carries the time or the group element where the user left it out."""
    if x0 is None:
        raise TypeError("the initial states are missing: one in each row of x0, or a single one")
    if any(np.size(value) == 0 for value in parameters.values()):
        raise ValueError("a parameter is an empty array: there are no members")
    if system._core.family:
        return _each(members_of_family(system, x0, parameters), parameters)
    return _each(_members_of_one(system, x0, parameters), parameters)


def _each(starts: Array, parameters: Mapping[str, Any]) -> Array:
    """A single initial state for each member that the parameters make."""
    members = max((np.size(value) for value in parameters.values()), default=1)
    return np.repeat(starts, members, axis=0) if len(starts) == 1 else starts


def _members_of_one(
    system: Declared, x0: npt.ArrayLike, parameters: Mapping[str, Any]
) -> Array:
    starts = np.ascontiguousarray(np.atleast_2d(floats(x0, "x0")))
    n = system.dimension
    if starts.ndim == 2 and starts.shape[1] != len(system._core.coordinates):
        # the group element at the start may depend on parameters
        starts = _each(starts, parameters)
        values = table_of(system, parameters, len(starts))
        complete = system._core.complete(starts.tolist(), values.tolist())
        if complete is not None:
            return np.asarray(complete, dtype=np.float64).reshape(len(starts), -1)
    elif starts.ndim == 2:
        return starts
    raise ValueError(f"x0 has the shape {np.shape(x0)}, not (members, {n})")


def members_of_family(system: Declared, x0: npt.ArrayLike, parameters: Mapping[str, Any]) -> Array:
    """The same of a family: members have as many sites each."""
    sites = []
    for number in range(max((np.size(value) for value in parameters.values()), default=1)):
        chosen = {
            name: np.ravel(value)[min(number, np.size(value) - 1)]
            for name, value in parameters.items()
        }
        sites.append(Sites(system, system._values(chosen)))
        if sites[-1].shape != sites[0].shape:
            raise ValueError("all members of an ensemble have as many sites: run them one by one")
    given = floats(x0, "x0")
    one = given.shape in ((sites[0].dimension,), (*sites[0].shape, sites[0].each))
    states = [sites[0].state(member) for member in np.atleast_1d(given[None] if one else given)]
    given = np.reshape(states, (len(states), sites[0].dimension))
    # what is carried beside the sites where something acts on them
    values = table_of(system, parameters, len(given)) if len(given) > 1 else first_of(system, parameters)
    complete = system._core.complete(given.tolist(), values.tolist())
    return given if complete is None else np.asarray(complete, dtype=np.float64)


def first_of(system: Declared, parameters: Mapping[str, Any]) -> Array:
    """The values of the parameters of the first member."""
    first = {name: np.ravel(value)[0] for name, value in parameters.items()}
    return np.asarray([system._values(first)], dtype=np.float64)


def table_of(system: Declared, parameters: Mapping[str, Any], members: int) -> Array:
    """The values of the parameters: a row for each member, or one for all."""
    lengths = {name: np.size(value) for name, value in parameters.items()}
    if any(length not in (1, members) for length in lengths.values()):
        raise ValueError(
            f"parameters have lengths {lengths}, x0 has {members} members: give as many values as rows, or one of either"
        )
    varied = any(length > 1 for length in lengths.values())
    count = members if varied else 1
    scalars = system._values({name: np.ravel(value)[0] for name, value in parameters.items()})
    table = np.tile(np.asarray(scalars, dtype=np.float64), (count, 1))
    for name, value in parameters.items():
        if np.size(value) > 1:
            column = floats(value, f"the parameter {name}")
            table[:, list(system.parameters).index(name)] = np.ravel(column)
    return table


def drawn(
    system: Declared,
    x0: Any,
    parameters: Mapping[str, Any],
    asked: tuple[int, int | None, Number | None],
) -> tuple[Array, Array]:
    """So many initial states drawn around one, by a seed and how far they go; and the values of the parameters."""
    members, seed, spread = asked
    count = whole(members, "members", 1)
    lengths = {name: np.size(value) for name, value in parameters.items()}
    if any(length not in (1, count) for length in lengths.values()):
        raise ValueError(
            f"parameters have lengths {lengths}, and there are {count} members: give one value, or one for each of them"
        )
    table = table_of(system, parameters, count)
    if x0 is None:
        x0 = system._core.initial(list(table[0]))
        if x0 is None:
            raise TypeError(
                "x0 is missing: the state around which members are drawn, which the declaration does not give"
            )
    first = {name: np.ravel(value)[0] for name, value in parameters.items()}
    family = system._core.family
    around = members_of_family(system, x0, first) if family else _members_of_one(system, x0, first)
    if len(around) != 1:
        raise ValueError(f"members are drawn around one state, and x0 has {len(around)}")
    if isinstance(spread, str) and spread.strip() == "orbit":
        far = None
    else:
        far = 0.1 if spread is None else number_of(spread, "spread")
        if not 0 <= far < np.inf:
            raise ValueError(f'spread is a standard deviation, or "orbit", not {spread!r}')
    which = 1 if seed is None else whole(seed, "seed", 0)
    return system._core.drawn(table, around[0].tolist(), (count, which, far)), table
