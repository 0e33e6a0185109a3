"""Changes one operator, comparison, sign or constant at a time in the lines that changed since a commit, and expects a test to fail.

    python lab/mutants/mutants.py --changed-since COMMIT --work FOLDER [--count 300] [--seed 2026] [--package NAME]… [--test ARGUMENT]…
        [--under FOLDER]… [--verify]

The changes are drawn from all that can be made (`src/main.rs` finds them), and all of them are built at once, in a copy of the project: each
place asks a number in the environment whether it is to be another one. So one build of the tests serves all. A first run, without a
change, notes how long each test program takes and which places it reaches; each change is then tried with the programs that reach it, the
shortest first. One that no program reaches survives, as one does that all pass. With `--verify` the programs are calls of `lie verify`, for
the methods and specs of `methods.py`, instead of tests. All lines have changed since the empty tree, 4b825dc642cb6eb9a060e54bf8d69288fbee4904.

What was found is written to FOLDER/verdicts.jsonl, a line for each change, and read again: a run that was interrupted goes on.
"""

import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from methods import METHODS

ROOT = Path(__file__).resolve().parents[2]
# crates whose tests hold what the runtime, the compiler and the command do
PACKAGES = ["lie-core", "lie-runtime", "runtime-tests", "unit-tests", "lie-program", "lie-measure", "lie-syntax", "lie-symbolic", "lie-codegen",
            "lie-judge", "lie-dynamic", "lie-dense", "lie-in-process", "lie-plot", "lie-poisson"]
LEFT_OUT = re.compile(r"(^|/)(tests?|benches|examples)(/|\.rs$)|_tests\.rs$|^(lab|lie-python|crates/lie-wasm)/|build\.rs$|^crates/(spec-systems|no-std-check)/")
MODULE = """
/// Which place is another one.
#[doc(hidden)]
#[allow(missing_docs, warnings, clippy::all)]
pub mod __mutants {
    extern crate std;
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
    static CHOSEN: AtomicU32 = AtomicU32::new(u32::MAX);
    static SEEN: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];
    #[inline]
    pub fn is(place: usize) -> bool {
        if !SEEN[place].load(Relaxed) {
            first(place);
        }
        CHOSEN.load(Relaxed) == place as u32
    }
    #[cold]
    fn first(place: usize) {
        use std::io::Write as _;
        SEEN[place].store(true, Relaxed);
        if let Some(chosen) = std::env::var("LIE_MUTANT").ok().and_then(|text| text.parse().ok()) {
            CHOSEN.store(chosen, Relaxed);
        }
        if let Ok(path) = std::env::var("LIE_MUTANTS_REACHED") {
            let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
            let _ = file.and_then(|mut file| file.write_all(std::format!("{place}\\n").as_bytes()));
        }
    }
}
"""


def changed_lines(commit):
    """The lines of each file that are others than at a commit."""
    diff = subprocess.run(["git", "diff", "-U0", commit, "HEAD", "--", "*.rs"], cwd=ROOT, capture_output=True, text=True, check=True)
    lines, file = {}, None
    for line in diff.stdout.splitlines():
        if line.startswith("+++ "):
            file = line[6:] if line.startswith("+++ b/") else None
        elif line.startswith("@@") and file and not LEFT_OUT.search(file):
            first, count = re.search(r"\+(\d+)(?:,(\d+))?", line).groups()
            lines.setdefault(file, set()).update(range(int(first), int(first) + int(count or 1)))
    return lines


