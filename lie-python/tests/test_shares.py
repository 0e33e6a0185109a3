"""Ensembles by executors: the same bits for every number of workers and shares, and after a worker was killed."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import sysconfig
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import Any

import liepoisson as lp
import numpy as np
import pytest
from liepoisson import _shares

STARTS = np.random.default_rng(2018).normal(size=(300, 3))
# some members of a method that iterates too little fail
HARD: dict[str, Any] = {"method": "gauss4", "h": 0.4, "t": 4, "every": 2, "max_iterations": 3}


def body() -> lp.System:
    return lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"a": 1},
        hamiltonian="a*x^2/2 + y^2/4 + z^2/6",
        initial=[0.8, 0.1, 0.6],
    )


def processes(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(workers, mp_context=get_context("spawn"))


def same(one: lp.Ensemble, other: lp.Ensemble) -> bool:
    bits = np.array_equal(one.mu, other.mu, equal_nan=True) and np.array_equal(one.t, other.t)
    ended = np.array_equal(one.stop_times, other.stop_times, equal_nan=True)
    ended = ended and np.array_equal(one.stopped, other.stopped)
    events = one.events.keys() == other.events.keys() and all(
        np.array_equal(mine, its)
        for name in one.events
        for mine, its in zip(one.events[name], other.events[name])
    )
    return bool(bits and one.failures == other.failures and ended and events)


def die(_: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


class Killing(ProcessPoolExecutor):
    """Processes of which one kills itself in the place of a share."""

    def __init__(self, which: int) -> None:
        super().__init__(2, mp_context=get_context("spawn"))
        self.which, self.count = which, 0

    def submit(self, task: Any, /, *arguments: Any, **named: Any) -> Future[Any]:
        self.count += 1
        return super().submit(die if self.count == self.which else task, *arguments, **named)


class Counting(ThreadPoolExecutor):
    """Threads that count the members of the shares that they do."""

    members = 0

    def submit(self, task: Any, /, work: Any, **named: Any) -> Future[Any]:
        self.members += len(work.starts)
        return super().submit(task, work, **named)


def test_the_bits_do_not_depend_on_workers_and_shares() -> None:
    a = np.linspace(1, 2, len(STARTS))
    expected = body().ensemble(STARTS, **HARD, a=a)
    assert 5 < len(expected.failures) < 200
    for executor, shares in [
        (ThreadPoolExecutor(1), 1),
        (ThreadPoolExecutor(3), 7),
        (processes(1), None),
        (processes(2), 3),
        (processes(4), 40),
    ]:
        with executor:
            found = body().ensemble(STARTS, **HARD, a=a, executor=executor, shares=shares)
            assert same(found, expected), (executor, shares)
    other = body().ensemble(STARTS + 1e-12, **HARD, a=a)
    assert not same(other, expected), "the control"


@pytest.mark.parametrize("kept", ["memory", "disk"])
def test_a_killed_worker_is_named_and_the_same_call_goes_on(
    kept: str, tmp_path: pathlib.Path
) -> None:
    folder = tmp_path / "shares" if kept == "disk" else None
    call: dict[str, Any] = {**HARD, "shares": 12, "folder": folder}
    expected = body().ensemble(STARTS, **HARD)
    with Killing(6) as pool, pytest.raises(lp.LostShares, match="members") as caught:
        body().ensemble(STARTS, **call, executor=pool)
    error = caught.value
    assert isinstance(error.__cause__, BrokenProcessPool)
    missing = [member for some in error.missing for member in some]
    assert 25 <= len(missing) <= 300 and f"{missing[0]} to " in str(error)
    assert set(range(125, 150)) <= set(missing), "the share that was killed"
    there = np.setdiff1d(np.arange(300), missing)
    assert np.array_equal(error.partial.mu[there, :1], expected.mu[there, :1], equal_nan=True)
    assert np.isnan(error.partial.mu[missing]).all()
    if kept == "disk":
        _shares._kept.clear()
        assert len(list(tmp_path.glob("shares/*.npz"))) == 12 - len(error.missing)
    with Counting(2) as pool:
        found = body().ensemble(STARTS, **call, executor=pool)
        assert same(found, expected) and pool.members == len(missing)
    # another call has nothing of it
    with Counting(2) as pool:
        body().ensemble(STARTS[::-1], **call, executor=pool)
        assert pool.members == 300


@pytest.mark.parametrize("rows", [{}, {"every": 10}])
def test_events_do_not_depend_on_workers_and_shares(
    rows: dict[str, Any], tmp_path: pathlib.Path
) -> None:
    events = {"fall": {"when": "x", "direction": -1, "stop": True}, "turn": {"when": "y"}}
    system = lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        hamiltonian="x^2/2 + y^2/4 + z^2/6",
        events=events,
    )
    call: dict[str, Any] = {"method": "gauss8", "h": 0.1, "t": 4, "events": True, **rows}
    expected = system.ensemble(STARTS, **call)
    assert 20 < np.count_nonzero(expected.stopped == "fall") < 280
    for folder in [None, tmp_path]:
        with processes(2) as workers:
            found = system.ensemble(STARTS, **call, executor=workers, shares=7, folder=folder)
        assert same(found, expected)
    # from the disk alone
    with Counting(1) as none:
        found = system.ensemble(STARTS, **call, executor=none, shares=7, folder=tmp_path)
    assert same(found, expected) and none.members == 0
    other = system.ensemble(STARTS + 1e-9, **call)
    assert not same(other, expected), "the control"


def test_mistakes_come_back_as_they_are() -> None:
    with processes(2) as pool:
        with pytest.raises(lp.MethodError, match="euler-arnold2"):
            body().ensemble(STARTS, "euler-arnold2", h=0.1, t=1, executor=pool)
        with pytest.raises(ValueError, match="away from"):
            body().ensemble(STARTS, "rk4", h=-0.1, t=1, executor=pool)
        said: list[tuple[int, int, str]] = []
        body().ensemble(
            STARTS,
            "rk4",
            h=0.1,
            t=1,
            executor=pool,
            shares=3,
            progress=lambda *now: said.append(now),
        )
        assert said == [(100, 300, "members"), (200, 300, "members"), (300, 300, "members")]
    with pytest.raises(TypeError, match="executor=ProcessPoolExecutor"):
        body().ensemble(STARTS, "rk4", h=0.1, t=1, shares=3)
    with pytest.raises(lp.LostShares):  # an executor that was shut down
        body().ensemble(STARTS, "rk4", h=0.1, t=1, executor=pool)


def test_arrays_from_a_network_need_not_be_aligned() -> None:
    bytes_ = np.zeros(8 * STARTS.size + 1, dtype=np.uint8)
    moved = bytes_[1:].view(np.float64).reshape(STARTS.shape)
    moved[:] = STARTS
    assert not moved.flags.aligned
    work = _shares.Work(
        body().text, np.ones((1, 1)), moved, {"method": "rk4", "h": 0.1, "t": 1.0}, 1, False
    )
    part, error = _shares._members(work)
    assert error is None and part is not None
    assert np.array_equal(part.states[:, 0], body().ensemble(STARTS, "rk4", h=0.1, t=1).mu)


def test_members_are_drawn_on_the_orbit() -> None:
    call: dict[str, Any] = {"method": "rk4", "h": 0.1, "at": [0], "members": 50}
    first = body().ensemble(**call).mu[:, 0]
    assert first.shape == (50, 3)
    assert np.allclose((first**2).sum(axis=1), 1.01, rtol=1e-14)
    assert 0.05 < np.abs(first - [0.8, 0.1, 0.6]).max() < 0.6
    assert np.array_equal(first, body().ensemble(**call, seed=1, spread=0.1).mu[:, 0])
    assert not np.array_equal(first, body().ensemble(**call, seed=2).mu[:, 0])
    everywhere = body().ensemble(**{**call, "members": 5000}, spread="orbit").mu[:, 0]
    assert np.abs(everywhere.mean(axis=0)).max() < 0.04
    parameters = np.linspace(1, 2, 50)
    assert np.array_equal(first, body().ensemble(**call, a=parameters).mu[:, 0])
    top = lp.System(
        algebra="se(3)", state=["a", "b", "c", "d", "e", "f"], hamiltonian="a^2 + b^2 + c^2 + f"
    )
    for wrong, kind, text in [
        (lambda: body().ensemble(STARTS, seed=1), TypeError, "members=1000"),
        (lambda: body().ensemble(STARTS, members=3), ValueError, "around one state"),
        (lambda: body().ensemble(members=0), ValueError, "members must be"),
        (lambda: body().ensemble(members=3, spread=-1), ValueError, "standard deviation"),
        (lambda: body().ensemble(members=3, seed=0.5), TypeError, "seed must be"),
        (lambda: body().ensemble(members=3, a=[1, 2]), ValueError, "there are 3 members"),
        (lambda: top.ensemble(members=3), TypeError, "x0 is missing"),
        (lambda: top.ensemble(np.ones(6), members=3, spread="orbit"), ValueError, "uniform"),
    ]:
        with pytest.raises(kind, match=text):
            wrong()


DASK = """
import sys
import numpy as np
from distributed import Client
from test_shares import HARD, STARTS, body, same

