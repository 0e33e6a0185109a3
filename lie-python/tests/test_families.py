"""Families: as many sites as the parameters say."""

from __future__ import annotations

import pickle

import liepoisson as lp
import numpy as np
import pytest

RING = {
    "name": "Ring",
    "algebra": "so(3)^N",
    "state": ["x[i]", "y[i]", "z[i]"],
    "parameters": {"N": 12, "J": 1},
    "hamiltonian": "-J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1])",
    "initial": {"random": "unit-sphere", "seed": 1},
}
LATTICE = {
    **RING,
    "algebra": "so(3)^(N, M)",
    "state": ["x[i, j]", "y[i, j]", "z[i, j]"],
    "parameters": {"N": 3, "M": 4},
    "hamiltonian": "-sum(i in 0..N, j in 0..M: x[i, j]*x[i+1, j] + z[i, j]*z[i, j+1])",
}

CUBE = {
    **RING,
    "algebra": "so(3)^(L, N, M)",
    "state": ["x[i, j, k]", "y[i, j, k]", "z[i, j, k]"],
    "parameters": {"L": 3, "N": 2, "M": 4},
    "hamiltonian": "-sum(i in 0..L, j in 0..N, k in 0..M: x[i, j, k]*x[i+1, j, k] + B[i, j, k]*z[i, j, k])"
    " - sum(i in 0..L, j in 0..N, k in 0..M-1: z[i, j, k]*z[i, j, k+1])",
}


def test_the_sizes_are_those_of_the_parameters() -> None:
    ring = lp.System(**RING)
    assert (ring.dimension, ring.coordinates[12]) == (36, "y[0]")
    assert ring.casimirs == ["C1_mean", "C1_min", "C1_max"]
    run = ring.run("splitting4", h=0.1, t=1, N=5)
    assert run.mu.shape == (11, 15) and run.sites.shape == (11, 5, 3)
    # a state holds the first coordinates of all sites, then the second ones
    assert np.array_equal(run.sites[3, 2], run.mu[3, [2, 7, 12]])
    assert np.array_equal(run["y[2]"], run.sites[:, 2, 1])
    assert run.drift["C1_mean"] < 1e-14 < run.drift["energy"] < 1e-3
    by_site = ring.run("splitting4", h=0.1, t=1, N=5, x0=run.sites[0])
    assert np.array_equal(by_site.mu, run.mu)
    assert "12 sites with x, y, z" in repr(pickle.loads(pickle.dumps(ring)))
    assert r"\sum_{0 \le i < N} (x_{i}" in ring.latex()


def test_fields_by_numpy() -> None:
    lattice = lp.System(**LATTICE)
    run = lattice.run(t=0.1)
    assert run.method == "gauss16" and run.sites.shape[1:] == (3, 4, 3)
    field = lattice.function("vector_field")(run.mu[0])
    mu = run.sites[0]
    x, z = mu[..., 0], mu[..., 2]
    slope = np.zeros_like(mu)
    slope[..., 0] = -np.roll(x, 1, axis=0) - np.roll(x, -1, axis=0)
    slope[..., 2] = -np.roll(z, 1, axis=1) - np.roll(z, -1, axis=1)
    expected = np.moveaxis(np.cross(mu, slope), -1, 0).reshape(-1)
    assert np.abs(field - expected).max() < 1e-15
    assert np.abs(field + expected).max() > 1e-1


def test_fields_of_three_dimensions_by_numpy() -> None:
    field = np.linspace(-1, 2, 24).reshape(3, 2, 4)
    cube = lp.System(**{**CUBE, "parameters": {**CUBE["parameters"], "B": field}})
    assert "3 x 2 x 4 sites" in repr(cube) and cube.coordinates[13] == "x[1][1][1]"
    run = cube.run(t=0.1)
    assert run.sites.shape[1:] == (3, 2, 4, 3)
    mu = run.sites[0]
    x, z = mu[..., 0], mu[..., 2]
    slope = np.zeros_like(mu)
    slope[..., 0] = -np.roll(x, 1, axis=0) - np.roll(x, -1, axis=0)
    slope[..., 2] = -field
    slope[..., :-1, 2] -= z[..., 1:]
    slope[..., 1:, 2] -= z[..., :-1]
    expected = np.moveaxis(np.cross(mu, slope), -1, 0).reshape(-1)
    assert np.abs(cube.function("vector_field")(run.mu[0]) - expected).max() < 1e-15
    again = cube.run("rk4", h=0.05, t=0.1, x0=mu)
    assert np.array_equal(again.mu[0], run.mu[0])
    with pytest.raises(ValueError, match=r"\(3, 2, 4, 3\), the coordinates of each site"):
        cube.run(t=0.1, x0=np.moveaxis(mu, 0, 1))
    with pytest.raises(lp.DeclarationError, match="2 x 3 x 4 values, and there are 3 x 2 x 4"):
        wrong = field.reshape(2, 3, 4)
        lp.System(**{**CUBE, "parameters": {**CUBE["parameters"], "B": wrong}})


