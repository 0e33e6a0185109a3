"""What methods claim, beside what was measured."""

from __future__ import annotations

import html
import math
from typing import Any, NamedTuple

from . import _core
from ._pictures import page, table

__all__ = ["Fact", "Verification"]


class Fact(NamedTuple):
    """A fact of a method.

    ``claim``: what is claimed, an order as a number, else 0. ``measured``: what was measured. ``bound``: the largest value at
    which a claim of 0 holds, the smallest at which an order does. ``verdict``: "holds", "fails", "not-measurable",
    "not-claimed" or "absent".
    ``step``: the step of the measurement. ``error``: the standard error of what was measured along paths of noise, else not a number.
    """

    method: str
    fact: str
    claim: float
    measured: float
    bound: float
    verdict: str
    note: str
    step: float
    error: float = math.nan


class Verification:
    """The claims of methods, measured on a system, and the kernels of the system, compared with its declaration.

    ``facts``: a list of :class:`Fact`. ``kernels``: of each kernel ("vector_field", "jacobian", …) the largest difference between what the
    compiled code gives and the declaration as it was written, interpreted with derivatives of its own, in units of the round-off
    allowed: at most 1 for one that is right; ``None`` of a family, whose kernels are not compared. ``reference``: the same of the
    reference solution, ``None`` where it was not compared. ``failures``: what does not hold, in words: claims, kernels, and
    measurements that would not have noticed a spoiled map. ``passed``: whether there is none. ``complete``: whether it came to
    its end.
    """

    def __init__(self, found: dict[str, Any]) -> None:
        self.facts = [Fact(*fact) for fact in found["facts"]]
        self.failures: list[str] = found["failures"]
        self.kernels: dict[str, float] | None = found["kernels"]
        self.reference: float | None = found["reference"]
        self.complete: bool = found["complete"]
        self._kernels: str = found["summary"]

    @property
    def passed(self) -> bool:
        """Whether it came to its end, and nothing fails."""
        return self.complete and not self.failures

    def _table(self) -> tuple[list[str], list[list[str]]]:
        methods = list(dict.fromkeys(fact.method for fact in self.facts))
        names = list(dict.fromkeys(fact.fact for fact in self.facts if fact.verdict != "absent"))
        cells = {(fact.method, fact.fact): _cell(fact) for fact in self.facts}
        rows = [[method, *(cells.get((method, name), "–") for name in names)] for method in methods]
        return ["method", *names], rows

    def _summary(self) -> str:
        claimed = sum(fact.verdict in ("holds", "fails") for fact in self.facts)
        fail = sum(fact.verdict == "fails" for fact in self.facts)
        early = "" if self.complete else "interrupted: "
        return f"{early}{claimed} claims, {fail} fail"

    def __repr__(self) -> str:
        """A table: a line for each method, a column for each fact that is claimed or measured."""
        head, body = self._table()
        lines = [_core.columns([head, *body]) + self._kernels, self._summary()]
        return "\n".join([*lines, *(f"failed: {failure}" for failure in self.failures)])

    def _repr_html_(self) -> str:
        failed = table(["what fails"], [[words] for words in self.failures])
        return page(
            self._summary(),
            table(*self._table()),
            f"<p>{html.escape(self._kernels)}</p>",
            failed if self.failures else "",
        )


def _cell(fact: Fact) -> str:
    if fact.verdict == "absent" or math.isnan(fact.measured):
        return "–"
    sign = {"holds": " ✓", "fails": " ✗"}.get(fact.verdict, "")
    error = "" if math.isnan(fact.error) else f" ± {fact.error:.1g}"
    return f"{fact.measured:.2g}{error}{sign}"
