"""What a spec with one method costs: generated lines, compile time and size of the program that `lie run` builds.

    cargo build --release
    python lab/tools/program_costs.py [--lie target/release/lie] [--only SPEC]

Writes the table of lab/docs/compile_time.md between its markers. Times are those of the processor, all threads together; the
runtime is built beforehand.
"""

import argparse
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "lab/docs/compile_time.md"
METHODS = ["rk4", "midpoint", "gauss16", "taylor", "lie-midpoint", "splitting4", "collective16"]
MARKERS = ("<!-- programs -->", "<!-- end of programs -->")


def children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run(lie, cache, *words):
    """The seconds of a command, or None where it refuses."""
    before = children()
    environment = dict(os.environ, LIE_CACHE_DIR=str(cache))
    done = subprocess.run([lie, *words, "--quiet"], cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode == 2:
        return None
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")
    return children() - before


def programs(cache):
    """The executable files of the cache and their sizes."""
    files = [path for path in Path(cache).rglob("*") if path.is_file() and os.access(path, os.X_OK)]
    return {path: path.stat().st_size for path in files if path.suffix == "" and "deps" not in path.parts and "build" not in path.parts}


def lines(lie, spec, methods):
    options = [word for method in methods for word in ("--method", method)]
    text = subprocess.run([lie, "expand", str(spec), *options], cwd=ROOT, capture_output=True, text=True)
    return len(text.stdout.splitlines())


def row(lie, cache, spec, method):
    words = ["run", str(spec), "--method", method, "--step", "1e-3", "--until", "1e-3"]
    before = programs(cache)
    first = run(lie, cache, *words)
    if first is None:
        return None
    again = run(lie, cache, *words)
    new = programs(cache)
    grown = [size for path, size in new.items() if path not in before]
    size = max(grown) if grown else max(new.values())
    return lines(lie, spec, [method]), first - again, size


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--only", default="", help="a part of the name of the spec")
    arguments = parser.parse_args()
    table = ["| spec | " + " | ".join(METHODS) + " | lines, all of these |", "|---|" + "---|" * (len(METHODS) + 1)]
    with tempfile.TemporaryDirectory() as cache:
        run(arguments.lie, cache, "run", "specs/heisenberg_h3.json", "--method", "gauss4", "--until", "1e-3", "--step", "1e-3")
        for spec in sorted((ROOT / "specs").glob("*.json")):
            if spec.name.endswith("schema.json") or arguments.only not in spec.name:
                continue
            cells, apply = [], []
            for method in METHODS:
                cost = row(arguments.lie, cache, spec.relative_to(ROOT), method)
                if cost is not None:
                    apply.append(method)
                cells.append("" if cost is None else f"{cost[0]} lines, {cost[1]:.1f} s, {cost[2] / 1024:.0f} KiB")
            cells.append(str(lines(arguments.lie, spec, apply)))
            table.append(f"| {spec.stem} | " + " | ".join(cells) + " |")
            print(table[-1], flush=True)
    if arguments.only:
        return
    start, end = MARKERS
    between = re.compile(re.escape(start) + ".*" + re.escape(end), re.S)
    PAGE.write_text(between.sub("\n".join([start, *table, end]), PAGE.read_text()))


if __name__ == "__main__":
    main()
