"""Nothing is lost: memory that is not there, Ctrl-C within long work, rows in their order, energies that vary."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import liepoisson as lp
import numpy as np
import pytest

BODY = {"algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "x^2/2 + y^2/4 + z^2/6", "initial": [0.8, 0.1, 0.6]}
DRIVEN = {**BODY, "hamiltonian": "x^2/2 + y^2/4 + z^2/6 + cos(t)*x"}


def test_times_are_given_in_order():
    body = lp.System(**BODY)
    assert body.run("rk4", h=0.1, at=[0, "1/3", 0.5, 0.5]).t.tolist() == [0, 1 / 3, 0.5, 0.5]
    assert body.run("rk4", h=-0.1, at=[-0.5, -1]).t.tolist() == [-0.5, -1]
    for at in ([0.5, "1/3"], [2, 1], [1, 0]):
        with pytest.raises(ValueError, match="not in order") as caught:
            body.run("rk4", h=0.1, at=at)
        assert "sorted" in str(caught.value)
        with pytest.raises(ValueError, match="not in order"):
            body.ensemble(np.ones((2, 3)), "rk4", h=0.1, at=at)
    # the list of a declaration is no order that anybody waits for
    declared = lp.System(**BODY, run={"method": "rk4", "step": 0.1, "at": [2, 1]})
    assert declared.run().t.tolist() == [1, 2]


def test_a_driven_system_has_no_error_of_its_energy():
    driven = lp.System(**DRIVEN).run("gauss4", h=0.1, t=3)
    assert list(driven.drift) == ["C1"] and driven.drift["C1"] < 1e-14
    assert np.ptp(driven.energy) > 0.1 and "energy" not in repr(driven)
    assert "energy" not in driven._repr_html_().split("<img")[0]
    assert list(lp.System(**BODY).run("gauss4", h=0.1, t=3).drift) == ["energy", "C1"], "the control"
    with pytest.raises(ValueError, match="changes with the time"):
        lp.System(**DRIVEN).bench("rk4", t=1, measure="energy")
    # without a Casimir there is nothing to speak of
    plane = lp.System(poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 + q^2/2 + cos(t)*q", initial=[1, 0])
    run = plane.run("gauss4", h=0.1, t=1)
    assert run.drift == {} and "error" not in repr(run)
    run.plot()


def test_rows_that_do_not_fit_are_refused_before_a_step():
    body = lp.System(**BODY)
    start = time.monotonic()
    for call in (
        lambda: body.run("rk4", h=1e-6, t=1e9),
        lambda: body.run("rk4", h=1e-300, t=1e-290, every=1),
        lambda: body.ensemble(np.ones((1000, 3)), "rk4", h=1e-6, t=1e6, every=1),
    ):
        with pytest.raises((MemoryError, ValueError), match="memory|counted"):
            call()
    assert time.monotonic() - start < 5
    with pytest.raises(MemoryError, match="GB of memory are needed") as caught:
        body.run("rk4", h=1e-6, t=1e9)
    assert "every" in str(caught.value)
    chain = lp.System(
        algebra="so(3)^N", state=["x[i]", "y[i]", "z[i]"], parameters={"N": 10},
        hamiltonian="sum(i in 0..N: z[i]*z[i+1])", initial={"random": "unit-sphere", "seed": 1},
    )  # fmt: skip
    with pytest.raises(MemoryError, match="GB of memory are needed"):
        chain.run("rk4", h=0.1, t=1, N=2_000_000_000)
    # the control: the same with fewer rows
    assert len(body.run("rk4", h=1e-3, t=1e3, every=10**6)) == 2


@pytest.mark.skipif(sys.platform != "linux", reason="there is no limit to set")
def test_a_limit_of_memory_is_an_exception():
    script = f"""
        import resource
        import numpy as np
        import liepoisson as lp
        body = lp.System(**{BODY!r})
        body.run("rk4", h=0.1, t=1)
        body.ensemble(np.ones((4, 3)), "rk4", h=0.1, t=1, threads=2)
        f = body.function("jacobian")
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + 400_000_000,) * 2)
        for call in (
            lambda: body.run("rk4", h=1e-3, t=2e4),
            lambda: body.run("dopri5", h=1e-3, t=2e4),
            lambda: body.run("gauss16", tol=1e-12, t=1e7),
            lambda: body.ensemble(np.ones((500, 3)), "rk4", h=1e-3, t=100, every=1, threads=2),
            lambda: f(np.ones((6_000_000, 3))),
        ):
            try:
                call()
                print("fits")
            except MemoryError:
                print("MemoryError")
        print(len(body.run("rk4", h=0.1, t=1)))
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["MemoryError"] * 5 + ["11"], done.stdout


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize(
    "work",
    [
        # a single step of the grid
        "system.run('taylor', h=1e9, t=1e9)",
        "system.run('rk4', h=1e-6, t=1e6, every=10**12)",
        # a large algebra, compiled
        "lp.System(algebra='su(5)', hamiltonian=H, initial=[1/(k + 1) for k in range(24)]).run('gauss4', h=0.1, t=1e9, every=10**9)",
    ],
)
def test_ctrl_c_is_heard_within_a_step(work):
    script = f"""
        import time
        import liepoisson as lp
        system = lp.System(**{BODY!r})
        su5 = lp.System(algebra="su(5)", hamiltonian="0")
        H = " + ".join(f"{{x}}^2*{{y}}^2" for x in su5.coordinates for y in su5.coordinates)
        print("ready", flush=True)
        try:
            {work}
        except KeyboardInterrupt:
            print("heard", time.monotonic())
    """
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None and child.stdout.readline() == "ready\n"
    time.sleep(0.5)
    sent = time.monotonic()
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert out.startswith("heard"), out
    assert float(out.split()[1]) - sent < 3
    assert child.returncode == 0
