"""Structure-preserving integrators for Lie–Poisson systems.

A system is declared by an algebra, a state and a Hamiltonian; the compiler checks the algebra exactly, derives everything
else and makes machine code of it.

>>> import liepoisson as lp
>>> body = lp.System(algebra="so(3)", state=["x", "y", "z"], parameters={"I1": 2, "I2": 1, "I3": "2/3"},
...                  hamiltonian="x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)")
>>> run = body.run("lie-midpoint", h=0.1, t=10, x0=[0.8, 0.1, 0.6])
>>> run.mu.shape
(101, 3)
>>> bool(abs(run.casimirs["C1"] - run.casimirs["C1"][0]).max() < 1e-14)
True
"""

from __future__ import annotations

import difflib
import json
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import DeclarationError, IntegrationError, MethodError
from ._verification import Fact, Verification

__all__ = [
    "DeclarationError",
    "Ensemble",
    "Fact",
    "IntegrationError",
    "MethodError",
    "Solution",
    "System",
    "Verification",
    "load",
]
__version__ = "0.1.0"

Array = npt.NDArray[np.float64]
Number = Union[float, int, str]

#: What people write from habit, and what it is called here.
_SLIPS = {
    "dt": "h",
    "step": "h",
    "stepsize": "h",
    "max_step": "h",
    "y0": "x0",
    "mu0": "x0",
    "initial": "x0",
    "u0": "x0",
    "t_end": "t",
    "until": "t",
    "tmax": "t",
    "t_span": "t",
    "t_eval": "at",
    "tolerance": "tol",
    "T": "t",
    "tf": "t",
    "tspan": "t",
    "times": "at",
    "initial_state": "x0",
}
#: What chooses a variant of a method.
_VARIANTS = ("retraction", "lift", "gradient", "composition", "pieces", "tensor")
#: Options of the solver of implicit methods.
_SOLVER = ("iteration", "newton_tolerance", "max_iterations", "converge")
_FUNCTIONS = (
    "vector_field",
    "jacobian",
    "hamiltonian",
    "gradient",
    "hessian",
    "poisson_matrix",
    "casimirs",
)
#: The step where neither the call nor the declaration gives one.
_STEP = 0.01
#: The time until which a system runs where neither says it.
_UNTIL = 10.0


def _hint(name: str, known: Sequence[str]) -> str:
    close = difflib.get_close_matches(name, known, n=1)
    return f"; did you mean `{close[0]}`?" if close else ""


def _number(value: Number, what: str) -> float:
    """A number, or an exact constant as text."""
    if isinstance(value, str):
        return _core.constant(value)
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a number or text such as '1/7', not {value!r}") from None


def _given(value: float | None, name: str, options: Mapping[str, list[str]]) -> float | None:
    """What the call says, else what the declaration says."""
    if value is None and name in options:
        return _core.constant(options[name][0])
    return None if value is None else float(value)


def _times(
    t: Number | None, at: Any, every: int | None, options: Mapping[str, list[str]]
) -> tuple[float, int, list[float] | None]:
    """The end, each so-manyth step that is saved, and the times that are saved in its place."""
    if at is not None and (t is not None or every is not None):
        raise TypeError("with `at` there is a row for each of its times: leave out t and every")
    if every is not None and every < 1:
        raise ValueError(f"every must be 1, 2, 3, …, not {every}")
    if at is None and t is None and every is None:
        at = options.get("at")
    if at is not None:
        times = [_number(time, "a time of at") for time in np.atleast_1d(at).tolist()]
        if not times:
            raise ValueError("`at` is empty: give it times, such as at=[0, 1, 2]")
        times.sort(key=abs)
        return times[-1], 1, times
    until = options.get("until", [str(_UNTIL)])
    end = _core.constant(until[0]) if t is None else _number(t, "t")
    count = every if every is not None else int(options.get("every", ["1"])[0])
    return end, count, None


def _declared(name: str, value: object, options: Mapping[str, list[str]]) -> object:
    """An option of the solver: what the call says, else what the declaration says."""
    key = name.replace("_", "-")
    if value is not None or key not in options:
        return value
    text = options[key][0]
    if name == "newton_tolerance":
        return _core.constant(text)
    return int(_core.constant(text)) if name == "max_iterations" else text


