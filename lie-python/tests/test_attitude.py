"""The group element at the start, and Euler angles."""

from __future__ import annotations

import liepoisson as lp
import numpy as np
import pytest

BODY = {
    "algebra": "so(3)",
    "state": ["x", "y", "z"],
    "parameters": {"a": 0.5},
    "hamiltonian": "x^2/4 + y^2/3 + z^2/2",
    "initial": [0.8, 0.1, 0.6],
}


def about(axis: int, angle: float) -> np.ndarray:
    sine, cosine = np.sin(angle), np.cos(angle)
    turn = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn[i, i] = turn[j, j] = cosine
    turn[j, i], turn[i, j] = sine, -sine
    return turn


def of_angles(axes: str, angles: np.ndarray) -> np.ndarray:
    first, second, third = ("xyz".index(axis) for axis in axes)
    return about(first, angles[0]) @ about(second, angles[1]) @ about(third, angles[2])


def test_a_run_from_an_attitude_is_turned_by_it() -> None:
    body = lp.System(**BODY, attitude={"euler": "zxz", "angles": ["a", 1, "-a"]})
    assert body.check().attitude == "Euler angles zxz (a, 1, -a)"
    alone = lp.System(**BODY).run("gauss6", h=0.1, t=20, group="matrix").group
    for a in (0.5, -2.0):
        start = of_angles("zxz", np.array([a, 1, -a]))
        run = body.run("gauss6", h=0.1, t=20, group="matrix", a=a)
        assert np.allclose(run.group[0], start, atol=1e-15)
        assert np.abs(run.group - start @ alone).max() < 1e-12
        # the second call is not looked at again
        again = body.run("gauss6", h=0.1, t=20, group="matrix", a=a)
        assert np.array_equal(again.group, run.group)


@pytest.mark.parametrize("axes", ["zxz", "zyz", "xyx", "zyx", "xyz", "yxz"])
def test_angles_are_those_of_the_matrices_and_do_not_jump(axes: str) -> None:
    body = lp.System(**BODY, attitude={"euler": axes, "angles": [0.1, 0.7, -0.3]})
    angles = body.run("lie-midpoint", h=0.05, t=40, group=f"euler:{axes}").group
    matrices = body.run("lie-midpoint", h=0.05, t=40, group="matrix").group
    assert angles.shape == (801, 3)
    assert np.array_equal(angles[0], [0.1, 0.7, -0.3])
    found = np.array([of_angles(axes, row) for row in angles])
    assert np.abs(found - matrices).max() < 1e-12
    assert np.abs(np.diff(angles, axis=0)).max() < 1.5
    assert np.abs(angles).max() > 2 * np.pi


def test_entries_of_the_state_begin_there() -> None:
    system = lp.System(
        **{**BODY, "hamiltonian": "x^2/4 + y^2/3 + z^2/2 + R33"},
        group="R",
        attitude={"quaternion": ["cos(a/2)", 0, 0, "sin(a/2)"]},
    )
    for a in (0.5, 1.5):
        start = about(2, a).ravel()
        assert np.allclose(system.run("gauss4", h=0.1, t=1, a=a).mu[0, 3:], start, atol=1e-15)
        given = system.run("gauss4", h=0.1, t=1, x0=[1, 2, 3], a=a)
        assert np.allclose(given.mu[0, 3:], start, atol=1e-15)
    # members begin each at the attitude of its parameters
    values = [0.5, 1.5, -1.0]
    rows = system.ensemble([1, 2, 3], "gauss4", h=0.1, t=1, every=10, a=values)
    for member, a in enumerate(values):
        assert np.allclose(rows.mu[member, 0, 3:], about(2, a).ravel(), atol=1e-15)


def test_what_is_wrong_is_said() -> None:
    for attitude, kind, says in [
        ({"quaternion": [1, 1, 0, 0]}, "domain", "norm is 1.414"),
        ({"euler": "zzx", "angles": [0, 1, 0]}, "schema", "no sequence"),
        ({"matrix": [[1, 0], [0, 1]]}, "representation", "rows or columns"),
    ]:
        with pytest.raises(lp.DeclarationError, match=says) as caught:
            lp.System(**BODY, attitude=attitude)
        assert caught.value.kind == kind
    body = lp.System(**BODY)
    with pytest.raises(ValueError, match="euler:zxz"):
        body.run("gauss4", h=0.1, t=1, group="euler")
    with pytest.raises(ValueError, match="neighbours different"):
        body.run("gauss4", h=0.1, t=1, group="euler:xxy")
