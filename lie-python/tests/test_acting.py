"""What acts beside the Hamiltonian: forces and their work, inputs from functions and arrays, noise and its seed."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

START = [0.8, 0.1, 0.6]


def wheel(**more: Any) -> lp.System:
    return lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        hamiltonian="x^2/4 + y^2/3 + z^2/2",
        inputs={"u": {"default": 0, "sampling": 0.1}},
        forces={"x": "u"},
        initial=START,
        **more,
    )


def spin(temperature: float = 0.3) -> lp.System:
    return lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"T": temperature},
        hamiltonian="z",
        dissipation=[{"kind": "double-bracket", "strength": 1, "temperature": "T"}],
        initial=[0.6, 0, 0.8],
    )


def test_friction_is_work() -> None:
    system = lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        hamiltonian="x^2/4 + y^2/3 + z^2/2",
        forces={"x": "-x/5", "y": "-y/5", "z": "-z/5"},
        initial=START,
    )
    run = system.run("gauss4", h=0.1, t=10)
    # every component decays alike, and the energy twice as fast
    assert np.allclose(run.energy, run.energy[0] * np.exp(-0.4 * run.t), rtol=1e-12 * 1e6)
    assert np.abs(run.energy - run["work"] - run.energy[0]).max() < 1e-14
    assert run["work"][-1] < -0.1


def test_a_check_says_what_acts() -> None:
    found = wheel(observables={"size": "x^2 + y^2 + z^2"}).check()
    assert [what for what, _ in found.acting] and "u" in str(found.acting)
    assert [casimir.kept for casimir in found.casimirs] == [False]
    assert found.observables.keys() == {"size"} and "changed by what acts" in repr(found)
    damped = spin().check()
    assert [casimir.kept for casimir in damped.casimirs] == [True]


def test_a_controller_closes_the_loop() -> None:
    asked: list[tuple[float, float]] = []

    def damper(t: float, mu: Any, g: Any) -> float:
        assert g is None
        asked.append((t, mu[0]))
        return -2 * mu[0]

    run = wheel().run("gauss6", h=0.05, t=5, inputs={"u": damper})
    assert [round(t, 9) for t, _ in asked] == [round(0.1 * k, 9) for k in range(len(asked))]
    assert len(asked) in (50, 51)
    # the same values as an array give the same bits
    table = [[t, -2 * x] for t, x in asked]
    again = wheel().run("gauss6", h=0.05, t=5, inputs={"u": table})
    assert np.array_equal(run.mu, again.mu) and np.array_equal(run["u"], again["u"])
    free = wheel().run("gauss6", h=0.05, t=5)
    assert run.energy[-1] < 0.9 * free.energy[-1] and abs(free["u"]).max() == 0
    assert np.abs(run.energy - run["work"] - run.energy[0]).max() < 1e-13


def test_a_controller_sees_the_group_element() -> None:
    seen: list[Any] = []

    def controller(t: float, mu: Any, g: Any) -> float:
        seen.append(g)
        return 0.1

    run = wheel().run("gauss6", h=0.05, t=1, group="matrix", inputs={"u": controller})
    assert all(np.allclose(g @ g.T, np.eye(3), atol=1e-13) and g.shape == (3, 3) for g in seen)
    assert np.allclose(seen[0], np.eye(3)) and not np.allclose(seen[-1], np.eye(3))
    assert run.group is not None and np.allclose(seen[5], run.group[10].reshape(3, 3), atol=1e-13)


def test_what_a_controller_raises_is_raised() -> None:
    def broken(t: float, mu: Any, g: Any) -> float:
        if t > 0.45:
            raise RuntimeError("no signal")
        return 0.0

    with pytest.raises(RuntimeError, match="no signal"):
        wheel().run("gauss6", h=0.05, t=5, inputs={"u": broken})
    for inputs, error, says in [
        ({"v": broken}, Exception, "inputs are u"),
        ([1, 2], TypeError, "dictionary"),
        ({"u": [[0, 1], [0, 2]]}, ValueError, "ascend"),
        ({"u": [1, 2, 3]}, ValueError, "shape"),
    ]:
        with pytest.raises(error, match=says):
            wheel().run("gauss6", h=0.05, t=5, inputs=inputs)


def test_noise_is_told_by_seed_and_member() -> None:
    one = spin().run("lie-midpoint", h=0.1, t=5, seed=3)
    assert one.seed == 3 and spin().run("lie-midpoint", h=0.1, t=5).seed == 1
    assert np.array_equal(one.mu, spin().run("lie-midpoint", h=0.1, t=5, seed=3).mu)
    assert not np.array_equal(one.mu, spin().run("lie-midpoint", h=0.1, t=5, seed=4).mu)
    assert np.abs((one.mu**2).sum(axis=1) - 1).max() < 1e-13
    with pytest.raises(Exception, match="noise"):
        spin().run("lie-midpoint", tol=1e-6, t=5)
    with pytest.raises(Exception, match=r"temperature|T"):
        spin(-1.0).run("lie-midpoint", h=0.1, t=5)


def test_members_have_the_same_noise_whoever_makes_them() -> None:
    starts = np.tile([0.6, 0, 0.8], (12, 1))
    asked: dict[str, Any] = {"h": 0.1, "t": 2, "seed": 7}
    alone = spin().ensemble(starts, "gauss4", threads=1, **asked).mu
    assert len({row.tobytes() for row in alone}) == 12
    assert np.array_equal(alone, spin().ensemble(starts, "gauss4", threads=2, **asked).mu)
    with ThreadPoolExecutor(2) as executor:
        shares = spin().ensemble(starts, "gauss4", executor=executor, **asked).mu
    assert np.array_equal(alone, shares)
    asked["seed"] = 8
    assert not np.array_equal(alone, spin().ensemble(starts, "gauss4", threads=1, **asked).mu)
    assert pickle.loads(pickle.dumps(spin())).run("gauss4", h=0.1, t=1).seed == 1


def test_a_thermal_spin_has_the_mean_of_langevin() -> None:
    starts = np.tile([0.6, 0, 0.8], (4000, 1))
    for temperature in (0.5, 2.0):
        ends = spin(temperature).ensemble(starts, "gauss4", h=0.1, t=8, seed=5).mu
        expected = temperature - 1 / np.tanh(1 / temperature)
        error = ends[:, 2].std() / np.sqrt(len(ends))
        assert abs(ends[:, 2].mean() - expected) < 4 * error + 0.002, temperature
        assert abs(ends[:, 2].mean() + 1) > 10 * error, "the control: where it would be without noise"
