"""Instructions of a step by `lie run`, and how many of them are machine code of the system: the table of docs/back_ends.md.

    cargo build --release
    python lab/tools/run_instructions.py [--lie target/release/lie] [METHOD ...]

callgrind counts two runs with one row at their end, of 20,000 and of 60,000 steps; the difference is that of 40,000 steps. Needs valgrind.
"""

import argparse
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SPECS = {"rigid body": "so3_free_rigid_body", "heavy top": "se3_heavy_top"}
METHODS = ["rk4", "splitting4", "midpoint", "gauss4", "lie-midpoint", "gauss16", "collective16", "taylor"]
STEP, COUNTS = 0.05, (20_000, 60_000)


def counted(lie, spec, method, steps, folder):
    """Instructions of a run, and those of functions made by it."""
    profile = Path(folder) / "profile"
    run = [lie, "run", str(ROOT / "specs" / f"{spec}.json"), "--method", method, "--step", str(STEP), "--at", str(steps * STEP)]
    run += ["--quiet", "--out", str(Path(folder) / "end.csv")]
    grind = ["valgrind", "--tool=callgrind", "--compress-strings=no", f"--callgrind-out-file={profile}"]
    subprocess.run([*grind, *run], check=True, capture_output=True)
    # functions that were made at run time are in no file and have no name
    whole, made, in_file, inside, call = 0, 0, True, False, False
    for line in profile.read_text().splitlines():
        if line.startswith("ob="):
            in_file = line != "ob=???"
        elif line.startswith("fn="):
            inside = not in_file and re.fullmatch(r"fn=0x[0-9a-f]+", line) is not None
        elif line.startswith("calls="):
            call = True
        elif line and (line[0].isdigit() or line[0] in "+-*"):
            if not call:
                count = int(line.split()[-1])
                whole, made = whole + count, made + (count if inside else 0)
            call = False
    return whole, made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lie", default=str(ROOT / "target" / "release" / "lie"))
    parser.add_argument("methods", nargs="*", metavar="METHOD", default=METHODS)
    arguments = parser.parse_args()
    print("| method | " + " | ".join(SPECS) + " |\n|---|" + "---|" * len(SPECS))
    with tempfile.TemporaryDirectory() as folder:
        for method in arguments.methods:
            cells = []
            for spec in SPECS.values():
                (few, few_made), (many, many_made) = (counted(arguments.lie, spec, method, steps, folder) for steps in COUNTS)
                each = COUNTS[1] - COUNTS[0]
                cells.append(f"{(many - few) / each:,.0f} ({(many_made - few_made) / each:,.0f})")
            print(f"| `{method}` | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
