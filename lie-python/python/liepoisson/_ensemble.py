"""What an ensemble has saved."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ._arguments import Array
from ._pictures import page, table

__all__ = ["Ensemble", "MemberOccurrences"]

#: Failures that a notebook shows.
_SHOWN = 10


class MemberOccurrences(NamedTuple):
    """When an event happened to members, and their states there, in order of the members and of time.

    ``member``: their numbers, shape (k,). ``t``: the times, shape (k,). ``mu``: the states, shape (k, n).
    """

    member: Any
    t: Array
    mu: Array


class Part(NamedTuple):
    """What members gave.

    ``stops``: of each the event that ended it, by its place in the declaration, -1 where none did; ``stop_times``: when. ``events``:
    members, which of the declared events, times and states, where they are kept.
    """

    t: Array
    states: Array
    failures: list[tuple[int, float, str]]
    note: str | None
    stops: Any
    stop_times: Array
    events: tuple[Any, ...]

    def recorded(
        self, names: list[str], visible: Callable[[Array], Array], kept: bool
    ) -> dict[str, Any]:
        """What events did, by their names."""
        member, which, times, states = self.events
        states = visible(states)
        found = {}
        for place, name in enumerate(names if kept else []):
            own = which == place
            found[name] = MemberOccurrences(member[own], times[own], states[own])
        # -1 is the last one
        stopped = np.array([*names, ""])[self.stops]
        return {"stopped": stopped, "stop_times": self.stop_times, "events": found}


class Ensemble:
    """Many trajectories.

    ``mu``: the final states, shape (m, n), or with ``every`` or ``at`` all that were saved, shape (m, rows, n); what a failed
    member did not reach is not a number, nor is what comes behind an event that ended one. ``t``: the times of the rows, shape (rows,).
    ``failures``: (member, time, reason).
    ``stopped``: of each member the event that ended it, shape (m,), empty where none did; ``stop_times``: when, not a number where none
    did. ``events``: with ``events=True`` all declared events by name, each with ``.member``, ``.t`` and ``.mu``.
    ``kept``: what a projection behind each step kept, by name; such steps are no Poisson maps.
    """

    def __init__(
        self,
        mu: Array,
        t: Array,
        failures: list[tuple[int, float, str]],
        kept: tuple[str, ...] = (),
        *,
        stopped: Any = None,
        stop_times: Array | None = None,
        events: dict[str, MemberOccurrences] | None = None,
    ) -> None:
        self.mu = mu
        self.t = t
        self.failures = failures
        self.kept = kept
        self.stopped = np.full(len(mu), "") if stopped is None else stopped
        self.stop_times: Array = np.full(len(mu), np.nan) if stop_times is None else stop_times
        self.events = {} if events is None else events

    def __len__(self) -> int:
        return len(self.mu)

    def __repr__(self) -> str:
        rows = f" at {len(self.t)} times" if self.mu.ndim == 3 else ""
        kept = f", {', '.join(self.kept)} kept by a projection" if self.kept else ""
        ended = np.count_nonzero(self.stopped != "")
        stopped = f", {ended} ended by events" if ended else ""
        return f"<{len(self.mu)} members{rows}{stopped}, {len(self.failures)} failed{kept}>"

    def _repr_html_(self) -> str:
        rows = [
            (str(member), f"{time:g}", reason) for member, time, reason in self.failures[:_SHOWN]
        ]
        failed = table(["member", "time", "why it failed"], rows) if rows else ""
        more = len(self.failures) - len(rows)
        return page(repr(self).strip("<>"), failed, f"<p>… and {more} more</p>" if more else "")
