"""States of a system by heyoka, for the measurements of lab/docs/when_structure_pays.md.

Reads one JSON object from standard input: system, start, tolerance, delta, looks, enough. Writes a line with the seconds of the
processor for a unit of time (measured for at least `enough` seconds, states at looks from the dense output included; 0 without),
then the states at `looks` multiples of delta, as little-endian doubles.
"""

import json
import sys
import time

import heyoka as hy
import numpy as np


def body(I1, I2, I3):
    x, y, z = hy.make_vars("x", "y", "z")
    return [(x, (1 / I3 - 1 / I2) * y * z), (y, (1 / I1 - 1 / I3) * z * x), (z, (1 / I2 - 1 / I1) * x * y)]


def top(I1, I2, I3, mgl, c1, c2, c3):
    m1, m2, m3, g1, g2, g3 = v = hy.make_vars("m1", "m2", "m3", "g1", "g2", "g3")
    i1, i2, i3 = 1 / I1, 1 / I2, 1 / I3
    # a direction that is zero is left out, which no optimiser would do
    def arm(*terms):
        return sum(mgl * c * g for c, g in terms if c != 0.0)
    return list(zip(v, [
        (i3 - i2) * m2 * m3 + arm((c3, g2), (-c2, g3)),
        (i1 - i3) * m3 * m1 + arm((c1, g3), (-c3, g1)),
        (i2 - i1) * m1 * m2 + arm((c2, g1), (-c1, g2)),
        g2 * (m3 * i3) - g3 * (m2 * i2),
        g3 * (m1 * i1) - g1 * (m3 * i3),
        g1 * (m2 * i2) - g2 * (m1 * i1),
    ]))


EXCHANGE = (1.0, 0.8, 0.6)


def chain(n):
    v = np.array(hy.make_vars(*[f"{c}{i}" for i in range(n) for c in "xyz"])).reshape(n, 3)
    equations = []
    for i in range(n):
        near = [v[j] for j in (i - 1, i + 1) if 0 <= j < n]
        h = [j * (near[0][c] + near[1][c] if len(near) > 1 else near[0][c]) for c, j in enumerate(EXCHANGE)]
        s = v[i]
        equations += [(s[c], h[(c + 1) % 3] * s[(c + 2) % 3] - h[(c + 2) % 3] * s[(c + 1) % 3]) for c in range(3)]
    return equations


SYSTEMS = {"body": body, "top": top, "chain": chain}


def main():
    request = json.load(sys.stdin)
    system = dict(request["system"])
    equations = SYSTEMS[system.pop("name")](**system)
    start = np.array(request["start"])
    solver = hy.taylor_adaptive(equations, start, tol=request["tolerance"])
    delta, looks, enough = request["delta"], request["looks"], request["enough"]

    def back():
        solver.time = 0.0
        solver.state[:] = start

    seconds = 0.0
    if enough > 0.0:
        count, spent = 64, 0.0
        while True:
            grid = delta * np.arange(count + 1)
            rounds = []
            for _ in range(5):
                back()
                before = time.thread_time()
                solver.propagate_grid(grid)
                rounds.append(time.thread_time() - before)
            spent = min(rounds)
            if spent >= enough:
                break
            count = int(count * max(2, min(64, round(1.2 * enough / max(spent, 1e-6)))))
        seconds = spent / (count * delta)
    back()
    out = sys.stdout.buffer
    out.write(f"{seconds!r}\n".encode())
    done = 0
    while done < looks:
        count = min(100_000, looks - done)
        outcome = solver.propagate_grid(delta * np.arange(done, done + count + 1))
        out.write(np.ascontiguousarray(outcome[-1][1:], dtype="<f8").tobytes())
        done += count


if __name__ == "__main__":
    main()
