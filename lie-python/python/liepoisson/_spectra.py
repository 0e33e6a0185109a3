"""Lyapunov exponents of a motion, and the lines of a signal."""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import Array, whole

__all__ = ["Exponents", "Frequencies", "Line"]

#: Lines are sought among so many samples, at least.
_LEAST = 16
#: The largest power of a window.
_WINDOW = 5


class Exponents:
    """The Lyapunov exponents of an orbit, the largest first.

    ``values``, ``errors``: arrays; an error is the standard error of the mean, from 20 parts of the time, or the distance of the mean over
    its second half where that is larger. ``sum``: of all, the mean of the divergence. ``pairing_defect``: the largest |lambda_i +
    lambda_(n+1-i)| on the leaf, of ``leaf_dimension``. ``casimir_exponents``: the largest magnitude of those off the leaf. The last
    three are not numbers where not all exponents were asked for, or where there are none. ``method``, ``step``, ``steps``, ``time``, ``transient``,
    ``seed``: what was done. ``complete``: whether it came to its end.
    """

    def __init__(self, found: dict[str, Any], complete: bool) -> None:
        def real(name: str) -> float:
            return math.nan if found[name] is None else float(found[name])

        self.name: str = found["system"]
        self.values: Array = np.array(found["exponents"], dtype=float)
        self.errors: Array = np.array(found["errors"], dtype=float)
        self.sum = real("sum")
        self.pairing_defect = real("pairing_defect")
        self.casimir_exponents = real("casimir_exponents")
        self.leaf_dimension: int = found["leaf_dimension"]
        self.method: str = found["method"]
        self.step: float = found["step"]
        self.steps: int = found["steps"]
        self.time: float = found["time"]
        self.transient: float = found["transient"]
        self.seed: int = found["seed"]
        self.complete = complete

    def __repr__(self) -> str:
        pairs = zip(self.values, self.errors)
        values = ", ".join(f"{value:.4g} ± {error:.1g}" for value, error in pairs)
        return f"{self.name}: Lyapunov exponents over a time of {self.time:g}: {values}"


class Line(NamedTuple):
    """A line ``amplitude * cos(frequency * t + phase)``, with the time from the first row on.

    ``frequency``: angular, radians per unit of the time. ``halves``: the frequencies over the first half of the time and over the second.
    """

    frequency: float
    amplitude: float
    phase: float
    halves: tuple[float, float]

    @property
    def drift(self) -> float:
        """By how much the halves differ: an estimate of the error of a regular motion, and the diffusion of a chaotic one."""
        return abs(self.halves[0] - self.halves[1])


class Frequencies(NamedTuple):
    """What a signal is made of.

    ``mean``: the line at zero. ``lines``: each a :class:`Line`, that of the largest amplitude first. ``rest``: the root of the mean square of what is left.
    """

    mean: float
    lines: list[Line]
    rest: float


def read_exponents(found: dict[str, Any]) -> Exponents | None:
    """What the core says of exponents; nothing where it was ended before there were any."""
    said = found["json"]
    return None if said is None else Exponents(json.loads(said), found["complete"])


def frequencies_of(times: Array, values: Array, count: Any, window: Any) -> Frequencies:
    """The lines of a signal."""
    count, window = whole(count, "count", 1), whole(window, "window", 0)
    if window > _WINDOW:
        raise ValueError(f"window is a power up to {_WINDOW}, not {window}")
    if len(times) < _LEAST:
        raise ValueError(
            f"{len(times)} rows, and lines take at least {_LEAST}\n  help: give a later t, or a smaller h or every"
        )
    found = _core.lines(times, values, count, window)
    if found is None:
        raise ValueError(
            "the rows are at no equal distances\n  help: leave out `at`, or give times at equal distances"
        )
    mean, lines, rest = found
    if not math.isfinite(mean):
        place = np.flatnonzero(~np.isfinite(values))[0]
        raise ValueError(
            f"the column is not finite at t = {times[place]}\n  help: analyse another one, or give rows where it is defined"
        )
    made = [Line(frequency, size, phase, (a, b)) for frequency, size, phase, (a, b) in lines]
    return Frequencies(mean, made, rest)
