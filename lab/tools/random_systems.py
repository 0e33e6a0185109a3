"""Twelve random Lie-Poisson systems with 30-digit reference trajectories.

    python lab/tools/random_systems.py             rewrite tests/data/random/
    python lab/tools/random_systems.py --check     recompute and compare

Random, from seed 2018: the basis (rational shears, scalings and a permutation of that of a known algebra), the
names, the shape and the coefficients of H, the initial state.  Fixed, so that nothing is left out: the
list of algebras and which functions H must contain.

A drawing is kept for the longest end time T of 10, 5, 2 for which
  * every component stays below 50 (the data promise 100),
  * no propagator D phi_{t,s} with 0 <= s <= t <= T has a norm above 300: errors are not amplified beyond that,
  * the three-stage Gauss method with h = 1/100 in double precision stays within 5e-11 (the tests ask for 1e-9),
  * something moves: some component changes by more than 1/10.
If there is none, the next drawing is tried.  The reference is a Taylor run of order 40 (320 bits) straight
from the structure constants, confirmed by one of order 30 with other steps (agreement demanded: 1e-34) and by
scipy's DOP853 in double precision (1e-10).
"""

import json
import math
import random
import sys
from pathlib import Path

import numpy as np
import sympy as sp

import algebras
import lie_spec
import reference
from hamiltonians import Shape, rational

SEED = 2018
TARGET = Path(__file__).resolve().parents[2] / "tests/data/random"
TIMES = ["0", "1/10", "1/3", "1/2", "1", "2", "5", "10"]
NAME_STYLES = [
    ["u", "v", "w"], ["α", "β", "γ", "δ", "ε"], ["qa", "qb", "qc", "ra", "rb", "rc", "sa", "sb", "sc", "sd"],
    ["Xi", "Eta", "Zeta"], ["ka", "lu", "mo", "ne", "pu", "ri", "so", "ta", "vu", "wy"], ["L_", "K_", "N_"],
]


class Recipe:
    """What is fixed of a system: its algebra, how far the basis moves, what H must contain."""

    def __init__(self, name, what, algebra, functions, shears=0, casimirs=0, exact=None, abbreviate=False):
        self.name, self.what, self.algebra, self.functions = name, what, algebra, functions
        self.shears, self.casimirs, self.exact, self.abbreviate = shears, casimirs, exact, abbreviate


K = sp.Symbol("kappa")
RECIPES = [
    Recipe("01_aff1", "aff(1), basis changed", algebras.aff1(), ["exp", "rational"], 2),
    Recipe("02_so3", "so(3), basis changed", algebras.so3(), ["sqrt", "sin"], 3, 1),
    Recipe("03_sl2", "sl(2), basis changed", algebras.sl2(), ["tanh", "cubic", "cosh"], 3, 1),
    Recipe("04_gl2", "gl(2), basis changed", algebras.gl2(), ["exp", "cos", "quartic"], 4, 2),
    Recipe("05_h3_aff1", "the direct sum of the Heisenberg algebra and aff(1), basis changed",
           algebras.heisenberg() + algebras.aff1(), ["tan", "atan", "power"], 4),
    Recipe("06_sl2_plane", "the semidirect product of sl(2) and R^2, basis changed", algebras.sl2_plane(),
           ["log", "quartic"], 4, 1, abbreviate=True),
    Recipe("07_se3", "the semidirect product of so(3) and R^3, basis changed", algebras.se3(),
           ["three_halves", "sin", "cubic"], 5, 2),
    Recipe("08_gl2_plane", "the semidirect product of gl(2) and R^2", algebras.gl2_plane(), ["cubic", "log", "rational"]),
    Recipe("09_so3_sl2_line", "the direct sum of so(3), sl(2) and R, basis changed",
           algebras.so3() + algebras.sl2() + algebras.line(), ["cos", "asin", "atan2"], 9),
    Recipe("10_so3_e2_aff1", "the direct sum of a deformed so(3), e(2) and aff(1) with an exact parameter",
           algebras.so3_deformed(K) + algebras.e2() + algebras.aff1(), ["sinh", "acos", "tanh"], 0, 2,
           exact={"kappa": "3/5"}),
    Recipe("11_so3_two_vectors", "the semidirect product of so(3) and R^3 + R^3, basis changed",
           algebras.so3_two_vectors(), ["rational", "sqrt"], 5, 2, abbreviate=True),
    Recipe("12_so4_space", "the semidirect product of so(4) and R^4, basis changed", algebras.so4_space(),
           ["quartic", "exp", "tanh"], 5, 1),
]


