"""The corpora of the targets, from every spec of the project, in lab/fuzz/corpus (which is not committed). A corpus that is there stays.

    python lab/fuzz/seeds.py
"""

import json
import struct
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
PLACES = ["specs", "tests/data", "docs/book", "examples", "lab", "crates"]
# What no spec shows of an option.
REQUESTS = [
    {"method": ["rk4", "lie-midpoint --retraction cayley"], "step": 0.1, "until": "1/7", "every": 2},
    {"method": ["dopri5"], "rtol": "1e-9", "atol": 1e-12, "at": [0, "1/2", 1.5], "step": 0.5},
    {"method": ["gauss8"], "iteration": "fixed-point", "newton-tolerance": 0, "max-iterations": 7, "converge": "state", "step": 1},
    {"param": ["I1=1:2:3", ["I2", 0.5], "k = cos(1/3)"], "initial": "0.1,-1/2,cos(11/10)", "step": -0.1, "until": -1},
    {"tol": 1e-9, "from": 1, "until": 3, "group": "quaternion"},
    {"method": ["compose4(lie-midpoint)", "splitting4", "orbit-energy", "gonzalez", "k-hj4"], "composition": "suzuki", "pieces": "found",
     "lift": "hopf", "gradient": "mean-value", "tensor": "mean", "retraction": "exp"},
]


def specs():
    """Every spec, right or wrong, with what it is where it is JSON."""
    for place in PLACES:
        for path in sorted((ROOT / place).rglob("*.json")):
            text = path.read_bytes()
            if path.is_relative_to(FOLDER / "corpus") or len(text) > 8192 or b'"format"' not in text:
                continue
            try:
                spec = json.loads(text)
            except ValueError:
                spec = {}
            yield text, spec if isinstance(spec, dict) else {}


def tables(spec):
    functions = spec.get("functions", {})
    for function in functions.values() if isinstance(functions, dict) else []:
        points = function.get("table") if isinstance(function, dict) else None
        if isinstance(points, list) and all(isinstance(point, list) for point in points):
            yield "\n".join(",".join(str(number) for number in point) for point in points)


def array(rows, columns, kind="<f8"):
    values = [0.1 * k for k in range(rows * columns)]
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    data = struct.pack(f"<{len(values)}{'d' if kind == '<f8' else 'f'}", *values)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


def messages():
    rows = struct.pack("<6d", *(0.5 * k for k in range(6)))
    columns = {"columns": {"coordinates": ["x"], "casimirs": [], "element": 0}}
    said = [{"progress": {"done": 1, "all": 2}}, {"found": columns}, {"found": {"shortened": {"step": 0.25, "time": 0.5}}}]
    lines = "".join(json.dumps(message) + "\n" for message in said).encode()
    yield lines + b'{"found":{"rows":{"count":2,"width":3}}}\n' + rows + b'{"end":"done"}\n'
    run = {"method": "rk4", "start": {"parameters": {"k": 1.5}, "initial": [0.5, 1]}, "pace": {"step": 0.1}, "from": 0,
           "times": {"until": {"end": 1, "every": 1}}, "tolerances": {"rtol": 1e-6, "atol": "inf"},
           "newton": {"iteration": "newton", "tolerance": 1e-3, "max_iterations": 50, "convergence": "map"}}
    yield json.dumps(run).encode()
    yield (FOLDER / "lie.dict").read_bytes()


def corpora():
    found = list(specs())
    texts = [text for text, _ in found]
    states = [spec["initial"] for _, spec in found if isinstance(spec.get("initial"), list)]
    lines = [",".join(str(value) for value in state) for state in states]
    declarations, checkpoints = ([path.read_bytes() for path in sorted((FOLDER / "seeds" / kind).iterdir())]
                                 for kind in ["declaration", "checkpoint"])
    arrays = [array(2, 3), array(1, 6), array(4, 3, "<f4"), array(0, 3), array(3, 2, "<f4")]
    return {
        "spec": texts,
        "read_spec": texts,
        "declaration": declarations,
        "read_declaration": declarations,
        "table": [table.encode() for _, spec in found for table in tables(spec)] + [b"r,drag\n0,1e-3\n+0.5,2\n# end\n1,.5\n"],
        "npy": arrays,
        "initial_file": [line.encode() for line in lines] + [b"z,y,x\n1,2,3\n1/2,cos(1),-1\n", b"\xef\xbb\xbf1,2,3\n# no\n4,5,6"] + arrays,
        "request": [json.dumps(run).encode() for run in [spec.get("run", {}) for _, spec in found] + REQUESTS],
        "messages": list(messages()),
        "checkpoint": checkpoints + [b"lie checkpoint 1, by lie 0\n{}\n"],
    }


def main():
    for target, inputs in corpora().items():
        folder = FOLDER / "corpus" / target
        if folder.exists():
            continue
        folder.mkdir(parents=True)
        for number, data in enumerate(dict.fromkeys(inputs)):
            (folder / f"seed{number:04}").write_bytes(data)


if __name__ == "__main__":
    main()
