"""What measurements ask the core for, and what they make of the answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from . import _core
from ._arguments import UNTIL, Number, Progress, among, heard, merged, number, whole
from ._bench import MEASURES, Bench, BenchRow
from ._errors import Interrupted
from ._methods import labels_of
from ._stress import Stress
from ._verification import Verification

if TYPE_CHECKING:
    from ._declared import Declared

Result = TypeVar("Result", Bench, Stress, Verification)

#: What each measurement chooses itself.
OWN = {
    "verify": {"tol": "measures at a step"},
    "bench": {"h": "tries many steps", "tol": "tries many tolerances"},
    "stress": {
        "h": "finds a step and tries many",
        "tol": "finds a step and tries many",
        "t": "counts steps (`steps` of the long run)",
    },
}
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


def _names(system: Declared, values: list[float]) -> list[str]:
    """The coordinates, of a family those of all sites."""
    return system._core.names_of_sites(values) if system._core.family else system._core.coordinates


def _plane(
    system: Declared, names: list[str], measure: str, section: tuple[str, Number] | None
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
    shown = names if system._core.family else system.coordinates
    if name not in shown:
        raise ValueError(f"section: no coordinate `{name}`{among(name, shown)}")
    return names.index(name), number(value, "the value of the section")


def start_of(
    system: Declared,
    call: str,
    x0: Any,
    parameters: Mapping[str, Any] | None,
    named: Mapping[str, Any],
) -> tuple[list[float], list[float]]:
    """The values of the parameters and the initial state; what a measurement chooses itself is no argument."""
    for name, why in OWN[call].items():
        if name in named and name not in system.parameters:
            raise TypeError(f"no argument `{name}`: {call} {why}; leave it out")
    values = system._values(merged(parameters, named))
    return values, system._start(x0, values)


def unless_interrupted(result: Result) -> Result:
    """The result, unless Ctrl-C ended the measurement."""
    if not result.complete:
        raise Interrupted("interrupted; what was measured so far is in `partial`", result)
    return result


def measured(
    system: Declared,
    methods: Sequence[Any],
    begin: tuple[list[float], list[float]],
    asked: tuple[Number | None, float, str, tuple[str, Number] | None],
    progress: Progress | None,
) -> Bench:
    """Errors and times of these methods from a state on."""
    t, budget, measure, section = asked
    labels = labels_of("bench", methods)
    if measure not in MEASURES:
        raise ValueError(f"no measure `{measure}`{among(measure, list(MEASURES))}")
    budget = number(budget, "budget")
    if not (np.isfinite(budget) and budget > 0):
        raise ValueError(f"budget is {budget:g}, and must be seconds, such as budget=0.2")
    end, plane = _end(system, t), _plane(system, _names(system, begin[0]), measure, section)
    found = system._core.bench(labels, begin, (end, budget, measure, plane), heard(progress))
    passed = found["section"]
    names = _names(system, begin[0])
    result = Bench(
        system.name,
        measure,
        end,
        [BenchRow(*row) for row in found["rows"]],
        found["stopped"],
        found["reference"],
        found["floor"],
        None if passed is None else (names[passed[0]], passed[1], passed[2]),
        "processor" if found["processor"] else "wall",
        not found["interrupted"],
    )
    return unless_interrupted(result)


def verified(
    system: Declared,
    methods: Sequence[Any],
    begin: tuple[list[float], list[float]],
    asked: tuple[Number | None, int],
    progress: Progress | None,
) -> Verification:
    """The claims of these methods from a state on."""
    h, seed = asked
    step = None if h is None else number(h, "h")
    if step is not None and (step == 0 or not np.isfinite(step)):
        raise ValueError(
            f"h is {step:g}, which measures nothing: give a step such as h=0.1, or leave it out"
        )
    options = (step, whole(seed, "seed", 0))
    found = system._core.verify(labels_of("verify", methods), begin, options, heard(progress))
    return unless_interrupted(Verification(found))


def stressed(
    system: Declared,
    methods: Sequence[Any],
    begin: tuple[list[float], list[float]],
    steps: int,
    progress: Progress | None,
) -> Stress:
    """These methods at their limits."""
    count = whole(steps, "steps", 1)
    found = system._core.stress(labels_of("stress", methods), begin, count, heard(progress))
    return unless_interrupted(Stress(system.name, count, found))
