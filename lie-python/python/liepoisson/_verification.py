"""What methods claim, beside what was measured."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ._pictures import page, table

__all__ = ["Fact", "Verification"]


class Fact(NamedTuple):
    """A fact of a method.

    ``claim``: what is claimed, an order as a number, else 0. ``measured``: what was measured. ``bound``: the largest value at
    which a claim of 0 holds, the smallest at which an order does. ``verdict``: "holds", "fails", "not-claimed" or "absent".
    ``step``: the step of the measurement.
    """

    method: str
    fact: str
    claim: float
    measured: float
    bound: float
    verdict: str
    note: str
    step: float


class Verification:
    """The claims of methods, measured on a system.

    ``facts``: a list of :class:`Fact`. ``passed``: whether every claim holds and every measurement would have noticed a
    spoiled map. ``failures``: what does not, in words.
    """

    def __init__(self, facts: Sequence[Fact], unsound: Sequence[str]) -> None:
        self.facts = list(facts)
        self.unsound = list(unsound)

    @property
    def failures(self) -> list[str]:
        """What does not hold, in words."""
        failed = [fact for fact in self.facts if fact.verdict == "fails"]
        words = [
            f"{fact.method}: {fact.fact} is claimed, {fact.measured:.1e} was measured, where "
            f"{'at most' if fact.claim == 0 else 'at least'} {fact.bound:.1e} holds"
            for fact in failed
        ]
        return words + self.unsound

    @property
    def passed(self) -> bool:
        """Whether every claim holds."""
        return not self.failures

    def _table(self) -> tuple[list[str], list[list[str]]]:
        methods = list(dict.fromkeys(fact.method for fact in self.facts))
        names = list(dict.fromkeys(fact.fact for fact in self.facts if fact.verdict != "absent"))
        cells = {(fact.method, fact.fact): _cell(fact) for fact in self.facts}
        rows = [[method, *(cells.get((method, name), "–") for name in names)] for method in methods]
        return ["method", *names], rows

    def _summary(self) -> str:
        claimed = sum(fact.verdict in ("holds", "fails") for fact in self.facts)
        return f"{claimed} claims, {len(self.failures)} fail"

    def __repr__(self) -> str:
        """A table: a line for each method, a column for each fact that is claimed or measured."""
        head, body = self._table()
        rows = [head, *body]
        widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)) for row in rows]
        return "\n".join(line.rstrip() for line in [*lines, self._summary(), *self.failures])

    def _repr_html_(self) -> str:
        failed = table(["what fails"], [[words] for words in self.failures])
        return page(self._summary(), table(*self._table()), failed if self.failures else "")


def _cell(fact: Fact) -> str:
    if fact.verdict == "absent" or math.isnan(fact.measured):
        return "–"
    sign = {"holds": " ✓", "fails": " ✗"}.get(fact.verdict, "")
    return f"{fact.measured:.2g}{sign}"
