"""What `bench` asks the core for, and what it makes of the answers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import UNTIL, Number, hint, number
from ._bench import MEASURES, Bench, BenchRow
from ._errors import Interrupted

if TYPE_CHECKING:
    from ._declared import Declared

#: The longest span of the declaration that is taken.
_SPAN = 20.0


def _end(system: Declared, t: Number | None) -> float:
    if t is None:
        until = system._core.run_options().get("until")
        return UNTIL if until is None else float(np.clip(_core.constant(until[0]), -_SPAN, _SPAN))
    end = number(t, "t")
    if end == 0 or not np.isfinite(end):
        raise ValueError(f"t is {end:g}, there is nothing to integrate: give an end such as t=10")
    return end


def _plane(
    system: Declared, measure: str, section: tuple[str, Number] | None
) -> tuple[int, float] | None:
    if section is None:
        return None
    if measure != "section":
        raise TypeError('a section says something with measure="section" alone')
    example = f'section=("{system.coordinates[0]}", 0)'
    if not isinstance(section, (tuple, list)) or len(section) != 2:
        raise TypeError(
            f"section is a coordinate and its value, such as {example}, not {section!r}"
        )
    name, value = section
    if name not in system.coordinates:
        close = hint(str(name), system.coordinates)
        raise ValueError(
            f"section: no coordinate `{name}`{close} There are: {', '.join(system.coordinates)}"
        )
    return system._core.coordinates.index(name), number(value, "the value of the section")


def measured(
    system: Declared,
    methods: Sequence[Any],
    values: list[float],
    start: list[float],
    asked: tuple[Number | None, float, str, tuple[str, Number] | None],
) -> Bench:
    """Errors and times of these methods from a state on."""
    t, budget, measure, section = asked
    if any(not isinstance(method, str) for method in methods):
        raise TypeError('methods are given one by one, as text: bench("rk4", "gauss4")')
    if measure not in MEASURES:
        raise ValueError(
            f"no measure `{measure}`{hint(str(measure), list(MEASURES))} There are: {', '.join(MEASURES)}"
        )
    budget = number(budget, "budget")
    if not (np.isfinite(budget) and budget > 0):
        raise ValueError(f"budget is {budget:g}, and must be seconds, such as budget=0.2")
    end, plane = _end(system, t), _plane(system, measure, section)
    found = system._core.bench(list(methods), values, start, (end, budget, measure, plane))
    passed = found["section"]
    result = Bench(
        system.name,
        measure,
        end,
        [BenchRow(*row) for row in found["rows"]],
        found["stopped"],
        found["reference"],
        None if passed is None else (system._core.coordinates[passed[0]], passed[1], passed[2]),
        "processor" if found["processor"] else "wall",
        not found["interrupted"],
    )
    if not result.complete:
        raise Interrupted("interrupted; what was measured so far is in `partial`", result)
    return result
