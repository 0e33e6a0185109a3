"""Checks that every spec in specs/ describes the system of the test vector of the same name.

For each pair: structure constants, state names, exact initial state, Hamiltonian (as a function),
parameters, matrices; and the vector's gradient, Hessian, Poisson matrix, right-hand side, energy and
Casimir values, recomputed here from the spec with 50 digits and compared to 32.  Also Jacobi, the
representation, and that the declared Casimirs are Casimirs and as many as can be.

    python lab/tools/check_specs.py
"""

import json
import sys
from pathlib import Path

import sympy as sp

import lie_spec

ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = sp.Float("1e-32", 50)


def differences(spec_path, vector_path):
    """Names of everything that does not agree."""
    system = lie_spec.load(spec_path)
    vector = json.loads(vector_path.read_text(encoding="utf-8"))
    names = [str(x) for x in system.coordinates]
    point = dict(zip(system.coordinates, system.initial))
    wrong = []

    def expect(what, holds):
        if not holds:
            wrong.append(what)

    def close(ours, theirs):
        return abs(sp.N(ours.subs(point) if hasattr(ours, "subs") else ours, 50) - sp.Float(theirs, 50)) < TOLERANCE

    expect("state names", names == vector["variables"])
    expect("structure constants",
           {key: v for key, v in system.constants.items() if key[0] < key[1]}
           == {(i, j, k): sp.Rational(v) for i, j, k, v in vector["structure_constants"]})
    expect("parameters", system.parameters == {k: sp.Rational(v) for k, v in vector["parameters"].items()})
    symbols = {**system.parameters, **{str(x): x for x in system.coordinates}}
    parse = lambda text: lie_spec.Parser(text, symbols).parse()
    expect("hamiltonian", sp.expand(system.hamiltonian - parse(vector["hamiltonian"])) == 0)
    expect("initial state", system.initial == [parse(text) for text in vector["initial_state_expr"]])
    expect("initial digits", all(close(x, v) for x, v in zip(system.initial, vector["initial_state"])))
    expect("energy", close(system.hamiltonian, vector["energy"]))
    expect("casimirs", sorted(str(sp.expand(c)) for _, c in system.casimirs)
           == sorted(str(sp.expand(parse(c["expr"]))) for c in vector["casimirs"]))
    expect("casimir values", all(close(parse(c["expr"]), c["value"]) for c in vector["casimirs"]))
    if "matrix_representation" in vector:
        expect("matrices", system.matrices == [sp.Matrix([[sp.Rational(v) for v in row] for row in m])
                                               for m in vector["matrix_representation"]])
    here = vector["pointwise_at_initial_state"]
    n = system.dimension
    pi, field = system.poisson(), system.field()
    hessian = [[sp.diff(g, x) for x in system.coordinates] for g in system.gradient]
    expect("gradient", all(close(system.gradient[i], here["gradient"][i]) for i in range(n)))
    expect("hessian", all(close(hessian[i][j], here["hessian"][i][j]) for i in range(n) for j in range(n)))
    expect("poisson matrix", all(close(pi[i, j], here["poisson_matrix"][i][j]) for i in range(n) for j in range(n)))
    expect("rhs", all(close(field[i], here["rhs"][i]) for i in range(n)))
    expect("jacobi", system.jacobi())
    expect("representation", system.represents())
    expect("casimirs commute", all(system.is_casimir(c) for _, c in system.casimirs))
    generic = {x: sp.Rational(7 * i * i + 3, 5 + i) for i, x in enumerate(system.coordinates)}
    rank = pi.subs(generic).rank()
    expect("generic rank", rank == vector["generic_rank"])
    jacobian = sp.Matrix([[sp.diff(c, x) for x in system.coordinates] for _, c in system.casimirs]).subs(generic)
    expect("number of casimirs", jacobian.rank() == len(system.casimirs) == n - rank)
    return wrong


def main():
    failed = False
    specs = {p.stem: p for p in sorted((ROOT / "specs").glob("*.json")) if not p.name.endswith("schema.json")}
    vectors = {p.stem: p for p in sorted((ROOT / "tests/data/vectors").glob("*.json"))
               if not p.stem.startswith("steps_")}
    for name in sorted(specs.keys() ^ vectors.keys()):
        print(f"{name}: only in {'specs' if name in specs else 'tests/data/vectors'}")
        failed = True
    for name in sorted(specs.keys() & vectors.keys()):
        wrong = differences(specs[name], vectors[name])
        print(f"{name}: {'ok' if not wrong else 'DIFFERS: ' + ', '.join(wrong)}")
        failed |= bool(wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
