"""Histograms of members: bins of equal area on spheres, of each coordinate elsewhere."""

from __future__ import annotations

import liepoisson as lp
import numpy as np
import pytest


def body() -> lp.System:
    return lp.System(
        algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6", name="Body"
    )


def test_bins_of_a_sphere_have_the_same_area() -> None:
    many = body().ensemble([0, 3, 4], "rk4", h=0.1, t=0.2, members=9600, spread="orbit", every=1)
    found = body().histogram(many.mu, bins=4)
    assert found.counts.shape == (3, 4, 12)
    assert np.all(found.counts.sum(axis=(1, 2)) == 9600)
    # uniform over the sphere, at the start and later: 200 in each bin, and 14 their deviation
    assert 140 < found.counts.min() and found.counts.max() < 260
    height, azimuth = found.edges
    assert np.allclose(np.diff(height), 0.5) and np.allclose(np.diff(azimuth), np.pi / 6)
    x, y, z = many.mu[7, 2]
    band = np.searchsorted(height, z / 5, "right") - 1
    sector = np.searchsorted(azimuth, np.arctan2(y, x), "right") - 1
    alone = body().histogram(many.mu[7:8, 2], bins=4)
    assert alone.counts.sum() == 1 and alone.counts[band, sector] == 1
    # a state without a direction, and one that is none
    left = body().histogram([[0, 0, 0], [1, np.nan, 0], [0, 0, 1]])
    assert left.counts.shape == (16, 48) and left.counts.sum() == 1


def test_coordinates_elsewhere_are_those_of_numpy() -> None:
    plane = lp.System(algebra="se(2)", state=["m", "a", "b"], hamiltonian="m^2/2 + a")
    states = np.random.default_rng(1).normal(size=(500, 2, 3))
    states[3, 1] = np.nan
    found = plane.histogram(states, bins=7)
    assert found.counts.shape == (2, 3, 7) and isinstance(found.edges, np.ndarray)
    there = states.reshape(-1, 3)
    there = there[np.isfinite(there).all(axis=1)]
    for k in range(3):
        edges = found.edges[k]
        assert edges[0] == there[:, k].min() and edges[-1] == there[:, k].max()
        for row in range(2):
            own = states[:, row, k]
            expected, _ = np.histogram(own[np.isfinite(own)], 7, (edges[0], edges[-1]))
            assert np.array_equal(found.counts[row, k], expected)
    with pytest.raises(ValueError, match=r"not \(members, 3\) or \(members, rows, 3\)"):
        plane.histogram(states[0, 0])


def test_so3_in_another_basis_has_no_spheres() -> None:
    stretched = lp.System(
        algebra={"basis": ["a", "b", "c"], "brackets": ["[a, b] = 4*c", "[b, c] = a", "[c, a] = b"]},
        state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6",
    )  # fmt: skip
    assert stretched.histogram(np.eye(3), bins=5).counts.shape == (3, 5)
    driven = lp.System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + cos(t)*y")
    assert driven.histogram(np.eye(3), bins=5).counts.shape == (5, 15)
