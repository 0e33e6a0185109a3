"""Ensembles cut into shares for the workers of an executor."""

from __future__ import annotations

import functools
import hashlib
import json
import os
import pathlib
import queue
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import Array, Progress
from ._ensemble import Ensemble, Part
from ._errors import LostShares

#: The most shares where nobody says how many, and the fewest members of each.
SHARES, FEWEST = 64, 64


class Work(NamedTuple):
    """What a share is cut from."""

    text: str
    table: Array
    starts: Array
    asked: dict[str, Any]
    threads: int
    events: bool

    def share(self, some: range) -> Work:
        rows = slice(some.start, some.stop)
        table = self.table if len(self.table) == 1 else self.table[rows]
        # each member has the noise of its number
        asked = {**self.asked, "stream": some.start} if "seed" in self.asked else self.asked
        return self._replace(table=table, starts=self.starts[rows], asked=asked)

    def digest(self, shares: int) -> str:
        """Tells it from all others."""
        parts = (_core.__version__, self.text, sorted(self.asked.items()), self.table.shape, shares)
        found = hashlib.sha256(repr((*parts, self.starts.shape, self.events)).encode())
        found.update(np.ascontiguousarray(self.table).tobytes())
        found.update(np.ascontiguousarray(self.starts).tobytes())
        return found.hexdigest()[:16]


#: The arrays of events in the file of a share.
_EVENTS = ("event_members", "event_names", "event_times", "event_states")

#: The shares of the last ensemble that lost some, for the call that asks for the same again.
_kept: dict[str, dict[int, Part]] = {}


@functools.lru_cache(maxsize=4)
def _system(text: str) -> _core.Core:
    return _core.Core(text)


def _members(work: Work) -> tuple[Part | None, Exception | None]:
    """What a worker does. That members cannot be run is an answer; what is raised has happened to the worker."""
    try:
        core = _system(work.text)
        # what came over a network may lie across the places of numbers
        table, starts = (
            np.require(array, requirements=["A", "C"]) for array in (work.table, work.starts)
        )
        options = (work.threads, work.events)
        return Part(*core.ensemble(table, starts, work.asked, options, None)), None
    except Exception as error:  # noqa: BLE001
        return None, error


