"""Rigid bodies and heavy tops by `lie ensemble`, heyoka's batches and diffrax to the same errors, all in one run and in turn: the table of
lab/docs/peers.md.

    cargo build --release
    pip install numpy heyoka
    python3 -m venv JAX && JAX/bin/pip install diffrax numpy
    python lab/tools/ensembles_at_errors.py [--members 100000] [--rounds 3] [--diffrax JAX/bin/python]

Bodies have initial states of the normal distribution, tops such momenta and a vertical uniform on the sphere; all go to t = 10. Errors are the largest
distance of a component over the first 200 members, from `gauss16` with steps of 0.02. Of each method the loosest setting of its ladder that comes to the error is
taken, and then every round times each once, one after the other. Seconds are those of the processor, so that other programs beside do
not count as waiting: of the command without what it takes to read the spec and the states, which a run of one step tells. With two threads they are divided
by two.
"""

import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
UNTIL = 10.0
CHECKED, TRIED = 200, 3200
TARGETS = [1e-6, 1e-9, 1e-12]
INERTIA = {"body": np.array([2, 1, 2 / 3]), "top": np.array([2, 1.5, 1])}
PULL = np.array([1 / 3, 1 / 7, 1])
SPECS = {"body": "so3_free_rigid_body", "top": "se3_heavy_top"}
BATCH = 8


def starts_of(system, members):
    source = np.random.default_rng(1)
    momenta = source.normal(size=(members, 3))
    if system == "body":
        return momenta
    vertical = source.normal(size=(members, 3))
    return np.hstack([momenta, vertical / np.linalg.norm(vertical, axis=1, keepdims=True)])


