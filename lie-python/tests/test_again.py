"""A call that is made again with the same options is checked once: it gives and refuses what the first one does."""

from __future__ import annotations

import copy
import pickle
import signal
import time
import warnings
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

BODY: dict[str, Any] = {
    "algebra": "so(3)",
    "state": ["x", "y", "z"],
    "parameters": {"I1": {"value": 2, "positive": True}, "k": 1},
    "hamiltonian": "x^2/(2*I1) + y^2/2 + k*z^2/3",
    "initial": ["4/5", "1/10", "3/5"],
}
OPTIONS: list[dict[str, Any]] = [
    {"method": "rk4", "h": 0.1, "t": 1},
    {"method": "gauss16", "h": 0.1, "at": [0.25, 0.5]},
    {"method": "lie-midpoint", "h": "1/10", "t": 1.0, "every": 2},
    {"tol": 1e-9, "t": 1},
    {"method": "dopri5", "h": 0.5, "t": 1, "rtol": 1e-9, "group": "matrix"},
]
STARTS: list[Any] = [None, [0.8, 0.1, 0.6], (1, 0, 0.5), np.array([0.3, 0.2, 0.1]), {"x": 1, "y": 2, "z": 3}]  # fmt: skip


def known(system: lp.System, options: dict[str, Any]) -> bool:
    """Whether the core knows these options."""
    from liepoisson._system import _OPTIONS

    values = tuple(options.get(name, False if name == "assess" else None) for name in _OPTIONS)
    return system._core.again(values, None, {}) is not None


def test_words_of_the_command_are_remembered_as_arguments() -> None:
    for words in ({"step": 0.05, "until": 3}, {"until": 2}, {"step": 0.2}, {"initial": [0.1, 0.2, 0.3]}):
        system, fresh = (lp.System({**BODY, "run": {"step": 0.01, "until": 1}}) for _ in range(2))
        system.run("rk4", **words)
        again, first = system.run("rk4"), fresh.run("rk4")
        assert (again.step, again.t[-1]) == (first.step, first.t[-1]) == (0.01, 1)
        assert np.array_equal(again.mu, first.mu)
        once, more = (system.run("rk4", **words) for _ in range(2))
        assert np.array_equal(once.mu, more.mu) and not np.array_equal(once.mu[-1], first.mu[-1])


@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("start", range(len(STARTS)))
def test_the_bits_are_those_of_the_first_call(options: dict[str, Any], start: int) -> None:
    x0 = STARTS[start]
    system = lp.System(BODY)
    assert not known(system, options)
    system.run(**options, x0=[0.1, 0.2, 0.3], k=3)
    assert known(system, options)
    for named in ({}, {"k": 2.5}, {"k": 2, "I1": 1}):
        # the control: another system, which has seen no call
        first = lp.System(BODY).run(**options, x0=x0, **named)
        again = system.run(**options, x0=x0, **named)
        for name in ("t", "mu", "energy"):
            assert np.array_equal(getattr(first, name), getattr(again, name)), name
        assert first.casimirs.keys() == again.casimirs.keys()
        assert all(np.array_equal(first.casimirs[c], again.casimirs[c]) for c in first.casimirs)
        done = ("method", "step", "steps", "name", "coordinates")
        assert all(getattr(first, name) == getattr(again, name) for name in done)
        if options.get("group"):
            assert np.array_equal(first.group, again.group)
        times = [0.1, 0.43] if "at" not in options else [0.1, 0.3]
        assert np.array_equal(first.at(times), again.at(times))
        assert np.array_equal(pickle.loads(pickle.dumps(again)).at(times), first.at(times))


def test_mistakes_are_those_of_the_first_call() -> None:
    system = lp.System(BODY, hamiltonian="x^2/(2*I1) + log(y)/2 + k*z^2/3", initial=[1, 1, 1])
    options: dict[str, Any] = {"method": "rk4", "h": 0.01, "t": 0.02}
    system.run(**options)
    assert known(system, options)
    for given in (
        {"x0": [1, -1, 0]},
        {"x0": [1, float("nan"), 0]},
        {"x0": [1, 2]},
        {"x0": [1, True, 2]},
        {"x0": [[1, 2, 3]]},
        {"I1": -1},
        {"I1": float("inf")},
        {"J1": 1},
        {"k": True},
        {"h": True},
        {"every": 1.0},
        {"t": float("nan")},
    ):
        with pytest.raises((TypeError, ValueError)) as again:
            system.run(**{**options, **given})
        fresh = copy.copy(system)
        with pytest.raises((TypeError, ValueError)) as first:
            fresh.run(**{**options, **given})
        assert str(again.value) == str(first.value) and again.type is first.type, given


def test_true_is_not_one() -> None:
    system = lp.System(BODY)
    system.run("rk4", h=1, t=1)
    with pytest.raises(TypeError, match="h must be a number"):
        system.run("rk4", h=True, t=1)
    assert len(system.run("rk4", h=1.0, t=1.0)) == 2


def test_what_changes_afterwards_does_not_change_a_run() -> None:
    system = lp.System(BODY)
    times, start = [0.25, 0.5], np.array([0.8, 0.1, 0.6])
    system.run("rk4", h=0.1, at=times)
    run = system.run("rk4", h=0.1, at=times, x0=start)
    expected = lp.System(BODY).run("rk4", h=0.1, at=[0.25, 0.5], x0=[0.8, 0.1, 0.6]).at(0.3)
    start[:] = 0
    times.clear()
    assert np.array_equal(run.at(0.3), expected)


def test_steps_that_fail_and_warnings_come_again() -> None:
    system = lp.System(BODY, hamiltonian="x^2/2 + exp(y)*z + 1/(x - z)", initial=[1, 0.2, 0.3])
    stopped = []
    for _ in range(2):
        with pytest.raises(lp.IntegrationError) as caught:
            system.run("lie-midpoint", h=4, t=400)
        stopped.append((str(caught.value), caught.value.partial.mu.tobytes()))
    assert stopped[0] == stopped[1]
    pendulum = lp.System(
        poisson=["{q, p} = -1"],
        state=["q", "p"],
        hamiltonian="p^2/2 - cos(q)",
        initial=[1, 0],
    )
    said = []
    for _ in range(2):
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            pendulum.run("rk4", h=0.1, t=1)
        said.append([str(warning.message) for warning in heard])
    assert said[0] == said[1] and "backwards in time" in said[0][0]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer")
def test_a_long_run_after_brief_ones_hears_ctrl_c() -> None:
    system = lp.System(BODY)
    options: dict[str, Any] = {"method": "rk4", "h": 0.1, "every": 10**6}
    for _ in range(2):
        system.run(**options, t=1)
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    begun = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            system.run(**options, t=1e12)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begun < 30
    # it goes on as before
    assert len(system.run(**options, t=1)) == 2
