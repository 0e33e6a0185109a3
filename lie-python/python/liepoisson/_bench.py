"""Errors of methods beside the times that they take."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import among
from ._pictures import image, new_figure, page, shown, table

__all__ = ["Bench", "BenchRow"]

#: What the error of a run is, by the name of the measure.
MEASURES = {
    "state": "relative error at the end",
    "energy": "largest relative drift of the energy",
    "casimirs": "largest relative drift of a Casimir",
    "phase": "difference in time at the end",
    "section": "relative distance on the surface of section",
}
_TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)


class BenchRow(NamedTuple):
    """A run: a method at one step or tolerance.

    ``control``: "step" or "tolerance", ``value``: which one. ``error``: in the sense of the measure; ``across``: beside an error
    in phase, the distance from the exact orbit. ``seconds``: the least time of all rounds for a unit of time of the system,
    ``median``: their median, ``wall``: what passed meanwhile on the clock of the wall. ``steps``, ``evaluations`` (of the
    vector field or of a residual), ``newton`` (iterations): counts of the run.
    """

    method: str
    control: str
    value: float
    error: float
    across: float | None
    seconds: float
    median: float
    wall: float
    steps: int
    evaluations: int
    newton: int


class Bench:
    """Errors of methods beside the times that they take.

    ``rows``: a list of :class:`BenchRow`. ``bench["error"]`` is a column as a numpy array, ``of(method)`` the columns of one
    method. ``stopped``: runs that did not come to their end: method, control, value, reason. ``measure`` and ``t``: what was asked
    for. ``reference``: the estimated error of the exact solution that runs are compared with, and its distance from
    a second one, ``None`` where none is needed. ``floor``: errors below it are not told from 0; 0 where there is no such
    solution. ``section``: coordinate, value and passages of the surface of section, else ``None``. ``clock``: "processor" or "wall". ``complete``: whether it came to its end.
    """

    def __init__(
        self,
        name: str,
        measure: str,
        t: float,
        rows: Sequence[BenchRow],
        stopped: Sequence[tuple[str, str, float, str]],
        reference: tuple[float, float] | None,
        floor: float,
        section: tuple[str, float, int] | None,
        clock: str,
        complete: bool,
    ) -> None:
        self.name = name
        self.measure = measure
        self.t = t
        self.rows = list(rows)
        self.stopped = list(stopped)
        self.reference = reference
        self.floor = floor
        self.section = section
        self.clock = clock
        self.complete = complete

    @property
    def methods(self) -> list[str]:
        """The methods of the rows, in order."""
        return list(dict.fromkeys(row.method for row in self.rows))

    def _column(self, name: str, rows: Sequence[BenchRow]) -> Any:
        values = [getattr(row, name) for row in rows]
        if name == "across":
            values = [np.nan if value is None else value for value in values]
        return np.array(values)

    def __getitem__(self, name: str) -> Any:
        if not isinstance(name, str):
            raise TypeError(f"columns have names, not {name!r}; rows are in `rows`")
        if name not in BenchRow._fields:
            raise KeyError(f"no column {name!r}{among(name, BenchRow._fields)}")
        return self._column(name, self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def of(self, method: str) -> dict[str, Any]:
        """The rows of a method, as a dictionary of numpy arrays."""
        rows = [row for row in self.rows if row.method == method]
        if not rows:
            raise KeyError(f"no rows of {method!r}{among(method, self.methods)}")
        return {name: self._column(name, rows) for name in BenchRow._fields if name != "method"}

    def fastest(self, error: float) -> list[BenchRow]:
        """Of each method the fastest row with at most this error, the fastest method first."""
        best: dict[str, BenchRow] = {}
        for row in self.rows:
            known = best.get(row.method)
            if row.error <= error and (known is None or row.seconds < known.seconds):
                best[row.method] = row
        return sorted(best.values(), key=lambda row: row.seconds)

    def _table(self) -> tuple[list[str], list[list[str]]]:
        head = ["method", *(f"to {target:.0e}" for target in _TARGETS), "least error"]
        times = [
            {row.method: row.seconds for row in self.fastest(error)} if error >= self.floor else {}
            for error in _TARGETS
        ]
        rows = []
        for method in self.methods:
            cells = [f"{time[method] * 1e6:.3g}" if method in time else "–" for time in times]
            least = self.of(method)["error"].min()
            rows.append(
                [method, *cells, f"< {self.floor:.1e}" if least < self.floor else f"{least:.1e}"]
            )
        return head, rows

    def _title(self) -> str:
        early = "" if self.complete else " (interrupted)"
        return (
            f"{self.name} to t = {self.t:g}{early}: microseconds per unit of time, by the "
            f"{self.clock}, to a {MEASURES[self.measure]}"
        )

    def __repr__(self) -> str:
        """A table: a line for each method, a column for each accuracy."""
        head, rows = self._table()
        return f"{self._title()}\n{_core.columns([head, *rows])}".rstrip()

    def plot(self, *, show: bool = False) -> Any:
        """Draws errors over times with matplotlib; returns the figure."""
        figure = new_figure((8, 5.5), "plot()")
        self._draw(figure)
        return shown(figure, show)

    def _draw(self, figure: Any) -> None:
        axes = figure.subplots()
        for number, method in enumerate(self.methods):
            rows = self.of(method)
            marks = {"marker": "osv^Dx"[number % 6], "markersize": 3, "linewidth": 1}
            axes.loglog(rows["seconds"], np.maximum(rows["error"], 1e-17), label=method, **marks)
        axes.set_xlabel(f"seconds per unit of time ({self.clock})")
        axes.set_ylabel(MEASURES[self.measure])
        axes.set_title(f"{self.name}, to t = {self.t:g}")
        if self.rows:
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=8)

    def _repr_html_(self) -> str:
        picture = image(self._draw, (8, 5), "errors over times") if self.rows else ""
        return page(self._title(), table(*self._table()), picture)
