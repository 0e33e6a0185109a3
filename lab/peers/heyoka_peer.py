"""heyoka: Taylor's method, compiled at run time, with the recurrences of the right-hand side in `cases.json`.

    heyoka_peer.py DIGITS   prints the references of all cases, in extended precision

Install: python3 -m pip install heyoka
"""

import json
import re
import sys
from pathlib import Path

import heyoka as hy
import numpy as np

from server import serve

CASES = json.loads((Path(__file__).parent / "cases.json").read_text())


def field(case, number=float):
    """The right-hand side as pairs of variable and expression; `number` makes a constant of a literal."""
    given = CASES[case]
    names = [f"y{k}" for k in range(len(given["initial"]))]
    values = dict(zip(names, hy.make_vars(*names)))
    values.update(cos=hy.cos, exp=hy.exp, rsqrt=lambda x: x ** number(-0.5), number=number)
    for line in given["field"]:
        left, right = line.split(" = ")
        right = re.sub(r"(?<![\w.])\d+\.\d*", lambda text: f"number({text.group()})", right)
        values[left] = eval(right, values)
    return [(values[name], values["d" + name[1:]]) for name in names]


def prepare_chain(trials):
    """Case D, in compact mode; the variables are the spins one after the other."""
    quick, until = trials.request.get("quick"), CASES["D"]["until"]
    start = np.array(trials.request["initial"])
    count = len(start) // 3
    spins = np.array(hy.make_vars(*[f"v{k}" for k in range(3 * count)])).reshape(count, 3)
    equations = []
    for spin in range(count):
        v, n = spins[spin], spins[spin - 1] + spins[(spin + 1) % count]
        equations += [(v[0], n[1] * v[2] - n[2] * v[1]), (v[1], n[2] * v[0] - n[0] * v[2]),
                      (v[2], n[0] * v[1] - n[1] * v[0])]
    for k in range(12, 52, 12 if quick else 4):
        tolerance = 10.0 ** (-0.25 * k)
        integrator = hy.taylor_adaptive(equations, start, tol=tolerance, compact_mode=True)

        def run(integrator=integrator):
            integrator.time = 0.0
            integrator.state[:] = start
            steps = integrator.propagate_until(until)[3]
            return integrator.state, steps

        trials.add("heyoka", "taylor, compact mode", f"tol {tolerance:.1e}", run)


def prepare_ensemble(trials):
    """Case C, eight bodies at a time."""
    from ensemble import equations

    quick, until, lanes = trials.request.get("quick"), CASES["C"]["until"], 8
    start = np.array(trials.request["initial"]).reshape(-1, 3)
    groups = [np.ascontiguousarray(start[k : k + lanes].T) for k in range(0, len(start), lanes)]
    ends = np.empty_like(start)
    for k in range(16, 60, 8 if quick else 2):
        tolerance = 10.0 ** (-0.25 * k)
        integrator = hy.taylor_adaptive_batch(equations(), np.zeros((3, lanes)), tol=tolerance)

        def run(integrator=integrator):
            for index, group in enumerate(groups):
                integrator.set_time(0.0)
                integrator.state[:] = group
                integrator.propagate_until(until)
                ends[index * lanes : (index + 1) * lanes] = integrator.state.T
            return ends.ravel(), 0

        trials.add("heyoka", "taylor, 8 at a time", f"tol {tolerance:.1e}", run)


def prepare(trials):
    if trials.request["case"] == "C":
        return prepare_ensemble(trials)
    if trials.request["case"] == "D":
        return prepare_chain(trials)
    case, quick = trials.request["case"], trials.request.get("quick")
    given = CASES[case]
    start, until = np.array(given["initial"]), given["until"]
    equations = field(case)
    for k in range(8, 63, 4 if quick else 1):
        tolerance = 10.0 ** (-0.25 * k)
        for accurate in [False, True] if tolerance < 1e-15 else [False]:
            integrator = hy.taylor_adaptive(equations, start, tol=tolerance, high_accuracy=accurate)

            def run(integrator=integrator):
                integrator.time = 0.0
                integrator.state[:] = start
                steps = integrator.propagate_until(until)[3]
                return integrator.state, steps

            name = "taylor, high accuracy" if accurate else "taylor"
            trials.add("heyoka", name, f"tol {tolerance:.1e}", run)


def reference(case, digits):
    """The state at the end of the span, in extended precision."""
    given = CASES[case]
    bits = int(digits * 3.33) + 10
    number = lambda value: hy.real(value, bits)
    constant = lambda value: hy.expression(number(value))
    # constants are the doubles that everybody computes with; what is derived from them is not rounded
    equations = field(case, constant)
    start = [number(value) for value in given["initial"]]
    integrator = hy.taylor_adaptive(
        equations, start, fp_type=hy.real, prec=bits, tol=number(10.0 ** -digits))
    integrator.propagate_until(number(given["until"]))
    return [float(value) for value in integrator.state]


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps({case: reference(case, int(sys.argv[1])) for case in CASES if "field" in CASES[case]}))
    else:
        serve(prepare)
