"""Functions of the state, over arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._arguments import Array, hint

if TYPE_CHECKING:
    from ._declared import Declared

FUNCTIONS = (
    "vector_field",
    "jacobian",
    "hamiltonian",
    "gradient",
    "hessian",
    "poisson_matrix",
    "casimirs",
)


def function_of(system: Declared, name: str, values: list[float]) -> Callable[..., Array]:
    """A function of the state and, where the Hamiltonian depends on it, of the time."""
    if name not in FUNCTIONS:
        raise ValueError(
            f"no function `{name}`{hint(name, FUNCTIONS)} There are: {', '.join(FUNCTIONS)}"
        )
    core, n, count = system._core, system._dimension(values), len(system.casimirs)
    shown, time = core.shown(), core.time()
    # what the user does not give: the constants of a state of the larger space
    template = None if time is None else (core.complete([[0.0] * n]) or [[]])[0]
    shapes: dict[str, tuple[int, ...]] = {
        "hamiltonian": (),
        "vector_field": (n,),
        "gradient": (n,),
        "casimirs": (count,),
    }

    def evaluate(mu: npt.ArrayLike, t: npt.ArrayLike = 0.0) -> Array:
        states = np.asarray(mu, dtype=np.float64)
        if states.shape[-1:] != (n,):
            raise ValueError(f"the last axis of the state has {states.shape[-1:]} entries, not {n}")
        leading = states.shape[:-1]
        flat = np.ascontiguousarray(states.reshape(-1, n))
        if template is not None and time is not None:
            whole = np.tile(np.asarray(template, dtype=np.float64), (len(flat), 1))
            whole[:, shown] = flat
            try:
                times = np.broadcast_to(np.asarray(t, dtype=np.float64), leading)
            except ValueError:
                raise ValueError(
                    f"t has the shape {np.shape(t)}, the states have the leading axes {leading}: give one time, "
                    "or one for each state"
                ) from None
            whole[:, time] = times.reshape(-1)
            flat = whole
        found = core.evaluate(name, values, flat)
        result: Array = found.reshape(leading + shapes.get(name, (n, n)))
        return result

    evaluate.__name__ = name
    return evaluate
