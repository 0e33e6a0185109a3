"""What methods keep over 100,000 steps on brackets that are declared by their entries, as a table for each system.

    cargo build --release
    python lab/tools/brackets.py [--lie target/release/lie] [--steps 100000] [SPEC=STEP…]

Each run writes a row every 20 steps. A cell has the largest change of the energy (of the Casimir) and its drift, the mean over the last tenth of
the rows less that over the first. Times are those of a fifth of the steps, without rows, over those of `gauss4`, which runs before each: the
median of three. Where `lie canonical` has coordinates for a bracket, some methods run in these too.
"""

import argparse
import csv
import json
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RUNS = [
    "specs/lotka_volterra.json=0.1",
    "specs/brackets/species5.json=0.1",
    "specs/brackets/nambu.json=0.1",
    "specs/brackets/charged_plane.json=0.2",
    "specs/brackets/charged_space.json=0.2",
    "specs/brackets/guiding_centre.json=0.2",
]
CANONICAL = ["midpoint", "gauss4", "gauss10"]
METHODS = ["midpoint", "gauss4", "gauss10", "gonzalez", "orbit-energy", "k-hj2", "k-hj4", "canonical2", "canonical4", "splitting4"]


def run(lie, spec, method, step, steps, every, out):
    flags = ["--method", method, "--step", str(step), "--until", repr(step * steps), "--every", str(every), "--out", out]
    return subprocess.run([lie, "run", spec, *flags], check=False, cwd=ROOT, capture_output=True, text=True)


def changes(rows, name):
    """The largest change of a column and its drift; none where there is no such column."""
    if name not in rows[0]:
        return None
    values = [float(row[name]) - float(rows[0][name]) for row in rows]
    tenth = max(len(values) // 10, 1)
    drift = statistics.fmean(values[-tenth:]) - statistics.fmean(values[:tenth])
    return f"{max(map(abs, values)):.1e}, {drift:+.0e}"


def canonical(lie, spec, folder):
    """The spec in coordinates in which its bracket is constant; none where there are none."""
    out = Path(folder) / "canonical.json"
    out.unlink(missing_ok=True)
    subprocess.run([lie, "canonical", spec, "--out", str(out)], check=False, cwd=ROOT, capture_output=True)
    return str(out) if out.exists() else None


def cells(lie, specs, method, step, steps, folder):
    """Energy, Casimir and what stands for the time: that over the time of `gauss4`, or why the run ended."""
    spec, declared = specs
    out = str(Path(folder) / "rows.csv")
    Path(out).unlink(missing_ok=True)
    done = run(lie, spec, method, step, steps, 20, out)
    if not Path(out).exists():
        return None
    with open(out) as file:
        rows = list(csv.DictReader(file))
    found = changes(rows, "energy"), changes(rows, "C")
    stopped = re.search(r"stopped in step (\d+)", done.stderr)
    if stopped:
        return *found, f"ends in step {stopped[1]}"

    def time(spec, method):
        text = run(lie, spec, method, step, steps // 5, steps // 5, out).stderr
        return float(re.search(r"\sin\s+([0-9.]+)\s+s", text)[1])

    ratios = []
    for _ in range(3):
        unit = time(declared, "gauss4")
        ratios.append(time(spec, method) / unit)
    return *found, f"{statistics.median(ratios):.2g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--steps", type=int, default=100_000)
    parser.add_argument("runs", nargs="*", default=RUNS)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for entry in arguments.runs:
            spec, step = entry.rsplit("=", 1)
            name = json.loads((ROOT / spec).read_text())["name"]
            print(f"\n`{name}`, step {step}:\n\n| method | energy, drift | Casimir, drift | time over `gauss4` |\n|---|---|---|---|")
            rows = [(spec, method, f"`{method}`") for method in METHODS]
            if other := canonical(arguments.lie, spec, folder):
                rows += [(other, method, f"`{method}`, `lie canonical`") for method in CANONICAL]
            for path, method, title in rows:
                row = cells(arguments.lie, (path, spec), method, float(step), arguments.steps, folder)
                if row is not None:
                    energy, casimir, time = row
                    print(f"| {title} | {energy} | {casimir or ''} | {time} |", flush=True)


if __name__ == "__main__":
    main()
