"""Runs the commands shown in lab/docs/bench.md and lab/docs/stress.md and writes their output and pictures there.

    cargo build --release
    python lab/tools/pages.py [--lie target/release/lie] [--only SPEC]

A block of text that begins with `$ lie …` holds the output of that command; commands write their pictures themselves.
Of a run that lists many lines behind the table, the table is kept.
"""

import argparse
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = ["lab/docs/bench.md", "lab/docs/stress.md"]


def output(lie, command):
    print(command, flush=True)
    words = command.removeprefix("lie ").split()
    run = subprocess.run([lie, *words, "--quiet"], cwd=ROOT, capture_output=True, text=True)
    if run.returncode not in (0, 1) or not run.stdout:
        raise SystemExit(f"{command}: {run.stderr}")
    table = re.split(r"\n\d+ (?:runs did not|stopped with)", run.stdout)[0]
    lost = [line for line in run.stderr.splitlines() if line.startswith("lost:")]
    return table.rstrip() + "\n" + "".join(line + "\n" for line in lost)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--only", default="", help="a part of the commands to run")
    arguments = parser.parse_args()
    for page in PAGES:
        path = ROOT / page

        def again(match):
            if arguments.only not in match.group(1):
                return match.group(0)
            return f"```text\n$ {match.group(1)}\n{output(arguments.lie, match.group(1))}```\n"

        text = re.sub(r"```text\n\$ (lie .*)\n(?:[^`].*\n|\n)*```\n", again, path.read_text())
        path.write_text(text)


if __name__ == "__main__":
    main()
