"""The package from the outside. Each comparison has a control that fails."""

from __future__ import annotations

import doctest
import pathlib
import pickle
import types
import warnings
from concurrent.futures import ProcessPoolExecutor

import liepoisson as lp
import numpy as np
import pytest

BODY = {
    "algebra": "so(3)",
    "state": ["x", "y", "z"],
    "parameters": {"I1": 2, "I2": 1, "I3": "2/3"},
    "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
}
START = [0.8, 0.1, 0.6]


def body() -> lp.System:
    return lp.System(BODY)


def euler(mu: np.ndarray) -> np.ndarray:
    """Euler's equations by hand."""
    return np.cross(mu, mu / np.array([2.0, 1.0, 2.0 / 3.0]))


def rk4(mu: np.ndarray, h: float, steps: int) -> np.ndarray:
    for _ in range(steps):
        a = euler(mu)
        b = euler(mu + h / 2 * a)
        c = euler(mu + h / 2 * b)
        d = euler(mu + h * c)
        mu = mu + h / 6 * (a + 2 * b + 2 * c + d)
    return mu


def test_a_run_is_the_solution() -> None:
    run = body().run("gauss16", h=0.1, t=5, x0=START)
    assert run.t.shape == (51,) and run.mu.shape == (51, 3)
    exact = rk4(np.array(START), 1e-3, 5000)
    assert np.abs(run.mu[-1] - exact).max() < 1e-11
    rough = body().run("midpoint", h=0.1, t=5, x0=START)
    assert np.abs(rough.mu[-1] - exact).max() > 1e-5


def test_columns_and_drift() -> None:
    run = body().run("lie-midpoint", h=0.1, t=50, x0=START)
    assert np.array_equal(run["y"], run.mu[:, 1])
    assert np.array_equal(run["C1"], run.casimirs["C1"])
    assert run.drift["C1"] < 1e-13
    assert body().run("rk4", h=0.5, t=50, x0=START).drift["C1"] > 1e-6
    with pytest.raises(KeyError, match="There are"):
        run["w"]


def test_a_tolerance_chooses_the_step() -> None:
    run = body().run(tol=1e-10, t=5, x0=START)
    exact = rk4(np.array(START), 1e-3, 5000)
    assert run.method == "gauss16"
    assert np.abs(run.mu[-1] - exact).max() < 1e-9
    loose = body().run("gauss4", tol=1e-3, t=5, x0=START)
    assert loose.step > 3 * body().run("gauss4", tol=1e-8, t=5, x0=START).step


def test_times_parameters_and_states_by_name() -> None:
    run = body().run("rk4", h=0.1, at=[0.25, 1.0], x0=dict(zip("xyz", START)), I2="1/2")
    assert run.t.tolist() == [0.25, 1.0]
    other = body().run("rk4", h=0.1, at=[0.25, 1.0], x0=START)
    assert not np.array_equal(run.mu, other.mu)


def test_functions_over_leading_axes() -> None:
    states = np.random.default_rng(2018).normal(size=(4, 5, 3))
    f, jacobian = body().function("vector_field"), body().function("jacobian")
    assert np.allclose(f(states), euler(states), atol=1e-14)
    assert not np.allclose(f(states), euler(states + 0.01), atol=1e-14)
    assert jacobian(states).shape == (4, 5, 3, 3)
    e = 1e-6
    difference = (f(states + [e, 0, 0]) - f(states - [e, 0, 0])) / (2 * e)
    assert np.allclose(jacobian(states)[..., 0], difference, atol=1e-8)
    assert body().function("hamiltonian")(START).shape == ()
    with pytest.raises(ValueError, match="did you mean `jacobian`"):
        body().function("jacobean")


def test_an_ensemble_has_the_bits_of_single_runs() -> None:
    starts = np.random.default_rng(7).normal(size=(200, 3))
    masses = np.linspace(1.0, 3.0, 200)
    one = body().ensemble(starts, "gauss4", h=0.1, t=2, threads=1, I1=masses)
    three = body().ensemble(starts, "gauss4", h=0.1, t=2, threads=3, I1=masses)
    assert np.array_equal(one.mu, three.mu) and one.failures == []
    alone = body().run("gauss4", h=0.1, t=2, x0=starts[17], I1=masses[17])
    assert np.array_equal(one.mu[17], alone.mu[-1])
    assert not np.array_equal(one.mu, body().ensemble(starts, "gauss4", h=0.1, t=2).mu)


