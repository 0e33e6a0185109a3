"""Time of a step by machine code of the command beside that of programs built by cargo, for every method, and how long commands take:
the tables of docs/back_ends.md.

    cargo build --release
    python lab/tools/back_ends.py [--lie target/release/lie] [--budget 0.05] [--rounds 3] SPEC…

`lie bench` measures the same runs both ways, in turns. A row is the median, over all steps and rounds, of the ratio of two times of
the same run; what both computed is the same to the last digit, or the script fails. The commands are timed as whole processes.
"""

import argparse
import csv
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = ["check", "expand", "run", "verify --methods lie-midpoint", "bench --methods rk4,lie-midpoint --budget 0.05",
            "stress --methods lie-midpoint --steps 1000", "report --method lie-midpoint"]


def measured(lie, spec, budget, *flags):
    """Seconds for a unit of time and the error of each run, by method and step or tolerance."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as out:
        command = [lie, "bench", spec, "--budget", str(budget), "--quiet", "--out", out.name, *flags]
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
        with open(out.name) as rows:
            return {
                (row["method"], row["value"]): (float(row["seconds_per_unit_time"]), row["error"])
                for row in csv.DictReader(rows)
            }


def rows_of(lie, spec, budget, rounds):
    """The median of the ratios of each method."""
    ratios = {}
    for _ in range(rounds):
        here = measured(lie, spec, budget)
        built = measured(lie, spec, budget, "--compile")
        for (method, value), (seconds, error) in here.items():
            if (method, value) not in built:
                continue
            other, its_error = built[method, value]
            if error != its_error:
                raise SystemExit(f"{spec} {method} {value}: errors {error} and {its_error}")
            ratios.setdefault(method, []).append(seconds / other)
    return {method: statistics.median(all) for method, all in ratios.items()}


def table_of_methods(arguments):
    columns = [rows_of(arguments.lie, spec, arguments.budget, arguments.rounds) for spec in arguments.specs]
    methods = list(dict.fromkeys(method for column in columns for method in column))
    print("| method | " + " | ".join(Path(spec).stem for spec in arguments.specs) + " |")
    print("|---" * (1 + len(columns)) + "|")
    for method in methods:
        cells = [f"{column[method]:.2f}" if method in column else "" for column in columns]
        print(f"| `{method}` | " + " | ".join(cells) + " |")
    medians = [f"{statistics.median(column.values()):.2f}" for column in columns]
    print("| median | " + " | ".join(medians) + " |")


def seconds_of(command):
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        subprocess.run(command, cwd=ROOT, capture_output=True)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def table_of_commands(arguments):
    print("\n| command | seconds |\n|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for command in COMMANDS:
            name, *flags = command.split()
            ending = {"run": "csv", "report": "html"}.get(name)
            out = ["--out", f"{folder}/out.{ending}"] if ending else []
            call = [arguments.lie, name, arguments.specs[0], *flags, *out]
            shown = " ".join(["lie", name, Path(arguments.specs[0]).stem, *flags])
            print(f"| `{shown}` | {seconds_of(call):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--budget", type=float, default=0.05)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--commands-only", action="store_true")
    parser.add_argument("specs", nargs="+")
    arguments = parser.parse_args()
    if not arguments.commands_only:
        table_of_methods(arguments)
    table_of_commands(arguments)


if __name__ == "__main__":
    main()
