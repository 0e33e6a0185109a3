"""Changes one coefficient or sign of each method in turn, in a copy, and expects `lie verify` to fail.

    cargo build --release
    python lab/tools/mutate.py [--lie target/release/lie] [--sites 4] [--only LABEL]… [--out survivors.txt]

For each method a program is built by `lie verify` into a cache of its own; sites are then changed one by one in the
files of the runtime that make up the method and in the fused equation that the generated program has for it.
The equation of a composition is that of the method that it composes, and is changed there. Parts of coefficients below
1e-9 (their second words, which only wider scalars see) and the counters of reports are left alone.
A change counts as caught if the verification reports a claim that fails, or if the program does not come to its end; what
does not compile is no change, and the next site is taken. Survivors are listed with the line that was changed.

A new method is one line of METHODS: label, spec, files below crates/lie-core/src, with the items in them
(constants, functions) that belong to the method where others share the file.
"""

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SPIN = "so3_nonpolynomial"
BODY = "so3_free_rigid_body"
TOP = "se3_heavy_top"
# a polynomial that is not quadratic: gradients are closed forms there
QUARTIC = "heisenberg_h3"

METHODS = [
    ("midpoint", SPIN, []),
    ("gauss4", SPIN, ["generic/tableau.rs#A2|B2"]),
    ("gauss6", SPIN, ["generic/tableau.rs#A3|B3"]),
    ("lie-midpoint", SPIN, ["generic/exp_midpoint.rs", "generic/series.rs"]),
    ("lie-midpoint --retraction cayley", SPIN, []),
    ("rk4", SPIN, ["methods/rk4.rs"]),
    ("dopri5", SPIN, ["methods/dopri5.rs"]),
    ("taylor", SPIN, ["methods/taylor.rs", "recurrence.rs"]),
    ("lie-taylor", SPIN, ["methods/lie_taylor.rs"]),
    ("lie-euler", SPIN, ["methods/lie_euler.rs", "methods/explicit.rs"]),
    ("rkmk2", SPIN, ["methods/rkmk.rs#MIDPOINT", "methods/rkmk.rs#act|correct|step"]),
    ("rkmk3", SPIN, ["methods/rkmk.rs#KUTTA", "methods/rkmk.rs#act|correct|step"]),
    ("rkmk4", SPIN, ["methods/rkmk.rs#CLASSICAL", "methods/rkmk.rs#act|correct|step"]),
    ("rkmk6", SPIN, ["methods/rkmk.rs#BUTCHER", "methods/rkmk.rs#act|correct|step"]),
    ("cg3", SPIN, ["methods/crouch_grossman.rs"]),
    ("cf4", SPIN, ["methods/commutator_free.rs"]),
    ("compose4(midpoint)", SPIN, ["methods/coefficients.rs#SUZUKI_4", "methods/compose.rs#run|step"]),
    ("compose6(midpoint)", SPIN, ["methods/coefficients.rs#KAHAN_LI_6", "methods/compose.rs#run|step"]),
    ("compose8(midpoint)", SPIN, ["methods/coefficients.rs#KAHAN_LI_8", "methods/compose.rs#run|step"]),
    ("splitting1", BODY, ["methods/splitting.rs#sweeps|advance"]),
    ("splitting2", BODY, ["methods/splitting.rs#sweeps|advance"]),
    ("splitting4", BODY, ["methods/splitting.rs#sweeps|advance", "methods/coefficients.rs#BLANES_MOAN_4"]),
    ("splitting6", BODY, ["methods/splitting.rs#sweeps|advance", "methods/coefficients.rs#BLANES_MOAN_6"]),
    ("splitting8", BODY, ["methods/splitting.rs#sweeps|advance", "methods/coefficients.rs#KAHAN_LI_8"]),
    ("moser-veselov", BODY, []),
    ("moser-veselov", "so4_manakov", []),
    ("generating2", SPIN, []),
    ("generating4", SPIN, []),
    ("generating4 --retraction cayley", SPIN, []),
    ("generating6", SPIN, []),
    ("generating-second-kind2", SPIN, []),
    ("collective2", SPIN, []),
    ("collective4", TOP, ["generic/matrix_stages.rs", "generic/stage_momenta.rs"]),
    ("collective4 --lift hopf", SPIN, ["generic/quaternion_stages.rs"]),
    ("isospectral4", SPIN, ["generic/stage_momenta.rs"]),
    ("spherical-midpoint", SPIN, []),
    ("gonzalez", SPIN, ["generic/discrete_gradient_step.rs"]),
    ("mean-value", SPIN, ["generic/quadrature.rs"]),
    ("itoh-abe", SPIN, ["generic/discrete_gradient_step.rs"]),
    ("orbit-energy", SPIN, ["generic/orbit_energy.rs"]),
    ("cohen-hairer2", QUARTIC, []),
    ("cohen-hairer4", SPIN, ["generic/cohen_hairer.rs"]),
    ("cohen-hairer6", SPIN, ["generic/cohen_hairer.rs"]),
    ("gonzalez", QUARTIC, []),
    ("mean-value", QUARTIC, []),
    ("itoh-abe", QUARTIC, []),
    ("orbit-energy", QUARTIC, []),
    ("orbit-energy --gradient mean-value", QUARTIC, []),
    ("cohen-hairer4", QUARTIC, []),
]