def cut(members: int, shares: int | None) -> list[range]:
    """So many shares, or a number that depends on nothing but the members."""
    count = min(SHARES, max(1, members // FEWEST)) if shares is None else shares
    count = max(1, min(count, members))
    bounds = [members * k // count for k in range(count + 1)]
    return [range(*pair) for pair in zip(bounds, bounds[1:])]


def gathered(
    work: Work,
    executor: Any,
    shares: int | None,
    folder: str | os.PathLike[str] | None,
    progress: Progress | None,
) -> Part:
    """All shares by the workers of an executor; those that a call before has left are not done again."""
    ranges = cut(len(work.starts), shares)
    digest = work.digest(len(ranges))
    files = [_file(folder, digest, k, len(ranges)) for k in range(len(ranges))]
    done = dict(_kept.get(digest, {}))
    done.update({k: part for k, path in enumerate(files) if (part := _load(path)) is not None})
    missing = {k: work.share(some) for k, some in enumerate(ranges) if k not in done}
    told = sum(len(ranges[k]) for k in done)
    why: BaseException | None = None
    for number, answer in _answers(executor, missing):
        if isinstance(answer, BaseException):
            why = answer
            continue
        part, error = answer
        if error is not None:
            raise error
        done[number] = Part(*part)
        _save(files[number], done[number])
        told += len(ranges[number])
        if progress is not None:
            progress(told, len(work.starts), "members")
    lost = [some for k, some in enumerate(ranges) if k not in done]
    found = _joined(ranges, done, work.starts.shape[1])
    _kept.clear()
    if lost:
        if folder is None:
            _kept[digest] = done
        named = ", ".join(f"{some.start} to {some.stop - 1}" for some in lost)
        where = "kept" if folder is None else f"in {os.fspath(folder)}"
        raise LostShares(
            f"{len(lost)} of {len(ranges)} shares are missing, since their workers ended: members {named}\n"
            f"  help: the others are {where}: the same call, with an executor that works, does these alone",
            lost,
            Ensemble(
                found.states,
                found.t,
                found.failures,
                **found.recorded(_system(work.text).events, lambda states: states, work.events),
            ),
        ) from why
    return found


def _answers(executor: Any, shares: dict[int, Work]) -> Iterator[tuple[int, Any]]:
    """What each share gave, or what happened to its worker, in the order in which they end."""
    if all(hasattr(executor, name) for name in ("remote", "wait", "get")):
        yield from _of_ray(executor, shares)
        return
    ended: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
    futures = []
    try:
        for number, share in shares.items():
            try:
                future = executor.submit(_members, share)
            except RuntimeError as error:
                # the workers have ended already
                ended.put((number, error))
                continue
            futures.append(future)
            future.add_done_callback(lambda future, number=number: ended.put((number, future)))
        for _ in shares:
            number, future = ended.get()
            yield number, future if isinstance(future, Exception) else _answer(future)
    finally:
        for future in futures:
            future.cancel()


def _answer(future: Any) -> Any:
    """What a share gave, or what happened to its worker; a cancelled one is no Exception in all engines."""
    try:
        return future.result()
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # noqa: BLE001
        return error


def _of_ray(ray: Any, shares: dict[int, Work]) -> Iterator[tuple[int, Any]]:
    task = ray.remote(max_retries=3)(_members)
    waiting = {task.remote(share): number for number, share in shares.items()}
    try:
        while waiting:
            (reference, *_), _ = ray.wait(list(waiting), num_returns=1)
            number = waiting.pop(reference)
            try:
                answer = ray.get(reference)
            except Exception as error:  # noqa: BLE001
                answer = error
            yield number, answer
    finally:
        for reference in waiting:
            ray.cancel(reference)


def _file(
    folder: str | os.PathLike[str] | None, digest: str, number: int, shares: int
) -> pathlib.Path | None:
    if folder is None:
        return None
    os.makedirs(folder, exist_ok=True)
    return pathlib.Path(folder) / f"{digest}.{number + 1}-of-{shares}.npz"


def _load(path: pathlib.Path | None) -> Part | None:
    if path is None or not path.exists():
        return None
    with np.load(path) as file:
        failures, note = json.loads(str(file["said"]))
        failures = [(member, time, why) for member, time, why in failures]
        events = tuple(file[name] for name in _EVENTS)
        return Part(
            file["t"], file["states"], failures, note, file["stops"], file["stop_times"], events
        )


def _save(path: pathlib.Path | None, part: Part) -> None:
    """Writes a share as a whole or not at all."""
    if path is None:
        return
    said = np.array(json.dumps([part.failures, part.note]))
    draft = path.with_suffix(f".{os.getpid()}.new")
    try:
        with open(draft, "wb") as file:
            arrays = {"t": part.t, "states": part.states, "said": said, "stops": part.stops}
            events = dict(zip(_EVENTS, part.events))
            np.savez(file, **arrays, stop_times=part.stop_times, **events)
        os.replace(draft, path)
    finally:
        draft.unlink(missing_ok=True)


def _joined(ranges: list[range], done: dict[int, Part], width: int) -> Part:
    """All members, in order; of a share that is missing no number is one."""
    times = next((part.t for part in done.values()), np.zeros(0))
    count = ranges[-1].stop
    states, stop_times = np.full((count, len(times), width), np.nan), np.full(count, np.nan)
    stops = np.full(count, -1)
    failures = []
    for k, part in sorted(done.items()):
        some = slice(ranges[k].start, ranges[k].stop)
        states[some], stops[some], stop_times[some] = part.states, part.stops, part.stop_times
        failures += [(ranges[k].start + member, time, why) for member, time, why in part.failures]
    notes = (part.note for part in done.values() if part.note is not None)
    events = [
        (ranges[k].start + part.events[0], *part.events[1:]) for k, part in sorted(done.items())
    ]
    none = (np.zeros(0, int), np.zeros(0, int), np.zeros(0), np.zeros((0, width)))
    joined = tuple(np.concatenate(arrays) for arrays in zip(none, *events))
    return Part(times, states, failures, next(notes, None), stops, stop_times, joined)