def test_failed_members_do_not_disturb_the_others() -> None:
    starts = np.array([START, [np.inf, 0, 0], START])
    found = body().ensemble(starts, "midpoint", h=0.1, t=1)
    assert [failure[0] for failure in found.failures] == [1]
    assert np.isnan(found.mu[1]).all() and np.array_equal(found.mu[0], found.mu[2])


def test_a_run_that_stops_keeps_its_rows() -> None:
    top = lp.System(
        algebra="se(3)",
        state=["m1", "m2", "m3", "g1", "g2", "g3"],
        hamiltonian="(m1^2 + m2^2)/2 + m3^2 + g3",
    )
    start = [0.4, 0.3, 0.9, 0.36, 0.48, 0.8]
    with pytest.raises(lp.IntegrationError, match="help: take a smaller step") as caught:
        top.run("midpoint", h=100, t=1000, x0=start)
    assert caught.value.step >= 1 and caught.value.time == 100.0 * (caught.value.step - 1)
    assert caught.value.partial.mu.shape == (caught.value.step, 6)
    assert len(top.run("midpoint", h=0.1, t=1, x0=start)) == 11


def test_mistakes_have_a_kind_a_place_and_a_remedy() -> None:
    with pytest.raises(lp.DeclarationError, match="declare `w` as a parameter") as caught:
        lp.System({**BODY, "hamiltonian": "x^2 + w"})
    assert caught.value.kind == "unknown-symbol"
    assert caught.value.line is not None and caught.value.column is not None
    with pytest.raises(lp.DeclarationError) as caught:
        basis = {"basis": ["a", "b", "c"], "brackets": ["[a, b] = c", "[b, c] = a", "[a, c] = a"]}
        lp.System(algebra=basis, state=["x", "y", "z"], hamiltonian="x^2")
    assert caught.value.kind == "jacobi"


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        (lambda: body().run(dt=0.1), "here it is `h`"),
        (lambda: body().run(y0=1.0), "here it is `x0`"),
        (lambda: body().run(t_end=1), "here it is `t`"),
        (lambda: body().run(I_1=2), "did you mean `I1`"),
        (lambda: body().run(x0=[1, 2]), "x0: 2 values for a state of 3"),
        (lambda: body().run(), r"x0=\[0.1, 0.2, 0.3\]"),
        (lambda: body().run("midpont", x0=START), "did you mean `midpoint`"),
        (lambda: body().run("midpoint", h=0.1, tol=1e-3, x0=START), "both given"),
        (lambda: lp.System({**BODY, "hamiltonian": "x**2"}), r"written `\^`"),
        (lambda: lp.System({**BODY, "hamiltonian": "np.sin(x)"}), "write `sin\\(x\\)`"),
        (lambda: lp.System(state=["x"], hamiltonian="x"), 'algebra="so\\(3\\)"'),
        (lambda: lp.System({**BODY, "hamiltonin": "x"}), "hamiltonian"),
    ],
)
def test_slips_are_answered_with_what_works(wrong: object, hint: str) -> None:
    with pytest.raises((ValueError, TypeError), match=hint):
        wrong()  # type: ignore[operator]


def test_a_method_that_does_not_apply_says_why() -> None:
    assert body().methods()["midpoint"].applies
    refused = body().methods()["euler-arnold2"]
    assert not refused.applies and refused.reason
    with pytest.raises(lp.MethodError, match="does not apply"):
        body().run("euler-arnold2", x0=START)


def end_of(system: lp.System, start: list[float]) -> list[float]:
    end: list[float] = system.run("gauss4", h=0.1, t=1, x0=start).mu[-1].tolist()
    return end


def test_systems_travel_to_other_processes() -> None:
    system = pickle.loads(pickle.dumps(body()))
    assert system.text == body().text
    starts = [[1.0, 0.1 * k, 0.3] for k in range(6)]
    with ProcessPoolExecutor(2) as pool:
        found = list(pool.map(end_of, [system] * 6, starts))
    assert found == [end_of(system, start) for start in starts]
    run = pickle.loads(pickle.dumps(system.run("rk4", h=0.1, t=1, x0=START)))
    assert run.mu.shape == (11, 3)