# options by what the names of their equations contain, and methods that are solved by those of others
VARIANTS = {"Cayley": "cayley", "Hopf": "hopf", "MeanValue": "mean-value", "ItohAbe": "itoh-abe"}
ALSO = {"collective2": {"Cayley"}, "cohen-hairer2": {"MeanValue"}}

# functions of an equation in which no claim lies
NO_CLAIM = ("initial_guess", "zero_", "set_base", "new(")


def code_lines(text):
    """Numbers of the lines that are code: no comments, attributes, tests, imports or signatures."""
    lines = text.split("\n")
    skip = False
    for number, line in enumerate(lines):
        bare = line.strip()
        if bare.startswith("#[cfg(test)]"):
            return
        if re.match(r"(pub(\(\w+\))? )?(const )?fn ", bare):
            skip = any(name in bare for name in NO_CLAIM)
        if skip or not bare or bare.startswith(("//", "#", "use ", "pub use", "impl", "where", "debug_assert")):
            continue
        if re.search(r"dyn |: [A-Z]\w*(<.*>)? \+ [A-Z]|\b(assert|panic)", bare):
            continue
        if bare.startswith("total."):
            continue
        yield number, line


def changes(line):
    """Every line that differs from this one in a sign or a coefficient."""
    for sign, other in ((" + ", " - "), (" - ", " + "), (" += ", " -= "), (" -= ", " += ")):
        for match in re.finditer(re.escape(sign), line):
            yield line[: match.start()] + other + line[match.end() :]
    for match in re.finditer(r"(?<=[ (\[=])-(?=[\w(])(?!\d\.\d+e-[12]\d)", line):
        yield line[: match.start()] + line[match.end() :]
    for match in re.finditer(r"(?<![\w.])(\d+\.\d+(e-?\d+)?)(?![\w.])", line):
        value = float(match.group(1))
        if value == 0.0 or abs(value) < 1e-9:
            continue
        changed = value + 1.0 if value == int(value) else value * 1.01
        yield line[: match.start()] + repr(changed) + line[match.end() :]


def sites(text, region):
    first, last = region
    found = []
    for number, line in code_lines(text):
        if first <= number < last:
            found.extend((number, changed) for changed in changes(line))
    return found


def item_regions(text, names):
    """The lines of the items of these names; all of the file where none is given."""
    lines = text.split("\n")
    if not names:
        return [(0, len(lines))]
    regions = []
    for first, line in enumerate(lines):
        match = re.match(rf"( *)(pub(\(\w+\))? )?(const|fn) ({names})\b", line)
        if match:
            end = (k for k in range(first, len(lines)) if re.match(rf"{match.group(1)}[}}\]].*|.*;$", lines[k]))
            end = next(k for k in end if not (k == first and lines[k].endswith(("{", "["))))
            if not line.rstrip().endswith(";"):
                end = next(k for k in range(first + 1, len(lines)) if re.match(rf"{match.group(1)}[}}\]]", lines[k]))
            regions.append((first, end + 1))
    return regions


def fused_regions(text, label):
    """The lines of the generated program with the equations of the method and of its options."""
    if label.startswith("compose"):
        return []
    lines = text.split("\n")
    lift = next(k for k, line in enumerate(lines) if "::lie_runtime::Lift<" in line)
    starts = [k for k in range(lift, len(lines)) if re.match(r"    pub struct ", lines[k])]
    ends = [*starts[1:], next(k for k, line in enumerate(lines) if line.startswith("fn main"))]
    # fused code is there for every value of an option: that of the label is wanted
    wanted = {word for word, option in VARIANTS.items() if option in label} | ALSO.get(label, set())
    def of(line):
        return {word for word in VARIANTS if word in line}
    return [(start, end) for start, end in zip(starts, ends) if of(lines[start]) == wanted]