def test_members_are_single_runs() -> None:
    ring = lp.System(**RING)
    alone = ring.run("rk4", h=0.05, t=1, N=5)
    starts = np.stack([alone.sites[0], -alone.sites[0]])
    many = ring.ensemble(starts, "rk4", h=0.05, t=1, N=5, J=[1.0, 2.0])
    assert np.array_equal(many.mu[0], alone.mu[-1])
    assert not np.array_equal(many.mu[1], -alone.mu[-1])


def test_small_ones_are_verified() -> None:
    ring = lp.System(**RING)
    assert ring.verify("rk4", "splitting2", N=6).passed
    with pytest.raises(ValueError, match="fewer sites, at most 21"):
        ring.verify("rk4", N=100)


def test_small_ones_are_measured() -> None:
    ring = lp.System(**RING)
    found = ring.bench("rk4", "splitting2", N=4, t=1, budget=0.01)
    assert {row.method for row in found.rows} == {"rk4", "splitting2"}
    assert min(found["error"]) < 1e-6 < max(found["error"])
    limits = ring.stress("splitting2", N=4, steps=500)
    assert {cell.name for cell in limits.cells} >= {"J", "z[3]"}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda ring: ring.run(x0=[1, 2, 3], N=4), r"give \(12,\), .*, or \(4, 3\)"),
        (lambda ring: ring.run(N=2.5), "a whole number"),
        (lambda ring: ring.run("midpoint"), "keeps no matrix"),
        (lambda ring: ring.bench("rk4", N=40_000), "fewer sites, at most 33333"),
        (lambda ring: ring.stress("rk4", N=100), "fewer sites, at most 21"),
        (lambda ring: ring.ensemble(np.zeros((2, 12)), "rk4", N=[4, 5]), "as many sites"),
    ],
)
def test_what_is_wrong_is_said(call, message) -> None:
    with pytest.raises((ValueError, AttributeError), match=message):
        call(lp.System(**RING))


def test_no_family_has_no_sites() -> None:
    body = lp.System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
    with pytest.raises(AttributeError, match="is no family"):
        print(body.run(x0=[1, 0, 0], t=0.1).sites)


def test_values_of_sites_are_arrays() -> None:
    fields = np.array([1.0, -0.5, 2.0, 0.25])
    chain = lp.System(
        algebra="so(3)^N",
        state=["x[i]", "y[i]", "z[i]"],
        parameters={"N": 4, "B": fields},
        hamiltonian="sum(i in 0..N: B[i]*z[i])",
        initial={"random": "unit-sphere", "seed": 1},
    )
    found = chain.run("splitting2", h=0.1, t=1)
    start, end = found.mu[0].reshape(3, 4), found.mu[-1].reshape(3, 4)
    # x' = B y, y' = -B x: each turns about z by the angle of its field
    turned = (start[0] + 1j * start[1]) * np.exp(-1j * fields)
    assert np.allclose(end[0] + 1j * end[1], turned, atol=1e-13)
    with pytest.raises(lp.DeclarationError, match="`B` has 4 values, and there are 5 sites"):
        lp.System(chain.text.replace('"N": 4', '"N": 5'))


