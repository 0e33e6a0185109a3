"""Writes reference values of closed forms, computed to more than 50 digits before they are rounded:

crates/lie-core/src/closed/values.txt: Stumpff functions and phi functions;
tests/data/closed/*.txt: the coadjoint action of exp(x) and the dual of dexp_x, a file per algebra, straight from the
structure constants; tests/data/closed/*.json: the algebras among them that no spec has, some in another basis.

    python lab/tools/closed_forms.py
"""

import json
import random
from pathlib import Path

import sympy as sp
from mpmath import factorial, mp, mpf, nstr

import lie_spec

mp.dps = 500  # the sums cancel where the argument is large
ROOT = Path(__file__).resolve().parents[2]
SIZES = [1e-24, 1e-13, 1e-6, 1e-3, 0.05, 0.3, 0.9, 1.0, 1.0000001, 1.5, 3.0, 4.0, 4.0001, 9.0, 15.9, 16.0, 16.0001, 17.0, 40.0, 100.0,
         350.0, 1e4]
FUNCTIONS = 9


def series(x, k, stride):
    """sum_n x^n/(stride n + k)!"""
    total, term, n = mpf(0), 1 / factorial(k), 0
    while n < 20 or abs(term) > mpf(10) ** -60 * abs(total):
        total += term
        divisor = mpf(1)
        for j in range(stride):
            divisor *= stride * n + k + 1 + j
        term, n = term * x / divisor, n + 1
    return total


def rows(name, sign, stride, largest):
    for x in [0.0] + [s * size for size in SIZES for s in (1, -1) if size <= largest]:
        values = [series(sign * mpf(x), k, stride) for k in range(FUNCTIONS)]
        yield " ".join([name, repr(x)] + [nstr(value, 25) for value in values])


lines = [*rows("stumpff", -1, 2, 1e4), *rows("phi", 1, 1, 350)]
path = ROOT / "crates/lie-core/src/closed/values.txt"
path.parent.mkdir(exist_ok=True)
path.write_text("\n".join(lines) + "\n")


# Functions of ad*_x: each line has x, mu, exp(ad*_x) mu, phi1(ad*_x) mu, and the norms of what relative changes of the entries of
# x and mu do to the two.
mp.dps = 150
DATA = ROOT / "tests/data/closed"
NORMS = [1e-12, 1e-7, 1e-3, 0.1, 1.0, 3.0, 10.0]
SPECS = ["so3_free_rigid_body", "se3_heavy_top", "so4_manakov", "su3_quadratic", "heisenberg_h3", "e2_pendulum", "sl2_quadratic",
         "toda3_solvable", "so3_cotangent_euler_arnold"]
# beside what is removable: angles near 0 and 2 pi, null vectors, one factor at rest
SPECIAL = {
    "so3_free_rigid_body": [[1e-9, -2e-9, 3.0], [6.283185307, 1e-9, 0], [0.6, 0.8, 1e-30], [0, 0, 4.0000001]],
    "se3_heavy_top": [[1e-9, 2e-8, -1e-9, 3.0, -4.0, 5.0], [6.283185, 1e-6, 0, 1.0, 2.0, -0.5], [0, 0, 1e-4, 7.0, 0, 3.0],
                      [0.3, 0.4, 0.5, 1e-9, 0, -1e-9]],
    "so4_manakov": [[1.0, 0.5, -0.25, -0.2500001, -0.5000001, 1.0000001], [1.0, 0.5, -0.25, -0.25, -0.5, 1.0],
                    [1e-9, 0, 2.0, 0, 1e-8, 1e-9], [4.0, 0, 0, 0, 0, -4.0000001]],
    "su3_quadratic": [[0, 0, 0, 0, 0, 0, 1.0, 1.0000001], [0, 0, 0, 0, 0, 0, 3.0, -3.0]],
    "heisenberg_h3": [[1e-9, 5.0, 2.0]],
    "e2_pendulum": [[1e-9, 3.0, -2.0], [6.283185, 1.0, -2.0], [1e-30, 3.0, 1.0], [1.0, 1e-9, 8.0]],
    "sl2_quadratic": [[1.0, 1.0, -1.0], [1.0, 1.0, -1.0000001], [1.0, 1.0, -0.9999999], [1e-9, 3.0, 1e-9], [2.0, 1.5, 3.0], [0.5, -4.0, 2.0]],
    "toda3_solvable": [[1.0, 1.0000001, 0.99, 3.0, -2.0], [2.0, -1.0, 1.0, 1.0, 1.0], [1e-9, 0, -1e-9, 5.0, 4.0]],
    "affine_line": [[1e-9, 3.0], [-9.0, 1e-3], [4.0000001, 2.0], [1.0000001, -5.0]],
}


