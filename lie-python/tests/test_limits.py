"""Methods at their limits, kernels before the declaration, progress. Each comparison has a control."""

from __future__ import annotations

import os
import pathlib
import pickle
import signal
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
ROOT = pathlib.Path(__file__).parents[2]
Call = tuple[int, int, str]


def test_methods_keep_at_their_limits_what_they_claim() -> None:
    found = lp.System(**BODY).stress("rk4", "lie-midpoint", "midpoint", steps=4000)
    assert found.passed and found.complete and not found.lost and found.steps == 4000
    assert found.methods == ["rk4", "lie-midpoint", "midpoint"]
    long = {cell.method: cell for cell in found.cells if cell.experiment == "long"}
    assert {cell.steps for cell in long.values()} == {4000}
    # the energy of the control drifts, that of the others is bounded or kept
    assert long["rk4"].energy_growth > 5 and long["lie-midpoint"].energy_growth < 2
    assert long["midpoint"].energy_drift < 1e-13 and long["lie-midpoint"].energy_drift > 1e-7
    assert long["lie-midpoint"].casimir_drift < 1e-13 and long["rk4"].casimir_drift > 1e-8
    # the step is 0.2 over the rate: the longest steps are refused
    steps = [cell for cell in found.of("lie-midpoint") if cell.experiment == "step"]
    assert steps[-1].value == 256 and steps[-1].outcome == "stopped" and steps[-1].what
    assert steps[-1].step == pytest.approx(256 * found.h0)
    scales = {cell.value for cell in found.of("rk4") if cell.experiment == "scale"}
    assert [min(scales), max(scales)] == pytest.approx([1e-100, 1e100])
    assert {growth.method for growth in found.growths} == {"lie-midpoint", "midpoint"}
    assert all(-0.5 < growth.exponent < 1.6 for growth in found.growths)
    assert {round(growth.step / found.h0) for growth in found.growths} == {1, 8}
    assert all(abs(growth.bias) < 8 * growth.bias_error for growth in found.growths)
    assert len(found["energy_drift"]) == len(found) == len(found["method"])
    assert "lie-midpoint" in repr(found) and "0 lost" in repr(found)
    assert max(len(line) for line in repr(found).splitlines()[2:-3]) <= 120
    assert pickle.loads(pickle.dumps(found)).cells[0] == found.cells[0]


def test_limits_have_a_picture() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    found = lp.System(**BODY).stress("rk4", steps=1000)
    figure = found.plot()
    assert len(figure.axes) == 2 and figure.axes[0].get_yticklabels()[0].get_text() == "rk4"
    shown = found._repr_html_()
    assert "<td" in shown and shown.count("<img") == 1 and "near singular" in shown


def test_what_is_lost_is_said() -> None:
    # a found loss, as the core gives it: methods of the package lose nothing
    found = lp.System(**BODY).stress("rk4", steps=1000)
    lost = lp.Stress(
        "Body",
        1000,
        {
            "step": found.h0,
            "cells": [found.cells[0]._asdict()],
            "growths": [],
            "losses": ["rk4, long steps 1000: energy"],
            "table": found._table,
            "legend": "",
            "complete": True,
        },
    )
    assert found.passed and not lost.passed
    assert "lost: rk4" in repr(lost) and "lost: rk4" not in repr(found)


def test_ctrl_c_keeps_what_was_tried() -> None:
    body = lp.System(**BODY)

    def interrupt(done: int, total: int, what: str) -> None:
        if done > 10:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(lp.Interrupted) as caught:
        body.stress("rk4", "lie-midpoint", "gauss4", steps=10**9, progress=interrupt)
    partial = caught.value.partial
    # the long runs come last
    assert not partial.complete and not partial.passed and len(partial) > 10
    assert not any(cell.experiment == "long" for cell in partial.cells)
    assert "interrupted" in repr(partial)

    def at_the_end(done: int, total: int, what: str) -> None:
        if done == total:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(lp.Interrupted) as caught:
        body.stress("rk4", steps=1000, progress=at_the_end)
    assert any(cell.experiment == "long" for cell in caught.value.partial.cells)

    def at_second(done: int, total: int, what: str) -> None:
        if done == 1:
            os.kill(os.getpid(), signal.SIGINT)

    methods = [method for method in body.methods().applicable if not method.startswith("compose")]
    with pytest.raises(lp.Interrupted) as caught:
        body.verify(*methods, progress=at_second)
    partial = caught.value.partial
    assert not partial.passed
    # the next methods are measured while the answer is on its way, and what was found of them is kept
    found = list(dict.fromkeys(fact.method.split()[0] for fact in partial.facts))
    assert 0 < len(found) < len(methods) and found == methods[: len(found)]
    assert not partial.failures


