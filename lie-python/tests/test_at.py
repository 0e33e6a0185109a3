"""States at any times of a run: order, bits, spans, mistakes, pictures."""

import pickle
from pathlib import Path
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

SPECS = Path(__file__).parents[2] / "specs"
START = [0.8, 0.1, 0.6]
# methods that choose their own steps, and the error that they have left
OWN_STEPS = {"dopri5": 1e-11, "taylor": 1e-12, "lie-taylor": 1e-12}


def body() -> lp.System:
    return lp.System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")


@pytest.fixture(scope="module")
def top() -> lp.System:
    return lp.load(SPECS / "se3_heavy_top.json")


def slope(top: lp.System, method: str, end: float, steps: list[int]) -> float:
    """The order of states at a time 0.4 of a step beyond a step, from the smallest errors above round-off."""
    exact = top.run("gauss16", h=0.02, t=end).mu[-1]
    points = []
    for count in steps:
        h = end / (count + 0.4)
        try:
            found = top.run(method, h=h, t=end + h).at(end)
        except lp.IntegrationError:
            continue  # too long a step
        error = float(np.max(np.abs(found - exact)))
        if 3e-12 < error < 1e-2:
            points.append((np.log(h), np.log(error)))
    assert len(points) >= 4, f"{method}: {len(points)} points"
    return float(np.polyfit(*np.array(points[-10:]).T, 1)[0])


def test_the_order_between_steps_is_that_of_every_method(top: lp.System) -> None:
    low = [round(10 * 1.2**k) for k in range(20)]
    high = list(range(4, 60))
    measured = 0
    for name, facts in top.methods().items():
        if not facts.applies or facts.order is None or name in OWN_STEPS:
            continue
        label = f"{name}(midpoint)" if name.startswith("compose") else name
        late = facts.order >= 5 or name.startswith("compose")
        found = slope(top, label, *((10.0, high) if late else (2.0, low)))
        slack = max(0.35, facts.order * (0.2 if facts.order > 12 else 0.05))
        assert found > facts.order - slack, f"{name}: {found:.2f}, order {facts.order}"
        measured += 1
    assert measured > 50


def test_methods_with_steps_of_their_own_keep_their_tolerance(top: lp.System) -> None:
    exact = top.run("gauss16", h=0.02, t=2).mu[-1]
    for method, bound in OWN_STEPS.items():
        more = {"atol": 1e-13} if method == "dopri5" else {}
        found = top.run(method, h=0.3, t=3, rtol=1e-13, **more).at(2.0)
        assert np.max(np.abs(found - exact)) < bound, method


@pytest.mark.parametrize(
    "options",
    [
        {"h": 0.1, "t": 3},
        {"h": -0.1, "t": -3, "every": 7},
        {"h": 0.1, "t0": 1, "t": 3.05},
        {"tol": 1e-9, "t": 30},
        {"tol": 1e-3, "t": 30, "every": 3},
        {"h": 0.1, "at": [1, 2.05]},
    ],
)
def test_rows_have_their_bits(options: dict[str, Any]) -> None:
    run = body().run("gauss4", x0=START, **options)
    assert np.array_equal(run.at(run.t), run.mu)
    # any order and shape
    times = np.array([[run.t[-1], 0.5 * (run.t[0] + run.t[-1])], [run.t[0], run.t[-1]]])
    found = run.at(times)
    assert found.shape == (2, 2, 3)
    assert np.array_equal(found[0, 0], found[1, 1]) and np.array_equal(found[0, 0], run.mu[-1])
    assert np.array_equal(found[0, 1], run.at(float(times[0, 1])))
    assert run.at([]).shape == (0, 3)


def test_times_are_those_that_rows_can_have() -> None:
    system = body()
    run = system.run("gauss6", h=0.5, t=3, x0=START)
    rows = system.run("gauss6", h=0.5, at=[0.25, "1/3", 2.9], x0=START)
    assert np.array_equal(run.at(["1/4", "1/3", "29/10"]), rows.mu)
    # with a tolerance the step is that of the whole span
    chosen = system.run("gauss6", tol=1e-6, t=30, x0=START)
    rows = system.run("gauss6", tol=1e-6, at=[0.25, 7, 30], x0=START)
    assert rows.step == chosen.step
    assert np.array_equal(chosen.at([0.25, 7]), rows.mu[:2])
    # its orbit: the Casimir is kept between steps too
    states = chosen.at(np.linspace(0, 30, 200))
    norms = np.sum(states**2, axis=1)
    assert np.max(np.abs(norms - norms[0])) < 1e-14
    assert np.array_equal(pickle.loads(pickle.dumps(run)).at(1.23), run.at(1.23))


@pytest.mark.parametrize("time", [3.1, -0.1, float("nan"), float("inf")])
def test_times_outside_are_refused(time: float) -> None:
    run = body().run("gauss4", h=0.1, t=3, x0=START)
    with pytest.raises(ValueError, match="outside the run, from 0.0 to 3.0"):
        run.at([1, time])
    with pytest.raises(TypeError):
        run.at([1j])


def test_a_driven_system_and_one_that_stops() -> None:
    driven = lp.System(
        algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + cos(t)*y + z^2/6"
    )
    run = driven.run("gauss6", h=0.2, t=4, x0=START)
    exact = driven.run("gauss6", h=0.01, at=[1.23], x0=START)
    assert run.at(1.23).shape == (3,)
    assert np.max(np.abs(run.at(1.23) - exact.mu[0])) < 1e-5
    stops = lp.System(poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 + sqrt(q)")
    with pytest.raises(lp.IntegrationError) as stopped:
        stops.run("rk4", h=0.05, t=10, x0=[1, 0])
    partial, end = stopped.value.partial, stopped.value.time
    assert partial.at(0.5 * end).shape == (2,)
    with pytest.raises(ValueError, match="outside the run"):
        partial.at(9)


def test_pictures_are_curves() -> None:
    plt = pytest.importorskip("matplotlib.pyplot")
    run = body().run(tol=1e-9, t=40, x0=START)
    axes = run.plot().axes[0]
    curves = [line for line in axes.lines if len(line.get_xdata()) > 900]
    dots = [line for line in axes.lines if len(line.get_xdata()) == len(run)]
    assert len(curves) == len(dots) == 3
    # steps that are many are drawn as they are
    run = body().run("gauss4", h=0.01, t=20, x0=START)
    lengths = {len(line.get_xdata()) for line in run.plot().axes[0].lines}
    assert lengths == {2001}
    plt.close("all")
