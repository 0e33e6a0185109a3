"""Verification, bench, check, methods, ensembles with rows, systems with time, notebooks, Ctrl-C. Each comparison has a control."""

from __future__ import annotations

import html
import os
import pathlib
import pickle
import signal
import threading
import time
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

BODY: dict[str, Any] = {
    "name": "Body",
    "algebra": "so(3)",
    "state": ["x", "y", "z"],
    "parameters": {"I1": 2, "I2": 1, "I3": "2/3"},
    "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
    "initial": ["4/5", "1/10", "3/5"],
}
DRIVEN: dict[str, Any] = {
    **BODY,
    "parameters": {},
    "hamiltonian": "x^2/2 + y^2 + z^2/3 + cos(t)*x",
}
START = [0.8, 0.1, 0.6]


def test_claims_are_measured() -> None:
    body = lp.System(**BODY)
    found = body.verify("rk4", "lie-midpoint", "gauss4")
    assert found.passed and not found.failures, repr(found)
    facts = {(fact.method, fact.fact): fact for fact in found.facts}
    assert abs(facts["rk4", "order"].measured - 4) < 0.3
    assert abs(facts["lie-midpoint", "order"].measured - 2) < 0.2
    assert facts["lie-midpoint", "Poisson"].verdict == "holds"
    # the control: what is not claimed is far from it
    assert facts["rk4", "Poisson"].verdict == "not-claimed"
    assert facts["rk4", "Poisson"].measured > 1e3 * facts["lie-midpoint", "Poisson"].measured
    assert "lie-midpoint" in repr(found) and "0 fail" in repr(found)
    with pytest.raises(lp.MethodError):
        body.verify("rk5")
    with pytest.raises(ValueError):
        body.verify("rk4", x0=[float("nan"), 0, 0])


def test_errors_fall_by_the_order_and_cost_time() -> None:
    found = lp.System(**BODY).bench("rk4", "midpoint", "dopri5", t=2, budget=0.02)
    assert found.complete and found.t == 2 and found.measure == "state"
    for method, order in [("rk4", 4), ("midpoint", 2)]:
        rows = found.of(method)
        assert set(rows["control"]) == {"step"}
        fine = (rows["error"] > 1e-9) & (rows["error"] < 1e-2)
        slope = np.polyfit(np.log(rows["value"][fine]), np.log(rows["error"][fine]), 1)[0]
        assert abs(slope - order) < 0.4, (method, slope)
        assert np.array_equal(np.sort(rows["steps"]), rows["steps"])
        assert rows["seconds"][-1] > rows["seconds"][0] > 0
    assert set(found.of("dopri5")["control"]) == {"tolerance"}
    assert found.reference is not None and max(found.reference) < 1e-9
    # the fastest way to an error reaches it, and a method of order 2 does not reach 1e-12
    assert all(row.error <= 1e-6 for row in found.fastest(1e-6))
    assert "midpoint" not in [row.method for row in found.fastest(1e-12)]
    assert "rk4" in repr(found) and len(pickle.loads(pickle.dumps(found))) == len(found)


def test_other_senses_of_errors() -> None:
    body = lp.System(**BODY)
    drift = body.bench("lie-midpoint", "rk4", t=5, budget=0.01, measure="casimirs")
    assert drift.of("lie-midpoint")["error"].max() < 1e-13 < drift.of("rk4")["error"].max()
    passes = body.bench("rk4", t=20, budget=0.01, measure="section", section=("y", 0))
    assert passes.section is not None and passes.section[0] == "y" and passes.section[2] > 0
    assert "across" in lp.BenchRow._fields and np.isnan(drift["across"]).all()


