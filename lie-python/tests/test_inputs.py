"""What people pass: scalars and arrays of numpy, other types, wrong shapes, what is not finite; copies and pickles."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import liepoisson as lp
import numpy as np
import pytest

START = [0.8, 0.1, 0.6]


def body() -> lp.System:
    return lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"I1": 2, "I2": 1, "I3": Fraction(2, 3)},
        hamiltonian="x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
        initial=START,
    )


def test_numbers_of_numpy_are_numbers() -> None:
    plain = body().run("rk4", h=0.5, t=2, every=2, x0=START, I1=3).mu
    numpy = body().run(
        " rk4",
        h=np.float32(0.5),
        t=np.int64(2),
        every=np.int32(2),  # type: ignore[arg-type]
        x0=np.array(START),
        I1=np.array(3),  # type: ignore[arg-type]
    )
    assert np.array_equal(plain, numpy.mu) and numpy.method == "rk4"
    assert not np.array_equal(plain, body().run("rk4", h=0.5, t=2, every=2, I1=2).mu)
    # a fraction is exact
    assert '"2/3"' in body().text and body().parameters["I3"] == 2 / 3


def test_the_layout_of_arrays_does_not_matter() -> None:
    starts = np.random.default_rng(3).normal(size=(20, 3))
    found = body().ensemble(starts, "rk4", h=0.1, t=1).mu
    f = body().function("vector_field")
    for other in (
        np.asfortranarray(starts),
        np.repeat(starts, 2, axis=0)[::2],
        starts[::-1][::-1],
        starts.tolist(),
    ):
        assert np.array_equal(found, body().ensemble(other, "rk4", h=0.1, t=1).mu)
        assert np.array_equal(f(starts), f(other))
    assert not np.array_equal(found, body().ensemble(starts[::-1], "rk4", h=0.1, t=1).mu)
    half = starts.astype(np.float32)
    assert np.array_equal(f(half), f(half.astype(np.float64))) and f(half).dtype == np.float64
    assert f(np.zeros((0, 3))).shape == (0, 3)
    assert body().ensemble(np.zeros((0, 3)), t=1).mu.shape == (0, 3)


def test_copies_and_pickles() -> None:
    system = body()
    f = system.function("jacobian", I1=3)
    again = pickle.loads(pickle.dumps(f))
    assert np.array_equal(again(START), f(START)) and repr(again) == repr(f)
    assert not np.array_equal(again(START), system.function("jacobian")(START))
    for one in (copy.copy(system), copy.deepcopy(system), pickle.loads(pickle.dumps(system))):
        assert np.array_equal(one.run(t=1).mu, system.run(t=1).mu)
    # what is given out is not the system's own
    assert system.initial is not None
    system.initial[0] = 9
    system.parameters["I1"] = 9
    assert system.initial.tolist() == START and system.parameters["I1"] == 2


Wrong = tuple[Callable[[lp.System], Any], type[Exception], str]
WRONG: list[Wrong] = [
    (lambda s: s.run(x0=[START]), ValueError, "ensemble takes many"),
    (lambda s: s.run(x0=[START, START]), ValueError, "ensemble takes many"),
    (lambda s: s.run(x0=np.array(START) * 1j), TypeError, "must be a number"),
    (lambda s: s.run(x0=[None, 1, 2]), TypeError, "must be a number"),
    (lambda s: s.run(I1=np.array([1.0, 2.0])), TypeError, "the parameter I1 must be a number"),
    (lambda s: s.run(I1=True), TypeError, "the parameter I1 must be a number"),
    (lambda s: s.run(I1=0), ValueError, "not finite because of `1/I1`"),
    (lambda s: s.run(t=float("nan")), ValueError, "t: `nan` is not a finite number"),
    (lambda s: s.run(t=(0, 1)), TypeError, "t must be a number"),
    (lambda s: s.run(at=[0, float("inf")]), ValueError, "at: `inf` is not a finite number"),
    (lambda s: s.run(at=[-1, 1]), ValueError, "both sides of t = 0"),
    (lambda s: s.run(every=2.0), TypeError, "every must be 1, 2, 3"),
    (lambda s: s.run(every="2"), TypeError, "every must be 1, 2, 3"),
    (lambda s: s.run(every=10**20), ValueError, "too large"),
    (lambda s: s.run("dopri5", rtol="x"), ValueError, "rtol: `x` is not a number"),
    (lambda s: s.run("midpoint", max_iterations=3.0), TypeError, "max_iterations must be 1, 2"),
    (lambda s: s.run("midpoint", max_iterations=-3), ValueError, "max_iterations must be 1, 2"),
    (lambda s: s.run("midpoint", newton_tolerance="a"), ValueError, "newton_tolerance"),
    (lambda s: s.run("midpoint", iteration=3), TypeError, "iteration is text"),
    (lambda s: s.run(group=True), TypeError, "group is text"),
    (lambda s: s.run(t=0.1)[0], TypeError, "columns have names"),
    (lambda s: list(s.run(t=0.1)), TypeError, r"run.mu\[0\]"),
    (lambda s: s.ensemble(np.ones((2, 3)) * 1j, t=1), TypeError, "real numbers"),
    (lambda s: s.ensemble([["a", 1, 2]], t=1), TypeError, "real numbers"),
    (lambda s: s.ensemble([{"x": 1}], t=1), TypeError, "array of numbers"),
    (lambda s: s.ensemble(np.ones((2, 2, 3)), t=1), ValueError, "members, 3"),
    (lambda s: s.ensemble([START], t=1, threads=2.0), TypeError, "threads must be 1, 2"),
    (lambda s: s.ensemble([START], t=1, every=2.5), TypeError, "every must be 1, 2"),
    (lambda s: s.function("gradient")(np.ones(3) * 1j), TypeError, "real numbers"),
    (lambda s: s.function("gradient")(0.0, START), ValueError, "it comes before the time"),
    (lambda s: s.verify("rk4", h=0), ValueError, "h=0.1"),
    (lambda s: s.verify("rk4", seed=-1), ValueError, "seed must be 0, 1, 2"),
    (lambda s: s.verify("rk4", tol=1e-6), TypeError, "measures at a step"),
    (lambda s: s.bench("rk4", t=1, x0=[0, 0, 1]), ValueError, "not an equilibrium"),
    (lambda s: s.stress("rk4", x0=[0, 0, 0], steps=10), ValueError, "another x0"),
    (lambda s: s.stress("rk4", steps=1e4), TypeError, "steps must be 1, 2, 3"),
    (lambda s: s.stress("rk4", h=0.1), TypeError, "leave it out"),
    (lambda s: s.stress(["rk4", "gauss4"]), TypeError, r'stress\("rk4", "gauss4"\)'),
    (lambda s: s.stress(""), ValueError, "a method is empty"),
    (lambda s: s.rust(["rk4"]), TypeError, r'rust\("rk4"\)'),
    (lambda s: s.run("rk4 --retraction cayley"), lp.MethodError, "arguments of run"),
    (lambda s: lp.System(3), TypeError, "keys by name"),  # type: ignore[arg-type]
    (lambda s: lp.System(b"{}"), TypeError, "keys by name"),  # type: ignore[arg-type]
    (lambda s: lp.System(hamiltonian=object(), algebra="so(3)"), TypeError, "numbers and text"),
]


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_what_is_none_of_that_is_refused(number: int) -> None:
    call, error, says = WRONG[number]
    with pytest.raises(error, match=says):
        call(body())


def test_one_state_goes_with_many_parameters_and_the_declared_times_have_the_end() -> None:
    body = lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"a": 2},
        hamiltonian="x^2/a + y^2 + z^2/3",
        run={"at": [1, 3, 2]},
    )
    many = body.ensemble([0.8, 0.1, 0.6], "rk4", h=0.1, a=np.array([1.0, 2.0]))
    assert many.t.tolist() == [3.0]
    alone = body.run("rk4", h=0.1, t=3, x0=[0.8, 0.1, 0.6], a=2.0)
    assert (many.mu[1] == alone.mu[-1]).all()
    assert body.run("rk4", h=0.1, every=10, x0=[0.8, 0.1, 0.6]).t.tolist() == [0, 1, 2, 3]
    with pytest.raises(TypeError, match="leave out"):
        body.ensemble([0.8, 0.1, 0.6], "rk4", h=0.1, at=[1, 2], every=2)


def test_the_spelling_of_the_command_is_taken() -> None:
    one = body().run("rk4", h=0.5, t=2, x0=[0.1, 0.2, 0.9])
    two = body().run("rk4", step=0.5, until=2, initial=[0.1, 0.2, 0.9])
    assert np.array_equal(one.mu, two.mu) and not np.array_equal(one.mu, body().run("rk4").mu)
    many = body().ensemble(initial=[[0.1, 0.2, 0.9]], method="rk4", step=0.5, until=2)
    assert np.array_equal(many.mu[0], one.mu[-1])
    assert body().verify("rk4", step=0.1).facts and body().bench("rk4", until=1, budget=1e-4).rows
    with pytest.raises(TypeError, match="`h` and `step` are one argument"):
        body().run(h=0.1, step=0.1)
    # a parameter of that name wins
    named = lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"step": 1},
        hamiltonian="step*x^2/2 + y^2",
        initial=START,
    )
    assert not np.array_equal(named.run("rk4", t=1).mu, named.run("rk4", t=1, step=2).mu)
    assert named.run("rk4", t=1, step=2).step == 0.01