def test_damping_noise_and_observables() -> None:
    spins = lp.System(
        name="Spins",
        algebra="so(3)^N",
        state=["x[i]", "y[i]", "z[i]"],
        parameters={"N": 400, "T": 0.3},
        hamiltonian="sum(i in 0..N: z[i])",
        dissipation=[{"kind": "double-bracket", "strength": 1, "temperature": "T"}],
        observables={"m": "sum(i in 0..N: z[i])/N"},
        initial={"random": "unit-sphere", "seed": 1},
    )
    run = spins.run("gauss8", h=0.1, t=8, seed=7)
    assert (run.seed, run.mu.shape, run.sites.shape) == (7, (81, 1200), (81, 400, 3))
    assert np.allclose(run["m"], run.sites[..., 2].mean(axis=1), atol=1e-14)
    # L(1/T) within four errors of 400 spins
    assert abs(run["m"][-1] + 1 / np.tanh(1 / 0.3) - 0.3) < 4 * np.sqrt(1 / 3 / 400)
    assert np.abs(np.linalg.norm(run.sites, axis=2) - 1).max() < 1e-13
    cold = spins.run("gauss8", h=0.1, t=2, T=0, N=5)
    assert np.all(np.diff(cold.energy) < 0) and cold["work"][-1] < -1
    assert np.allclose(cold.energy - cold["work"], cold.energy[0], atol=1e-13)
    assert list(cold.drift) == ["C1_mean", "C1_min", "C1_max"]
    assert np.array_equal(cold.at([1.0])[0], cold.mu[10])
    again = spins.run("gauss8", h=0.1, t=2, T=0, x0=cold.sites[0], N=5)
    assert np.array_equal(again.mu, cold.mu)
    ends = spins.ensemble(members=3, seed=2, t=1, N=5, method="gauss8", h=0.1)
    assert ends.mu.shape == (3, 15) and not np.array_equal(ends.mu[0], ends.mu[1])
    field = spins.function("vector_field", N=5)(cold.mu[0])
    slope = np.array([0.0, 0.0, 1.0])
    moved = np.cross(cold.sites[0], slope)
    assert np.allclose(field.reshape(3, 5).T, moved + np.cross(cold.sites[0], moved), atol=1e-15)


def test_bonds_between_any_two_sites() -> None:
    bonds = [[i, (i + 1) % 12, 1] for i in range(12)]
    by_bonds = lp.System(
        **{
            **RING,
            "bonds": bonds,
            "hamiltonian": "-J*sum(bonds: value*(x[i]*x[j] + y[i]*y[j] + z[i]*z[j]))",
        }
    )
    one, other = (system.run("gauss8", h=0.1, t=3) for system in (by_bonds, lp.System(**RING)))
    assert np.allclose(one.mu, other.mu, atol=1e-12)
    assert r"\mathrm{bonds}" in by_bonds.latex()
    with pytest.raises(lp.DeclarationError, match="joins the sites 0 and 12, and there are 12 sites"):
        lp.System(**{**RING, "bonds": [[0, 12, 1]], "hamiltonian": "sum(bonds: value*x[i]*x[j])"})
    with pytest.raises(ValueError, match="joins the sites"):
        by_bonds.run("gauss8", h=0.1, t=1, N=5)


def test_inputs_are_for_all_sites() -> None:
    driven = lp.System(
        **{
            **RING,
            "inputs": {"u": {"default": 0, "sampling": 0.1}},
            "noise": [{"force": {"x[i]": "0*x[i]"}}],
            "hamiltonian": "-sum(i in 0..N: x[i]*x[i+1] + z[i]*z[i+1]) - sum(i in 0..N: (u + cos(t))*z[i])",
        }
    )
    seen: list[tuple[float, tuple[int, ...]]] = []

    def along(t: float, mu: np.ndarray, g: np.ndarray | None) -> float:
        seen.append((t, mu.shape))
        return float(-mu[24:].mean())

    run = driven.run("gauss8", h=0.05, t=1, inputs={"u": along})
    # what the function sees is the state of the sites, without what is carried beside them
    assert {shape for _, shape in seen} == {(36,)} and run.mu.shape == (21, 36)
    sampled = run.sites[::2, :, 2].mean(axis=1)
    assert np.allclose(run["u"][::2], -sampled, atol=1e-15) and abs(sampled).max() > 1e-3
    again = driven.run("gauss8", h=0.05, t=1, inputs={"u": np.column_stack([run.t, run["u"]])[::2]})
    assert np.allclose(again.mu, run.mu, atol=1e-13)
    balance = run.energy - run["work"]
    assert abs(balance - balance[0]).max() < 1e-12 < abs(run["work"]).max()
    plain = driven.run("gauss8", h=0.05, t=1)
    assert abs(plain.mu - run.mu).max() > 1e-3