def spread(items, count):
    """Items at even distances, the others behind them."""
    if len(items) <= count:
        return items
    first = [items[(2 * k + 1) * len(items) // (2 * count)] for k in range(count)]
    return first + [item for item in items if item not in first]


class Bench:
    """The copy in which a method is changed."""

    def __init__(self, lie, label, spec, cache):
        self.cache, self.label = cache, label
        shutil.rmtree(cache / "programs", ignore_errors=True)
        self.environment = dict(
            os.environ,
            LIE_CACHE_DIR=str(cache),
            CARGO_TARGET_DIR=str(cache / "mutants"),
            CARGO_PROFILE_RELEASE_OPT_LEVEL="1",
            CARGO_PROFILE_RELEASE_CODEGEN_UNITS="8",
        )
        self.spec = ROOT / "specs" / f"{spec}.json"
        command = [lie, "verify", str(self.spec), "--quiet", "--json", "--methods", label]
        run = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(run.stderr.strip() or run.stdout)
        (self.program,) = (cache / "programs").iterdir()
        (self.runtime,) = (cache / "runtime").iterdir()
        self.request = self.request_lines()

    def request_lines(self):
        values = initial(self.spec)
        return f"method {self.label}\ninitial {values}\nseed 1\nrun\n"

    def caught(self):
        """None if it does not compile, else what the verification says of the changed method."""
        build = subprocess.run(
            ["cargo", "build", "--release", "--offline", "--quiet", "--message-format", "json"],
            cwd=self.program, env=self.environment, capture_output=True, text=True,
        )
        if build.returncode != 0:
            return None
        paths = re.findall(r'"executable":"([^"]+)"', build.stdout)
        program = subprocess.Popen(
            [paths[-1]], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        program.stdin.write(self.request)
        program.stdin.flush()
        try:
            # the program stops when its input ends: keep it open until then
            output = program.stdout.read() if wait(program, 60) else None
        finally:
            program.kill()
        if output is None:
            return "does not end"
        failing = [line.split("\t")[2] for line in output.splitlines() if "\tfails\t" in line]
        if failing:
            return ", ".join(failing)
        return "" if "\tholds\t" in output else "reports nothing"


def wait(program, seconds):
    try:
        program.wait(seconds)
        return True
    except subprocess.TimeoutExpired:
        return False


def initial(spec):
    """The initial state of a spec; expressions in numbers alone."""
    names = {name: getattr(math, name) for name in ("cos", "sin", "sqrt", "exp", "pi")}
    entries = json.loads(spec.read_text())["initial"]
    return " ".join(repr(float(eval(str(entry).replace("^", "**"), names))) for entry in entries)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lie", default=str(ROOT / "target/release/lie"))
    parser.add_argument("--sites", type=int, default=4, help="changes per file or fused equation")
    parser.add_argument("--only", action="append", default=[], help="a label")
    parser.add_argument("--out", help="where survivors are written")
    arguments = parser.parse_args()
    survivors, total, failed = [], 0, []
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        for label, spec, files in METHODS:
            if arguments.only and label not in arguments.only:
                continue
            try:
                bench = Bench(arguments.lie, label, spec, cache)
            except RuntimeError as error:
                failed.append(f"{label}: {error}")
                print(f"{label}: not verified unchanged: {error}", flush=True)
                continue
            places = [(bench.runtime / "lie-core" / "src" / path.split("#")[0], path.partition("#")[2]) for path in files]
            for path, names in places + [(bench.program / "main.rs", None)]:
                text = path.read_text()
                fused = names is None
                regions = fused_regions(text, label) if fused else item_regions(text, names)
                found = [site for region in regions for site in sites(text, region)]
                done = 0
                for number, changed in spread(found, arguments.sites):
                    if done == arguments.sites:
                        break
                    lines = text.split("\n")
                    before, lines[number] = lines[number], changed
                    path.write_text("\n".join(lines))
                    what = bench.caught()
                    path.write_text(text)
                    if what is None:
                        continue
                    done += 1
                    total += 1
                    verdict = f"caught ({what})" if what else "SURVIVES"
                    line = f"{label}: {'fused' if fused else path.name}:{number + 1}: {verdict}: {before.strip()} -> {changed.strip()}"
                    print(line, flush=True)
                    if not what:
                        survivors.append(line)
    print(f"\n{total} changes, {len(survivors)} survive, {len(failed)} could not be tried")
    for line in survivors + failed:
        print("  " + line)
    if arguments.out:
        Path(arguments.out).write_text("\n".join(survivors + failed) + "\n")
    sys.exit(1 if survivors or failed else 0)


if __name__ == "__main__":
    main()
