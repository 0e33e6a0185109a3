"""Runs the commands shown in lab/docs/when_structure_pays.md and writes their output and pictures there.

    cargo build --release
    python lab/tools/structure_pays.py [--lie target/release/lie] [--only PART]

A block of text that begins with `$ lie …` holds the output of that command, one that begins with `$ when-structure-pays …` that of
the program in lab/when_structure_pays, which is built first, for the processor of this machine. With python3 that has heyoka
(`pip install heyoka`) it is among the methods.
"""

import argparse
import os
import re
import subprocess
from pathlib import Path

from pages import output

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "lab/docs/when_structure_pays.md"
FOLDER = ROOT / "lab/when_structure_pays"
TARGET = ROOT / "target/when_structure_pays"


def built():
    environment = os.environ | {"RUSTFLAGS": "-Ctarget-cpu=native", "CARGO_TARGET_DIR": str(TARGET)}
    subprocess.run(["cargo", "build", "--release", "--locked"], cwd=FOLDER, env=environment, check=True)
    return TARGET / "release/when-structure-pays"


def long_run(program, command):
    print(command, flush=True)
    words = command.split()[1:]
    run = subprocess.run([program, *words], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return run.stdout.rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--only", default="", help="a part of the commands to run")
    arguments = parser.parse_args()
    program = built()

    def again(match):
        command = match.group(1)
        if arguments.only not in command:
            return match.group(0)
        ours = command.startswith("lie ")
        text = output(arguments.lie, command) if ours else long_run(program, command)
        return f"```text\n$ {command}\n{text}```\n"

    block = r"```text\n\$ ((?:lie|when-structure-pays) .*)\n(?:[^`].*\n|\n)*```\n"
    PAGE.write_text(re.sub(block, again, PAGE.read_text()))


if __name__ == "__main__":
    main()