def sites(lines):
    build = ["cargo", "build", "--quiet", "--message-format", "json", "--manifest-path", str(ROOT / "lab/mutants/Cargo.toml")]
    built = subprocess.run(build, capture_output=True, text=True, check=True).stdout
    (finder,) = re.findall(r'"executable":"([^"]+)"', built)
    found = subprocess.run([finder, *sorted(lines)], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    found = [json.loads(line) for line in found.splitlines()]
    return [site for site in found if site["line"] in lines[site["file"]]]


def drawn(found, count, seed):
    """So many of them, none within another."""
    order = random.Random(seed).sample(found, len(found))
    taken = []
    for site in order:
        apart = (other["file"] != site["file"] or other["end"] <= site["start"] or site["end"] <= other["start"] for other in taken)
        if all(apart):
            taken.append(dict(site, number=len(taken)))
        if len(taken) == count:
            break
    return taken


def source(file):
    """The folder of a crate's sources."""
    return next(folder for folder in (ROOT / file).parents if folder.name == "src").relative_to(ROOT)


def planted(copy, taken):
    """Writes the project into the copy, with all of them; where each stands then."""
    places, texts = {}, {}
    for file in {site["file"] for site in taken}:
        text, out, last = (ROOT / file).read_bytes(), b"", 0
        for site in sorted((site for site in taken if site["file"] == file), key=lambda site: site["start"]):
            both = f"(if crate::__mutants::is({site['number']}) {{ {site['new']} }} else {{ {site['old']} }})".encode()
            out += text[last : site["start"]]
            places[site["number"]] = (file, len(out), len(out) + len(both))
            out += both
            last = site["end"]
        texts[file] = out + text[last:]
    count = max(places) + 1
    for folder in {source(site["file"]) for site in taken}:
        for root in (str(folder / "lib.rs"), str(folder / "main.rs")):
            if (ROOT / root).exists():
                texts[root] = texts.get(root, (ROOT / root).read_bytes()) + MODULE.replace("COUNT", str(count)).encode()
    for file in subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines():
        if not (ROOT / file).exists():
            continue
        content, there = texts.get(file, (ROOT / file).read_bytes()), copy / file
        # what is as it was keeps its time, so that cargo builds little again
        if not there.exists() or there.read_bytes() != content:
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(content)
            shutil.copymode(ROOT / file, there)
    return places


def cargo(copy, arguments):
    environment = dict(os.environ, CARGO_TARGET_DIR=str(copy / "target"), CARGO_INCREMENTAL="0")
    return subprocess.run(["cargo", *arguments, "--message-format", "json"], cwd=copy, env=environment, capture_output=True, text=True)


def wrong(output, places):
    """The numbers of the places of which the compiler complains."""
    found = set()
    for line in output.splitlines():
        message = json.loads(line).get("message") if line.startswith("{") else None
        if not isinstance(message, dict) or message.get("level") != "error":
            continue
        spans = list(message["spans"])
        for span in spans:
            for number, (file, start, end) in places.items():
                if span["file_name"].endswith(file) and start <= span["byte_start"] and span["byte_end"] <= end:
                    found.add(number)
    return found


def built(copy, taken, arguments):
    """What cargo builds, with all changes that compile."""
    while True:
        places = planted(copy, taken)
        run = cargo(copy, arguments)
        if run.returncode == 0:
            return taken, run.stdout
        refused = wrong(run.stdout, places)
        if not refused:
            sys.exit(run.stderr[-4000:])
        taken = [site for site in taken if site["number"] not in refused]
        print(f"{len(refused)} do not compile, {len(taken)} are left", flush=True)


def tests(output):
    """The test programs that were built: a name, a command, and the folder in which it is run."""
    found = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
    found = [unit for unit in found if unit.get("executable") and unit["profile"]["test"]]
    # what compiles packages takes minutes, and asks the compiler
    found = [unit for unit in found if unit["target"]["name"] not in ("compile_fail", "packages")]
    # to ask the environment allocates: tests that count allocations would fail of every change
    quiet = ("--quiet", "--skip", "allocate")
    return sorted({(Path(unit["executable"]).name, (unit["executable"], *quiet), str(Path(unit["manifest_path"]).parent)) for unit in found})


def verifications(copy):
    """The same of calls of `lie verify`."""
    lie = str(copy / "target/debug/lie")
    calls = [(spec, label) for spec, labels in METHODS.items() for label in labels]
    return [(f"{label} on {spec}", (lie, "verify", f"specs/{spec}.json", "--quiet", "--methods", label), str(copy)) for spec, label in calls]


def run(program, seconds, **environment):
    """Whether a program passes in this time."""
    _, command, folder = program
    environment = dict(os.environ, CARGO_MANIFEST_DIR=folder, **environment)
    try:
        done = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=seconds)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def baseline(work, found, seconds):
    """What passes unchanged: how long it takes, and what it reaches."""
    known = work / "baseline.json"
    if known.exists():
        return [(tuple(program), took, set(reached)) for program, took, reached in json.loads(known.read_text())]
    passed = []
    for program in found:
        note = work / "reached"
        note.unlink(missing_ok=True)
        began = time.monotonic()
        right = run(program, seconds, LIE_MUTANTS_REACHED=str(note))
        took = time.monotonic() - began
        why = "" if right else ", left out: it takes too long" if took > seconds else ", left out: it fails without a change"
        print(f"{program[0]}: {took:.1f} s{why}", flush=True)
        if right:
            passed.append((program, took, sorted({int(line) for line in note.read_text().split()} if note.exists() else set())))
    passed.sort(key=lambda entry: entry[1])
    known.write_text(json.dumps(passed))
    return [(program, took, set(reached)) for program, took, reached in passed]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--changed-since", required=True, metavar="COMMIT")
    parser.add_argument("--work", type=Path, required=True, help="a folder for the copy, its target folder and what was found")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--under", action="append", default=[], help="only files below this folder")
    parser.add_argument("--package", action="append", default=[], help="whose tests judge, instead of the usual ones")
    parser.add_argument("--test", action="append", default=[], help="more for `cargo test`, such as --test=--lib")
    parser.add_argument("--verify", action="store_true", help="`lie verify` judges, and no test")
    parser.add_argument("--longest", type=float, default=120, help="seconds of a test program that still judges")
    arguments = parser.parse_args()
    copy = arguments.work / "copy"
    copy.mkdir(parents=True, exist_ok=True)
    lines = changed_lines(arguments.changed_since)
    if arguments.under:
        lines = {file: found for file, found in lines.items() if file.startswith(tuple(arguments.under))}
    found = sites(lines)
    taken = drawn(found, arguments.count, arguments.seed)
    print(f"{len(found)} changes can be made in {len(lines)} files, {len(taken)} are drawn", flush=True)
    if arguments.verify:
        taken, _ = built(copy, taken, ["build", "--locked", "--keep-going", "--bin", "lie"])
        programs = verifications(copy)
    else:
        packages = [word for package in arguments.package or PACKAGES for word in ("--package", package)]
        taken, output = built(copy, taken, ["test", "--no-run", "--locked", *packages, *arguments.test])
        programs = tests(output)
    judges = baseline(arguments.work, programs, arguments.longest)
    verdicts = arguments.work / "verdicts.jsonl"
    done = {json.loads(line)["number"]: json.loads(line) for line in verdicts.read_text().splitlines()} if verdicts.exists() else {}
    for site in taken:
        if site["number"] in done:
            continue
        reaching = [(program, took) for program, took, reached in judges if site["number"] in reached]
        killer = next((program for program, took in reaching if not run(program, 5 * took + 20, LIE_MUTANT=str(site["number"]))), None)
        verdict = dict(site, caught=killer[0] if killer else None, judges=len(reaching))
        done[site["number"]] = verdict
        with verdicts.open("a") as file:
            file.write(json.dumps(verdict) + "\n")
        said = f"caught by {verdict['caught']}" if killer else f"SURVIVES {len(reaching)} programs"
        print(f"{site['number']} {site['file']}:{site['line']}: {said}: {site['old']} -> {site['new']}", flush=True)
    caught = sum(1 for site in taken if done[site["number"]]["caught"])
    print(f"{len(taken)} changes, {caught} caught, {len(taken) - caught} survive")


if __name__ == "__main__":
    main()