def test_the_declaration_gives_what_the_call_leaves_out() -> None:
    system = lp.System(BODY, initial=START, run={"method": "gauss4", "step": "1/5", "until": 2})
    run = system.run()
    assert (run.method, run.step, len(run)) == ("gauss4", 0.2, 11)
    assert system.initial is not None and system.initial.tolist() == START


def test_the_examples_of_the_documentation() -> None:
    attempted = 0
    for module in [lp, *(m for n, m in vars(lp).items() if isinstance(m, types.ModuleType))]:
        found = doctest.testmod(module)
        assert found.failed == 0
        attempted += found.attempted
    # every example in the package is one of them
    folder = pathlib.Path(lp.__file__).parent
    written = sum(file.read_text("utf-8").count(">>> ") for file in folder.glob("*.py"))
    assert attempted == written > 20


def test_everything_public_is_described() -> None:
    for name in lp.__all__:
        thing = getattr(lp, name)
        assert thing.__doc__ and "Alias for field" not in thing.__doc__, name
        for of, member in vars(thing).items() if isinstance(thing, type) else ():
            if not of.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{name}.{of}"


def test_pictures_and_text() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    run = body().run("gauss4", h=0.1, t=5, x0=START)
    assert len(run.plot().axes) == 2
    assert "dot" not in body().latex() and r"\begin{aligned}" in body().latex()
    assert "fn vector_field" in body().rust("midpoint")
    assert "gauss4" in repr(run)


def test_latex_shows_what_was_written() -> None:
    top = lp.System(
        algebra="so(3)",
        state=["x1", "y", "z"],
        parameters={"k_rot": 2},
        hamiltonian="x1^2/2 + k_rot*y^2",
    )
    assert r"x_{1}' &=" in top.latex() and r"k_{\mathrm{rot}}" in top.latex()
    ring = lp.System(
        algebra="so(3)^N",
        state=["x[i]", "y[i]", "z[i]"],
        parameters={"N": 4},
        hamiltonian="sum(i in 0..N: x[i])^2/(2*N)",
    )
    assert r"\left(\sum_{0 \le i < N} x_{i}\right)^{2}" in ring.latex()
    quartic = pathlib.Path(__file__).parents[2] / "specs" / "so3_quartic_lagrangian.json"
    assert lp.load(quartic).latex().count(r"\text{the Hamiltonian is not known") == 1


def test_every_key_of_a_run_in_the_declaration_counts() -> None:
    def run(**keys: object) -> lp.Solution:
        return lp.System(BODY, initial=START, run=keys).run()

    assert len(run(step=0.1, until=2, every=5)) == 5 and len(run(step=0.1, until=2)) == 21
    assert run(step=0.1, at=["1/3", 0.5]).t.tolist() == [1 / 3, 0.5]
    chosen = run(tol=1e-6, until=2)
    assert (chosen.method, chosen.drift["energy"] < 1e-12) == ("gauss16", True)
    assert run(method="gauss4", tol=1e-6, until=2).method == "gauss4"
    tight = run(method="dopri5", step=1, until=20, rtol=1e-13, atol=1e-13)
    assert tight.drift["energy"] < 1e-11 < run(method="dopri5", step=1, until=20).drift["energy"]
    times = lp.System(BODY, initial=START, run={"step": 0.1, "at": [0.5]}).run(t=1)
    assert len(times) == 11


def test_series_are_as_exact_as_those_of_the_command() -> None:
    assert body().run("taylor", h=0.1, t=10, x0=START).drift["energy"] < 1e-13
    assert body().run("taylor", h=0.1, t=10, x0=START, rtol=1e-6).drift["energy"] > 1e-9
    with pytest.raises(lp.MethodError, match="give `rtol` and `atol`"):
        body().run("dopri5", tol=1e-8, x0=START)
    with pytest.raises(lp.MethodError, match="not an option of rk4"):
        body().run("rk4", rtol=1e-8, x0=START)


