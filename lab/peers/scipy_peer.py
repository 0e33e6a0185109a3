"""SciPy: solve_ivp with DOP853 and LSODA, the right-hand side compiled by Numba where that is installed.

Install: python3 -m pip install scipy numba
"""

import json
import math
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from server import serve

try:
    from numba import njit
except ImportError:
    def njit(function):
        return function

CASES = json.loads((Path(__file__).parent / "cases.json").read_text())


def field(given):
    """The right-hand side as a function of the time and the state."""
    size = range(len(given["initial"]))
    lines = [f"y{k} = y[{k}]" for k in size] + given["field"] + ["return np.array([" + ", ".join(f"d{k}" for k in size) + "])"]
    source = "def field(t, y):\n" + "".join(f"    {line}\n" for line in lines)
    values = {"np": np, "cos": math.cos, "exp": math.exp, "rsqrt": njit(lambda x: 1.0 / math.sqrt(x))}
    exec(source, values)
    return njit(values["field"])


def prepare(trials):
    given = CASES[trials.request["case"]]
    function, span = field(given), (0.0, given["until"])
    for method in ["DOP853", "LSODA"]:
        for k in range(8, 54, 8 if trials.request.get("quick") else 2):
            tolerance = 10.0 ** (-0.25 * k)

            def run(method=method, tolerance=tolerance):
                solution = solve_ivp(function, span, given["initial"], method=method, t_eval=[span[1]],
                                     rtol=tolerance, atol=0.1 * tolerance)
                return (solution.y[:, -1], solution.nfev) if solution.success else None

            trials.add("SciPy", method, f"rtol {tolerance:.1e}", run)


if __name__ == "__main__":
    serve(prepare)
