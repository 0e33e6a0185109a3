"""Structure-preserving integrators for Lie–Poisson systems.

A system is declared by an algebra, a state and a Hamiltonian; the compiler checks the algebra exactly, derives everything
else and makes machine code of it.

>>> import liepoisson as lp
>>> body = lp.System(algebra="so(3)", state=["x", "y", "z"], parameters={"I1": 2, "I2": 1, "I3": "2/3"},
...                  hamiltonian="x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)")
>>> run = body.run("lie-midpoint", h=0.1, t=10, x0=[0.8, 0.1, 0.6])
>>> run.mu.shape
(101, 3)
>>> bool(abs(run.casimirs["C1"] - run.casimirs["C1"][0]).max() < 1e-14)
True
"""

from __future__ import annotations

from ._bench import Bench, BenchRow
from ._check import Casimir, Check, Motion
from ._core import __version__ as __version__
from ._ensemble import Ensemble, MemberOccurrences
from ._errors import DeclarationError, IntegrationError, Interrupted, LostShares, MethodError
from ._functions import Function
from ._histogram import Histogram
from ._methods import Method, Methods
from ._solution import Occurrences, Solution
from ._spectra import Exponents, Frequencies, Line
from ._stress import Growth, Stress, StressCell
from ._system import System, load
from ._verification import Fact, Verification

__all__ = [
    "Bench",
    "BenchRow",
    "Casimir",
    "Check",
    "DeclarationError",
    "Ensemble",
    "Exponents",
    "Fact",
    "Frequencies",
    "Function",
    "Growth",
    "Histogram",
    "IntegrationError",
    "Interrupted",
    "Line",
    "LostShares",
    "MemberOccurrences",
    "Method",
    "MethodError",
    "Methods",
    "Motion",
    "Occurrences",
    "Solution",
    "Stress",
    "StressCell",
    "System",
    "Verification",
    "load",
]
