"""Methods at their limits."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import among
from ._pictures import image, new_figure, page, shown, table

__all__ = ["Growth", "Stress", "StressCell"]

#: What is said of an experiment.
EXPERIMENTS = {
    "step": "step over h0",
    "parameter": "times",
    "scale": "state times",
    "component": "times",
    "casimir": "times",
    "long": "long run",
}
#: Colours of what is not a drift.
_COLOURS = {"lost": "#d62728", "stopped": "#bdbdbd", "domain": "#f4f4f4"}


class StressCell(NamedTuple):
    """An experiment with a method.

    ``experiment``: what is changed: "step", "parameter", "scale" (the whole state), "component", "casimir", "long" (the number of steps).
    ``name``: which one, ``value``: by what factor (of a long run its steps). ``step``: the step. ``outcome``: "kept" (no claimed
    invariant moved further than round-off moves it, no step was refused), "lost" (one did, and no message said so), "stopped"
    (a step failed with a message), "domain" (nothing to integrate there). ``steps``: steps done, ``newton``: iterations of the
    solver for each. ``energy_drift``, ``casimir_drift``: largest errors relative to the size of the terms, of the Casimir that moved
    most; ``energy_growth``, ``casimir_growth``: those of the last tenth of the run over those of the first. ``claimed``: the largest
    drift of a claimed invariant over its bound of round-off. ``what``: what was lost, or why it stopped.
    """

    method: str
    experiment: str
    name: str
    value: float
    step: float
    outcome: str
    steps: int
    newton: float
    energy_drift: float
    energy_growth: float
    casimir_drift: float
    casimir_growth: float
    claimed: float
    what: str


class Growth(NamedTuple):
    """How the round-off of the claimed invariant that moves most grows with the number of steps N.

    ``exponent``: of its error in N, with its standard ``error``: 0.5 is a random walk, 1 a bias. ``bias``: the mean of the
    error per step, with its standard error ``bias_error`` over ``states`` near the initial one. ``end``: the error at the end, root of
    the mean square, ``largest``: the largest. ``first``, ``last``: the steps of the first and of the last point of the fit. ``step``: the
    step, h0 or the largest of 8 h0, 4 h0 and 2 h0 that goes. ``ratio``: the largest error over its bound.
    """

    method: str
    invariant: str
    exponent: float
    error: float
    bias: float
    bias_error: float
    end: float
    largest: float
    first: int
    last: int
    states: int
    step: float
    ratio: float


def _growth(method: str, invariant: str, *rest: Any) -> Growth:
    exponent, bias, end, steps, states, step, ratio = rest
    return Growth._make([method, invariant, *exponent, *bias, *end, *steps, states, step, ratio])


class Stress:
    """What methods did at the limits of steps, parameters and states, and through a long run.

    ``cells``: a list of :class:`StressCell` (``pandas.DataFrame(found.cells)`` has their names as columns). ``found["energy_drift"]`` is a
    column as a numpy array, ``of(method)`` the cells of a method. ``growths``: a list of :class:`Growth`. ``lost``: what moved
    further than is claimed, in words. ``passed``: whether nothing did. ``h0``: the step that experiments share, 0.2 over
    the largest rate of the field. ``steps``: those of the long run. ``complete``: whether it came to its end.
    """

    def __init__(self, name: str, steps: int, found: dict[str, Any]) -> None:
        self.name = name
        self.steps = steps
        self.h0: float = found["step"]
        self.cells = [StressCell(**cell) for cell in found["cells"]]
        self.growths = [_growth(*growth) for growth in found["growths"]]
        self.lost: list[str] = found["losses"]
        self.complete: bool = found["complete"]
        self._table: list[list[str]] = found["table"]
        self._legend: str = found["legend"]

    @property
    def passed(self) -> bool:
        """Whether it came to its end, and nothing is lost."""
        return self.complete and not self.lost

    @property
    def methods(self) -> list[str]:
        """The methods, in order."""
        return list(dict.fromkeys(cell.method for cell in self.cells))

    def __getitem__(self, name: str) -> Any:
        if not isinstance(name, str):
            raise TypeError(f"columns have names, not {name!r}; experiments are in `cells`")
        if name not in StressCell._fields:
            raise KeyError(f"no column {name!r}{among(name, StressCell._fields)}")
        return np.array([getattr(cell, name) for cell in self.cells])

    def __len__(self) -> int:
        return len(self.cells)

    def of(self, method: str) -> list[StressCell]:
        """The experiments of a method."""
        cells = [cell for cell in self.cells if cell.method == method]
        if not cells:
            raise KeyError(f"no experiments of {method!r}{among(method, self.methods)}")
        return cells

    def _title(self) -> str:
        early = "" if self.complete else " (interrupted)"
        return (
            f"{self.name}{early}: {len(self)} experiments, h0 = {self.h0:.3g}, {self.steps} steps of the long run at h0; "
            f"{len(self.lost)} lost"
        )

    def __repr__(self) -> str:
        """A table: a line for each method."""
        legend = (
            "m of n: m of the n experiments were kept, with no claimed invariant beyond its round-off bound and no step\n"
            "refused; drifts are relative to the size of the terms\ngrows: the last tenth of the run over the first\n"
        )
        text = f"{self._title()}\n\n{_core.columns(self._table)}\n{legend}{self._legend}"
        return text + "".join(f"lost: {loss}\n" for loss in self.lost)

    def plot(self, *, show: bool = False) -> Any:
        """Draws a map of all experiments with matplotlib; returns the figure."""
        figure = new_figure(self._size(), "plot()")
        self._draw(figure)
        return shown(figure, show)

    def _columns(self) -> list[tuple[str, str, float]]:
        return list(dict.fromkeys((cell.experiment, cell.name, cell.value) for cell in self.cells))

    def _size(self) -> tuple[float, float]:
        return 4 + 0.22 * len(self._columns()), 2.4 + 0.25 * len(self.methods)

    def _draw(self, figure: Any) -> None:
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        columns = {key: place for place, key in enumerate(self._columns())}
        rows = {method: place for place, method in enumerate(self.methods)}
        drifts = np.full((len(rows), len(columns)), np.nan)
        others = np.full((len(rows), len(columns)), np.nan)
        kinds = list(_COLOURS)
        for cell in self.cells:
            at = rows[cell.method], columns[cell.experiment, cell.name, cell.value]
            if cell.outcome == "kept":
                drifts[at] = math.log10(max(cell.energy_drift, 1e-16))
            else:
                others[at] = kinds.index(cell.outcome)
        axes = figure.subplots()
        mesh = axes.pcolormesh(drifts, cmap="viridis_r", vmin=-16, vmax=0, edgecolors="w", lw=0.5)
        palette = ListedColormap([_COLOURS[kind] for kind in kinds])
        axes.pcolormesh(
            others, cmap=palette, vmin=-0.5, vmax=len(kinds) - 0.5, edgecolors="w", lw=0.5
        )
        axes.set_yticks(np.arange(len(rows)) + 0.5, list(rows), fontsize=8)
        axes.set_xticks(np.arange(len(columns)) + 0.5, [_factor(key) for key in columns])
        axes.tick_params(axis="x", rotation=90, labelsize=7)
        axes.invert_yaxis()
        groups: dict[tuple[str, str], list[int]] = {}
        for (experiment, name, _), place in columns.items():
            groups.setdefault((experiment, name), []).append(place)
        for (experiment, name), places in groups.items():
            axes.text(
                np.mean(places) + 0.5,
                -0.2,
                _group(experiment, name),
                ha="center",
                va="bottom",
                fontsize=7,
                rotation=0 if len(places) > 4 else 45,
            )
            axes.axvline(places[0], color="k", lw=0.8)
        bar = figure.colorbar(mesh, ax=axes)
        bar.set_label("log10 of energy drift", fontsize=8)
        words = {
            "lost": "a claimed invariant is lost",
            "stopped": "stopped with a message",
            "domain": "nothing to integrate",
        }
        patches = [Patch(color=_COLOURS[kind], label=words[kind]) for kind in kinds]
        figure.legend(
            handles=patches, loc="outside lower center", ncols=len(kinds), fontsize=8, frameon=False
        )
        figure.suptitle(
            f"{self.name}: what methods do at their limits, h0 = {self.h0:.3g}", fontsize=10
        )

    def _repr_html_(self) -> str:
        head, *rows = self._table
        losses = table(["what is lost"], [[loss] for loss in self.lost]) if self.lost else ""
        picture = image(self._draw, self._size(), "methods at their limits") if self.cells else ""
        return page(self._title(), table(head, rows), losses, picture)


def _factor(key: tuple[str, str, float]) -> str:
    value = key[2]
    return f"{value:g}" if value == 0 or 1 <= value < 1e4 else f"{value:.0e}"


def _group(experiment: str, name: str) -> str:
    word = EXPERIMENTS[experiment]
    return f"{name} {word}" if word == "times" else word
