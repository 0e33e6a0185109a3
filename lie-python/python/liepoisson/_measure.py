"""What measurements ask the core for, and what they make of the answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ._arguments import Number, Progress, among, heard, number, spelled, whole
from ._bench import MEASURES, Bench, BenchRow
from ._errors import IntegrationError, Interrupted
from ._methods import labels_of
from ._spectra import Exponents, read_exponents
from ._stress import Stress
from ._verification import Verification

if TYPE_CHECKING:
    from ._declared import Declared

Result = TypeVar("Result", Bench, Exponents, Stress, Verification)

#: What each measurement chooses itself.
OWN = {
    "verify": {"tol": "measures at a step"},
    "exponents": {"tol": "measures the tangents of steps of one size"},
    "bench": {"h": "tries many steps", "tol": "tries many tolerances"},
    "stress": {
        "h": "finds a step and tries many",
        "tol": "finds a step and tries many",
        "t": "counts steps (`steps` of the long run)",
    },
}


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


def asked_of(
    system: Declared,
    call: str,
    own: dict[str, Any],
    parameters: Mapping[str, Any] | None,
    named: Mapping[str, Any],
) -> dict[str, Any]:
    """What a measurement is asked for; what it chooses itself is no argument."""
    others = dict(named)
    spelled(own, others, system.parameters)
    for name, why in OWN[call].items():
        if name in others and name not in system.parameters:
            raise TypeError(f"no argument `{name}`: {call} {why}; leave it out")
    return system._asked(own, parameters, others)


def unless_interrupted(result: Result) -> Result:
    """The result, unless Ctrl-C ended the measurement."""
    if not result.complete:
        raise Interrupted("interrupted; what was measured so far is in `partial`", result)
    return result


def measured(
    system: Declared,
    methods: Sequence[Any],
    asked: dict[str, Any],
    options: tuple[float, str, tuple[str, Number] | None],
    progress: Progress | None,
) -> Bench:
    """Errors and times of these methods from a state on."""
    budget, measure, section = options
    labels = labels_of("bench", methods)
    if measure not in MEASURES:
        raise ValueError(f"no measure `{measure}`{among(measure, list(MEASURES))}")
    budget = number(budget, "budget")
    if not (np.isfinite(budget) and budget > 0):
        raise ValueError(f"budget is {budget:g}, and must be seconds, such as budget=0.2")
    names = _names(system, asked["parameters"])
    plane = _plane(system, names, measure, section)
    found = system._core.bench(labels, asked, (budget, measure, plane), heard(progress))
    passed = found["section"]
    result = Bench(
        system.name,
        measure,
        found["until"],
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
    asked: dict[str, Any],
    seed: int,
    progress: Progress | None,
) -> Verification:
    """The claims of these methods from a state on."""
    labels = labels_of("verify", methods)
    found = system._core.verify(labels, asked, whole(seed, "seed", 0), heard(progress))
    return unless_interrupted(Verification(found))


def stressed(
    system: Declared,
    methods: Sequence[Any],
    asked: dict[str, Any],
    steps: int,
    progress: Progress | None,
) -> Stress:
    """These methods at their limits."""
    count = whole(steps, "steps", 1)
    found = system._core.stress(labels_of("stress", methods), asked, count, heard(progress))
    return unless_interrupted(Stress(system.name, count, found))


def parted(
    system: Declared,
    asked: dict[str, Any],
    own: tuple[Number, int | None],
    progress: Progress | None,
) -> Exponents:
    """How fast neighbours part along an orbit."""
    transient, count = own
    wanted = None if count is None else whole(count, "count", 1)
    beside = (number(transient, "transient"), wanted)
    found = system._core.exponents(asked, beside, heard(progress))
    result = read_exponents(found)
    if result is None:
        raise Interrupted("interrupted before anything was summed", None)
    if found["stopped"] is not None:
        step, time, why, remedy = found["stopped"]
        message = (
            f"the integration stopped in step {step} at t = {time!r}: {why}\n"
            f"  help: {remedy}; what was summed so far is in `partial`"
        )
        raise IntegrationError(message, result, step, time)
    return unless_interrupted(result)
