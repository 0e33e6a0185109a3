"""What round-off does to the invariants that methods claim: its bias per step with the standard error over states, and its
root of the mean square. The errors are computed from the rows of `lie run` in exact arithmetic.

    python lab/tools/round_off.py --lie target/release/lie --steps 1000000 --out after.csv
    python lab/tools/round_off.py --table before.csv after.csv

The states are the spec's initial one with independent changes of each coordinate by up to a quarter of the largest; the steps are
h0 of `lie stress` and 8 h0, or 4 h0 or 2 h0 where some step is refused. Errors are relative to the sum of the sizes of the terms.
Lines are appended, and what stands in the file is not measured again.
"""

import argparse
import csv
import json
import os
import random
import shlex
import subprocess
import sys
import tempfile
import time
from fractions import Fraction
from math import sqrt
from pathlib import Path

SPECS = Path(__file__).resolve().parents[2] / "specs"
BODY = [Fraction(1, 4), Fraction(1, 2), Fraction(3, 4)]
TOP = [Fraction(1, 4), Fraction(1, 3), Fraction(1, 2)]
MASSES = [Fraction(n, 10) for n in (9, 7, 5, 4)]
PAIRS = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def squares(x, weights):
    return [w * v * v for w, v in zip(weights, x)]


# the spec, h0, the initial state, and the terms of each invariant
SYSTEMS = {
    "so3": ("so3_free_rigid_body", 0.15, [0.4535961214255773, 0.0, 0.8912073600614354], {
        "energy": lambda x: squares(x, BODY),
        "norm2": lambda x: squares(x, [1] * 3),
    }),
    "se3": ("se3_heavy_top", 0.09, [0.4, 0.3, 0.9, 0.36, 0.48, 0.8], {
        "energy": lambda x: squares(x, TOP) + [x[3] / 3, x[4] / 7, x[5]],
        "length2": lambda x: squares(x[3:], [1] * 3),
        "vertical_momentum": lambda x: [x[k] * x[k + 3] for k in range(3)],
    }),
    "so4": ("so4_manakov", 0.31, [0.5, -0.4, 0.3, 0.6, 0.2, 0.7], {
        "energy": lambda x: squares(x, [1 / (2 * (MASSES[i] + MASSES[j])) for i, j in PAIRS]),
        "norm2": lambda x: squares(x, [1] * 6),
        "pfaffian": lambda x: [x[0] * x[5], -x[1] * x[4], x[2] * x[3]],
    }),
}
# methods that stand with other options too
OPTIONS = {
    "lie-midpoint": ["--retraction cayley"],
    "generating2": ["--retraction cayley"],
    "generating4": ["--retraction cayley"],
    "splitting2": ["--pieces coordinate"],
    "splitting4": ["--pieces coordinate"],
    "collective2": ["--lift hopf"],
    "collective4": ["--lift hopf"],
    "collective6": ["--lift hopf"],
}


def methods(lie, spec):
    """The methods that apply and claim something, with what they claim."""
    answer = json.loads(subprocess.run([lie, "check", spec, "--json"], capture_output=True, text=True, check=True).stdout)
    applies = [method for method, why in answer["methods"].items() if why is None]
    listed = json.loads(subprocess.run([lie, "methods", "--json"], capture_output=True, text=True, check=True).stdout)
    for entry in listed:
        kept = entry["preserves"]
        energy = kept["energy"] or kept["quadratic_invariants"]
        casimirs = kept["casimirs"] or kept["quadratic_casimirs"] or kept["orbit"]
        if entry["id"] not in applies or not (energy or casimirs):
            continue
        for option in ["", *OPTIONS.get(entry["id"], [])]:
            if option != "--lift hopf" or "so3" in spec:
                yield f"{entry['id']} {option}".strip(), energy, casimirs


def states(initial, count):
    generator = random.Random(31)
    reach = 0.25 * max(abs(x) for x in initial)
    return [[x + reach * generator.uniform(-1, 1) for x in initial] for _ in range(count)]


