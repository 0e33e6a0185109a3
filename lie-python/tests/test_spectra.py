"""Lyapunov exponents and frequencies. Each comparison has a control."""

from __future__ import annotations

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
}


def test_exponents_of_the_middle_axis_are_known() -> None:
    body = lp.System(**BODY)
    found = body.exponents("gauss6", h=0.05, t=200, x0=[0, 1, 0], transient=100)
    # |m| sqrt((I1 - I2)(I2 - I3)/(I1 I3))/I2 = 1/2
    assert np.abs(found.values - [0.5, 0, -0.5]).max() < 1e-9, found
    assert found.leaf_dimension == 2 and found.casimir_exponents < 1e-9
    assert found.complete and found.steps == 2000 and abs(found.time - 100) < 1e-9
    # the controls: another axis has none, and a large step of second order has another one
    assert body.exponents(h=0.1, t=200, x0=[1, 0, 0]).values[0] < 0.1
    coarse = body.exponents("midpoint", h=0.5, t=200, x0=[0, 1, 0], transient=100, count=1)
    assert coarse.values.shape == (1,) and abs(coarse.values[0] - 0.5) > 1e-3
    assert np.isnan(coarse.sum) and "Body" in repr(coarse)


def test_exponents_are_refused_with_reasons() -> None:
    body = lp.System(**BODY, initial=[0.6, 0, 0.8])
    with pytest.raises(ValueError, match="no end is given"):
        body.exponents(h=0.1)
    with pytest.raises(ValueError, match="no step is given"):
        body.exponents(t=10)
    with pytest.raises(ValueError, match="4 exponents"):
        body.exponents(h=0.1, t=10, count=4)
    with pytest.raises(TypeError, match="tol"):
        body.exponents(tol=1e-6, t=10)
    noisy = lp.System(**BODY, initial=[0.6, 0, 0.8], noise=[{"hamiltonian": "x"}])
    with pytest.raises(lp.MethodError, match="noise"):
        noisy.exponents(h=0.1, t=10)
    away = lp.System(
        poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 - q^4", initial=[1, 1]
    )
    with pytest.raises(lp.IntegrationError) as stopped:
        away.exponents("rk4", h=0.05, t=100)
    partial = stopped.value.partial
    assert isinstance(partial, lp.Exponents) and 0 < partial.steps < 2000


def test_frequencies_are_found() -> None:
    swing = lp.System(
        poisson=["{q, p} = 1"],
        state=["q", "p"],
        parameters={"k": 4},
        hamiltonian="p^2/2 + k*q^2/2",
    )
    run = swing.run("gauss6", h=0.05, t=200.02, x0=[0.5, 0])
    found = run.frequencies("q", count=3)
    assert [type(line) for line in found.lines] == [lp.Line] * len(found.lines)
    line = found.lines[0]
    assert abs(line.frequency - 2) < 1e-7 and line.drift < 1e-9
    assert abs(line.amplitude - 0.5) < 1e-7 and abs(line.phase) < 1e-5
    assert abs(found.mean) < 1e-12 and found.rest < 1e-9
    # the control: another constant of the spring
    other = swing.run("gauss6", h=0.05, t=200, x0=[0.5, 0], k=4.001).frequencies("q").lines[0]
    assert abs(other.frequency - 2) > 1e-4
    with pytest.raises(KeyError):
        run.frequencies("w")
    with pytest.raises(ValueError, match="equal distances"):
        times = np.linspace(0, 4, 30) ** 2
        swing.run("gauss6", h=0.05, x0=[0.5, 0], at=times.tolist()).frequencies("q")
    with pytest.raises(ValueError, match="at least 16"):
        swing.run("gauss6", h=0.05, t=0.2, x0=[0.5, 0]).frequencies("q")
    undefined = lp.System(
        poisson=["{q, p} = 1"],
        state=["q", "p"],
        hamiltonian="p^2/2 + q^2/2",
        observables={"ratio": "sin(q - 1)/(q - 1)"},
    )
    with pytest.raises(ValueError, match="not finite at t = 0"):
        undefined.run("gauss6", h=0.05, t=4, x0=[1, 0]).frequencies("ratio")