if __name__ == "__main__":
    with Client(n_workers=int(sys.argv[1]), threads_per_worker=1, dashboard_address=None) as client:
        found = body().ensemble(STARTS, **HARD, executor=client, shares=6)
    assert same(found, body().ensemble(STARTS, **HARD))
    print("the same bits")
"""


def test_dask(tmp_path: pathlib.Path) -> None:
    pytest.importorskip("distributed")
    script = tmp_path / "dask_shares.py"
    script.write_text(DASK)
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)}
    call = [sys.executable, str(script), "2"]
    ended = subprocess.run(
        call, check=False, env=environment, timeout=240, capture_output=True, text=True
    )
    assert ended.returncode == 0 and "the same bits" in ended.stdout, ended.stderr


def test_ray() -> None:
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        found = body().ensemble(STARTS, **HARD, executor=ray, shares=6)
        assert same(found, body().ensemble(STARTS, **HARD))
        with pytest.raises(lp.MethodError):
            body().ensemble(STARTS, "euler-arnold2", h=0.1, t=1, executor=ray)
    finally:
        ray.shutdown()


MPI = """
from mpi4py.futures import MPIPoolExecutor
from test_shares import HARD, STARTS, body, same

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        found = body().ensemble(STARTS, **HARD, executor=pool, shares=6)
    assert same(found, body().ensemble(STARTS, **HARD))
    print("the same bits")
"""


@pytest.mark.skipif(importlib.util.find_spec("mpi4py") is None, reason="mpi4py is not installed")
def test_mpi(tmp_path: pathlib.Path) -> None:
    beside = pathlib.Path(sysconfig.get_path("scripts")) / "mpirun"
    launcher = str(beside) if beside.exists() else shutil.which("mpirun")
    if launcher is None:
        pytest.skip("mpirun is not installed")
    script = tmp_path / "mpi_shares.py"
    script.write_text(MPI)
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)}
    call = [launcher, "-n", "3", sys.executable, "-m", "mpi4py.futures", str(script)]
    ended = subprocess.run(
        call, check=False, env=environment, timeout=120, capture_output=True, text=True
    )
    assert ended.returncode == 0 and "the same bits" in ended.stdout, ended.stderr