def _merged(parameters: Mapping[str, Any] | None, named: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by name, and those in a dictionary."""
    if parameters is not None and not isinstance(parameters, Mapping):
        raise TypeError(f'parameters are a dictionary such as {{"k": 2}}, not {parameters!r}')
    both = [name for name in named if name in (parameters or {})]
    if both:
        raise TypeError(f"the parameter `{both[0]}` is given twice")
    return {**(parameters or {}), **named}


class Solution:
    """What a run has saved, as numpy arrays.

    ``t``: the times, shape (m,). ``mu``: the states, shape (m, n). ``energy``: H at each row, shape (m,).
    ``casimirs``: a dictionary of arrays of shape (m,). ``run["Pi1"]``, ``run["energy"]`` and ``run["C1"]`` are columns.
    ``method``, ``step``, ``steps``: what was done.
    """

    def __init__(
        self,
        name: str,
        coordinates: Sequence[str],
        t: Array,
        mu: Array,
        energy: Array,
        casimirs: Mapping[str, Array],
        method: str,
        step: float,
        steps: int,
    ) -> None:
        self.name = name
        self.coordinates = list(coordinates)
        self.t = t
        self.mu = mu
        self.energy = energy
        self.casimirs = dict(casimirs)
        self.method = method
        self.step = step
        self.steps = steps
        #: The group element at each row, shape (m, s, s) or (m, 4), where it was asked for.
        self.group: Array | None = None

    def __getitem__(self, name: str) -> Array:
        if name in self.coordinates:
            column: Array = self.mu[:, self.coordinates.index(name)]
            return column
        if name == "t":
            return self.t
        if name == "energy":
            return self.energy
        if name in self.casimirs:
            return self.casimirs[name]
        known = ["t", *self.coordinates, "energy", *self.casimirs]
        raise KeyError(f"no column {name!r}{_hint(str(name), known)} There are: {', '.join(known)}")

    def __len__(self) -> int:
        return len(self.t)

    def _reference(self, values: Array) -> float | None:
        """What a change is divided by: the first value; nothing where that is only round-off beside the state."""
        if not len(values):
            return None
        scale = float(np.max(np.abs(self.mu))) if self.mu.size else 0.0
        first = abs(float(values[0]))
        return first if first > 1e-12 * min(scale, scale * scale) else None

    @property
    def drift(self) -> dict[str, float]:
        """The largest change of energy and Casimirs over the rows, relative to their first values.

        Where the first value is 0, or only round-off beside the state, the change itself.
        """
        found = {}
        for name, values in [("energy", self.energy), *self.casimirs.items()]:
            change = float(np.max(np.abs(values - values[0]))) if len(values) else 0.0
            found[name] = change / (self._reference(values) or 1.0)
        return found

    def __repr__(self) -> str:
        absolute = {
            name: " (absolute)" if self._reference(values) is None else ""
            for name, values in [("energy", self.energy), *self.casimirs.items()]
        }
        drift = ", ".join(
            f"{name} {value:.1e}{absolute[name]}" for name, value in self.drift.items()
        )
        end = f"t = {self.t[-1]:g}" if len(self.t) else "nothing"
        return (
            f"<{self.name}, {self.method}, step {self.step:g}: {len(self.t)} rows to {end}; "
            f"largest relative error: {drift}>"
        )

    def plot(self, *, show: bool = False) -> Any:
        """Draws the components and the errors of the invariants with matplotlib; returns the figure."""
        try:
            import matplotlib.pyplot as plt
        except ImportError:
            raise ImportError(
                "plot() needs matplotlib: pip install matplotlib (or pip install 'liepoisson[plot]')"
            ) from None
        figure, (above, below) = plt.subplots(
            2, 1, sharex=True, figsize=(8, 6), height_ratios=[2, 1], layout="constrained"
        )
        for name in self.coordinates:
            above.plot(self.t, self[name], label=name, linewidth=1)
        above.set_title(f"{self.name}, {self.method}, step {self.step:g}")
        above.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
        for name, values in [("energy", self.energy), *self.casimirs.items()]:
            scale = self._reference(values) or 1.0
            errors = np.maximum(np.abs(values - values[0]) / scale, 1e-17)
            below.semilogy(self.t, errors, label=name, linewidth=1)
        below.set_ylabel("relative error")
        below.set_xlabel("t")
        below.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
        if show:
            plt.show()
        return figure


class Ensemble:
    """The ends of many trajectories.

    ``mu``: the final states, shape (m, n); rows of failed members are not numbers. ``failures``: (member, time, reason).
    """

    def __init__(self, mu: Array, failures: list[tuple[int, float, str]]) -> None:
        self.mu = mu
        self.failures = failures

    def __repr__(self) -> str:
        return f"<{len(self.mu)} members, {len(self.failures)} failed>"


class System:
    """A Lie–Poisson system, by the text of a spec, a dictionary, or the keys of a spec as keywords.

    >>> top = System(name="Top", algebra="se(3)", state=["m1", "m2", "m3", "g1", "g2", "g3"],
    ...              hamiltonian="m1^2/2 + m2^2/2 + m3^2 + g3", initial=[0.1, 0.2, 0.9, 0, 0.6, 0.8])
    >>> top.casimirs
    ['C1', 'C2']

    Errors: :class:`DeclarationError` lists every mistake with its place and remedy.
    """

    def __init__(self, spec: str | Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        if isinstance(spec, (str, os.PathLike)):
            if keys:
                raise TypeError("give the text of a spec or its keys, not both")
            if not isinstance(spec, str) or (spec.endswith(".json") and "{" not in spec):
                raise TypeError(f"this is the name of a file: liepoisson.load({os.fspath(spec)!r})")
            text = spec
        else:
            declaration = {"format": 1, "name": "System", **dict(spec or {}), **keys}
            algebra = declaration.get("algebra")
            if algebra is None and "poisson" not in declaration:
                raise DeclarationError(
                    'schema: the algebra is missing\n  help: algebra="so(3)", or '
                    'algebra={"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", …]}',
                    "schema",
                )
            text = json.dumps(declaration, indent=2, ensure_ascii=False, default=_plain)
        self._core = _core.Core(text)

    # a system is its text: other processes compile it again
    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self._core.text,)

    @property
    def name(self) -> str:
        """The name of the system."""
        return self._core.name

    @property
    def text(self) -> str:
        """The declaration as JSON."""
        return self._core.text

    @property
    def dimension(self) -> int:
        """The number of coordinates."""
        return len(self._core.coordinates)

    @property
    def coordinates(self) -> list[str]:
        """The names of the coordinates."""
        return self._core.coordinates

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters with their defaults."""
        values = self._core.parameters
        return {name: values[name] for name in self._core.parameter_names()}

    @property
    def casimirs(self) -> list[str]:
        """The names of the Casimirs, declared and found."""
        return self._core.casimirs

    @property
    def initial(self) -> Array | None:
        """The declared initial state at the default parameters."""
        return self._core.initial(list(self.parameters.values()))

    def __repr__(self) -> str:
        return f"<System {self.name}: {', '.join(self.coordinates)}>"

    def _repr_markdown_(self) -> str:
        return f"**{self.name}**\n\n$$\n{self.latex()}\n$$"

    def _values(self, given: Mapping[str, Any]) -> list[float]:
        values = self.parameters
        for name, value in given.items():
            if name not in values:
                if name in ("params", "args"):
                    example = next(iter(values), "k")
                    raise TypeError(f"parameters are given by their names: {example}=…")
                if name in _VARIANTS:
                    raise TypeError(
                        f'`{name}` stands with the method: run("METHOD --{name} {value}")'
                    )
                if name in _SLIPS:
                    raise TypeError(f"no argument `{name}`; here it is `{_SLIPS[name]}`")
                known = ", ".join(values) or "none"
                raise TypeError(
                    f"{self.name} has no parameter `{name}`{_hint(name, list(values))} (parameters: {known})"
                )
            values[name] = _number(value, f"the parameter {name}")
        return list(values.values())

    def _start(self, x0: Any, values: list[float]) -> list[float]:
        if x0 is None:
            found = self._core.initial(values)
            if found is None:
                raise ValueError(
                    f"the initial state is missing: give x0=[…] with {self.dimension} numbers "
                    f"({', '.join(self.coordinates)})"
                )
            return [float(value) for value in found]
        if isinstance(x0, Mapping):
            names = self._core.shown()
            if any(name not in names for name in x0):
                names = self.coordinates
            unknown = [name for name in x0 if name not in names]
            if unknown:
                raise ValueError(f"no coordinate `{unknown[0]}`{_hint(unknown[0], names)}")
            missing = [name for name in names if name not in x0]
            if missing:
                raise ValueError(f"x0 lacks {', '.join(missing)}")
            x0 = [x0[name] for name in names]
        start = [_number(value, "an entry of x0") for value in np.atleast_1d(x0).tolist()]
        complete = self._core.complete(start)
        if complete is None:
            names = self._core.shown()
            raise ValueError(
                f"x0 has {len(start)} numbers, {self.name} has {len(names)} coordinates: "
                f"{', '.join(names)}"
            )
        for name, value in zip(self.coordinates, complete):
            if not np.isfinite(value):
                raise ValueError(f"x0: {name} is {value}, and must be finite")
        return complete

    def _method(self, method: str | None, options: Mapping[str, list[str]], tol: Any) -> str:
        if method is None:
            if tol is not None and "method" not in options:
                return "gauss16"
            method = options["method"][0] if "method" in options else self._core.usual_method()
            for name in _VARIANTS:
                if name in options:
                    method += f" --{name} {options[name][0]}"
        if not isinstance(method, str):
            raise TypeError(f"the method is its id as text, such as 'lie-midpoint', not {method!r}")
        return method

    def run(
        self,
        method: str | None = None,
        *,
        h: Number | None = None,
        tol: float | None = None,
        t: Number | None = None,
        x0: Any = None,
        every: int | None = None,
        at: Sequence[float] | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        iteration: str | None = None,
        newton_tolerance: float | None = None,
        max_iterations: int | None = None,
        converge: str | None = None,
        group: str | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Solution:
        """Integrates from time 0 until ``t``.

        ``h`` is the step; ``tol``, in its place, the relative error wanted at the end. ``x0`` is the initial state, a
        sequence or a dictionary; ``every`` saves each so-manyth step, ``at`` saves these times alone. Parameters are given by
        name, or in ``parameters`` where a name is also an argument (``parameters={"h": 2}``). What is left out comes from the
        declaration. ``rtol`` and ``atol`` are those of dopri5. ``iteration`` ("automatic", "newton", "simplified",
        "fixed-point"), ``newton_tolerance`` (in units of round-off), ``max_iterations`` and ``converge`` ("state", "map",
        "tolerance") are for the solver of implicit methods. ``group="matrix"`` or ``"quaternion"`` follows the group element
        from the identity on (``run.group``).

        Warnings: :class:`UserWarning` where the error at the end may be much larger than ``tol``.

        Errors: :class:`MethodError` for a method that does not apply, :class:`IntegrationError` with ``partial`` for a
        run that stopped early, :class:`ValueError` and :class:`TypeError` for arguments.
        """
        values = self._values(_merged(parameters, named))
        start = self._start(x0, values)
        options = self._core.run_options()
        if h is not None and tol is not None:
            raise TypeError("give h or tol, not both")
        if method is None and tol is not None:
            options.pop("method", None)  # a tolerance takes a method of its own
            options.pop("rtol", None)
            options.pop("atol", None)
        if h is None:
            tol = _given(tol, "tol", options)
        label = self._method(method, options, tol)
        end, every, times = _times(t, at, every, options)
        if h is None and tol is None:
            step = options.get("step")
            h = _core.constant(step[0]) if step else np.copysign(_STEP, end)
        pace = (None if h is None else _number(h, "h"), None if tol is None else float(tol))
        tolerances = (rtol, atol)
        if method is None:  # of the declaration's method
            tolerances = (_given(rtol, "rtol", options), _given(atol, "atol", options))
        solver: dict[str, object] = {
            "iteration": iteration,
            "newton_tolerance": newton_tolerance,
            "max_iterations": max_iterations,
            "converge": converge,
        }
        if method is None:  # of the declaration's method, like these
            solver = {name: _declared(name, value, options) for name, value in solver.items()}
        group = group if group is not None else options.get("group", [None])[0]
        rows, found = self._core.run(
            label, values, start, pace, end, every, times, tolerances, solver, group
        )
        t_rows, mu, energy, casimirs = rows
        columns = {name: casimirs[:, index] for index, name in enumerate(self.casimirs)}
        solution = Solution(
            self.name,
            self.coordinates,
            t_rows,
            mu,
            energy,
            columns,
            label,
            float(str(found["step"])),
            int(str(found["steps"])),
        )
        shown = [self.coordinates.index(name) for name in self._core.shown()]
        if len(shown) < len(self.coordinates):  # what carries the time is no coordinate of the user
            solution.coordinates = self._core.shown()
            solution.mu = mu[:, shown]
        if "group" in found:
            elements = np.asarray(found["group"]).reshape(len(t_rows), -1)
            size = round(elements.shape[1] ** 0.5)
            solution.group = elements if group == "quaternion" else elements.reshape(-1, size, size)
        if "missed" in found:
            error = float(str(found["missed"]))
            text = (
                f"the error at the end is about {error:.1e} of the state, more than the tolerance {tol:g}: "
                f"errors grow on this orbit, or {label} cannot keep it"
                if np.isfinite(error)
                else "the error at the end is not known: telling it takes too many steps, or failed"
            )
            warnings.warn(text, stacklevel=2)
        if "why" in found:
            number, time = int(str(found["step_number"])), float(str(found["time"]))
            message = (
                f"the integration stopped in step {number} at t = {time!r}: {found['why']}\n"
                f"  help: {found['remedy']}; the rows so far are in `partial`"
            )
            raise IntegrationError(message, solution, number, time)
        return solution

    def ensemble(
        self,
        x0: npt.ArrayLike,
        method: str | None = None,
        *,
        h: Number | None = None,
        t: Number,
        threads: int | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        parameters: Mapping[str, Any] | None = None,
        **named: Any,
    ) -> Ensemble:
        """The ends of many trajectories, from the rows of ``x0`` (shape (m, n)); parameters may be arrays of length m.

        The bits do not depend on the number of threads (all processors by default). A member that fails is a row
        of not-a-number, and is named in ``failures``. Of a group element that the declaration asks for, nothing is kept.
        """
        parameters = _merged(parameters, named)
        starts = np.ascontiguousarray(np.atleast_2d(np.asarray(x0, dtype=np.float64)))
        if starts.ndim != 2 or starts.shape[1] != self.dimension:
            raise ValueError(f"x0 has the shape {np.shape(x0)}, not (members, {self.dimension})")
        lengths = {name: np.size(value) for name, value in parameters.items()}
        if any(length not in (1, len(starts)) for length in lengths.values()):
            raise ValueError(f"parameters have lengths {lengths}, x0 has {len(starts)} members")
        varied = any(length > 1 for length in lengths.values())
        count = len(starts) if varied else 1
        scalars = self._values({name: np.ravel(value)[0] for name, value in parameters.items()})
        table = np.tile(np.asarray(scalars, dtype=np.float64), (count, 1))
        for name, value in parameters.items():
            table[:, list(self.parameters).index(name)] = np.broadcast_to(np.ravel(value), (count,))
        options = self._core.run_options()
        label = self._method(method, options, None)
        end = _number(t, "t")
        if h is None:
            if "tol" in options:
                raise TypeError("an ensemble has a step, not a tolerance: give h")
            h = _core.constant(options["step"][0]) if "step" in options else np.copysign(_STEP, end)
        if threads is not None and threads < 1:
            raise ValueError(f"threads must be 1, 2, 3, …, not {threads}")
        tolerances = (rtol, atol)
        if method is None:
            tolerances = (_given(rtol, "rtol", options), _given(atol, "atol", options))
        solver: dict[str, object] = {
            name: _declared(name, None, options) if method is None else None for name in _SOLVER
        }
        workers = threads if threads is not None else (os.cpu_count() or 1)
        ends, failures = self._core.ensemble(
            label, table, starts, _number(h, "h"), end, workers, tolerances, solver
        )
        return Ensemble(ends, failures)

    def function(
        self, name: str, /, parameters: Mapping[str, Number] | None = None, **named: Number
    ) -> Callable[..., Array]:
        """A function of the state, vectorised over leading axes: of shape (…, n).

        ``vector_field``, ``gradient``: (…, n). ``jacobian``, ``hessian``, ``poisson_matrix``: (…, n, n).
        ``hamiltonian``: (…). ``casimirs``: (…, number of Casimirs).

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> f = body.function("vector_field")
        >>> f([1.0, 2.0, 6.0]).tolist()
        [-2.0, 4.0, -1.0]

        For SciPy: ``solve_ivp(lambda t, y: f(y), …)``.
        """
        if name not in _FUNCTIONS:
            raise ValueError(
                f"no function `{name}`{_hint(name, _FUNCTIONS)} There are: {', '.join(_FUNCTIONS)}"
            )
        values, n = self._values(_merged(parameters, named)), self.dimension
        core, count = self._core, len(self.casimirs)

        def evaluate(mu: npt.ArrayLike) -> Array:
            states = np.asarray(mu, dtype=np.float64)
            if states.shape[-1:] != (n,):
                raise ValueError(
                    f"the last axis of the state has {states.shape[-1:]} entries, not {n}"
                )
            leading = states.shape[:-1]
            flat = np.ascontiguousarray(states.reshape(-1, n))
            found = core.evaluate(name, values, flat)
            shapes: dict[str, tuple[int, ...]] = {
                "hamiltonian": (),
                "vector_field": (n,),
                "gradient": (n,),
                "casimirs": (count,),
            }
            result: Array = found.reshape(leading + shapes.get(name, (n, n)))
            return result

        evaluate.__name__ = name
        return evaluate

    def methods(self) -> dict[str, str | None]:
        """Every method by its id, with the reason where it does not apply, else ``None``."""
        return dict(self._core.methods())

    def verify(
        self,
        *methods: str,
        h: Number | None = None,
        x0: Any = None,
        seed: int = 1,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Verification:
        """Measures what methods claim on this system: order, symmetry, invariants, the orbit, the Poisson structure.

        Without names, all methods that apply and run in Python, at their default options. ``h`` is the step at which facts are
        measured; it is found where it is not given. Kernels are compared with the declaration by the command, `lie verify`.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> body.verify("rk4", "lie-midpoint", x0=[0.8, 0.1, 0.6]).passed
        True

        Errors: :class:`MethodError` for a method that does not apply, :class:`ValueError` where nothing can be measured.
        """
        values = self._values(_merged(parameters, named))
        start = self._start(x0, values)
        step = None if h is None else _number(h, "h")
        facts, unsound = self._core.verify(list(methods), values, start, (step, seed))
        return Verification([Fact(*fact) for fact in facts], unsound)

    def rust(self, *methods: str) -> str:
        """The generated Rust, with fused code of these methods."""
        return self._core.rust(list(methods))

    def latex(self) -> str:
        """The Hamiltonian and the equations of motion for LaTeX."""
        lines = [line for line in self._core.equations()]
        body = r" \\ ".join(_latex(line).replace("=", "&=", 1) for line in lines)
        return r"\begin{aligned}" + body + r"\end{aligned}"


def _plain(value: Any) -> Any:
    """numpy's numbers and arrays as JSON."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{value!r} cannot stand in a declaration")


def _latex(text: str) -> str:
    import re

    text = re.sub(r"([A-Za-z]+)_?(\d+)(?![\d^])", r"\1_{\2}", text)
    text = re.sub(r"\^(\d+)", r"^{\1}", text)
    text = re.sub(r"\b(sqrt|exp|log|sin|cos|tan)\(", r"\\\1(", text)
    return text.replace("*", r"\,")


def load(path: str | os.PathLike[str]) -> System:
    """The system of a spec file."""
    with open(path, encoding="utf-8-sig") as file:
        return System(file.read())