def test_kernels_are_compared_with_the_declaration() -> None:
    for spec in ("so3_free_rigid_body", "lotka_volterra"):
        system = lp.load(ROOT / "specs" / f"{spec}.json")
        found = system.verify("rk4")
        assert found.passed and found.kernels is not None, found
        assert {"hamiltonian", "vector_field", "jacobian", "casimirs"} <= set(found.kernels)
        assert all(0 <= excess <= 1 for excess in found.kernels.values())
        assert max(found.kernels.values()) > 0
        assert found.reference is None or found.reference <= 1
        assert f"{len(found.kernels)} kernels, " in repr(found)
    # at other parameters they are compared with these
    assert lp.System(**BODY).verify("rk4", I1=5, I2=3).passed
    wrong = {
        "facts": [],
        "failures": ["gradient: entry 1 is 2.0, and 1.0 by the declaration as it was written"],
        "kernels": {"gradient": 1e9},
        "reference": None,
        "summary": "1 kernels",
        "complete": True,
    }
    assert not lp.Verification(wrong).passed and "failed: gradient" in repr(lp.Verification(wrong))
    ring = lp.load(ROOT / "tests" / "data" / "families" / "heisenberg_chain.json")
    family = ring.verify("rk4", N=4)
    assert family.kernels is None and "not compared" in repr(family) and family.passed


def told() -> tuple[list[Call], Any]:
    calls: list[Call] = []
    return calls, lambda done, total, what: calls.append((done, total, what))


def test_progress_is_told_and_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    body = lp.System(**BODY)
    starts = np.tile([0.8, 0.1, 0.6], (100, 1))
    runs: list[tuple[str, Any]] = [
        ("rk4, Poisson", lambda progress: body.verify("rk4", progress=progress)),
        ("times", lambda progress: body.bench("rk4", t=1, budget=0.01, progress=progress)),
        ("experiments", lambda progress: body.stress("rk4", steps=1000, progress=progress)),
        ("members", lambda progress: body.ensemble(starts, "rk4", h=0.01, t=1, progress=progress)),
        ("steps", lambda progress: body.run("rk4", h=2e-6, t=25, every=10_000, progress=progress)),
    ]
    for what, run in runs:
        calls, progress = told()
        run(progress)
        assert what in [call[2] for call in calls], (what, calls)
        assert all(0 <= done <= total for done, total, _ in calls)
        parts = [done / total for done, total, _ in calls]
        assert parts == sorted(parts) and parts[-1] == 1, calls
        run(None)
    assert capfd.readouterr() == ("", "")


def test_an_exception_of_progress_ends_the_work() -> None:
    body = lp.System(**BODY)
    starts = np.tile([0.8, 0.1, 0.6], (100, 1))

    def refuse(done: int, total: int, what: str) -> None:
        raise RuntimeError("enough")

    for run in (
        lambda: body.verify("rk4", progress=refuse),
        lambda: body.bench("rk4", t=1, progress=refuse),
        lambda: body.stress("rk4", steps=10**9, progress=refuse),
        lambda: body.ensemble(starts, "rk4", h=1e-6, t=1e6, progress=refuse),
        lambda: body.run("rk4", h=1e-6, t=1e6, every=10**9, progress=refuse),
    ):
        with pytest.raises(RuntimeError, match="enough"):
            run()
    with pytest.raises(TypeError, match="progress is a function"):
        body.verify("rk4", progress=True)  # type: ignore[arg-type]
