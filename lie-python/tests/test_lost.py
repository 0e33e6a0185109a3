"""Nothing is lost: memory that is not there, Ctrl-C within long work, rows in their order, energies that vary."""

import numpy as np
import pytest

import liepoisson as lp

BODY = {"algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "x^2/2 + y^2/4 + z^2/6", "initial": [0.8, 0.1, 0.6]}
DRIVEN = {**BODY, "hamiltonian": "x^2/2 + y^2/4 + z^2/6 + cos(t)*x"}


def test_a_driven_system_has_no_error_of_its_energy():
    driven = lp.System(**DRIVEN).run("gauss4", h=0.1, t=3)
    assert list(driven.drift) == ["C1"] and driven.drift["C1"] < 1e-14
    assert np.ptp(driven.energy) > 0.1 and "energy" not in repr(driven)
    assert "energy" not in driven._repr_html_().split("<img")[0]
    assert list(lp.System(**BODY).run("gauss4", h=0.1, t=3).drift) == ["energy", "C1"], "the control"
    with pytest.raises(ValueError, match="depends on the time"):
        lp.System(**DRIVEN).bench("rk4", t=1, measure="energy")
    # without a Casimir there is nothing to speak of
    plane = lp.System(poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 + q^2/2 + cos(t)*q", initial=[1, 0])
    run = plane.run("gauss4", h=0.1, t=1)
    assert run.drift == {} and "error" not in repr(run)
    run.plot()
