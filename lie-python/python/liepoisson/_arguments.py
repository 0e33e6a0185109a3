"""Arguments of calls: numbers, times, names, and what people write from habit."""

from __future__ import annotations

import difflib
import functools
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

#: The spelling of the command and of declarations, which is taken too.
ALSO = {"h": "step", "t0": "from", "t": "until", "x0": "initial"}
#: What people write from habit, and what it is called here.
SLIPS = {
    "dt": "h",
    "stepsize": "h",
    "max_step": "h",
    "y0": "x0",
    "mu0": "x0",
    "u0": "x0",
    "t_end": "t",
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
#: Arguments that count something.
COUNTS = ("every", "max_iterations", "seed")
#: Arguments that are True or False.
FLAGS = ("assess",)
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


def number(value: Number, what: str) -> float:
    """A number, or an exact constant as text."""
    if isinstance(value, str):
        try:
            return _core.constant(value)
        except ValueError as error:
            raise ValueError(f"{what}: {error}; give a number, or text such as '1/7'") from None
    try:
        if type(value) is float or type(value) is int:
            return float(value)
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


_is_word = functools.cache(_core.is_word)


def asked(options: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments that are given, as the core takes them: numbers, words, exact constants as text."""
    return {name: _value(name, value) for name, value in options.items() if value is not None}


def _value(name: str, value: Any) -> Any:
    if name in COUNTS:
        return whole(value, name, 0 if name == "seed" else 1)
    if name == "inputs":
        return {str(key): source(key, given) for key, given in value.items()}
    if name in FLAGS:
        if isinstance(value, (bool, np.bool_)):
            return bool(value)
        raise TypeError(f"{name} must be True or False, not {value!r}")
    if isinstance(value, str):
        return str(value)
    if name == "keep" and isinstance(value, (list, tuple, set, frozenset)):
        if not all(isinstance(word, str) for word in value):
            raise TypeError(f"keep lists words such as 'energy' and 'casimirs', not {value!r}")
        return ",".join(sorted(value))
    if _is_word(name):
        raise TypeError(f"{name} is text, not {value!r}")
    if name in ("at", "x0"):
        what = "a time of at" if name == "at" else "an entry of x0"
        entries = value if type(value) is list else np.atleast_1d(value).tolist()
        return [entry if isinstance(entry, str) else number(entry, what) for entry in entries]
    return number(value, name)


def source(name: str, given: Any) -> Any:
    """The values of an input: a function, or a table of times and values as two lists."""
    if callable(given):
        return given
    table = np.asarray(given, dtype=float)
    if table.ndim != 2 or table.shape[1] != 2 or len(table) == 0:
        raise ValueError(
            f"the input {name!r} is a function of (t, mu, g), or an array of shape (m, 2) with a time and a value in each row, "
            f"not of shape {table.shape}"
        )
    if not np.isfinite(table).all() or (np.diff(table[:, 0]) <= 0).any():
        raise ValueError(f"the times of the input {name!r} must ascend, and all its numbers be finite")
    return table[:, 0].tolist(), table[:, 1].tolist()


class Controllers:
    """Functions that set inputs, with what one of them raised."""

    def __init__(self, inputs: Mapping[str, Any]) -> None:
        if not isinstance(inputs, Mapping):
            raise TypeError(f'inputs are a dictionary such as {{"u": controller}}, not {inputs!r}')
        self.raised: BaseException | None = None
        self.sources = {
            name: self._guarded(given) if callable(given) else given for name, given in inputs.items()
        }

    def _guarded(self, function: Callable[..., Any]) -> Callable[..., float]:
        def answer(time: float, mu: Array, element: Array | None) -> float:
            if self.raised is not None:
                return float("nan")
            if element is not None and len(element) != 4:
                size = round(len(element) ** 0.5)
                element = element.reshape(size, size)
            try:
                return float(function(time, mu, element))
            except BaseException as error:  # noqa: BLE001
                self.raised = error
                return float("nan")

        return answer


def spelled(own: dict[str, Any], named: dict[str, Any], parameters: Mapping[str, float]) -> None:
    """Moves arguments that are spelt as the command spells them to their names; a parameter of that name wins."""
    for name, other in ALSO.items():
        if name in own and other in named and other not in parameters:
            value = named.pop(other)
            if own[name] is not None:
                raise TypeError(f"`{name}` and `{other}` are one argument: give it once")
            own[name] = value


def merged(parameters: Mapping[str, Any] | None, named: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by name, and those in a dictionary."""
    if parameters is not None and not isinstance(parameters, Mapping):
        raise TypeError(f'parameters are a dictionary such as {{"k": 2}}, not {parameters!r}')
    both = [name for name in named if name in (parameters or {})]
    if both:
        raise TypeError(f"the parameter `{both[0]}` is given twice")
    return {**(parameters or {}), **named}
