"""What a run has saved."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._again import Again
from ._arguments import Array, among
from ._pictures import image, new_figure, page, shown, table
from ._sites import Sites
from ._spectra import Frequencies, frequencies_of

if TYPE_CHECKING:
    from ._system import System

__all__ = ["Occurrences", "Solution"]

#: Coordinates of a family that a picture shows.
_DRAWN = 12
#: Runs of so many steps are drawn by their rows alone.
_MOST_STEPS = 10_000
#: Points of a curve, at least, where rows are fewer; numbers of all curves together, at most.
_POINTS = 1000
_NUMBERS = 1_000_000
#: So many rows are dots on a curve that goes on between them.
_DOTS = 200


class Occurrences(NamedTuple):
    """When an event happened, and the states there.

    ``t``: the times, shape (k,). ``mu``: the states, shape (k, n).
    """

    t: Array
    mu: Array


class Solution:
    """What a run has saved, as numpy arrays.

    ``t``: the times, shape (m,). ``mu``: the states, shape (m, n). ``energy``: H at each row, shape (m,).
    ``casimirs``: a dictionary of arrays of shape (m,); ``quantities``: the same of declared integrals and observables. ``run["Pi1"]``,
    ``run["energy"]`` and ``run["C1"]`` are columns.
    ``method``, ``step``, ``steps``: what was done.
    """

    def __init__(self, system: System, made: tuple[Any, ...], call: Any) -> None:
        self.t: Array
        self.energy: Array
        self.method: str
        self.step: float
        self.steps: int
        self.t, mu, self.energy, casimirs, self.method, self.step, self.steps, self._span, _ = made
        self.mu: Array = system._visible(mu)
        # what is seldom looked at is made of these when it is
        self._system = system
        self._call = call
        self._casimirs: Array = casimirs
        self._quantities: Array | None = None
        #: The declared events by name; each has ``.t``, the times, and ``.mu``, the states there.
        self.events: dict[str, Occurrences] = {}
        #: The event that ended the run, by its name.
        self.stopped: str | None = None
        #: The error at the end relative to the state, where it was asked for; not a number where it cannot be told.
        self.error: float | None = None
        #: ``"reversible"`` where the size of steps follows the motion: they are reversible, and no Poisson maps. ``step`` is the first one then.
        self.density: str | None = None
        #: The seed of the noise, where there is some.
        self.seed: int | None = None
        #: The group element at each row, shape (m, s, s), or (m, 4) of quaternions, (m, 3) of Euler angles, where it was asked for.
        self.group: Array | None = None

    @cached_property
    def name(self) -> str:
        """The name of the system."""
        return self._system.name

    @cached_property
    def coordinates(self) -> list[str]:
        """The names of the columns of ``mu``, of a family those of all sites."""
        core = self._system._core
        if core.family:
            return core.names_of_sites(self._again.asked["parameters"])
        return self._system.coordinates

    @cached_property
    def casimirs(self) -> dict[str, Array]:
        """The Casimirs by name, each of shape (m,)."""
        names = self._system.casimirs
        return {name: self._casimirs[:, place] for place, name in enumerate(names)}

    @cached_property
    def quantities(self) -> dict[str, Array]:
        """The declared first integrals and observables by name, each of shape (m,); angles that unwrap without their jumps."""
        names = self._system.quantities
        values = self._quantities
        if values is None:
            return {}
        return {name: values[:, place] for place, name in enumerate(names)}

    @cached_property
    def kept(self) -> tuple[str, ...]:
        """What a projection behind each step kept: ``energy`` and Casimirs by name, as ``keep`` asked for.

        Such steps are no Poisson maps.
        """
        return tuple(self._system._core.kept(self._again.asked))

    @cached_property
    def _again(self) -> Again:
        return self._system._again(self._call, self._span)

    @cached_property
    def _sites(self) -> Sites | None:
        family = self._system._core.family
        return Sites(self._system, self._again.asked["parameters"]) if family else None

    def __getitem__(self, name: str) -> Array:
        if not isinstance(name, str):
            raise TypeError(
                f"columns have names, not {name!r}; rows are those of `t` and `mu`, such as run.mu[0]"
            )
        if name in self.coordinates:
            column: Array = self.mu[:, self.coordinates.index(name)]
            return column
        if name == "t":
            return self.t
        if name == "energy":
            return self.energy
        if name in self.casimirs:
            return self.casimirs[name]
        if name in self.quantities:
            return self.quantities[name]
        known = ["t", *self.coordinates, "energy", *self.casimirs, *self.quantities]
        raise KeyError(f"no column {name!r}{among(name, known)}")

    def __len__(self) -> int:
        return len(self.t)

    def at(self, times: Any) -> Array:
        """The states at any times from the start of the run to its end, saved or not: shape (…, n) for times of shape (…).

        A state between two steps is reached by one shorter step from the one before, as the rows of ``run(…, at=…)`` are: it has
        the order of the method and lies on its orbit. The run is made again for that, up to the last of the times, or with
        ``tol`` to its end: give all times in one call. At the times of rows that are steps, the bits are those of ``mu``.

        >>> from liepoisson import System
        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> run = body.run(tol=1e-9, t=10, x0=[0.8, 0.1, 0.6])
        >>> run.at(2.5).shape, run.at([0, 2.5, 10]).shape
        ((3,), (3, 3))

        Errors: :class:`ValueError` for a time outside the run.
        """
        return self._again.at(times)

    def frequencies(self, name: str, *, count: int = 5, window: int = 2) -> Frequencies:
        """The strongest lines of a column, such as ``"x"`` or ``"energy"``, by refined Fourier analysis, ``count`` of them at most.

        The rows must be at equal distances. ``window`` is the power of the window of Hann, from 0 to 5: a larger one keeps lines that are not
        asked for from disturbing the others, and tells neighbours apart after a longer time.

        >>> from liepoisson import System
        >>> swing = System(poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 + 2*q^2")
        >>> line = swing.run("gauss6", h=0.05, t=100, x0=[1, 0]).frequencies("q", count=1).lines[0]
        >>> round(line.frequency, 7), round(line.amplitude, 7), line.drift < 1e-9
        (2.0, 1.0, True)

        Errors: :class:`ValueError` where the rows are at no equal distances, or fewer than 16, or the column is not finite at one, :class:`KeyError` for no column.
        """
        return frequencies_of(self.t, np.ascontiguousarray(self[name]), count, window)

    def _curve(self) -> tuple[Array, Array]:
        """Times and states for a picture: between the rows too, where these are few."""
        rows, width = len(self.t), self.mu.shape[1]
        parts = -(-_POINTS // max(rows - 1, 1))
        few = rows > 1 and parts > 1 and self.steps <= _MOST_STEPS
        if not few or parts * rows * width > _NUMBERS:
            return self.t, self.mu
        places = np.arange((rows - 1) * parts + 1) / parts
        times = np.interp(places, np.arange(rows), self.t)
        return times, self.at(times)

    @property
    def sites(self) -> Array:
        """The states of a family by sites: shape (m, N, coordinates), of a lattice (m, N, M, coordinates) or (m, L, N, M, coordinates)."""
        if self._sites is None:
            raise AttributeError(f"{self.name} is no family: its states are in `mu`")
        return self._sites.of(self.mu)

    def _reference(self, values: Array) -> float | None:
        """What a change is divided by: the first value; nothing where that is only round-off beside the state."""
        if not len(values):
            return None
        scale = float(np.max(np.abs(self.mu))) if self.mu.size else 0.0
        first = abs(float(values[0]))
        return first if first > 1e-12 * min(scale, scale * scale) else None

    def _invariants(self) -> list[tuple[str, Array]]:
        """What ought to be constant, by name."""
        # where H depends on the time, or more than H acts, the energy is no constant
        driven = self._system._core.time() is not None or "work" in self.quantities
        energy = [] if driven else [("energy", self.energy)]
        conserved = [name for name, kept in self._system._core.quantities if kept]
        integrals = [(name, self.quantities[name]) for name in conserved if name in self.quantities]
        return [*energy, *self.casimirs.items(), *integrals]

    @property
    def drift(self) -> dict[str, float]:
        """The largest change of energy, Casimirs and first integrals over the rows, relative to their first values; of the energy only where H
        does not depend on the time.

        Where the first value is 0, or only round-off beside the state, the change itself.
        """
        found = {}
        for name, values in self._invariants():
            change = float(np.max(np.abs(values - values[0]))) if len(values) else 0.0
            found[name] = change / (self._reference(values) or 1.0)
        return found

    def __repr__(self) -> str:
        absolute = {
            name: " (absolute)" if self._reference(values) is None else ""
            for name, values in self._invariants()
        }
        drift = ", ".join(
            f"{name} {value:.1e}{absolute[name]}" for name, value in self.drift.items()
        )
        end = f"t = {self.t[-1]:g}" if len(self.t) else "nothing"
        kept = f"; {', '.join(self.kept)} kept by a projection" if self.kept else ""
        errors = f"; largest relative error: {drift}" if drift else ""
        return (
            f"<{self.name}, {self.method}, step {self.step:g}: {len(self.t)} rows to {end}{kept}{errors}>"
        )

    def plot(self, *, show: bool = False) -> Any:
        """Draws the components and the errors of the invariants with matplotlib; returns the figure.

        Where rows are few, the components are curves through states between them (:meth:`at`), and the rows are dots.
        """
        if not len(self.t):
            raise ValueError("there are no rows to draw")
        figure = new_figure((8, 6), "plot()")
        self._draw(figure)
        return shown(figure, show)

    def _draw(self, figure: Any) -> None:
        invariants = self._invariants()
        title = f"{self.name}, {self.method}, step {self.step:g}"
        if not invariants:
            axes = figure.subplots()
            self._draw_components(axes)
            axes.set_title(title)
            axes.set_xlabel("t")
            return
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
        self._draw_components(above)
        above.set_title(title)
        for name, values in invariants:
            scale = self._reference(values) or 1.0
            errors = np.maximum(np.abs(values - values[0]) / scale, 1e-17)
            below.semilogy(self.t, errors, label=name, linewidth=1)
        below.set_ylabel("relative error")
        below.set_xlabel("t")
        below.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)

    def _draw_components(self, axes: Any) -> None:
        drawn = len(self.coordinates) if self._sites is None else _DRAWN
        times, states = self._curve()
        dots = len(times) > len(self.t) and len(self.t) <= _DOTS
        for place, name in enumerate(self.coordinates[:drawn]):
            (line,) = axes.plot(times, states[:, place], label=name, linewidth=1)
            if dots:
                axes.plot(self.t, self[name], ".", color=line.get_color(), markersize=4)
        more = len(self.coordinates) - drawn
        if more > 0:
            axes.plot([], [], " ", label=f"… and {more} more")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)

    def _repr_html_(self) -> str:
        if not len(self):
            return page(repr(self))
        drift = [(name, f"{value:.2e}") for name, value in self.drift.items()]
        picture = image(self._draw, (8, 5), f"components and errors of {self.name}")
        errors = table(["invariant", "largest error"], drift) if drift else ""
        return page(repr(self).strip("<>"), errors, picture)