def test_what_is_kept_by_a_projection_is_kept_to_round_off() -> None:
    kept = body().run("dopri5", h=1, t=200, x0=START, keep=["energy", "casimirs"])
    assert max(kept.drift.values()) < 1e-14, kept.drift
    plain = body().run("dopri5", h=1, t=200, x0=START)
    assert plain.drift["energy"] > 1e-9 < plain.drift["C1"], plain.drift
    between = kept.at([0.3, 77.7])
    energy = 0.5 * np.sum(between**2 / np.array([2, 1, 2 / 3]), axis=1)
    assert np.abs(energy - kept.energy[0]).max() < 1e-14
    energy_alone = body().run("taylor", h=1, t=200, x0=START, rtol=1e-6, keep="energy")
    assert energy_alone.drift["energy"] < 1e-14 and energy_alone.drift["C1"] > 1e-9
    assert kept.kept == ("energy", "C1") and "energy, C1 kept by a projection" in repr(kept)
    assert energy_alone.kept == ("energy",)
    assert plain.kept == () and "projection" not in repr(plain)
    picked = body().run(tol=1e-6, t=10, x0=START, keep="casimirs")
    assert (picked.method, picked.kept) == ("taylor", ("C1",))
    many = body().ensemble([START, START], "rk4", h=0.1, t=200, keep="energy,casimirs")
    assert many.kept == ("energy", "C1") and "kept by a projection" in repr(many)
    assert body().ensemble([START], "rk4", h=0.1, t=1).kept == ()
    assert np.abs(np.sum(many.mu**2, axis=1) - np.sum(np.square(START))).max() < 1e-14
    with pytest.raises(lp.MethodError, match="solves equations"):
        body().run("gauss4", h=0.1, t=1, x0=START, keep="energy")
    with pytest.raises(ValueError, match="nothing that can be kept"):
        body().run("rk4", h=0.1, t=1, x0=START, keep=["momentum"])


def planet() -> lp.System:
    return lp.System(
        name="Planet",
        poisson=["{q1, p1} = 1", "{q2, p2} = 1"],
        state=["q1", "q2", "p1", "p2"],
        hamiltonian="(p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2)",
        initial=["1/10", 0, 0, "sqrt(19)"],
    )


def test_steps_follow_the_motion_and_go_back() -> None:
    there = planet().run("gauss16", h=0.0158, t=60, density="reversible")
    assert there.density == "reversible" and there.t[-1] == 60
    sizes = np.diff(there.t[:-1])
    assert sizes[0] == pytest.approx(0.0158) and sizes.max() > 8 * sizes.min()
    assert np.abs(there.energy + 0.5).max() < 1e-6
    back = planet().run("gauss16", h=-sizes[-1], t0=there.t[-2], t=0, x0=there.mu[-2], density="reversible")
    # which comes to the start but for round-off, and may have a row there and one at 0
    assert np.abs(back.mu[: len(sizes) + 1][::-1] - there.mu[:-1]).max() < 1e-9
    plain = planet().run("gauss16", h=0.0158, t=60)
    assert plain.density is None and plain.steps > 10 * there.steps
    between = there.at([0.3, 31.4])
    assert np.abs(between - planet().run("taylor", h=1, at=[0.3, 31.4]).mu).max() < 1e-5
    with pytest.raises(lp.MethodError, match="not symmetric"):
        planet().run("rk4", h=0.01, t=1, density="reversible")
    with pytest.raises(ValueError, match="unknown density"):
        planet().run("gauss4", h=0.01, t=1, density="even")
    with pytest.raises(lp.IntegrationError, match="smaller step"):
        planet().run("gauss16", h=0.3, t=60, density="reversible")


def test_time_runs_backwards_without_a_step() -> None:
    run = body().run("gauss4", t=-1, x0=START)
    assert run.t[-1] == -1 and run.step == -0.01
    assert np.allclose(body().run("gauss4", t=1, x0=run.mu[-1]).mu[-1], START, atol=1e-10)


