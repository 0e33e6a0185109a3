"""The bits of every method on two processors.

    python lab/tools/two_processors.py "qemu-aarch64 -L /usr/aarch64-linux-gnu PATH/lie" target/release/lie [SPEC …]

Each command runs each spec by every method that applies, and what they print must be the same, byte for byte. The first command may be an emulator with its
arguments. Where one stops, the other must stop with the same message. Exit code 1 where they differ. All methods of a spec are run by one process, whose start
takes longest under an emulator; where these stop or differ, each is run alone.
"""

import json
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STEP, UNTIL = "1/16", "2"


def methods(command, spec):
    found = subprocess.run([*command, "check", spec, "--json"], capture_output=True, text=True, check=True)
    applies = [key for key, reason in json.loads(found.stdout)["methods"].items() if reason is None]
    return [f"{key}(lie-midpoint)" if key.startswith("compose") else key for key in applies]


def run(command, spec, methods):
    asked = [*command, "run", spec, "--step", STEP, "--until", UNTIL, "--quiet"]
    for method in methods:
        asked += ["--method", method]
    found = subprocess.run(asked, capture_output=True, text=True, check=False)
    return found.returncode, found.stdout, found.stderr


def initial(spec):
    return "initial" in json.loads(Path(spec).read_text())


def main():
    commands = [shlex.split(text) for text in sys.argv[1:3]]
    specs = sys.argv[3:] or sorted(str(path) for path in (ROOT / "specs").glob("*.json") if "schema" not in path.name)
    runs = stopped = differ = 0
    for spec in filter(initial, specs):
        applicable = methods(commands[1], spec)
        runs += len(applicable)
        first, second = (run(command, spec, applicable) for command in commands)
        if first == second and first[0] == 0:
            print(f"{Path(spec).name}: {len(applicable)} methods, the same", flush=True)
            continue
        for method in applicable:
            first, second = (run(command, spec, [method]) for command in commands)
            stopped += first[0] != 0
            if first != second:
                differ += 1
                print(f"{Path(spec).name}, {method}: {compared(first, second)}", flush=True)
    print(f"{runs} runs of {len(specs)} specs, {stopped} that stop; {differ} differ")
    sys.exit(1 if differ else 0)


def compared(first, second):
    if first[0] != second[0]:
        return f"exit codes {first[0]} and {second[0]}: {first[2] or second[2]}"
    for row, (a, b) in enumerate(zip(first[1].splitlines(), second[1].splitlines())):
        if a != b:
            return f"line {row + 1}: {a} and {b}"
    return "messages differ"


if __name__ == "__main__":
    main()