def in_another_basis(constants, n, seed):
    """Structure constants for a random rational basis."""
    draw = random.Random(seed)
    while True:
        p = sp.Matrix(n, n, lambda i, j: sp.Rational(draw.randint(-3, 3), draw.randint(1, 2)))
        if p.det() != 0:
            break
    inverse, table = p.inv(), {}
    for (i, j, k), value in constants.items():
        for a in range(n):
            for b in range(n):
                for c in range(n):
                    term = p[a, i] * p[b, j] * value * inverse[k, c]
                    table[a, b, c] = table.get((a, b, c), 0) + term
    return {key: value for key, value in table.items() if value != 0}


def spec_of(name, constants, n):
    """A spec with these constants."""
    basis = [f"e{i + 1}" for i in range(n)]
    brackets = []
    for i in range(n):
        for j in range(i + 1, n):
            terms = [f"({constants[i, j, k]})*{basis[k]}" for k in range(n) if (i, j, k) in constants]
            if terms:
                brackets.append(f"[{basis[i]}, {basis[j]}] = {' + '.join(terms)}")
    state = [f"m{i + 1}" for i in range(n)]
    return {"format": 1, "name": name, "description": "An algebra in a basis drawn at random.",
            "algebra": {"basis": basis, "brackets": brackets}, "state": state,
            "hamiltonian": " + ".join(f"{m}^2/2" for m in state), "methods": ["lie-midpoint"], "initial": [1] + [0] * (n - 1)}


def functions(constants, n, x, mu):
    """exp(ad*_x) mu and phi1(ad*_x) mu"""
    matrix = {}
    for i, j, k, value in constants:
        matrix[j, k] = matrix.get((j, k), 0) + value * x[i]
    term, total, other, index = list(mu), list(mu), list(mu), 0
    while index < 30 or max(map(abs, term)) > mpf(10) ** -120:
        index += 1
        moved = [mpf(0)] * n
        for (j, k), value in matrix.items():
            moved[j] += value * term[k]
        term = [entry / index for entry in moved]
        total = [a + b for a, b in zip(total, term)]
        other = [a + b / (index + 1) for a, b in zip(other, term)]
    return total, other


def conditions(constants, n, x, mu):
    """What relative changes of all entries do, in the largest norm."""
    base = functions(constants, n, x, mu)
    sums = [max(map(abs, values)) for values in base]
    tiny = mpf(10) ** -40
    for vector, at in [(x, 0), (mu, 1)]:
        for i in range(n):
            if vector[i] == 0:
                continue
            moved = [list(x), list(mu)]
            moved[at][i] *= 1 + tiny
            values = functions(constants, n, *moved)
            for k in range(2):
                sums[k] += max(abs(a - b) for a, b in zip(values[k], base[k])) / tiny
    return base, sums


def write_functions(name, constants, n):
    draw = random.Random(name)
    exact = [(i, j, k, mpf(int(v.p)) / int(v.q)) for (i, j, k), v in constants.items()]
    elements = []
    for norm in NORMS:
        direction = [draw.gauss(0, 1) for _ in range(n)]
        size = sum(entry * entry for entry in direction) ** 0.5
        elements.append([float(f"{norm * entry / size:.8g}") for entry in direction])
    lines = []
    for x in elements + SPECIAL.get(name, []):
        mu = [draw.randint(-64, 64) / 32 for _ in range(n)]
        values, sums = conditions(exact, n, [mpf(e) for e in x], [mpf(e) for e in mu])
        numbers = [*x, *mu, *map(float, values[0]), *map(float, values[1])]
        lines.append(" ".join([repr(float(v)) for v in numbers] + [nstr(s, 4) for s in sums]))
    (DATA / f"{name}.txt").write_text("\n".join(lines) + "\n")


DATA.mkdir(exist_ok=True)
known = {}
for name in SPECS:
    system = lie_spec.load(ROOT / "specs" / f"{name}.json")
    known[name] = (dict(system.constants), system.dimension)
affine = {(0, 1, 1): sp.Integer(1), (1, 0, 1): sp.Integer(-1)}
others = {"affine_line": (affine, 2)}
for name, of, seed in [("oblique_so3", "so3_free_rigid_body", 1), ("oblique_sl2", "sl2_quadratic", 2), ("oblique_se3", "se3_heavy_top", 3)]:
    constants, n = known[of]
    others[name] = (in_another_basis(constants, n, seed), n)
for name, (constants, n) in others.items():
    title = "".join(word.capitalize() for word in name.split("_"))
    (DATA / f"{name}.json").write_text(json.dumps(spec_of(title, constants, n), indent=1) + "\n")
for name, (constants, n) in {**known, **others}.items():
    write_functions(name, constants, n)