def test_states_of_systems_with_time_are_given_without_it() -> None:
    driven = lp.System({**BODY, "hamiltonian": "x^2/2 + y^2 + z^2/3 + cos(t)*x", "parameters": {}})

    def field(mu: np.ndarray, t: float) -> np.ndarray:
        return np.cross(mu, [mu[0] + np.cos(t), 2 * mu[1], 2 * mu[2] / 3])

    mu, h = np.array(START), 1e-3
    for k in range(1000):
        t = k * h
        a = field(mu, t)
        b = field(mu + h / 2 * a, t + h / 2)
        c = field(mu + h / 2 * b, t + h / 2)
        mu = mu + h / 6 * (a + 2 * b + 2 * c + field(mu + h * c, t + h))
    for x0 in (START, dict(zip("xyz", START))):
        end = driven.run("gauss16", h=0.1, t=1, x0=x0).mu[-1, :3]
        assert np.abs(end - mu).max() < 1e-10
    with pytest.raises(ValueError, match="a state of 3\n  help: give the values of x, y, z"):
        driven.run(x0=[1, 2])


def test_few_long_members_share_the_threads_and_stop_at_once() -> None:
    import os
    import signal
    import threading

    starts = np.tile(START, (4, 1))
    # runs of months: they end because they stop
    with pytest.raises(KeyboardInterrupt):
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        body().ensemble(starts, "gauss4", h=1e-6, t=1e7, threads=2)


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        (lambda: body().run("", x0=START), "the method is empty"),
        (lambda: body().run("RK45", x0=START), r"System.methods\(\)"),
        (lambda: body().run(x0=START, at=[]), "`at` is empty"),
        (lambda: body().run(x0=START, at=[1], every=2), "leave out `every`"),
        (lambda: body().run(x0=START, every=-1), "1, 2, 3"),
        (lambda: body().run(x0=START, params={"I1": 1}), "I1=…"),
        (lambda: body().run(x0=START, retraction="cayley"), "--retraction cayley"),
        (lambda: body().ensemble([START], h=0, t=1), "the step is zero"),
        (lambda: body().ensemble([START], h=-0.1, t=1), "away from"),
        (lambda: body().ensemble([START], h=0.1, t=1, threads=-1), "1, 2, 3"),
    ],
)
def test_more_slips(wrong: object, hint: str) -> None:
    with pytest.raises((ValueError, TypeError), match=hint):
        wrong()  # type: ignore[operator]


STARTED = {**BODY, "initial": ["4/5", "1/10", "3/5"]}


def test_solver_options_of_the_declaration_and_of_the_call() -> None:
    keys = {
        "method": "gauss16",
        "step": "1/2",
        "until": 10,
        "iteration": "fixed-point",
        "max-iterations": 2,
    }
    slow = lp.System(**{**STARTED, "run": keys})
    # two iterations do not solve a step of this size
    with pytest.raises(lp.IntegrationError):
        slow.run()
    assert len(slow.run(max_iterations=100).t) == 21
    # they belong to the method of the declaration
    assert len(slow.run("midpoint").t) == 21
    body = lp.System(**STARTED)
    with pytest.raises(lp.MethodError, match="explicit"):
        body.run("rk4", iteration="newton")
    with pytest.raises(lp.MethodError, match="stages together"):
        body.run("midpoint", converge="map")
    with pytest.raises(ValueError, match="no tolerance to which"):
        body.run("gauss16", converge="tolerance")
    with pytest.raises(ValueError, match="not 0"):
        body.run("midpoint", max_iterations=0)
    with pytest.raises(ValueError, match="simplified"):
        body.run("midpoint", iteration="picard")
    one = body.run("gauss16", tol=1e-6, t=5, converge="tolerance")
    two = body.run("gauss16", tol=1e-6, t=5)
    assert not np.array_equal(one.mu, two.mu)
    assert np.allclose(one.mu[-1], two.mu[-1], atol=1e-4)