def test_ctrl_c_keeps_what_was_measured() -> None:
    body = lp.System(**BODY)

    def interrupt(done: int, total: int, what: str) -> None:
        if what == "times":
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(lp.Interrupted) as caught:
        body.bench("rk4", "gauss4", t=10, budget=0.01, progress=interrupt)
    assert isinstance(caught.value, KeyboardInterrupt)
    partial = caught.value.partial
    assert not partial.complete and len(partial) > 0 and "interrupted" in repr(partial)
    assert np.isfinite(partial["error"]).all() and (partial["seconds"] > 0).all()
    assert not pickle.loads(pickle.dumps(caught.value)).partial.complete


def test_a_check_says_what_the_system_is() -> None:
    found = lp.System(**BODY).check()
    assert (found.dimension, found.generic_rank, found.initial_rank) == (3, 2, 2)
    assert (found.algebra, found.independent_casimirs) == ("so(3)", 1)
    assert found.casimirs[0].kind == "polynomial" and found.casimirs[0].degree == 2
    assert found.algebra_class is not None and not found.algebra_class["solvable"]
    assert found.operations["vector_field"]["mul"] > 0
    assert found.methods["midpoint"] is None and found.methods["euler-arnold2"]
    assert found.splitting is not None and found.warnings == [] and found.json["name"] == "Body"
    other = lp.System(
        algebra="heisenberg(1)", state=["q", "p", "c"], hamiltonian="q^2/2 + p^2/2"
    ).check()
    assert other.algebra_class is not None and other.algebra_class["nilpotent"]
    assert other.initial_rank is None and other.algebra != found.algebra
    # Lagrange's top, whose spin is constant
    top = {"algebra": "se(3)", "state": ["m1", "m2", "m3", "g1", "g2", "g3"]}
    symmetric = lp.System(**top, hamiltonian="m1^2/2 + m2^2/2 + m3^2 + g3").check()
    assert symmetric.constants_of_motion == [lp.Motion("m3", 1)]
    assert (
        lp.System(**top, hamiltonian="m1^2/2 + m2^2 + m3^2 + g3").check().constants_of_motion == []
    )
    assert "Casimir C1" in repr(found)


def test_methods_say_what_they_keep() -> None:
    methods = lp.System(**BODY).methods()
    midpoint, rk4 = methods["lie-midpoint"], methods["rk4"]
    assert (midpoint.order, midpoint.symmetric, midpoint.explicit) == (2, True, False)
    assert (rk4.order, rk4.symmetric, rk4.explicit) == (4, False, True)
    assert {"poisson", "orbit"} <= set(midpoint.preserves) and "poisson" not in rk4.preserves
    assert midpoint.options == {"retraction": "exp"} and midpoint.here
    # all run in Python, where they apply
    assert all(method.here for method in methods.values())
    assert not methods["variational2"].applies
    assert "rk4" in methods.applicable and "euler-arnold2" not in methods.applicable
    assert "does not apply" in repr(methods)


def test_an_ensemble_saves_rows_and_takes_a_tolerance() -> None:
    body = lp.System(**BODY)
    starts = np.random.default_rng(3).normal(size=(5, 3))
    ends = body.ensemble(starts, "gauss4", h=0.1, t=2)
    rows = body.ensemble(starts, "gauss4", h=0.1, t=2, every=4)
    assert rows.mu.shape == (5, 6, 3) and np.allclose(rows.t, np.arange(6) * 0.4)
    assert np.array_equal(rows.mu[:, -1], ends.mu) and np.array_equal(rows.mu[:, 0], starts)
    alone = body.run("gauss4", h=0.1, t=2, every=4, x0=starts[3])
    assert np.array_equal(rows.mu[3], alone.mu) and not np.array_equal(rows.mu[2], alone.mu)
    at = body.ensemble(starts, "gauss4", tol=1e-10, at=[0.5, 2])
    assert at.mu.shape == (5, 2, 3) and at.t.tolist() == [0.5, 2]
    exact = body.ensemble(starts, "gauss16", h=0.05, t=2).mu
    rough = body.ensemble(starts, "gauss4", tol=1e-3, t=2).mu
    assert np.abs(at.mu[:, -1] - exact).max() < 1e-8 < np.abs(rough - exact).max()
    assert np.abs(body.ensemble(starts, tol=1e-11, t=2).mu - exact).max() < 1e-9