def rows(lie, spec, method, step, steps, starts):
    """First and last state of each run; nothing where a step is refused."""
    with tempfile.TemporaryDirectory() as folder:
        first, out = Path(folder, "initial.csv"), Path(folder, "out.csv")
        first.write_text("".join(",".join(map(repr, start)) + "\n" for start in starts))
        call = [lie, "run", spec, "--method", method, "--initial-file", str(first), "--step", repr(step)]
        call += ["--until", repr(step * steps), "--every", str(steps), "--out", str(out), "--quiet"]
        run = subprocess.run(call, capture_output=True, text=True, check=False)
        if run.returncode:
            return None, run.stderr.strip()
        with out.open() as file:
            table = list(csv.DictReader(file))
    size = len(starts[0])
    columns = list(table[0])
    at = columns.index("t") + 1
    values = [[Fraction(float(row[name])) for name in columns[at:at + size]] for row in table]
    ends = [values[2 * k:2 * k + 2] for k in range(len(starts))]
    assert all([float(v) for v in end[0]] == start for end, start in zip(ends, starts)), "rows out of order"
    return ends, ""


def measure(arguments):
    found = Path(arguments.out)
    known = set()
    if found.exists():
        with found.open() as file:
            known = {(row["system"], row["method"], row["h"], row["steps"]) for row in csv.DictReader(file)}
    else:
        found.write_text("system,method,invariant,h,steps,states,bias,error,rms,seconds\n")
    for name in arguments.systems.split(","):
        file, h0, initial, invariants = SYSTEMS[name]
        spec = str(SPECS / f"{file}.json")
        wanted = arguments.methods.split(",") if arguments.methods else None
        starts = states(initial, arguments.states)
        for method, energy, casimirs in methods(arguments.lie, spec):
            if wanted and method not in wanted:
                continue
            for factors in ([1], [8, 4, 2]):
                for factor in factors:
                    h = h0 * factor
                    if (name, method, repr(h), str(arguments.steps)) in known:
                        break
                    began = time.perf_counter()
                    ends, why = rows(arguments.lie, spec, method, h, arguments.steps, starts)
                    seconds = time.perf_counter() - began
                    if ends is None:
                        print(f"{name} {method} h = {h}: {why.splitlines()[0] if why else '?'}", file=sys.stderr)
                        continue
                    for invariant, terms in invariants.items():
                        if not (energy if invariant == "energy" else casimirs):
                            continue
                        errors = [
                            float((sum(terms(last)) - sum(terms(first))) / sum(abs(term) for term in terms(first)))
                            for first, last in ends
                        ]
                        n = len(errors)
                        mean = sum(errors) / n
                        deviation = sqrt(sum((e - mean) ** 2 for e in errors) / (n - 1))
                        line = [name, method, invariant, repr(h), arguments.steps, n, f"{mean / arguments.steps:.3e}",
                                f"{deviation / sqrt(n) / arguments.steps:.1e}", f"{sqrt(sum(e * e for e in errors) / n):.2e}", f"{seconds:.2f}"]
                        with found.open("a") as out:
                            out.write(",".join(map(str, line)) + "\n")
                        print(*line, flush=True)
                    break


def table(before, after):
    """Prints what was found before and after as a table of Markdown; a bias beyond three of its errors is bold."""
    keys = ("system", "method", "invariant", "h", "steps")
    found = []
    for path in (before, after):
        with Path(path).open() as file:
            found.append({tuple(row[key] for key in keys): row for row in csv.DictReader(file)})
    print("| system | method | invariant | h | steps | before: bias a step | RMS | after: bias a step | RMS |")
    print("|---|---|---|---|---|---|---|---|---|")

    def shown(row):
        if row is None:
            return ["–", "–"]
        bias, error = float(row["bias"]), float(row["error"])
        text = f"{bias:+.1e} ± {error:.0e}"
        return [f"**{text}**" if abs(bias) > 3 * error else text, f"{float(row['rms']):.1e}"]

    for key in sorted(set(found[0]) | set(found[1]), key=lambda key: [list(SYSTEMS).index(key[0]), key[1:3], float(key[3]), int(key[4])]):
        cells = [*key[:3], f"{float(key[3]):g}", f"{int(key[4]):.0e}".replace("e+0", "e")]
        print("| " + " | ".join(cells + shown(found[0].get(key)) + shown(found[1].get(key))) + " |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--table", nargs=2, metavar=("BEFORE", "AFTER"))
    parser.add_argument("--lie", default=os.environ.get("LIE", "lie"))
    parser.add_argument("--systems", default="so3,se3,so4")
    parser.add_argument("--methods", help="separated by commas; all that claim an invariant if absent")
    parser.add_argument("--steps", type=lambda text: int(float(text)), default=1_000_000)
    parser.add_argument("--states", type=int, default=16)
    parser.add_argument("--out", default="round_off.csv")
    arguments = parser.parse_args()
    if arguments.table:
        table(*arguments.table)
    else:
        measure(arguments)


if __name__ == "__main__":
    main()