def test_the_group_element() -> None:
    body = lp.System(**STARTED)
    run = body.run("lie-midpoint", h=0.1, t=5, group="matrix")
    assert run.group is not None and run.group.shape == (51, 3, 3)
    assert np.allclose(run.group[0], np.eye(3))
    # the momentum in space is constant: g mu(t) = mu(0)
    space = np.einsum("mij,mj->mi", run.group, run.mu)
    assert np.abs(space - space[0]).max() < 1e-13
    assert np.abs(run.mu - run.mu[0]).max() > 0.01
    quaternion = body.run("lie-midpoint", h=0.1, t=5, group="quaternion").group
    assert quaternion is not None and quaternion.shape == (51, 4)
    assert np.allclose((quaternion**2).sum(axis=1), 1.0, atol=1e-15)
    declared = lp.System(**{**STARTED, "run": {"group": "quaternion", "until": 1}})
    assert declared.run().group is not None
    assert body.run(t=1).group is None
    with pytest.raises(ValueError, match="quaternion"):
        body.run(t=1, group="euler")


def test_parameters_that_are_named_like_arguments() -> None:
    system = lp.System(
        algebra="so(3)",
        state=["x", "y", "z"],
        parameters={"h": 1, "group": 2},
        hamiltonian="h*x^2/2 + group*y^2/2",
        initial=[1, 2, 3],
    )
    one = system.run("rk4", h=0.1, t=1, parameters={"h": 3, "group": 5})
    two = system.run("rk4", h=0.1, t=1)
    assert not np.array_equal(one.mu, two.mu)
    assert system.function("hamiltonian", parameters={"h": 2})([1.0, 0.0, 0.0]) == 1.0
    with pytest.raises(TypeError, match="twice"):
        lp.System(**STARTED).run(parameters={"I1": 2}, I1=3)


def test_what_is_zero_is_not_divided_by() -> None:
    # a Casimir that is 0 but for round-off
    top = lp.System(
        algebra="se(3)",
        state=["m1", "m2", "m3", "g1", "g2", "g3"],
        hamiltonian="m1^2/2 + m2^2/2 + m3^2 + g3",
        initial=["1/10", "1/5", "1/3", "2/3", "-1/3", 0],
    )
    run = top.run("lie-midpoint", h=0.1, t=10)
    zero = [name for name, values in run.casimirs.items() if abs(values[0]) < 1e-15]
    assert zero and all(run.drift[name] < 1e-14 for name in zero)
    assert "(absolute)" in repr(run)


def test_a_missed_tolerance_is_said() -> None:
    spec = pathlib.Path(__file__).parents[2] / "specs" / "se3_heavy_top.json"
    top = lp.load(spec)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = top.run("rk4", tol=1e-3, t=100, every=1000)
        assert run.error is None
        run = top.run("gauss16", tol=1e-9, t=20, assess=True)
        assert 0 < run.error < 1e-7
        run = top.run("gauss16", h=0.5, t=20, assess=True)
        assert 0 < run.error < 1
    # its motion is chaotic: after a longer time no step is small enough
    with pytest.warns(UserWarning, match="more than the tolerance 0.001"):
        top.run("rk4", tol=1e-3, t=400, every=1000, assess=True)


def test_mechanics_that_runs_backwards_is_said() -> None:
    pendulum = lp.System(algebra="heisenberg(1)", hamiltonian="p^2/2 - cos(q)")
    grid = {"h": 0.1, "t": 3}
    note = r"{q, p} = -z is -1.0 at the initial state.*start from z < 0"
    with pytest.warns(UserWarning, match=note) as said:
        pendulum.run("gauss16", x0=[0.3, 1, 1], **grid)
    assert len(said) == 1
    starts = [[0.3, 1, 1], [0.3, 1, -1], [0.2, 1, 2]]
    with pytest.warns(UserWarning, match="{q, p} = -z is negative in 2 of 3 runs"):
        pendulum.ensemble(starts, "gauss4", **grid)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = pendulum.run("gauss16", x0=[0.3, 1, -1], **grid)
        pendulum.ensemble(starts[1:2], "gauss4", **grid)
    assert run["q"][-1] == pytest.approx(0.1089473932480415, abs=1e-12)
    report = pendulum.check()
    assert report.brackets == ["{q, p} = -z"]
    assert [pair["forwards"] for pair in report.canonical] == ["z < 0"]
    assert "mechanics runs forwards: z < 0" in repr(report)


def test_a_file_is_loaded_by_load() -> None:
    with pytest.raises(TypeError, match=r"load\('top.json'\)"):
        lp.System("top.json")
    with pytest.raises(TypeError, match="load"):
        lp.System(pathlib.Path("top.json"))
