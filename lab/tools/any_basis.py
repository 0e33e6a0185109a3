"""What `lie check` says of named algebras, in their own bases and in bases that mix all elements under unknown names.

    cargo build --release
    python lab/tools/any_basis.py [--lie target/release/lie] [NAME …]

Writes the table of docs/algebras.md between its markers. Numbers are drawn from seed 2018. A changed basis reaches the compiler as
brackets: nothing of the name is left in them.
"""

import argparse
import json
import random
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/algebras.md"
MARKERS = ("<!-- any basis -->", "<!-- end of any basis -->")


def pairs(n, strict=True):
    return [(i, j) for i in range(1, n + 1) for j in range(i + strict, n + 1)]


def numbered(letter, n):
    return [f"{letter}{i}" for i in range(1, n + 1)]


def entries(letter, places):
    return [f"{letter}{i}{j}" for i, j in places]


def square(n):
    return [(i, j) for i in range(1, n + 1) for j in range(1, n + 1)]


def isometries(n, others):
    rotations = {1: [], 2: ["J"], 3: ["J1", "J2", "J3"]}
    rotations = rotations[n] if n in rotations else entries("J", pairs(n))
    vectors = [[letter] if n == 1 else numbered(letter, n) for letter in others]
    return rotations + sum(vectors, [])


def su(n):
    return [f"{c}{i}{j}" for i, j in pairs(n) for c in "AS"]


def sp(n):
    half = n // 2
    symmetric = pairs(half, strict=False)
    return entries("A", square(half)) + entries("B", symmetric) + entries("C", symmetric)


def sl(n):
    above = pairs(n)
    below = [(j, i) for i, j in above]
    return numbered("H", n - 1) + entries("E", above + below)


# the names of the bases, as docs/algebras.md has them
BASES = {
    "so(3)": ["e1", "e2", "e3"],
    **{f"so({n})": entries("E", pairs(n)) for n in (4, 5, 6, 7)},
    **{f"so({p}, {q})": entries("E", pairs(p + q)) for p, q in ((2, 1), (3, 1), (2, 2), (4, 1))},
    **{f"su({n})": su(n) + [f"D{i}{i + 1}" for i in range(1, n)] for n in (2, 3, 4)},
    **{f"u({n})": su(n) + numbered("D", n) for n in (2, 3)},
    "sl(2)": ["h", "e", "f"],
    **{f"sl({n})": sl(n) for n in (3, 4)},
    **{f"gl({n})": entries("E", square(n)) for n in (2, 3)},
    **{f"sp({n})": sp(n) for n in (2, 4, 6)},
    "se(2)": ["J", "P1", "P2"],
    **{f"se({n})": isometries(n, "P") for n in (3, 4)},
    "heisenberg(1)": ["Q", "P", "Z"],
    **{f"heisenberg({n})": numbered("Q", n) + numbered("P", n) + ["Z"] for n in (2, 4)},
    "aff(1)": ["E", "P"],
    **{f"aff({n})": entries("E", square(n)) + numbered("P", n) for n in (2, 3)},
    "galilei(3)": isometries(3, "KP") + ["H"],
    **{f"poincare({n})": isometries(n, "KP") + ["H"] for n in (1, 2, 3)},
    "diamond": ["N", "Q", "P", "Z"],
    "oscillator(2)": ["N", "Q1", "Q2", "P1", "P2", "Z"],
    **{f"bianchi({kind})": ["e1", "e2", "e3"] for kind in
       ("II", "III", "IV", "V", "VI, -1/4", "VI0", "VII, 4", "VII0", "VIII", "IX")},
    **{f"upper({n})": entries("E", pairs(n)) for n in (3, 4)},
    **{f"toda({n})": numbered("h", n) + numbered("e", n - 1) for n in (2, 3)},
}


def report(lie, algebra, state=None):
    spec = {"name": "Algebra", "algebra": algebra, "hamiltonian": "1"}
    if state:
        spec["state"] = state
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "spec.json"
        path.write_text(json.dumps(spec))
        answer = subprocess.run([lie, "check", path, "--json"], capture_output=True, text=True)
    if answer.returncode:
        raise SystemExit(f"{algebra}: {answer.stderr}")
    found = json.loads(answer.stdout)
    degrees = [c["degree"] if c["kind"] != "rational" else "rational" for c in found["casimirs"]]
    classes = [name for name, holds in found["class"].items() if holds]
    return {
        "name": found["algebra_name"],
        "rank": found["generic_rank"],
        "independent": found["independent_casimirs"],
        "degrees": sorted(degrees, key=str),
        "classes": classes,
    }


def mixed(basis, draw):
    """Combinations of all elements with small coefficients, of determinant one."""
    n = len(basis)
    rows = [[int(i == j) for j in range(n)] for i in range(n)]
    factors = [-2, -1, 0, 1, 2] if n <= 6 else [-1, 0, 0, 0, 1]
    for _ in range(3 if n <= 10 else 2):
        for i in range(n):
            for j in range(n) if n <= 10 else draw.sample(range(n), 2):
                if i != j:
                    factor = draw.choice(factors)
                    rows[i] = [x + factor * y for x, y in zip(rows[i], rows[j])]
    names = [f"q{draw.randint(100, 999)}_{i}" for i in range(n)]
    sums = [" + ".join(f"{c}*{b}" for c, b in zip(row, basis) if c).replace("+ -", "- ") for row in rows]
    return [f"{name} = {text}" for name, text in zip(names, sums)]


def row(lie, name, basis, draw):
    own = report(lie, name)
    other = report(lie, {"named": name, "basis": mixed(basis, draw)}, numbered("u", len(basis)))
    differs = [f"{key}: {other[key]}" for key in own if own[key] != other[key]]
    casimirs = ", ".join(map(str, own["degrees"])) or "none found"
    if len(own["degrees"]) < own["independent"]:
        casimirs += f" (of {own['independent']})" if own["degrees"] else f" of {own['independent']}"
    cells = [
        f"`{name}`", str(len(basis)), own["name"] or "no name", str(own["rank"]),
        casimirs if own["independent"] else "there are none", ", ".join(own["classes"]) or "–",
        "; ".join(differs) or "the same",
    ]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    draw = random.Random(2018)
    lines = [
        "| algebra | dimension | name | generic rank | degrees of Casimirs | class | in the other basis |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in options.names or BASES:
        lines.append(row(options.lie, name, BASES[name], draw))
        print(lines[-1], flush=True)
    if not options.names:
        text = PAGE.read_text()
        start, end = (text.index(marker) for marker in MARKERS)
        PAGE.write_text(text[:start] + MARKERS[0] + "\n" + "\n".join(lines) + "\n" + text[end:])


main()