def test_failed_members_keep_their_rows() -> None:
    top = lp.System(
        algebra="se(3)",
        state=["m1", "m2", "m3", "g1", "g2", "g3"],
        hamiltonian="(m1^2 + m2^2)/2 + m3^2 + g3",
    )
    start = np.array([0.4, 0.3, 0.9, 0.36, 0.48, 0.8])
    starts = np.stack([start * 1e-3, start])
    found = top.ensemble(starts, "midpoint", h=100, t=1000, every=1)
    [(member, failed_at, _)] = found.failures
    reached = np.isfinite(found.mu[member]).all(axis=1).sum()
    assert member == 1 and reached == failed_at / 100 + 1 < len(found.t)
    assert np.isfinite(found.mu[0]).all()


def test_members_in_lanes_have_the_bits_of_members_alone() -> None:
    body = lp.System(**BODY)
    starts = np.random.default_rng(5).normal(size=(21, 3))
    moments = np.linspace(1.5, 3, 21)
    for method in ["rk4", "gauss4", "gauss16", "lie-midpoint", "taylor", "splitting2"]:
        asked: dict[str, Any] = {"h": 0.1, "at": [0.25, 2]}
        found = body.ensemble(starts, method, threads=1, I1=moments, **asked).mu
        two = body.ensemble(starts, method, threads=2, I1=moments, **asked).mu
        alone = [
            body.run(method, x0=start, I1=moment, **asked).mu
            for start, moment in zip(starts, moments)
        ]
        assert np.array_equal(found, np.stack(alone)) and np.array_equal(two, found)
        assert not np.array_equal(found, np.stack(alone[1:] + alone[:1]))


def test_a_member_that_fails_in_a_lane_fails_as_alone() -> None:
    body = lp.System(**BODY)
    starts = np.random.default_rng(7).normal(size=(8, 3))
    whole = body.ensemble(starts, "gauss4", h=0.1, t=1, every=1, threads=1)
    broken = starts.copy()
    broken[3, 0] = 1e160
    found = body.ensemble(broken, "gauss4", h=0.1, t=1, every=1, threads=1)
    alone = body.ensemble(broken[3:4], "gauss4", h=0.1, t=1, every=1, threads=1)
    [(member, *why)], [(_, *why_alone)] = found.failures, alone.failures
    assert (member, why) == (3, why_alone) and not whole.failures
    others = np.arange(8) != 3
    assert np.array_equal(found.mu[others], whole.mu[others])
    assert np.isnan(found.mu[3, -1]).all() and not np.isnan(found.mu[others]).any()


def test_solver_options_count_for_members() -> None:
    body = lp.System(**BODY)
    slow = {"iteration": "fixed-point", "max_iterations": 2}
    failed = body.ensemble([START], "gauss16", h=0.5, t=10, **slow)
    assert len(failed.failures) == 1 and np.isnan(failed.mu).all()
    assert body.ensemble([START], "gauss16", h=0.5, t=10).failures == []