class Lie:
    """The command."""

    name = "lie-poisson"

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)

    def seconds(self, flags):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([self.program, "ensemble", *flags, "--quiet"], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def run(self, system, starts, setting, threads):
        method, (_, step, *options) = setting
        states, out = self.folder / f"{system}_{len(starts)}.npy", self.folder / "ends.npy"
        if not states.exists():
            np.save(states, starts)
        spec = str(ROOT / "specs" / f"{SPECS[system]}.json")
        flags = [spec, "--initial-file", str(states), "--threads", str(threads), "--method", method, *options]
        whole = self.seconds([*flags, "--step", step, "--until", repr(UNTIL), "--out", str(out)])
        # what is read and written, and one step
        idle = self.seconds([*flags, "--step", "0.001", "--until", "0.001", "--out", str(self.folder / "idle.npy")])
        return np.load(out), (whole - idle) / threads

    def ladders(self, system):
        taylor = [("taylor", ["--step", repr(UNTIL), "--rtol", f"{10 ** (-k / 2):.1e}"]) for k in range(8, 31)]
        steps = [10, 12, 15, 20, 25, 30, 40, 50, 65, 80, 100, 130]
        gauss = [("gauss16", ["--step", repr(UNTIL / n)]) for n in steps]
        dopri = [("dopri5", ["--step", repr(UNTIL), "--rtol", f"1e-{k}", "--atol", f"1e-{k}"]) for k in range(4, 13)]
        rk4 = [("rk4", ["--step", repr(UNTIL / round(100 * 1.5**k))]) for k in range(14)]
        return {"taylor": taylor, "gauss16": gauss, "dopri5": dopri, "rk4": rk4}


class Heyoka:
    name = "heyoka, batches of 8"

    def __init__(self):
        import heyoka

        self.heyoka, self.made = heyoka, {}

    def equations(self, system):
        hy, inertia = self.heyoka, INERTIA[system]
        m = hy.make_vars("m1", "m2", "m3")
        w = [m[i] * (1 / inertia[i]) for i in range(3)]
        cross = lambda a, b, i: a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]
        if system == "body":
            # as few products as there are
            factor = [1 / inertia[(i + 2) % 3] - 1 / inertia[(i + 1) % 3] for i in range(3)]
            return [(m[i], factor[i] * m[(i + 1) % 3] * m[(i + 2) % 3]) for i in range(3)]
        g = hy.make_vars("g1", "g2", "g3")
        pull = [hy.expression(float(p)) for p in PULL]
        turning = [(m[i], cross(m, w, i) + cross(g, pull, i)) for i in range(3)]
        return turning + [(g[i], cross(g, w, i)) for i in range(3)]

    def batch(self, system, tolerance, thread):
        key = (system, tolerance, thread)
        if key not in self.made:
            equations = self.equations(system)
            self.made[key] = self.heyoka.taylor_adaptive_batch(equations, np.zeros((len(equations), BATCH)), tol=tolerance)
        return self.made[key]

    def run(self, system, starts, tolerance, threads):
        ends = np.empty_like(starts)
        batches = [self.batch(system, tolerance, thread) for thread in range(threads)]

        def work(batch, first, last):
            for at in range(first, last, BATCH):
                batch.set_time(0.0)
                batch.state[:] = starts[at : at + BATCH].T
                batch.propagate_until(UNTIL)
                ends[at : at + BATCH] = batch.state.T

        bounds = [len(starts) // BATCH * k // threads * BATCH for k in range(threads + 1)]
        workers = [threading.Thread(target=work, args=(batches[k], bounds[k], bounds[k + 1])) for k in range(threads)]
        begun = time.process_time()
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        return ends, (time.process_time() - begun) / threads

    def ladders(self, system):
        return {"taylor": [10 ** (-k / 2) for k in range(6, 31)] + [2.2e-16]}


class Diffrax:
    name = "diffrax"

    def __init__(self, python, folder):
        self.folder = Path(folder)
        program = [python, str(ROOT / "lab" / "tools" / "ensembles_diffrax.py")]
        self.process = subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def run(self, system, starts, setting, threads):
        if threads > 1:
            return None, None
        solver, tolerance = setting
        inertia = INERTIA[system]
        factors = [1 / inertia[(i + 2) % 3] - 1 / inertia[(i + 1) % 3] for i in range(3)]
        files = [str(self.folder / name) for name in ("starts.npy", "diffrax.npy")]
        np.save(files[0], starts)
        request = {
            "system": system, "starts": files[0], "ends": files[1], "until": UNTIL, "solver": solver, "tolerance": tolerance,
            "coefficients": factors if system == "body" else [inertia.tolist(), PULL.tolist()],
        }  # fmt: skip
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        seconds, _ = json.loads(self.process.stdout.readline())
        return np.load(files[1]), seconds

    def ladders(self, system):
        return {solver: [(solver, 10.0**-k) for k in range(4, 15, 2)] for solver in ("Tsit5", "Dopri8")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--members", type=int, default=100_000, help="a multiple of 64")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--lie", default=str(ROOT / "target" / "release" / "lie"))
    parser.add_argument("--diffrax", metavar="PYTHON", help="of an environment with diffrax")
    parser.add_argument("--systems", default="body,top")
    parser.add_argument("--threads", default="1,2")
    arguments = parser.parse_args()
    if arguments.members % 64 or arguments.members < TRIED:
        parser.error(f"--members is a multiple of 64, at least {TRIED}")
    folder = tempfile.mkdtemp()
    peers = [Lie(arguments.lie, folder)]
    try:
        peers.append(Heyoka())
    except ImportError:
        print("heyoka is left out: pip install heyoka", file=sys.stderr)
    if arguments.diffrax:
        peers.append(Diffrax(arguments.diffrax, folder))
    for system in arguments.systems.split(","):
        measure(system, peers, arguments)


def measure(system, peers, arguments):
    starts = starts_of(system, arguments.members)
    some = starts[:TRIED]
    lie = peers[0]
    reference, _ = lie.run(system, some, ("gauss16", ["--step", "0.02"]), 1)

    def error(ends):
        return float(np.abs(ends[:CHECKED] - reference[:CHECKED]).max())

    # the settings that come to an error, for each method
    chosen = {}
    for peer in peers:
        for method, ladder in peer.ladders(system).items():
            left = list(TARGETS)
            for setting in ladder:
                found = error(peer.run(system, some, setting, 1)[0])
                while left and found <= left[0]:
                    chosen[peer.name, method, left.pop(0)] = (peer, setting)
                if not left:
                    break
    fixed = ("lie-midpoint", ["--step", "0.1"])
    chosen[lie.name, "lie-midpoint, h = 0.1", None] = (lie, fixed)
    threads = [int(count) for count in arguments.threads.split(",")]
    seconds = {}
    for number in range(arguments.rounds):
        print(f"{system}: round {number + 1} of {arguments.rounds}, {len(chosen)} settings", file=sys.stderr)
        for key, (peer, setting) in chosen.items():
            for count in threads:
                _, taken = peer.run(system, starts, setting, count)
                if taken is not None:
                    seconds.setdefault((key, count), []).append(taken)
    print(f"\n<!-- {system}, {arguments.members} members, {arguments.rounds} rounds -->\n")
    columns = [f"to {target:.0e}".replace("e-0", "e-") for target in TARGETS]
    for count in threads:
        unit = {target: statistics.median(seconds.get(((Heyoka.name, "taylor", target), count), [float("nan")])) for target in TARGETS}
        print(f"| {system}, threads: {count} | " + " | ".join(columns) + " |\n|---|" + "---|" * len(columns))
        for name, method in dict.fromkeys(key[:2] for key, _ in seconds):
            cells = []
            for target in TARGETS:
                found = seconds.get(((name, method, target), count)) or seconds.get(((name, method, None), count))
                cells.append(f"{statistics.median(found):.3g} ({statistics.median(found) / unit[target]:.2f})" if found else "–")
            print(f"| {name}: `{method}` | " + " | ".join(cells) + " |")
        print()


if __name__ == "__main__":
    main()
