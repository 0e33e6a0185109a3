"""A run that is made again for states between its rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Array, floats, number

if TYPE_CHECKING:
    from ._system import System

__all__ = ["Again"]


class Again:
    """What was asked of a run, and the span that it came through."""

    def __init__(self, system: System, asked: dict[str, Any], span: tuple[float, float]) -> None:
        self.system = system
        self.asked = asked
        self.span = span

    def at(self, times: Any) -> Array:
        """The states at these times, of shape (…, n) for times of shape (…)."""
        given = np.asarray(times)
        if given.dtype.kind in "UO":
            given = np.array([number(time, "a time") for time in given.ravel()]).reshape(
                given.shape
            )
        wanted = floats(given, "times")
        start, end = self.span
        low, high = min(self.span), max(self.span)
        outside = wanted[~((low <= wanted) & (wanted <= high))]
        if outside.size:
            time = float(outside.flat[0])
            raise ValueError(
                f"t = {time!r} is outside the run, from {start!r} to {end!r}; "
                "give times between these, or make a longer run"
            )
        order, places = np.unique(wanted, return_inverse=True)
        if end < start:
            order, places = order[::-1], len(order) - 1 - places
        found = self.system._core.at(self.asked, order.tolist())
        if len(found) < len(order):
            raise ValueError(
                f"the run stopped again before t = {order[len(found)]!r}; give earlier times"
            )
        states: Array = self.system._visible(found)
        return states[places.reshape(wanted.shape)]