def test_what_carries_the_time_is_no_coordinate() -> None:
    driven = lp.System(**DRIVEN)
    assert (driven.coordinates, driven.dimension) == (["x", "y", "z"], 3)
    assert driven.initial is not None and np.allclose(driven.initial, START)
    assert "_p" not in driven.latex() and "_one" not in driven.latex()
    assert r"\cos(t)" in driven.latex() and driven.latex().count("&=") == 4
    ends = driven.ensemble([START, START], "gauss4", h=0.1, t=1).mu
    assert ends.shape == (2, 3)
    run = driven.run("gauss4", h=0.1, t=1)
    assert run.mu.shape == (11, 3) and np.array_equal(ends[0], run.mu[-1])
    states = np.random.default_rng(5).normal(size=(4, 2, 3))
    times = np.array([[0.0, 0.5]])
    omega = states * [1, 2, 2 / 3] + np.cos(times)[..., None] * [1, 0, 0]
    f = driven.function("vector_field")
    assert np.allclose(f(states, times), np.cross(states, omega), atol=1e-14)
    assert not np.allclose(f(states), np.cross(states, omega), atol=1e-3)
    assert np.allclose(driven.function("gradient")(states, times), omega)
    assert driven.function("jacobian")(states).shape == (4, 2, 3, 3)
    energy = (states**2 * [0.5, 1, 1 / 3]).sum(axis=-1) + np.cos(times) * states[..., 0]
    assert np.allclose(driven.function("hamiltonian")(states, times), energy)
    integrate = pytest.importorskip("scipy.integrate")
    exact = integrate.solve_ivp(lambda t, y: f(y, t), (0, 1), START, rtol=1e-11, atol=1e-12).y
    fine = driven.run("gauss16", h=0.1, t=1).mu[-1]
    assert np.abs(fine - exact[:, -1]).max() < 1e-9


def test_long_functions_stop_at_ctrl_c() -> None:
    energy = lp.System(**BODY).function("hamiltonian")
    states = np.tile(START, (6_000_000, 1))
    # by the clock of the processor, which does not care what else the machine does
    begun = time.process_time()
    energy(states)
    whole = time.process_time() - begun
    if whole < 0.2:
        pytest.skip(f"too fast to be interrupted: {whole} s")
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_PROF, 0.05)
    try:
        begun = time.process_time()
        with pytest.raises(KeyboardInterrupt):
            energy(states)
            # without a look at signals it is raised here
            time.sleep(1)
        assert time.process_time() - begun < 0.05 + 0.7 * whole
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def test_other_threads_run_while_something_compiles() -> None:
    ticks, done = [0], threading.Event()

    def tick() -> None:
        while not done.wait(0.001):
            ticks[0] += 1

    thread = threading.Thread(target=tick)
    thread.start()
    system = lp.load(pathlib.Path(__file__).parents[2] / "specs" / "so4_manakov.json")
    try:
        before = ticks[0]
        system.rust("cohen-hairer6", "collective6", "generating6")
        passed = ticks[0] - before
        # with the lock there are none but at the ends
        assert passed > 10
    finally:
        done.set()
        thread.join()


def test_notebooks_show_mathematics_and_motion() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    body = lp.System(**BODY)
    shown = body._repr_html_()
    assert html.escape(body.latex()) in shown and "$$" in shown
    assert shown.count("<img") == 1 and "data:image/png;base64," in shown
    # without an initial state there is nothing to draw
    still = lp.System({key: value for key, value in BODY.items() if key != "initial"})
    assert "<img" not in still._repr_html_() and "$$" in still._repr_html_()
    # of a long system the Hamiltonian alone
    long = lp.load(pathlib.Path(__file__).parents[2] / "specs" / "se3_kirchhoff_full.json")
    assert "H &=" in long.latex() and long.latex().count("&=") == 1 < body.latex().count("&=")
    run = body.run("gauss4", h=0.1, t=1)
    bench = body.bench("rk4", t=1, budget=0.005)
    assert "<img" in run._repr_html_() and "<img" in bench._repr_html_()
    assert len(bench.plot().axes) == 1
    for other in (body.verify("rk4"), body.check(), body.methods()):
        assert other._repr_html_().startswith("<div>") and "<td" in other._repr_html_()
    failed = body.ensemble([[np.inf, 0, 0]], "midpoint", h=0.1, t=1)
    assert (
        "<td" in failed._repr_html_()
        and "<td" not in lp.Ensemble(np.zeros((1, 3)), np.zeros(1), [])._repr_html_()
    )


def test_names_stand_in_pages_as_text() -> None:
    methods = lp.Methods()
    methods["<b>"] = lp.System(**BODY).methods()["rk4"]._replace(id="<b>", keeps="<script>")
    assert "<script>" not in methods._repr_html_() and "&lt;b&gt;" in methods._repr_html_()