def draw_basis(rng, n, shears):
    """An invertible rational matrix: a permutation, scalings and shears of the identity."""
    rows = list(range(n))
    rng.shuffle(rows)
    p = sp.zeros(n)
    for a, i in enumerate(rows):
        p[a, i] = rng.choice([1, 1, -1, 2, sp.Rational(1, 2), sp.Rational(3, 2)])
    for _ in range(shears):
        a, b = rng.sample(range(n), 2)
        p[a, :] += rational(rng, 2, 3) * p[b, :]
    return p


def draw_names(rng, n):
    """Names in one style, numbered where it has too few; none is a word of the language."""
    style = list(rng.choice(NAME_STYLES))
    rng.shuffle(style)
    if len(style) >= n:
        return style[:n]
    return [f"{style[i % len(style)]}{i // len(style) + 1}" for i in range(n)]


def text(expression):
    return str(expression).replace("**", "^")


def bracket_texts(rng, algebra, names):
    """The brackets in random order, each the one way round or the other."""
    out = []
    for (i, j), value in sorted(algebra.brackets.items()):
        if rng.random() < 0.4:
            i, j, value = j, i, {k: -v for k, v in value.items()}
        terms = []
        for k, v in sorted(value.items()):
            sign, size = ("-", -v) if v.could_extract_minus_sign() else ("+", v)
            body = names[k] if size == 1 else f"{text(size)}*{names[k]}"
            terms.append(f" {sign} {body}" if terms else f"-{body}" if sign == "-" else body)
        out.append(f"[{names[i]}, {names[j]}] = {''.join(terms)}")
    rng.shuffle(out)
    return out


def draw(recipe, rng):
    """A spec as a dictionary."""
    n = recipe.algebra.dimension
    algebra = recipe.algebra.change_basis(draw_basis(rng, n, recipe.shears)) if recipe.shears else recipe.algebra
    basis, state = draw_names(rng, n), draw_names(rng, n)
    shape = Shape(rng, state)
    hamiltonian = shape.hamiltonian(recipe.functions, abbreviate=recipe.abbreviate)
    spec = {
        "$schema": "../../../specs/lie-system.schema.json",
        "format": 1,
        "name": "Random" + recipe.name.title().replace("_", ""),
        "description": f"A random system on {recipe.what}. Written by lab/tools/random_systems.py, seed {SEED}.",
        "algebra": {"basis": basis, "brackets": bracket_texts(rng, algebra, basis)},
        "state": state,
    }
    parameters = {name: {"default": value, "exact": True} for name, value in (recipe.exact or {}).items()}
    parameters.update(shape.parameters)
    if parameters:
        spec["parameters"] = parameters
    if shape.lets:
        spec["let"] = shape.lets
    spec["hamiltonian"] = hamiltonian
    if recipe.casimirs:
        coordinates = [sp.Symbol(name) for name in state]
        spec["casimirs"] = [f"K{i + 1} = {text(c(coordinates))}"
                            for i, c in enumerate(algebra.casimirs[:recipe.casimirs])]
    spec["initial"] = [str(rational(rng, 12, 10)) for _ in range(n)]
    return spec


def shifted(doubles, h, times):
    """States of gauss6 at the times: on the grid, or by one shorter step from the grid point before."""
    steps = [math.floor(t / h + 1e-9) for t in times]
    grid = np.vstack([doubles.initial, doubles.gauss6(h, max(steps))])
    out = []
    for t, k in zip(times, steps):
        rest = t - k * h
        out.append(grid[k] if abs(rest) < 1e-9 * h else doubles.gauss6(rest, 1, grid[k])[0])
    return np.array(out)


def bound(value):
    """The power of ten above a measured error: a number that does not depend on the machine."""
    return "0" if value == 0 else f"1e{max(-15, math.ceil(math.log10(value)))}"


def unsuitable(doubles, times):
    """Why the rule of this file does not admit the last of the times, `None` if it does."""
    floats = [float(sp.Rational(t)) for t in times]
    with np.errstate(all="ignore"):
        try:
            amplification, largest = doubles.amplification(floats[-1])
            if not (largest < 50 and amplification < 300):
                return f"components up to {largest:.0e}, errors amplified by {amplification:.0e}"
            states = doubles.dop853(floats)
            if np.ptp(states, axis=0).max() < 0.1:
                return "nothing moves"
            error = np.abs(shifted(doubles, 0.01, floats) - states).max()
            return None if error < 5e-11 else f"gauss6 reaches {error:.0e} only"
        except (ArithmeticError, np.linalg.LinAlgError) as failure:
            return str(failure)


