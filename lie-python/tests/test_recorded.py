"""Integrals, observables and events of a run."""

import pickle
from typing import Any

import liepoisson as lp
import numpy as np
import pytest


def top(**more: Any) -> lp.System:
    keys: dict[str, Any] = {
        "name": "Top",
        "algebra": "se(3)",
        "state": ["m1", "m2", "m3", "g1", "g2", "g3"],
        "hamiltonian": "(m1^2 + m2^2)/2 + m3^2/1.2 + 2*g3",
        "integrals": ["spin = m3"],
        "observables": {
            "height": "g3",
            "phi": {"expression": "atan2(g2, g1)", "unwrap": True},
        },
        "initial": [0.3, 0.1, 2, 0.6, 0, 0.8],
    }
    return lp.System({**keys, **more})


def test_columns_have_their_names() -> None:
    system = top()
    assert system.quantities == ["spin", "height", "phi"]
    run = system.run("gauss6", h=0.05, t=20)
    assert np.array_equal(run["height"], run["g3"])
    assert np.array_equal(run["spin"], run.quantities["spin"])
    phi = run["phi"]
    assert np.abs(np.diff(phi)).max() < np.pi < np.abs(np.diff(np.arctan2(run["g2"], run["g1"]))).max()
    assert np.allclose(phi, np.unwrap(np.arctan2(run["g2"], run["g1"])), atol=1e-12)
    assert set(run.drift) == {"energy", "C1", "C2", "spin"}
    assert run.drift["spin"] < 1e-13
    # a second call with the same options goes another way
    assert np.array_equal(system.run("gauss6", h=0.05, t=20)["phi"], phi)
    assert run.events == {} and run.stopped is None
    with pytest.raises(KeyError, match="hight"):
        run["hight"]


def test_an_integral_that_is_none_is_refused() -> None:
    with pytest.raises(lp.DeclarationError) as caught:
        top(integrals=["tilt = m1"])
    assert caught.value.kind == "integral"
    assert "{tilt, H} = " in str(caught.value)


def test_events_have_times_and_states() -> None:
    events = {"low": {"when": "g2", "direction": -1}, "end": {"when": "t - 7.3", "stop": True}}
    system = top(events=events)
    run = system.run("gauss8", h=0.05, t=20)
    assert set(run.events) == {"low", "end"}
    low = run.events["low"]
    assert low.mu.shape == (len(low.t), 6) and len(low.t) >= 2
    assert np.abs(low.mu[:, 4]).max() < 1e-13
    assert run.stopped == "end"
    assert abs(run.t[-1] - 7.3) < 1e-14 and np.array_equal(run.mu[-1], run.events["end"].mu[0])
    # states at any times up to there
    assert np.allclose(run.at(low.t), low.mu, atol=1e-13)
    with pytest.raises(ValueError):
        run.at(8.0)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.events["low"].t, low.t)
    # scipy's way to the same times
    scipy = pytest.importorskip("scipy.integrate")

    def falls(t: float, mu: Any) -> float:
        return float(mu[4])

    falls.direction = -1  # type: ignore[attr-defined]
    start = np.array([0.3, 0.1, 2, 0.6, 0, 0.8])
    plain = top().function("vector_field")
    found = scipy.solve_ivp(
        lambda t, mu: plain(mu), (0, 7.3), start, method="DOP853", rtol=1e-12, atol=1e-13, events=falls
    )
    times = found.t_events[0]
    assert np.allclose(times[times > 1e-9], low.t, atol=1e-8)


def test_events_of_members_have_times_and_states() -> None:
    # whatever the moments of inertia, the norm falls as exp(-k t)
    keys: dict[str, Any] = {
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "parameters": {"k": 0.3},
        "hamiltonian": "x^2/2 + y^2/3 + z^2",
        "forces": {"x": "-k*x", "y": "-k*y", "z": "-k*z"},
    }
    events = {
        "low": {"when": "x^2 + y^2 + z^2 - 1/4", "direction": -1, "stop": True},
        "turn": {"when": "y"},
    }
    system = lp.System({**keys, "events": events})
    norms = 0.6 + 0.05 * np.arange(20)
    starts = norms[:, None] * np.array([2, 3, 6]) / 7
    expected = np.log(norms / 0.5) / 0.3
    ends = system.ensemble(starts, "gauss12", h=0.1, t=3)
    early = expected < 3
    assert 4 < early.sum() < 17 and ends.t.tolist() == [3.0] and ends.events == {}
    assert np.array_equal(ends.stopped, np.where(early, "low", ""))
    assert np.allclose(ends.stop_times[early], expected[early], rtol=0, atol=1e-12)
    assert np.isnan(ends.stop_times[~early]).all()
    assert np.allclose((ends.mu[early] ** 2).sum(axis=1), 0.25, atol=1e-13)
    assert f"{early.sum()} ended by events" in repr(ends)
    # all rows that were asked for, whoever came to them, and every event of each member
    rows = system.ensemble(starts, "gauss12", h=0.1, t=3, every=1, events=True)
    assert rows.mu.shape == (20, 31, 3)
    assert np.array_equal(np.isnan(rows.mu[:, -1, 0]), early)
    low, turn = rows.events["low"], rows.events["turn"]
    assert np.array_equal(low.member, np.flatnonzero(early))
    assert np.array_equal(low.t, ends.stop_times[early])
    assert np.array_equal(low.mu, ends.mu[early])
    assert np.all(np.diff(turn.member) >= 0) and np.abs(turn.mu[:, 1]).max() < 1e-13
    for member in (0, 19):
        alone = system.run("gauss12", h=0.1, t=3, x0=starts[member]).events["turn"]
        own = turn.member == member
        assert np.array_equal(turn.t[own], alone.t) and np.array_equal(turn.mu[own], alone.mu)
    again = pickle.loads(pickle.dumps(rows))
    assert np.array_equal(again.stopped, rows.stopped)
    # where all are ended, there are as many rows as before
    rows = system.ensemble(starts[:3], "gauss12", h=0.1, t=3, every=1)
    assert rows.mu.shape == (3, 31, 3) and np.isnan(rows.mu[:, -1]).all()
    plain = lp.System(keys).ensemble(starts, "gauss12", h=0.1, t=3)
    assert set(plain.stopped) == {""} and np.isnan(plain.stop_times).all()
    with pytest.raises(ValueError, match="declares no events"):
        lp.System(keys).ensemble(starts, "gauss12", h=0.1, t=3, events=True)
