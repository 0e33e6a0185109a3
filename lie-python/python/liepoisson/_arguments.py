"""Arguments of calls: numbers, times, names, and what people write from habit."""

from __future__ import annotations

import difflib
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core

Array = npt.NDArray[np.float64]
Number = Union[float, int, str]
#: What hears how far long work is: what is done, of how much, what it is.
Progress = Callable[[int, int, str], object]

#: What people write from habit, and what it is called here.
SLIPS = {
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
VARIANTS = ("retraction", "lift", "gradient", "composition", "pieces", "tensor")
#: Options of the solver of implicit methods.
SOLVER = ("iteration", "newton_tolerance", "max_iterations", "converge")
#: The step where neither the call nor the declaration gives one.
STEP = 0.01
#: The time until which a system runs where neither says it.
UNTIL = 10.0


def hint(name: str, known: Sequence[str]) -> str:
    folded = {other.casefold(): other for other in reversed(known)}
    close = difflib.get_close_matches(name, known, n=1)
    near = folded.get(name.casefold()) or (close[0] if close else None)
    return f"; did you mean `{near}`?" if near else ""


# so many names of what there is are told
_NAMED = 40


def among(name: object, known: Sequence[str]) -> str:
    """What is meant by an unknown name, and what there is."""
    near = hint(str(name), known) or "."
    more = ", …" if len(known) > _NAMED else ""
    return f"{near} There are: {', '.join(known[:_NAMED]) or 'none'}{more}"


def floats(value: Any, what: str) -> Array:
    """An array of double precision; complex numbers and text are none."""
    if np.ma.is_masked(value):
        raise TypeError(f"{what} is masked: give all of its numbers, such as {what}.filled(0)")
    try:
        found = np.asarray(value)
        if found.dtype.kind in "biuf" or found.dtype.kind == "O":
            return found.astype(np.float64)
    except OverflowError:
        raise ValueError(f"{what} has a number beyond the range of double precision") from None
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be an array of numbers, not {value!r}") from None
    raise TypeError(f"{what} must be an array of real numbers, and has the type {found.dtype}")


def word(value: Any, what: str, example: str) -> str | None:
    """A word, or nothing."""
    if value is None or isinstance(value, str):
        return value
    raise TypeError(f"{what} is text, such as {example!r}, not {value!r}")


def number(value: Number, what: str) -> float:
    """A number, or an exact constant as text."""
    if isinstance(value, str):
        try:
            return _core.constant(value)
        except ValueError as error:
            raise ValueError(f"{what}: {error}; give a number, or text such as '1/7'") from None
    try:
        if np.ndim(value) == 0 and not isinstance(value, (bool, np.bool_)):
            return float(value)
    except OverflowError:
        raise ValueError(f"{what} is beyond the range of double precision") from None
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{what} must be a number or text such as '1/7', not {value!r}")


def whole(value: Any, name: str, least: int) -> int:
    """A whole number, of Python or of numpy, that is not smaller than this one."""
    known = f"{least}, {least + 1}, {least + 2}, …"
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be {known}, not {value!r}") from None
    if isinstance(value, bool):
        raise TypeError(f"{name} must be {known}, not {value!r}")
    if found < least:
        raise ValueError(f"{name} must be {known}, not {found}")
    if found >= 2**63:
        raise ValueError(f"{name} is too large: {found}")
    return found


def heard(progress: Progress | None) -> Progress | None:
    """What hears how far it is, if it can be called."""
    if progress is None or callable(progress):
        return progress
    raise TypeError(
        "progress is a function, such as progress=lambda done, total, what: print(done, total, what), "
        f"not {progress!r}"
    )


def given(value: float | None, name: str, options: Mapping[str, list[str]]) -> float | None:
    """What the call says, else what the declaration says."""
    if value is None and name in options:
        return _core.constant(options[name][0])
    return None if value is None else number(value, name)


def times_of(
    t: Number | None, at: Any, every: int | None, options: Mapping[str, list[str]]
) -> tuple[float, int, list[float] | None]:
    """The end, each so-manyth step that is saved, and the times that are saved in its place."""
    if at is not None and (t is not None or every is not None):
        raise TypeError("with `at` there is a row for each of its times: leave out t and every")
    if every is not None:
        every = whole(every, "every", 1)
    if at is None and t is None and every is None:
        at = options.get("at")
    if at is not None:
        found = [number(time, "a time of at") for time in np.atleast_1d(at).tolist()]
        if not found:
            raise ValueError("`at` is empty: give it times, such as at=[0, 1, 2]")
        if not np.isfinite(found).all():
            raise ValueError(f"times of `at` must be finite, not {found}")
        if min(found) < 0 < max(found):
            raise ValueError("times of `at` lie on one side of 0: make a run for each side")
        found.sort(key=abs)
        return found[-1], 1, found
    last = max(options.get("at", [str(UNTIL)]), key=lambda time: abs(_core.constant(time)))
    until = options.get("until", [last])
    end = _core.constant(until[0]) if t is None else number(t, "t")
    if not np.isfinite(end):
        raise ValueError(f"t is {end}, and must be finite")
    if every is None:
        told = _core.constant(options.get("every", ["1"])[0])
        if not (told.is_integer() and told >= 1):
            raise ValueError(f"`every` of the declaration is {told:g}, and must be 1, 2, 3, …")
        every = int(told)
    return end, every, None


def declared(name: str, value: object, options: Mapping[str, list[str]]) -> object:
    """An option of the solver: what the call says, else what the declaration says."""
    key = name.replace("_", "-")
    if value is not None:
        return solver_option(name, value)
    if key not in options:
        return None
    text = options[key][0]
    if name == "newton_tolerance":
        return _core.constant(text)
    return int(_core.constant(text)) if name == "max_iterations" else text


def solver_option(name: str, value: Any) -> object:
    """An option of the solver as it is given."""
    if value is None:
        return None
    if name == "newton_tolerance":
        return number(value, name)
    if name == "max_iterations":
        return min(whole(value, name, 1), 2**31)
    return word(value, name, "newton" if name == "iteration" else "state")


def merged(parameters: Mapping[str, Any] | None, named: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by name, and those in a dictionary."""
    if parameters is not None and not isinstance(parameters, Mapping):
        raise TypeError(f'parameters are a dictionary such as {{"k": 2}}, not {parameters!r}')
    both = [name for name in named if name in (parameters or {})]
    if both:
        raise TypeError(f"the parameter `{both[0]}` is given twice")
    return {**(parameters or {}), **named}
