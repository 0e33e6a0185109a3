"""Functions of the state, over arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._arguments import Array, floats, hint

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


#: What they are called elsewhere.
ELSEWHERE = {
    "f": "vector_field",
    "fun": "vector_field",
    "rhs": "vector_field",
    "field": "vector_field",
    "jac": "jacobian",
    "h": "hamiltonian",
    "energy": "hamiltonian",
    "grad": "gradient",
    "hess": "hessian",
    "invariants": "casimirs",
}


class Function:
    """A function of the state and, where the Hamiltonian depends on it, of the time: ``f(y)``, ``f(y, t)``.

    It can be pickled, with its system.
    """

    def __init__(self, system: Declared, name: str, values: list[float]) -> None:
        if name not in FUNCTIONS:
            meant = ELSEWHERE.get(str(name).casefold())
            near = f"; did you mean `{meant}`?" if meant else hint(str(name), FUNCTIONS) or "."
            raise ValueError(f"no function `{name}`{near} There are: {', '.join(FUNCTIONS)}")
        core, n = system._core, system._dimension(values)
        self.__name__ = name
        self._made = (system, name, values)
        self._n = n
        self._shape = {
            "hamiltonian": (),
            "vector_field": (n,),
            "gradient": (n,),
            "casimirs": (len(system.casimirs),),
        }.get(name, (n, n))
        self._shown, self._time = core.shown(), core.time()
        # what the user does not give: the constants of a state of the larger space
        whole = [] if self._time is None else (core.complete([[0.0] * n], [values]) or [[]])[0]
        self._template = np.asarray(whole, dtype=np.float64)

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), self._made

    def __repr__(self) -> str:
        return f"<{self.__name__} of {self._made[0].name}>"

    def __call__(self, mu: npt.ArrayLike, t: npt.ArrayLike = 0.0) -> Array:
        states, n = floats(mu, "the state"), self._n
        if states.shape[-1:] != (n,):
            order = "; it comes before the time" if states.ndim == 0 else ""
            raise ValueError(
                f"the state has the shape {states.shape}, and its last axis must have {n} entries, not "
                f"{states.shape[-1] if states.ndim else 'none'}{order}"
            )
        leading = states.shape[:-1]
        flat = np.ascontiguousarray(states.reshape(-1, n))
        if self._time is not None:
            flat = self._with_time(flat, floats(t, "t"), leading)
        system, name, values = self._made
        found = system._core.evaluate(name, values, flat)
        result: Array = found.reshape(leading + self._shape)
        return result

    def _with_time(self, flat: Array, t: Array, leading: tuple[int, ...]) -> Array:
        """The states in the larger space, in which the time is a coordinate."""
        whole = np.tile(self._template, (len(flat), 1))
        whole[:, self._shown] = flat
        try:
            times = np.broadcast_to(t, leading)
        except ValueError:
            raise ValueError(
                f"t has the shape {t.shape}, the states have the leading axes {leading}: give one time, "
                "or one for each state"
            ) from None
        whole[:, self._time] = times.reshape(-1)
        return whole
