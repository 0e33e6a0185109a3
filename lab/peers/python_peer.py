"""lie-poisson as the package that `pip install ./lie-python` makes: one call of `System.run` with a tolerance, which picks method and step,
for each run. The system is made once.

Install: python3 -m pip install ./lie-python
"""

import json
from pathlib import Path

import liepoisson as lp

from server import serve

HERE = Path(__file__).resolve().parent
CASES = json.loads((HERE / "cases.json").read_text())
CHOICES = {"run(tol=)": {}, 'run(tol=, converge="tolerance")': {"converge": "tolerance"}, 'run(tol=, converge="map")': {"converge": "map"}}


def prepare(trials):
    given = CASES[trials.request["case"]]
    system = lp.load(HERE.parent.parent / "specs" / f"{given['spec']}.json")
    parameters = dict(zip(system.parameters, given["parameters"]))
    for name, choice in CHOICES.items():
        for k in range(4, 27, 4 if trials.request.get("quick") else 1):
            tolerance = 10.0 ** (-0.5 * k)

            def run(tolerance=tolerance, choice=choice):
                solution = system.run(tol=tolerance, t=given["until"], x0=given["initial"], **choice, **parameters)
                return solution.mu[-1], len(solution.t) - 1

            trials.add("lie-poisson from Python", name, f"tol {tolerance:.1e}", run)


if __name__ == "__main__":
    serve(prepare)