def compute(spec):
    """The reference of a drawing, or the reason why it is not kept."""
    system = lie_spec.System(json.loads(json.dumps(spec), parse_int=sp.Integer))
    if not system.jacobi() or not all(system.is_casimir(c) for _, c in system.casimirs):
        raise AssertionError("the generator made no Lie algebra")
    doubles = reference.Doubles(system)
    for end in (10, 5, 2):
        times = [t for t in TIMES if sp.Rational(t) <= end]
        reason = unsuitable(doubles, times)
        if reason is None:
            break
    else:
        return reason
    first = reference.taylor(system, times, 40, 48)
    second = reference.taylor(system, times, 30, 46)
    agreement = max(abs(float((a - b).mid())) for x, y in zip(first, second) for a, b in zip(x, y))
    assert agreement < 1e-34, f"the two Taylor runs differ by {agreement}"
    states = [[reference.text(v) for v in state] for state in first]
    exact = np.array([[float(v) for v in state] for state in states])
    floats = [float(sp.Rational(t)) for t in times]
    dop853 = np.abs(doubles.dop853(floats) - exact).max()
    assert dop853 < 1e-10, f"DOP853 differs by {dop853}"
    gauss6 = np.abs(shifted(doubles, 0.01, floats) - exact).max()
    assert gauss6 < 1e-10, f"gauss6 differs by {gauss6}"
    amplification, _ = doubles.amplification(floats[-1])
    values = dict(zip(system.coordinates, system.initial))
    return {
        "format": "lie-poisson-reference/1",
        "seed": SEED,
        "times": times,
        "states": states,
        "energy": str(sp.N(system.hamiltonian.subs(values), 30)),
        "casimirs": [str(sp.N(c.subs(values), 30)) for _, c in system.casimirs],
        "taylor": {"orders": [40, 30], "bits": reference.BITS, "agreement": f"{agreement:.0e}"},
        "dop853": bound(dop853),
        "gauss6": {"step": "1/100", "error": bound(gauss6)},
        "amplification": math.ceil(amplification / 10) * 10,
    }


def layout(value, indent=0):
    """JSON with one line per item of the outer levels and none inside short lists."""
    flat = json.dumps(value, ensure_ascii=False)
    if len(flat) + indent <= 100 or not isinstance(value, (dict, list)):
        return flat
    pad = " " * (indent + 2)
    if isinstance(value, dict):
        items = [f"{pad}{json.dumps(k, ensure_ascii=False)}: {layout(v, indent + 2)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + "\n" + " " * indent + "}"
    return "[\n" + ",\n".join(pad + layout(v, indent + 2) for v in value) + "\n" + " " * indent + "]"


def main():
    check, failed = "--check" in sys.argv[1:], False
    TARGET.mkdir(parents=True, exist_ok=True)
    for recipe in RECIPES:
        attempt = 0
        while True:
            # A generator per drawing: a change of one recipe leaves the other systems as they are.
            rng = random.Random(f"{SEED} {recipe.name} {attempt}")
            spec = draw(recipe, rng)
            result = compute(spec)
            if isinstance(result, dict):
                break
            print(f"{recipe.name}: drawing {attempt} rejected, {result}", flush=True)
            attempt += 1
        result = {"format": result.pop("format"), "system": recipe.name, "drawing": attempt, **result}
        spec["run"] = {"method": "gauss6", "step": "1/100", "at": result["times"]}
        for suffix, value in ((".json", spec), (".reference.json", result)):
            path, content = TARGET / (recipe.name + suffix), layout(value) + "\n"
            if check:
                same = path.exists() and path.read_text(encoding="utf-8") == content
                failed |= not same
                print(f"{path.name}: {'same' if same else 'DIFFERS'}", flush=True)
            else:
                path.write_text(content, encoding="utf-8")
        print(f"{recipe.name}: T = {result['times'][-1]}, gauss6 {result['gauss6']['error']}, "
              f"amplification {result['amplification']}, Taylor runs agree to {result['taylor']['agreement']}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
